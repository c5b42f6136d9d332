"""What library functions are given: objects, or the names and paths that commands take."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

from .errors import OptionError, Problem, TrialError, brief, kind_of, parts_of
from .profile import ShipProfile, load_profile
from .trial import IndexTrial, Trial, TrialSet, load_trials
from .trial.by_hand import ship_of_all
from .trial.unusable import increasing


@runtime_checkable
class Found(Protocol):
    """A result that a ship came out of: it stands for her wherever a ship is wanted."""

    def as_ship(self) -> Any:
        """Her profile, particles of her, or what was trained."""
        ...


ShipGiven = ShipProfile | Found | str | Path
TrialsGiven = TrialSet | Trial | IndexTrial | Sequence[Trial | IndexTrial | str | Path] | str | Path

_NONE = Problem("the list of trials is empty", "trials", "nothing was measured", "give one at least")


def ship_of(given: ShipGiven) -> ShipProfile:
    """A profile, the one of that path or bundled name, or the one that a fit or a diagnosis found.

    Raises ProfileError, OptionError for anything else.
    """
    found = given.as_ship() if isinstance(given, Found) else given
    if isinstance(found, ShipProfile):
        return found
    if isinstance(given, (str, Path)):
        return load_profile(given)
    fix = "load a profile with load_profile(NAME)"
    if found is not given:
        fix = (
            "simulation, scoring and prediction take it; give a profile here, as load_profile(NAME) or a fit returns it"
        )
    if isinstance(given, (TrialSet, Trial, IndexTrial)):
        fix = "give the ship first, then the trials"
    raise OptionError(Problem(f"{kind_of(given)} is no ship profile", brief(given), "a ship is wanted here", fix))


def trials_of(given: TrialsGiven) -> TrialSet:
    """A data set, or the one of that path or bundled name; a trial, or several, as a set that tunes to all of them.

    Files of trials may stand for them in a list.  Raises TrialError, OptionError for anything else.
    """
    if isinstance(given, TrialSet):
        _require_timed(given.trials.values())
        return given
    return load_trials(given) if isinstance(given, (str, Path)) else _set_of(_several(given))


def list_of(given: TrialsGiven) -> list[Trial]:
    """The trials of a data set, in its order, or those of a list.  Raises as ``trials_of`` does."""
    what = "a simulation of trials"
    if isinstance(given, (str, Path, TrialSet)):
        return list(trials_of(given).series_only(what).trials.values())
    several = _several(given)
    series = [one for one in several if isinstance(one, Trial)]
    if len(series) < len(several):
        _set_of(several).series_only(what)
    return series


def some_of(given: TrialsGiven) -> list[Trial]:
    """The trials of a data set, in its order, or those of a list: one at least.  Raises TrialError for none."""
    several = list_of(given)
    if not several:
        raise TrialError(_NONE)
    return several


def of_one_ship(given: TrialsGiven) -> tuple[list[Trial], str]:
    """The same, and the id of their ship, "" where nothing says.  Raises TrialError also for trials of many ships."""
    data = trials_of(given) if isinstance(given, (str, Path, TrialSet)) else None
    several = some_of(given if data is None else data)
    return several, ship_of_all(several) if data is None else data.ship


def _several(given: object) -> list[Trial | IndexTrial]:
    """What is given as one trial or several, in a list also by their files.

    Raises OptionError for anything else, TrialError for files that cannot be read.
    """
    if isinstance(given, (Trial, IndexTrial)):
        given = [given]
    parts = None if _is_table(given) else parts_of(given)
    if parts is not None:
        parts = [trial for one in parts for trial in (load_trials(one) if _is_file(one) else (one,))]
    others = [one for one in parts or () if not isinstance(one, (Trial, IndexTrial))]
    if parts is not None and not others:
        _require_timed(one for one in parts if isinstance(one, Trial))
        return parts
    what = f"{kind_of(given)} is no set of trials"
    if others and isinstance(given, Sequence):
        what = f"{kind_of(others[0])} in the {type(given).__name__} of trials is no trial"
    fix = "give a TrialSet, a Trial, a list of these, a path or a bundled name; load_trials(NAME) reads a set"
    if isinstance(given, ShipProfile):
        fix = "give the ship first, then the trials"
    elif type(given).__name__.endswith("Options"):
        fix = f"options are named where they do not stand third: options={type(given).__name__}(...)"
    elif isinstance(given, Found) or (parts and any(isinstance(one, (ShipProfile, Found)) for one in parts)):
        fix = "several ships stand in a list, and the trials behind it"
    elif _is_table(given):
        fix += ", trial_of(TABLE, ID) makes a trial of a table; a table of orders is for predict(SHIP, TABLE)"
    if others and all(_is_folder(one) for one in others):
        fix = f"a set is given by itself: {brief(others[0])}; in a list stand trials and their files"
    elif others and all(isinstance(one, str) for one in others) and isinstance(given, Sequence):
        fix = f"ids are looked up in their set: [TRIALS[{others[0]!r}]], where TRIALS is load_trials(NAME)"
    raise OptionError(Problem(what, brief(given), "measured trials are wanted here", fix))


def _is_table(given: object) -> bool:
    """Whether something has named columns and is no dict."""
    return not isinstance(given, Mapping) and hasattr(given, "keys")


def _is_file(one: object) -> bool:
    """Whether what stands in a list of trials is a file of one: a path, or a text that plainly is one."""
    plainly = isinstance(one, Path) or (isinstance(one, str) and (one.endswith((".parquet", ".toml")) or os.sep in one))
    return plainly and not _is_folder(one)


def _is_folder(one: object) -> bool:
    return isinstance(one, (str, Path)) and os.path.isdir(one)


def _require_timed(trials: Iterable[Trial]) -> None:
    """Raises TrialError for trials in memory whose time a file of them could not have."""
    for one in trials:
        if not increasing(one.t):
            what, fix = "time does not strictly increase", "give finite times, each sample later than the one before"
            raise TrialError(Problem(what, one.id, "it is what everything else is simulated along", fix))


def _set_of(several: Sequence[Trial | IndexTrial]) -> TrialSet:
    """Trials as a data set that tunes to all of them.  Raises TrialError for none, and for two of one id."""
    if not several:
        raise TrialError(_NONE)
    return TrialSet(several, [one.id for one in several], ())
