"""Columns that logs of one kind have in common."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from ... import units
from ...errors import LogError, Problem
from ...phrases import listed
from ..cells.headers import bare
from .sampling import Sample
from .words import KINDS, unit_named

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


def as_each_says(samples: Sequence[Sample]) -> tuple[list[Sample], list[str], list[str]]:
    """Logs whose columns go by one name where names differ in their units, or in one file in capitals, alone.

    Where units differ the numbers are in that of the first log then.

    Returns the logs, the names of the columns whose units differ, and sentences on them.
    """
    first = samples[0]
    found, own, notes = list(samples), [], []
    of_one = all(one.path == first.path for one in samples)

    def called(name: str) -> str:
        return bare(name).lower() if of_one else bare(name)

    columns: list[dict[str, list[int]]] = [{} for _ in samples]
    for one, of in zip(samples, columns, strict=True):
        for k, name in enumerate(one.names):
            of.setdefault(called(name), []).append(k)
    for name in first.names:
        places = [of[called(name)][0] for of in columns if len(of.get(called(name), ())) == 1]
        if not name.strip() or len(places) < len(samples):
            continue
        said = [unit_named(one.names[k], one.units[k]) for one, k in zip(samples, places, strict=True)]
        if len(set(said)) == 1:
            found = [one.called(k, name, one.units[k]) for one, k in zip(found, places, strict=True)]
            continue
        known = next((units.factors(kind) for kind in KINDS if set(said) <= set(units.factors(kind))), None)
        if known is None:
            continue
        found = [
            one.called(k, bare(name), said[0], known[unit] / known[said[0]])
            for one, k, unit in zip(found, places, said, strict=True)
        ]
        own.append(bare(name))
        other = next(k for k, unit in enumerate(said) if unit != said[0])
        here, there = (samples[k].part or samples[k].path.name for k in (0, other))
        notes.append(
            f"'{bare(name)[:60]}' is in {said[0]} in '{here}' and in {said[other]} in '{there}': "
            "each is read in the unit that its header says"
        )
    return found, own, notes


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
