"""Helmsmen: they turn time and heading into rudder orders."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from numbers import Integral
from typing import Protocol

from ..errors import OptionError, Problem, brief
from ..limits import as_float, is_real

RUDDER_MOST, HEADING_MOST = 1.6, 2.0 * math.pi
"""Rudder angle and check heading [rad] beyond which degrees are meant."""


def is_number(value: object, *, least: float = -math.inf, above: float = -math.inf) -> bool:
    """Whether a value is a finite number, not below one limit and above the other."""
    number = as_float(value) if is_real(value) else math.nan
    return math.isfinite(number) and number >= least and number > above


def positive(**given: float) -> None:
    """Raises OptionError for the first of some lengths of time [s] that is not above 0."""
    for name, value in given.items():
        if not is_number(value, above=0.0):
            raise OptionError(Problem(f"{name} is {brief(value)}", name, "it is in seconds", "give a number above 0"))


def whole(least: int, **given: int) -> None:
    """Raises OptionError for the first of some numbers of orders that is less, or not whole."""
    for name, value in given.items():
        if not isinstance(value, Integral) or value < least:
            raise OptionError(Problem(f"{name} is {brief(value)}", name, fix=f"give a whole number, {least} or more"))


def started(at: float) -> None:
    """Raises OptionError for a time of the first order [s] before the start."""
    if not is_number(at, least=0.0):
        raise OptionError(
            Problem(f"the first order is given at {brief(at)}", "at", "it is in seconds", "give 0 or more")
        )


def in_radians(angle: float, name: str, most: float) -> None:
    """Raises OptionError where an angle [rad] is no number, or so large that it must be in degrees."""
    if not is_real(angle) or math.isinf(as_float(angle)):
        kind = "" if is_real(angle) else ", not a number"
        what, fix = f"the {name} is {brief(angle)}{kind}", "write math.radians(35.0) for 35 deg"
        raise OptionError(Problem(what, "", "orders are in radians", fix))
    if not abs(angle) <= most:
        fix = f"write math.radians({angle:g}) if {angle:g} deg is meant"
        raise OptionError(Problem(f"the {name} is {angle:g} rad", "", "orders are in radians", fix))


def ordered(angle: float, name: str) -> None:
    """Raises OptionError for an angle of 0: nothing is ordered then, and the run ends when its time does."""
    if angle == 0.0:
        fix = "write math.radians(35.0) for 35 deg; mmgtune.orders.Straight() leaves the rudder amidships"
        raise OptionError(Problem(f"the {name} is 0", "", "such a manoeuvre orders nothing and never ends", fix))


class Helmsman(Protocol):
    """Turns time and heading into rudder orders; may remember what it has seen: each simulation has its own copy."""

    def order(self, t: float, heading: float) -> float:
        """Rudder ordered [rad] at time t [s] and heading off the approach course [rad]."""
        ...

    def finished(self, heading: float) -> bool:
        """Whether the manoeuvre is complete."""
        ...


@dataclass
class TurningOrder:
    """One rudder angle [rad], starboard positive, from time ``at`` [s] until the heading changed by ``until`` [rad]."""

    angle: float
    at: float = 20.0
    until: float = math.radians(540.0)

    def __post_init__(self) -> None:
        """Raises OptionError for an angle that is 0 or must be degrees, and for times that make no sense."""
        in_radians(self.angle, "rudder angle", RUDDER_MOST)
        ordered(self.angle, "rudder angle")
        started(self.at)
        if not is_number(self.until, above=0.0):
            why = "it ends where the heading has changed by so much"
            raise OptionError(Problem(f"until is {brief(self.until)}", "until", why, "write math.radians(540.0)"))

    def order(self, t: float, heading: float) -> float:
        """See ``Helmsman``."""
        return self.angle if t >= self.at else 0.0

    def finished(self, heading: float) -> bool:
        """See ``Helmsman``."""
        return abs(heading) >= self.until


@dataclass
class ZigzagOrder:
    """Rudder [rad] put over to the other side whenever the heading passes ``heading`` [rad].

    After ``legs`` orders it is over where the next would be given.
    """

    rudder: float
    heading: float
    at: float = 20.0
    legs: int = 5
    _side: float = field(default=0.0, init=False, repr=False, compare=False)
    _given: int = field(default=0, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Raises OptionError for angles that are 0 or must be degrees, and for what makes no sense."""
        in_radians(self.rudder, "rudder angle", RUDDER_MOST)
        in_radians(self.heading, "check heading", HEADING_MOST)
        ordered(self.rudder, "rudder angle")
        ordered(self.heading, "check heading")
        started(self.at)
        whole(1, legs=self.legs)

    def order(self, t: float, heading: float) -> float:
        """See ``Helmsman``."""
        if self._given == 0 and t >= self.at:
            self._side, self._given = 1.0, 1
        elif self._given and heading * self._side * math.copysign(1.0, self.rudder) >= abs(self.heading):
            self._side, self._given = -self._side, self._given + 1
        return self._side * self.rudder

    def finished(self, heading: float) -> bool:
        """See ``Helmsman``."""
        return self._given > self.legs


@dataclass
class SpiralOrder:
    """Dieudonne's spiral: rudder from one side to the other in ``steps``, each kept for ``hold`` [s].

    rudder  of the first and, to the other side, of the last step [rad]
    """

    rudder: float
    hold: float
    steps: int = 9
    at: float = 20.0
    _t: float = field(default=0.0, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Raises OptionError for an angle that is 0 or must be degrees, and for what makes no sense."""
        in_radians(self.rudder, "rudder angle", RUDDER_MOST)
        ordered(self.rudder, "rudder angle")
        positive(hold=self.hold)
        whole(2, steps=self.steps)
        started(self.at)

    def order(self, t: float, heading: float) -> float:
        """See ``Helmsman``."""
        self._t = t
        k = min(math.floor((t - self.at) / self.hold), self.steps - 1)
        return 0.0 if t < self.at else self.rudder * (1.0 - 2.0 * k / (self.steps - 1))

    def finished(self, heading: float) -> bool:
        """See ``Helmsman``."""
        return self._t >= self.at + self.steps * self.hold


@dataclass
class Weave:
    """Rudder orders of changing size and sign every ``hold`` seconds: excites everything a little."""

    hold: float

    def __post_init__(self) -> None:
        """Raises OptionError for a time that is not above 0."""
        positive(hold=self.hold)

    def order(self, t: float, heading: float) -> float:
        """See ``Helmsman``."""
        k = int(t // self.hold)
        return math.radians(25.0) * math.sin(2.4 * k) * (0.4 + 0.6 * math.cos(1.1 * k) ** 2)

    def finished(self, heading: float) -> bool:
        """See ``Helmsman``."""
        return False


@dataclass
class Straight:
    """Rudder amidships."""

    def order(self, t: float, heading: float) -> float:
        """See ``Helmsman``."""
        return 0.0

    def finished(self, heading: float) -> bool:
        """See ``Helmsman``."""
        return False


OF_FEW_ORDERS = (TurningOrder, ZigzagOrder, SpiralOrder, Weave, Straight)
"""Helmsmen who leave the rudder alone for many steps at a time."""
