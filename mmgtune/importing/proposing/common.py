"""Columns that logs of one kind have in common."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from ...errors import LogError, Problem
from ...phrases import listed
from .sampling import Sample

LEAST = 0.5
"""Share of the columns of the log with the fewest that are in all logs, if they are of one kind."""


def in_common(samples: Sequence[Sample]) -> tuple[list[Sample], list[str]]:
    """Logs with the same columns in the same order, and the names of those left out as not all logs have them.

    Columns go by name.  Raises LogError where logs have hardly any in common.
    """
    first = samples[0]
    samples = [one if one.names == first.names else one.in_order(first) for one in samples]
    if all(one.names == first.names for one in samples):
        return samples, []
    # What has no name of its own may be anything else in another log.
    own = [_own_names(one) for one in samples]
    shared = [name for name in own[0] if all(name in names for names in own[1:])]
    if len(shared) < max(2.0, LEAST * min(len(one.names) for one in samples)):
        raise LogError(of_different_kinds(samples))
    others = dict.fromkeys(name.strip() for one in samples for name in one.names if name.strip() not in shared)
    return [one.only(shared) for one in samples], [name for name in others if name]


def of_different_kinds(samples: Sequence[Sample]) -> Problem:
    """What is wrong with logs whose columns differ in what a map needs."""
    first = samples[0]
    other = next(one for one in samples if one.names != first.names)
    why = f"{first.label} has {len(first.names)} columns, {other.label} {len(other.names)}"
    if quoted := [f"'{name[:60]}'" for name in first.names if name.strip() and name not in other.names]:
        why += f", without {listed(quoted, 4)}"
    if len(other.names) == len(first.names):
        k = next(k for k, name in enumerate(other.names) if name != first.names[k])
        why = f"column {k + 1} is '{first.names[k][:60]}' in one, '{other.names[k][:60]}' in the other"
    what = "the logs are of different kinds: their columns differ"
    return Problem(what, str(other.path), why, "make a map for each kind")


def _own_names(sample: Sample) -> list[str]:
    """Names of columns by which a map can name them."""
    counts = Counter(name.strip() for name in sample.names)
    return [
        name.strip()
        for k, name in enumerate(sample.names)
        if counts[name.strip()] == 1 and isinstance(sample.reference(k), str)
    ]
