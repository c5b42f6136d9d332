"""What the network of a hybrid says, in known terms: the force it adds, where, and which terms would give it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..backends import LaneModel
from ..inputs import INPUTS
from ..model import Model
from ..networks.hybrid import Hybrid
from ..phrases import listed
from ..physics.kinematics import flow
from ..physics.quantities import UNKNOWN
from ..physics.rigid_body import accelerations
from ..trial import Trial
from ..units import DEG
from .following import Followed, added_by, follow, own_force
from .known import VALUE, Candidate, candidates
from .refitting import tuned_names
from .selecting import Chosen, select

COMPONENTS = ("X", "Y", "N")
DIRECTIONS = {"X": "surge", "Y": "sway", "N": "yaw"}
UNITS = {"X": "N", "Y": "N", "N": "N m"}

MOMENTS = 4000
"""Instants that are looked at, at most: more give the same answer."""

LITTLE = 0.2
"""Share of the force that a term explains from which it is named."""

RARE = 0.03
"""Share of the time a class of motion needs to be worth naming."""


@dataclass(frozen=True)
class Share:
    """The force the network adds in one direction, root mean squares over all instants.

    size  [N] or [N m]
    own   of the model's own total force
    """

    component: str
    size: float
    own: float

    @property
    def share(self) -> float:
        """Of the model's own."""
        return self.size / self.own if self.own > 0.0 else 0.0

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "component": self.component,
            "unit": UNITS[self.component],
            "rms": self.size,
            "rms_model": self.own,
            "share": self.share,
        }


@dataclass(frozen=True)
class Class:
    """A class of motion: how much of the time ships are in it, and of the squares of the force added."""

    words: str
    time: float
    force: float

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {"class": self.words, "share_of_time": self.time, "share_of_force": self.force}


@dataclass(frozen=True)
class Rival:
    """A term that would have done about as well in the place of another."""

    name: str
    title: str
    share: float

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {"name": self.name, "title": self.title, "share": self.share}


@dataclass(frozen=True)
class Term:
    """A known term that gives part of the force the network adds.

    name     section.symbol of a coefficient, tag.parameter of an effect
    title    what it is, in words
    told     the same with a place for the value
    value    of an effect its parameter; of a coefficient what is added to the profile's [unit]
    unit     SI
    factor   its force is that many times what the value gives; 1 where force is proportional to value
    spread   standard deviation of factor times value over the parts of the runs left out, over its size
    share    of the squares of the force that tuned coefficients and the terms before it leave, what it explains on
             unseen runs
    shares   the same by component
    rivals   terms that would have done about as well
    """

    name: str
    title: str
    told: str
    value: float
    unit: str
    factor: float
    spread: float
    share: float
    shares: dict[str, float]
    rivals: tuple[Rival, ...]

    @property
    def sized(self) -> str:
        """The value with its unit, angles in degrees."""
        value, unit = self.value, self.unit
        if unit in ("rad", "rad/s"):
            value, unit = value / DEG, unit.replace("rad", "deg")
        return f"{value:.3g}{'' if unit in ('-', 'prime') else ' ' + unit}"

    @property
    def written(self) -> str:
        """The value, and how many times its force it is that is meant."""
        return self.sized if self.factor == 1.0 else f"{self.sized}, {self.factor:.2g} times"

    @property
    def cause(self) -> str:
        """The term with its value, as it stands in a sentence."""
        times = "" if self.factor == 1.0 else f", at {self.factor:.2g} times its force"
        return self.told.replace(VALUE, self.sized) + times

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "name": self.name,
            "title": self.title,
            "value": self.value,
            "unit": self.unit,
            "factor": self.factor,
            "spread": self.spread,
            "written": self.written,
            "share": self.share,
            "shares": self.shares,
            "rivals": [one.to_dict() for one in self.rivals],
        }


