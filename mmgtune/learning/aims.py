"""What networks are trained for: a loss on short windows, and the score on long ones that chooses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import STATES
from ..backends.twins import jax_module
from ..networks.recurrent import Scales, Weights
from ..trial import Trial
from ..trial.pieces import windows
from .losses import acceleration_loss, trajectory_loss
from .rolling import roll
from .samples import samples_of
from .starting import accelerations_of
from .task import Task

Single = np.float32
"""Training is in single precision: half the memory, twice as quick, and far below the noise of any sensor."""

Roll = Callable[[Any, Any, Any, Any], Any]
"""Parameters, initial (n, 6), controls (T, n, n_inputs), wind (T, n, 2) -> states (T + 1, n, 6); traceable."""


class RecurrentAim:
    """A recurrent network on windows of trials, chosen by windows of ``restart`` [s] of others."""

    def __init__(self, task: Task, scales: Scales):
        jnp = jax_module().numpy
        options, recipe, learn = task.options, task.recipe, task.samples
        sigma = np.array([task.sigma[name] for name in STATES])
        self.starts: IntArray = learn.starts(options.horizon)
        self._states = jnp.asarray(learn.states, dtype=Single)
        self._controls = jnp.asarray(learn.controls, dtype=Single)
        self._wind = jnp.asarray(learn.wind, dtype=Single)
        self._scales = Scales(*(jnp.asarray(one, dtype=Single) for one in scales))
        self._sigma = jnp.asarray(sigma, dtype=Single)
        self._h, self._memory, self._horizon, self._recipe = learn.step, task.memory, options.horizon, recipe
        if recipe.loss == "acceleration":
            measured = accelerations_of(learn)
            self._measured = jnp.asarray(measured, dtype=Single)
            self._deviation = jnp.asarray(np.nanstd(measured, axis=0), dtype=Single)
        self._chooser = Chooser(self.roll, task.split.choose, task.inputs, learn.step, sigma, options.restart)

    def roll(self, w: Weights, initial: Any, controls: Any, wind: Any) -> Any:
        """See ``Roll``."""
        return roll(w, self._scales, initial, controls, wind, self._h, self._memory)

    def loss(self, w: Weights, starts: Any) -> Any:
        """See ``Aim``."""
        rows = starts[None, :] + jax_module().numpy.arange(self._horizon + 1)[:, None]
        states = from_origin(self._states[rows])
        controls, wind = self._controls[rows], self._wind[rows]
        if self._recipe.loss == "acceleration":
            return acceleration_loss(
                w, self._scales, states, controls, wind, self._memory, self._measured[rows], self._deviation
            )
        return trajectory_loss(w, self._scales, states, controls[:-1], wind[:-1], self._h, self._memory, self._sigma)

    def score(self, w: Weights) -> float:
        """See ``Aim``."""
        return self._chooser.score(w)


class Chooser:
    """L_MSE on windows of trials that were not learned from: its mean over kinds of manoeuvre, each alike."""

    def __init__(
        self,
        roll: Roll,
        trials: Sequence[Trial],
        inputs: Sequence[str],
        step: float,
        sigma: FloatArray,
        restart: float | None,
    ):
        jax = jax_module()
        pieces = [piece for trial in trials for piece in (windows(trial, restart) if restart else [trial])]
        cut = samples_of(pieces, inputs, step)
        lengths = np.diff(cut.first)
        T, n = int(lengths.max()), len(pieces)
        states = np.full((T, n, 6), np.nan)
        controls = np.zeros((T, n, len(inputs)))
        wind = np.zeros((T, n, 2))
        for k, (begin, length) in enumerate(zip(cut.first[:-1], lengths, strict=True)):
            part = slice(begin, begin + length)
            for whole, values in ((states, cut.states), (controls, cut.controls), (wind, cut.wind)):
                whole[:length, k] = values[part]
        kinds = np.array([piece.manoeuvre for piece in pieces])
        self._groups = [np.flatnonzero(kinds == kind) for kind in sorted(set(kinds.tolist()))]
        counts = np.isfinite(states)
        counts[0] = False
        initial = np.nan_to_num(states[0])
        states[:, :, :2] -= initial[:, :2]
        initial[:, :2] = 0.0
        given = tuple(
            jax.numpy.asarray(one, dtype=Single)
            for one in (initial, controls[:-1], wind[:-1], np.nan_to_num(states), counts, sigma)
        )
        self._counts = counts.sum(axis=0)

        def squares(
            parameters: Any, initial: Any, controls: Any, wind: Any, states: Any, counts: Any, sigma: Any
        ) -> Any:
            off = (roll(parameters, initial, controls, wind) - states) / sigma
            return jax.numpy.sum(jax.numpy.where(counts > 0.0, off * off, 0.0), axis=0)

        self._squares = jax.jit(squares)
        self._given = given

    def score(self, parameters: Any) -> float:
        """See ``Aim``."""
        squares = np.asarray(self._squares(parameters, *self._given), dtype=float)
        parts = []
        for of in self._groups:
            n = self._counts[of].sum(axis=0)
            parts.append(float(np.sum(squares[of].sum(axis=0)[n > 0] / n[n > 0])))
        total = float(np.mean(parts))
        return total if np.isfinite(total) else float("inf")


def from_origin(states: Any) -> Any:
    """Windows (T, n, 6) moved so that each begins at the origin: single precision has seven digits."""
    jnp = jax_module().numpy
    begin = states[:1, :, :2]
    return jnp.concatenate([states[..., :2] - begin, states[..., 2:]], axis=-1)
