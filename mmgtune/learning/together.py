"""Trainings side by side under one compiled step, for an accelerator, which one small network leaves idle.

On a processor products of stacked matrices take longer than plain ones after each other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..backends.twins import jax_module
from .training import LOST, Progressed, Trainer, batch, copied, past, standing

PRECISION = "float32"
"""Of products of matrices, whose factors a GPU would round to ten bits."""


class Told(NamedTuple):
    """What is known of the steps of one training since its last validation, (n_steps,) each."""

    loss: FloatArray
    norm: FloatArray
    sound: BoolArray


class Together:
    """Trainings of one plan that differ in weights, in seeds, and in what is not the same object in the aims' data."""

    def __init__(self, trainers: Sequence[Trainer]):
        jax = jax_module()
        self.trainers, self.plan = tuple(trainers), trainers[0].plan
        leaves = [jax.tree.leaves(one.aim.data) for one in trainers]
        own = [any(one is not same[0] for one in same) for same in zip(*leaves, strict=True)]
        self._own = jax.tree.unflatten(jax.tree.structure(trainers[0].aim.data), own)
        step: Any = trainers[0].traced

        def advanced(weights: Any, starts: Any, pasts: Any, factor: Any, data: Any) -> Any:
            def one(weights: Any, given: Any) -> Any:
                *weights, loss, norm, sound = step(*weights, given[0], factor, given[1], data)
                return tuple(weights), Told(loss, norm, sound)

            return jax.lax.scan(one, weights, (starts, pasts))

        axes = jax.tree.map(lambda own: 0 if own else None, self._own)
        self._advanced = jax.jit(jax.vmap(advanced, in_axes=(0, 0, None, 0, axes)))

    def run(
        self,
        now: Sequence[Progressed],
        seeds: Sequence[int],
        *,
        on_validation: Callable[[int, Progressed], None] = lambda *_: None,
        stop: Callable[[], bool] = lambda: False,
    ) -> list[Progressed]:
        """Train all to the end of the plan, or until ``stop``, which is asked after each validation.

        on_validation  called with the number of a training, and where it stands, after each of its validations

        Those that stand at an earlier step go on first, until they have met the others.  Where one is lost, what it did
        since its last validation is dropped.  Raises what ``Trainer.run`` does.
        """
        found, good = list(now), [copied(one.good or one) for one in now]
        while behind := [k for k, one in enumerate(found) if one.step < self.plan.steps]:
            first = min(found[k].step for k in behind)
            group = [k for k in behind if found[k].step == first]
            for k, (one, told) in zip(group, self._to_validation(found, group, seeds), strict=True):
                own = self.trainers[k]
                if most_lost(one, told) >= LOST:
                    found[k] = own.gone_back(one, good[k])
                    continue
                found[k] = one
                if own.validated(one, told.loss[told.sound].tolist(), float(np.max(told.norm[told.sound], initial=0))):
                    good[k] = copied(one)
                on_validation(k, standing(one, good[k]))
            if stop():
                break
        for one, own in zip(found, self.trainers, strict=True):
            own.ended(one, self.plan.steps)
        return [standing(one, back) for one, back in zip(found, good, strict=True)]

    def _to_validation(
        self, found: list[Progressed], group: list[int], seeds: Sequence[int]
    ) -> list[tuple[Progressed, Told]]:
        """Those of a group, which stand at one step, at their next validation."""
        tree = jax_module().tree
        ones, own = [found[k] for k in group], [self.trainers[k] for k in group]
        plan, first = self.plan, ones[0].step
        steps = range(first, min(plan.steps, first + plan.every - first % plan.every))
        starts = [
            np.stack([batch(self.trainers[k].aim.starts, plan.batch, seeds[k], step) for step in steps]) for k in group
        ]
        data = tree.map(lambda own, *of: np.stack(of) if own else of[0], self._own, *(one.aim.data for one in own))
        weights = tree.map(lambda *of: np.stack(of), *((one.parameters, one.state, one.mean) for one in ones))
        with jax_module().default_matmul_precision(PRECISION):
            ended, told = self._advanced(
                weights,
                np.stack(starts),
                np.array([past(step) for step in steps], dtype=np.float32),
                np.array([one.factor for one in ones], dtype=np.float32),
                data,
            )
        ended, told = tree.map(np.asarray, (ended, told))
        advanced = []
        for row, one in enumerate(ones):
            new = copied(one)
            new.parameters, new.state, new.mean = tree.map(lambda of, row=row: of[row], ended)
            new.step = steps.stop
            advanced.append((new, Told(*(of[row] for of in told))))
        return advanced


def most_lost(now: Progressed, told: Told) -> int:
    """Steps in a row without a finite gradient, the most there were; those at the end count on in ``now.lost``."""
    most = 0
    for sound in told.sound.tolist():
        now.lost = 0 if sound else now.lost + 1
        most = max(most, now.lost)
    return most
