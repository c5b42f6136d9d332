"""Manoeuvres stepped together with their helmsmen, side by side on NumPy."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends import LaneModel
from ..backends.cases import Integrator
from ..model import Model
from ..physics.quantities import UNKNOWN, State
from .sailing import ACTUATORS, Watch

RK4 = Integrator("rk4")


def step_by_step(model: Model, theta: FloatArray, watches: list[Watch]) -> None:
    """Sail every watch to its end, a lane to each; theta (n_rows, n_watches)."""
    fleet = _Fleet(model, model.without_readings(theta), list(watches))
    while fleet.under_way:
        fleet.step()


class _Fleet:
    """Manoeuvres side by side, a lane to each; lanes that are over are left behind once they are half of all.

    driven  (n_inputs, n_lanes) what drives the ships now
    """

    def __init__(self, model: Model, theta: FloatArray, watches: list[Watch]):
        self.model, self.theta, self.watches = model, theta, watches
        self.inputs = model.arrangement.inputs
        self.actuators = [model.profile.actuator(one.name) for one in self.inputs]
        self.h = np.array([one.h for one in watches])
        self.driven = np.array([[w.n_0 if one.role == "propeller" else 0.0 for w in watches] for one in self.inputs])
        self.steps = 0
        ship = LaneModel(model, theta[:, self._lanes])
        start = np.array([[0.0, 0.0, one.sailing.heading, one.U_0, 0.0, 0.0] for one in watches]).T
        self.run = ship.under_way(State(*start[:, self._lanes]), self._control())
        for k, shown in enumerate(self._shown()):
            watches[k].log(shown, self.driven[:, k])
            watches[k].late = [None if late is None else float(np.atleast_1d(late)[k]) for late in ship.late_log]

    @property
    def under_way(self) -> bool:
        """Whether any manoeuvre is not over."""
        return any(not watch.over for watch in self.watches)

    def step(self) -> None:
        """March by one step, each lane by its own, and log what is due."""
        seen = zip(self.watches, self._shown(), self._states(), strict=True)
        orders = np.array([watch.orders(self.steps, shown, state) for watch, shown, state in seen]).T
        for place, (one, actuator) in enumerate(zip(self.inputs, self.actuators, strict=True)):
            order = orders[ACTUATORS.index(one.role)]
            self.driven[place] = actuator.moved(self.driven[place], order, self.h) if actuator else order
        with np.errstate(all="ignore"):
            self.run.step(self._control(), UNKNOWN, self.h[self._lanes], RK4)
        self.steps += 1
        due = [k for k, watch in enumerate(self.watches) if watch.due(self.steps)]
        if due:
            shown, states = self._shown(), self._states()
            for k in due:
                self.watches[k].log(shown[k], self.driven[:, k])
                self.watches[k].look(bool(np.isfinite(states[k]).all()))
            self._leave_behind()

    def _leave_behind(self) -> None:
        kept = [k for k, watch in enumerate(self.watches) if not watch.over]
        if 0 < 2 * len(kept) <= len(self.watches):
            self.watches = [self.watches[k] for k in kept]
            self.theta, self.h, self.driven = self.theta[:, kept], self.h[kept], self.driven[:, kept]
            self.run.keep(LaneModel(self.model, self.theta[:, self._lanes]), kept if len(kept) > 1 else kept[0])

    @property
    def _lanes(self) -> Any:
        # A lane alone is plain numbers, which NumPy is several times as quick with.
        return 0 if len(self.watches) == 1 else slice(None)

    def _control(self) -> Any:
        return self.model.arrangement.control(*(np.array(values)[self._lanes] for values in self.driven))

    def _shown(self) -> FloatArray:
        """(n_lanes, 6) what the sensors show."""
        return np.atleast_2d(np.array(self.run.shown).T)

    def _states(self) -> FloatArray:
        """(n_lanes, n_states)."""
        return np.atleast_2d(self.run.s.T)
