"""Networks trained on trials: what ``mmgtune learn rnn`` does."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from ..backends.twins import accelerated
from ..displayed import Plotted
from ..documents import finite
from ..errors import OptionError, Problem, must_be_a
from ..files import kept_in
from ..hooks import Hooks
from ..networks import Network, NetworkPredictor
from ..networks.recurrent import Scales, Weights
from ..options.choice import must_be
from ..options.learning import LearnOptions
from ..predictor import Predictor
from ..scores import TrialScore, score
from ..trial import Trial
from . import records
from .aims import RecurrentAim
from .choosing import pieces_of
from .keeping import Kept
from .provenance import provenance_of, travelling
from .starting import first_weights, scales_of
from .task import Material, Task, make_task
from .together import Together
from .training import Plan, Progressed, Trainer, needed


@dataclass(frozen=True, eq=False)
class Member:
    """One trained network.

    weights  the best by score, or the last where no run chooses, without the axis of members
    score    mean over kinds of manoeuvre of L_MSE on the windows that chose; None where none did
    curve    a row for each validation: step, loss, score if there is one, norm of the gradient
    events   where training diverged, and what was done
    """

    seed: int
    weights: Weights
    score: float | None
    step: int
    curve: tuple[dict[str, float], ...]
    events: tuple[dict[str, Any], ...]

    @property
    def best(self) -> dict[str, float]:
        """The row of the curve at which the weights were kept."""
        return self.curve[-1] if self.score is None else min(self.curve, key=lambda row: row["score"])

    def to_dict(self) -> dict[str, Any]:
        """For JSON; the weights are in the model's file."""
        return {
            "seed": self.seed,
            "loss": finite(self.best["loss"]),
            "score": None if self.score is None else finite(self.score),
            "best_step": int(self.best["step"]),
            "steps": self.step,
            "curve": [{key: finite(value) for key, value in row.items()} for row in self.curve],
            "events": list(self.events),
        }


