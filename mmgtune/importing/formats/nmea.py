"""Reading NMEA 0183 logs: position, velocity, heading, yaw rate, rudder, revolutions and wind, whoever talks.

A sentence that carries no time gets that of its epoch, the stretch between one position and the next: where it comes
once an epoch the epoch's own time, where it comes more often they are spread evenly over it.
"""

from __future__ import annotations

import math
import re
from array import array
from collections import Counter
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import numpy as np

from ...errors import LogError, Problem
from ...trial.headings import unwrapped
from ...units import DEG, KNOT, factors
from ..cells.periods import DAY
from ..clock import put_right
from ..maps.mapping import LogMap, TimeSource
from ..maps.quantities import AGAINST, QUANTITIES, meaning, quantity_of
from ..record import Record, Series
from .table import MOST_ROWS

SENTENCES = {
    "GGA": "position", "RMC": "position", "GLL": "position", "VTG": "velocity", "HDT": "heading", "THS": "heading",
    "ROT": "yaw rate", "RSA": "rudder", "RPM": "revolutions", "MWV": "wind", "MWD": "wind", "ZDA": "date",
}  # fmt: skip
POSITIONS = ("GGA", "RMC", "GLL")
OF_ONE_SENSOR = (*POSITIONS, "VTG", "HDT", "THS", "ROT", "MWV", "MWD")
"""Sentences that two sensors may send in turn, each of its own place or zero."""
GYROCOMPASS = b"HE"
OFTEN = 0.05
"""Sentences of others over those of one talker from which they are no damage to its name."""
_SPEED = {letter: factors("m/s")[unit] for letter, unit in (("K", "km/h"), ("M", "m/s"), ("N", "kn"))} | {"S": 0.44704}
"""Letters of units of speed; S is for statute miles per hour."""
_PER_MINUTE = factors("rad/s")["deg/min"]
_RPM = factors("1/s")["rpm"]
_LINE = re.compile(rb"[$!]([A-Z]{2}|P[A-Z]*)([A-Z]{3}),([^*\r\n]*+)(?:\*([0-9A-Fa-f]{2}))?\s*$")
_NUMBER = re.compile(r"[-+]?(\d{1,12}\.?\d{0,30}|\.\d{1,30})")
LINE = 4096
"""Bytes of a line that are looked at; sentences have 82 at most."""
WAITING = 10_000
"""Sentences of a kind that may wait for the time of the next position."""


def checksum(body: bytes) -> int:
    """Exclusive or of all bytes between "$" and "*", 0 to 255."""
    # Folded in halves as one long number: several times quicker than byte by byte.
    value, bits = int.from_bytes(body, "little"), 8
    while bits < 8 * len(body):
        bits *= 2
    while bits > 8:
        bits //= 2
        value ^= value >> bits
    return value & 0xFF


class _Channel:
    """Times and values of one quantity, thinned where there are too many."""

    def __init__(self) -> None:
        self.t, self.values = array("d"), array("d")
        self.stride, self.seen = 1, 0

    def add(self, t: float, value: float) -> None:
        if self.seen % self.stride == 0:
            self.t.append(t)
            self.values.append(value)
            if len(self.t) > MOST_ROWS:
                self.t, self.values = self.t[::2], self.values[::2]
                self.stride *= 2
        self.seen += 1


