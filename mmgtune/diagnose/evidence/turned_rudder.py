"""Runs whose log of the rudder has the other sign than that of all others."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from ...evaluation import evaluate
from ...inputs import INPUTS
from ...profile import ShipProfile
from ...trial import Trial
from ...trial.model import fields_of

TELLS = 0.1
"""Share of J with the rudder as logged up to which a turned one tells a run."""

LIKE_OTHERS = 2.0
"""Times the largest J of a sample of the other runs up to which a turned one leaves no more than these do: what else
can turn a ship away from her rudder, as the bank of a canal does, leaves more."""


def turned_in(profile: ShipProfile, trials: Mapping[str, Trial], doubtful: Collection[str]) -> list[str]:
    """Ids of the runs that the ship, as her profile has her, sails as well as the others with the rudder turned round,
    and not as logged; none where half of the runs are doubtful: no other then shows which sign is right.

    doubtful  ids of the runs in which the ship turns away from her rudder
    """
    if not doubtful or 2 * len(doubtful) >= len(trials):
        return []
    others = [_left(profile, trial) for id, trial in trials.items() if id not in doubtful]
    found = []
    for id in doubtful:
        as_logged, turned = _left(profile, trials[id]), _left(profile, with_rudders_turned(trials[id]))
        if turned < TELLS * as_logged and turned < LIKE_OTHERS * max(others):
            found.append(id)
    return found


def with_rudders_turned(trial: Trial) -> Trial:
    """The trial with the other sign of all rudder angles."""
    rudders = [name for name in trial.columns if name in INPUTS and INPUTS[name].role == "rudder"]
    return replace(trial, **fields_of({**trial.columns, **{name: -trial.columns[name] for name in rudders}}))


def _left(profile: ShipProfile, trial: Trial) -> float:
    """J of a sample."""
    return evaluate(profile, [trial])[0].J / trial.n_samples
