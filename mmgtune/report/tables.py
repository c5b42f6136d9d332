"""The tables of a fit's report."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..how_far_off import off_heading, off_track
from ..manoeuvres.named import in_order
from .blocks import Cell, Table, cells
from .wording import (
    CHANNELS,
    NONE,
    ROLES,
    change,
    clean,
    coefficient_text,
    fixed,
    index_words,
    is_index,
    number,
    percent,
    short,
    shown,
    unit_words,
)

if TYPE_CHECKING:
    from .load import RunRecord


def tone(value: float | None, small: float = 0.05) -> str:
    """Whether a relative change in percent of a misfit is good, bad or nothing."""
    if value is None or abs(value) < small:
        return ""
    return "good" if value < 0.0 else "bad"


def trials(record: RunRecord) -> Table:
    """Every trial: role and J before and after."""
    rows = []
    for row in record.results:
        moved = change(row.get("J_before"), row.get("J_after"))
        ended = row.get("status_after", "ok")
        rows.append(
            cells(
                clean(row["id"]),
                clean(row.get("manoeuvre") or NONE),
                ROLES.get(str(row.get("role")), "not used"),
                clean(row.get("source") or "not stated"),
                shown(row.get("n_samples"), 9),
                f"{shown(off_track(row, 'before'), 3)} → {shown(off_track(row, 'after'), 3)}",
                f"{shown(off_heading(row, 'before'), 2)} → {shown(off_heading(row, 'after'), 2)}",
                shown(row.get("J_before")),
                Cell("diverged", "bad") if ended != "ok" else Cell(shown(row.get("J_after"))),
                Cell(percent(moved), tone(moved)) if ended == "ok" else Cell(NONE),
            )
        )
    return Table(
        "trials-table",
        "How far off each trial is, and its misfit J, with the pre-determined and with the tuned coefficients",
        (
            "trial",
            "manoeuvre",
            "role",
            "data",
            "samples",
            "off track [m]",
            "off heading [deg]",
            "J before",
            "J after",
            "change of J",
        ),
        tuple(rows),
        numeric=range(4, 10),
    )


def errors(record: RunRecord) -> Table:
    """Root-mean-square residuals of every trial and channel, before and after."""
    used = [name for name in ("x", "y", "psi", "u", "v_m", "r") if any(name in _rms(row) for row in record.results)]
    rows = []
    for row in record.results:
        line: list[str | Cell] = [clean(row["id"])]
        for name in used:
            channel, pair = CHANNELS[name], _rms(row).get(name) or {}
            before, after = number(pair.get("before")), number(pair.get("after"))
            decimals = max(1, channel.decimals - 1)
            first = fixed(None if before is None else before * channel.factor, decimals)
            last = fixed(None if after is None else after * channel.factor, decimals)
            line.append(Cell(f"{first} → {last}", tone(change(before, after), 1.0)))
        rows.append(cells(*line))
    titles = tuple(CHANNELS[name].title for name in used)
    return Table(
        "errors-table",
        "Root-mean-square error of the simulation, before → after tuning",
        ("trial", *titles),
        tuple(rows),
        numeric=range(1, 1 + len(titles)),
    )


def _rms(row: Mapping[str, Any]) -> Mapping[str, Any]:
    return row.get("rms") or {}


def indices(record: RunRecord) -> Table | None:
    """Indices of the manoeuvres: measured, before and after with their errors; None where there are none."""
    rows = []
    for row in record.results:
        values = row.get("indices") or {}
        measured, before, after = (values.get(which) or {} for which in ("measured", "before", "after"))
        for key in filter(is_index, in_order(dict.fromkeys([*measured, *before, *after]))):
            true, first, last = number(measured.get(key)), number(before.get(key)), number(after.get(key))
            if true is None and first is None and last is None:
                continue
            words, unit = index_words(key)
            errors = [deviation(true, value, unit) for value in (first, last)]
            off = [None if true is None or value is None else value - true for value in (first, last)]
            rows.append(
                cells(
                    clean(row["id"]),
                    f"{words} [{unit}]" if unit else words,
                    shown(true),
                    shown(first),
                    errors[0],
                    shown(last),
                    Cell(errors[1], _nearer(*off)),
                )
            )
    if not rows:
        return None
    return Table(
        "indices-table",
        "Indices of the manoeuvres, and how far the simulation is off the measured ones",
        ("trial", "index", "measured", "before", "error", "after", "error"),
        tuple(rows),
        numeric=range(2, 7),
    )


def stated(record: RunRecord) -> Table | None:
    """Stated indices with their tolerance, before and after; None where there are none."""
    return stated_rows(record.data.get("stated") or (), ("before", "after"), ("before", "after"))


def stated_rows(
    rows: Sequence[Mapping[str, Any]], which: Sequence[str], words: Sequence[str], id: str = "stated"
) -> Table | None:
    """Stated indices with their tolerance and what models make of them; None where there are none.

    which, words  the models, keys of the rows, and what they are called; the last is judged
    """
    lines = []
    for row in rows:
        unit = clean(row.get("unit") or "")
        off = [number((row.get("off") or {}).get(one)) for one in which]
        mark = " (assumed)" if row.get("assumed_tolerance") else ""
        last = Cell(shown(row.get(which[-1])), _nearer(off[0], off[-1]) if len(which) > 1 else "")
        lines.append(
            cells(
                clean(row["trial"]),
                ROLES.get(str(row.get("role")), "not used"),
                clean(row.get("words") or row["index"]) + (f" [{unit}]" if unit else ""),
                f"{shown(row.get('stated'))} ± {shown(row.get('tolerance'), 2)}{mark}",
                *(shown(row.get(one)) for one in which[:-1]),
                last,
                fixed(off[-1], 2),
            )
        )
    if not lines:
        return None
    return Table(
        f"{id}-table",
        "Stated indices and what the model's own helmsman makes of them",
        ("trial", "role", "index", "stated", *words, "off"),
        tuple(lines),
        range(3, 5 + len(which)),
        (("off", "simulated less stated, in tolerances"),),
    )


def _nearer(before: float | None, after: float | None) -> str:
    """The tone of an error that was ``before`` and is ``after``."""
    return tone(None if before is None or after is None else change(abs(before), abs(after)), 1.0)


def deviation(true: float | None, value: float | None, unit: str) -> str:
    """The error of an index: in percent, or for angles in degrees."""
    if true is None or value is None:
        return NONE
    if unit == "deg":
        return f"{'+' if value > true else ''}{fixed(value - true, 1)} deg"
    return percent(change(true, value))


def described(row: Mapping[str, Any]) -> str:
    """What a coefficient means, with its unit where it has one."""
    unit = unit_words(row.get("unit"))
    return clean(row.get("label") or "") + (f" [{unit}]" if unit else "")


def coefficients(rows: Iterable[Mapping[str, Any]]) -> Table:
    """Tuned coefficients with their box, standard error and what is to be said of them."""
    lines = []
    for row in rows:
        notes, flag = [], ""
        if row.get("at_bound"):
            notes.append(f"at its {clean(row['at_bound'])} bound")
            flag = "note"
        if row.get("determined") is False:
            notes.append("not determined")
            flag = "bad"
        lines.append(
            cells(
                short(clean(row["name"])),
                described(row),
                coefficient_text(row["pre_determined"]),
                f"{coefficient_text(row['low'])}\u00a0… {coefficient_text(row['high'])}",
                Cell(coefficient_text(row["value"])),
                percent(change(row["pre_determined"], row["value"])),
                shown(row.get("stderr"), 2),
                Cell("; ".join(notes) or "inside", flag),
            )
        )
    return Table(
        "coefficients-table",
        "Tuned coefficients",
        ("symbol", "meaning", "pre-determined", "box", "tuned", "change", "std. error", "state"),
        tuple(lines),
        numeric=range(2, 7),
        cards=True,
        about=(("box", "what the search was allowed"), ("std. error", "standard deviation that the noise gives it")),
    )


def correlation(names: Sequence[str], matrix: Sequence[Sequence[Any]], limit: int = 20) -> Table:
    """The strongest correlations between coefficients."""
    pairs = [
        (value, names[i], names[j])
        for i in range(len(names))
        for j in range(i)
        if (value := number(matrix[i][j])) is not None
    ]
    pairs.sort(key=lambda pair: -abs(pair[0]))
    rows = tuple(cells(short(clean(one)), short(clean(two)), fixed(value, 3)) for value, one, two in pairs[:limit])
    return Table(
        "correlation-table",
        "Strongest correlations of the coefficients' errors",
        ("coefficient", "with", "correlation"),
        rows,
        numeric=(2,),
    )


def restarts(entries: Sequence[Mapping[str, Any]]) -> Table:
    """What each restart of the search reached."""
    rows = tuple(
        cells(
            str(index),
            shown(entry.get("lambda"), 9),
            shown(entry.get("generations"), 9),
            shown(entry.get("evaluations"), 9),
            shown(entry.get("J"), 7),
            clean(entry.get("stop") or NONE),
        )
        for index, entry in enumerate(entries, start=1)
    )
    return Table(
        "restarts-table",
        "Restarts of the search",
        ("restart", "population", "generations", "evaluations", "J reached", "stopped by"),
        rows,
        numeric=range(1, 5),
    )


def pairs(
    id: str,
    caption: str,
    titles: tuple[str, str],
    items: Iterable[tuple[str, str]],
    numeric: bool = False,
    raw: bool = False,
) -> Table:
    """A two-column table of names and texts, or names and numbers."""
    rows = tuple(cells(clean(name), clean(text)) for name, text in items)
    return Table(id, caption, titles, rows, (1,) if numeric else (), raw=raw)