class _Parser:
    """One pass over the lines of a log."""

    def __init__(self, primary: str, with_vtg: bool, talkers: Mapping[str, bytes]):
        self.primary, self.with_vtg, self.talkers = primary, with_vtg, talkers
        self.of_others: Counter[str] = Counter()
        self.channels: dict[str, _Channel] = {}
        self.waiting: dict[str, list[float]] = {}
        self.counts: Counter[str] = Counter()
        self.bad = 0
        self.first_bad = 0
        self.unsigned = 0
        self.no_fix = 0
        self.malformed: Counter[str] = Counter()
        self.epoch = math.nan
        self.lasting = 0.0
        self.day = 0.0
        self.of_day = math.nan
        self.date = ""

    def line(self, number: int, raw: bytes) -> None:
        """Take one line; what is no sentence of interest is passed over."""
        match = _LINE.search(raw)
        if match is None:
            return
        kind = match.group(2).decode()
        if kind not in SENTENCES:
            return
        if match.group(1) != self.talkers.get(kind, match.group(1)):
            self.of_others[f"{match.group(1).decode()}{kind}"] += 1
            return
        if match.group(4) is None:
            self.unsigned += 1
        elif checksum(raw[match.start() + 1 : match.end(3)]) != int(match.group(4), 16):
            self.bad += 1
            self.first_bad = self.first_bad or number
            return
        fields = match.group(3).decode("ascii", "replace").split(",")
        try:
            self.sentence(kind, fields)
            self.counts[kind] += 1
        except (ValueError, IndexError, KeyError):
            self.malformed[kind] += 1

    def sentence(self, kind: str, f: list[str]) -> None:
        """Take one sentence.  Raises ValueError, IndexError or KeyError where it is not what the standard says."""
        if kind in POSITIONS:
            self.position(kind, f)
        elif kind == "VTG" and f[0] and f[4]:
            self.velocity(_number(f[4]) * KNOT, _number(f[0]) * DEG)
        elif (kind == "HDT" and f[0]) or (kind == "THS" and f[0] and f[1] != "V"):
            self.wait(psi=_number(f[0]) * DEG)
        elif kind == "ROT" and f[0] and f[1] == "A":
            self.wait(r=_number(f[0]) * _PER_MINUTE)
        elif kind == "RSA":
            self.rudder(f)
        elif kind == "RPM" and f[2] and f[4] == "A":
            if f[0] not in ("S", "E") or not re.fullmatch(r"\d{0,2}", f[1]):
                raise ValueError
            self.wait(**{f"n {f[0]}{f[1]}": _number(f[2]) * _RPM})
        elif kind == "MWV" and f[0] and f[2] and f[4] == "A" and f[1] == "R":
            self.wait(wind_dir_app=_number(f[0]) * DEG, wind_speed_app=_number(f[2]) * _SPEED[f[3]])
        elif kind == "MWD" and f[0] and (f[6] or f[4]):
            self.wait(wind_dir=_number(f[0]) * DEG, wind_speed=_number(f[6]) if f[6] else _number(f[4]) * KNOT)
        elif kind == "ZDA" and not self.date and f[1]:
            self.date = _date(f[3], f[2], f[1])

    def position(self, kind: str, f: list[str]) -> None:
        if kind == "GGA":
            time, at, good = f[0], 1, f[5] not in ("", "0")
        elif kind == "RMC":
            time, at, good = f[0], 2, f[1] == "A"
        else:
            # Receivers of before 1992 write no status.
            time, at, good = f[4], 0, len(f) < 6 or f[5] == "A"
        if kind == self.primary and time:
            self.begin(_of_day(time))
            self.no_fix += not good
            place = (math.nan, math.nan)
            try:
                if good:
                    place = (_degrees(f[at], f[at + 1], "NS", 90.0), _degrees(f[at + 2], f[at + 3], "EW", 180.0))
            finally:
                # Its time counts even where the place cannot be read: other sentences take theirs from it.
                self.add("latitude", self.epoch, place[0])
                self.add("longitude", self.epoch, place[1])
        if kind == "RMC":
            if not self.date and len(f) > 8 and len(f[8]) == 6:
                self.date = _date(f"20{f[8][4:]}", f[8][2:4], f[8][:2])
            if not self.with_vtg and f[1] == "A" and f[6] and f[7]:
                self.velocity(_number(f[6]) * KNOT, _number(f[7]) * DEG)

    def begin(self, of_day: float) -> None:
        """A new epoch: what was waiting belongs to the one before."""
        if not math.isnan(self.of_day):
            if of_day - self.of_day < -DAY / 2.0:
                self.day += DAY
            elif of_day - self.of_day > DAY / 2.0:
                self.day -= DAY
        self.of_day = of_day
        now = self.day + of_day
        self.spread(now)
        self.epoch = now

    def spread(self, now: float) -> None:
        """Give the waiting sentences their times, up to the next epoch."""
        if not math.isnan(self.epoch):
            if 0.0 < now - self.epoch < (10.0 * self.lasting or math.inf):
                self.lasting = now - self.epoch
            # Over a hole, or where the clock was set, an epoch lasts as long as the one before.
            for name, values in self.waiting.items():
                for i, value in enumerate(values):
                    self.add(name, self.epoch + self.lasting * i / len(values), value)
        self.waiting = {}

    def velocity(self, speed: float, course: float) -> None:
        self.wait(north=speed * math.cos(course), east=speed * math.sin(course))

    def rudder(self, f: list[str]) -> None:
        """The single or starboard sensor, and the port one where there is one."""
        angles = [_number(f[k]) * DEG for k in (0, 2) if len(f) > k + 1 and f[k] and f[k + 1] == "A"]
        if angles:
            self.wait(delta=sum(angles) / len(angles))
        if len(angles) == 2:
            self.wait(delta_stbd=angles[0], delta_port=angles[1])

    def wait(self, **values: float) -> None:
        """Keep values until the time of the next position is known; all of a sentence were read by then."""
        for name, value in values.items():
            waiting = self.waiting.setdefault(name, [])
            if len(waiting) >= WAITING:
                raise ValueError
            waiting.append(value)

    def add(self, name: str, t: float, value: float) -> None:
        channel = self.channels.get(name)
        if channel is None:
            channel = self.channels[name] = _Channel()
        channel.add(t, value)


