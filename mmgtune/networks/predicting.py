"""A trained network as a predictor, on NumPy alone: who uses a model needs no library that trained it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import Cases
from ..predictor import Prediction
from ..threads import blas_on_one_thread
from .marching import WIND, RunStepper, marched, paired
from .model import Network
from .motion import Array, moved
from .recurrent import accelerations, alike, both_sides, features, projected, remembered, truncated


@dataclass(frozen=True, eq=False)
class NetworkPredictor:
    """All members of a network; see ``Predictor``, ``Steerable``, ``Paired`` and ``Fleet``.

    It marches in its own step by Euler's method, as it was trained.  The memory begins at zero with each case.
    """

    network: Network

    @property
    def id(self) -> str:
        """Id of the ship."""
        return self.network.ship

    @property
    def name(self) -> str:
        """Ship and type."""
        return " ".join(filter(None, (self.network.ship, str(self.network.facts.get("type", "network")))))

    @property
    def L_pp(self) -> float:
        """Length between perpendiculars [m]."""
        return self.network.L_pp

    @property
    def n_members(self) -> int:
        """One for each seed."""
        return self.network.n_members

    @property
    def inputs(self) -> tuple[str, ...]:
        """What drives it."""
        return self.network.inputs

    @property
    def method(self) -> str:
        """Its own step."""
        return f"network, euler at {self.network.step:g} s"

    @blas_on_one_thread
    def predict(self, cases: Cases) -> Prediction:
        """See ``Predictor``."""
        begin = np.broadcast_to(cases.initial, (self.n_members, *cases.initial.shape))
        return marched(NetworkRun(self.network, begin), cases, self.network.step)

    @blas_on_one_thread
    def paired(self, cases: Cases, members: IntArray) -> FloatArray:
        """See ``Paired``."""
        run = NetworkRun(self.network.only(members), cases.initial[:, None])
        return paired(run, cases, self.network.step)

    @property
    def own_step(self) -> float:
        """See ``Fleet``."""
        return self.network.step

    def under_way(self, states: FloatArray, controls: FloatArray) -> NetworkRun:
        """See ``Fleet``."""
        return NetworkRun(self.network, states)

    def stepper(self, member: int, state: FloatArray, controls: FloatArray) -> RunStepper:
        """See ``Steerable``."""
        run = NetworkRun(self.network.member(member), np.asarray(state, dtype=float)[None, None])
        return RunStepper(run, self.network.step)


class NetworkRun:
    """See ``Run``."""

    def __init__(self, network: Network, states: FloatArray):
        self.network = network
        self.states: Array = np.array(states)
        members, lanes = self.states.shape[:2]
        self._signs = network.signs
        if self._signs is not None:
            lanes *= 2
        rows = lanes if network.memory is None else (network.memory - 1) * lanes
        self._held: Array = np.zeros((members, rows, network.width))

    def step(self, controls: FloatArray, around: FloatArray, h: float) -> None:
        """See ``Run``."""
        net = self.network
        lanes = self.states.shape[:-1]
        seen = features(
            self.states,
            np.broadcast_to(controls, (*lanes, controls.shape[-1])),
            np.broadcast_to(around[..., WIND], (*lanes, 2)),
            net.scales,
        )
        if self._signs is not None:
            seen = both_sides(seen, self._signs)
        part = projected(seen, net.weights)
        if net.memory is None:
            first = self._held = remembered(part, self._held, net.weights)
        else:
            first, self._held = truncated(part, self._held, net.weights)
        rates = accelerations(first, net.weights, net.scales)
        self.states = moved(self.states, rates if self._signs is None else alike(rates), h)
