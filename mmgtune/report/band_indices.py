"""Indices with their bands as reports show them."""

from __future__ import annotations

from collections.abc import Mapping
from math import floor, log10
from typing import Any

from . import approaches
from .blocks import Cell, Table, cells
from .wording import NONE, clean, fixed, number, shown


def banded(row: Mapping[str, Any]) -> str:
    """A mean with half its band; "3.1 or more" where a share of the particles never gets there."""
    mean, half, low = (number(row[key]) for key in ("mean", "half_width", "low"))
    if mean is None:
        return "never reached"
    if row["particles"] == 1:
        return shown(mean, 3)
    if half is None:
        return NONE if low is None else f"{shown(low, 3)} or more"
    decimals = 1 if half <= 0.0 else min(max(1 - floor(log10(half)), 0), 6)
    return f"{fixed(mean, decimals)} ± {fixed(half, decimals)}"


def indices_table(run: Mapping[str, Any], level: float, several: bool) -> Table | None:
    """All indices of a run, None of one that has none.

    level    percent that bands hold
    several  whether there is a band; without one nothing is said of bands
    """
    measured = any(number(row["measured"]) is not None for row in run["indices"])
    rows = []
    for row in run["indices"]:
        lengths = row["over_L"]
        line: list[str | Cell] = [
            f"{row['words']} [{row['unit']}]",
            banded(row),
            banded(lengths) if lengths else NONE,
        ]
        if several:
            line.append(f"{shown(row['low'], 3)} to {shown(row['high'], 3)}")
        if measured:
            line.append(Cell(shown(row["measured"]), _tone(row) if several else ""))
        if several:
            never = row["particles"] - row["reached"]
            line.append(Cell(str(never), "bad") if never else "0")
        rows.append(cells(*line))
    if not rows:
        return None
    heads = ["index", "mean ± half the band" if several else "foretold", "in ship lengths"]
    heads += [f"band of {shown(level, 3)} %"] if several else []
    heads += ["measured"] if measured else []
    heads += ["never reach it"] if several else []
    order = f": {clean(run['order'])}" if run.get("order") else ""
    caption = f"Indices of {clean(run['id'])}{order}{approaches.in_caption(run)}"
    caption += "; particles that never reach one count as beyond all others" if several else ""
    return Table(f"indices-{clean(run['id'])}", caption, tuple(heads), tuple(rows), numeric=range(1, len(heads)))


def _tone(row: Mapping[str, Any]) -> str:
    """Whether the measured value lies in the band."""
    value, low, high = (number(row[key]) for key in ("measured", "low", "high"))
    if value is None:
        return ""
    return "good" if (low is None or value >= low) and (high is None or value <= high) else "bad"
