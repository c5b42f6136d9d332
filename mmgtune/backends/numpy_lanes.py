"""The equations on NumPy arrays, one time step of all lanes at once: the reference, and quick for a single run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from ..arrays import FloatArray
from ..effects import ActuatorEffect, Effect, FactorsEffect, FlowEffect, ForceEffect, LagEffect, SensorEffect
from ..model import Model
from ..physics.integration import after_step, at_stage, between, with_stage
from ..physics.mmg import carried, rates, through_water
from ..physics.quantities import HELD, STATES, UNKNOWN, Force, State, Surroundings
from .cases import Cases, Integrator, LaneResult, finish, lanes_of
from .logged import Logged

E = TypeVar("E", bound=Effect)

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

        def acting(kind: type[E]) -> list[Acting[E]]:
            return [Acting(effect, model.parameters(effect, theta)) for effect in model.acting(kind)]

        self.actuators, self.flows, self.forces = acting(ActuatorEffect), acting(FlowEffect), acting(ForceEffect)
        self.lags, self.sensors, self.factors = acting(LagEffect), acting(SensorEffect), acting(FactorsEffect)
        self.acts_on = [self.arrangement.of_role(one.effect.of) for one in self.actuators]
        shifts = [model.parameters(effect, theta)[0] for effect in model.clocks]
        self.shift: FloatArray | None = sum(shifts[1:], shifts[0]) if shifts else None

    @property
    def looks_around(self) -> bool:
        """Whether anything depends on the surroundings."""
        return bool(self.flows or self.forces or self.factors)

    def start(self, shown: State, logged: Any, around: Surroundings = UNKNOWN) -> LaneRun:
        """A run from the state the sensors show, with the machinery at rest at the inputs logged there."""
        return LaneRun(self, self.unsensed(shown), logged, around)

    def moved(self, start: list[Any], end: Any, before: list[Any] | None, h: Any) -> list[Any]:
        """What reaches and leaves each actuator at the end of a step; ``before`` None where it has been at rest."""
        chain = [end]
        for k, (one, inputs) in enumerate(zip(self.actuators, self.acts_on, strict=True)):
            first = chain[k] if before is None else start[k]
            held = first if before is None else before[k + 1]
            left = list(chain[k])
            for i in inputs:
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
                section, _, symbol = name.partition(".")
                part = getattr(p, section)
                p = p._replace(**{section: part._replace(**{symbol: getattr(part, symbol) * factor})})
        return p

    def breakdown(self, state: State, control: Any, around: Surroundings = UNKNOWN) -> Any:
        """Forces of the components, and in the total those that effects add."""
        through, p = self.of(through_water)(state, *self.water(state, around)), self.here(around)
        found = self.of(self.arrangement.forces)(through, control, self.components, p)
        total = found.total
        for one in self.forces:
            total = _sum(total, self.of(one.effect.function)(state, around, found, self.components, p, one.e))
        return found._replace(total=total)

    def behind(self, state: State, control: Any, around: Surroundings) -> list[Any]:
        """What lags remember at the first state."""
        if not self.lags:
            return []
        found = self.breakdown(state, control, around)
        return [value for one in self.lags for value in self.of(one.effect.start)(found, one.e)]

    def acting_force(self, s: Any, control: Any, around: Surroundings, h: Any) -> tuple[Force, list[Any]]:
        """Force on the ship, with those that effects and lags add, and the rates of what lags remember."""
        state = State(*s[:N_STATES])
        found = self.breakdown(state, control, around)
        total: Force = found.total
        slopes: list[Any] = []
        at = N_STATES
        for one in self.lags:
            behind = tuple(s[at : at + len(one.effect.states)])
            more, own = self.of(one.effect.function)(found, behind, h, one.e)
            total = _sum(total, more)
            slopes += own
            at += len(behind)
        return total, slopes

    def rates(self, s: Any, control: Any, around: Surroundings, h: Any) -> Any:
        """Time derivatives of the six states and of what lags remember, (n_states, n_lanes)."""
        state = State(*s[:N_STATES])
        total, slopes = self.acting_force(s, control, around, h)
        rate = self.of(rates)(state, *self.water(state, around), total, self.p.ship)
        for moving in self.flows:
            if moving.effect.rate is not None:
                rate = self.of(carried)(rate, *self.of(moving.effect.rate)(state, around, moving.e))
        return self.on.states([*rate, *slopes])

    def sensed(self, state: State) -> State:
        """The state as the sensors show it."""
        for one in self.sensors:
            state = self.of(one.effect.function)(state, one.e)
        return state

    def unsensed(self, shown: State) -> State:
        """The state behind what the sensors show."""
        for one in reversed(self.sensors):
            shown = self.of(one.effect.inverse)(shown, one.e)
        return shown

    def begin(self, state: State, logged: Any, around: Surroundings) -> Moment:
        """The first moment, with the machinery at rest at the inputs logged there."""
        chain = self.moved([], logged, None, 0.0)
        return Moment(self.on.states([*state, *self.behind(state, chain[-1], around)]), chain, around)

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
        return Moment(each(after_step, now.s, h, total), chain, around)


class Moment(NamedTuple):
    """Lanes on their way.

    s       (n_states, n_lanes), or (n_states,), the six states, then what lags remember
    chain   what has reached and left each actuator, one after the other
    around  the surroundings
    """

    s: FloatArray
    chain: list[Any]
    around: Surroundings


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
        """The six states as the sensors show them."""
        return self.ship.sensed(State(*self.s[:N_STATES]))

    def step(self, logged: Any, around: Surroundings, h: Any, integrator: Integrator) -> None:
        """March by h [s] to where these inputs are logged and these surroundings measured."""
        self.now = self.ship.step(self.now, logged, around, h, integrator)


def _between(before: Surroundings, after: Surroundings, f: float) -> Surroundings:
    return Surroundings(
        *(
            b if name in HELD else between(a, b, f)
            for name, a, b in zip(Surroundings._fields, before, after, strict=True)
        )
    )


def _sum(a: Force, b: Force) -> Force:
    return Force(*(one + other for one, other in zip(a, b, strict=True)))