@dataclass(frozen=True)
class Reading:
    """What a network says.

    shares   of the force it adds, by component
    classes  the two classes of motion with more of the force than of the time
    tuned    share of the force that other values of the tuned coefficients would give: a model that lacks something
             is tuned to make up for it, and its network takes that back
    terms    known terms that give part of the rest, the first the one that gives most
    runs     runs looked at
    """

    shares: tuple[Share, ...]
    classes: tuple[Class, ...]
    tuned: float
    terms: tuple[Term, ...]
    runs: int

    @property
    def sentences(self) -> tuple[str, ...]:
        """In words."""
        if not any(one.size > 0.0 for one in self.shares):
            return ("The network adds no force.",)
        sizes = [f"{_force(one.size, UNITS[one.component])} in {DIRECTIONS[one.component]}" for one in self.shares]
        parts = [_percent(one.share) for one in self.shares]
        said = [
            f"The network adds {listed(sizes)} (root mean square), which is {listed(parts)} of the model's own force."
        ]
        if self.classes:
            where = listed(
                [
                    f"{one.words} ({_percent(one.force)} of it in {_percent(one.time)} of the time)"
                    for one in self.classes
                ]
            )
            said.append(f"It acts most at {where}.")
        if self.tuned > LITTLE:
            said.append(
                f"{_percent(self.tuned)} of it could as well come from other values of the coefficients that were "
                "tuned: this part says nothing of what the model lacks."
            )
        named = [one for one in self.terms if max(one.share, *one.shares.values()) > LITTLE]
        left = self.tuned > LITTLE
        for one in named:
            said.append(_sentence(one, left))
            left = True
        if not named:
            said.append(f"No known cause gives more than {_percent(LITTLE)} of {'the rest' if left else 'it'}.")
        return tuple(said)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "runs": self.runs,
            "force": [one.to_dict() for one in self.shares],
            "where": [one.to_dict() for one in self.classes],
            "share_of_tuned": self.tuned,
            "terms": [one.to_dict() for one in self.terms],
            "sentences": list(self.sentences),
        }


def read_network(hybrid: Hybrid, trials: Sequence[Trial], *, restart: float | None = 100.0) -> Reading:
    """Read the network of a hybrid along the runs of trials.

    restart  [s] of the windows; None for whole runs

    The ship is followed where the hybrid itself takes her, begun anew from the measured state at each window: there
    the network was trained, its memory is known, and states have no noise.  Known terms are chosen one by one
    (forward selection), each by what it explains on runs its value was not found from.
    What the tuned coefficients would give with other values is not counted for the terms.
    Raises TrialError for a trial without one of the inputs.
    """
    followed = follow(hybrid, trials, restart, MOMENTS)
    M = mass_matrix(followed.model)
    y, own = added_by(hybrid, followed) @ M.T, own_force(followed)
    shares = tuple(Share(name, _rms(y[:, k]), _rms(own[:, k])) for k, name in enumerate(COMPONENTS))
    runs = len(set(followed.runs.tolist()))
    if not np.any(y):
        return Reading(shares, (), 0.0, (), runs)
    # A force in each direction counts by the acceleration it gives, over those that ships have in the data.
    scale = np.diag(M) * np.asarray(hybrid.ranges.accelerations)
    library = candidates(followed, M, scale)
    tuned = tuned_names(hybrid.profile)
    found = select(
        y / scale,
        np.stack([one.force / scale for one in library], axis=-1),
        [one.family for one in library],
        given=[k for k, one in enumerate(library) if one.name in tuned],
        one_way=np.array([not one.linear for one in library]),
        most=np.array([one.most for one in library]),
        run=followed.runs,
    )
    squares = np.sum((y / scale) ** 2, axis=1)
    classes = sorted(_classes(followed, squares), key=lambda one: one.time - one.force)
    where = tuple(one for one in classes if one.force > one.time >= RARE)[:2]
    return Reading(shares, where, found.given, tuple(_term(one, library) for one in found.chosen), runs)


