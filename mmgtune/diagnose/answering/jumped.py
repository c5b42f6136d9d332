"""Runs whose logged position jumps, taken in parts: each part begins where its own first samples say."""

from __future__ import annotations

from collections.abc import Mapping

from ...phrases import listed
from ...trial import TrialSet
from ...trial.checks.position_jumps import position_jumps

MOST = 3
"""Jumps of a run up to which it is taken in parts: a receiver that jumps more often is another matter."""

NAMED = 3
"""Runs up to which each is named."""


def in_parts(trials: TrialSet) -> tuple[TrialSet, dict[str, float]]:
    """The trials divided where their positions jump, and the largest jump of each run that does [m].

    Left as they are where any is a window already: windows begin anew anyhow.
    """
    if any(trial.part_of for trial in trials.trials.values()):
        return trials, {}
    jumps = {id: position_jumps(trial) for id, trial in trials.trials.items()}
    jumps = {id: found for id, found in jumps.items() if 0 < len(found) <= MOST}
    if not jumps:
        return trials, {}
    divided = trials.divided({id: [row for row, _ in found] for id, found in jumps.items()})
    return divided, {id: max(size for _, size in found) for id, found in jumps.items()}


def in_words(jumped: Mapping[str, float]) -> str:
    """Where the position jumps, and by how much; "" for nowhere."""
    if not jumped:
        return ""
    if len(jumped) <= NAMED:
        return f"the position jumps in {listed([f'{id} by {size:.3g} m' for id, size in jumped.items()])}"
    least, largest = (f"{end(jumped.values()):.3g}" for end in (min, max))
    by = largest if least == largest else f"{least} to {largest}"
    return f"the position jumps in {len(jumped)} runs, by {by} m"
