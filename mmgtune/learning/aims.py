"""What networks are trained for: a loss on short windows, and the score on long ones that chooses, where one does."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import IntArray
from ..backends import STATES
from ..backends.twins import jax_module
from ..networks.marching import WIND
from ..networks.recurrent import Scales, Weights
from .choosing import Chooser, Single, from_origin, squares_of
from .losses import acceleration_loss, trajectory_loss
from .rolling import roll
from .starting import accelerations_of
from .task import Task


class RecurrentAim:
    """A recurrent network on windows of trials, chosen by windows of ``restart`` [s] of others if there are some."""

    def __init__(self, task: Task, scales: Scales):
        jnp = jax_module().numpy
        options, recipe, learn = task.options, task.recipe, task.samples
        sigma = np.array([task.sigma[name] for name in STATES])
        self.starts: IntArray = learn.starts(options.horizon)
        measured = accelerations_of(learn) if recipe.loss == "acceleration" else np.zeros((0, 3))
        self.data = {
            "states": jnp.asarray(learn.states, dtype=Single),
            "controls": jnp.asarray(learn.controls, dtype=Single),
            "wind": jnp.asarray(learn.wind, dtype=Single),
            "accelerations": jnp.asarray(measured, dtype=Single),
        }
        self._scales = Scales(*(jnp.asarray(one, dtype=Single) for one in scales))
        self._sigma = jnp.asarray(sigma, dtype=Single)
        self._signs = None if task.signs is None else jnp.asarray(task.signs, dtype=Single)
        self._h, self._memory, self._horizon, self._recipe = learn.step, task.memory, options.horizon, recipe
        if recipe.loss == "acceleration":
            self._deviation = jnp.asarray(np.nanstd(measured, axis=0), dtype=Single)
        self._chooser = None
        if choose := task.split.choose:
            squares = squares_of(self._of_windows)
            self._chooser = Chooser(squares, choose, task.inputs, learn.step, sigma, restart=options.restart)

    def _of_windows(self, w: Weights, initial: Any, controls: Any, around: Any) -> Any:
        """See ``Roll``."""
        return roll(w, self._scales, initial, controls[:-1], around[:-1, :, WIND], self._h, self._memory, self._signs)

    def loss(self, w: Weights, starts: Any, data: Any) -> Any:
        """See ``Aim``."""
        rows = starts[None, :] + jax_module().numpy.arange(self._horizon + 1)[:, None]
        states = from_origin(data["states"][rows])
        controls, wind = data["controls"][rows], data["wind"][rows]
        if self._recipe.loss == "acceleration":
            measured = data["accelerations"][rows]
            return acceleration_loss(
                w, self._scales, states, controls, wind, self._memory, measured, self._deviation, self._signs
            )
        return trajectory_loss(
            w, self._scales, states, controls[:-1], wind[:-1], self._h, self._memory, self._sigma, self._signs
        )

    def judged(self, w: Weights) -> dict[str, float]:
        """See ``Aim``: the mean over kinds of manoeuvre, each alike."""
        return {"score": float(np.mean(list(self._chooser.by_kind(w).values())))} if self._chooser else {}
