"""An ensemble of feed-forward networks trained on trials: what ``mmgtune learn ensemble`` does.

Members are trained side by side: on an accelerator under one compiled step (``Together``), on a processor in threads,
each on a core of its own, since there members of 64 units and more take longer under ``vmap`` than one after the other.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from ..backends.twins import accelerated, jax_module
from ..displayed import Plotted
from ..documents import finite
from ..errors import OptionError, Problem, must_be_a
from ..files import kept_in
from ..hooks import Hooks
from ..networks.ensemble import Ensemble, EnsemblePredictor, Part
from ..networks.feedforward import Layers, Standards
from ..options.choice import must_be
from ..options.learning import EnsembleOptions
from ..scores import TrialScore
from ..threads import cores, on_threads
from . import records
from .choosing import Single
from .ensemble import EnsembleAim, MemberStandards, Trainable, first_member
from .keeping import Kept
from .provenance import provenance_of, travelling
from .run import identity_of, scored
from .task import EnsembleTask, ensemble_task
from .together import Together
from .training import Plan, Progressed, Trainer, needed


@dataclass(frozen=True, eq=False)
class EnsembleMember:
    """One trained network.

    weights    the running mean of the last updates
    standards  what its inputs and outputs are standardised by
    curve      a row for each time it was looked at: step, loss, score, norm of the gradient
    events     where training diverged, and what was done
    """

    seed: int
    weights: Trainable
    standards: MemberStandards
    step: int
    curve: tuple[dict[str, float], ...]
    events: tuple[dict[str, Any], ...]

    @property
    def score(self) -> float:
        """Its loss on the windows it was watched by."""
        return float(self.curve[-1]["score"])

    def to_dict(self) -> dict[str, Any]:
        """For JSON; the weights are in the model's file."""
        rows = [{key: finite(value) for key, value in row.items()} for row in self.curve]
        return {
            "seed": self.seed,
            "loss": rows[-1]["loss"],
            "score": rows[-1]["score"],
            "steps": self.step,
            "curve": rows,
            "events": list(self.events),
        }


@dataclass(frozen=True, eq=False)
class LearnedEnsemble(Plotted):
    """Networks that differ by their initial values and the order of windows alone.

    task    what was learned from what
    scores  of the trials held out, and of those kept back where some were, in windows, by role: "validation", "test";
            of neither, those of the trials learned from: "learned"
    """

    written_by = "write_learned"

    ensemble: Ensemble
    members: tuple[EnsembleMember, ...]
    task: EnsembleTask
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

    def as_ship(self) -> Ensemble:
        """What was trained: what the result stands for where a ship is wanted."""
        return self.ensemble

    def __repr__(self) -> str:
        """In a line."""
        losses = ", ".join(f"{one.score:.3g}" for one in self.members)
        return f"LearnedEnsemble({self.ensemble.ship}: {len(self.members)} members, loss {losses})"

    def to_dict(self) -> dict[str, Any]:
        """The document of ``ensemble.json``: everything but the weights."""
        return records.of_ensemble(self)


def learn_ensemble(
    ship: ShipGiven,
    trials: TrialsGiven,
    options: EnsembleOptions = EnsembleOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | str | None = None,
    resume: bool = False,
    command: str = "",
) -> LearnedEnsemble:
    """Train an ensemble on the trials that tune, and score it on those that test.

    ship    profile that names the ship, her length and what drives her; her coefficients play no part
    hooks   what is told on the way, and what ends it: see ``until_interrupted`` for Ctrl-C
    folder  for checkpoints; None for none
    resume  go on with what is there: the result is that of a run without a stop, bit for bit
    Raises what ``ensemble_task`` does, and OptionError where JAX is missing.
    """
    folder = kept_in(folder, resume)
    must_be(options, EnsembleOptions)
    must_be_a(hooks, Hooks, "hooks")
    began = time.perf_counter()
    needed()
    task = ensemble_task(ship_of(ship), trials_of(trials).series_only("a network"), options)
    members = _members(task, hooks, Kept(folder, identity_of(task), resume))
    if not members:
        why = "nothing is known of weights before"
        raise OptionError(
            Problem("stopped before any was looked at", "validate_every", why, "write a smaller validate_every")
        )
    used = (*task.split.learn, *task.split.choose)
    made = provenance_of(task.profile, task.data, used, options, command)
    facts = {**travelling(made), "type": "ensemble", "seeds": [one.seed for one in members]}
    ensemble = ensemble_of(members, task, facts)
    done = len(members) == options.members and all(one.step >= options.steps for one in members)
    return LearnedEnsemble(
        ensemble,
        tuple(members),
        task,
        {
            role: scored(EnsemblePredictor(ensemble), of, task.sigma, options.restart)
            for role, of in task.by_role.items()
        },
        made,
        not done,
        time.perf_counter() - began,
    )


