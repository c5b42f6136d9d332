"""One record in the program's units: every quantity with its own time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from .. import units
from ..arrays import BoolArray, FloatArray
from ..errors import LogError, Problem
from ..phrases import listed
from ..trial.headings import unwrapped
from .cells.degrees import DDMM
from .cells.digits import print_step, within_digits
from .cells.headers import PERCENT, in_percent, unit_in
from .cells.seldom import is_seldom
from .formats.table import TIME, Table
from .maps.mapping import LogMap, Source, TimeSource
from .maps.quantities import AGAINST, PAIRS, known_quantity, meaning

POSITIONS = (("latitude", "longitude"), ("x", "y"))
FEWEST_UPDATES, MOST_REPEATS = 20, 20
"""Updates of a position that show how often it comes, and rows up to which it may be written over and over."""
REGULAR = 0.9
"""Share of updates that come as often as the others, from which a position is held between them."""
BEYOND = 5.0
"""Steps of print that a ship moves from one update to the next, at least."""
FEW = 4
"""Significant digits up to which a column is looked at as to whether they suffice."""
TOGETHER = 0.1
"""Share of the values of the second of a pair up to which its rows are others than those of the first."""
FEWEST_PRINTED = 40
MORE_DIGITS = "log it with more digits"


@dataclass(frozen=True, eq=False)
class Series:
    """Samples of one quantity, all (n_samples,).

    t        time [s], strictly increasing
    values   in the program's unit
    printed  values before digits were made up for, and coarse: the step they are printed in, both in the program's
             unit; None where nothing is to be recovered
    """

    t: FloatArray
    values: FloatArray
    printed: FloatArray | None = None
    coarse: FloatArray | None = None

    def at(self, rows: BoolArray) -> Series:
        """The samples at some rows (n_samples,)."""
        printed, coarse = (None if one is None else one[rows] for one in (self.printed, self.coarse))
        return Series(self.t[rows], self.values[rows], printed, coarse)

    @property
    def step(self) -> float:
        """Median time between samples that have a value [s]; 0 where there are fewer than two."""
        t = self.t[np.isfinite(self.values)]
        return float(np.median(np.diff(t))) if len(t) > 1 else 0.0


@dataclass(frozen=True)
class Coarse:
    """A column printed with few digits.

    digits   how many
    step     the largest step of the last, in ``unit``; size: the same in the program's unit
    repeats  share of values that are the one before
    """

    digits: int
    step: float
    unit: str
    repeats: float
    size: float

    @property
    def words(self) -> str:
        return f"printed with {self.digits} digits, in steps of up to {self.step:.3g} {self.unit}"

    @property
    def why(self) -> str:
        return f"{100.0 * self.repeats:.0f} % of its values repeat the one before"

    def fix(self, name: str) -> str:
        """What the map can say."""
        way = "yaw-rate" if name == "psi" else "print-resolution"
        return f'say recover = "{way}" in [columns.{name}], or {MORE_DIGITS}'


@dataclass(eq=False)
class Record:
    """What a log holds, or a part of one between two settings of its clock.

    series   by quantity (``quantities.quantity_of``), angles unwrapped
    spikes   number of samples taken out, by quantity
    notes    what was done, in sentences
    coarse   columns printed with few digits that the map does not recover, by quantity
    recovered  of a heading that was, rms [rad]: by which the integral of the yaw rate misses it as printed, what
             rounding alone would make of that, and what the noise of the rate adds up to; None of any other
    """

    path: Path
    series: dict[str, Series]
    spikes: dict[str, int] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    coarse: dict[str, Coarse] = field(default_factory=dict)
    recovered: tuple[float, float, float] | None = None

    @property
    def has_velocities(self) -> bool:
        """Whether velocities were logged, and do not come from the positions."""
        return {"u", "v"} <= set(self.series) or "sog" in self.series


def when_it_happened(record: Record, log_map: LogMap) -> Record:
    """The record with what the map says was logged late at the times it is of, which its notes say."""
    late = {name: source.late for name, source in log_map.sources.items() if source.late and name in record.series}
    if not late:
        return record
    series = {name: replace(one, t=one.t - late.get(name, 0.0)) for name, one in record.series.items()}
    of: dict[float, list[str]] = {}
    for name, by in late.items():
        of.setdefault(by, []).append(name)
    told = [f"taken {abs(by):g} s {'earlier' if by > 0.0 else 'later'} than logged, as the map says" for by in of]
    notes = [f"{listed(names)}: {words}" for names, words in zip(of.values(), told, strict=True)]
    return replace(record, series=series, notes=[*record.notes, *notes])


def time_in_seconds(table: Table, log_map: LogMap) -> FloatArray:
    """The log's time (n_rows,) in s.  Raises LogError where nothing says its unit."""
    source = log_map.time
    if table.clock:
        return table.t * source.scale
    unit = unit_of(TIME, table, source, "s", table.t, f"{log_map.path}, [time]")
    return table.t * (units.factors("s")[unit] * source.scale)


