"""What a data set is made of where it is made in memory: looked at before it is believed, as files are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ..displayed import inert
from ..errors import OptionError, Problem, TrialError, all_of, brief, kind_of, parts_of
from .index_trial import IndexTrial
from .metadata import nameless, without_id
from .model import Trial
from .split import in_both, wrong_ids

Given = Mapping[str, Trial | IndexTrial] | Iterable[Trial | IndexTrial] | Trial | IndexTrial
"""Trials by id, several of them, or a single one."""

Roles = Mapping[str, tuple[str, ...]]
"""Ids of trials by "tune" and "test"."""

NAMED = 3
"""Trials of a ship that are named where there are several ships."""


def trials_by_id(trials: Given, stated: Given) -> tuple[dict[str, Trial], dict[str, IndexTrial]]:
    """Time series, and trials of which only indices are known, by id.

    trials, stated  each by id, several of them, or a single one; those of stated indices may be among the trials
    Raises OptionError for what is no trial, TrialError for one without an id, two of one id and one under the id of
    another.
    """
    every = [*_several(trials, "trials"), *_several(stated, "stated")]
    if any(nameless(one.id) for one in every):
        raise TrialError(without_id("trials"))
    twice = [id for id, count in Counter(one.id for one in every).items() if count > 1]
    if twice:
        why = "trials are told apart by their ids"
        raise TrialError(Problem(f"two trials are called '{twice[0]}'", "trials", why, "give each its own id"))
    series = {one.id: one for one in every if isinstance(one, Trial)}
    return series, {one.id: one for one in every if isinstance(one, IndexTrial)}


def roles_of(ids: Mapping[str, Iterable[str]], trials: Sequence[str]) -> Roles:
    """Which trials tune and which test.

    ids     as they are given: by "tune", "test", "tune_stated" and "test_stated"
    trials  ids of those that there are
    Raises OptionError for what is no list of ids, TrialError with everything that is wrong in them.
    """
    several = {name: all_of(given, str, name) for name, given in ids.items()}
    found = {role: (*several[role], *several[f"{role}_stated"]) for role in ("tune", "test")}

    def place(_: str) -> str:
        return "the data set"

    problems = [problem for role, named in found.items() for problem in wrong_ids(role, named, trials, place)]
    problems += in_both(found["tune"], found["test"], place)
    if problems:
        raise TrialError(*problems)
    return found


def ship_of_all(trials: Sequence[Trial | IndexTrial]) -> str:
    """Id of the ship that trials are of, "" where none says.  Raises TrialError where they are of several."""
    by_ship: dict[str, list[str]] = {}
    for one in trials:
        if one.ship:
            by_ship.setdefault(one.ship, []).append(one.id)
    if len(by_ship) > 1:
        told = [f"{', '.join(ids[:NAMED])}{' and more' if len(ids) > NAMED else ''}" for ids in by_ship.values()]
        why = "; ".join(f"of '{inert(ship)}': {ids}" for ship, ids in zip(by_ship, map(inert, told), strict=True))
        fix = "make a set for each ship; where all are of one ship, TrialSet(..., ship=ID) says so"
        raise TrialError(Problem(f"the trials are of {len(by_ship)} ships", "trials", why, fix))
    return next(iter(by_ship), "")


def _several(given: Any, name: str) -> list[Trial | IndexTrial]:
    """Trials one by one.

    name  of the argument they are given as
    """
    alone = isinstance(given, (Trial, IndexTrial))
    parts = list(given.values()) if isinstance(given, Mapping) else [given] if alone else parts_of(given)
    others = [one for one in parts or () if not isinstance(one, (Trial, IndexTrial))]
    if parts is None or others:
        listed = others and isinstance(given, (Mapping, Sequence))
        what = f"{kind_of(others[0])} in {name} is no trial" if listed else f"{kind_of(given)} is no set of trials"
        fix = "give a list of trials; trial_of(TABLE, ID) makes one of a table, load_trials(NAME) reads a set"
        raise OptionError(Problem(what, name, "a data set is made of trials", fix))
    for key, one in given.items() if isinstance(given, Mapping) else ():
        if key != one.id:
            why, fix = "trials are looked up by their ids", "give a list of trials, or each under its own id"
            raise TrialError(Problem(f"trial '{one.id}' stands under {brief(key)}", name, why, fix))
    return parts
