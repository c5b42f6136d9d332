"""Time of a log: reading stamps, and putting right what clocks and printing do to them."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .. import units
from ..arrays import BoolArray, FloatArray, IntArray
from ..errors import LogError, Problem
from ..trial.schema import impossible
from .cells.dates import ORDERS, Dates, Shows, is_date, order_told
from .cells.numerals import numbers_in
from .cells.periods import Periods
from .cells.stopwatch import DIGITS, EITHER, MINUTES, TIME_OF_DAY, of_day, of_digits, of_watch, times_told
from .cells.thousands import either_way, first_marked, in_thousands
from .cells.with_units import numbers_with_unit
from .maps.mapping import TimeSource

OUTLIERS = 3
"""Rows in a row whose stamps may be off while the clock as a whole is right."""
NEWEST_FIRST = 0.98
"""Share of steps back in time from which rows are written newest first, and are in order otherwise."""
ISO = r"\d{4}-?\d{2}-?\d{2}[T ](?!.*[A-Ya-z]{2}$)"
"""Beginning of a date that the library reads, which knows no zones by name."""


READABLE = "seconds, 2024-05-14T02:15:00, 14.05.2024 02:15:00, 02:15:00, 021500"
"""Stamps of each form."""


class Stamps:
    """Turns time cells into numbers, block by block; ``decimal`` and ``thousands`` are the signs in them.

    stated  unit that the cells say themselves, such as 12.5 s; "" where they do not
    """

    def __init__(self, source: TimeSource, path: Path, decimal: str = ".", thousands: str | None = None):
        self.source, self.path, self.decimal, self.thousands = source, path, decimal, thousands
        self.format = source.format
        self.notes: list[str] = []
        self.origin: Any = None
        self.orders: tuple[str, ...] = ()
        self.began: dict[str, float] = {}
        self.ended: dict[str, float] = {}
        self.periods = Periods()
        self.stated = ""

    @property
    def clock(self) -> bool:
        """Whether stamps are dates or clocks, so that what is returned is in s."""
        return self.format in ("iso", TIME_OF_DAY, DIGITS, MINUTES, "date", *ORDERS)

    def of(self, values: Any, rows: IntArray) -> FloatArray:
        """Time (n_rows,) of a pandas column: as printed, or in s from the first stamp; NaN where there is none.

        Raises LogError where the first stamps are neither numbers nor dates nor clocks, and where they may be hours and
        minutes as well as minutes and seconds.
        """
        import pandas as pd

        if pd.api.types.is_datetime64_any_dtype(values.dtype):
            self.format = "iso"
            return self._since(pd.to_datetime(values, utc=True))
        if pd.api.types.is_numeric_dtype(values.dtype) and self.format in (None, "number"):
            self.format = "number"
            return np.asarray(values.to_numpy(dtype=np.float64, na_value=np.nan))
        text = values.astype("string").str.strip()
        if self.format is None:
            self.format = self._seen(text, rows)
        if self.format == "number":
            if self.thousands is None and in_thousands(text, self.decimal) is None:
                first = first_marked(text, self.decimal)
                raise LogError(either_way(str(text.iloc[first]), f"{self.path}, line {rows[first]}, time"))
            return self._with_unit(text, numbers_in(text, self.decimal, self.thousands))
        if self.format == DIGITS:
            return self.periods.over_midnight(of_digits(numbers_in(text, self.decimal)))
        if self.format == TIME_OF_DAY:
            return self.periods.over_midnight(of_day(text))
        if self.format == MINUTES:
            return self.periods.over_the_hour(of_watch(text))
        if self.format in ("date", *ORDERS):
            return self._dated(text, rows)
        stamps = pd.to_datetime(text.str.replace(",", ".", regex=False), errors="coerce", utc=True, format="ISO8601")
        if stamps.isna().all():
            self._unreadable(text, rows, "as ISO 8601 dates, such as 2024-05-01T10:00:00.5")
        return self._since(stamps)

    def _with_unit(self, text: Any, plain: FloatArray) -> FloatArray:
        """Numbers (n_rows,) of cells that say their unit, such as 12.5 s; ``plain`` ones where they do not."""
        if np.isfinite(plain).any():
            return plain
        numbers, unit = numbers_with_unit(text, self.decimal)
        if unit not in units.factors("s") or (self.stated and unit != self.stated):
            return plain
        self.stated = unit
        return numbers

    def _seen(self, text: Any, rows: IntArray) -> str:
        known = text.dropna()
        first = known[known != ""]
        times = times_told(first)
        if times == EITHER:
            asks = "are the stamps hours and minutes, or minutes and seconds?"
            place = f"{self.path}, line {rows[0] if len(rows) else 0}"
            why = f"the first is '{first.iloc[0]}', and both can be: a time of day, and what a stopwatch shows"
            fix = f'say format = "{TIME_OF_DAY}" (hours and minutes) or format = "{MINUTES}" in [time]'
            raise LogError(Problem(asks, place, why, fix))
        if times:
            return times
        if len(first) and first.str.match(ISO).mean() > 0.5:
            return "iso"
        if any(is_date(one) for one in first.iloc[:20]):
            return "date"
        if len(first) and first.str.contains("[^\\W\\d_]{3}").all() and np.isnan(numbers_in(first, self.decimal)).all():
            self._unreadable(first, rows, "as numbers, dates or times of day")
        return "number"

    def _dated(self, text: Any, rows: IntArray) -> FloatArray:
        """Seconds since the first stamp of dates, in the order the map says or the dates show."""
        dates = Dates(text)
        if self.format in ORDERS:
            self.orders = (str(self.format),)
        else:
            seen = dates.orders()
            self.orders = tuple(one for one in (self.orders or ORDERS) if one in seen) if seen else self.orders
        stamps = {order: dates.since(order) for order in self.orders}
        if not self.began and not any(np.isfinite(t).any() for t in stamps.values()):
            self._unreadable(text, rows, "as dates of day, month and year with a time of day")
        for order, t in stamps.items():
            known = t[np.isfinite(t)]
            if len(known):
                self.began.setdefault(order, float(known[0]))
        if not self.orders:
            return np.full(len(text), np.nan)
        joined = {order: np.concatenate([[self.ended.get(order, np.nan)], t]) for order, t in stamps.items()}
        told = order_told(joined)
        if told.shows is Shows.NONE:
            place = f"{self.path}, line {rows[0] if len(rows) else 0}"
            asks = "is the day before the month in the dates, or behind it?"
            fix = 'say format = "dmy" or format = "mdy" in [time]'
            raise LogError(Problem(asks, place, f"the first is '{text.iloc[0]}'; {told.words}", fix))
        if len(self.orders) > 1 and told.shows is Shows.ONE:
            self.notes.append(f"dates are read as {told.order}: {told.words}")
            self.orders = (told.order,)
        self.ended |= {one: float(t[np.isfinite(t)][-1]) for one, t in stamps.items() if np.isfinite(t).any()}
        return np.asarray(stamps[told.order] - self.began[told.order])

    def _since(self, stamps: Any) -> FloatArray:
        if self.origin is None and stamps.notna().any():
            self.origin = stamps[stamps.notna()].iloc[0]
        if self.origin is None:
            return np.full(len(stamps), np.nan)
        return np.asarray((stamps - self.origin).dt.total_seconds().to_numpy(dtype=np.float64))

    def _unreadable(self, text: Any, rows: IntArray, how: str) -> None:
        shown = text.iloc[0] if len(text) else ""
        fix = 'say format = "number", "iso", "clock", "hhmmss", "mm:ss", "dmy", "mdy" or "ymd" in [time]'
        place = f"{self.path}, line {rows[0] if len(rows) else 0}"
        why = f"the first stamp is '{shown}'; {READABLE} can be read"
        raise LogError(Problem(f"time cannot be read {how}", place, why, fix))


def falls(t: FloatArray) -> bool:
    """Whether stamps (n_rows,) stand newest first."""
    steps = np.diff(t[np.isfinite(t)])
    return len(steps) > 2 and float(np.mean(steps <= 0.0)) > NEWEST_FIRST and float(np.median(steps)) < 0.0


@dataclass
class Timeline:
    """Time put right.

    keep    (n_rows,) rows that have a time of their own
    t       (n_rows,) time [s]; of rows not kept without meaning
    parts   rows, among those kept, at which the clock was set back: the record is cut there
    notes   what was done, in sentences
    """

    keep: BoolArray
    t: FloatArray
    parts: list[int] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def put_right(t: FloatArray, source: TimeSource, place: Any) -> Timeline:
    """A strictly increasing time axis from stamps (n_rows,) [s].

    place  function from a row to where it is in the file, for messages

    Raises LogError where fewer than 2 rows have a stamp, or stamps are in no order.
    """
    known = np.isfinite(t) & ~impossible(t, "s")
    if known.sum() < 2:
        raise LogError(Problem("fewer than two rows have a time", place(0) if len(t) else "", fix="check [time]"))
    line = Timeline(known.copy(), np.array(t))
    if (~known).any():
        row = int(np.flatnonzero(~known)[0])
        dropped = int((~known).sum())
        said = "1 row without a time was" if dropped == 1 else f"{dropped} rows without a time were"
        line.notes.append(f"{said} dropped, {'in' if dropped == 1 else 'the first in'} {place(row)}")
    if source.recover != "never":
        rows = np.flatnonzero(known)
        even = uniform(t[rows], source)
        if even is not None:
            line.t[rows], said = even
            line.notes.append(said)
            return line
    if source.recover == "uniform":
        what = "the time stamps do not fit a uniform step"
        fix = 'leave out recover, or give the true step in [time], such as step = "0.135 s"'
        raise LogError(Problem(what, place(0), "they are further off it than their printed digits allow", fix))
    _order(line, place)
    return line


def uniform(t: FloatArray, source: TimeSource) -> tuple[FloatArray, str] | None:
    """Stamps (n_rows,) printed with too few digits put back on the uniform step they come from, and what was done.

    None where they are not such: where they neither repeat nor jitter by their digits, or are further off a uniform
    step than the distance to the next printable stamp.
    """
    steps = np.diff(t)
    if len(t) < 10 or (steps < 0.0).any():
        return None
    repeats = int((steps == 0.0).sum())
    if repeats < 0.05 * len(steps) and source.recover != "uniform" and source.step is None:
        return None
    distinct, index = np.unique(t, return_inverse=True)
    if len(distinct) < 3:
        return None
    apart = np.diff(distinct)
    # The last distance holds for the last stamp too; where digits run out it is the coarser of both sides.
    spacing = np.maximum(np.concatenate([apart[:1], apart]), np.concatenate([apart, apart[-1:]]))[index]
    k = np.arange(len(t), dtype=np.float64)
    weight = 1.0 / spacing
    if source.step is None:
        matrix = np.column_stack([np.ones_like(k), k]) * weight[:, None]
        (start, step), *_ = np.linalg.lstsq(matrix, t * weight, rcond=None)
    else:
        step = source.step
        start = float(np.average(t - step * k, weights=weight**2))
    if step <= 0.0:
        return None
    off = np.abs(t - start - step * k)
    if source.step is None:
        # Loggers run at round steps: the roundest that fits as well is the likelier one.
        for digits in range(1, 6):
            round_step = float(f"{step:.{digits - 1}e}")
            round_start = float(np.average(t - round_step * k, weights=weight**2))
            round_off = np.abs(t - round_start - round_step * k)
            if round_off.max() <= 1.02 * off.max():
                start, step, off = round_start, round_step, round_off
                break
    allowed = np.where(spacing > 2.0 * step, 0.75 * spacing, np.maximum(spacing, step))
    if (off > allowed).any():
        return None
    said = (
        f"time stamps repeat in {repeats} of {len(t)} rows, as if printed with too few digits; "
        f"put back on a uniform step of {step:.6g} s, which moves none by more than {off.max():.3g} s"
    )
    return start + step * k, said


def _order(line: Timeline, place: Any) -> None:
    """Drop stamps that repeat or are off, and find where the clock was set back."""
    rows = np.flatnonzero(line.keep)
    t = line.t[rows]
    back = np.flatnonzero(np.diff(t) < 0.0) + 1
    if len(back) > max(20, 0.02 * len(t)):
        why = f"time goes back {len(back)} times"
        raise LogError(Problem("the rows are not in the order of time", place(int(rows[back[0]])), why, "sort them"))
    off: list[int] = []
    cuts: list[int] = []
    for k in back.tolist():
        ahead = next((j for j in range(1, OUTLIERS + 1) if k - 1 - j >= 0 and t[k] > t[k - 1 - j]), None)
        behind = next((j for j in range(1, OUTLIERS + 1) if k + j < len(t) and t[k + j] > t[k - 1]), None)
        # A stamp far ahead leaves a gap before it; one far behind leaves none.
        if ahead is not None and (behind is None or ahead <= behind):
            off += range(k - ahead, k)
        elif behind is not None:
            off += range(k, k + behind)
        else:
            cuts.append(k)
    if off:
        line.keep[rows[off]] = False
        line.notes.append(
            f"{len(set(off))} rows have a time stamp off the others and were dropped, "
            f"the first in {place(int(rows[off[0]]))}"
        )
    for k in cuts:
        line.notes.append(
            f"the clock was set back by {t[k - 1] - t[k]:.6g} s in {place(int(rows[k]))}: the record is cut there"
        )
    kept = np.setdiff1d(np.arange(len(t)), off)
    bounds = [0, *cuts, len(t)]
    repeated: list[int] = []
    edges = np.searchsorted(kept, bounds).tolist()
    for first, last in itertools.pairwise(edges):
        inside = kept[first:last]
        if len(inside):
            highest = np.maximum.accumulate(t[inside])
            late = inside[1:][t[inside[1:]] <= highest[:-1]]
            repeated += late.tolist()
    if repeated:
        line.keep[rows[repeated]] = False
        line.notes.append(
            f"{len(repeated)} rows repeat a time stamp and were dropped, the first in {place(int(rows[min(repeated)]))}"
        )
        if len(repeated) > 0.5 * len(t):
            fix = 'give the true step in [time], such as step = "0.1 s", or write stamps with more digits'
            why = f"{len(repeated)} of {len(t)} rows have the stamp of the row before, unevenly"
            raise LogError(Problem("time stamps are too coarse", place(int(rows[min(repeated)])), why, fix))
    left = np.cumsum(line.keep[rows])
    line.parts = [int(left[k - 1]) for k in cuts]
