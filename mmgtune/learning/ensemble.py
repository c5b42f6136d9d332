"""An ensemble's networks on windows of trials: where they begin, their roll-out on JAX, and what is made small.

Wakita, Akimoto and Maki; equation numbers are that paper's.
"""

from __future__ import annotations

from copy import copy
from typing import Any, NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends.twins import jax_module, twin
from ..networks import feedforward, motion
from ..networks.feedforward import Layers, Standards, dense, sequence, through
from ..networks.model import N_ACCELERATIONS, N_VELOCITIES
from .choosing import Single, from_origin
from .samples import Samples, samples_of
from .starting import differences, features_of
from .task import EnsembleTask

NORMAL = 10_000
"""Standard-normal inputs by which the outputs of a network that begins are standardised (eq. 13)."""

WATCHED = 512
"""Windows that a training is watched by, at most."""


class Trainable(NamedTuple):
    """What is trained of a member: theta and theta' of eq. 27; no start where windows begin as observed."""

    motion: Layers
    start: Layers | None


class MemberStandards(NamedTuple):
    """What is not trained of a member."""

    motion: Standards
    start: Standards | None


class EnsembleAim:
    """The likelihood of observed velocities on windows of trials (eq. 27), for one member; see ``Aim``.

    data  samples, and the member's standards: all that differs between members
    """

    def __init__(self, task: EnsembleTask):
        options, learn = task.options, task.samples
        self.starts: IntArray = learn.starts(options.horizon)
        self._h, self._horizon, self._initial = learn.step, options.horizon, options.initial
        self._sigma = task.noise.astype(Single)
        self.data: dict[str, Any] = self._columns(learn)
        kept = task.split.choose
        watched = samples_of(kept, task.inputs, learn.step) if kept else learn
        self._watched_starts = apart(watched, options.horizon) if kept else apart(learn, options.horizon)
        self._watched = self._columns(watched) if kept else self.data
        if not len(self._watched_starts):  # runs kept back that are shorter than a window
            self._watched, self._watched_starts = self.data, apart(learn, options.horizon)
        self._judge = jax_module().jit(self.loss)

    def of(self, standards: MemberStandards) -> EnsembleAim:
        """The aim of a member with these standards."""
        found = copy(self)
        given = jax_module().tree.map(lambda one: jax_module().numpy.asarray(one, dtype=Single), standards)
        found.data = {**self.data, "standards": given}
        return found

    def loss(self, w: Trainable, starts: Any, data: Any) -> Any:
        """See ``Aim``: mean over windows and their samples of the squared errors of velocities over the noise."""
        numpy = jax_module().numpy
        rows = starts[None, :] + numpy.arange(self._horizon + 1)[:, None]
        states = from_origin(data["states"][rows])
        controls, wind = data["controls"][rows[:-1]], data["wind"][rows[:-1]]
        begin = begun(w, data["standards"], states[: self._initial] if self._initial else states[:1])
        found = rolled(w, data["standards"], begin, controls, wind, self._h)
        off = (found[..., 3:] - states[..., 3:]) / self._sigma
        return numpy.mean(numpy.sum(off * off, axis=-1))

    def judged(self, w: Trainable) -> dict[str, float]:
        """See ``Aim``: the loss on windows of the runs kept back, or of those learned from; it chooses nothing."""
        data = {**self._watched, "standards": self.data["standards"]}
        found = float(self._judge(w, jax_module().numpy.asarray(self._watched_starts), data))
        return {"score": found if np.isfinite(found) else float("inf")}

    @staticmethod
    def _columns(samples: Samples) -> dict[str, Any]:
        numpy = jax_module().numpy
        return {name: numpy.asarray(getattr(samples, name), dtype=Single) for name in ("states", "controls", "wind")}


def begun(w: Trainable, standards: MemberStandards, observations: Any) -> Any:
    """States (n, 6) that windows with these observations (K, n, 6) begin at: eq. 22, or the first as observed."""
    if w.start is None or standards.start is None:
        return observations[0]
    return twin(feedforward.begun)(observations, dense(w.start), standards.start)


def rolled(w: Trainable, standards: MemberStandards, begin: Any, controls: Any, wind: Any, h: float) -> Any:
    """States (T + 1, n, 6) from ``begin`` (n, 6) by Euler's method: eq. 19.

    controls  (T, n, n_inputs); wind (T, n, 2) over ground
    """
    jax = jax_module()
    see, move, evaluate = twin(motion.observed), twin(motion.moved), twin(feedforward.evaluated)
    layers = dense(w.motion)

    def step(states: Any, given: Any) -> Any:
        states = move(states, evaluate(see(states, *given), layers, standards.motion), h)
        return states, states

    _, found = jax.lax.scan(step, begin, (controls, wind))
    return jax.numpy.concatenate([begin[None], found])


def first_member(task: EnsembleTask, seed: int) -> tuple[Trainable, MemberStandards]:
    """A member before its training, and what its inputs and outputs are standardised by (eq. 12-14)."""
    rng = np.random.default_rng([seed, 7])
    options, samples = task.options, task.samples
    seen = features_of(samples)[samples.whole]
    rates = differences(samples)
    layers = first_layers(seen.shape[1], options.width, options.layers, N_ACCELERATIONS, rng)
    mean, deviation = untrained(layers, rng)
    standards = Standards(*moments(seen), mean, deviation, *moments(rates))
    if not options.initial:
        return Trainable(layers, None), MemberStandards(standards, None)
    rows = apart(samples, options.horizon, most=NORMAL) + np.arange(options.initial)[:, None]
    before = sequence(samples.states[rows])
    start = first_layers(before.shape[1], options.width, options.layers, N_VELOCITIES, rng)
    nothing, one = np.zeros((1, N_VELOCITIES)), np.ones((1, N_VELOCITIES))
    # Outputs in units of the noise, and not standardised: a start begins nearly as it is observed.
    of_start = Standards(*moments(before), nothing, one, nothing, task.noise[None])
    return Trainable(layers, start), MemberStandards(standards, of_start)


def first_layers(n_in: int, width: int, n_layers: int, n_out: int, rng: np.random.Generator) -> Layers:
    """Weights of one network, all within 1 over the root of the numbers that go into their layer: PyTorch's default."""

    def drawn(*shape: int, of: int) -> FloatArray:
        return np.asarray(rng.uniform(-1.0, 1.0, shape) / np.sqrt(of))

    return Layers(
        W_in=drawn(n_in, width, of=n_in),
        b_in=drawn(1, width, of=n_in),
        W_hidden=drawn(n_layers - 1, width, width, of=width),
        b_hidden=drawn(n_layers - 1, 1, width, of=width),
        W_out=drawn(width, n_out, of=width),
        b_out=drawn(1, n_out, of=width),
    )


def untrained(layers: Layers, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Mean and deviation (1, n_out) of what a network gives for standard-normal inputs (eq. 13)."""
    return moments(through(rng.standard_normal((NORMAL, layers.W_in.shape[0])), dense(layers)))


def moments(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean and deviation (1, n) of columns (n_rows, n); the deviation 1 of what never varies."""
    deviation = np.std(values, axis=0, keepdims=True)
    return np.mean(values, axis=0, keepdims=True), np.where(deviation > 0.0, deviation, 1.0)


def apart(samples: Samples, horizon: int, most: int = WATCHED) -> IntArray:
    """Rows at which windows begin that do not overlap, thinned evenly to ``most``."""
    found: list[int] = []
    for start in samples.starts(horizon).tolist():
        if not found or start >= found[-1] + horizon:
            found.append(start)
    return np.array(found[:: max(1, -(-len(found) // most))], dtype=np.int64)
