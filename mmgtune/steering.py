"""Standard manoeuvres of many lanes at once: a helmsman and a steering gear to each, and the model.

A zigzag's rudder depends on the motion, so its inputs are found by repeating: all lanes are run with the orders known
so far, the first at which a ship passes her check heading gives her next one, and she is run again.  In the end the
inputs of a lane are those of a log, sampled at every step, and its motion is what a back end makes of them.  It varies
smoothly with the coefficients, as finite differences of it need: the rudder is reversed at the moment within a step at
which the ship passes her check heading, not at the end of the step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from .arrays import BoolArray, FloatArray, IntArray
from .backends import STATES, Backend, Cases, Integrator
from .inputs import INPUTS, Role
from .manoeuvres import Track
from .model import Model
from .physics.quantities import Surroundings
from .profile import Actuator

STEP = 0.05
"""Step of the integration, fourth-order Runge-Kutta, and of the record: a share of the time a ship length takes."""

APPROACH = 10
"""Steps before the order: half a ship length."""

PATIENCE = 1600
"""Steps after which a manoeuvre ends in any case: eighty ship lengths at the approach speed."""

AHEAD = 150
"""Steps a lane is run beyond its last order, at first; twice as many whenever nothing has happened in them."""

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


class Lanes(Protocol):
    """What is steered: as many ships as there are orders, each a lane.

    inputs     what drives them, by names of ``inputs.INPUTS``
    actuators  what moves each input; None where orders act at once
    """

    @property
    def L_pp(self) -> float: ...

    @property
    def inputs(self) -> Sequence[str]: ...

    @property
    def actuators(self) -> Sequence[Actuator | None]: ...

    def march(self, lanes: IntArray, cases: Cases) -> FloatArray:
        """States (n_cases, T, 6) of some lanes, a case to each; not finite once one leaves the world of ships."""
        ...


class ModelLanes:
    """Lanes of a model, each with coefficients of its own, on a back end.

    theta  (n_rows, n_lanes)
    """

    def __init__(self, model: Model, theta: FloatArray, backend: Backend):
        self.model, self.theta, self.backend = model, model.without_log(theta), backend
        self.L_pp, self.inputs = model.L_pp, model.inputs
        self.actuators = [model.profile.actuator(name) for name in model.inputs]

    def march(self, lanes: IntArray, cases: Cases) -> FloatArray:
        """See ``Lanes``."""
        theta = self.theta[:, lanes]
        found = self.backend.run(self.model, theta, cases, integrator=RK4, keep_states=True, paired=True).states
        assert found is not None  # asked for
        return found[:, 0]


def steer(model: Model, theta: FloatArray, orders: Orders, backend: Backend) -> Steered:
    """``steer_lanes`` with those of a model; theta (n_rows, n_lanes) coefficients."""
    return steer_lanes(ModelLanes(model, theta, backend), orders)


def steer_lanes(ships: Lanes, orders: Orders) -> Steered:
    """Every lane from straight ahead to the end of its manoeuvre, or to ``PATIENCE``; samples are a step apart.

    A lane that leaves the world of ships ends there and touches no other.
    """
    n_lanes = len(orders.speed)
    h = STEP * ships.L_pp / orders.speed
    helm = _Helm(ships, orders, h)
    states = np.empty((n_lanes, PATIENCE + 1, N_STATES))
    length = np.minimum(APPROACH + AHEAD, helm.longest)  # steps
    end = np.zeros(n_lanes, dtype=np.int64)
    lanes = np.arange(n_lanes)  # those under way
    while len(lanes):
        steps = length[lanes]
        controls = helm.drive(lanes, int(steps.max()))
        shown = ships.march(lanes, _cases(h[lanes], steps, controls, orders.speed[lanes]))
        states[lanes, : shown.shape[1]] = shown
        passed, end[lanes] = helm.look(lanes, shown, steps)
        turned = np.isfinite(passed)
        helm.order(lanes[turned], passed[turned])
        further = np.where(turned, np.nan_to_num(passed).astype(np.int64) + AHEAD, 2 * steps)
        length[lanes] = np.minimum(further, helm.longest[lanes])
        lanes = lanes[turned | (end[lanes] < 0)]
    # Every record holds its order, and each lane its last state after its end.
    at = np.minimum(np.arange(max(int(end.max(initial=0)), APPROACH + 1) + 1)[:, None], end)
    every = np.arange(n_lanes)
    whole = np.ascontiguousarray(states[every, at].transpose(0, 2, 1))
    driven = helm.controls[every, at].transpose(0, 2, 1)
    sound = np.asarray(np.isfinite(states[every, end]).all(axis=1))
    return Steered(h, whole, driven, end, np.array(helm.times), sound, tuple(ships.inputs))


class _Helm:
    """The helmsmen and the steering gears: orders given so far, and what inputs became of them.

    controls  (n_lanes, PATIENCE + 1, n_inputs) inputs, as far as they are known
    side      (n_lanes,) side the rudder is at, 0 before the first order
    given     (n_lanes,) orders
    since     (n_lanes,) fractional sample of the last of them; held (n_inputs, n_lanes), inputs at that moment
    times     (n_lanes,) for each order, fractional samples, NaN where it was not given
    """

    def __init__(self, ships: Lanes, orders: Orders, h: FloatArray):
        n_lanes, zero = len(h), np.zeros(len(h))
        self.orders = orders
        self.h = h
        self.inputs = [INPUTS[name] for name in ships.inputs]
        self.actuators = ships.actuators
        self.side, self.given, self.since = zero, np.zeros(n_lanes, dtype=np.int64), zero.copy()
        self.held = np.array([orders.n if one.role == "propeller" else zero for one in self.inputs])
        self.controls = np.empty((n_lanes, PATIENCE + 1, len(self.inputs)))
        self.controls[:, 0] = self.held.T
        self.times: list[FloatArray] = []
        everyone = np.arange(n_lanes)
        self.drive(everyone, APPROACH)
        self.order(everyone, np.full(n_lanes, float(APPROACH)))

    @property
    def longest(self) -> IntArray:
        """(n_lanes,) last sample of each, whatever happens: the one after the last order, where that is given."""
        last = np.floor(self.since).astype(np.int64) + 1
        return np.where(self.given > self.orders.legs, last, PATIENCE)

    def drive(self, lanes: IntArray, last: int) -> FloatArray:
        """Inputs (n_lanes, last + 1, n_inputs) of some lanes, the last order carried out up to sample ``last``."""
        samples = np.arange(last + 1.0)
        later = samples > self.since[lanes, None]
        known = self.controls[lanes, : last + 1]
        self.controls[lanes, : last + 1] = np.where(later[:, :, None], self._moved(lanes, samples), known)
        return self.controls[lanes, : last + 1]

    def order(self, lanes: IntArray, when: FloatArray) -> None:
        """The next order to some lanes at fractional samples (n_lanes,): the first, or the rudder to the other side."""
        self.held[:, lanes] = self._moved(lanes, when[:, None])[:, 0].T
        self.since[lanes] = when
        while len(self.times) <= self.given[lanes].max(initial=-1):
            self.times.append(np.full(len(self.h), np.nan))
        for lane, moment in zip(lanes, when, strict=True):
            self.times[self.given[lane]][lane] = moment
        self.side[lanes] = np.where(self.given[lanes] == 0, 1.0, -self.side[lanes])
        self.given[lanes] += 1

    def look(self, lanes: IntArray, shown: FloatArray, length: IntArray) -> tuple[FloatArray, IntArray]:
        """What is next of some lanes whose motion ``shown`` (n_lanes, n_samples, 6) is known for ``length`` steps.

        -> fractional sample at which a lane passes her check heading, NaN where she does not; else the sample at which
        she ends, -1 where neither is known.
        """
        orders, samples = self.orders, np.arange(shown.shape[1])
        psi, u = shown[:, :, 2], shown[:, :, 3]
        with np.errstate(all="ignore"):
            stopped = (orders.revolutions[lanes, None] < 0.0) & (samples > APPROACH) & (u <= 0.0)
            done = (np.abs(psi) >= orders.until[lanes, None]) | stopped | ~np.isfinite(shown).all(axis=2)
            done &= (samples > 0) & (samples <= length[:, None])
            towards = (self.side[lanes] * np.sign(orders.rudder[lanes]))[:, None] * psi
            check = orders.check[lanes, None]
            passing = (towards[:, :-1] < check) & (towards[:, 1:] >= check)
            passing &= np.isfinite(towards[:, 1:])  # a lane that is lost passes nothing, not even a check at infinity
            passing &= (samples[:-1] >= self.since[lanes, None]) & (samples[1:] <= length[:, None])
        end = np.where(done.any(axis=1), np.argmax(done, axis=1), np.where(length == self.longest[lanes], length, -1))
        k = np.argmax(passing, axis=1)
        turned = passing.any(axis=1) & ((k < end) | (end < 0))
        every = np.arange(len(lanes))
        before, after = towards[every, k], towards[every, k + 1]
        rise = np.where(turned, after - before, 1.0)
        share = np.clip(np.where(turned, check[:, 0] - before, 0.0) / rise, 0.0, 1.0 - 1e-12)
        return np.where(turned, k + share, np.nan), np.where(turned, -1, end)

    def _moved(self, lanes: IntArray, samples: FloatArray) -> FloatArray:
        """What the last order of lanes has made of their inputs at samples, (n_lanes, n_samples, n_inputs)."""
        orders = self.orders
        propeller = np.where(self.given > 0, orders.revolutions, orders.n)
        by_role = {"rudder": self.side * orders.rudder, "propeller": propeller, "thruster": np.zeros(len(self.h))}
        elapsed = (samples - self.since[lanes, None]) * self.h[lanes, None]
        found = np.empty((*elapsed.shape, len(self.inputs)))
        for k, (one, actuator) in enumerate(zip(self.inputs, self.actuators, strict=True)):
            ordered, held = by_role[one.role][lanes, None], self.held[k, lanes, None]
            found[:, :, k] = actuator.moved(held, ordered, elapsed) if actuator else ordered
        return found


def _cases(h: FloatArray, length: IntArray, controls: FloatArray, speed: FloatArray) -> Cases:
    """Lanes with these inputs (n_lanes, n_samples, n_inputs) as cases; arguments by lane, ``length`` in steps."""
    n_lanes, n_samples = controls.shape[:2]
    nothing = np.zeros((n_lanes, n_samples, N_STATES))
    initial = np.zeros((n_lanes, N_STATES))
    initial[:, 3] = speed
    return Cases(
        t=h[:, None] * np.minimum(np.arange(n_samples), length[:, None]),
        n_samples=length + 1,
        controls=controls,
        around=np.zeros((n_lanes, n_samples, len(Surroundings._fields))),
        initial=initial,
        target=nothing,
        weight=nothing,
    )
