"""Runs that belong together: what may have a value of its own in each of them, or in each group of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...arrays import FloatArray
from ...fitting.box import AT, base_of, group_of
from ...trial import Trial

FEWEST = 3
"""Runs there must be for a spread between them to mean anything; of two runs, each can be a case of its own."""

FEWEST_GROUPS = 2
"""Groups of several runs that there must be: two days tell what differs between them by the runs of each."""

GROUPINGS = ("trial", "file", "group")
"""Ways to put runs together: each by itself, those cut from one log, those that say they are of one group."""

IN_WORDS = {"trial": "run", "file": "log", "group": "group"}
"""A group in words."""


def groups_of(trial: Trial) -> dict[str, str]:
    """Group of a trial, by grouping; windows of a trial belong to its groups."""
    return {"trial": trial.whole, "file": trial.run, "group": trial.group or trial.run}


def labels_of(trial: Trial) -> frozenset[str]:
    """The groups of a trial as targets name them."""
    return frozenset(f"{by}:{name}" for by, name in groups_of(trial).items())


def groupings(trials: Sequence[Trial]) -> dict[str, tuple[str, ...]]:
    """Groupings worth telling apart, the finest first, with the labels of their groups in the order of the trials."""
    found: dict[str, tuple[str, ...]] = {}
    for by in GROUPINGS:
        labels = tuple(dict.fromkeys(f"{by}:{groups_of(trial)[by]}" for trial in trials))
        together = by == "group" and len(labels) <= len(trials) // 2
        fewest = FEWEST_GROUPS if together else FEWEST
        if len(labels) >= fewest and len(labels) not in [len(other) for other in found.values()]:
            found[by] = labels
    return found


def name_of(label: str) -> str:
    """The name of a group."""
    return label.partition(":")[2]


def within(name: str, other: str, trials: Sequence[Trial]) -> bool:
    """Whether one is the same coefficient as another, of all runs or of a group that runs of its own are in."""
    own, others = group_of(name), group_of(other)
    shared = not others or any({own, others} <= labels_of(trial) for trial in trials)
    return base_of(name) == base_of(other) and shared


def between(names: Sequence[str], spreads: Mapping[str, float]) -> FloatArray | None:
    """(n_rows, n_names) rows whose squares say how unlike values of groups are, over their spread; None for none.

    spreads  of each coefficient "name@grouping", in the unit cube
    """
    rows = []
    for key in dict.fromkeys(spread_key(name) for name in names if group_of(name)):
        own = [k for k, name in enumerate(names) if group_of(name) and spread_key(name) == key]
        n = len(own)
        block = np.zeros((n, len(names)))
        block[:, own] = (np.eye(n) - 1.0 / n) / spreads[key]
        rows.append(block)
    return np.concatenate(rows) if rows else None


def spread_key(name: str) -> str:
    """What the spread of a value of a group is called: coefficient and grouping."""
    return f"{base_of(name)}{AT}{group_of(name).partition(':')[0]}"
