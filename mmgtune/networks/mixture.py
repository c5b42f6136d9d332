"""A hybrid and recurrent networks that drive one ship together: equations, and the predictor of both.

Their errors on unseen runs are nearly independent, so that the mean of their accelerations errs less than either.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from .. import limits
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

    hybrid    model of forces; its network may add nothing
    networks  recurrent networks of one step, with memories of any length, mirrored or not; all members of all of them
              count alike
    share     of the networks in the accelerations
    facts     provenance, as of ``Network``
    """

    hybrid: Hybrid
    networks: tuple[Network, ...]
    share: float
    facts: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raises ValueError where they do not fit together."""
        if not 0.0 < self.share < 1.0:
            raise ValueError(f"the share of the networks is {self.share:g}, not between 0 and 1")
        if not self.networks:
            raise ValueError("there are no networks")
        if too_many := limits.NETWORKS.problem(len(self.networks), ""):
            raise ValueError(too_many.what)
        ship, inputs = self.hybrid.profile.id, Model(self.hybrid.profile).inputs
        for one in self.networks:
            if one.ship != ship:
                raise ValueError(f"the networks are of {one.ship}, the model of forces is of {ship}")
            if one.inputs != inputs:
                raise ValueError(f"{', '.join(one.inputs)} drive the networks, {', '.join(inputs)} the other")
        steps = sorted({one.step for one in self.networks})
        if len(steps) > 1:  # their memories count samples
            several = " and ".join(f"{step:.12g} s" for step in steps)
            raise ValueError(f"the networks have steps of {several}, and none can march in that of another")

    def __repr__(self) -> str:
        """In a line."""
        members = " + ".join(str(one.n_members) for one in self.networks)
        return f"Mixture({self.hybrid.profile.id}: hybrid, and {members} networks with a share of {self.share:g})"

    @property
    def step(self) -> float:
        """Of its networks [s]."""
        return self.networks[0].step


class MixtureRun:
    """See ``Run``: one member.  The networks see and move what the sensors show, the model of forces the ship.

    A step is that of Euler's method for both; where each would bring the ship, the weighted mean is where she goes.
    """

    def __init__(self, mixture: Mixture, states: FloatArray):
        self.states: Array = np.array(states)
        self._share = mixture.share
        self._networks = [
            NetworkRun(one, np.broadcast_to(states[0], (one.n_members, *states.shape[1:]))) for one in mixture.networks
        ]
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
        for run in self._networks:
            run.states = np.broadcast_to(shown, run.states.shape)
            run.step(controls, around, h)
        members = np.concatenate([run.states for run in self._networks])
        there = lanes.unsensed(State(*members.mean(axis=0).T))
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
        return self.mixture.hybrid.profile.id

    @property
    def name(self) -> str:
        """Ship, and that it is a mixture."""
        return f"{self.id} mixture"

    @property
    def L_pp(self) -> float:
        """Length between perpendiculars [m]."""
        return self.mixture.networks[0].L_pp

    @property
    def n_members(self) -> int:
        """One."""
        return 1

    @property
    def inputs(self) -> tuple[str, ...]:
        """What drives her."""
        return self.mixture.networks[0].inputs

    @property
    def method(self) -> str:
        """The step of its networks."""
        return f"mixture, euler at {self.mixture.step:g} s"

    @blas_on_one_thread
    def predict(self, cases: Cases) -> Prediction:
        """See ``Predictor``."""
        return marched(MixtureRun(self.mixture, cases.initial[None]), cases, self.mixture.step)

    def stepper(self, member: int, state: FloatArray, controls: FloatArray) -> RunStepper:
        """See ``Steerable``."""
        run = MixtureRun(self.mixture, np.asarray(state, dtype=float)[None, None])
        return RunStepper(run, self.mixture.step)
