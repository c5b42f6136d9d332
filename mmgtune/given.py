"""What library functions are given: objects, or the names and paths that commands take."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .profile import ShipProfile, load_profile
from .trial import Trial, TrialSet, load_trials

ShipGiven = ShipProfile | str | Path
TrialsGiven = TrialSet | str | Path


def ship_of(given: ShipGiven) -> ShipProfile:
    """A profile, or the one of that path or bundled name.  Raises ProfileError."""
    return load_profile(given) if isinstance(given, (str, Path)) else given


def trials_of(given: TrialsGiven) -> TrialSet:
    """A data set, or the one of that path or bundled name.  Raises TrialError."""
    return load_trials(given) if isinstance(given, (str, Path)) else given


def list_of(given: TrialsGiven | Sequence[Trial]) -> list[Trial]:
    """The trials of a data set, in its order, or those of a list."""
    if isinstance(given, (str, Path, TrialSet)):
        return list(trials_of(given).series_only("a simulation of trials").trials.values())
    return list(given)
