"""Weights made better step by step: Adam, the best kept by a score, checkpoints, and a way back from divergence.

What is trained is any tree of arrays; what is made small and what chooses come as an ``Aim``.  The batch of a step
depends on seed and step alone, so a run that was stopped goes on as if it had not been, bit for bit.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np

from ..arrays import IntArray
from ..backends.twins import jax_module
from ..errors import OptionError, Problem, reason

WARM_UP = 0.05
"""Share of the steps over which the rate rises to its largest; it then falls as a cosine."""

CLIP = 1.0
"""Largest norm of a gradient."""

AVERAGE = 0.98
"""Weight of the past in the running mean of the weights, which is what is scored and kept."""

LOST = 10
"""Steps in a row without a finite gradient after which training goes back."""

BACK = 5
"""Times training goes back, each time at half the rate, before it ends with what it has."""

FIX = "train at a smaller rate, or look at the trials for jumps, and at the profile"
"""What helps where no weights are found."""


class Aim(Protocol):
    """What is trained for.

    starts  rows at which windows of the loss begin
    data    tree of arrays that the loss is of: given to it, so that they are no part of what is compiled
    """

    starts: IntArray
    data: Any

    def loss(self, parameters: Any, starts: Any, data: Any) -> Any:
        """Loss of a batch of windows, (n,) rows -> number; traceable."""
        ...

    def judged(self, parameters: Any) -> dict[str, float]:
        """What is known of weights: their "score", less is better and infinite where a run diverged, and more.

        Without a score nothing chooses: the last weights are as good as any.
        """
        ...


@dataclass(frozen=True)
class Plan:
    """How long, how fast, and with what: see ``LearnOptions``."""

    steps: int
    batch: int
    rate: float
    every: int
    decay: float = 0.0


@dataclass
class Progressed:
    """Where a training stands: everything that it goes on from.

    parameters, state, mean  trees of arrays: weights, what the optimiser remembers, running mean of the weights
    best, best_score         the best mean so far; where nothing chooses the last, and the loss of its updates
    curve                    a row for each validation: step, mean loss since the last, norm of the gradient, and what
                             the aim says
    events                   what went wrong, with its step
    good                     where it stood at the last validation that it can go back to; None where that is here
    factor                   on the rate, halved each time training went back
    """

    parameters: Any
    state: Any
    mean: Any
    best: Any
    best_score: float = math.inf
    step: int = 0
    factor: float = 1.0
    lost: int = 0
    curve: list[dict[str, float]] = field(default_factory=list)
    events: list[dict[str, Any]] = field(default_factory=list)
    good: Progressed | None = None


class Trainer:
    """One compiled step, for any number of seeds.

    traced   the step as JAX traces it: (weights, optimiser, mean, starts, factor, past, data) -> the first three anew,
             loss, norm of the gradient, whether both are finite
    update   the same compiled
    alone    whether a step keeps to one core, for trainings side by side in threads
    """

    def __init__(self, aim: Aim, plan: Plan, *, alone: bool = False):
        jax, optax = jax_module(), optax_module()
        self.aim, self.plan = aim, plan
        warm = max(1, round(WARM_UP * plan.steps))
        rate = optax.warmup_cosine_decay_schedule(0.0, plan.rate, warm, max(plan.steps, warm + 1), 0.0)
        self.optimiser = optax.chain(optax.clip_by_global_norm(CLIP), optax.adamw(rate, weight_decay=plan.decay))

        def update(parameters: Any, state: Any, mean: Any, starts: Any, factor: Any, past: Any, data: Any) -> Any:
            loss, gradient = jax.value_and_grad(aim.loss)(parameters, starts, data)
            norm = optax.tree.norm(gradient)
            sound = jax.numpy.isfinite(norm) & jax.numpy.isfinite(loss)
            gradient = jax.tree.map(lambda one: jax.numpy.where(sound, one, 0.0), gradient)
            change, moved = self.optimiser.update(gradient, state, parameters)
            new = jax.tree.map(lambda a, b: a + factor * b, parameters, change)
            kept = jax.tree.map(lambda a, b: past * a + (1.0 - past) * b, mean, new)
            old = (parameters, state, mean)
            found = jax.tree.map(lambda a, b: jax.numpy.where(sound, a, b), (new, moved, kept), old)
            return *found, loss, norm, sound

        self.traced = update
        self.update = jax.jit(update, compiler_options={"xla_cpu_multi_thread_eigen": False} if alone else None)

    def on(self, aim: Aim) -> Trainer:
        """A trainer with this one's compiled step, for an aim that differs in its data alone."""
        other = copy(self)
        other.aim = aim
        return other

    def begin(self, parameters: Any) -> Progressed:
        """A training before its first step."""
        parameters = jax_module().tree.map(jax_module().numpy.asarray, parameters)
        return Progressed(parameters, self.optimiser.init(parameters), parameters, parameters)

    def run(
        self,
        now: Progressed,
        seed: int,
        *,
        until: int | None = None,
        on_validation: Callable[[Progressed], None] = lambda _: None,
        stop: Callable[[], bool] = lambda: False,
    ) -> Progressed:
        """Train to the end of the plan, or to the step ``until``, or until ``stop``.

        on_validation  called after each validation, to save and tell

        Raises OptionError where no step ever had a finite loss.
        """
        plan, last = self.plan, until or self.plan.steps
        good = copied(now.good or now)
        losses: list[float] = []
        largest = 0.0
        while now.step < last:
            starts = batch(self.aim.starts, plan.batch, seed, now.step)
            now.parameters, now.state, now.mean, loss, norm, sound = self.update(
                now.parameters,
                now.state,
                now.mean,
                starts,
                np.float32(now.factor),
                np.float32(past(now.step)),
                self.aim.data,
            )
            now.step += 1
            if bool(sound):
                now.lost = 0
                losses.append(float(loss))
                largest = max(largest, float(norm))
            else:
                now.lost += 1
            if now.lost >= LOST:
                now = self.gone_back(now, good)
                losses, largest = [], 0.0
                continue
            if now.step % plan.every == 0 or now.step == last:
                if self.validated(now, losses, largest):
                    good = copied(now)
                losses, largest = [], 0.0
                on_validation(standing(now, good))
                if stop():
                    break
        self.ended(now, last)
        return standing(now, good)

    def validated(self, now: Progressed, losses: list[float], largest: float) -> bool:
        """Whether a training can go back to where it stands now, which is judged and written down.

        losses, largest  of the steps since the last validation: losses, and the largest norm of a gradient
        """
        judged = self.aim.judged(now.mean)
        loss = float(np.mean(losses)) if losses else math.nan
        now.curve.append({"step": now.step, "loss": loss, "norm": largest, **judged})
        score = judged.get("score", loss)
        if score < now.best_score or ("score" not in judged and math.isfinite(loss)):
            now.best, now.best_score = now.mean, score
        return math.isfinite(score) and not now.lost

    def ended(self, now: Progressed, last: int) -> None:
        """Raises OptionError where a training came to its last step, and no step ever had a finite loss."""
        if not math.isfinite(now.best_score) and now.step >= last:
            raise OptionError(
                Problem(
                    "training found no weights with which the ship stays in the world",
                    "rate",
                    f"after {now.step} steps; it went back {len(now.events)} times",
                    FIX,
                )
            )

    def gone_back(self, now: Progressed, good: Progressed) -> Progressed:
        """The last good state again, at half the rate; the steps count on.  Raises OptionError after ``BACK`` times."""
        why = "no finite gradient for some steps in a row"
        if len(now.events) >= BACK:
            raise OptionError(
                Problem(
                    f"training diverged {BACK + 1} times, the last time at step {now.step}",
                    "rate",
                    why,
                    FIX,
                )
            )
        back = copied(good)
        back.events = [
            *now.events,
            {"step": now.step, "why": why, "back_to": good.step, "rate_factor": 0.5 * now.factor},
        ]
        back.step, back.factor, back.lost = now.step, 0.5 * now.factor, 0
        return back


