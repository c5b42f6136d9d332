"""A trial of which only indices are known, as a sea-trial report gives them: advance, overshoots, stopping distance.

Files are TOML with one or several tables ``[[trial]]`` (docs/formats.md).  Each stated number has a tolerance, one
standard deviation of trial and reading together.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import limits, units
from ..errors import Problem, TrialError, among, brief, closest, reason
from ..files import can_name_file
from ..limits import NAME
from ..toml_reading import TomlReader, finite, is_map, toml_of
from ..units import DEG
from .raw_logs import map_instead
from .schema import SOURCES

SCHEMA = 1
MANOEUVRES = ("turning", "zigzag", "stopping")
KEYS = ("id", "ship", "manoeuvre", "order", "approach_speed", "n", "source", "note", "indices")
LEAST, MOST = 1e-6, 1e6
"""Sizes in SI, or ship lengths, beyond which nothing that is stated can be, angles apart, nor its tolerance."""

SHARPEST = 1e-6
"""Share of a value below which a tolerance is none: residuals over it would be beyond all numbers."""

LENGTH = re.compile(r"^\s*([-+0-9.eE]+)\s*L\s*$")
"""A length in ship lengths between perpendiculars: "3.01 L"."""


@dataclass(frozen=True)
class Index:
    """An index that can be stated.

    of         manoeuvres that show it
    unit       SI
    share, absolute  tolerance where a report gives none, as a share of the value or in the unit; an assumption
    """

    words: str
    of: tuple[str, ...]
    unit: str
    share: float = 0.0
    absolute: float = 0.0


_TURN, _ZIGZAG, _STOP, _ANY = ("turning",), ("zigzag",), ("stopping",), ("turning", "zigzag")

INDICES: Mapping[str, Index] = {
    "advance": Index("advance", _TURN, "m", 0.05),
    "transfer": Index("transfer", _TURN, "m", 0.1),
    "tactical_diameter": Index("tactical diameter", _TURN, "m", 0.05),
    "steady_diameter": Index("steady diameter", _TURN, "m", 0.1),
    "steady_speed": Index("steady speed", _TURN, "m/s", 0.1),
    "steady_yaw_rate": Index("steady yaw rate", _TURN, "rad/s", 0.1),
    "steady_drift_angle": Index("steady drift angle", _TURN, "rad", absolute=2.0 * DEG),
    **{f"time_{k}": Index(f"time to {k} deg", _TURN, "s", 0.05) for k in (90, 180, 270, 360)},
    **{f"speed_ratio_{k}": Index(f"speed ratio at {k} deg", _TURN, "-", absolute=0.05) for k in (90, 180, 360)},
    "initial_turning_distance": Index("initial turning distance", _ANY, "m", 0.05),
    "initial_turning_time": Index("initial turning time", _ZIGZAG, "s", 0.05),
    "overshoot_1": Index("1st overshoot", _ZIGZAG, "rad", absolute=1.5 * DEG),
    "overshoot_2": Index("2nd overshoot", _ZIGZAG, "rad", absolute=3.0 * DEG),
    "overshoot_3": Index("3rd overshoot", _ZIGZAG, "rad", absolute=3.0 * DEG),
    "reach": Index("reach", _ZIGZAG, "s", 0.05),
    "period": Index("period", _ZIGZAG, "s", 0.05),
    "track_reach": Index("track reach", _STOP, "m", 0.1),
    "head_reach": Index("head reach", _STOP, "m", 0.1),
    "stopping_time": Index("stopping time", _STOP, "s", 0.1),
}
"""By the names of ``manoeuvres``.  Tolerances are choices of this program, after what basins and ships differ by: 1.5
deg of the first overshoot and 3 deg of the second between towing tanks, 7 to 8 % of advance and tactical diameter of a
model in wind."""

SMALLER: tuple[tuple[str, str], ...] = (
    ("transfer", "tactical_diameter"),
    ("initial_turning_distance", "advance"),
    ("head_reach", "track_reach"),
    ("time_90", "time_180"),
    ("time_180", "time_270"),
    ("time_270", "time_360"),
    ("reach", "period"),
)
"""Pairs of which the first is less than the second on any ship."""


@dataclass(frozen=True)
class Stated:
    """A number of a report with its tolerance, in SI units or in ship lengths.

    in_lengths  value and tolerance are over L_pp
    assumed     whether the tolerance is the program's
    """

    value: float
    tolerance: float
    in_lengths: bool = False
    assumed: bool = False


@dataclass(frozen=True, eq=False)
class IndexTrial:
    """One manoeuvre known by its indices.

    manoeuvre  "turning", "zigzag" or "stopping"
    rudder     ordered [rad], starboard positive; 0 for a stop
    check      check heading of a zigzag [rad], else None
    astern     revolutions ordered of a stop [1/s], negative, else None
    approach_speed, n  [m/s], [1/s]; None for the profile's approach
    """

    id: str
    ship: str
    manoeuvre: str
    rudder: float
    check: float | None
    astern: float | None
    indices: Mapping[str, Stated]
    approach_speed: float | None = None
    n: float | None = None
    source: str = ""
    note: str = ""
    path: Path | None = None
    sha256: str = ""

    def __repr__(self) -> str:
        """In a line."""
        return f"IndexTrial({self.id}: {self.order}, {len(self.indices)} indices)"

    @property
    def order(self) -> str:
        """In words: "turning, 35 deg to port"."""
        side = "port" if self.rudder < 0.0 else "starboard"
        if self.astern is not None:
            return f"stopping, {self.astern * 60.0:.4g} rpm"
        angle = f"{abs(self.rudder) / DEG:.3g}"
        if self.check is not None:
            return f"zigzag {angle}/{self.check / DEG:.3g} deg, to {side} first"
        return f"turning, {angle} deg to {side}"

    @property
    def run(self) -> str:
        """Its id: what was sailed in one go."""
        return self.id

    def stated(self, L_pp: float) -> dict[str, tuple[float, float]]:
        """Value and tolerance of each index in SI units, for a ship of a length [m]."""
        scale = {name: L_pp if one.in_lengths else 1.0 for name, one in self.indices.items()}
        return {name: (scale[name] * one.value, scale[name] * one.tolerance) for name, one in self.indices.items()}

    def describe(self) -> dict[str, Any]:
        """Facts for JSON, numbers in the units of the file: SI, or ship lengths."""
        return {
            "id": self.id,
            "ship": self.ship,
            "manoeuvre": self.manoeuvre,
            "order": self.order,
            "source": self.source,
            "note": self.note,
            "sha256": self.sha256,
            "indices": {
                name: {
                    "value": one.value,
                    "tolerance": one.tolerance,
                    "unit": "L" if one.in_lengths else INDICES[name].unit,
                    "assumed_tolerance": one.assumed,
                }
                for name, one in self.indices.items()
            },
        }


def shown_index(name: str, value: float, L_pp: float | None = None) -> tuple[float, str]:
    """An index in SI as people read it, with its unit: degrees for angles, ship lengths where L_pp [m] is given."""
    unit = INDICES[name].unit
    if unit == "m" and L_pp:
        return value / L_pp, "L"
    shown, factor = units.shown_in(unit)
    return value * factor, "" if shown == "-" else shown


def has_index_trials(path: Path) -> bool:
    """Whether a TOML file in a folder of trials is of such trials, and no profile or map that lies there.

    Raises TrialError where it cannot be read.
    """
    data = _data(path, profile=True)[0]
    # A map of logs has a table [trial] too, for what their trials have in common; it goes with what it says of a log.
    return "trial" in data and not is_map(data)


def read_index_trials(path: Path) -> tuple[list[IndexTrial], list[Problem]]:
    """The trials of a file, and everything wrong with it."""
    try:
        data, text = _data(path)
    except TrialError as error:
        return [], list(error.problems)
    if is_map(data):
        return [], [map_instead(path)]
    reader = TomlReader(data, text, str(path))
    reader.schema(SCHEMA)
    reader.unknown("", data, ("schema", "trial"))
    tables = data.get("trial", [])
    tables = [tables] if isinstance(tables, dict) else tables
    if not isinstance(tables, list) or not tables or not all(isinstance(one, dict) for one in tables):
        reader.problem("there is no table [trial]", fix='write [trial], id = "...", manoeuvre = "turning", ...')
        return [], reader.problems
    found = [_Table(reader, one, path).read() for one in tables]
    return [one for one in found if one is not None], reader.problems


def _data(path: Path, profile: bool = False) -> tuple[dict[str, Any], str]:
    """The tables of a file, and its text; ``profile`` where it may be a ship profile."""
    try:
        text = limits.text(path, limits.SPLIT_BYTES, TrialError)
    except (OSError, ValueError) as error:
        what = "the file of stated indices cannot be read"
        raise TrialError(Problem(what, str(path), reason(error), "it must be UTF-8 text")) from error
    return toml_of(text, "the file of stated indices", str(path), TrialError, profile=profile, log_map=True), text


class _Table:
    """One table [trial] on its way into a trial."""

    def __init__(self, reader: TomlReader, table: dict[str, Any], path: Path):
        self.reader, self.table, self.path = reader, table, path
        self.called = table.get("id") if isinstance(table.get("id"), str) else "?"

    def wrong(self, what: str, key: str = "", why: str = "", fix: str = "", table: str = "trial") -> None:
        self.reader.problem(f"trial '{self.called}': {what}", table, key, why, fix)

    def read(self) -> IndexTrial | None:
        reader, table = self.reader, self.table
        before = len(reader.problems)
        for key in table:
            if key not in KEYS:
                self.wrong(f"unknown key '{key}'", key, **among(key, KEYS))
        texts = {key: reader.text_of("trial", table, key) for key in ("id", "ship", "order", "note")}
        self._id(texts["id"])
        source = reader.choice("trial", table, "source", ("", *SOURCES)) or ""
        manoeuvre = reader.choice("trial", table, "manoeuvre", MANOEUVRES)
        if "manoeuvre" not in table:
            self.wrong("no manoeuvre", fix=f"write manoeuvre = one of {', '.join(MANOEUVRES)}")
        speed = self._positive("approach_speed", "m/s", 30.0)
        n = self._positive("n", "1/s", 100.0)
        rudder, check, astern = self._order(manoeuvre, texts["order"]) if manoeuvre else (0.0, None, None)
        indices = self._indices(manoeuvre)
        if len(reader.problems) > before or manoeuvre is None:
            return None
        content = repr((sorted(texts.items()), manoeuvre, rudder, check, astern, speed, n, sorted(indices.items())))
        return IndexTrial(
            id=texts["id"],
            ship=texts["ship"],
            manoeuvre=manoeuvre,
            rudder=rudder,
            check=check,
            astern=astern,
            indices=indices,
            approach_speed=speed,
            n=n,
            source=source,
            note=texts["note"],
            path=self.path,
            sha256=hashlib.sha256(content.encode()).hexdigest(),
        )

    def _id(self, name: str) -> None:
        if not name:
            self.wrong("it has no id", "id", fix='write id = "turn_35"')
        elif not can_name_file(name):
            self.wrong("its id cannot be the name of a file", "id", fix="use letters, digits, '_' and '-'")
        elif too_long := NAME.problem(len(name), self.reader.where):
            self.reader.problems.append(too_long)

    def _quantity(self, key: str, written: Any, unit: str, table: str) -> float | None:
        found = self.reader.quantities(table, key, written, unit)
        if found is None:
            return None
        if len(found) != 1 or finite(found[0]) is None:
            self.wrong(f"'{key}' is {brief(written)}, not one number", key, table=table)
            return None
        return found[0]

    def _positive(self, key: str, unit: str, most: float) -> float | None:
        if key not in self.table:
            return None
        value = self._quantity(key, self.table[key], unit, "trial")
        if value is not None and not 0.0 < value <= most:
            self.wrong(f"{key} is {brief(self.table[key])}", key, fix=f"give a value above 0 and up to {most:g} {unit}")
            return None
        return value

    def _order(self, manoeuvre: str, order: str) -> tuple[float, float | None, float | None]:
        """Rudder, check heading and revolutions astern out of an order in words."""
        if manoeuvre == "stopping":
            n = self._quantity("order", order, "1/s", "trial") if order else None
            if not order:
                self.wrong("no order", fix='write order = "-60 rpm", the revolutions astern')
            elif n is not None and not -100.0 < n < 0.0:
                self.wrong(f"order is '{order}'", "order", "revolutions astern are negative", 'write order = "-60 rpm"')
            return 0.0, None, n
        example = "35 deg" if manoeuvre == "turning" else "20/20 deg"
        numbers = 1 if manoeuvre == "turning" else 2
        said = re.fullmatch(r"\s*(-?[\d.]+)(?:\s*/\s*([\d.]+))?\s*(deg|rad)\s*(?:to\s+)?(port|starboard)?\s*", order)
        try:
            angles = (
                [float(one) * (DEG if said[3] == "deg" else 1.0) for one in (said[1], said[2]) if one] if said else []
            )
        except ValueError:
            angles = []
        if said is None or len(angles) != numbers:
            why = "rudder to starboard is positive" if order else ""
            self.wrong(f"order is {brief(order)}", "order", why, f'write order = "{example}", or "{example} to port"')
            return 0.0, None, None
        if said[4] == "starboard" and angles[0] < 0.0:
            why = "its sign says port, its words say starboard"
            self.wrong(f"order is '{order}'", "order", why, "leave the sign out, or the side")
        rudder = angles[0] if said[4] != "port" else -abs(angles[0])
        if not 0.0 < abs(rudder) <= 90.0 * DEG or (numbers == 2 and not 0.0 < angles[1] <= 90.0 * DEG):
            self.wrong(f"order is '{order}'", "order", "angles of manoeuvres lie between 0 and 90 deg")
        return rudder, angles[1] if numbers == 2 else None, None

    def _indices(self, manoeuvre: str | None) -> dict[str, Stated]:
        table = self.table.get("indices")
        if not isinstance(table, dict) or not table:
            self.wrong("no indices", fix='write [trial.indices], advance = { value = "3.0 L", tolerance = "0.1 L" }')
            return {}
        known = [name for name, one in INDICES.items() if manoeuvre is None or manoeuvre in one.of]
        found = {}
        for name, written in table.items():
            if name not in known:
                why = f"it is none of a {manoeuvre} manoeuvre" if name in INDICES else ""
                self.wrong(f"unknown index '{name}'", name, why, closest(name, known), table="trial.indices")
            elif (stated := self._stated(name, written)) is not None:
                found[name] = stated
        for less, more in SMALLER:
            a, b = found.get(less), found.get(more)
            if a and b and a.in_lengths == b.in_lengths and a.value >= b.value:
                self.wrong(f"{less} is not below {more}", less, "on no ship", "correct one", table="trial.indices")
        return found

    def _stated(self, name: str, written: Any) -> Stated | None:
        index, where = INDICES[name], "trial.indices"
        if isinstance(written, dict):
            for key in written:
                if key not in ("value", "tolerance"):
                    self.wrong(f"unknown key '{name}.{key}'", name, fix="value, tolerance", table=where)
            if "value" not in written:
                self.wrong(f"'{name}' has no value", name, fix=f'write {name} = {{ value = "..." }}', table=where)
                return None
        entry = written if isinstance(written, dict) else {"value": written}
        value = self._length_or(name, entry["value"], index.unit)
        if value is None:
            return None
        number, in_lengths = value
        angle = index.unit == "rad"
        least, most = (0.0, 180.0 * DEG) if angle else (LEAST, MOST)
        if not least <= number <= most:
            self.wrong(f"{name} is {brief(entry['value'])}", name, "no ship does that", table=where)
            return None
        if "tolerance" not in entry:
            return Stated(number, index.absolute or index.share * number, in_lengths, True)
        tolerance = self._length_or(name, entry["tolerance"], index.unit)
        if tolerance is None:
            return None
        if tolerance[1] != in_lengths:
            fix = "give both in L, or both in m"
            self.wrong(f"{name}: value and tolerance are in different units", name, fix=fix, table=where)
            return None
        least = max(LEAST, SHARPEST * number)
        if not least <= tolerance[0] <= MOST:
            what = f"tolerance of {name} is {brief(entry['tolerance'])}"
            unit = "L" if in_lengths else index.unit.replace("-", "")
            fix = (
                f"give one of {2.0 * least:.1g} {unit}".rstrip() + " or more, as large as trials and readings differ by"
            )
            why = "it is one standard deviation, and nothing at sea is known to a millionth"
            self.wrong(what, name, why if 0.0 < tolerance[0] < least else "it is one standard deviation", fix, where)
            return None
        return Stated(number, tolerance[0], in_lengths)

    def _length_or(self, name: str, written: Any, unit: str) -> tuple[float, bool] | None:
        """A quantity in its SI unit, or a length in ship lengths."""
        said = LENGTH.match(written) if unit == "m" and isinstance(written, str) else None
        if said:
            try:
                return float(said[1]), True
            except ValueError:
                self.wrong(f"'{name}' is {brief(written)}, not a number", name, table="trial.indices")
                return None
        number = self._quantity(name, written, unit, "trial.indices")
        return None if number is None else (number, False)