def unit_of(name: str, table: Table, source: Source | TimeSource, target: str, values: FloatArray, place: str) -> str:
    """The unit a column is written in, from the map or the log's header.

    Raises LogError where neither says it, with the question to answer, and where they contradict each other.
    """
    header, stated = table.headers[name], source.unit
    known = units.factors(target)
    if in_cells := table.stated.get(name):
        if stated not in (None, in_cells, DDMM):
            what, why = f"the map says '{header}' is in {stated}, its cells say {in_cells}", "one of them is wrong"
            raise LogError(Problem(what, place, why, "correct the map's unit or remove it"))
        if in_cells not in known:
            what = f"the cells of '{header}' say {in_cells}, which is no unit of {meaning(name) or name}"
            raise LogError(Problem(what, place, fix="name another column in the map"))
        return in_cells
    printed = next((one for one in (unit_in(header), table.below.get(name)) if one in known), None)
    contradicted = stated and printed and known.get(stated) != known[printed]  # rps and 1/s are the same
    if contradicted and printed != source.header_says:
        what = f"the map says '{header}' is in {stated}, its header says {printed}"
        fix = f'correct the map\'s unit or remove it; if the header is wrong, add header_says = "{printed}"'
        raise LogError(Problem(what, place, "one of them is wrong", fix))
    shares = not printed and in_percent(header, table.below.get(name, ""))
    if shares and source.scale == 1.0 and source.header_says != PERCENT:
        what = f"'{header}' is in percent, as its header says{f', and the map says {stated}' if stated else ''}"
        unit = stated or next(iter(known))
        why = "neither says what 100 % are"
        fix = f'say scale, a hundredth of its {unit} at 100 %; if the header is wrong, add header_says = "{PERCENT}"'
        raise LogError(Problem(what, place, why, fix))
    if stated or printed:
        return str(stated or printed)
    finite = values[np.isfinite(values)]
    span = f"its values run from {finite.min():.6g} to {finite.max():.6g}" if len(finite) else "it has no values"
    short = [
        unit
        for unit in known
        if unit in ("deg", "rad", "m/s", "kn", "s", "ms", "m", "ft", "rpm", "1/s", "deg/s", "rad/s", "deg/min")
    ]
    first = "deg" if "deg" in short else short[-1]
    days = target == "s" and len(finite) > 1 and finite.min() > 1e4 and finite.max() < 1e6 and np.ptp(finite) < 100.0
    if days:
        span, first = f"{span}: days, as Excel and MATLAB count them?", "d"
    raise LogError(
        Problem(
            f"is '{header}' in {' or '.join(short)}?",
            place,
            f"neither the map nor the header says the unit of {meaning(name) or 'time'}; {span}",
            f'say its unit, such as unit = "{first}"',
        )
    )


