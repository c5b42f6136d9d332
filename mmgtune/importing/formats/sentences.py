"""Sentences of NMEA 0183: what each holds, and which is taken where several hold the same."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from types import MappingProxyType

from ...units import DEG, KNOT, factors

Fields = list[str]
Values = dict[str, float]

POSITIONS = ("GGA", "GNS", "RMC", "GLL")
HOLDERS: Mapping[str, tuple[tuple[str, ...], ...]] = MappingProxyType(
    {
        "position": tuple((kind,) for kind in POSITIONS),
        "velocity": (("VTG",), ("RMC",), ("VBW",)),
        "heading": (("HDT", "THS"), ("HDG",), ("HDM",)),
        "rudder angle": (("RSA",), ("ROR",), ("HTD",)),
        "depth": (("DPT",), ("DBS",)),
    }
)
"""Sentences that hold the same: the first of them that a log has are taken."""
ALONE = ("ROT", "RPM", "MWV", "MWD", "ZDA")
"""Sentences that nothing stands in for."""
KINDS = frozenset((*ALONE, *(kind for several in HOLDERS.values() for kinds in several for kind in kinds)))
ONE_SENSOR = frozenset(KINDS - {"RSA", "ROR", "HTD", "RPM", "ZDA"})
"""Sentences that two sensors may send in turn, each of its own place or zero."""

_SPEED = {letter: factors("m/s")[unit] for letter, unit in (("K", "km/h"), ("M", "m/s"), ("N", "kn"), ("S", "mph"))}
"""Letters of units of speed; S is for statute miles per hour."""
_PER_MINUTE = factors("rad/s")["deg/min"]
_RPM = factors("1/s")["rpm"]
_NUMBER = re.compile(r"[-+]?(\d{1,12}\.?\d{0,30}|\.\d{1,30})")


def chosen(kinds: Mapping[str, int]) -> dict[str, tuple[str, ...]]:
    """For each quantity of ``HOLDERS`` that a log has the sentences that are taken.

    kinds  how often the log has each sentence
    """
    found = {}
    for name, several in HOLDERS.items():
        there = next((some for some in several if any(kinds.get(kind) for kind in some)), None)
        if there is not None:
            found[name] = there
    return found


def stand_ins(taken: Mapping[str, tuple[str, ...]]) -> list[str]:
    """What is taken for something that was not logged, in sentences.

    taken  as ``chosen`` returns it
    """
    rudder, heading = (taken.get(name, ("",))[0] for name in ("rudder angle", "heading"))
    said = []
    if rudder in ("ROR", "HTD"):
        said.append(f"no RSA says the rudder angle: the one ordered is taken ({rudder}), ahead of the rudder in time")
    if heading in ("HDG", "HDM"):
        more = "with what HDG says of deviation and variation" if heading == "HDG" else "without variation"
        said.append(
            f"no HDT or THS says the heading: that of a magnetic compass is taken ({heading}), {more}; "
            "offset in [columns.psi] adds more"
        )
    return said


def values(kind: str, f: Fields) -> Values:
    """What a sentence without a time says, by quantity in the program's units; nothing where it is marked as invalid.

    "n S1" are the revolutions of shaft 1, "n E0" those of an engine.
    Raises ValueError, IndexError or KeyError where it is not what the standard says.
    """
    read = _READ.get(kind)
    return read(f) if read else {}


def number(text: str) -> float:
    """A plain number.  Raises ValueError where it is none: Python reads more than sentences may hold."""
    if not _NUMBER.fullmatch(text):
        raise ValueError
    return float(text)


def of_day(time: str) -> float:
    """ "123519.50" as seconds of the day.  Raises ValueError."""
    h, m, s = number(time[:2]), number(time[2:4]), number(time[4:])
    if not (0.0 <= h < 24.0 and 0.0 <= m < 60.0 and 0.0 <= s < 61.0):
        raise ValueError
    return 3600.0 * h + 60.0 * m + s


def date(year: str, month: str, day: str) -> str:
    """ "2024-05-01".  Raises ValueError where these are no numbers."""
    if not re.fullmatch(r"\d{4}-\d{1,2}-\d{1,2}", found := f"{year}-{month}-{day}"):
        raise ValueError
    return found


def place(f: Fields, at: int) -> tuple[float, float]:
    """Latitude and longitude [deg] of four fields, as "3512.345", "S", "13900.1", "E".

    Raises ValueError or IndexError where it is no place on earth.
    """
    return _degrees(f[at], f[at + 1], "NS", 90.0), _degrees(f[at + 2], f[at + 3], "EW", 180.0)


def velocity(speed: str, course: str) -> Values:
    """Velocity over ground in earth axes [m/s] of a speed [kn] and a course [deg]; nothing where one is missing."""
    if not speed or not course:
        return {}
    size, way = number(speed) * KNOT, number(course) * DEG
    return {"north": size * math.cos(way), "east": size * math.sin(way)}


def _degrees(text: str, side: str, sides: str, most: float) -> float:
    number(text)
    point = text.index(".") if "." in text else len(text)
    degrees, minutes = float(text[: max(0, point - 2)] or 0), float(text[max(0, point - 2) :])
    found = degrees + minutes / 60.0
    if side not in sides or not side or minutes > 60.0 or not 0.0 <= found <= most:
        raise ValueError
    return -found if side == sides[1] else found


def _vtg(f: Fields) -> Values:
    return velocity(f[4], f[0])


def _vbw(f: Fields) -> Values:
    """Speeds over ground of a log along the ship and abeam, starboard positive."""
    return {"u": number(f[3]) * KNOT, "v": number(f[4]) * KNOT} if f[5] == "A" and f[3] and f[4] else {}


def _hdt(f: Fields) -> Values:
    return {"psi": number(f[0]) * DEG} if f[0] else {}


def _ths(f: Fields) -> Values:
    return {} if f[1] == "V" else _hdt(f)


def _hdg(f: Fields) -> Values:
    """Heading of a magnetic sensor, with deviation and variation where it says them, east positive."""
    sides = {"E": 1.0, "W": -1.0}
    added = sum(sides[f[k + 1]] * number(f[k]) for k in (1, 3) if len(f) > k + 1 and f[k])
    return {"psi": (number(f[0]) + added) * DEG} if f[0] else {}


def _rot(f: Fields) -> Values:
    return {"r": number(f[0]) * _PER_MINUTE} if f[0] and f[1] == "A" else {}


def _rsa(f: Fields) -> Values:
    """The single or starboard rudder, and the port one where there is one."""
    angles = [number(f[k]) * DEG for k in (0, 2) if len(f) > k + 1 and f[k] and f[k + 1] == "A"]
    found = {"delta": sum(angles) / len(angles)} if angles else {}
    return found | ({"delta_stbd": angles[0], "delta_port": angles[1]} if len(angles) == 2 else {})


def _htd(f: Fields) -> Values:
    return {"delta": {"R": 1.0, "L": -1.0}[f[2]] * number(f[1]) * DEG} if f[1] and f[2] else {}


def _rpm(f: Fields) -> Values:
    if not f[2] or f[4] != "A":
        return {}
    if f[0] not in ("S", "E") or not re.fullmatch(r"\d{0,2}", f[1]):
        raise ValueError
    return {f"n {f[0]}{f[1]}": number(f[2]) * _RPM}


def _mwv(f: Fields) -> Values:
    if not f[0] or not f[2] or f[4] != "A" or f[1] != "R":
        return {}
    return {"wind_dir_app": number(f[0]) * DEG, "wind_speed_app": number(f[2]) * _SPEED[f[3]]}


def _mwd(f: Fields) -> Values:
    if not f[0] or not (f[6] or f[4]):
        return {}
    return {"wind_dir": number(f[0]) * DEG, "wind_speed": number(f[6]) if f[6] else number(f[4]) * KNOT}


def _dpt(f: Fields) -> Values:
    """Depth of the water: only where the transducer's own depth is said, which is positive."""
    return {"depth": number(f[0]) + number(f[1])} if f[0] and f[1] and number(f[1]) > 0.0 else {}


def _dbs(f: Fields) -> Values:
    return {"depth": number(f[2])} if f[2] else {}


_READ: Mapping[str, Callable[[Fields], Values]] = MappingProxyType(
    {
        "VTG": _vtg,
        "VBW": _vbw,
        "HDT": _hdt,
        "THS": _ths,
        "HDG": _hdg,
        "HDM": _hdt,
        "ROT": _rot,
        "RSA": _rsa,
        "ROR": _rsa,
        "HTD": _htd,
        "RPM": _rpm,
        "MWV": _mwv,
        "MWD": _mwd,
        "DPT": _dpt,
        "DBS": _dbs,
    }
)
"""How the fields of a sentence that carries no time are read."""
