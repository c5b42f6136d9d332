"""Models that cannot be simulated on the trials they are to be fitted to."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray
from ..errors import Problem, ProfileError
from ..profile import ShipProfile
from ..trial import Trial, check_trials
from .problem import FitProblem

SHOWN = 3
"""Trials that are named, and warnings of them that are told."""


def require_simulated(
    profile: ShipProfile,
    problem: FitProblem,
    unit: FloatArray,
    trials: Sequence[Trial],
    when: str = "wherever the targets are in their box",
) -> None:
    """See that a model can be simulated on all trials of a problem, a case each.

    unit  (n_targets,) the targets, in the unit cube: the best of a fit
    when  what they are, in words

    Raises ProfileError where it cannot: nothing can be told of a ship then.
    """
    costs = problem.costs_by_case(unit[:, None])[:, 0]
    lost = [one for one, cost in zip(trials, costs, strict=True) if not np.isfinite(cost)]
    if lost:
        raise runs_away(profile, lost, when)


def runs_away(profile: ShipProfile, trials: Sequence[Trial], when: str) -> ProfileError:
    """The error of a model that cannot be simulated on these trials, with what a check warns of in them."""
    names = [one.id for one in trials]
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    what = f"the simulation runs away on {', '.join(names[:SHOWN])}{more}, {when}"
    odd = _warned(trials, profile.L_pp)
    why = "a coefficient may be wrong by its sign or a power of ten"
    fix = "look at mmgtune validate of this profile and these trials, or tune the coefficient that is wrong too"
    if odd:
        why = f"the trials may be wrong, as said below; else {why}"
        fix = f"mend the trials first; else {fix}"
    return ProfileError(Problem(what, str(profile.path or profile.id), why, fix), *odd)


def _warned(trials: Sequence[Trial], L_pp: float) -> list[Problem]:
    """What is odd in trials, each thing to mend once: of many with revolutions a minute it is said of the first."""
    found: dict[str, Problem] = {}
    for findings in check_trials({one.id: one for one in trials}, L_pp).values():
        for one in findings:
            if one.severity != "note" and one.code != "gaps":
                found.setdefault(one.fix or one.what, Problem(one.what, one.where, one.why, one.fix))
    return list(found.values())[:SHOWN]