def read_nmea(path: Path, log_map: LogMap) -> list[Record]:
    """A log of NMEA 0183 sentences as records, more than one where its clock was set back.

    ``north`` and ``east`` are the velocity over ground in earth axes [m/s].

    Raises LogError naming the sentences that are missing.
    """
    kinds = _kinds(path)
    primary = next((kind for kind in POSITIONS if kinds[kind]), None)
    needed = [
        ("a position", "GGA, RMC or GLL", primary is not None),
        ("a heading", "HDT or THS", bool(kinds["HDT"] or kinds["THS"])),
    ]
    for name, words, kind in (("delta", "the rudder angle", "RSA"), ("n", "the propeller's revolutions", "RPM")):
        constant = name in log_map.sources and log_map.sources[name].value is not None
        needed.append((words, kind, bool(kinds[kind]) or constant))
    problems = [
        Problem(
            f"the log has no sentence with {what}",
            str(path),
            f"it has {', '.join(f'{count} {kind}' for kind, count in kinds.most_common()) or 'no sentence known here'}",
            f"log {sentence}" + ("" if k < 2 else ', or give it as a constant in the map: value = "..."'),
        )
        for k, (what, sentence, there) in enumerate(needed)
        if not there
    ]
    if problems:
        raise LogError(*problems)
    parser = _Parser(primary or "GGA", bool(kinds["VTG"]), _talkers(path))
    with path.open("rb") as file:
        number = 1
        while raw := file.readline(LINE):
            parser.line(number, raw)
            number += raw.endswith(b"\n")
    if "latitude" not in parser.channels:
        why = f"{parser.bad} sentences have a bad checksum, {parser.malformed.total()} are not as the standard says"
        raise LogError(Problem("the log has no position that can be read", str(path), why, "check its receiver"))
    usual = np.diff(np.array(parser.channels["latitude"].t))
    parser.spread(parser.epoch + (float(np.median(usual)) if len(usual) else 1.0))
    return _records(parser, path, log_map)


def _kinds(path: Path) -> Counter[str]:
    """How often each sentence of interest is in the log."""
    pattern = re.compile(rb"[$!](?:[A-Z]{2}|P[A-Z]*)([A-Z]{3}),")
    found: Counter[str] = Counter()
    with path.open("rb") as file:
        while block := file.read(1 << 22):
            block += file.readline(LINE)
            found.update(kind.decode() for kind in pattern.findall(block))
    return Counter({kind: count for kind, count in found.items() if kind in SENTENCES})


def _talkers(path: Path) -> dict[str, bytes]:
    """For sentences that several talkers send in turn the one to listen to: a gyrocompass, or who sends most.

    A receiver that goes over to more satellites changes its name once, and stays the same.
    """
    pattern = re.compile(rb"[$!]([A-Z]{2})(" + "|".join(OF_ONE_SENSOR).encode() + rb"),")
    last: dict[bytes, bytes] = {}
    counts: dict[bytes, Counter[bytes]] = {}
    changes: Counter[bytes] = Counter()
    with path.open("rb") as file:
        while block := file.read(1 << 22):
            block += file.readline(LINE)
            for talker, kind in pattern.findall(block):
                counts.setdefault(kind, Counter())[talker] += 1
                changes[kind] += last.setdefault(kind, talker) != talker
                last[kind] = talker
    found = {}
    for kind, talkers in counts.items():
        (first, most), *others = talkers.most_common()
        rest = talkers.total() - most
        if others and rest > OFTEN * most and changes[kind] > 0.5 * rest:
            found[kind.decode()] = GYROCOMPASS if GYROCOMPASS in talkers else first
    return found


