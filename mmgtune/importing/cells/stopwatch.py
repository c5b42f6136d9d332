"""Stamps of two or three numbers, with colons or without: the time of day, or minutes and seconds of a stopwatch."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from ...arrays import BoolArray, FloatArray

CLOCK = r"(\d{1,2}):(\d{2})(?::(\d{2}(?:[.,]\d*)?))?(?:\s*([AaPp])\.?[Mm]\.?)?"
"""Hours, minutes and seconds, if any; the half of the day."""
WATCH = r"(?:(\d{1,2}):)?(\d{1,3}):(\d{2}(?:[.,]\d*)?)"
"""Hours, if any, minutes and seconds."""
TIME_OF_DAY, MINUTES, EITHER = "clock", "mm:ss", "clock or mm:ss"
"""What stamps are: hours first, minutes first, or one as well as the other."""
DIGITS = "hhmmss"
"""The same without colons: a time of day as one number."""
_TWO, _SPLIT = r"(\d{1,3}):(\d{2})", r"(\d{1,3}):(\d{2})[.,]\d*"
_HOURS, _MINUTES, _SECONDS = "[hH時时시]|시간", "[mM]|min|分|분", "[sS]|sec|秒|초"
_WORDED = rf"(?:(\d{{1,2}})\s*(?:{_HOURS})\s*)?(\d{{1,3}})\s*(?:{_MINUTES})\s*(\d{{1,2}}(?:[.,]\d*)?)\s*(?:{_SECONDS})"
"""Hours, if any, minutes and seconds, each with its unit behind it: 1h02m03.5s, 12時34分56秒."""
_FEW = 0.02
"""Share of damaged stamps that tells nothing."""


def are_times(texts: Any) -> bool:
    """Whether most cells of a pandas column of texts are such stamps."""
    texts = with_colons(texts)
    return bool(len(texts)) and bool((_matches(texts, CLOCK) | _matches(texts, WATCH)).mean() > 0.5)


def with_colons(texts: Any) -> Any:
    """A pandas column of texts with colons in place of the units of stamps that have them; as it is where its first has
    none.  Such stamps say their hours, if only as 0, so that nothing is left to tell."""
    first = texts.dropna()
    first = first[first != ""].head(1)
    if not len(first) or not _matches(first, _WORDED).all():
        return texts

    def colons(found: re.Match[str]) -> str:
        h, m, s = found.groups()
        return f"{h or 0}:{int(m):02d}:{s if len(re.split('[.,]', s)[0]) > 1 else '0' + s}"

    return texts.str.replace(f"^{_WORDED}$", colons, regex=True)


def times_told(texts: Any) -> str:
    """What the stamps of a pandas column of texts are, one of the above; "" where most are no such stamps.

    Told by a third number, by AM and PM, by a fraction, by a first number that no hour is, and by midnight.
    """
    known = texts.dropna()
    known = with_colons(known[known != ""])
    if not are_times(known):
        return ""
    two = _matches(known, _TWO)
    if _matches(known, _SPLIT).mean() > _FEW:
        return MINUTES
    if two.mean() <= _FEW:
        return TIME_OF_DAY
    pairs = known[two].str.extract(f"^{_TWO}$").astype(np.float64).to_numpy()
    if (pairs[:, 0] > 24.0).mean() > _FEW:
        return MINUTES
    if (~two & (_matches(known, CLOCK) | _matches(known, WATCH))).mean() > _FEW:
        if known.str.contains("[AaPp]").mean() > _FEW:
            return TIME_OF_DAY
        # Hours that a stopwatch writes once there are any, or seconds that a clock leaves out where there are none.
        by_hours, by_minutes = (_backwards(one(known)) for one in (of_day, of_watch))
        return MINUTES if by_minutes < by_hours else TIME_OF_DAY
    steps = np.diff(pairs @ [60.0, 1.0])
    usual = float(np.median(steps[steps > 0.0])) if (steps > 0.0).any() else 1.0
    over_midnight = steps[steps < -720.0] + 1440.0
    return TIME_OF_DAY if ((over_midnight >= 0.0) & (over_midnight <= 5.0 * usual)).any() else EITHER


def of_day(texts: Any) -> FloatArray:
    """Seconds since midnight (n_rows,) of times of day; NaN where a cell is none."""
    parts = with_colons(texts).str.extract(f"^{CLOCK}$")
    half = parts.pop(3).str.lower()
    h, m, s = _numbers(parts.fillna({2: "0"}))
    h = np.where(half.notna().to_numpy(dtype=bool), np.mod(h, 12.0), h)
    h = h + 12.0 * (half == "p").to_numpy(dtype=bool, na_value=False)
    return np.asarray(3600.0 * h + 60.0 * m + s)


def of_digits(numbers: FloatArray) -> FloatArray:
    """Seconds since midnight (n_rows,) of times of day written as one number, 235959.5; NaN where it is none."""
    h, rest = np.divmod(numbers, 1e4)
    m, s = np.divmod(rest, 100.0)
    return np.where((numbers >= 0.0) & (h < 24.0) & (m < 60.0) & (s < 60.0), 3600.0 * h + 60.0 * m + s, np.nan)


def in_digits(numbers: FloatArray) -> bool:
    """Whether numbers (n_rows,) are such times: all can be, and read so they grow evenly, but not as they stand.

    The first full minute tells it: from 59 to 100.
    """
    known = numbers[np.isfinite(numbers)]
    t = of_digits(known)
    if len(t) < 10 or not np.isfinite(t).all() or np.ptp(known) == 0.0:
        return False
    steps = np.mod(np.diff(t), 86400.0)
    usual = float(np.median(steps))
    jumps = np.abs(np.diff(known) - np.diff(t)) > 1.0  # a minute, an hour or midnight between
    return bool(jumps.any() and not jumps.all() and usual > 0.0 and (steps[jumps] < 5.0 * max(usual, 1.0)).mean() > 0.9)


def of_watch(texts: Any) -> FloatArray:
    """Seconds (n_rows,) of a stopwatch; NaN where a cell is no stamp of one."""
    h, m, s = _numbers(with_colons(texts).str.extract(f"^{WATCH}$").fillna({0: "0"}))
    return np.asarray(3600.0 * h + 60.0 * m + s)


def _numbers(parts: Any) -> tuple[FloatArray, ...]:
    parts = parts.apply(lambda one: one.str.replace(",", ".", regex=False))
    return tuple(parts[k].astype("Float64").to_numpy(dtype=np.float64, na_value=np.nan) for k in range(3))


def _matches(texts: Any, pattern: str) -> BoolArray:
    return np.asarray(texts.str.fullmatch(pattern).fillna(False).to_numpy(dtype=bool))


def _backwards(t: FloatArray) -> int:
    return int((np.diff(t[np.isfinite(t)]) < 0.0).sum())