@dataclass(frozen=True, eq=False)
class Learned(Plotted):
    """Networks of one type, one for each seed.

    task     what was learned from what
    scores   in windows, by role, of the trials of ``Material.by_role``: those held out, "test", and those that chose,
             "validation"; where there are neither, of those "learned" from
    """

    written_by = "write_learned"

    network: Network
    members: tuple[Member, ...]
    task: Task
    scores: dict[str, tuple[TrialScore, ...]]
    provenance: dict[str, Any]
    interrupted: bool
    wall_s: float

    @property
    def role(self) -> str:
        """The trials it is judged by first."""
        return next(iter(self.task.by_role))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to know of it: that the trials are of another ship, where they are."""
        return self.task.warnings

    def as_ship(self) -> Network:
        """What was trained: what the result stands for where a ship is wanted."""
        return self.network

    def __repr__(self) -> str:
        """In a line."""
        chosen = bool(self.task.split.choose)
        best = ", ".join(f"{one.best['score' if chosen else 'loss']:.3g}" for one in self.members)
        what = "L_MSE of validation" if chosen else "loss"
        return f"Learned({self.network.ship}, type {self.task.options.type}, {what} by seed {best})"

    def to_dict(self) -> dict[str, Any]:
        """The document of ``learning.json``: everything but the weights."""
        return records.of_networks(self)


def learn_rnn(
    ship: ShipGiven,
    trials: TrialsGiven,
    options: LearnOptions = LearnOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | str | None = None,
    resume: bool = False,
    command: str = "",
) -> Learned:
    """Train networks on the trials that tune, choose by runs kept back, and score those that test.

    With ``validation=0.0`` no run is kept back: after all updates the running mean of the weights is kept.

    ship    profile that names the ship, her length and what drives her; her coefficients play no part
    hooks   what is told on the way, and what ends it: see ``until_interrupted`` for Ctrl-C
    folder  for checkpoints; None for none
    resume  go on with what is there: the result is that of a run without a stop, bit for bit
    Raises what ``make_task`` does, and OptionError where JAX is missing.
    """
    folder = kept_in(folder, resume)
    must_be(options, LearnOptions)
    must_be_a(hooks, Hooks, "hooks")
    began = time.perf_counter()
    needed()
    task = make_task(ship_of(ship), trials_of(trials).series_only("a network"), options)
    scales = scales_of(task.samples)
    plan = Plan(options.steps, options.batch, options.rate, options.validate_every)
    kept = Kept(folder, identity_of(task), resume)
    members = _members(Trainer(RecurrentAim(task, scales), plan), task, hooks, kept)
    if not members:
        why = "nothing is known of weights before"
        raise OptionError(
            Problem("stopped before the first validation", "validate_every", why, "write a smaller validate_every")
        )
    used = (*task.split.learn, *task.split.choose)
    made = provenance_of(task.profile, task.data, used, options, command)
    made["recipe"] = task.recipe.words
    network = Network(
        ship=task.profile.id,
        L_pp=task.profile.L_pp,
        inputs=task.inputs,
        step=task.samples.step,
        memory=task.memory,
        weights=Weights(*(np.stack(parts) for parts in zip(*(one.weights for one in members), strict=True))),
        scales=Scales(*(one[None] for one in scales)),
        facts={**travelling(made), "type": f"type {options.type}", "seeds": [one.seed for one in members]},
        mirrored=options.mirrored,
    )
    done = len(members) == options.seeds and all(one.step >= options.steps for one in members)
    return Learned(
        network,
        tuple(members),
        task,
        {role: scored(NetworkPredictor(network), of, task.sigma, options.restart) for role, of in task.by_role.items()},
        made,
        not done,
        time.perf_counter() - began,
    )


def identity_of(task: Material) -> dict[str, Any]:
    """Everything the weights depend on, but for versions."""
    return {
        "ship": task.profile.id,
        "inputs": list(task.inputs),
        "trials": task.data.hashes(),
        "tune": list(task.data.tune),
        "options": task.options.to_dict(),
    }


def _members(trainer: Trainer, task: Task, hooks: Hooks, kept: Kept) -> list[Member]:
    """The networks one after the other, on an accelerator at once; those that an earlier run has trained are read."""
    options = task.options
    seeds = [options.seed + k for k in range(options.seeds)]
    done = [0] * len(seeds)

    def begun(k: int) -> Progressed:
        first = trainer.begin(_single(first_weights(len(task.inputs), options.width, seeds[k])))
        now = kept.begun(seeds[k], first)
        done[k] = now.step
        return now

    def told(k: int, one: Progressed) -> None:
        kept.keep(seeds[k], one)
        row, done[k] = one.curve[-1], one.step
        chosen = f", L_MSE of validation {row['score']:.4g}" if "score" in row else ""
        hooks.on_progress(sum(done), task.updates, f"seed {k + 1} of {options.seeds}, loss {row['loss']:.4g}{chosen}")

    def one_by_one() -> Iterator[Progressed]:
        for k, seed in enumerate(seeds):
            now = begun(k)
            if now.step < options.steps:
                now = trainer.run(now, seed, on_validation=partial(told, k), stop=hooks.stop)
            yield now
            if hooks.stop():
                return

    def at_once() -> list[Progressed]:
        nows = list(map(begun, range(len(seeds))))
        return Together([trainer] * len(seeds)).run(nows, seeds, on_validation=told, stop=hooks.stop)

    found = []
    for seed, now in zip(seeds, at_once() if accelerated() else one_by_one(), strict=False):  # fewer where stopped
        if np.isfinite(now.best_score):
            best = Weights(*(np.asarray(one, dtype=np.float64) for one in now.best))
            score = now.best_score if task.split.choose else None
            found.append(Member(seed, best, score, now.step, tuple(now.curve), tuple(now.events)))
    return found


def _single(weights: Weights) -> Weights:
    return Weights(*(one.astype(np.float32) for one in weights))


def scored(
    predictor: Predictor, trials: Sequence[Trial], sigma: dict[str, float], restart: float | None
) -> tuple[TrialScore, ...]:
    """Windows of trials scored by all members."""
    if not trials:
        return ()
    return tuple(score(predictor, pieces_of(trials, restart), sigma))
