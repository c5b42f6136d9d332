"""The map of a log: which of its columns is which quantity, in which unit and counted which way."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path

from ...inputs import INPUTS
from ...trial.schema import MAIN_INPUTS

ASKS = "?"
"""How a value begins that is a question to who uses the map."""
FORMATS = ("csv", "parquet", "nmea", "xlsx", "mat")
ALL = "*"
"""How a map says that every sheet or run of a log becomes a trial."""
PLACEHOLDERS = ("stem", "parent", "part")
"""What may stand in braces in ``id`` and ``group``: the log's name, its folder, and the sheet or variable."""
PARTS = ("sheet", "variable")
"""Keys of [log] that name one of several runs in a log, or several."""
TIME_FORMATS = ("number", "iso", "clock", "hhmmss", "mm:ss", "date", "dmy", "mdy", "ymd")
PROJECTIONS = ("transverse-mercator", "azimuthal-equidistant")
TABLES = {
    "": (
        "schema",
        "description",
        "log",
        "trial",
        "time",
        "columns",
        "velocity",
        "antenna",
        "position",
        "resample",
        "cut",
    ),
    "log": (
        "format",
        "delimiter",
        "encoding",
        "decimal",
        "thousands",
        "skip",
        "header",
        "fields",
        "missing",
        "sheet",
        "join",
        "variable",
    ),
    "trial": ("ship", "id", "manoeuvre", "group", "source", "note", "noise"),
    "time": ("column", "format", "unit", "header_says", "scale", "recover", "step"),
    "velocity": ("axes", "point", "shifted"),
    "antenna": ("x", "y"),
    "position": ("projection", "origin"),
    "resample": ("step", "gap"),
    "cut": ("start", "end", "from", "lead", "to", "split"),
}
"""Tables of a map and their keys; "" stands for the map itself."""


@dataclass(frozen=True)
class Source:
    """Where one quantity comes from.

    column     name of the log's column, or its number counted from 1; None where ``value`` is given
    value      constant in the program's unit, None where a column is given
    unit       unit of the column, None where the log's header has to say it
    header_says  another unit that the header says, and is wrong in
    positive   direction the log counts as positive, None where the map does not say
    zero       "north" or "east": where angles are counted from
    direction  "from" or "to", of wind, current and waves; None for other quantities
    scale      factor on the log's numbers, before the unit
    offset     added after unit and sign, in the program's unit
    late       how much later than it happened it was logged [s]
    recover    where few digits are printed. "print-resolution": smoothed within them; "yaw-rate": the integral of r,
               its bias and lag fitted, in place of the heading; None: as it is printed
    parts      further columns of a latitude or longitude by what they hold, one of position_parts.PARTS
    line       line of the map, 0 where unknown
    """

    column: str | int | None = None
    value: float | None = None
    unit: str | None = None
    header_says: str | None = None
    positive: str | None = None
    zero: str = "north"
    direction: str | None = None
    scale: float = 1.0
    offset: float = 0.0
    late: float = 0.0
    recover: str | None = None
    parts: dict[str, str | int] = field(default_factory=dict)
    line: int = 0

    @property
    def columns(self) -> dict[str, str | int]:
        """The log's columns it is read from, by what each holds of it: "" for the quantity itself."""
        return {} if self.column is None else {"": self.column, **self.parts}


@dataclass(frozen=True)
class TimeSource:
    """Where time comes from.

    column   name or number, as of a Source; None where several columns hold a part of it each
    parts    these columns by the unit of what they hold, such as "h", "min" and "s", the longest first; else empty
    format   one of TIME_FORMATS; "date" where the dates have to show the order of day and month; None where the cells
             have to show it all
    unit     of numbers; None where the header has to say it
    header_says  another unit that the header says, and is wrong in
    scale    factor on the log's time
    recover  "auto" (where stamps are found to be printed with too few digits), "uniform" (always) or "never"
    step     true time between samples [s], None where it is to be estimated
    """

    column: str | int | None = None
    parts: dict[str, str | int] = field(default_factory=dict)
    format: str | None = None
    unit: str | None = None
    header_says: str | None = None
    scale: float = 1.0
    recover: str = "auto"
    step: float | None = None

    @property
    def columns(self) -> dict[str, str | int]:
        """The log's columns it is read from, by the unit of the part each holds; "" for one that holds it all."""
        return self.parts or ({} if self.column is None else {"": self.column})


@dataclass(frozen=True)
class Cut:
    """The part of the record to keep: seconds from its start, and what to begin with.

    start, end  [s], None for the record's own; an end below 0 counts back from the record's
    begin       "first-rudder-order", "first-order" (without the head in which propellers and rudders all stand at
                zero), or None
    lead        seconds kept before that order
    to          "last-order": without the tail in which propellers and rudders all stand at zero; or None
    split       "pull-out": what follows a turn's rudder order becomes a trial of its own; or None
    """

    start: float | None = None
    end: float | None = None
    begin: str | None = None
    lead: float = 0.0
    to: str | None = None
    split: str | None = None


