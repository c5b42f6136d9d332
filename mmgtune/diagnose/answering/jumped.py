"""Runs whose logged position jumps, taken in parts: each part begins where its own first samples say.  What is off the
track before the first of them is left out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ...phrases import listed
from ...trial import TrialSet
from ...trial.checks.position_jumps import first_positions_off, position_jumps
from ...trial.pieces import begun_at

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


def from_the_track_on(trials: TrialSet) -> tuple[TrialSet, dict[str, float]]:
    """The trials without first positions that are off the track, and how far they are, by run [m]; windows as they
    are."""
    if any(trial.part_of for trial in trials.trials.values()):
        return trials, {}
    off = {id: found for id, trial in trials.trials.items() if (found := first_positions_off(trial))}
    kept = {id: begun_at(trial, off[id][0]) if id in off else trial for id, trial in trials.trials.items()}
    return replace(trials, trials=kept) if off else trials, {id: size for id, (_, size) in off.items()}


def beginnings_in_words(off: Mapping[str, float], runs: int) -> str:
    """That first positions are off, and how far; "" for none."""
    if not off:
        return ""
    return f"the first positions are off the track by {_span(off)} m in {len(off)} of {runs} runs"


def in_words(jumped: Mapping[str, float]) -> str:
    """Where the position jumps, and by how much; "" for nowhere."""
    if not jumped:
        return ""
    if len(jumped) <= NAMED:
        return f"the position jumps in {listed([f'{id} by {size:.3g} m' for id, size in jumped.items()])}"
    return f"the position jumps in {len(jumped)} runs, by {_span(jumped)} m"


def _span(sizes: Mapping[str, float]) -> str:
    """From the least to the largest of some, once where they are alike."""
    return " to ".join(dict.fromkeys(f"{end(sizes.values()):.3g}" for end in (min, max)))
