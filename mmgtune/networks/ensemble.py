"""An ensemble of feed-forward networks: several that learned the same, and differ where the data say little."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import repeat
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import Cases
from ..errors import OptionError, Problem, among
from ..options.particles import SAMPLINGS
from ..predictor import Prediction, Predictor, Sampling
from ..threads import blas_on_one_thread
from .feedforward import Layers, Standards, begun, dense, member, scaled, standardised, through
from .marching import WIND, RunStepper, marched, paired
from .model import N_ACCELERATIONS, N_VELOCITIES, n_features, problems_of_ship
from .motion import Array, moved, observed

Single = np.float32
"""Layers are evaluated in single precision, in which they are kept and were trained; states are in double."""


@dataclass(frozen=True, eq=False)
class Part:
    """Networks of one purpose, one to a member: layers, and what inputs and outputs are standardised by."""

    layers: Layers
    standards: Standards

    @property
    def n_members(self) -> int:
        """Networks that there are."""
        return int(self.layers.W_in.shape[0])

    @property
    def n_in(self) -> int:
        """Numbers that go in."""
        return int(self.layers.W_in.shape[-2])

    @property
    def width(self) -> int:
        """Units of a hidden layer."""
        return int(self.layers.W_in.shape[-1])

    @property
    def n_layers(self) -> int:
        """Hidden layers."""
        return 1 + int(self.layers.W_hidden.shape[-3])

    def only(self, members: list[int]) -> Part:
        """The same of some members."""
        return Part(
            Layers(*(one[members] for one in self.layers)), Standards(*(one[members] for one in self.standards))
        )

    def problems(self, n_members: int, n_in: int, n_out: int) -> list[str]:
        """What is wrong with it, in words, where it should be of so many members, inputs and outputs."""
        first, hidden = np.shape(self.layers.W_in), np.shape(self.layers.W_hidden)
        if len(first) != 3 or len(hidden) != 4 or 0 in first:
            return [f"W_in has the shape {first}, W_hidden {hidden}"]
        width, between = first[2], hidden[1]
        of_in, of_out = (n_members, 1, n_in), (n_members, 1, n_out)
        layers = Layers(
            W_in=(n_members, n_in, width),
            b_in=(n_members, 1, width),
            W_hidden=(n_members, between, width, width),
            b_hidden=(n_members, between, 1, width),
            W_out=(n_members, width, n_out),
            b_out=of_out,
        )
        standards = Standards(of_in, of_in, of_out, of_out, of_out, of_out)
        found = []
        given = {**self.layers._asdict(), **self.standards._asdict()}
        for name, shape in {**layers._asdict(), **standards._asdict()}.items():
            if np.shape(given[name]) != shape:
                found.append(f"{name} has the shape {np.shape(given[name])}, not {shape}")
            elif not np.isfinite(given[name]).all():
                found.append(f"{name} holds numbers that are not finite")
            elif name.endswith("_deviation") and not (np.asarray(given[name]) > 0.0).all():
                found.append(f"{name} is not above 0")
        return found


@dataclass(frozen=True, eq=False)
class Ensemble:
    """Feed-forward networks that give the accelerations of one ship (Wakita, Akimoto and Maki).

    ship    id of the ship
    L_pp    her length between perpendiculars [m]
    inputs  what drives her, by names of ``inputs.INPUTS``, in the order of the features
    step    [s] of Euler's method and between the samples learned from
    motion  what is ``observed`` in, accelerations out
    start   the initial-state networks, which estimate velocities from the first observations of a run; None without
    facts   provenance, as of ``Network``
    """

    ship: str
    L_pp: float
    inputs: tuple[str, ...]
    step: float
    motion: Part
    start: Part | None = None
    facts: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raises ValueError where shapes do not fit together, or a number is not finite."""
        for problem in problems_of(self):
            raise ValueError(problem)

    def __repr__(self) -> str:
        """In a line."""
        part = self.motion
        return f"Ensemble({self.ship}: {part.n_members} x {part.n_layers} x {part.width} units, step {self.step:g} s)"

    @property
    def n_members(self) -> int:
        """Networks that there are."""
        return self.motion.n_members

    @property
    def initial(self) -> int:
        """Observations that an initial-state network looks at, 0 without one."""
        return self.start.n_in // N_VELOCITIES if self.start else 0

    def only(self, members: list[int]) -> Ensemble:
        """An ensemble of some of the members."""
        start = self.start.only(members) if self.start else None
        motion = self.motion.only(members)
        return Ensemble(self.ship, self.L_pp, self.inputs, self.step, motion, start, self.facts)

    def started(self, observations: FloatArray) -> FloatArray:
        """States (n_members, n, 6) at the start of runs, as the initial-state networks estimate them (eq. 22).

        observations  (initial, n, 6) states as measured from the start on, a step apart
        Raises ValueError where the ensemble has no such networks.
        """
        if self.start is None:
            raise ValueError("the ensemble has no initial-state networks")
        of = self.start
        return np.stack(
            [begun(observations, dense(member(of.layers, k)), member(of.standards, k)) for k in range(self.n_members)]
        )