@dataclass(frozen=True)
class LogMap:
    """Everything needed to read a kind of log; lengths in m, times in s.

    name        file or preset it was read from
    some        maps of logs that differ, by the pattern of their names
    sheet       of a workbook, "" for its first that holds rows
    joined      sheets whose rows are put together by their times; () where one is read, or each becomes a trial
    variable    of a MATLAB file, a structure or a matrix that holds the columns, such as "log" or "data.run(2)"; ""
                where they are variables themselves
    parts       sheets or variables that each become a trial of one log, the first of them also in ``sheet`` or
                ``variable``; of the map of one of them, it alone; () where a log is one trial. Of ALL, in their
                place, there are as many as a log has
    thousands   what divides thousands, "none" for nothing, None where each column has to show it
    fields      how many a row of a log has, None where the map does not say
    axes        "ship" or "earth": of u and v; None where the map does not say
    point       "midship", "antenna" or "stated": what u and v, or sog and cog, are of; None where the map does not say
    stated      (2,) that point from midship, forward and to starboard; None unless ``point`` is "stated"
    shifted     "earth-axes" where velocities were moved to midship already, but along earth axes; else None
    antenna     (2,) position of the antenna from midship, forward and to starboard; None where positions are of midship
    projection  of latitude and longitude; origin: (2,) its centre, latitude and longitude [deg], None: the first fix
    group       what trials have in common with others, such as the day; may name the log and its folder, as ``id`` does
    step        time step of the trials, None: the log's own median; gap: steps beyond which a hole is not bridged
    """

    name: str
    path: Path
    format: str | None = None
    delimiter: str | None = None
    encoding: str = "utf-8"
    decimal: str = "."
    thousands: str | None = None
    skip: int = 0
    header: bool = True
    fields: int | None = None
    sheet: str = ""
    joined: tuple[str, ...] = ()
    variable: str = ""
    parts: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    time: TimeSource = field(default_factory=TimeSource)
    sources: dict[str, Source] = field(default_factory=dict)
    axes: str | None = None
    point: str | None = None
    stated: tuple[float, float] | None = None
    shifted: str | None = None
    antenna: tuple[float, float] | None = None
    projection: str = "transverse-mercator"
    origin: tuple[float, float] | None = None
    step: float | None = None
    gap: float = 5.0
    cut: Cut = field(default_factory=Cut)
    ship: str = ""
    id: str = "{stem}"
    manoeuvre: str = ""
    group: str = ""
    source: str = "measured"
    note: str = ""
    some: tuple[tuple[str, LogMap], ...] = ()
    noise: dict[str, float] = field(default_factory=dict)

    def of(self, log: Path) -> LogMap:
        """The map of one log: the first in ``some`` whose pattern its name matches, else this one."""
        return next((one for pattern, one in self.some if fnmatchcase(log.name, pattern)), self)

    def of_part(self, part: str) -> LogMap:
        """The map of one sheet or variable of several."""
        parts = (part,) if part else ()
        return replace(self, parts=parts, variable=part) if self.variable else replace(self, parts=parts, sheet=part)

    @property
    def part(self) -> str:
        """The sheet or variable that is read, "" where the map does not say."""
        return self.sheet or self.variable

    @property
    def means(self) -> dict[str, tuple[str, ...]]:
        """What the map does not name but is the mean of what it does: ``delta`` of port and starboard rudder, say."""
        if self.format == "nmea":
            return {}
        made = {}
        for name in MAIN_INPUTS:
            others = tuple(other for other in self.inputs_of(name) if other != name)
            if name not in self.sources and len(others) > 1:
                made[name] = others
        return made

    @property
    def inputs(self) -> tuple[str, ...]:
        """Inputs that a trial made by this map has at every sample: those every trial has, and those the map names."""
        return tuple(name for name in INPUTS if name in MAIN_INPUTS or name in self.sources)

    def inputs_of(self, name: str) -> tuple[str, ...]:
        """The inputs the map names that are of the same role as another."""
        return tuple(one for one in INPUTS if one in self.sources and INPUTS[one].role == INPUTS[name].role)

    def lever(self, point: str | None) -> tuple[float, float] | None:
        """Position (2,) of a point from midship, forward and to starboard [m]; None where it is midship."""
        return {"antenna": self.antenna, "stated": self.stated}.get(point or "")

    def place(self, quantity: str) -> str:
        """Where the map speaks of a quantity, for messages."""
        line = self.sources[quantity].line if quantity in self.sources else 0
        return f"{self.path}, line {line}" if line else str(self.path)