def record_of(table: Table, log_map: LogMap, t: FloatArray, rows: slice) -> Record:
    """A part of a table in the program's units and directions.

    t     (n_kept,) time put right [s]; rows: the part of it

    Raises LogError with every column that has no values, or no unit.
    """
    problems: list[Problem] = []
    series = {}
    notes: list[str] = []
    coarse: dict[str, Coarse] = {}
    for name, values in table.columns.items():
        source = log_map.sources[name]
        if not np.isfinite(values).any():
            place = f"{table.path}, column '{table.headers[name]}'"
            why = f"the map says it holds {meaning(name)}"
            fix = "name another column, or leave it out of the map where it is not needed"
            problems.append(Problem("the column has no numbers at all", place, why, fix))
            continue
        try:
            unit = unit_of(name, table, source, known_quantity(name).unit, values, log_map.place(name))
            printed = possible(name, values[rows], source, unit, table, notes)
        except LogError as error:
            problems += error.problems
            continue
        factor = units.factors(known_quantity(name).unit)[unit] * abs(source.scale)
        if not source.recover:
            if name in ("x", "y", "psi") and (few := few_digits(printed, unit, factor)) is not None:
                coarse[name] = few
            series[name] = Series(t[rows], converted(name, printed, source, unit))
            continue
        # In the log's own unit: that is where the digits are.
        if source.recover == "yaw-rate":
            recovered, (steps, digits), how = printed, print_step(printed), ""
        else:
            recovered, digits, steps = within_digits(t[rows], printed)
            how = "; it was smoothed within half a step"
        if not digits:
            notes.append(f"{name} is printed with more than 6 digits: nothing to recover")
            series[name] = Series(t[rows], converted(name, printed, source, unit))
            continue
        coarsest = f"{np.nanmax(steps):.3g} {unit}"
        notes.append(f"{name} is printed with {digits} significant digits, in steps of up to {coarsest}{how}")
        as_printed = converted(name, printed, source, unit)
        series[name] = Series(
            t[rows], converted(name, recovered, source, unit) if how else as_printed, as_printed, steps * factor
        )
    if problems:
        raise LogError(*problems)
    for pair in POSITIONS:
        if set(pair) <= set(series) and (updated := updates_of(*(series[name] for name in pair))) is not None:
            every = float(np.median(np.diff(series[pair[0]].t[updated])))
            series |= {name: series[name].at(updated) for name in pair}
            told = f"positions stand still between updates, {every:.3g} s apart"
            notes.append(f"{told}: the first row of each is kept, as the ship moves on meanwhile")
    return Record(table.path, as_logged(series), notes=notes, coarse=coarse)


def updates_of(north: Series, east: Series) -> BoolArray | None:
    """Rows (n_samples,) in which a position is new, of a log that writes each several times over until the next comes;
    None of any other.

    They come at equal distances, and steps are far beyond those in which positions are printed: few digits repeat too.
    Where the ship lies still a row is kept as often.
    """
    if north.printed is not None or east.printed is not None:
        return None
    known = np.isfinite(north.values) & np.isfinite(east.values)
    new = np.zeros(len(known), dtype=bool)
    new[1:] = known[1:] & known[:-1] & ((np.diff(north.values) != 0.0) | (np.diff(east.values) != 0.0))
    rows = np.flatnonzero(new)
    if len(rows) < FEWEST_UPDATES:
        return None
    apart = np.diff(rows)
    step = int(np.median(apart))
    if not 2 <= step <= MOST_REPEATS or np.mean(np.abs(apart - step) <= 1) < REGULAR:
        return None
    for values in (north.values, east.values):
        steps, digits = print_step(values[np.isfinite(values)])
        moved = float(np.median(np.abs(np.diff(values[rows]))))
        if digits and moved < BEYOND * float(np.nanmax(steps)) and moved > 0.0:
            return None
    last = np.maximum.accumulate(np.where(new, np.arange(len(new)), rows[0] % step - step))
    return np.asarray(~known | ((np.arange(len(new)) - last) % step == 0))


def as_logged(series: Mapping[str, Series]) -> dict[str, Series]:
    """Series by quantity, those logged more seldom than rows are written without the rows that have no value.

    The two of a position or velocity keep the same rows.
    """
    found = dict(series)
    pairs = [pair for pair in PAIRS if set(pair) <= set(found)]
    for first, second in pairs:
        found[second] = at_times_of(found[first], found[second])
    for names in [*pairs, *((name,) for name in found if not any(name in pair for pair in pairs))]:
        known = np.any([np.isfinite(found[name].values) for name in names], axis=0)
        if is_seldom(known):
            found |= {name: found[name].at(known) for name in names}
    return found