def problems_of(ensemble: Ensemble) -> list[str]:
    """What is wrong with an ensemble, in words."""
    found = problems_of_ship(ensemble.inputs, ensemble.step, ensemble.L_pp)
    n = np.shape(ensemble.motion.layers.W_in)[0] if np.ndim(ensemble.motion.layers.W_in) else 0
    found += ensemble.motion.problems(n, n_features(ensemble.inputs), N_ACCELERATIONS)
    if ensemble.start is not None and np.ndim(ensemble.start.layers.W_in) < 2:
        found.append(f"W_in of the initial-state network has the shape {np.shape(ensemble.start.layers.W_in)}")
    if ensemble.start is not None and not found:
        if ensemble.start.n_in % N_VELOCITIES or ensemble.start.n_in < N_VELOCITIES:
            found.append(f"the initial-state network sees {ensemble.start.n_in} numbers, not {N_VELOCITIES} an instant")
        found += ensemble.start.problems(n, ensemble.start.n_in, N_VELOCITIES)
    return found


class EnsembleRun:
    """Particles on their way, each driven by a member at a time; see ``Run``.

    members  (n_particles,) of each step in turn: the member that gives the accelerations of each particle
    """

    def __init__(self, ensemble: Ensemble, states: FloatArray, members: Iterator[IntArray]):
        self.states: Array = np.array(states)
        self._members = members
        part = ensemble.motion
        self._standards = [member(part.standards, k) for k in range(part.n_members)]
        single = Layers(*(np.asarray(one, dtype=Single) for one in part.layers))
        self._layers = [dense(member(single, k)) for k in range(part.n_members)]

    def step(self, controls: FloatArray, around: FloatArray, h: float) -> None:
        """See ``Run``."""
        lanes = self.states.shape[:-1]
        seen = observed(
            self.states,
            np.broadcast_to(controls, (*lanes, controls.shape[-1])),
            np.broadcast_to(around[..., WIND], (*lanes, 2)),
        )
        rates = np.empty((*lanes, N_ACCELERATIONS))
        which = next(self._members)
        for k in np.unique(which):
            of = which == k
            x = seen[of].reshape(-1, seen.shape[-1])
            raw = through(standardised(x, self._standards[k]).astype(Single), self._layers[k])
            rates[of] = scaled(raw, self._standards[k]).reshape(-1, *lanes[1:], N_ACCELERATIONS)
        self.states = moved(self.states, rates, h)


@dataclass(frozen=True, eq=False)
class EnsemblePredictor:
    """All members of an ensemble; see ``Predictor``, ``Steerable``, ``Paired``, ``Fleet`` and ``Uncertain``.

    Every member starts from the given state: what comes before it is not in a case, and what comes after it, from which
    the initial-state networks learned to estimate it, is what is to be predicted.
    """

    ensemble: Ensemble

    @property
    def id(self) -> str:
        """Id of the ship."""
        return self.ensemble.ship

    @property
    def name(self) -> str:
        """Ship, and that it is an ensemble."""
        return f"{self.ensemble.ship} ensemble"

    @property
    def L_pp(self) -> float:
        """Length between perpendiculars [m]."""
        return self.ensemble.L_pp

    @property
    def n_members(self) -> int:
        """Networks that there are."""
        return self.ensemble.n_members

    @property
    def inputs(self) -> tuple[str, ...]:
        """What drives it."""
        return self.ensemble.inputs

    @property
    def method(self) -> str:
        """Its own step."""
        return f"ensemble, euler at {self.ensemble.step:g} s"

    @blas_on_one_thread
    def predict(self, cases: Cases) -> Prediction:
        """See ``Predictor``."""
        begin = np.broadcast_to(cases.initial, (self.n_members, *cases.initial.shape))
        run = EnsembleRun(self.ensemble, begin, repeat(np.arange(self.n_members)))
        return marched(run, cases, self.ensemble.step)

    @blas_on_one_thread
    def paired(self, cases: Cases, members: IntArray) -> FloatArray:
        """See ``Paired``."""
        return paired(EnsembleRun(self.ensemble, cases.initial[:, None], repeat(members)), cases, self.ensemble.step)

    @property
    def own_step(self) -> float:
        """See ``Fleet``."""
        return self.ensemble.step

    def under_way(self, states: FloatArray, controls: FloatArray) -> EnsembleRun:
        """See ``Fleet``."""
        return EnsembleRun(self.ensemble, states, repeat(np.arange(self.n_members)))

    def stepper(self, member: int, state: FloatArray, controls: FloatArray) -> RunStepper:
        """See ``Steerable``."""
        return _steered(self.ensemble, state, repeat(np.array([member])))

    def drawn(self, n: int, seed: int, sampling: Sampling = "TS-infinity") -> Predictor:
        """See ``Uncertain``.  Raises OptionError for another sampling, and for less than one particle."""
        if sampling not in SAMPLINGS:
            raise OptionError(Problem(f"unknown sampling '{sampling}'", "sampling", **among(str(sampling), SAMPLINGS)))
        if n < 1:
            raise OptionError(Problem(f"{n} particles", "particles", fix="write 1 or more"))
        return DrawnMembers(self.ensemble, n, seed, sampling)


