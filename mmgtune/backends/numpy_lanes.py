"""The equations on NumPy arrays, one time step of all lanes at once: the reference, and quick for a single run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from ..arrays import FloatArray
from ..effects import (
    ActuatorEffect,
    ClockEffect,
    Effect,
    FactorsEffect,
    FilterEffect,
    FlowEffect,
    ForceEffect,
    LagEffect,
    SensorEffect,
)
from ..model import Model
from ..physics.integration import after_step, at_stage, between, with_stage
from ..physics.mmg import carried, rates, through_water
from ..physics.quantities import HELD, STATES, UNKNOWN, Force, State, Surroundings
from .cases import Cases, Integrator, LaneResult, finish, lanes_of
from .logged import Logged

E = TypeVar("E", bound=Effect)

Filtered = tuple[State, tuple[Any, ...]]
"""What leaves a filter, and what it remembers."""

N_STATES = len(STATES)


@dataclass(frozen=True)
class Arithmetic:
    """What evaluates the equations on lanes.

    of      what takes the place of a function of the equations, or of each of a tuple of them
    states  how the states of lanes are kept: in one array, or apart
    each    calls a function of states and numbers, with states kept so
    """

    of: Callable[[Any], Any]
    states: Callable[[list[Any]], Any]
    each: Callable[..., Any]


NUMPY = Arithmetic(of=lambda function: function, states=np.array, each=lambda function, *given: function(*given))
"""NumPy on the functions as they stand, and on all states at once."""


class NumpyLanes:
    """Evaluates ``physics`` as it stands, on arrays of n_cases * n_candidates lanes.

    lanes  what marches, of a model and the coefficients of every lane
    """

    name = "numpy"

    def __init__(self, lanes: Callable[[Model, FloatArray], LaneModel] | None = None):
        self.lanes = lanes or LaneModel

    def run(
        self,
        model: Model,
        theta: FloatArray,
        cases: Cases,
        *,
        initial: FloatArray | None = None,
        integrator: Integrator = Integrator(),
        keep_states: bool = False,
        keep_residuals: bool = False,
        paired: bool = False,
    ) -> LaneResult:
        """See ``Backend.run``."""
        n_cases, n_candidates = len(cases), 1 if paired else theta.shape[-1]
        shape = (n_cases, n_candidates)
        ship = self.lanes(model, np.ascontiguousarray(lanes_of(theta, n_cases, paired)))
        if initial is None:
            initial = np.repeat(cases.initial[:, None], n_candidates, axis=1)
        T = cases.t.shape[1]
        cost = np.zeros(shape)
        states = np.empty((n_cases, n_candidates, T, N_STATES)) if keep_states else None
        residuals = np.empty((cases.n_residuals, n_candidates)) if keep_residuals else None
        if states is not None:
            states[:, :, 0] = initial

        log = Logged(model, cases, n_candidates, ship.shift)
        with np.errstate(all="ignore"):
            run = ship.start(State(*initial.reshape(-1, N_STATES).T), log.inputs(1, 0.0), log.around(1, 0.0))
            fastest2 = np.zeros(n_cases * n_candidates)
            for k in range(1, T):
                h = log.per_lane((cases.t[:, k] - cases.t[:, k - 1]) / integrator.substeps)
                for sub in range(integrator.substeps):
                    f = (sub + 1) / integrator.substeps
                    run.step(log.inputs(k, f), log.around(k, f), h, integrator)
                fastest2 = np.fmax(fastest2, run.s[3] * run.s[3] + run.s[4] * run.s[4])
                now_states = np.array(run.shown).T.reshape(n_cases, n_candidates, N_STATES)
                difference = now_states - cases.target[:, None, k]
                cost += np.sum(cases.weight[:, None, k] * difference * difference, axis=-1)
                if states is not None:
                    states[:, :, k] = now_states
                if residuals is not None:
                    counts = cases.rows[:, k] >= 0
                    scaled = np.sqrt(cases.weight[:, None, k]) * difference
                    residuals[cases.rows[:, k][counts]] = scaled.transpose(0, 2, 1)[counts]
        last = run.s[:N_STATES].T.reshape(n_cases, n_candidates, N_STATES)
        return finish(cost, fastest2.reshape(shape), last, states, residuals)


class Acting(Generic[E]):
    """An effect with the parameters of every lane."""

    def __init__(self, effect: E, e: Any):
        self.effect = effect
        self.e = e


class LaneModel:
    """A model with the coefficients of every lane, and its effects in the order in which they act.

    theta  (n_rows, n_lanes), or (n_rows,) for one lane: everything is then a plain number where it is (n_lanes,) else,
           which NumPy is several times as quick with as with arrays of one
    on     what evaluates it; arrays are of its kind
    """

    def __init__(self, model: Model, theta: FloatArray, on: Arithmetic = NUMPY):
        self.on, self.of = on, on.of
        self.arrangement = model.arrangement
        self.components = self.of(model.components)
        self.p = model.coefficients(theta)
        self._field_of = {part.kind: name for part, name in zip(model.parts, self.p._fields, strict=True)}

        def acting(kind: type[E]) -> list[Acting[E]]:
            return [Acting(effect, model.parameters(effect, theta)) for effect in model.acting(kind)]

        def there(kind: type[E]) -> list[Acting[E]]:
            """Without those that every lane has at their null, where numbers are known."""
            return [one for one in acting(kind) if on is not NUMPY or not one.effect.is_absent(one.e)]

        self.flows, self.forces = there(FlowEffect), there(ForceEffect)
        self.sensors, self.factors = there(SensorEffect), there(FactorsEffect)
        self.actuators, self.lags, self.filters = acting(ActuatorEffect), acting(LagEffect), acting(FilterEffect)
        self.acts_on = [self.arrangement.of_role(one.effect.of) for one in self.actuators]
        self._clocks = acting(ClockEffect)

    @property
    def shift(self) -> tuple[FloatArray | None, ...]:
        """For each input (n_lanes,) how much later in the log what acts stands [s]; None where nothing shifts it."""
        return self._shifts({"log": 1.0, "ship": -1.0})

    @property
    def late_log(self) -> tuple[FloatArray | None, ...]:
        """For each input (n_lanes,) how late its log is [s]; None where nothing makes it so."""
        return self._shifts({"log": 1.0})

    @property
    def dead_time(self) -> tuple[FloatArray | None, ...]:
        """For each input (n_lanes,) how late the ship answers to it [s]; None where nothing makes her so."""
        return self._shifts({"ship": 1.0})

    def _shifts(self, signs: Mapping[str, float]) -> tuple[FloatArray | None, ...]:
        found: list[FloatArray | None] = [None] * len(self.arrangement.inputs)
        for one in self._clocks:
            sign = signs.get(one.effect.late)
            if sign is None:
                continue
            of = one.effect.of
            for k in range(len(found)) if of is None else self.arrangement.of_role(of):
                before = found[k]
                found[k] = sign * one.e[0] if before is None else before + sign * one.e[0]
        return tuple(found)

    @property
    def looks_around(self) -> bool:
        """Whether anything depends on the surroundings."""
        return bool(self.flows or self.forces or self.factors)

    def start(self, shown: State, logged: Any, around: Surroundings = UNKNOWN) -> LaneRun:
        """A run from the state the sensors show, with the machinery at rest at the inputs logged there."""
        return LaneRun(self, self.unsensed(shown), logged, around)

    def under_way(self, shown: State, logged: Any, around: Surroundings = UNKNOWN) -> LaneRun:
        """A run, begun as by ``start``, whose inputs become known as they come: they act after the dead time."""
        return (
            LateRun(self, shown, logged, around)
            if any(d is not None for d in self.dead_time)
            else self.start(shown, logged, around)
        )

    def moved(self, start: list[Any], end: Any, before: list[Any] | None, h: Any) -> list[Any]:
        """What reaches and leaves each actuator at the end of a step; ``before`` None where it has been at rest."""
        chain = [end]
        for k, (one, inputs) in enumerate(zip(self.actuators, self.acts_on, strict=True)):
            first = chain[k] if before is None else start[k]
            held = list(first if before is None else before[k + 1])
            left = list(chain[k])
            for i in inputs:
                if before is None and one.effect.rested is not None:
                    held[i] = self.of(one.effect.rested)(first[i], one.e)
                left[i] = self.of(one.effect.function)(first[i], chain[k][i], held[i], h, one.e)
            chain.append(type(end)(*left))
        return chain

    def water(self, state: State, around: Surroundings) -> tuple[Any, Any]:
        """Velocity of the water in the ship's axes."""
        u_c: Any = 0.0
        v_c: Any = 0.0
        for one in self.flows:
            du, dv = self.of(one.effect.function)(state, around, one.e)
            u_c, v_c = u_c + du, v_c + dv
        return u_c, v_c

    def here(self, around: Surroundings) -> Any:
        """The coefficients in these surroundings."""
        p = self.p
        for one in self.factors:
            for name, factor in zip(one.effect.changes, self.of(one.effect.function)(around, one.e), strict=True):
                kind, _, symbol = name.partition(".")
                field = self._field_of[kind]
                part = getattr(p, field)
                if symbol in part._fields:
                    p = p._replace(**{field: part._replace(**{symbol: getattr(part, symbol) * factor})})
        return p

    def breakdown(self, state: State, control: Any, around: Surroundings, p: Any) -> Any:
        """Forces of the components, and in the total those that effects add; p the coefficients ``here``."""
        through = self.of(through_water)(state, *self.water(state, around))
        found = self.of(self.arrangement.forces)(through, control, self.components, p)
        total = found.total
        for one in self.forces:
            total = _sum(total, self.of(one.effect.function)(state, around, found, self.components, p, one.e))
        return found._replace(total=total)

    def behind(self, state: State, control: Any, around: Surroundings) -> list[Any]:
        """What lags remember at the first state."""
        if not self.lags:
            return []
        found = self.breakdown(state, control, around, self.here(around))
        return [value for one in self.lags for value in self.of(one.effect.start)(found, one.e)]

    def acting_force(self, s: Any, control: Any, around: Surroundings, h: Any, p: Any) -> tuple[Force, list[Any]]:
        """Force on the ship, with those that effects and lags add, and the rates of what lags remember; p as above."""
        found = self.breakdown(State(*s[:N_STATES]), control, around, p)
        return self.lagged(found, s[N_STATES:], h)

    def lagged(self, found: Any, behind: Any, h: Any) -> tuple[Force, list[Any]]:
        """The force of a breakdown with those that lags add, and the rates of what they remember."""
        total: Force = found.total
        slopes: list[Any] = []
        for one in self.lags:
            at = len(slopes)
            more, own = self.of(one.effect.function)(found, tuple(behind[at : at + len(one.effect.states)]), h, one.e)
            total = _sum(total, more)
            slopes += own
        return total, slopes

    def rates(self, s: Any, control: Any, around: Surroundings, h: Any) -> Any:
        """Time derivatives of the six states and of what lags remember, (n_states, n_lanes)."""
        state = State(*s[:N_STATES])
        p = self.here(around)
        total, slopes = self.acting_force(s, control, around, h, p)
        return self.on.states([*self.under(total, state, around, p), *slopes])

    def under(self, total: Force, state: State, around: Surroundings, p: Any) -> State:
        """Time derivatives of the six states under a force; p the coefficients ``here``."""
        rate: State = self.of(rates)(state, *self.water(state, around), total, p.ship)
        for moving in self.flows:
            if moving.effect.rate is not None:
                rate = self.of(carried)(rate, *self.of(moving.effect.rate)(state, around, moving.e))
        return rate

    def sensed(self, state: State) -> State:
        """The state as it is logged, of a motion that has lasted."""
        return self._settled(state)[-1][0]

    def unsensed(self, shown: State) -> State:
        """The state behind what is logged of a motion that has lasted."""
        for last in reversed(self.filters):
            shown = self.of(last.effect.inverse)(shown, last.e)
        for one in reversed(self.sensors):
            shown = self.of(one.effect.inverse)(shown, one.e)
        return shown

    def shown(self, now: Moment) -> State:
        """The state as it is logged now."""
        return now.logs[-1][0] if self.filters else self._through_sensors(State(*now.s[:N_STATES]))

    def _through_sensors(self, state: State) -> State:
        for one in self.sensors:
            state = self.of(one.effect.function)(state, one.e)
        return state

    def _settled(self, state: State) -> list[Filtered]:
        """What sensors show, then what each filter makes of that, of a motion that has lasted."""
        found: list[Filtered] = [(self._through_sensors(state), ())]
        for one in self.filters:
            found.append(self.of(one.effect.settled)(found[-1][0], one.e))
        return found

    def _filtered(self, before: tuple[Filtered, ...], state: State, h: Any) -> tuple[Filtered, ...]:
        """The same a step of h [s] after ``before``."""
        if not self.filters:
            return ()
        found: list[Filtered] = [(self._through_sensors(state), ())]
        for k, one in enumerate(self.filters):
            (start, _), (_, held), (end, _) = before[k], before[k + 1], found[-1]
            found.append(self.of(one.effect.function)(start, end, held, h, one.e))
        return tuple(found)

    def begin(self, state: State, logged: Any, around: Surroundings) -> Moment:
        """The first moment, with the machinery at rest at the inputs logged there."""
        chain = self.moved([], logged, None, 0.0)
        logs = tuple(self._settled(state)) if self.filters else ()
        return Moment(self.on.states([*state, *self.behind(state, chain[-1], around)]), chain, around, logs)

    def step(
        self,
        now: Moment,
        logged: Any,
        around: Surroundings,
        h: Any,
        integrator: Integrator,
        by: Callable[[Any, Any, Surroundings, Any], Any] | None = None,
    ) -> Moment:
        """The moment h [s] later, at which these inputs are logged and these surroundings measured.

        by  what takes the place of ``rates``
        """
        by, each = by or self.rates, self.on.each
        position, share = (values.tolist() for values in integrator.tableau)
        chain = self.moved(now.chain, logged, now.chain, h)
        before, after = now.chain[-1], chain[-1]
        total: Any = 0.0
        z = now.s
        for stage, at in enumerate(position):
            control = type(after)(*(between(a, b, at) for a, b in zip(before, after, strict=True)))
            rate = by(z, control, _between(now.around, around, at), h)
            total = each(with_stage, total, share[stage], rate)
            if stage + 1 < len(position):
                z = each(at_stage, now.s, position[stage + 1], h, rate)
        s = each(after_step, now.s, h, total)
        return Moment(s, chain, around, self._filtered(now.logs, State(*s[:N_STATES]), h))


