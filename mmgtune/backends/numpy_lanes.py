"""The equations on NumPy arrays, one time step of all lanes at once: the reference, and quick for a single run."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..model import Model
from ..physics.mmg import Breakdown, forces, rates, through_water
from ..physics.quantities import Air, Control, State
from .cases import Cases, Integrator, LaneResult, finish

STILL = Air(0.0, 0.0, 0.0)
"""No wind measured."""


class NumpyLanes:
    """Evaluates ``physics`` as it stands, on arrays of n_cases * n_candidates lanes."""

    name = "numpy"

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
    ) -> LaneResult:
        """See ``Backend.run``."""
        n_cases, n_candidates = len(cases), theta.shape[1]
        shape = (n_cases, n_candidates)
        ship = LaneModel(model, np.ascontiguousarray(np.tile(theta, n_cases)))
        if initial is None:
            initial = np.repeat(cases.initial[:, None], n_candidates, axis=1)
        position, share = integrator.tableau
        T = cases.t.shape[1]
        cost = np.zeros(shape)
        states = np.empty((n_cases, n_candidates, T, 6)) if keep_states else None
        residuals = np.empty((cases.n_residuals, n_candidates)) if keep_residuals else None
        if states is not None:
            states[:, :, 0] = initial

        def per_lane(values: FloatArray) -> FloatArray:
            return np.repeat(values, n_candidates)

        def logged(k: int, f: float) -> Control:
            return Control(*(_at(cases, k, f, column, ship.shift, per_lane) for column in range(2)))

        with np.errstate(all="ignore"):
            start = ship.unsensed(State(*initial.reshape(-1, 6).T))
            fastest2 = np.zeros(n_cases * n_candidates)
            here = logged(1, 0.0)
            chain = ship.moved([here], [here], None, per_lane(np.zeros(n_cases)))
            air = Air(*(per_lane(cases.wind[:, 0, j]) for j in range(3)))
            s = np.array([*start, *ship.lag_start(start, chain[-1], air)])
            for k in range(1, T):
                h = per_lane((cases.t[:, k] - cases.t[:, k - 1]) / integrator.substeps)
                for sub in range(integrator.substeps):
                    reached = ship.moved(chain, [logged(k, (sub + 1) / integrator.substeps)], chain, h)
                    now, then = chain[-1], reached[-1]
                    total = np.zeros_like(s)
                    z = s
                    for stage in range(len(position)):
                        f = (sub + position[stage]) / integrator.substeps
                        control = Control(*(a + position[stage] * (b - a) for a, b in zip(now, then, strict=True)))
                        before, after = cases.wind[:, k - 1], cases.wind[:, k]
                        north, east = (per_lane(before[:, j] + f * (after[:, j] - before[:, j])) for j in range(2))
                        air = Air(north, east, known=per_lane(after[:, 2]))
                        rate = ship.rates(z, control, air, h)
                        total = total + share[stage] * rate
                        if stage + 1 < len(position):
                            z = s + position[stage + 1] * h * rate
                    s = s + h * total
                    chain = reached
                fastest2 = np.fmax(fastest2, s[3] * s[3] + s[4] * s[4])
                now_states = np.array(ship.sensed(State(*s[:6]))).T.reshape(n_cases, n_candidates, 6)
                difference = now_states - cases.target[:, None, k]
                cost += np.sum(cases.weight[:, None, k] * difference * difference, axis=-1)
                if states is not None:
                    states[:, :, k] = now_states
                if residuals is not None:
                    counts = cases.rows[:, k] >= 0
                    scaled = np.sqrt(cases.weight[:, None, k]) * difference
                    residuals[cases.rows[:, k][counts]] = scaled.transpose(0, 2, 1)[counts]
        last = s[:6].T.reshape(n_cases, n_candidates, 6)
        return finish(cost, fastest2.reshape(shape), last, states, residuals)


class LaneModel:
    """A model with the coefficients of every lane, and its effects in the order in which they act."""

    def __init__(self, model: Model, theta: FloatArray):
        self.components = model.components
        self.p = model.coefficients(theta)

        def acting(place: str) -> list[tuple[Any, Any]]:
            return [(effect, model.parameters(effect, theta)) for effect in model.acting(place)]

        self.actuators, self.flows, self.forces = acting("actuator"), acting("flow"), acting("force")
        self.lags, self.sensors = acting("lag"), acting("sensor")
        self.shift: FloatArray | None = None
        for _, e in acting("clock"):
            self.shift = e[0] if self.shift is None else self.shift + e[0]

    def moved(
        self, start: list[Control], end: list[Control], before: list[Control] | None, h: FloatArray
    ) -> list[Control]:
        """What reaches and leaves each actuator at the end of a step; ``before`` None where it has been at rest."""
        chain = [end[0]]
        for k, (effect, e) in enumerate(self.actuators):
            first = chain[k] if before is None else start[k]
            chain.append(effect.function(first, chain[k], first if before is None else before[k + 1], h, e))
        return chain

    def water(self, state: State, air: Air) -> tuple[Any, Any]:
        """Velocity of the water in the ship's axes."""
        u_c: Any = 0.0
        v_c: Any = 0.0
        for effect, e in self.flows:
            du, dv = effect.function(state, air, e)
            u_c, v_c = u_c + du, v_c + dv
        return u_c, v_c

    def breakdown(self, state: State, control: Control, air: Air = STILL) -> Breakdown:
        """Forces of the components, and in the total those that effects add."""
        found: Breakdown = forces(through_water(state, *self.water(state, air)), control, self.components, self.p)
        total = found.total
        for effect, e in self.forces:
            total = _sum(total, effect.function(state, air, found, self.components, self.p, e))
        return found._replace(total=total)

    def lag_start(self, state: State, control: Control, air: Air = STILL) -> list[FloatArray]:
        """Lagging forces at the first state."""
        if not self.lags:
            return []
        hull = self.breakdown(state, control, air).hull
        return [hull.Y, hull.N] * len(self.lags)

    def rates(self, s: FloatArray, control: Control, air: Air, h: Any) -> FloatArray:
        """Time derivatives of the six states and of the lagging forces, (6 + 2 n_lags, n_lanes)."""
        state = State(*s[:6])
        found = self.breakdown(state, control, air)
        total = found.total
        slopes: list[FloatArray] = []
        for k, (effect, e) in enumerate(self.lags):
            more, Y_dot, N_dot = effect.function(found.hull, s[6 + 2 * k], s[7 + 2 * k], h, e)
            total = _sum(total, more)
            slopes += [Y_dot, N_dot]
        return np.array([*rates(state, *self.water(state, air), total, self.p.ship), *slopes])

    def sensed(self, state: State) -> State:
        """The state as the sensors show it."""
        for effect, e in self.sensors:
            state = effect.function(state, e)
        return state

    def unsensed(self, shown: State) -> State:
        """The state behind what the sensors show."""
        for effect, e in reversed(self.sensors):
            shown = effect.inverse(shown, e)
        return shown


def _sum(a: Any, b: Any) -> Any:
    return type(a)(*(one + other for one, other in zip(a, b, strict=True)))


def _at(cases: Cases, k: int, f: float, column: int, shift: FloatArray | None, per_lane: Any) -> FloatArray:
    """A logged input at the share f of the step that ends at sample k, each lane ``shift`` [s] later."""
    before, after = cases.controls[:, k - 1, column], cases.controls[:, k, column]
    value = per_lane(before + f * (after - before))
    if shift is None:
        return np.asarray(value)
    time = per_lane(cases.t[:, k - 1] + f * (cases.t[:, k] - cases.t[:, k - 1])) + shift
    late = time.reshape(len(cases), -1)
    moved = [
        np.interp(late[case], cases.t[case, :n], cases.controls[case, :n, column])
        for case, n in enumerate(cases.n_samples)
    ]
    return np.where(shift == 0.0, value, np.concatenate(moved))