@dataclass(frozen=True, eq=False)
class DrawnMembers:
    """Particles of an ensemble; see ``Predictor``, ``Steerable``, ``Paired`` and ``Fleet``.

    TS-infinity gives each particle one member for its whole path, TS1 another at each step (eq. 28; Chua et al. 2018).
    Members are dealt out evenly: with as many particles as members each has one.  In TS1 a particle changes members at
    the same steps in every case, so that it moves the same whatever cases stand beside it.
    """

    ensemble: Ensemble
    n_members: int
    seed: int
    sampling: Sampling

    @property
    def name(self) -> str:
        """Ship, and how particles are drawn."""
        return f"{self.ensemble.ship} ensemble, {self.sampling}"

    @property
    def L_pp(self) -> float:
        """Length between perpendiculars [m]."""
        return self.ensemble.L_pp

    @property
    def inputs(self) -> tuple[str, ...]:
        """What drives it."""
        return self.ensemble.inputs

    @property
    def method(self) -> str:
        """Its own step, and how particles are drawn."""
        return f"ensemble, euler at {self.ensemble.step:g} s, {self.sampling}"

    def members(self) -> Iterator[IntArray]:
        """(n_members,) of each step in turn: the network that drives each particle."""
        rng = np.random.default_rng([self.seed, 6])
        dealt = _dealt(rng, self.n_members, self.ensemble.n_members)
        while True:
            yield dealt
            if self.sampling == "TS1":
                dealt = _dealt(rng, self.n_members, self.ensemble.n_members)

    @blas_on_one_thread
    def predict(self, cases: Cases) -> Prediction:
        """See ``Predictor``."""
        if self.sampling == "TS-infinity":  # particles of one member are alike
            found = EnsemblePredictor(self.ensemble).predict(cases)
            which = next(self.members())
            return Prediction(found.states[:, which], found.diverged[:, which])
        begin = np.broadcast_to(cases.initial, (self.n_members, *cases.initial.shape))
        return marched(EnsembleRun(self.ensemble, begin, self.members()), cases, self.ensemble.step)

    @blas_on_one_thread
    def paired(self, cases: Cases, members: IntArray) -> FloatArray:
        """See ``Paired``."""
        of = (which[members] for which in self.members())
        return paired(EnsembleRun(self.ensemble, cases.initial[:, None], of), cases, self.ensemble.step)

    @property
    def own_step(self) -> float:
        """See ``Fleet``."""
        return self.ensemble.step

    def under_way(self, states: FloatArray, controls: FloatArray) -> EnsembleRun:
        """See ``Fleet``."""
        return EnsembleRun(self.ensemble, states, self.members())

    def stepper(self, member: int, state: FloatArray, controls: FloatArray) -> RunStepper:
        """See ``Steerable``."""
        return _steered(self.ensemble, state, (which[member : member + 1] for which in self.members()))


def _dealt(rng: np.random.Generator, n: int, n_members: int) -> IntArray:
    """(n,) members for particles: each as often as any other, as far as that goes, in an order drawn."""
    return np.asarray(rng.permutation(rng.permutation(n_members)[np.arange(n) % n_members]))


def _steered(ensemble: Ensemble, state: FloatArray, members: Iterator[IntArray]) -> RunStepper:
    """One particle under way."""
    return RunStepper(EnsembleRun(ensemble, np.asarray(state, dtype=float)[None, None], members), ensemble.step)
