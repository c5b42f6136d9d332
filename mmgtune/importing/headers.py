"""Names of columns as logs print them, and the units in them."""

from __future__ import annotations

import re
from collections.abc import Sequence

_SYNONYMS = {
    "knots": "kn", "knot": "kn", "kts": "kn", "kt": "kn", "kmh": "km/h", "kph": "km/h", "mps": "m/s", "m s-1": "m/s",
    "degree": "deg", "degrees": "deg", "°": "deg", "radian": "rad", "radians": "rad",
    "°/s": "deg/s", "degrees/s": "deg/s", "deg/sec": "deg/s", "dps": "deg/s", "rad/sec": "rad/s",
    "°/min": "deg/min", "deg/minute": "deg/min",
    "1/min": "rpm", "r/min": "rpm", "min-1": "rpm", "rev/min": "rpm", "hz": "1/s", "rev/s": "rps", "s-1": "1/s",
    "metre": "m", "metres": "m", "meter": "m", "meters": "m", "feet": "ft", "foot": "ft", "nmi": "NM", "nm": "NM",
    "sec": "s", "second": "s", "seconds": "s", "minutes": "min", "minute": "min", "hours": "h", "msec": "ms",
}  # fmt: skip

_UNIT = re.compile(r"^(.*?)\s*(?:\[([^\[\]]+)\]|\(([^()]+)\))\s*$")


def canonical(unit: str) -> str:
    """A unit by the name the program knows it by; unknown ones as they are."""
    unit = unit.strip()
    return _SYNONYMS.get(unit.lower(), unit)


def unit_in(header: str) -> str | None:
    """The unit in a header such as "u_velo [m/s]" or "speed (kn)"; None where it has none."""
    match = _UNIT.match(header)
    return canonical(match.group(2) or match.group(3)) if match else None


def bare(header: str) -> str:
    """A header without its unit."""
    match = _UNIT.match(header)
    return (match.group(1) if match else header).strip()


def find_column(wanted: str | int, names: Sequence[str]) -> int | None:
    """Position of a column by number (from 1), by name, or by its name without unit or case; None if not there."""
    if isinstance(wanted, int):
        return wanted - 1 if wanted <= len(names) else None
    for same in (str.strip, bare, lambda name: bare(name).lower()):
        found = [k for k, name in enumerate(names) if same(name) == same(wanted)]
        if len(found) == 1:
            return found[0]
        if found:
            return None
    return None
