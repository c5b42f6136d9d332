"""A ship profile in memory."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from ..components import ARRANGEMENTS, Arrangement, Component, split_name
from ..displayed import Brief, Displayed
from ..errors import OptionError, Problem, ProfileError, among, must_be_a
from ..inputs import INPUTS
from ..physics.actuation import moved
from ..units import DIMENSIONLESS
from .doubts import Doubt

ABSENT = "absent"
"""Source of a parameter of an effect that stands at its null and need not be written."""


@dataclass(frozen=True, repr=False)
class Coefficient(Brief):
    """One number (or table) of a profile with what is known of it; value in the unit of its field.

    bounds          where a fit may look for it, whatever a_r is
    pre_determined  before any tuning
    stderr          standard error, of one that was tuned
    scatter         how far ships lie about the formula that gives it, one standard deviation
    warning         why it may be wrong, such as a formula used outside its range
    """

    value: float | tuple[float, ...]
    source: str
    assumption: bool = False
    note: str = ""
    bounds: tuple[float, float] | None = None
    pre_determined: float | None = None
    stderr: float | None = None
    scatter: float | None = None
    warning: str = ""


@dataclass(frozen=True, repr=False)
class Section(Brief):
    """One component of the ship with its coefficients, in the order of the component's fields."""

    component: Component
    coefficients: dict[str, Coefficient]
    source: str

    @property
    def numbers(self) -> dict[str, float]:
        """Every number as "section.symbol", those of a table as "section.symbol[0]", "[1]", ..."""
        found: dict[str, float] = {}
        for symbol, coefficient in self.coefficients.items():
            name, value = f"{self.component.kind}.{symbol}", coefficient.value
            if isinstance(value, tuple):
                found.update({f"{name}[{k}]": number for k, number in enumerate(value)})
            else:
                found[name] = value
        return found


@dataclass(frozen=True)
class Actuator:
    """Limits of what moves one input, for manoeuvres that give orders: low and high in its unit, rate in that per s."""

    low: float
    high: float
    rate: float

    def moved(self, value: Any, ordered: Any, dt: Any) -> Any:
        """What the input has become after dt [s] of a constant rate towards the order; numbers or arrays."""
        return moved(value, ordered, self.low, self.high, self.rate * dt)


@dataclass(frozen=True)
class SteeringGear:
    """Limits of every rudder that has no actuator of its own: max_angle [rad] to either side, rate [rad/s].

    source  where they come from, "" where the profile does not say
    """

    max_angle: float
    rate: float
    source: str = ""

    @property
    def actuator(self) -> Actuator:
        """Its limits as those of an actuator."""
        return Actuator(-self.max_angle, self.max_angle, self.rate)


@dataclass(frozen=True)
class Approach:
    """The condition standard manoeuvres start from: speed [m/s], propeller revolutions n [1/s].

    source  where they come from, "" where the profile does not say
    """

    speed: float
    n: float
    source: str = ""


