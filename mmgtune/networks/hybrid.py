"""A model of forces with a network for what is left of the accelerations: equations, and the predictor of both."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends import Cases, Integrator
from ..backends.numpy_lanes import NUMPY, Arithmetic, LaneModel, Moment, NumpyLanes
from ..model import Model
from ..physics.quantities import State, Surroundings
from ..predictor import LaneFleet, Prediction, words_of
from ..profile import ShipProfile
from . import residual
from .residual import Ranges, ResidualWeights

N_MEMORY = 3
"""Velocities that are remembered."""


@dataclass(frozen=True, eq=False)
class Hybrid:
    """A ship profile and what a network adds to its accelerations.

    memory  time constant [s] of the lag by which the network remembers velocities
    facts   provenance, as of ``Network``
    """

    profile: ShipProfile
    weights: ResidualWeights
    ranges: Ranges
    memory: float
    facts: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raises ValueError where shapes do not fit together, or a number is not finite."""
        n, width = len(self.profile.arrangement.inputs) + 8, int(np.shape(self.weights.W_1)[-1])
        wanted = {"W_1": (n, width), "b_1": (width,), "W_2": (width, width), "b_2": (width,), "W_3": (width, 3)}
        wanted |= {"deviation": (n,), "largest": (n,), "accelerations": (3,), "mirrored": (n,)}
        for name, values in {**self.weights._asdict(), **self.ranges._asdict()}.items():
            if np.shape(values) != wanted[name]:
                raise ValueError(f"{name} has the shape {np.shape(values)}, not {wanted[name]}")
            if not np.isfinite(values).all():
                raise ValueError(f"{name} holds numbers that are not finite")
        if not (self.memory > 0.0 and np.isfinite(self.memory)):
            raise ValueError(f"the memory is {self.memory:g} s")
        if not ((np.asarray(self.ranges.deviation) > 0.0).all() and (np.asarray(self.ranges.largest) > 0.0).all()):
            raise ValueError("a feature is divided by 0")

    def __repr__(self) -> str:
        """In a line."""
        return f"Hybrid({self.profile.id}: {len(self.weights.b_1)} x 2 units beside the model of forces)"


def silent(profile: ShipProfile) -> Hybrid:
    """A profile as a hybrid whose network adds nothing."""
    n = len(profile.arrangement.inputs) + 8
    weights = ResidualWeights(np.zeros((n, 1)), np.zeros(1), np.zeros((1, 1)), np.zeros(1), np.zeros((1, 3)))
    return Hybrid(profile, weights, Ranges(np.ones(n), np.ones(n), np.ones(3), np.ones(n)), 1.0)


class HybridLanes(LaneModel):
    """A model whose accelerations a network adds to; its last states are the velocities it remembers."""

    def __init__(
        self,
        model: Model,
        theta: FloatArray,
        *,
        weights: ResidualWeights,
        ranges: Ranges,
        memory: float,
        on: Arithmetic = NUMPY,
    ):
        super().__init__(model, theta, on)
        self.weights, self.ranges, self.memory = weights, ranges, memory

    @property
    def looks_around(self) -> bool:
        """See ``LaneModel.looks_around``: the network sees the wind."""
        return True

    def begin(self, state: State, logged: Any, around: Surroundings) -> Moment:
        """See ``LaneModel.begin``; the ship has moved so for long."""
        now = super().begin(state, logged, around)
        return now._replace(s=self.on.states([*now.s, *now.s[3:6]]))

    def rates(self, s: Any, control: Any, around: Surroundings, h: Any) -> Any:
        """See ``LaneModel.rates``."""
        own = list(super().rates(s[:-N_MEMORY], control, around, h))
        added = self.added(s, control, around)
        own[3:6] = [one + added[..., k] for k, one in enumerate(own[3:6])]
        slopes = [
            self.of(residual.settling)(now, before, self.memory)
            for now, before in zip(s[3:6], s[-N_MEMORY:], strict=True)
        ]
        return self.on.states([*own, *slopes])

    def added(self, s: Any, control: Any, around: Surroundings) -> Any:
        """(n_lanes, 3) of u [m/s^2], v_m [m/s^2], r [rad/s^2] that the network gives."""
        return self.of(_added)(s, tuple(control), around, self.weights, self.ranges)


def _added(s: Any, control: Any, around: Any, weights: Any, ranges: Any) -> Any:
    """The network of states, inputs and wind as lanes are kept; see ``residual``."""
    velocities = np.stack([*s[3:6]], axis=-1)
    inputs = np.stack([one + 0.0 * s[3] for one in control], axis=-1)
    wind = np.stack([around.wind_north + 0.0 * s[3], around.wind_east + 0.0 * s[3]], axis=-1)
    settled = np.stack([*s[-3:]], axis=-1)
    x = residual.seen(velocities, inputs, wind, s[2], settled, ranges)
    return residual.accelerations(x, weights, ranges)


@dataclass(frozen=True, eq=False)
class HybridPredictor:
    """See ``Predictor``: the model of forces and the network march together, on NumPy."""

    hybrid: Hybrid
    integrator: Integrator = Integrator()

    @cached_property
    def model(self) -> Model:
        """The model of forces."""
        return Model(self.hybrid.profile)

    @property
    def id(self) -> str:
        """Id of the ship."""
        return self.hybrid.profile.id

    @property
    def name(self) -> str:
        """Ship, and that there is a network."""
        return f"{self.id} hybrid"

    @property
    def L_pp(self) -> float:
        """Length between perpendiculars [m]."""
        return self.model.L_pp

    @property
    def n_members(self) -> int:
        """One."""
        return 1

    @property
    def inputs(self) -> tuple[str, ...]:
        """What drives her."""
        return self.model.inputs

    @property
    def method(self) -> str:
        """The integrator."""
        return f"hybrid, {words_of(self.integrator)}"

    def predict(self, cases: Cases) -> Prediction:
        """See ``Predictor``."""
        run = NumpyLanes(self.lanes).run(
            self.model, self.model.matrix(), cases, integrator=self.integrator, keep_states=True
        )
        return Prediction(run.states, run.diverged)

    @property
    def own_step(self) -> None:
        """See ``Fleet``."""
        return None

    def under_way(self, states: FloatArray, controls: FloatArray) -> LaneFleet:
        """See ``Fleet``."""
        theta = np.repeat(self.model.matrix(), states.shape[1], axis=1)
        return LaneFleet(self.lanes(self.model, theta), states, controls)

    @property
    def lanes(self) -> Any:
        """What marches; see ``NumpyLanes``."""
        one = self.hybrid
        return partial(HybridLanes, weights=one.weights, ranges=one.ranges, memory=one.memory)
