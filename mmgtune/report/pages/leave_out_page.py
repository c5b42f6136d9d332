"""The report of trials left out in turn: what a tuning is worth on runs it has not seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...how_far_off import mean_off_track, off_track
from .. import advice, codes, findings, measures, motion_block, repeated, tables, tables_of_motion
from ..band_scores import SCORE_HEADS, score_cells
from ..blocks import Card, Commands, Fold, Nothing, Page, Picture, Prose, Section, Table, cells
from ..common import assumptions, doubts, generated_banner, picture, provenance, ship_name, warnings
from ..figures.plot import Axis, Dots, Figure, Line, Look, Mark, Panel
from ..forces import Ship
from ..load import Kind, inputs_of, motions_in
from ..tables import tone
from ..wording import NONE, Channel, change, clean, coefficient_text, count, number, percent, share, short, shown, span

if TYPE_CHECKING:
    from ..load import Motion


WORDS = {"measured": "measured", "before": "before tuning", "after": "tuned to the others"}

MOST = 24
"""Runs that the picture has room for."""


@dataclass(frozen=True)
class LeaveOutRecord:
    """What leaving out left in its folder: leave_out.json, and motions of the trials left out, trial -> which."""

    data: Mapping[str, Any]
    motions: Mapping[str, Mapping[str, Motion]]
    inputs: tuple[Channel, ...] = ()

    @property
    def results(self) -> list[Mapping[str, Any]]:
        """The trials left out; records of older versions have none."""
        return list(self.data.get("trial_results") or ())


def build(record: LeaveOutRecord) -> Page:
    """Everything the report of leaving trials out says."""
    data = record.data
    ship = ship_name(data)
    sections = [
        _motions(record),
        _scores(record),
        _indices(record),
        _repeated(data),
        _bands(data),
        _stated(data),
        _coefficients(data),
        Section("next", "What to do next", (Commands(advice.after_leave_out(data)),)),
        assumptions(data),
        provenance(data),
    ]
    stopped = "The scores are of the parts that were finished; --resume goes on."
    return Page(
        title=f"{ship}: trials left out in turn",
        eyebrow=f"{ship} · {count(len(data['parts']), 'fit')}, each without some of the trials",
        verdict=verdict(data),
        lead=(f"L_MSE: {measures.L_MSE}.", f"The misfit J: {measures.J}.") if _whole(data) else (),
        banners=generated_banner(data["trials"]),
        warnings=(*((stopped,) if data.get("interrupted") else ()), *warnings(data), *doubts(data)),
        cards=_cards(data),
        sections=tuple(section for section in sections if section is not None),
    )


def _whole(data: Mapping[str, Any]) -> Mapping[str, Any] | None:
    return next((row for row in data["scores"] if row["manoeuvre"] == "all"), None)


def verdict(data: Mapping[str, Any]) -> str:
    """The answer; first of all that it is not the whole one, where the run was stopped."""
    if not data.get("interrupted"):
        return _answer(data)
    return f"Stopped before its end, after {len(data['parts'])} of {data.get('n_parts')} parts. {_answer(data)}"


def _answer(data: Mapping[str, Any]) -> str:
    row = _whole(data)
    if row is None:
        return "No trial with time series was left out." if data["parts"] else "No part was finished."
    removed = number(row["share_removed"])
    if removed is None:
        return "The model diverged on a trial that was left out."
    place, heading = (number(row.get(f"{key}_after")) for key in ("position_rms_m", "heading_rms_deg"))
    off = ""
    if place is not None:
        first, first_heading = (number(row.get(f"{key}_before")) for key in ("position_rms_m", "heading_rms_deg"))
        both = heading is not None and first_heading is not None
        off = f"On trials it has not seen, a tuned model is {shown(place, 3)} m off track"
        off += f" and {shown(heading, 2)}° off heading" if both else ""
        off += f" instead of {shown(first, 3)} m" + (f" and {shown(first_heading, 2)}°" if both else "")
        off += " (root mean square)"
    if removed <= 0.0:
        return f"{off or 'On trials it has not seen, tuning does not help'}: the error L_MSE there does not fall."
    interval = row["share_removed_ci95"]
    sure = f" ({span(*interval)} with 95 % confidence, judged by how much the runs differ)" if interval else ""
    told = f"tuning removes {share(removed)} of the error L_MSE{sure}."
    return f"{off}: {told}" if off else f"On trials it has not seen, {told}"


def _cards(data: Mapping[str, Any]) -> tuple[Card, ...]:
    row = _whole(data)
    if row is None:
        return ()
    where = f"all samples of {count(row['runs'], 'run')}, each left out in turn"
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
            note = f"root mean square over {where}" if unit else where
            cards.append(Card(label, value, percent(moved), note, tone(moved)))
    return tuple(cards)


def _kinds(rows: Sequence[Any]) -> Sequence[Any]:
    """Rows of all runs, then of each kind of manoeuvre; of one kind alone, which is all runs, it is said once."""
    return rows[1:] if len(rows) == 2 else rows


def _motions(record: LeaveOutRecord) -> Section | None:
    """Tracks of the trials left out, the worst of them first, and which is the worst and which is as most are."""
    results = record.results
    known = sorted(
        ((off, row) for row in results if (off := off_track(row, "after")) is not None), key=lambda one: one[0]
    )
    said = "Each trial is simulated with the coefficients that were tuned without it."
    if len(known) > 2:
        worst, typical = known[-1][1], known[(len(known) - 1) // 2][1]
        said += (
            f" The worst is {clean(worst['id'])}, {findings.off_track_words(worst, 'after')}; half of them are no "
            f"worse than {clean(typical['id'])}, {findings.off_track_words(typical, 'after')}."
        )
    first = str(known[-1][1]["id"]) if known else ""
    block = motion_block.of_trials(
        results, record.motions, record.inputs, said, words=WORDS, ship=Ship(number(record.data.get("L_pp"))),
        first=first, data=motion_block.numbers(results, record.motions, WORDS), finding=said,
    )  # fmt: skip
    return None if block is None else Section("motions", "Tracks of the trials left out", (block,))


def _indices(record: LeaveOutRecord) -> Section | None:
    table = tables_of_motion.index_errors(record.results)
    return None if table is None else Section("indices", "Manoeuvring indices of the trials left out", (table,))


def _repeated(data: Mapping[str, Any]) -> Section | None:
    """Manoeuvres repeated from their orders before tuning and as tuned to the others, where that was asked for."""
    found = data.get("manoeuvres") or {}
    return repeated.section({WORDS["before"]: found.get("before"), WORDS["after"]: found.get("left_out")})


def _by_run(results: Sequence[Mapping[str, Any]]) -> list[tuple[str, str, float, float]]:
    """Runs with their manoeuvre and how far off track they are before and after [m], the worst first."""
    runs: dict[str, list[Mapping[str, Any]]] = {}
    for row in results:
        runs.setdefault(str(row.get("run") or row["id"]), []).append(row)
    found = []
    for run, rows in runs.items():
        before, after = (mean_off_track(rows, which) for which in ("before", "after"))
        if before is not None and after is not None:
            found.append((clean(run), clean(rows[0].get("manoeuvre") or ""), before, after))
    return sorted(found, key=lambda one: -one[3])


def _runs(results: Sequence[Mapping[str, Any]]) -> Picture | None:
    """How far off track every run is when it is left out; None where that is not known."""
    rows = _by_run(results)
    if not rows:
        return None
    before, after = Look("before", 0.0, marker="^", size=8), Look("after", 0.0, marker="s", size=7)
    marks: list[Mark] = []
    for k, (_, _, a, b) in enumerate(rows[:MOST]):
        marks += [Line((a, b), (k, k), Look("muted", 1.2)), Dots((a,), (k,), before), Dots((b,), (k,), after)]
    log = min(min(a, b) for _, _, a, b in rows[:MOST]) > 0.0
    names = tuple((float(k), row[0]) for k, row in enumerate(rows[:MOST]))
    panel = Panel(
        tuple(marks),
        Axis("off track [m]", low=None if log else 0.0, log=log, room=0.06),
        Axis(low=len(names) - 0.4, high=-0.6, ticks=names, grid=False),
        shape=-(26.0 * len(names) + 60.0),
    )
    figure = Figure("scores", "Distance off track of each run left out, before tuning and as tuned to the others",
                    (panel,), ((WORDS["before"], before), (WORDS["after"], after)))  # fmt: skip
    closer = sum(b < a for _, _, a, b in rows)
    caption = f"Root mean square, the worst run first; {closer} of {count(len(rows), 'run')} come closer."
    caption += f" Shown are the {MOST} worst." if len(rows) > MOST else ""
    data = Table("runs-table", "Off track by run left out [m]", ("run", "manoeuvre", WORDS["before"], WORDS["after"]),
                 tuple(cells(run, kind, shown(a, 3), shown(b, 3)) for run, kind, a, b in rows), (2, 3))  # fmt: skip
    return picture(figure, "Runs left out", caption, data)


def _before_and_after(row: Mapping[str, Any], key: str, digits: int) -> str:
    return f"{shown(row.get(f'{key}_before'), digits)} → {shown(row.get(f'{key}_after'), digits)}"


def _scores(record: LeaveOutRecord) -> Section:
    rows = _kinds(record.data["scores"])
    if not rows:
        return Section("scores", "Trials left out", (Nothing("There is no time series to score."),))
    lines = []
    for row in rows:
        interval = row["share_removed_ci95"]
        lines.append(
            cells(
                clean(row["manoeuvre"]),
                str(row["runs"]),
                _before_and_after(row, "position_rms_m", 3),
                _before_and_after(row, "heading_rms_deg", 2),
                _before_and_after(row, "L_MSE", 3),
                share(row["share_removed"]),
                span(*interval) if interval else NONE,
                _before_and_after(row, "J", 4),
            )
        )
    table = Table(
        "scores-table",
        "Scores of trials left out, with the coefficients before tuning → as tuned to the others",
        ("manoeuvre", "runs", "off track [m]", "off heading [deg]", "L_MSE", "removed", "95 % interval", "J"),
        tuple(lines),
        range(1, 8),
        (
            ("L_MSE [–]", measures.L_MSE),
            (
                "removed",
                (
                    "share of L_MSE that tuning takes away; its interval by how much the runs differ: as many drawn "
                    "from them at random, some twice and some never, many times over"
                ),
            ),
            ("J [–]", measures.J),
            *codes.of_rows(record.results),
        ),
    )
    drawn = _runs(record.results)
    return Section("scores", "How far off, by run and by kind of manoeuvre", (*((drawn,) if drawn else ()), table))


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

    said = share(held, counted=True)
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


def _read(folder: Path, data: Mapping[str, Any]) -> LeaveOutRecord:
    inputs = inputs_of(folder, data)
    kept = motions_in(folder, inputs) if data.get("trial_results") else {}
    return LeaveOutRecord(data, kept, inputs)


KIND = Kind("leave-out", ("profile", "trials", "scores", "parts"), _read, build)
