"""What a training would do, for ``--dry-run``."""

from __future__ import annotations

from collections.abc import Sequence

from ..fitting import Plan
from ..given import ShipGiven, TrialsGiven, ship_of, trials_of
from ..options.learning import LearnOptions
from ..trial import Trial
from .task import make_task

RATE = 5e10, 2e11
"""Operations a second that training was measured at on two cores of different machines, busy and idle."""

WRITES = ("learning.json", "model.safetensors", "report.html", "training-SEED.safetensors until it is complete")


def plan_rnn(ship: ShipGiven, trials: TrialsGiven, options: LearnOptions) -> Plan:
    """What ``learn_rnn`` would do.  Raises what it would refuse with."""
    task = make_task(ship_of(ship), trials_of(trials).series_only("a network"), options)
    split, samples = task.split, task.samples
    layers = 2 + (task.memory or 1)
    windows = len(samples.starts(options.horizon))
    operations = 6.0 * task.updates * options.batch * options.horizon * layers * options.width**2
    lines = (
        f"learn     type {options.type}: {task.recipe.words}",
        f"ship      {task.profile.id}, driven by {', '.join(task.inputs)}",
        f"learn     {_of(split.learn)}: {windows} windows of {options.horizon} samples of {samples.step:g} s",
        f"choose    {_of(split.choose)}: {', '.join(one.id for one in split.choose)}",
        f"test      {len(task.test)} trials",
        f"train     {options.seeds} seeds of {options.steps} updates by {options.batch} windows",
    )
    low, high = (operations / rate for rate in (RATE[1], RATE[0]))
    return Plan(lines, (low, high), WRITES)


def _of(trials: Sequence[Trial]) -> str:
    return f"{len(trials)} trials, {sum(one.duration for one in trials):.0f} s"