def _records(parser: _Parser, path: Path, log_map: LogMap) -> list[Record]:
    """What was parsed in the program's units, in parts where the clock was set back."""
    start = parser.channels["latitude"].t[0]
    notes = [
        f"NMEA 0183: {', '.join(f'{count} {kind}' for kind, count in parser.counts.most_common())}; "
        f"time and position from {parser.primary}" + (f", {parser.date}" if parser.date else "")
    ]
    if parser.of_others:
        heard = ", ".join(sorted(f"{talker.decode()}{kind}" for kind, talker in parser.talkers.items()))
        others = ", ".join(f"{count} {name}" for name, count in parser.of_others.most_common())
        notes.append(f"two sensors talk in turn: {heard} is taken, and {others} left out")
    if parser.bad:
        notes.append(f"{parser.bad} sentences with a bad checksum were dropped, the first in line {parser.first_bad}")
    if parser.unsigned:
        notes.append(f"{parser.unsigned} sentences have no checksum and were taken as they are")
    if parser.malformed:
        kinds = ", ".join(f"{count} {kind}" for kind, count in parser.malformed.most_common())
        total = parser.malformed.total()
        notes.append(f"{total} sentences are not as the standard says and were dropped: {kinds}")
    if parser.no_fix:
        notes.append(f"{parser.no_fix} positions are marked as invalid and left out")
    channels = parser.channels
    shafts = sorted(name for name in channels if name.startswith("n "))
    used = [name for name in shafts if name[2] == "S"] or shafts
    if used:
        channels["n"] = channels[used[0]]
        if used[0][2] != "S":
            notes.append(
                "revolutions are of the engine, as no RPM sentence is of a shaft: a gear needs scale in the map"
            )
        if len(used) > 1:
            notes.append(f"{len(used)} shafts are logged; n is that of number {used[0][3:]}")
    pieces: dict[str, list[Series]] = {}
    for name, channel in channels.items():
        if name.startswith("n "):
            continue
        t, values = np.array(channel.t) - start, np.array(channel.values)
        if len(t) < 2:
            continue
        line = put_right(t, TimeSource(recover="never"), lambda row: f"{path}, sample {row + 1}")
        if name == "latitude":
            notes += line.notes
        values = values[line.keep]
        source = log_map.sources.get(name)
        if source is not None and source.value is None:
            values = values * source.scale * (-1.0 if source.positive in AGAINST else 1.0) + source.offset
        quantity = quantity_of(name)
        beyond = (quantity or QUANTITIES["sog"]).beyond(values)  # others are velocities
        if beyond.any():
            notes.append(f"{beyond.sum()} values of {meaning(name) or 'velocity'} are impossible; taken as gaps")
            values = np.where(beyond, np.nan, values)
        if quantity is not None and quantity.angle:
            values = unwrapped(values, 360.0 if quantity.unit == "deg" else 2.0 * np.pi)
        t = t[line.keep]
        bounds = [0, *line.parts, len(t)]
        pieces[name] = [Series(t[first:last], values[first:last]) for first, last in pairwise(bounds)]
    parts = len(pieces.get("latitude", [0]))
    if any(len(found) != parts for found in pieces.values()):
        why = "the times of the positions fall back and go on from there, and not all sentences are on both sides"
        raise LogError(Problem("the clock was set back within the log", str(path), why, "cut the log there"))
    return [Record(path, {name: found[k] for name, found in pieces.items()}, notes=list(notes)) for k in range(parts)]


def _number(text: str) -> float:
    """A plain number.  Raises ValueError where it is none: Python reads more than sentences may hold."""
    if not _NUMBER.fullmatch(text):
        raise ValueError
    return float(text)


def _of_day(time: str) -> float:
    """ "123519.50" as seconds of the day.  Raises ValueError."""
    h, m, s = _number(time[:2]), _number(time[2:4]), _number(time[4:])
    if not (0.0 <= h < 24.0 and 0.0 <= m < 60.0 and 0.0 <= s < 61.0):
        raise ValueError
    return 3600.0 * h + 60.0 * m + s


def _date(year: str, month: str, day: str) -> str:
    """ "2024-05-01".  Raises ValueError where these are no numbers."""
    if not re.fullmatch(r"\d{4}-\d{1,2}-\d{1,2}", found := f"{year}-{month}-{day}"):
        raise ValueError
    return found


def _degrees(text: str, side: str, sides: str, most: float) -> float:
    """ "3512.345", "S" as -35.20575.  Raises ValueError where it is no place on earth."""
    _number(text)
    point = text.index(".") if "." in text else len(text)
    degrees, minutes = float(text[: max(0, point - 2)] or 0), float(text[max(0, point - 2) :])
    found = degrees + minutes / 60.0
    if side not in sides or not side or minutes > 60.0 or not 0.0 <= found <= most:
        raise ValueError
    return -found if side == sides[1] else found
