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
from ..cells.periods import DAY
from ..clock import put_right
from ..maps.mapping import LogMap, TimeSource
from ..maps.quantities import AGAINST, QUANTITIES, meaning, quantity_of
from ..record import Record, Series
from .sentences import (
    ALONE,
    HOLDERS,
    KINDS,
    ONE_SENSOR,
    POSITIONS,
    chosen,
    date,
    of_day,
    place,
    stand_ins,
    values,
    velocity,
)
from .table import MOST_ROWS

GYROCOMPASS = b"HE"
OFTEN = 0.05
"""Sentences of others over those of one talker from which they are no damage to its name."""
_LINE = re.compile(rb"[$!]([A-Z]{2}|P[A-Z]*)([A-Z]{3}),([^*\r\n]*+)(?:\*([0-9A-Fa-f]{2}))?\s*$")
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

    def __init__(self, taken: Mapping[str, tuple[str, ...]], talkers: Mapping[str, bytes]):
        self.taken, self.talkers = taken, talkers
        self.primary = taken["position"][0]
        self.heard = {*ALONE, *(kind for kinds in taken.values() for kind in kinds)}
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
        if kind not in KINDS:
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
        elif kind == "ZDA" and not self.date and f[1]:
            self.date = date(f[3], f[2], f[1])
        elif kind in self.heard:
            self.wait(values(kind, f))

    def position(self, kind: str, f: list[str]) -> None:
        if kind == "GGA":
            time, at, good = f[0], 1, f[5] not in ("", "0")
        elif kind == "GNS":
            # A letter for each system of satellites, N where it gives no position.
            time, at, good = f[0], 1, f[5].strip("N") != ""
        elif kind == "RMC":
            time, at, good = f[0], 2, f[1] == "A"
        else:
            # Receivers of before 1992 write no status.
            time, at, good = f[4], 0, len(f) < 6 or f[5] == "A"
        if kind == self.primary and time:
            self.begin(of_day(time))
            self.no_fix += not good
            where = (math.nan, math.nan)
            try:
                if good:
                    where = place(f, at)
            finally:
                # Its time counts even where the place cannot be read: other sentences take theirs from it.
                self.add("latitude", self.epoch, where[0])
                self.add("longitude", self.epoch, where[1])
        if kind == "RMC":
            if not self.date and len(f) > 8 and len(f[8]) == 6:
                self.date = date(f"20{f[8][4:]}", f[8][2:4], f[8][:2])
            if kind in self.taken.get("velocity", ()) and f[1] == "A":
                self.wait(velocity(f[6], f[7]))

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
            for name, waited in self.waiting.items():
                for i, value in enumerate(waited):
                    self.add(name, self.epoch + self.lasting * i / len(waited), value)
        self.waiting = {}

    def wait(self, found: Mapping[str, float]) -> None:
        """Keep values until the time of the next position is known; all of a sentence were read by then."""
        for name, value in found.items():
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
    taken = chosen(kinds)
    constant = {name for name in ("delta", "n") if name in log_map.sources and log_map.sources[name].value is not None}
    needed = (
        ("a position", "GGA, GNS, RMC or GLL", "position" in taken),
        ("a heading", "HDT or THS", "heading" in taken),
        ("the rudder angle", "RSA", "rudder angle" in taken or "delta" in constant),
        ("the propeller's revolutions", "RPM", bool(kinds["RPM"]) or "n" in constant),
    )
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
    parser = _Parser(taken, _talkers(path))
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
    return Counter({kind: count for kind, count in found.items() if kind in KINDS})


def _talkers(path: Path) -> dict[str, bytes]:
    """For sentences that several talkers send in turn the one to listen to: a gyrocompass, or who sends most.

    A receiver that goes over to more satellites changes its name once, and stays the same.
    """
    pattern = re.compile(rb"[$!]([A-Z]{2})(" + "|".join(sorted(ONE_SENSOR)).encode() + rb"),")
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


def _left_out(parser: _Parser) -> list[str]:
    """Sentences that hold what others are believed for."""
    notes = []
    for name, kinds in parser.taken.items():
        others = [kind for several in HOLDERS[name] for kind in several if kind not in (*parser.heard, *POSITIONS)]
        counted = ", ".join(f"{parser.counts[kind]} {kind}" for kind in others if parser.counts[kind])
        if counted:
            believed = " and ".join(kind for kind in kinds if parser.counts[kind])
            notes.append(f"{counted} left out: the {name} is that of {believed}")
    return notes


def _records(parser: _Parser, path: Path, log_map: LogMap) -> list[Record]:
    """What was parsed in the program's units, in parts where the clock was set back."""
    start = parser.channels["latitude"].t[0]
    notes = [
        f"NMEA 0183: {', '.join(f'{count} {kind}' for kind, count in parser.counts.most_common())}; "
        f"time and position from {parser.primary}" + (f", {parser.date}" if parser.date else "")
    ]
    notes += [*stand_ins(parser.taken), *_left_out(parser)]
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
        t, numbers = np.array(channel.t) - start, np.array(channel.values)
        if len(t) < 2:
            continue
        line = put_right(t, TimeSource(recover="never"), lambda row: f"{path}, sample {row + 1}")
        if name == "latitude":
            notes += line.notes
        numbers = numbers[line.keep]
        source = log_map.sources.get(name)
        if source is not None and source.value is None:
            numbers = numbers * source.scale * (-1.0 if source.positive in AGAINST else 1.0) + source.offset
        quantity = quantity_of(name)
        beyond = (quantity or QUANTITIES["sog"]).beyond(numbers)  # others are velocities
        if beyond.any():
            notes.append(f"{beyond.sum()} values of {meaning(name) or 'velocity'} are impossible; taken as gaps")
            numbers = np.where(beyond, np.nan, numbers)
        if quantity is not None and quantity.angle:
            numbers = unwrapped(numbers, 360.0 if quantity.unit == "deg" else 2.0 * np.pi)
        t = t[line.keep]
        bounds = [0, *line.parts, len(t)]
        pieces[name] = [Series(t[first:last], numbers[first:last]) for first, last in pairwise(bounds)]
    parts = len(pieces.get("latitude", [0]))
    if any(len(found) != parts for found in pieces.values()):
        why = "the times of the positions fall back and go on from there, and not all sentences are on both sides"
        raise LogError(Problem("the clock was set back within the log", str(path), why, "cut the log there"))
    return [Record(path, {name: found[k] for name, found in pieces.items()}, notes=list(notes)) for k in range(parts)]
