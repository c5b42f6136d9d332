"""The report of trials left out in turn: what a tuning is worth on runs it has not seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from . import advice, measures, tables
from .band_scores import SCORE_HEADS, score_cells
from .blocks import Card, Commands, Fold, Nothing, Page, Prose, Section, Table, cells
from .common import assumptions, doubts, generated_banner, picture, provenance, warnings
from .load import Kind
from .plot import Axis, Dots, Figure, Line, Look, Mark, Panel
from .tables import tone
from .wording import NONE, change, clean, coefficient_text, count, number, percent, share, short, shown, span


def build(data: Mapping[str, Any]) -> Page:
    """Everything the report of leaving trials out says."""
    ship = clean(data["profile"].get("name") or data["profile"].get("id") or "the ship")
    sections = [
        _scores(data),
        _bands(data),
        _stated(data),
        _coefficients(data),
        Section("next", "What to do next", (Commands(advice.after_leave_out(data)),)),
        assumptions(data),
        provenance(data),
    ]
    stopped = f"Stopped after {len(data['parts'])} of {data.get('n_parts')} parts; --resume goes on."
    return Page(
        title=f"{ship}: trials left out in turn",
        eyebrow=f"{ship} · {count(len(data['parts']), 'fit')}, each without some of the trials",
        verdict=_verdict(data),
        banners=generated_banner(data["trials"]),
        warnings=(*((stopped,) if data.get("interrupted") else ()), *warnings(data), *doubts(data)),
        cards=_cards(data),
        sections=tuple(section for section in sections if section is not None),
    )


def _whole(data: Mapping[str, Any]) -> Mapping[str, Any] | None:
    return next((row for row in data["scores"] if row["manoeuvre"] == "all"), None)


def _verdict(data: Mapping[str, Any]) -> str:
    row = _whole(data)
    if row is None:
        return "No trial with time series was left out." if data["parts"] else "No part was finished."
    removed = number(row["share_removed"])
    if removed is None:
        return "The model diverged on a trial that was left out."
    if removed <= 0.0:
        return "Tuning does not help on trials it has not seen: the error there does not fall."
    interval = row["share_removed_ci95"]
    sure = f" (95 % interval {span(*interval)}, runs drawn anew)" if interval else ""
    return f"On trials it has not seen, tuning removes {share(removed)} of the error{sure}."


def _cards(data: Mapping[str, Any]) -> tuple[Card, ...]:
    row = _whole(data)
    if row is None:
        return ()
    note = f"trials left out in turn, {count(row['runs'], 'run')}"
    cards = []
    for key, label, unit, digits in (
        ("position_rms_m", "Off track", " m", 3),
        ("heading_rms_deg", "Off heading", "°", 2),
        ("L_MSE", "L_MSE", "", 3),
        ("J", "Misfit J", "", 4),
    ):
        before, after = row.get(f"{key}_before"), row.get(f"{key}_after")
        if number(before) is not None and number(after) is not None:
            moved = change(before, after)
            value = f"{shown(before, digits)} → {shown(after, digits)}{unit}"
            cards.append(Card(label, value, percent(moved), note, tone(moved)))
    return tuple(cards)


def _kinds(rows: Sequence[Any]) -> Sequence[Any]:
    """Rows of all runs, then of each kind of manoeuvre; of one kind alone, which is all runs, it is said once."""
    return rows[1:] if len(rows) == 2 else rows


def _scores(data: Mapping[str, Any]) -> Section:
    rows = _kinds(data["scores"])
    if not rows:
        return Section("scores", "Trials left out", (Nothing("There is no time series to score."),))
    places = tuple((float(k), f"{clean(row['manoeuvre'])}\n{row['runs']}") for k, row in enumerate(rows))
    before, after = Look("before", 0.0, marker="^", size=8), Look("after", 0.0, marker="s", size=7)
    marks: list[Mark] = []
    for k, row in enumerate(rows):
        a, b = number(row["L_MSE_before"]), number(row["L_MSE_after"])
        if a is not None and b is not None and a > 0.0 and b > 0.0:
            marks += [Line((k, k), (a, b), Look("muted", 1.2)), Dots((k,), (a,), before), Dots((k,), (b,), after)]
    panel = Panel(
        tuple(marks),
        Axis("kind of manoeuvre, number of runs", -0.6, len(rows) - 0.4, ticks=places, grid=False),
        Axis("L_MSE [–]", log=bool(marks), room=0.1),
        shape=0.42,
    )
    figure = Figure("scores", "Error of trials left out, before and after tuning to the others", (panel,),
                    (("before tuning", before), ("tuned to the others", after)))  # fmt: skip
    lines = []
    for row in rows:
        moved = change(row["L_MSE_before"], row["L_MSE_after"])
        interval = row["share_removed_ci95"]
        lines.append(
            cells(
                clean(row["manoeuvre"]),
                str(row["runs"]),
                shown(row["L_MSE_before"]),
                shown(row["L_MSE_after"]),
                percent(moved),
                share(row["share_removed"]),
                span(*interval) if interval else NONE,
                shown(row["J_before"]),
                shown(row["J_after"]),
            )
        )
    table = Table(
        "scores-table",
        "Scores of trials left out, with the coefficients before tuning and as tuned to the others",
        ("manoeuvre", "runs", "L_MSE before", "after", "change", "removed", "95 % interval", "J before", "after"),
        tuple(lines),
        range(1, 9),
        (
            ("L_MSE [–]", measures.L_MSE),
            ("removed", "share of L_MSE that tuning takes away; its interval by drawing runs anew"),
            ("J [–]", measures.J),
        ),
    )
    caption = "Each trial is scored by the fit that has not seen it; lower is better."
    return Section("scores", "Trials left out", (picture(figure, "Scores", caption), table))


def _bands(data: Mapping[str, Any]) -> Section | None:
    """What bands drawn from the other trials hold; records without them have none."""
    bands = data.get("bands") or {}
    kinds = bands.get("by_manoeuvre") or {}
    if not kinds:
        return None
    held = number(kinds["all"]["coverage_90"]) if "all" in kinds else None
    heads = ("windows", "50 % holds", "90 % holds", "CRPS", "width of 90 %")
    at = [SCORE_HEADS.index(head) for head in heads]

    def table(id: str, caption: str, first: str, of: Mapping[str, Any]) -> Table:
        rows = tuple(cells(clean(name), *(score_cells(one)[k] for k in at)) for name, one in of.items())
        about = (
            ("holds", "share of measured samples inside the band; samples have the noise of their sensors, bands none"),
            ("CRPS", "distance of the particles from what was measured, less half of that between them"),
            ("CRPS, width", "mean over the states, each over its spread over the trials"),
        )
        return Table(id, caption, (first, *heads), rows, range(1, 1 + len(heads)), about)

    said = NONE if held is None else share(held)
    sentence = f"Bands of 90 % drawn from the other trials hold {said} of what was measured on those left out."
    runs = table("bands-by-run", "By run", "run", bands["by_run"])
    return Section(
        "bands",
        "Bands from the other trials",
        (
            Prose((sentence,)),
            table("bands-table", "By kind of manoeuvre", "manoeuvre", dict(_kinds(list(kinds.items())))),
            Fold("By run", (runs,)),
        ),
    )


def _stated(data: Mapping[str, Any]) -> Section | None:
    rows = data.get("stated") or ()
    table = tables.stated_rows(rows, ("before", "left_out"), ("before", "left out"))
    return None if table is None else Section("stated", "Stated indices", (table,))


def _coefficients(data: Mapping[str, Any]) -> Section | None:
    """How far the tuned values depend on which trials they are tuned to."""
    parts: Sequence[Mapping[str, Any]] = data["parts"]
    if len(parts) < 2:
        return None
    lines = []
    for name in parts[0]["theta"]:
        values = [value for part in parts if (value := number(part["theta"].get(name))) is not None]
        if not values:
            continue
        middle, spread = sum(values) / len(values), max(values) - min(values)
        relative = percent(100.0 * spread / abs(middle)).lstrip("+") if middle else NONE
        lines.append(
            cells(short(clean(name)), *(coefficient_text(end) for end in (min(values), max(values))), relative)
        )
    table = Table(
        "parts-table",
        f"Tuned values over {len(parts)} fits, each without some of the trials",
        ("coefficient", "least", "greatest", "spread over mean"),
        tuple(lines),
        range(1, 4),
    )
    left = [f"{k}: {', '.join(clean(one) for one in part['left_out'])}" for k, part in enumerate(parts, 1)]
    folded = Fold("Which trials each fit left out", (Prose(tuple(left), listed=True),))
    return Section("coefficients", "Coefficients of the fits", (table, folded))


KIND = Kind("leave-out", ("profile", "trials", "scores", "parts"), lambda _, data: data, build)