def mass_matrix(model: Model) -> FloatArray:
    """(3, 3) force that gives accelerations: mass of ship and entrained water [kg, kg m, kg m^2].

    Found from ``physics.rigid_body``, whose accelerations at rest are proportional to the force.
    """
    ship = LaneModel(model, model.matrix()[:, 0]).here(UNKNOWN).ship
    columns = [accelerations(0.0, 0.0, 0.0, X, Y, N, ship) for X, Y, N in np.eye(3).tolist()]
    return np.asarray(np.linalg.inv(np.array(columns, dtype=float).T))


def _term(one: Chosen, library: Sequence[Candidate]) -> Term:
    of = library[one.column]
    value = of.null + one.factor if of.linear else of.value
    shares = dict(zip(COMPONENTS, map(float, one.shares), strict=True))
    rivals = tuple(Rival(library[k].name, library[k].title, share) for k, share in one.alike)
    factor = 1.0 if of.linear else one.factor
    return Term(of.name, of.title, of.told, value, of.unit, factor, one.spread, one.share, shares, rivals)


def _sentence(one: Term, left: bool) -> str:
    """How much of the force, or of what is left of it, a term gives; of one direction where it gives little beside."""
    of = "the rest" if left else "it"
    best = max(one.shares, key=lambda name: one.shares[name])
    share = one.share
    if max(value for name, value in one.shares.items() if name != best) < 0.5 * one.shares[best]:
        of, share = f"{of} in {DIRECTIONS[best]}", one.shares[best]
    return f"{_percent(share)} of {of} looks like {one.cause}."


def _classes(followed: Followed, squares: FloatArray) -> Iterator[Class]:
    """Classes of motion with their share of the time and of ``squares`` (n,)."""
    model = followed.model
    s = followed.at(followed.s)
    u, v_m, r = s[3:6]
    water, speed = flow(u, v_m, r, model.L_pp), np.hypot(u, v_m)
    low, high = np.quantile(speed, [1.0 / 3.0, 2.0 / 3.0])
    yield from _cut("speed", speed, (low, high), "m/s", squares)
    yield from _cut("drift angle", np.abs(water.beta) / DEG, (5.0, 15.0, 30.0, 90.0), "deg", squares)
    yield from _cut("yaw rate r' = r L/U", np.abs(water.r_), (0.2, 0.5, 1.0), "", squares)
    for name, values in zip(model.inputs, followed.at(followed.control), strict=True):
        role, label = INPUTS[name].role, INPUTS[name].words
        if role == "rudder":
            yield from _cut(label, np.abs(values) / DEG, (5.0, 15.0, 25.0), "deg", squares)
        elif role == "propeller":
            for astern, words in ((values >= 0.0, "ahead"), (values < 0.0, "astern")):
                yield _class(f"{label} {words}", astern, squares)
    around = followed.surroundings()
    wind = np.hypot(around.wind_north, around.wind_east)[around.wind_known > 0.0]
    if wind.size == len(squares):
        yield from _cut("wind", wind, tuple(np.quantile(wind, [1.0 / 3.0, 2.0 / 3.0])), "m/s", squares)


def _cut(what: str, values: FloatArray, edges: Sequence[float], unit: str, squares: FloatArray) -> Iterator[Class]:
    """Classes between edges."""
    unit = f" {unit}" if unit else ""
    place = np.searchsorted(edges, values)
    for k in range(len(edges) + 1):
        if k == 0:
            words = f"{what} below {edges[0]:.2g}{unit}"
        elif k == len(edges):
            words = f"{what} above {edges[-1]:.2g}{unit}"
        else:
            words = f"{what} from {edges[k - 1]:.2g} to {edges[k]:.2g}{unit}"
        yield _class(words, place == k, squares)


def _class(words: str, there: BoolArray, squares: FloatArray) -> Class:
    return Class(words, float(np.mean(there)), float(squares[there].sum() / squares.sum()))


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _force(value: float, unit: str) -> str:
    """Three digits with the prefix that suits them, as in 12.8 kN."""
    for size, prefix in ((1e6, "M"), (1e3, "k")):
        if value >= size:
            return f"{value / size:.3g} {prefix}{unit}"
    return f"{value:.3g} {unit}"


def _percent(share: float) -> str:
    return f"{100.0 * share:.0f} %"
