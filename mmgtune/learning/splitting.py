"""Which runs of a training set are kept back for validation: whole runs, some of each kind of manoeuvre."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import OptionError, Problem
from ..phrases import counted
from ..trial import Trial


@dataclass(frozen=True, eq=False)
class Split:
    """Trials that are learned from, and trials that choose among what was learned."""

    learn: tuple[Trial, ...]
    choose: tuple[Trial, ...]


def fold_runs(trials: Sequence[Trial], folds: int, seed: int) -> list[Split]:
    """Every run kept back once, in ``folds`` parts with runs of every kind dealt out in turn.

    Raises OptionError where there are fewer runs than parts.
    """
    rng = np.random.default_rng([seed, 5])
    kinds: dict[str, set[str]] = {}
    for trial in trials:
        kinds.setdefault(trial.manoeuvre, set()).add(trial.run)
    dealt: list[str] = []
    for _, runs in sorted(kinds.items()):
        names = sorted(runs)
        dealt += [names[k] for k in rng.permutation(len(names))]
    if len(dealt) < folds:
        why = f"runs to deal out: {len(dealt)}"
        raise OptionError(Problem(f"{folds} parts of runs", "folds", why, f"write folds={len(dealt)} or less"))
    parts = [{*dealt[k::folds]} for k in range(folds)]
    return [
        Split(
            tuple(trial for trial in trials if trial.run not in part),
            tuple(trial for trial in trials if trial.run in part),
        )
        for part in parts
    ]


def split_runs(trials: Sequence[Trial], share: float, seed: int) -> Split:
    """Keep back about this share of the time of each kind of manoeuvre, as whole runs drawn by ``seed``.

    Trials cut from one run stay together.  A kind with a single run is learned from.
    Raises OptionError where that leaves nothing to learn from or nothing to choose by.
    """
    rng = np.random.default_rng([seed, 1])
    by_kind: dict[str, dict[str, list[Trial]]] = {}
    for trial in trials:
        by_kind.setdefault(trial.manoeuvre, {}).setdefault(trial.run, []).append(trial)
    kept: set[str] = set()
    for _, runs in sorted(by_kind.items()):
        names = [sorted(runs)[k] for k in rng.permutation(len(runs))]
        wanted = share * sum(trial.duration for several in runs.values() for trial in several)
        so_far = 0.0
        for name in names[:-1]:  # one at least is learned from
            length = sum(trial.duration for trial in runs[name])
            if so_far > 0.0 and so_far + 0.5 * length > wanted:
                break
            kept.add(name)
            so_far += length
    choose = tuple(trial for trial in trials if trial.run in kept)
    learn = tuple(trial for trial in trials if trial.run not in kept)
    if not learn or not choose:
        many = counted(len({trial.run for trial in trials}), "run")
        raise OptionError(
            Problem(
                "there are too few runs to keep some back",
                "validation",
                f"{many}: what is learned is chosen by runs it has not seen",
                "give two runs or more of one kind of manoeuvre",
            )
        )
    return Split(learn, choose)
