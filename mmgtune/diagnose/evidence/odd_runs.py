"""What single runs log otherwise than all others, where the profile as it is shows it: rudders, and positions."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from math import hypot

import numpy as np

from ...arrays import FloatArray
from ...evaluation import TrialRecord, evaluate
from ...profile import ShipProfile
from ...trial import Trial
from ...trial.kinematics import FITS, lever_of, stretch_of
from ...trial.model import fields_of
from ...trial.schema import RUDDERS
from .misread import POSITION, RUDDER, Misread, both, without

TELLS = 0.1
"""Share of J with the rudder as logged up to which a turned one tells a run."""

LIKE_OTHERS = 2.0
"""Times the largest error of the other runs up to which a run is told as these are: what else can turn a ship away from
her rudder, as the bank of a canal does, leaves more."""

FAR = 4.0
"""Times the largest error of the other runs beyond which its positions are off."""

ALIKE = 0.03
"""Difference of the factors north and east up to which they are one."""


def put_right(
    profile: ShipProfile, trials: Mapping[str, Trial], from_rudder: Collection[str], contradicted: Collection[str]
) -> tuple[dict[str, Trial], Misread]:
    """The trials with rudders of the other sign turned, and gaps in place of positions that are off, and which.

    from_rudder   ids of runs in which the ship turns away from her rudder
    contradicted  of those whose positions, velocities and heading contradict each other
    """
    turned = turned_in(profile, trials, from_rudder)
    right = {id: with_rudders_turned(trial) if id in turned else trial for id, trial in trials.items()}
    off = off_track_in(profile, right, contradicted)
    right = {id: without(trial, {name: off for name in ("x", "y")}) for id, trial in right.items()}
    told: list[Misread] = [{RUDDER: dict.fromkeys(turned, -1.0)} if turned else {}, {POSITION: off} if off else {}]
    return right, both(*told)


def turned_in(profile: ShipProfile, trials: Mapping[str, Trial], doubtful: Collection[str]) -> list[str]:
    """Ids of the runs that the ship, as her profile has her, sails as well as the others with the rudder turned round,
    and not as logged; none where half of the runs are doubtful: no other then shows which sign is right."""
    if not _few(doubtful, trials):
        return []
    most = max(_left(_told(profile, trial)) for id, trial in trials.items() if id not in doubtful)
    found = []
    for id in doubtful:
        as_logged, turned = (_left(_told(profile, one)) for one in (trials[id], with_rudders_turned(trials[id])))
        if turned < TELLS * as_logged and turned < LIKE_OTHERS * most:
            found.append(id)
    return found


def off_track_in(
    profile: ShipProfile, trials: Mapping[str, Trial], doubtful: Collection[str]
) -> dict[str, float | None]:
    """Ids of the runs whose positions alone are far off what the ship sails, as her profile has her, with how many
    times her way they show; None where it is no factor that is off."""
    if not _few(doubtful, trials):
        return {}
    told = {id: _told(profile, trial) for id, trial in trials.items()}
    if any(one.diverged for one in told.values()):
        return {}
    errors = {id: _errors(one) for id, one in told.items()}
    usual = np.max([errors[id] for id in errors if id not in doubtful], axis=0)
    found: dict[str, float | None] = {}
    for id in doubtful:
        times = errors[id] / np.maximum(usual, 1e-300)
        # Of an antenna far from midship turns show much more than zigzags do: that is one for all, and may be a cause.
        lever = lever_of(trials[id].columns)
        aboard = lever is not None and lever.misfit < FITS and hypot(lever.x, lever.y) < profile.L_pp
        if times[0] > FAR and (times[1:] < LIKE_OTHERS).all() and not aboard:
            found[id] = _factor(trials[id])
    return found


def with_rudders_turned(trial: Trial) -> Trial:
    """The trial with the other sign of all rudder angles."""
    turned = {name: -trial.columns[name] for name in RUDDERS if name in trial.columns}
    return replace(trial, **fields_of({**trial.columns, **turned}))


def _few(doubtful: Collection[str], trials: Mapping[str, Trial]) -> bool:
    return bool(doubtful) and 2 * len(doubtful) < len(trials)


def _told(profile: ShipProfile, trial: Trial) -> TrialRecord:
    return evaluate(profile, [trial])[0]


def _left(told: TrialRecord) -> float:
    """J of a sample."""
    return told.J / told.trial.n_samples


def _errors(told: TrialRecord) -> FloatArray:
    """Root mean squares of the errors of positions, heading, velocities and yaw rate; 0 of what was not measured."""
    rms = told.rms
    found = [hypot(rms.get("x", 0.0), rms.get("y", 0.0)), *(rms.get(name, 0.0) for name in ("psi", "u", "v_m", "r"))]
    return np.array(found)


def _factor(trial: Trial) -> float | None:
    """How many times the way that velocities and heading make positions show; None where it is no multiple of that."""
    stretch = stretch_of(trial.columns)
    if stretch is None or stretch.misfit > FITS or abs(stretch.north / stretch.east - 1.0) > ALIKE:
        return None
    return 0.5 * (stretch.north + stretch.east)