def at_times_of(first: Series, second: Series) -> Series:
    """The second of a pair at the rows that have the first, where hardly a row has both, as of two sensors that log in
    turn: on the line between its values, with none further from the next than twice their usual step."""
    both = np.isfinite(first.values) & np.isfinite(second.values)
    known = np.isfinite(second.values)
    if known.sum() < 2 or not np.isfinite(first.values).any() or both.sum() > TOGETHER * known.sum():
        return second
    t, values = second.t[known], second.values[known]
    right = np.clip(np.searchsorted(t, first.t), 1, len(t) - 1)
    near = (t[right] - t[right - 1] <= 2.0 * second.step) & (first.t >= t[0]) & (first.t <= t[-1])
    there = np.isfinite(first.values) & near
    return Series(second.t, np.where(there, np.interp(first.t, t, values), np.nan))


def few_digits(printed: FloatArray, unit: str, factor: float) -> Coarse | None:
    """A column (n_samples,) that moves by less than its print step from row to row; None where digits suffice.

    factor  from its unit to the program's
    """
    values = printed[np.isfinite(printed)]
    if len(values) < FEWEST_PRINTED or np.ptp(values) == 0.0:
        return None
    steps, digits = print_step(values)
    again = float(np.mean(np.diff(values) == 0.0))
    if not digits or digits > FEW or again < 0.3:
        return None
    # What stands still repeats as well, however finely it is printed.
    moving = np.abs(values - np.median(values)) > 0.05 * np.ptp(values)
    again = float(np.mean((np.diff(values) == 0.0)[moving[1:]])) if moving[1:].any() else 0.0
    step = float(np.nanmax(steps))
    return Coarse(digits, step, unit, again, step * factor) if again >= 0.3 else None


def possible(name: str, values: FloatArray, source: Source, unit: str, table: Table, notes: list[str]) -> FloatArray:
    """Numbers of a log (n_samples,) with NaN for those that nothing about a ship can have; ``notes`` says how many.

    Raises LogError where most are such.
    """
    quantity = known_quantity(name)
    with np.errstate(over="ignore"):
        size = values * (units.factors(quantity.unit)[unit] * source.scale) + source.offset
    beyond = quantity.beyond(size)
    if not beyond.any():
        return values
    said = f"{beyond.sum()} of {len(values)} values of '{table.headers[name]}' are impossible for {meaning(name)}"
    most = float(np.abs(size[beyond]).max())
    largest = f"up to {most:.3g} {quantity.unit}" if math.isfinite(most) else "more than any number"
    if beyond.sum() > 0.5 * np.isfinite(values).sum():
        fix = "check unit, scale and offset of the column in the map"
        raise LogError(Problem(said, f"{table.path}, column '{table.headers[name]}'", largest, fix))
    notes.append(f"{said}, {largest}; taken as gaps")
    return np.where(beyond, np.nan, values)


def converted(name: str, values: FloatArray, source: Source, unit: str) -> FloatArray:
    """Numbers of a log (n_samples,) in the program's unit and directions, angles unwrapped."""
    quantity = known_quantity(name)
    turn = 360.0 if quantity.unit == "deg" else 2.0 * np.pi
    # A factor of exactly 1 leaves every bit as it is.
    factor = units.factors(quantity.unit)[unit] * source.scale
    out = values * factor if factor != 1.0 else np.array(values)
    if source.positive in AGAINST:
        out = -out
    if quantity.origin and source.zero == "east":
        # Counted from east, north lies a quarter turn back, whichever way angles grow.
        out = out + turn / 4.0
    if source.direction and source.direction != quantity.points:
        out = out + turn / 2.0
    if source.offset:
        out = out + source.offset
    return unwrapped(out, turn) if quantity.angle else out
