"""A hybrid and recurrent networks that drive one ship together: equations, and the predictor of both.

Their errors on unseen runs are nearly independent, so that the mean of their accelerations errs less than either.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends import Cases
from ..backends.numpy_lanes import Moment
from ..model import Model
from ..physics.quantities import State, Surroundings
from ..predictor import Prediction
from ..threads import blas_on_one_thread
from .hybrid import Hybrid, HybridLanes
from .marching import RunStepper, marched
from .model import Network
from .motion import Array
from .predicting import NetworkRun

N_STATES = len(State._fields)


@dataclass(frozen=True, eq=False)
class Mixture:
    """Two ways to compute the accelerations of one ship, and how much each counts.

    hybrid   model of forces; its network may add nothing
    network  recurrent networks, of which all members count alike
    share    of the networks in the accelerations
    facts    provenance, as of ``Network``
    """

    hybrid: Hybrid
    network: Network
    share: float
    facts: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raises ValueError where both do not fit together."""
        if not 0.0 < self.share < 1.0:
            raise ValueError(f"the share of the networks is {self.share:g}, not between 0 and 1")
        ship, inputs = self.hybrid.profile.id, Model(self.hybrid.profile).inputs
        if self.network.ship != ship:
            raise ValueError(f"the networks are of {self.network.ship}, the model of forces is of {ship}")
        if self.network.inputs != inputs:
            raise ValueError(f"{', '.join(self.network.inputs)} drive the networks, {', '.join(inputs)} the other")

    def __repr__(self) -> str:
        """In a line."""
        one = self.network
        return f"Mixture({one.ship}: hybrid, and {one.n_members} networks with a share of {self.share:g})"


class MixtureRun:
    """See ``Run``: one member.  The networks see and move what the sensors show, the model of forces the ship.

    A step is that of Euler's method for both; where each would bring the ship, the weighted mean is where she goes.
    """

    def __init__(self, mixture: Mixture, states: FloatArray):
        self.states: Array = np.array(states)
        self._share = mixture.share
        members = mixture.network.n_members
        self._networks = NetworkRun(mixture.network, np.broadcast_to(states[0], (members, *states.shape[1:])))
        one = mixture.hybrid
        model = Model(one.profile)
        self._lanes = HybridLanes(model, model.matrix(), weights=one.weights, ranges=one.ranges, memory=one.memory)
        self._now: Moment | None = None

    def step(self, controls: FloatArray, around: FloatArray, h: float) -> None:
        """See ``Run``."""
        lanes = self._lanes
        shown = self.states[0]
        logged = lanes.arrangement.control(*np.broadcast_to(controls, (len(shown), controls.shape[-1])).T)
        here = Surroundings(*np.broadcast_to(around, (len(shown), around.shape[-1])).T)
        if self._now is None:
            now = lanes.begin(lanes.unsensed(State(*shown.T)), logged, here)
        else:
            chain = lanes.moved(self._now.chain, logged, self._now.chain, h)
            now = self._now._replace(chain=chain, around=here)
        s = now.s + h * lanes.rates(now.s, now.chain[-1], here, h)
        self._networks.states = np.broadcast_to(shown, self._networks.states.shape)
        self._networks.step(controls, around, h)
        there = lanes.unsensed(State(*self._networks.states.mean(axis=0).T))
        s[:N_STATES] += self._share * (np.stack(there) - s[:N_STATES])
        self._now = now._replace(s=s)
        self.states = np.stack(lanes.sensed(State(*s[:N_STATES])), axis=-1)[None]


@dataclass(frozen=True, eq=False)
class MixturePredictor:
    """See ``Predictor`` and ``Steerable``: it marches in the step of its networks, on NumPy."""

    mixture: Mixture

    @cached_property
    def model(self) -> Model:
        """The model of forces."""
        return Model(self.mixture.hybrid.profile)

    @property
    def id(self) -> str:
        """Id of the ship."""
        return self.mixture.network.ship

    @property
    def name(self) -> str:
        """Ship, and that it is a mixture."""
        return f"{self.id} mixture"

    @property
    def L_pp(self) -> float:
        """Length between perpendiculars [m]."""
        return self.mixture.network.L_pp

    @property
    def n_members(self) -> int:
        """One."""
        return 1

    @property
    def inputs(self) -> tuple[str, ...]:
        """What drives her."""
        return self.mixture.network.inputs

    @property
    def method(self) -> str:
        """The step of its networks."""
        return f"mixture, euler at {self.mixture.network.step:g} s"

    @blas_on_one_thread
    def predict(self, cases: Cases) -> Prediction:
        """See ``Predictor``."""
        return marched(MixtureRun(self.mixture, cases.initial[None]), cases, self.mixture.network.step)

    def stepper(self, member: int, state: FloatArray, controls: FloatArray) -> RunStepper:
        """See ``Steerable``."""
        return RunStepper(
            MixtureRun(self.mixture, np.asarray(state, dtype=float)[None, None]), self.mixture.network.step
        )
