"""Manoeuvres of few orders on a back end: run as if the last order stood, up to the step at which the helmsman gives
another, and run again with that.

In the end the inputs are those of a log, a sample at each of the helmsman's steps, and the motion is what the back end
makes of them: that of stepping, to rounding.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray
from ..backends import Backend, LaneModel
from ..backends.cases import pad
from ..model import Model
from .helmsmen import OF_FEW_ORDERS
from .sailing import ACTUATORS, Watch
from .stepping import RK4

AHEAD = 500
"""Steps a manoeuvre is run beyond its last order, at first; twice as many whenever no other is given in them."""

WORTH = 1000
"""Steps below which stepping takes no longer than reading the compiled simulator."""


def serves(watch: Watch) -> bool:
    """Whether a manoeuvre is worth it: of few orders and, perhaps, of many steps."""
    sailing = watch.sailing
    steady = sailing.engine is None and sailing.telegraph is None
    return type(sailing.helmsman) in OF_FEW_ORDERS and steady and watch.samples * watch.steps >= WORTH


def order_by_order(model: Model, theta: FloatArray, watches: Sequence[Watch], backend: Backend) -> None:
    """Sail every watch to its end, a lane to each; theta (n_rows, n_watches)."""
    ship = model.without_log(theta)
    late = LaneModel(model, theta).late_log
    ways = [_Way(watch, model) for watch in watches]
    for k, watch in enumerate(watches):
        watch.late = [None if one is None else float(np.broadcast_to(one, len(watches))[k]) for one in late]
    while True:
        under_way = [k for k, way in enumerate(ways) if not way.watch.over]
        if not under_way:
            break
        cases = pad(*zip(*(ways[k].case() for k in under_way), strict=True))
        found = backend.run(model, ship[:, under_way], cases, integrator=RK4, keep_states=True, paired=True).states
        assert found is not None  # asked for
        for k, shown in zip(under_way, found[:, 0], strict=True):
            ways[k].follow(shown)


class _Way:
    """One manoeuvre: the inputs that follow from the orders so far, and how far it has been followed.

    controls  (n_steps + 1, n_inputs), up to step ``length``
    orders    last given, at step ``since``
    at        last step at which the helmsman was asked
    """

    def __init__(self, watch: Watch, model: Model):
        self.watch = watch
        self.roles = [ACTUATORS.index(one.role) for one in model.arrangement.inputs]
        self.actuators = [model.profile.actuator(name) for name in model.inputs]
        self.start = np.array([0.0, 0.0, watch.sailing.heading, watch.U_0, 0.0, 0.0])
        resting = 0.0, watch.n_0, 0.0
        self.total = watch.samples * watch.steps
        self.controls = np.tile([resting[role] for role in self.roles], (self.total + 1, 1))
        watch.log(self.start, self.controls[0])
        if not watch.over:
            self._give(0, watch.orders(0, self.start, self.start))

    def _give(self, step: int, orders: tuple[float, ...]) -> None:
        self.at, self.since, self.orders = step, step, orders
        self.length = min(step + AHEAD, self.total)

    def case(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Times, inputs and first state of a run with these orders."""
        held, elapsed = self.controls[self.since], self.watch.h * np.arange(1.0, self.length - self.since + 1.0)
        for k, (role, actuator) in enumerate(zip(self.roles, self.actuators, strict=True)):
            order = self.orders[role]
            moved = actuator.moved(held[k], order, elapsed) if actuator else order
            self.controls[self.since + 1 : self.length + 1, k] = moved
        return self.watch.h * np.arange(self.length + 1.0), self.controls[: self.length + 1], self.start

    def follow(self, shown: FloatArray) -> None:
        """Keep watch over what is new of a run, (n_samples, 6), up to the next order."""
        watch = self.watch
        for step in range(self.at + 1, self.length + 1):
            if watch.due(step):
                watch.log(shown[step], self.controls[step])
                watch.look(bool(np.isfinite(shown[step]).all()))
                if watch.over:
                    return
            orders = watch.orders(step, shown[step], shown[step])
            if orders != self.orders:
                self._give(step, orders)
                return
        self.at, self.length = self.length, min(2 * self.length, self.total)
