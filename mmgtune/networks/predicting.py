"""A trained network as a predictor, on NumPy alone: who uses a model needs no library that trained it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import Cases
from ..backends.cases import SPEED_LIMIT
from ..physics.quantities import Surroundings
from ..predictor import Prediction
from ..threads import blas_on_one_thread
from .model import Network
from .recurrent import Array, accelerations, features, moved, projected, remembered, truncated

WIND = tuple(Surroundings._fields.index(name) for name in ("wind_north", "wind_east"))


@dataclass(frozen=True, eq=False)
class NetworkPredictor:
    """All members of a network; see ``Predictor``, ``Steerable`` and ``Paired``.

    It marches in its own step by Euler's method, as it was trained.  Inputs and wind are interpolated linearly to its
    steps, and the states back to the samples of a case.  The memory begins at zero with each case.  Where no wind was
    measured the air is still.
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
        initial = np.broadcast_to(cases.initial, (self.n_members, *cases.initial.shape))
        return self._at_samples(self._march(self.network, initial, *self._driven(cases)), cases)

    @blas_on_one_thread
    def paired(self, cases: Cases, members: IntArray) -> FloatArray:
        """See ``Paired``."""
        controls, wind = self._driven(cases)
        fine = self._march(self.network.only(members), cases.initial[:, None], controls[:, None], wind[:, None])
        found = self._at_samples(fine[None, :, 0], cases)
        return np.asarray(np.where(found.diverged[:, :, None], np.nan, found.states[:, 0]))

    def _driven(self, cases: Cases) -> tuple[FloatArray, FloatArray]:
        """Inputs (n_cases, n_steps, n_inputs) and wind (n_cases, n_steps, 2) at its own steps."""
        h, span = self.network.step, cases.t - cases.t[:, :1]
        n_steps = max(1, math.ceil(float(span.max(initial=0.0)) / h - 1e-9))
        return (
            _on_grid(span, cases.controls, cases.n_samples, h, n_steps),
            _on_grid(span, cases.around[:, :, WIND], cases.n_samples, h, n_steps),
        )

    def _march(self, network: Network, initial: FloatArray, controls: FloatArray, wind: FloatArray) -> FloatArray:
        """States (n_members, n_lanes, n_steps + 1, 6) from initial ones (n_members, n_lanes, 6)."""
        n_steps = controls.shape[-2]
        run = NetworkRun(network, initial)
        fine = np.empty((*initial.shape[:2], n_steps + 1, 6))
        fine[:, :, 0] = run.states
        with np.errstate(all="ignore"):
            for k in range(n_steps):
                run.step(controls[..., k, :], wind[..., k, :], self.network.step)
                fine[:, :, k + 1] = run.states
        return fine

    def _at_samples(self, fine: FloatArray, cases: Cases) -> Prediction:
        """What (n_members, n_cases, n_steps + 1, 6) is at the samples of the cases."""
        n_steps = fine.shape[2] - 1
        place = (cases.t - cases.t[:, :1]) / self.network.step
        before = np.minimum(place.astype(np.int64), n_steps - 1)
        share = (place - before)[None, :, :, None]
        rows = np.arange(len(cases))[:, None]
        with np.errstate(all="ignore"):
            states = (1.0 - share) * fine[:, rows, before] + share * fine[:, rows, before + 1]
        states = np.where(share == 0.0, fine[:, rows, before], states)  # 0 times infinite is no number
        counts = np.arange(cases.t.shape[1]) < cases.n_samples[:, None]
        sound = np.isfinite(states).all(axis=-1) & (np.hypot(states[..., 3], states[..., 4]) < SPEED_LIMIT)
        diverged = np.any(~sound & counts, axis=-1)
        return Prediction(np.ascontiguousarray(states.transpose(1, 0, 2, 3)), np.asarray(diverged).T)

    def stepper(self, member: int, state: FloatArray, controls: FloatArray) -> NetworkStepper:
        """See ``Steerable``."""
        return NetworkStepper(self.network.member(member), state, controls)


class NetworkRun:
    """Networks on their way, with what they remember.

    states  (n_members, n_lanes, 6)
    """

    def __init__(self, network: Network, states: FloatArray):
        self.network = network
        self.states: Array = np.array(states)
        members, lanes = self.states.shape[:2]
        rows = lanes if network.memory is None else (network.memory - 1) * lanes
        self._held: Array = np.zeros((members, rows, network.width))

    def step(self, controls: FloatArray, wind: FloatArray, h: float) -> None:
        """March by h [s] with inputs (n_lanes, n_inputs) and wind (n_lanes, 2) over ground [m/s]."""
        net = self.network
        lanes = self.states.shape[:-1]
        seen = features(
            self.states,
            np.broadcast_to(controls, (*lanes, controls.shape[-1])),
            np.broadcast_to(wind, (*lanes, 2)),
            net.scales,
        )
        part = projected(seen, net.weights)
        if net.memory is None:
            first = self._held = remembered(part, self._held, net.weights)
        else:
            first, self._held = truncated(part, self._held, net.weights)
        self.states = moved(self.states, accelerations(first, net.weights, net.scales), h)


class NetworkStepper:
    """One member under way, steered while it moves, in still air; see ``Stepper``."""

    def __init__(self, network: Network, state: FloatArray, controls: FloatArray):
        self._run = NetworkRun(network, np.asarray(state, dtype=float)[None, None])
        self._step = network.step

    def step(self, now: FloatArray, then: FloatArray, h: float) -> FloatArray:
        """See ``Stepper``; the step is cut into equal parts as near as can be to those of the training."""
        parts = max(1, round(h / self._step))
        with np.errstate(all="ignore"):
            for k in range(parts):
                at = now + k / parts * (then - now)
                self._run.step(at[None], np.zeros((1, 2)), h / parts)
        return np.array(self._run.states[0, 0])


def _on_grid(span: FloatArray, values: FloatArray, n_samples: IntArray, h: float, n_steps: int) -> FloatArray:
    """(n_cases, n_steps, ...) values at multiples of h [s] from the start of each case; after its end its last."""
    grid = h * np.arange(n_steps)
    found = np.empty((len(span), n_steps, values.shape[-1]))
    for into, t, columns, n in zip(found, span, values, n_samples, strict=True):
        for k, column in enumerate(columns.T):
            into[:, k] = np.interp(grid, t[:n], column[:n])
    return found