@dataclass(frozen=True)
class ShipProfile(Displayed):
    """A ship: its components and coefficients, and what standard manoeuvres need.

    Two profiles are equal that say the same, wherever and however it is written.

    limits    what each metric of a trial may be at most, by its name, in its unit (``metrics.METRICS``)
    licence   of the data it was tuned to, where they have one; citation says how these are to be cited
    arrangement  how the components are put together
    actuators    limits of what moves the inputs, by input; see ``actuator``
    template  the TOML it was read from, "" for one made in memory: the place for ``text``, comments and all
    """

    id: str
    name: str
    source: str
    sections: dict[str, Section]
    steering_gear: SteeringGear | None
    approach: Approach | None
    targets: tuple[str, ...]
    limits: dict[str, float] = field(default_factory=dict)
    provenance: dict[str, Any] = field(default_factory=dict)
    licence: str = ""
    citation: str = ""
    arrangement: Arrangement = ARRANGEMENTS[0]
    actuators: dict[str, Actuator] = field(default_factory=dict)
    path: Path | None = field(default=None, compare=False)
    template: str = field(default="", compare=False, repr=False)

    @cached_property
    def text(self) -> str:
        """This profile as TOML, as it is now: the template with everything in it that differs."""
        from .writing import profile_text

        return profile_text(self)

    @cached_property
    def sha256(self) -> str:
        """Of ``text``."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    def actuator(self, name: str) -> Actuator | None:
        """What moves an input: its own actuator, else the steering gear for a rudder; None where orders act at once."""
        gear = self.steering_gear.actuator if self.steering_gear and INPUTS[name].role == "rudder" else None
        return self.actuators.get(name, gear)

    def require_approach(self) -> Approach:
        """Speed and revolutions of the approach.  Raises OptionError where the profile has none."""
        if self.approach is None:
            what, why = "the approach condition is not known", "the profile has no [approach] section"
            raise OptionError(Problem(what, str(self.path or self.id), why, "add one, or give speed and rpm"))
        return self.approach

    def __hash__(self) -> int:
        """The same of profiles that are equal."""
        numbers = (number for section in self.sections.values() for number in section.numbers.items())
        return hash((self.id, self.name, tuple(numbers)))

    def __repr__(self) -> str:
        """In a line."""
        parts = ", ".join(f"{kind} {section.component.tag}" for kind, section in list(self.sections.items())[:6])
        more = ", ..." if len(self.sections) > 6 else ""
        return f"ShipProfile({self.id}: {parts}{more})"

    def coefficient(self, name: str) -> Coefficient:
        """The coefficient called 'section.symbol'.  Raises ProfileError if there is none, OptionError for no text."""
        must_be_a(name, str, "name")
        section, symbol = split_name(name)
        found = self.sections[section].coefficients.get(symbol) if section in self.sections else None
        if found is None:
            raise ProfileError(Problem(f"no number '{name}'", str(self.path or self.id), **self._meant_by(name)))
        return found

    def _meant_by(self, name: str) -> dict[str, str]:
        """Why and fix of a name that no number has: symbols alone are not names, others may be misspelt."""
        known = [f"{kind}.{symbol}" for kind, section in self.sections.items() for symbol in section.coefficients]
        same = [f"'{one}'" for one in known if split_name(one)[1] == name]
        if same:
            return {"why": "numbers are called SECTION.SYMBOL", "fix": f"write {' or '.join(same)}"}
        return among(name, known)

    def names(self) -> list[str]:
        """Every 'section.symbol' that holds one number, in order."""
        return [
            f"{kind}.{symbol}"
            for kind, section in self.sections.items()
            for symbol, coefficient in section.coefficients.items()
            if not isinstance(coefficient.value, tuple)
        ]

    def value(self, name: str) -> float:
        """The number called 'section.symbol'.  Raises ProfileError where there is none, or it is a table."""
        value = self.coefficient(name).value
        if isinstance(value, tuple):
            why, fix = "it has several numbers", f"write coefficient('{name}').value"
            raise ProfileError(Problem(f"'{name}' is a table", str(self.path or self.id), why, fix))
        return value

    def written(self, name: str) -> str:
        """The value called 'section.symbol' as a person writes it: number with unit, list, or word."""
        section, symbol = split_name(name)
        field = self.sections[section].component.fields[symbol]
        value = self.coefficient(name).value
        for word, number in field.choices.items():
            if number == value:
                return word
        numbers = ", ".join(f"{number:.4g}" for number in (value if isinstance(value, tuple) else (value,)))
        return numbers if field.unit in DIMENSIONLESS else f"{numbers} {field.unit}"

    @property
    def L_pp(self) -> float:
        """Length between perpendiculars [m]."""
        return self.value("particulars.L_pp")

    def assumptions(self) -> list[tuple[str, Coefficient]]:
        """The coefficients marked as assumptions."""
        return [
            (f"{kind}.{symbol}", coefficient)
            for kind, section in self.sections.items()
            for symbol, coefficient in section.coefficients.items()
            if coefficient.assumption
        ]

    def doubts(self) -> list[Doubt]:
        """The coefficients that may be wrong, each with why."""
        return [
            Doubt(
                f"{kind}.{symbol}",
                None if isinstance(one.value, tuple) else one.value,
                section.component.fields[symbol].unit,
                one.warning,
            )
            for kind, section in self.sections.items()
            for symbol, one in section.coefficients.items()
            if one.warning
        ]

    def cites(self) -> list[str]:
        """The papers behind the components in use, each once."""
        return list(dict.fromkeys(cite for section in self.sections.values() for cite in section.component.cites))
