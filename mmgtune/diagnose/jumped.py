"""Runs whose logged position jumps, taken in parts: each part begins where its own first samples say."""

from __future__ import annotations

from ..trial import TrialSet
from ..trial.position_jumps import position_jumps

MOST = 3
"""Jumps of a run up to which it is taken in parts: a receiver that jumps more often is another matter."""


def in_parts(trials: TrialSet) -> tuple[TrialSet, list[str]]:
    """The trials divided where their positions jump, and which jump by how much, in words.

    Left as they are where any is a window already: windows begin anew anyhow.
    """
    if any(trial.part_of for trial in trials.trials.values()):
        return trials, []
    jumps = {id: position_jumps(trial) for id, trial in trials.trials.items()}
    jumps = {id: found for id, found in jumps.items() if 0 < len(found) <= MOST}
    if not jumps:
        return trials, []
    divided = trials.divided({id: [row for row, _ in found] for id, found in jumps.items()})
    told = [f"the position of {id} jumps by {max(size for _, size in found):.3g} m" for id, found in jumps.items()]
    return divided, told
