"""Standard manoeuvres of many lanes at once: a helmsman and a steering gear to each, and the model, stepped together.

A zigzag's rudder depends on the motion, so it cannot be prepared as inputs.  Here every lane has orders of its own and
they march side by side.  What comes out varies smoothly with the coefficients, as finite differences of it need: the
rudder is reversed at the moment within a step at which the ship passes her check heading, not at the end of the step.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .arrays import BoolArray, FloatArray, IntArray
from .backends import STATES, Integrator, LaneModel
from .inputs import INPUTS, Role
from .manoeuvres import Track
from .model import Model
from .physics.quantities import UNKNOWN, State
from .profile import Actuator

STEP = 0.05
"""Step of the integration, fourth-order Runge-Kutta, and of the record: a share of the time a ship length takes."""

APPROACH = 10
"""Steps before the order: half a ship length."""

PATIENCE = 1600
"""Steps after which a manoeuvre ends in any case: eighty ship lengths at the approach speed."""

RK4 = Integrator("rk4")
N_STATES = len(STATES)


class Orders(NamedTuple):
    """What the helmsman of each lane is told, (n_lanes,) each.

    After half a ship length the rudder is put over to ``rudder``, and the propeller to ``revolutions``.  Whenever the
    ship has turned ``check`` to the side of the rudder it is put over to the other side.  The manoeuvre is done once
    ``legs`` + 1 orders are given, the heading has changed by ``until``, or the ship has lost her way.
    """

    speed: FloatArray  # approach [m/s]
    n: FloatArray  # approach [1/s]
    rudder: FloatArray  # starboard positive [rad]
    check: FloatArray  # [rad], infinite where the rudder is never reversed
    legs: IntArray
    until: FloatArray  # [rad], infinite where the heading ends nothing
    revolutions: FloatArray  # [1/s], n where the propeller is left alone


@dataclass(frozen=True, eq=False)
class Steered:
    """Lanes as they went.

    h         (n_lanes,) time between samples [s]
    states    (n_samples, 6, n_lanes); after the end of a lane anything
    controls  (n_samples, n_inputs, n_lanes)
    end       (n_lanes,) last sample of each
    orders    (n_orders, n_lanes) fractional samples at which rudder orders were given, NaN where they were not
    sound     (n_lanes,) whether it stayed within the world of ships
    """

    h: FloatArray
    states: FloatArray
    controls: FloatArray
    end: IntArray
    orders: FloatArray
    sound: BoolArray
    inputs: tuple[str, ...]

    def track(self, lane: int) -> Track:
        """One lane as indices are computed from it."""
        part = slice(0, int(self.end[lane]) + 1)
        columns = dict(zip(STATES, self.states[part, :, lane].T, strict=True))
        n, delta = self._mean("propeller", part, lane), self._mean("rudder", part, lane)
        return Track(t=self.h[lane] * np.arange(part.stop), n=n, delta=delta, **columns)

    def _mean(self, role: Role, part: slice, lane: int) -> FloatArray:
        of = [k for k, name in enumerate(self.inputs) if INPUTS[name].role == role]
        return self.controls[part, of, lane].mean(axis=1) if of else np.zeros(part.stop)


def steer(model: Model, theta: FloatArray, orders: Orders) -> Steered:
    """Every lane from straight ahead to the end of its manoeuvre, or to ``PATIENCE``; samples are a step apart.

    theta  (n_rows, n_lanes) coefficients.  A lane that leaves the world of ships ends there and touches no other.
    """
    n_lanes = theta.shape[1]
    h = STEP * model.L_pp / orders.speed
    inputs = model.arrangement.inputs
    actuators = [model.profile.actuator(one.name) for one in inputs]
    zero = np.zeros(n_lanes)
    driven = np.array([orders.n if one.role == "propeller" else zero for one in inputs])
    ship = LaneModel(model, np.ascontiguousarray(theta))
    helm = _Helm(orders)
    states, controls = [np.array([zero, zero, zero, orders.speed, zero, zero])], [driven]
    end = np.full(n_lanes, PATIENCE)
    running = np.ones(n_lanes, dtype=bool)
    with np.errstate(all="ignore"):
        run = ship.start(State(*states[0]), model.arrangement.control(*driven))
        for k in range(PATIENCE):
            if k == APPROACH:
                helm.begin()
            then = _moved(driven, helm.ordered(inputs), actuators, h)
            before = copy.copy(run)  # a step replaces what a run holds
            run.step(model.arrangement.control(*then), UNKNOWN, h, RK4)
            shown = np.array(run.shown)
            share = helm.passed(states[-1][2], shown[2])
            if (share < 1.0).any():
                first = _moved(driven, helm.ordered(inputs), actuators, share * h)
                helm.reverse(share < 1.0, k + share)
                then = _moved(first, helm.ordered(inputs), actuators, (1.0 - share) * h)
                run = before
                run.step(model.arrangement.control(*then), UNKNOWN, h, RK4)
                shown = np.array(run.shown)
            driven = then
            states.append(shown)
            controls.append(driven)
            done = helm.finished(shown) | ~np.isfinite(run.s).all(axis=0)
            end[running & done] = k + 1
            running &= ~done
            if not running.any() and k > APPROACH:  # every record holds its order
                break
    whole = np.array(states)
    end = np.minimum(end, len(whole) - 1)
    sound = np.isfinite(whole[end, :, np.arange(n_lanes)]).all(axis=1)
    return Steered(h, whole, np.array(controls), end, np.array(helm.times), sound, model.inputs)


class _Helm:
    """The helmsmen: side the rudder is at, 0 before the first order, and orders given so far."""

    def __init__(self, orders: Orders):
        self.orders = orders
        self.side = np.zeros(len(orders.speed))
        self.given = np.zeros(len(orders.speed), dtype=np.int64)
        self.times = [np.full(len(orders.speed), float(APPROACH))]
        self._astern = orders.revolutions < 0.0

    def begin(self) -> None:
        """The first order."""
        self.side, self.given = self.side + 1.0, self.given + 1

    def ordered(self, inputs: Any) -> FloatArray:
        """Orders to every input (n_inputs, n_lanes)."""
        rudder = self.side * self.orders.rudder
        propeller = np.where(self.given > 0, self.orders.revolutions, self.orders.n)
        by_role = {"rudder": rudder, "propeller": propeller, "thruster": 0.0 * rudder}
        return np.array([by_role[one.role] for one in inputs])

    def passed(self, before: FloatArray, after: FloatArray) -> FloatArray:
        """Share of a step at which lanes pass their check heading, 1 where they do not."""
        towards = self.side * np.sign(self.orders.rudder)
        begin, end = towards * before, towards * after
        passing = (self.given > 0) & (begin < self.orders.check) & (end >= self.orders.check)
        rise = np.where(passing, end - begin, 1.0)
        return np.where(passing, np.clip((self.orders.check - begin) / rise, 0.0, 1.0 - 1e-12), 1.0)

    def reverse(self, lanes: BoolArray, when: FloatArray) -> None:
        """The rudder of lanes to the other side, at these fractional samples."""
        while len(self.times) <= self.given[lanes].max():
            self.times.append(np.full(len(self.side), np.nan))
        for lane in np.flatnonzero(lanes):
            self.times[self.given[lane]][lane] = when[lane]
        self.side = np.where(lanes, -self.side, self.side)
        self.given = self.given + lanes

    def finished(self, shown: FloatArray) -> BoolArray:
        """Which manoeuvres are complete."""
        stopped = self._astern & (self.given > 0) & (shown[3] <= 0.0)
        return np.asarray((self.given > self.orders.legs) | (np.abs(shown[2]) >= self.orders.until) | stopped)


def _moved(now: FloatArray, ordered: FloatArray, actuators: list[Actuator | None], dt: Any) -> FloatArray:
    """What inputs (n_inputs, n_lanes) have become after dt [s] towards their orders."""
    found = np.empty_like(now)
    for k, actuator in enumerate(actuators):
        if actuator is None:
            found[k] = ordered[k]
            continue
        most = actuator.rate * dt
        goal = np.clip(ordered[k], actuator.low, actuator.high)
        found[k] = now[k] + np.minimum(np.maximum(goal - now[k], -most), most)
    return found