class Moment(NamedTuple):
    """Lanes on their way.

    s       (n_states, n_lanes), or (n_states,), the six states, then what lags remember
    chain   what has reached and left each actuator, one after the other
    around  the surroundings
    logs    what sensors show, then what each filter makes of that and what it remembers; nothing without filters
    """

    s: FloatArray
    chain: list[Any]
    around: Surroundings
    logs: tuple[Filtered, ...] = ()

    def of(self, lanes: Any) -> Moment:
        """Some of several lanes, or one of them by its number; the surroundings are those of all."""
        return Moment(self.s[:, lanes], _of(self.chain, lanes), self.around, _of(self.logs, lanes))


class LaneRun:
    """Lanes that march in place."""

    def __init__(self, ship: LaneModel, state: State, logged: Any, around: Surroundings):
        self.ship = ship
        self.now = ship.begin(state, logged, around)

    @property
    def s(self) -> FloatArray:
        """The states, then what lags remember: see ``Moment``."""
        return self.now.s

    @property
    def shown(self) -> State:
        """The six states as they are logged."""
        return self.ship.shown(self.now)

    def keep(self, ship: LaneModel, lanes: Any) -> None:
        """Go on with some of several lanes, whose coefficients ``ship`` has."""
        self.ship, self.now = ship, self.now.of(lanes)

    def step(self, logged: Any, around: Surroundings, h: Any, integrator: Integrator) -> None:
        """March by h [s] to where these inputs are logged and these surroundings measured."""
        self.now = self.ship.step(self.now, logged, around, h, integrator)


