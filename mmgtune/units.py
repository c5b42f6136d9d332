"""Numbers with units, as people and logs write them; SI inside the program.

Degrees, knots and revolutions per minute appear here and in what people read, nowhere else.  A unit library
would treat a revolution as 2 pi of nothing and turn 106 rpm into 11.1 1/s, so the few units are listed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from .errors import OptionError, Problem, reason

DEG = math.pi / 180.0
KNOT = 1852.0 / 3600.0

NORMAL_95 = 1.96
"""Half width of a 95 % interval of a normal distribution, in standard deviations."""

_FACTORS: dict[str, dict[str, float]] = {
    "m": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "ft": 0.3048, "NM": 1852.0},
    "m^2": {"m^2": 1.0, "cm^2": 1e-4},
    "m/s": {"m/s": 1.0, "kn": KNOT, "km/h": 1.0 / 3.6, "mph": 0.44704, "cm/s": 1e-2, "mm/s": 1e-3, "ft/s": 0.3048},
    "rad": {"rad": 1.0, "deg": DEG, "gon": math.pi / 200.0},
    "deg": {"deg": 1.0, "rad": 1.0 / DEG},
    "rad/s": {"rad/s": 1.0, "deg/s": DEG, "deg/min": DEG / 60.0},
    "rad/s^2": {"rad/s^2": 1.0, "deg/s^2": DEG},
    "s/m": {"s/m": 1.0, "per m/s": 1.0, "per kn": 1.0 / KNOT},
    "m/s^2": {"m/s^2": 1.0, "m/s in ten minutes": 1.0 / 600.0},
    "1/s": {"1/s": 1.0, "rps": 1.0, "rpm": 1.0 / 60.0, "rad/s": 0.5 / math.pi},
    "1/s^2": {"1/s^2": 1.0, "rpm/s": 1.0 / 60.0},
    "N": {"N": 1.0, "kN": 1e3},
    "N m": {"N m": 1.0, "kN m": 1e3},
    "s": {"s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0, "ms": 1e-3, "us": 1e-6},
    "kg/m^3": {"kg/m^3": 1.0, "t/m^3": 1e3},
    "deg/s": {"deg/s": 1.0, "deg/min": 1.0 / 60.0, "rad/s": 1.0 / DEG},
    "%": {"%": 1.0},
    "1/deg": {"1/deg": 1.0, "1/rad": DEG},
    "1/deg^2": {"1/deg^2": 1.0, "1/rad^2": DEG**2},
    "1/deg^3": {"1/deg^3": 1.0, "1/rad^3": DEG**3},
    "1/rad": {"1/rad": 1.0, "1/deg": 1.0 / DEG},
    "1/rad^2": {"1/rad^2": 1.0, "1/deg^2": 1.0 / DEG**2},
    "1/rad^3": {"1/rad^3": 1.0, "1/deg^3": 1.0 / DEG**3},
}

_SYNONYMS = {
    "knots": "kn", "knot": "kn", "kts": "kn", "kt": "kn", "kmh": "km/h", "kph": "km/h", "mps": "m/s", "m s-1": "m/s",
    "mi/h": "mph", "gons": "gon", "gradian": "gon", "gradians": "gon",
    "degree": "deg", "degrees": "deg", "°": "deg", "radian": "rad", "radians": "rad",
    "°/s": "deg/s", "degrees/s": "deg/s", "deg/sec": "deg/s", "dps": "deg/s", "rad/sec": "rad/s",
    "°/min": "deg/min", "deg/minute": "deg/min",
    "1/min": "rpm", "r/min": "rpm", "min-1": "rpm", "rev/min": "rpm", "u/min": "rpm", "tr/min": "rpm",
    "omw/min": "rpm", "hz": "1/s", "rev/s": "rps", "s-1": "1/s",
    "metre": "m", "metres": "m", "meter": "m", "meters": "m", "feet": "ft", "foot": "ft", "nmi": "NM", "nm": "NM",
    "sec": "s", "second": "s", "seconds": "s", "minutes": "min", "minute": "min", "hours": "h", "msec": "ms",
    "day": "d", "days": "d",
}  # fmt: skip
"""Names that people and loggers give to units, in small letters."""

DIMENSIONLESS = ("-", "prime")

_SHOWN = {"rad": "deg", "rad/s": "deg/s", "1/s": "rpm", "1/s^2": "rpm/s"}
"""SI units that people read something else for."""

_IN_SENTENCES = {"rad/s^2": "deg/s^2", "N": "kN", "N m": "kN m", "m/s^2": "m/s in ten minutes", "s/m": "per m/s"}
"""More of these, for sizes of causes."""

SMALL_FORCE = 100.0
"""Force or moment [N, N m] below which nobody speaks of kN."""

SLOW_DRIFT = 0.01 * DEG
"""Rate [rad/s] below which nobody speaks of °/s."""

_SIGNS = {"deg": "°", "deg/s": "°/s", "deg/s^2": "°/s²"}


def shown_in(unit: str) -> tuple[str, float]:
    """The unit people read instead of an SI one, and the factor to it: degrees, revolutions per minute."""
    shown = _SHOWN.get(unit, unit)
    return shown, 1.0 if shown == unit else 1.0 / _FACTORS[unit][shown]


def read_as(unit: str, size: float = math.inf) -> tuple[str, float]:
    """The unit in which people read the size of a cause, with signs for words (°), and the factor to it from SI.

    size  in SI, of what is to be read: forces on a model ship are told in N, the drift of a gyro in °/min
    """
    if unit == "rad/s" and abs(size) < SLOW_DRIFT:
        return "°/min", 60.0 / DEG
    if unit in ("N", "N m") and abs(size) < SMALL_FORCE:
        return unit, 1.0
    word, factor = shown_in(unit)
    if unit in _IN_SENTENCES:
        word = _IN_SENTENCES[unit]
        factor = 1.0 / _FACTORS[unit][word]
    return _SIGNS.get(word, word), factor


_QUANTITY = re.compile(r"^\s*((?:[-+0-9.eE]+\s*,\s*)*[-+0-9.eE]+)\s*([^\s0-9].*?|1/.*?)?\s*$")


LONGEST = 2000
"""Characters a quantity may have."""
_NOT_FINITE = re.compile(r"^\s*[-+]?(nan|inf|infinity)(\s.*)?$", re.IGNORECASE)
_DECIMAL_COMMA = re.compile(r"^\s*([-+]?[0-9]+),([0-9]+)(\s*[^\s0-9,].*)?$")


class Unreadable(ValueError):
    """A text that is no quantity: a sentence that says so, and ``fix``, what to write instead."""

    def __init__(self, words: str, fix: str):
        super().__init__(words)
        self.fix = fix


_INFINITE = re.compile(r"^\s*(inf)\s+(\S.*?)\s*$")


def parse(text: str, unit: str, infinite: bool = False) -> tuple[float, ...]:
    """The numbers of "12 kn" or "0, 10, 18 deg" in ``unit``; "inf deg/s" too where ``infinite`` allows it.

    Raises Unreadable with a sentence saying what was expected.
    """
    such = f'write a number with its unit, such as "{example(unit)}"'
    if len(text) > LONGEST:
        raise Unreadable(f"'{text[:40]}...' is too long for a number with a unit, such as '{example(unit)}'", such)
    match = (_INFINITE.match(text) if infinite else None) or _QUANTITY.match(text)
    if match is None and _NOT_FINITE.match(text):
        raise Unreadable(f"'{text}' is not a finite number", such)
    if match is None:
        raise Unreadable(f"'{text}' is not a number with a unit, such as '{example(unit)}'", such)
    written = (match.group(2) or "").strip()
    known = factors(unit)
    if unit in DIMENSIONLESS:
        if written and written != "-":
            raise Unreadable(f"'{text}' has a unit where a pure number belongs", f"write {match.group(1)}")
        factor = 1.0
    elif not written:
        fix = f'write "{text.strip()} {unit}" if it is in {unit}'
        raise Unreadable(f"'{text}' has no unit; write for example '{example(unit)}'", fix)
    elif written not in known:
        meant = canonical(written)
        fix = f'write "{match.group(1)} {meant}"' if meant in known else f"write it in {' or '.join(known)}"
        raise Unreadable(f"unit '{written}' is not one of {', '.join(known)}", fix)
    else:
        factor = known[written]
    try:
        return tuple(float(number) * factor for number in match.group(1).split(","))
    except ValueError:
        raise Unreadable(f"'{text}' is not a number with a unit, such as '{example(unit)}'", such) from None


def quantity(text: str, name: str, unit: str, such_as: str, bare: bool = False) -> float:
    """One number of an option with its unit, in ``unit``.

    such_as  how the option may be written
    bare     whether a number without a unit is understood too, elsewhere
    Raises OptionError that says what to write.
    """
    what, fix = f"'{text[:80]}' cannot be read", f"write {name}={such_as}"
    pointed = with_point(text)
    number = _plain(text if pointed is None else pointed)
    if number is not None and not bare:
        fix = f'write {name}="{number} {unit}" if it is in {unit}'
    elif pointed is not None:
        fix = f'write {name}="{pointed}"'
    if pointed is not None:
        raise OptionError(Problem(what, name, "numbers have a decimal point here", fix))
    try:
        numbers = parse(with_known_unit(text), unit)
    except Unreadable as error:
        raise OptionError(Problem(what, name, reason(error), fix)) from None
    if len(numbers) != 1:
        raise OptionError(Problem(what, name, f"it is {len(numbers)} numbers, not one", fix))
    return numbers[0]


def _plain(text: str) -> str | None:
    """A number without a unit, None for anything else."""
    match = _QUANTITY.match(text[:LONGEST])
    return match[1] if match and not match[2] and "," not in match[1] else None


def with_point(text: str) -> str | None:
    """ "83.0 m" for "83,0 m": one number written with a decimal comma; None for anything else."""
    match = _DECIMAL_COMMA.match(text[:LONGEST])
    return f"{match[1]}.{match[2]}{match[3] or ''}" if match else None


def with_known_unit(text: str) -> str:
    """ "15 kn" for "15 knots": a quantity with its unit by the name known here; other texts as they are."""
    match = _QUANTITY.match(text[:LONGEST])
    return f"{match[1]} {canonical(match[2])}" if match and match[2] else text


def canonical(unit: str) -> str:
    """A unit by the name the program knows it by; unknown ones as they are."""
    unit = unit.strip()
    return _SYNONYMS.get(unit.lower(), unit)


def name_and_unit(header: str, brackets: Sequence[tuple[str, str]] = (("[", "]"),)) -> tuple[str, str]:
    """Name and unit of a column headed "u [m/s]", as it is written; the header as it is, and "", where it has none.

    brackets  pairs of marks that a unit may stand in, at the end
    """
    text = header.rstrip()
    for opening, closing in brackets:
        if text.endswith(closing):
            name, mark, unit = text[:-1].rpartition(opening)
            if mark and unit and closing not in unit:
                return name.rstrip(), unit
    return header, ""


def is_unit(text: str) -> bool:
    """Whether a text is a unit and no number with one: "1/min" as well as "rpm"."""
    return any(canonical(text) in known for known in _FACTORS.values())


def factors(unit: str) -> dict[str, float]:
    """Units a quantity in ``unit`` may be written in, and what a number in each is multiplied by.

    One that is not listed, of a coefficient of one's own, may be written as it is.
    """
    return dict(_FACTORS.get(unit, {unit: 1.0}))


EXAMPLE = 1.5
"""The number of examples."""


def example(unit: str) -> str:
    """How a quantity of this unit is written."""
    return f"{EXAMPLE:g}" if unit in DIMENSIONLESS else f"{EXAMPLE:g} {unit}"


def example_in_toml(unit: str, low: float | None = None, high: float | None = None) -> str:
    """How a quantity of this unit is written in TOML: a number between limits (exclusive), where there are any."""
    number = EXAMPLE
    if (low is not None and number <= low) or (high is not None and number >= high):
        below = low if low is not None else min(0.0, 2.0 * (high or 0.0)) - 1.0
        above = high if high is not None else max(0.0, 2.0 * (low or 0.0)) + 1.0
        number = 0.5 * (below + above)
    return f"{number:.3g}" if unit in DIMENSIONLESS else f'"{number:.3g} {unit}"'


def likely(value: float, unit: str, low: float | None, high: float | None) -> str:
    """The unit that a number without one may be in: ``unit``, or what people read for it where limits allow no other.

    low, high  in ``unit``, exclusive
    """

    def may_be(one: str) -> bool:
        number = value * _FACTORS[unit][one]
        return (low is None or number > low) and (high is None or number < high)

    return next((one for one in (unit, _SHOWN.get(unit, unit)) if may_be(one)), unit)


def shown(value: float, unit: str) -> str:
    """A quantity as profiles hold it: text that reads back to the same number.

    It is in the unit people read, degrees, knots or rpm, where the number itself has more digits than anybody wrote.
    """
    if unit in DIMENSIONLESS:
        return repr(value)
    if math.isfinite(value) and float(f"{value:.6g}") != value:
        for other in (_SHOWN.get(unit), "kn" if unit == "m/s" else None):
            text = f"{value / _FACTORS[unit][other]:.6g} {other}" if other else ""
            if text and parse(text, unit) == (value,):
                return text
    return f"{value!r} {unit}"


def in_time(seconds: float) -> str:
    """A time as people say it, to about a tenth: "40 s", "12 min", "1.5 h"; a second at least."""
    if seconds < 99.5:
        return f"{max(1.0, seconds):.2g} s"
    minutes = seconds / 60.0
    if minutes < 99.5:
        return f"{minutes:.2g} min"
    hours = minutes / 60.0
    return f"{hours:.2g} h" if hours < 99.5 else f"{hours:.0f} h"
