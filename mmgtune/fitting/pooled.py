"""Sister ships calibrated together: mean and spread of each coefficient in a class, and what that says of one more.

Each ship i has coefficients theta_i of her own, of which her trials say a quadratic (``information``).  In a class

    theta_i ~ N(mu, diag(tau^2)),    mu ~ N(pre-determined values, diag(s0^2)),

with s0 how well coefficients were known before any trial.  mu and tau are those under which all trials of the class are
most probable (empirical Bayes: Efron & Morris 1975; by expectation and maximisation, Dempster, Laird & Rubin 1977), so
that combinations which no trial of one ship tells apart count for as much as they are known, and no more.  Of a ship
that is not among them a coefficient is known before any trial to sqrt(tau^2 + variance of mu).
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from .. import limits
from ..arrays import FloatArray
from ..documents import parsed
from ..errors import FEW, OptionError, Problem, brief, reason
from ..files import require_regular
from ..resources import must_be_name
from .box import Box
from .information import Information
from .terms import ScatterPrior

SCHEMA = 1
CLASSES = "classes"
"""Folder, in that of a fleet, with a file for each class."""

FEWEST = 3
"""Ships from which a spread is told."""

MOST_ROUNDS = 500
"""Rounds of expectation and maximisation at most."""
SPREAD_TOLERANCE = 1e-4
"""Change of a spread, as a share, that ends them."""

FARTHEST = 1e4
"""Distance of a class from what was known before, in units of how well it was, that no trials show: damage."""

LEAST_SPREAD = 1e-3
"""Least spread, as a share of how well a coefficient was known before: more alike no sisters are."""


@dataclass(frozen=True, eq=False)
class SisterClass:
    """A class of sister ships.

    name     what the table of jobs calls it
    members  by ship what her trials say
    """

    name: str
    members: Mapping[str, Information]

    @property
    def sha256(self) -> str:
        """SHA-256 of what the trials of the members say."""
        told = {ship: one.to_dict() for ship, one in self.members.items()}
        return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()

    def to_dict(self) -> dict[str, Any]:
        """For JSON: members, and what follows from them."""
        found = pooled(self) if len(self.members) >= FEWEST else None
        return {
            "schema": SCHEMA,
            "kind": "sister-class",
            "name": self.name,
            "members": {ship: one.to_dict() for ship, one in self.members.items()},
            "pooled": found.to_dict() if found else None,
        }

    def without(self, ship: str) -> SisterClass:
        """The class without a ship: what her sisters say."""
        return replace(self, members={name: one for name, one in self.members.items() if name != ship})


@dataclass(frozen=True, eq=False)
class Pooled:
    """Mean and spread of coefficients in a class, (n,) each, in profile units.

    mean, mean_error  of the class, and its standard error
    spread            of ships about it, one standard deviation
    before, known     what was known before any trial
    n_ships           ships whose trials tell of each
    each              (n_ships, n) coefficients of the members, drawn towards the mean as far as they are unknown
    """

    names: tuple[str, ...]
    mean: FloatArray
    mean_error: FloatArray
    spread: FloatArray
    before: FloatArray
    known: FloatArray
    n_ships: int
    each: FloatArray

    @property
    def predictive(self) -> FloatArray:
        """Standard deviation (n,) of the coefficients of one more ship, before any trial of hers."""
        return np.sqrt(self.spread**2 + self.mean_error**2)

    def to_dict(self) -> dict[str, Any]:
        """For JSON, a row for each coefficient."""
        columns = ("mean", "mean_error", "spread", "before", "known")
        return {
            "ships": self.n_ships,
            "coefficients": {
                name: {column: float(getattr(self, column)[k]) for column in columns}
                for k, name in enumerate(self.names)
            },
        }


def pooled(sisters: SisterClass) -> Pooled:
    """Mean and spread of the coefficients of a class.

    Raises OptionError where it has fewer than three ships, or what their trials say is not of any trials.
    """
    try:
        with np.errstate(all="ignore"):  # of numbers beyond all measure, which are told below
            return _pooled(sisters)
    except np.linalg.LinAlgError as error:
        fix = "run the fleet of the class again; if nothing but mmgtune wrote the file, please report it"
        what = f"what the trials of the class '{sisters.name}' say cannot be put together"
        raise OptionError(Problem(what, "sisters", reason(error), fix)) from error


def _pooled(sisters: SisterClass) -> Pooled:
    """See ``pooled``."""
    members = list(sisters.members.values())
    if len(members) < FEWEST:
        what = f"the class '{sisters.name}' has {len(members)} ships to learn a spread from"
        why = f"{FEWEST} at least are needed, without the ship that is to be calibrated"
        raise OptionError(Problem(what, "sisters", why, "calibrate more of her sisters first, or leave the prior out"))
    names = tuple(dict.fromkeys(name for one in members for name in one.names))
    before, known = np.empty(len(names)), np.empty(len(names))
    for one in reversed(members):
        at = [names.index(name) for name in one.names]
        before[at], known[at] = one.before, one.known
    # In units of what was known before, as differences from the values before.
    n_ships = len(members)
    H, b = np.zeros((n_ships, len(names), len(names))), np.zeros((n_ships, len(names)))
    for i, one in enumerate(members):
        at = [names.index(name) for name in one.names]
        H[i][np.ix_(at, at)] = one.H * np.outer(known[at], known[at])
        b[i, at] = (one.b - one.H @ before[at]) * known[at]
    mean, spread = np.zeros(len(names)), np.ones(len(names))
    for _ in range(MOST_ROUNDS):
        P = np.linalg.inv(H + np.diag(spread**-2.0))
        each = np.einsum("ijk,ik->ij", P, b + mean / spread**2)
        mean = each.sum(axis=0) / spread**2 / (n_ships / spread**2 + 1.0)
        new = np.sqrt(np.mean((each - mean) ** 2 + np.diagonal(P, axis1=1, axis2=2), axis=0))
        new = np.maximum(new, LEAST_SPREAD)
        change = float(np.abs(new / spread - 1.0).max(initial=0.0))
        spread = new
        if change < SPREAD_TOLERANCE:
            break
    # What each ship says of the mean: her trials, blurred by the spread.
    P = np.linalg.inv(H + np.diag(spread**-2.0))
    of_mean = np.sum(H - H @ P @ H, axis=0) + np.eye(len(names))
    error = np.sqrt(np.diag(np.linalg.inv(of_mean)))
    each = np.einsum("ijk,ik->ij", P, b + mean / spread**2)
    if not all((np.abs(one) < FARTHEST).all() for one in (mean, error, spread, each)):
        raise np.linalg.LinAlgError("its numbers run away")
    return Pooled(
        names,
        before + known * mean,
        known * error,
        known * spread,
        before,
        known,
        n_ships,
        before + known * each,
    )


class SistersPrior(ScatterPrior):
    """How far coefficients are from the mean of sister ships, in what these leave open; of others from formulas."""

    sentence = "Prior: mean and spread of sister ships, {weight}; its squares go from {old:.3g} to {new:.3g}."


def with_sisters(box: Box, found: Pooled) -> Box:
    """The box with centre and scatter of the class for the targets it knows; bounds stay."""
    centre = np.full(len(box), np.nan) if box.centre is None else box.centre.copy()
    scatter = np.full(len(box), np.nan) if box.scatter is None else box.scatter.copy()
    for k, name in enumerate(found.names):
        if name in box.names and box.names.index(name) not in box.charted:
            i = box.names.index(name)
            centre[i], scatter[i] = found.mean[k], found.predictive[k]
    return replace(box, centre=centre, scatter=scatter)


def unheard(box: Box, found: Pooled | None) -> list[str]:
    """The sentence on a class that knows none of the targets; nothing where there is no class."""
    if found is None or any(name in found.names and k not in box.charted for k, name in enumerate(box.names)):
        return []
    more = len(found.names) - FEW
    only = f", only of {', '.join(found.names[:FEW])}" if found.names else ""
    only += f" and {more} more" if more > 0 else ""
    return [f"The class of sister ships has no effect: their trials say nothing of the targets{only}."]


def read_sisters(path: Path, ship: str) -> SisterClass:
    """The class of a file, or of the folder of a fleet: the only one there, or that which the ship is in.

    Raises OptionError where there is none, or it cannot be told which.
    """
    must_be_name(path, "prior", OptionError)
    file = path if path.exists() and not path.is_dir() else _chosen(path, ship)
    try:
        document = parsed(_text(file))
        if not isinstance(document, dict) or document.get("kind") != "sister-class" or document.get("schema") != SCHEMA:
            raise ValueError('it has no "kind": "sister-class" of schema 1')
        if not isinstance(document["members"], dict) or not isinstance(document["name"], str):
            raise ValueError("its members and its name are of another kind")
        return SisterClass(document["name"], dict(map(_member, document["members"].items())))
    except (ValueError, KeyError, RecursionError) as error:
        raise _no_class(file, error) from error


def _member(told: tuple[str, Any]) -> tuple[str, Information]:
    """A ship, and what her trials say.  Raises ValueError where that is none."""
    ship, document = told
    try:
        return ship, Information.from_dict(document)
    except (KeyError, ValueError) as error:
        raise ValueError(f"of {brief(ship)}: {reason(error)}") from error


def _text(file: Path) -> str:
    """Text of the file of a class, which is read more than once.  Raises OptionError."""
    try:
        require_regular(file)
        return limits.text(file, limits.RECORD_BYTES, OptionError)
    except (OSError, ValueError) as error:
        raise _no_class(file, error) from error


def _no_class(file: Path, error: Exception) -> OptionError:
    fix = "give the folder that mmgtune fleet run wrote, or a file of its folder classes"
    return OptionError(Problem("this is no class of sister ships", str(file), reason(error), fix))


def _chosen(folder: Path, ship: str) -> Path:
    files = sorted((folder / CLASSES).glob("*.json"))
    if not files:
        why = "a fleet has classes where three ships or more of a class were fitted"
        fix = 'write class = "..." into the entries of its table, and run it'
        raise OptionError(Problem("there is no class of sister ships", str(folder), why, fix))
    own = [file for file in files if f'"{ship}": {{' in _text(file)]
    if len(files) == 1 or len(own) == 1:
        return (own or files)[0]
    fix = "name one of: " + ", ".join(str(file) for file in files)
    raise OptionError(Problem("it is not said which class the ship is of", str(folder), "there are several", fix))
