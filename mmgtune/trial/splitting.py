"""A suggestion which trials of a set should tune, and which should test."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .model import Trial


def suggested_split(trials: Sequence[Trial]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Ids of trials to tune to, and to test on, each in the order given.

    Of each kind of manoeuvre, named or not, one is tested, then one to the other side, as far as the kind keeps as many
    to tune to; so no more are tested than tune.  The test is the gentlest where there is a choice: what tunes then goes
    further.
    Trials cut from one run are no test of each other, so they tune together.  Where that leaves no kind with two
    trials, the run of fewest tests, the last of those; of a single run all tune.
    """
    runs: dict[str, list[Trial]] = {}
    for trial in trials:
        runs.setdefault(trial.run, []).append(trial)
    kinds: dict[str, list[Trial]] = {}
    for pieces in runs.values():
        if len(pieces) == 1:
            kinds.setdefault(_kind(pieces[0]), []).append(pieces[0])
    tested: list[str] = []
    for of in kinds.values():
        tested += _tested(of)
    if not tested and len(runs) > 1:
        tested = [trial.id for trial in min(reversed(runs.values()), key=len)]
    ids = [trial.id for trial in trials]
    return tuple(id for id in ids if id not in tested), tuple(id for id in ids if id in tested)


def _kind(trial: Trial) -> str:
    """The manoeuvre; where a log does not say it, whether the rudder is laid to one side or to both."""
    if trial.manoeuvre:
        return trial.manoeuvre
    large = 0.5 * max(_size(trial), 1e-9)
    sides = [bool(np.any(side * trial.delta >= large)) for side in (1.0, -1.0)]
    return "both sides" if all(sides) else "one side"


def _tested(trials: Sequence[Trial]) -> list[str]:
    """Of trials of one kind those to test on: one, and one to the other side where both sides keep another."""
    sides: dict[float, list[Trial]] = {}
    for trial in sorted(trials, key=_size):
        sides.setdefault(_side(trial), []).append(trial)
    most = len(trials) // 2
    several = [of for of in sides.values() if len(of) > 1]
    # A side of a single trial is rather left to tune to, where the other side has trials to spare.
    chosen = [of[0].id for of in sorted(several or sides.values(), key=lambda of: (-len(of), _size(of[0])))]
    return chosen[:most]


def _size(trial: Trial) -> float:
    """The largest rudder angle [rad]."""
    return float(np.max(np.abs(trial.delta[np.isfinite(trial.delta)]), initial=0.0))


def _side(trial: Trial) -> float:
    """The side of the first large rudder angle: 1 to starboard, -1 to port, 0 without one."""
    large = np.flatnonzero(np.abs(trial.delta) >= 0.5 * max(_size(trial), 1e-9))
    return float(np.sign(trial.delta[large[0]])) if large.size else 0.0
