"""A helmsman to each particle: standard manoeuvres of all of them at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..backends import Cases, get_backend
from ..backends.numpy_lanes import NumpyLanes
from ..manoeuvres.on_lanes import LaneRecord, stopping, turning, zigzag
from ..networks import HybridPredictor
from ..predictor import Paired, PhysicsPredictor, Predictor, portions, predicted
from ..profile import Actuator
from ..steering import APPROACH, Lanes, ModelLanes, Orders, Steered, steer_lanes
from ..units import DEG
from .asked import Approach, Asked, actuators_of
from .reading import Values, of_lanes

LEGS = 5
"""Times the rudder of a zigzag is reversed, as ``orders.ZigzagOrder`` does."""

MORE = 3
"""Times it is reversed besides, where there are several particles: those that are done stay under way until the last
one is."""

TURNED = 545.0 * DEG
"""Change of heading after which a turn is done; several particles turn twice as far, for the same reason."""

AT_ONCE = 2000
"""Lanes steered at one time; bounds the memory."""


@dataclass(frozen=True, eq=False)
class Sailed:
    """One manoeuvre by all particles.

    t         (n_samples,) [s]
    states    (n_particles, n_samples, 6)
    diverged  (n_particles,)
    order_s   time of the order [s]
    """

    t: FloatArray
    states: FloatArray
    diverged: BoolArray
    indices: Values
    order_s: float


class MemberLanes:
    """Members of any predictor as lanes; see ``steering.Lanes``.

    members  (n_lanes,) of each lane
    A predictor that is not ``Paired`` runs all its members on every lane.
    """

    def __init__(self, predictor: Predictor, members: IntArray, actuators: Sequence[Actuator | None]):
        self.predictor, self.members, self.actuators = predictor, members, actuators
        self.L_pp, self.inputs = predictor.L_pp, predictor.inputs

    def march(self, lanes: IntArray, cases: Cases) -> FloatArray:
        """See ``Lanes``."""
        own = self.members[lanes]
        if isinstance(self.predictor, Paired):
            return self.predictor.paired(cases, own)
        states = np.empty((len(cases), cases.t.shape[1], 6))
        for part in portions([cases.t.shape[1]] * len(cases), self.predictor.n_members):
            found = predicted(self.predictor, _some(cases, part))
            rows = np.arange(part.stop - part.start)
            lost = found.diverged[rows, own[part]]
            states[part] = np.where(lost[:, None, None], np.nan, found.states[rows, own[part]])
        return states


def sail(predictor: Predictor, manoeuvres: Sequence[Asked], approach: Approach) -> list[Sailed]:
    """Every particle, member of the predictor, through every manoeuvre, from straight ahead at the approach."""
    each = max(1, AT_ONCE // predictor.n_members)
    found = []
    for first in range(0, len(manoeuvres), each):
        some = manoeuvres[first : first + each]
        orders = _orders(some, approach, predictor.n_members)
        steered = steer_lanes(_lanes(predictor, len(some)), orders)
        for k, one in enumerate(some):
            found.append(_read(one, steered, orders, slice(k * predictor.n_members, (k + 1) * predictor.n_members)))
    return found


def _lanes(predictor: Predictor, times: int) -> Lanes:
    """All members, as many times as there are manoeuvres."""
    if isinstance(predictor, PhysicsPredictor):
        return ModelLanes(predictor.model, np.tile(predictor.theta, times), get_backend(predictor.backend))
    if isinstance(predictor, HybridPredictor):
        theta = np.tile(predictor.model.matrix(), times)
        return ModelLanes(predictor.model, theta, NumpyLanes(predictor.lanes))
    return MemberLanes(predictor, np.tile(np.arange(predictor.n_members), times), actuators_of(predictor))


def _orders(manoeuvres: Sequence[Asked], approach: Approach, n: int) -> Orders:
    """The same orders to all particles of a manoeuvre; turns and zigzags of several go on after they are done."""
    several = n > 1

    def lanes(values: Sequence[float]) -> FloatArray:
        return np.repeat(np.array(values, dtype=float), n)

    return Orders(
        speed=lanes([approach.speed] * len(manoeuvres)),
        n=lanes([approach.n] * len(manoeuvres)),
        rudder=lanes([one.rudder for one in manoeuvres]),
        check=lanes([np.inf if one.check is None else one.check for one in manoeuvres]),
        legs=lanes([1000 if one.check is None else LEGS + MORE * several for one in manoeuvres]).astype(np.int64),
        until=lanes([(1 + several) * TURNED if one.manoeuvre == "turning" else np.inf for one in manoeuvres]),
        revolutions=lanes([one.n for one in manoeuvres]),
    )


def _read(one: Asked, steered: Steered, orders: Orders, at: slice) -> Sailed:
    """A manoeuvre out of all that was steered: to where the last particle is done, and all are under way."""
    states, given, sound = steered.states[:, :, at], steered.orders[:, at], steered.sound[at]
    last = steered.end[at]
    side = np.where(orders.rudder[at] < 0.0, -1.0, 1.0)
    done = _done(one, states, given, last)
    until = np.where(np.isfinite(done), np.ceil(np.nan_to_num(done, posinf=0.0)), last).astype(np.int64)
    record = LaneRecord(steered.h[at], states, np.minimum(until, last), given, APPROACH, side)
    with np.errstate(all="ignore"):
        if one.manoeuvre == "turning":
            values = turning(record)
        else:
            values = stopping(record) if one.manoeuvre == "stopping" else zigzag(record, orders.check[at])
    final = until[sound & np.isfinite(done)]
    end = int(final.max()) if len(final) else int(last.max())
    if one.manoeuvre != "stopping" and sound.any():
        end = min(end, int(last[sound].min()))
    h = float(steered.h[at][0])
    t: FloatArray = h * np.arange(end + 1, dtype=np.float64)
    particles = np.ascontiguousarray(states[: end + 1].transpose(2, 0, 1))
    return Sailed(t, particles, ~sound, of_lanes(values, sound), h * APPROACH)


def _done(one: Asked, states: FloatArray, given: FloatArray, last: IntArray) -> FloatArray:
    """(n_particles,) sample at which each is done, infinite where it never is."""
    if one.manoeuvre == "stopping":
        stopped = states[np.minimum(last, len(states) - 1), 3, np.arange(len(last))] <= 0.0
        return np.where(stopped, last.astype(float), np.inf)
    if one.manoeuvre == "zigzag":
        ordered = given[LEGS] if len(given) > LEGS else np.full(len(last), np.nan)
        return np.asarray(np.nan_to_num(ordered, nan=np.inf))
    with np.errstate(invalid="ignore"):
        there = np.abs(states[:, 2]) >= TURNED
    return np.where(there.any(axis=0), np.argmax(there, axis=0).astype(float), np.inf)


def _some(cases: Cases, part: slice) -> Cases:
    return Cases(
        cases.t[part], cases.n_samples[part], cases.controls[part], cases.around[part], cases.initial[part],
        cases.target[part], cases.weight[part],
    )  # fmt: skip