def past(step: int) -> float:
    """Weight of the past in the running mean of the weights at a step: the mean of what there is, at first."""
    return min((1.0 + step) / (10.0 + step), AVERAGE)


def batch(starts: IntArray, size: int, seed: int, step: int) -> IntArray:
    """The windows of one step: drawn from all, by seed and step alone."""
    rng = np.random.default_rng([seed, 3, step])
    return starts[rng.integers(len(starts), size=size)]


def needed() -> None:
    """Raises OptionError with the command that installs it where something that training needs is not there."""
    jax_module()
    optax_module()


def optax_module() -> Any:
    """Optax.  Raises OptionError with the command that installs it where it is not there."""
    try:
        import optax
    except ImportError as error:
        raise OptionError(
            Problem("Optax is not installed", "", reason(error), "install it with: pip install 'mmgtune[learn]'")
        ) from error
    return optax


def standing(now: Progressed, good: Progressed) -> Progressed:
    """Where a training stands, with where it would go back to: what it goes on from when it was stopped."""
    return replace(now, good=None if good.step == now.step else good)


def copied(one: Progressed) -> Progressed:
    """A copy with lists of its own; arrays are never written into."""
    return Progressed(
        one.parameters,
        one.state,
        one.mean,
        one.best,
        one.best_score,
        one.step,
        one.factor,
        one.lost,
        list(one.curve),
        list(one.events),
    )