class LateRun(LaneRun):
    """Lanes whose inputs become known as they come, and act after the ship's dead time; before the first, as there."""

    def __init__(self, ship: LaneModel, shown: State, logged: Any, around: Surroundings):
        super().__init__(ship, ship.unsensed(shown), logged, around)
        self._dead = ship.dead_time
        self._given = [logged]

    def keep(self, ship: LaneModel, lanes: Any) -> None:
        """See ``LaneRun``."""
        super().keep(ship, lanes)
        self._dead = ship.dead_time
        self._given = _of(self._given, lanes)

    def step(self, logged: Any, around: Surroundings, h: Any, integrator: Integrator) -> None:
        """March by h [s], the same at every step of a lane."""
        self._given.append(logged)
        acts = (
            one if dead is None else self._at(k, len(self._given) - 1 - np.asarray(dead) / h)
            for k, (one, dead) in enumerate(zip(logged, self._dead, strict=True))
        )
        super().step(type(logged)(*acts), around, h, integrator)

    def _at(self, k: int, steps: FloatArray) -> FloatArray:
        """Input k after so many steps (n_lanes,), linear between what was given."""
        j = np.clip(np.ceil(steps).astype(np.int64), 1, len(self._given) - 1)
        share = np.clip(steps - (j - 1), 0.0, 1.0)
        first = int(np.min(j)) - 1
        near = np.array([np.broadcast_to(given[k], steps.shape) for given in self._given[first:]])
        lane = np.indices(steps.shape)
        return np.asarray(between(near[(j - 1 - first, *lane)], near[(j - first, *lane)], share))


def _of(values: Any, lanes: Any) -> Any:
    """Some of the lanes of arrays in tuples and lists; what is one number for all of them stays as it is."""
    if isinstance(values, (list, tuple)):
        parts = [_of(one, lanes) for one in values]
        return type(values)(*parts) if hasattr(values, "_fields") else type(values)(parts)
    return values[lanes] if np.ndim(values) else values


def _between(before: Surroundings, after: Surroundings, f: float) -> Surroundings:
    return Surroundings(
        *(
            b if name in HELD else between(a, b, f)
            for name, a, b in zip(Surroundings._fields, before, after, strict=True)
        )
    )


def _sum(a: Force, b: Force) -> Force:
    return Force(*(one + other for one, other in zip(a, b, strict=True)))