def ensemble_of(members: Sequence[EnsembleMember], task: EnsembleTask, facts: dict[str, Any]) -> Ensemble:
    """What was trained as a model."""
    motion = _part([one.weights.motion for one in members], [one.standards.motion for one in members])
    starts = [(one.weights.start, one.standards.start) for one in members]
    known = [(layers, standards) for layers, standards in starts if layers is not None and standards is not None]
    return Ensemble(
        ship=task.profile.id,
        L_pp=task.profile.L_pp,
        inputs=task.inputs,
        step=task.samples.step,
        motion=motion,
        start=_part(*map(list, zip(*known, strict=True))) if known else None,
        facts=facts,
    )


def _part(layers: list[Layers], standards: list[Standards]) -> Part:
    return Part(
        Layers(*(np.stack(parts) for parts in zip(*layers, strict=True))),
        Standards(*(np.stack(parts) for parts in zip(*standards, strict=True))),
    )


def _members(task: EnsembleTask, hooks: Hooks, kept: Kept) -> list[EnsembleMember]:
    """The networks side by side; those that an earlier run has trained are read."""
    options = task.options
    aim = EnsembleAim(task)
    plan = Plan(options.steps, options.batch, options.rate, options.validate_every)
    trainer = Trainer(aim, plan, alone=not accelerated())
    lock, done = Lock(), [0] * options.members

    def begun(k: int) -> tuple[Trainer, MemberStandards, Progressed]:
        weights, standards = first_member(task, task.seed(k))
        own = trainer.on(aim.of(standards))
        now = kept.begun(k, own.begin(_single(weights)))
        done[k] = now.step
        return own, standards, now

    def told(k: int, one: Progressed) -> None:
        kept.keep(k, one)
        row = one.curve[-1]
        words = f"member {k + 1} of {options.members}, loss {row['loss']:.4g}, watched {row['score']:.4g}"
        with lock:
            done[k] = one.step
            hooks.on_progress(sum(done), options.members * options.steps, words)

    def ended(k: int, standards: MemberStandards, now: Progressed) -> EnsembleMember | None:
        if not now.curve:
            return None
        mean = jax_module().tree.map(lambda one: np.asarray(one, dtype=np.float64), now.mean)
        return EnsembleMember(task.seed(k), mean, standards, now.step, tuple(now.curve), tuple(now.events))

    def alone(k: int) -> EnsembleMember | None:
        own, standards, now = begun(k)
        if now.step < options.steps and not hooks.stop():
            now = own.run(now, task.seed(k), on_validation=partial(told, k), stop=hooks.stop)
        return ended(k, standards, now)

    def together() -> list[EnsembleMember | None]:
        owns, standards, nows = zip(*map(begun, range(options.members)), strict=True)
        seeds = [task.seed(k) for k in range(options.members)]
        ends = Together(owns).run(nows, seeds, on_validation=told, stop=hooks.stop)
        return list(map(ended, range(options.members), standards, ends))

    if accelerated():
        return [one for one in together() if one is not None]
    each = on_threads([partial(alone, k) for k in range(options.members)], cores())
    return [one for one in each if one is not None]


def _single(weights: Trainable) -> Any:
    return jax_module().tree.map(lambda one: one.astype(Single), weights)
