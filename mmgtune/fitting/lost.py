"""Models that cannot be simulated on the trials they are to be fitted to."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray
from ..errors import Problem, ProfileError
from ..profile import ShipProfile
from .problem import FitProblem

SHOWN = 3
"""Trials that are named."""


def hold_simulated(
    profile: ShipProfile,
    problem: FitProblem,
    unit: FloatArray,
    trials: Sequence[str],
    when: str = "wherever the targets are in their box",
) -> None:
    """See that a model can be simulated on all trials of a problem, a name a case.

    unit  (n_targets,) the targets, in the unit cube: the best of a fit
    when  what they are, in words

    Raises ProfileError where it cannot: nothing can be told of a ship then.
    """
    costs = problem.costs_by_case(unit[:, None])[:, 0]
    lost = [name for name, cost in zip(trials, costs, strict=True) if not np.isfinite(cost)]
    if lost:
        raise runs_away(profile, lost, when)


def runs_away(profile: ShipProfile, trials: Sequence[str], when: str) -> ProfileError:
    """The error of a model that cannot be simulated on these trials."""
    more = f" and {len(trials) - SHOWN} more" if len(trials) > SHOWN else ""
    return ProfileError(
        Problem(
            f"the simulation runs away on {', '.join(trials[:SHOWN])}{more}, {when}",
            str(profile.path or profile.id),
            "a coefficient may be wrong by its sign or a power of ten",
            "look at mmgtune validate of this profile and these trials, or tune the coefficient that is wrong too",
        )
    )
