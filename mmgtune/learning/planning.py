"""What a training would do, for ``--dry-run``."""

from __future__ import annotations

from collections.abc import Sequence

from ..arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from ..fitting import Plan
from ..options.learning import EnsembleOptions, HybridOptions, LearnOptions
from ..phrases import counted
from ..run_files import ENSEMBLE, HYBRID, LEARNING, MODEL, REPORT_HTML
from ..threads import cores
from ..trial import Trial
from .hybrid_run import splits_of, times_of
from .refitting import tuned_names
from .task import Material, ensemble_task, make_task

RATE = 5e10, 2e11
"""Operations a second that training was measured at on two cores of different machines, busy and idle."""

ALONE = 4e10, 1.2e11
"""The same on one core."""

LANE_STEP = 5e-7, 2e-6
"""Seconds for the gradient of one step of one window of a hybrid."""

FIT = 10.0
"""Seconds that a profile takes to be tuned anew, about."""

WRITES = (LEARNING, MODEL, REPORT_HTML, "training-SEED.safetensors until it is complete")


def plan_rnn(ship: ShipGiven, trials: TrialsGiven, options: LearnOptions) -> Plan:
    """What ``learn_rnn`` would do.  Raises what it would refuse with."""
    task = make_task(ship_of(ship), trials_of(trials).series_only("a network"), options)
    split = task.split
    layers = 2 + (task.memory or 1)
    operations = (
        6.0
        * task.updates
        * options.batch
        * options.horizon
        * layers
        * options.width**2
        * (2 if options.mirrored else 1)
    )
    lines = (
        f"learn     type {options.type}: {task.recipe.words}",
        *_material(task, options.horizon),
        f"choose    {_of(split.choose)}: {', '.join(one.id for one in split.choose)}"
        if split.choose
        else "choose    none: the mean of the last updates' weights is kept",
        f"test      {counted(len(task.test), 'trial')}",
        f"train     {options.seeds} seeds of {options.steps} updates by {options.batch} windows",
    )
    low, high = (operations / rate for rate in (RATE[1], RATE[0]))
    return Plan(lines, (low, high), WRITES)


def plan_ensemble(ship: ShipGiven, trials: TrialsGiven, options: EnsembleOptions) -> Plan:
    """What ``learn_ensemble`` would do.  Raises what it would refuse with."""
    task = ensemble_task(ship_of(ship), trials_of(trials).series_only("a network"), options)
    watch = task.split.choose
    inside = options.width * (len(task.inputs) + 8 + (options.layers - 1) * options.width)
    operations = 6.0 * options.members * options.steps * options.batch * options.horizon * inside
    start = f"{options.initial} observations" if options.initial else "as observed"
    lines = (
        f"learn     an ensemble of {options.members} networks of {options.layers} x {options.width} units",
        *_material(task, options.horizon),
        f"start     {start}",
        f"watch     {_of(watch)}, {', '.join(one.id for one in watch)}" if watch else "watch     what it learns from",
        f"test      {counted(len(task.test), 'trial')}",
        f"train     {options.steps} updates by {options.batch} windows, {min(cores(), options.members)} side by side",
    )
    low, high = (operations / rate / min(cores(), options.members) for rate in (ALONE[1], ALONE[0]))
    return Plan(lines, (low, high), (ENSEMBLE, *WRITES[1:3], "training-MEMBER.safetensors until it is complete"))


def plan_hybrid(ship: ShipGiven, trials: TrialsGiven, options: HybridOptions) -> Plan:
    """What ``learn_hybrid`` would do.  Raises what it would refuse with."""
    profile, data = ship_of(ship), trials_of(trials).series_only("a network")
    tune = [data.trials[id] for id in data.tune]
    splits = splits_of(tune, options)
    step, lag = times_of(profile, tune, options)
    steps = len(splits) * len(options.penalty) * options.steps + options.steps
    window = options.restart or max(one.duration for one in tune)
    lane_steps = steps * options.batch * window / step
    names = tuned_names(profile)
    anew = f"tuned anew without them: {len(names)} coefficients" if names and options.refit else "as it is"
    lines = (
        f"learn     what {profile.id} leaves of {_of(tune)}",
        f"memory    {lag:.3g} s, steps of {step:.3g} s in windows of {window:.4g} s",
        *(f"part {k + 1:<4} {_of(one.choose)} kept back; the profile {anew}" for k, one in enumerate(splits)),
        f"train     {options.steps} updates by {options.batch} windows, penalties {options.penalty}, then on all runs",
        f"test      {counted(len(data.test), 'trial')}",
    )
    low, high = (lane_steps * seconds + FIT * len(splits) * bool(names) for seconds in LANE_STEP)
    return Plan(lines, (low, high), (HYBRID, *WRITES[1:]))


def _material(task: Material, horizon: int) -> tuple[str, ...]:
    windows = len(task.samples.starts(horizon))
    return (
        f"ship      {task.profile.id}, driven by {', '.join(task.inputs)}",
        f"learn     {_of(task.split.learn)}: {windows} windows of {horizon} samples of {task.samples.step:g} s",
    )


def _of(trials: Sequence[Trial]) -> str:
    return f"{counted(len(trials), 'trial')}, {sum(one.duration for one in trials):.0f} s"
