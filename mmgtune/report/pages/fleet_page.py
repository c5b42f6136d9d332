"""The report of a fleet: ships over time, what changed, and who would gain most by a recalibration."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from ...options import in_flags
from .. import advice
from ..blocks import Block, Card, Cell, Commands, Fold, Nothing, Page, Prose, Section, Table, cells
from ..common import picture
from ..figures import fleet_figures
from ..figures.fleet_figures import ROWS
from ..load import Kind
from ..tables import pairs
from ..wording import MINUS, NONE, clean, count, listing, number, share, shown

COLUMNS = 36
"""Dates in a table at most: the latest."""

SHIPS = 500
"""Ships in a table at most: those with most to look at."""

PANELS = 12
"""Quantities that are drawn at most."""

_RUN = re.compile(r"runs/[A-Za-z0-9][\w.-]*/[0-9-]+/[A-Za-z0-9][\w.-]*")

_TONES = {"good": "", "no": "note", "failed": "bad"}


def build(data: Mapping[str, Any]) -> Page:
    """Everything the report of a fleet says."""
    sections = [
        _ships(data),
        _changes(data),
        _trends(data),
        _causes(data),
        _gains(data),
        _classes(data),
        _failures(data),
        _next(data),
        _rules(data),
        _made(data),
    ]
    jobs = data["jobs"]
    generated = "Some of the trials of this fleet are generated, not measured."
    return Page(
        title="Fleet",
        eyebrow=f"{count(len(data['ships']), 'ship')} · {_span(data['dates'])} · {count(jobs['total'], 'job')}",
        verdict=_verdict(data),
        banners=(generated,) if data.get("generated") else (),
        warnings=_warnings(jobs),
        cards=_cards(data),
        sections=tuple(section for section in sections if section is not None),
    )


def _span(dates: Sequence[Any]) -> str:
    if not dates:
        return "no dates"
    return clean(dates[0]) if len(dates) == 1 else f"{clean(dates[0])} to {clean(dates[-1])}, {len(dates)} dates"


def _verdict(data: Mapping[str, Any]) -> str:
    changed = list(dict.fromkeys(clean(one["ship"]) for one in data["changes"]))
    named = list(dict.fromkeys(clean(one["ship"]) for one in data["cells"] if one["causes"]))
    parts = []
    if changed:
        verb = "changed" if len(changed) > 1 else "has changed"
        parts.append(f"{len(changed)} of {count(len(data['ships']), 'ship')} {verb}: {listing(changed, 8)}")
    if named:
        parts.append(f"causes are named for {listing(named, 8)}")
    best = next((one for one in data["ranking"] if one["gain"] > 0.0), None)
    if best is not None:
        was, now = shown(best["off_track"], 3), shown(best["tuned_track"], 3)
        parts.append(f"{clean(best['ship'])} would gain most by a recalibration, {was} to {now} m off track")
    if not parts:
        return f"No change shows in {count(len(data['ships']), 'ship')}."
    return "; ".join(parts) + "."


def _warnings(jobs: Mapping[str, Any]) -> tuple[str, ...]:
    said = []
    if jobs["failed"]:
        said.append(f"{count(jobs['failed'], 'job')} could not run; their errors stand below.")
    if jobs["missing"]:
        verb = "is" if jobs["missing"] == 1 else "are"
        said.append(f"{count(jobs['missing'], 'job')} of the table {verb} not run yet.")
    if others := jobs.get("others"):
        verb = "is" if others == 1 else "are"
        said.append(f"{count(others, 'result')} {verb} of jobs that the table does not have, or has with other data.")
    return tuple(said)


def _cards(data: Mapping[str, Any]) -> tuple[Card, ...]:
    jobs = data["jobs"]
    latest: dict[str, float] = {}
    for one in data["cells"]:
        if (error := number(one["off_track"])) is not None:
            latest[one["ship"]] = error
    made = []
    if latest:
        ordered = sorted(latest.values())
        worst = max(latest, key=lambda ship: latest[ship])
        middle = f"{shown(ordered[len(ordered) // 2], 3)} m"
        note = f"median of ships at their latest date; most: {clean(worst)}, {shown(latest[worst], 3)}\u00a0m"
        made.append(Card("Off track now", middle, note=note))
    changes = len(data["changes"])
    made.append(Card("Changes", str(changes) if changes else "none", note="steps in what was followed over time"))
    failed = jobs["failed"]
    note = f"of {jobs['total']}" + (f"; {jobs['missing']} not run yet" if jobs["missing"] else "")
    made.append(Card("Jobs that failed", str(failed), note=note, tone="bad" if failed else ""))
    return tuple(made)


def _names(data: Mapping[str, Any]) -> list[str]:
    """Jobs by name, those with errors in metres first."""
    names = list(dict.fromkeys(one["name"] for one in data["cells"]))
    metres = {one["name"] for one in data["cells"] if number(one["off_track"]) is not None}
    return sorted(names, key=lambda name: name not in metres)


def _ships(data: Mapping[str, Any]) -> Section:
    names = _names(data)
    marks = {(one["ship"], one["month"]) for one in data["changes"]}
    blocks: list[Block] = []
    for place, name in enumerate(names):
        rows = [one for one in data["cells"] if one["name"] == name]
        ordered = _ordered(data, rows)
        dates = sorted({one["date"] for one in rows})[-COLUMNS:]
        if place == 0:
            blocks.append(_picture(rows, ordered, dates, marks))
        table = _table(name, rows, ordered[:SHIPS], dates, place)
        blocks.append(table if place == 0 else Fold(f"Ships and dates: {clean(name)}", (table,)))
    return Section("ships", "Ships over time", tuple(blocks))


def _ordered(data: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Ships by name; of more than a page holds, those with changes, failures and large errors first."""
    ships = sorted({one["ship"] for one in rows})
    if len(ships) <= ROWS:
        return ships
    changed = {one["ship"] for one in data["changes"]}
    failed = {one["ship"] for one in data["failures"]}
    worst = {one["ship"]: number(one["off_track"]) or 0.0 for one in rows}
    return sorted(ships, key=lambda ship: (ship not in changed, ship not in failed, -worst[ship], ship))


def _picture(
    rows: Sequence[Mapping[str, Any]],
    ships: Sequence[str],
    dates: Sequence[str],
    marks: set[tuple[str, str]],
) -> Block:
    errors = {(one["ship"], one["date"]): number(one["off_track"]) for one in rows}
    if not any(value is not None for value in errors.values()):
        return Nothing(
            "No job says how far off the models are in metres.", "Fits, sweeps, diagnoses and validations do."
        )
    failed = [(one["ship"], one["date"]) for one in rows if one["answer"] == "failed"]
    drawn = fleet_figures.ships_over_time(ships[:ROWS], dates, errors, failed, sorted(marks))
    more = f" The first {ROWS} of {len(ships)} ships." if len(ships) > ROWS else ""
    caption = (
        "How far each ship's model as given is off the measured tracks (root mean square); the denser, the further. "
        f"A diamond stands where something changed.{more}"
    )
    return picture(drawn, "Ships over time", caption)


def _table(
    name: str, rows: Sequence[Mapping[str, Any]], ships: Sequence[str], dates: Sequence[str], place: int
) -> Table:
    by = {(one["ship"], one["date"]): one for one in rows}
    made = tuple(cells(clean(ship), *(_cell(by.get((ship, date))) for date in dates)) for ship in ships)
    caption = f"{clean(name)}: metres off track, or what was found"
    caption += "; each opens the report of its job" if any(map(_page_of, rows)) else ""
    lacking = any(one["run"] and not _page_of(one) for one in rows)
    caption += "; mmgtune report FOLDER makes the report of a job that has none yet" if lacking else ""
    return Table(f"ships-{place}-table", caption, ("ship", *map(clean, dates)), made, range(1, 1 + len(dates)))


def _cell(one: Mapping[str, Any] | None) -> Cell:
    if one is None:
        return Cell(NONE)
    error = number(one["off_track"])
    said = [shown(error, 3)] if error is not None else []
    said += [clean(tag) for tag in one["causes"]]
    if one["answer"] == "failed":
        said = ["failed"]
    return Cell(", ".join(said) or clean(one["answer"]), _TONES.get(one["answer"], ""), _page_of(one))


def _page_of(one: Mapping[str, Any]) -> str:
    """The report of a cell's job, "" where none was rendered; older records do not say, and all have one."""
    return link_of(one["run"]) if one.get("report", True) else ""


def _pages(data: Mapping[str, Any]) -> dict[str, str]:
    """The reports of jobs by run folder, of those that have one."""
    return {one["run"]: page for one in data["cells"] if (page := _page_of(one))}


def link_of(run: Any) -> str:
    """The report of a job, "" for what is no run folder of a fleet."""
    return f"{run}/report.html" if isinstance(run, str) and _RUN.fullmatch(run) and ".." not in run else ""


def _changes(data: Mapping[str, Any]) -> Section:
    changes = data["changes"]
    looked = sum(one["course"] is not None for one in data["series"])
    if not changes:
        fewest = data["rules"]["fewest_dates"]
        more = f"{count(looked, 'series', 'series')} of {fewest} dates or more were looked at."
        return Section("changes", "What changed, and when", (Nothing("No change shows.", more),))
    runs = {(one["ship"], one["date"], one["name"]): one["run"] for one in data["cells"]}
    pages = _pages(data)
    rows = tuple(
        cells(
            Cell(clean(one["ship"]), link=pages.get(runs.get((one["ship"], one["month"], one["job"]), ""), "")),
            clean(one["month"]),
            f"{clean(one['after'])} to {clean(one['by'])}",
            clean(one["words"]),
            _signed(one["size"], one["unit"]),
            f"{shown(one['error'], 2)}",
            shown(one["p"], 2),
        )
        for one in changes[:SHIPS]
    )
    about = (
        ("between", "the last date before and the first date behind it, with 95 % probability"),
        ("±", "half the 95 % interval of the size"),
        ("by chance", "probability of such a change anywhere in the series where there is none"),
    )
    head = ("ship", "first seen", "between", "what", "change", "±", "by chance")
    table = Table("changes-table", "Changes in their order in time", head, rows, (4, 5, 6), about, cards=True)
    places = {(one["ship"], one["job"], one["name"]) for one in changes}
    drawn = [one for one in data["series"] if (one["ship"], one["job"], one["name"]) in places and one["course"]]
    shown_ones = drawn[:PANELS]
    more = f" The first {PANELS} of {len(drawn)}." if len(drawn) > PANELS else ""
    caption = f"Each quantity that changed, with the line and steps that describe it best.{more}"
    figure = picture(fleet_figures.courses(shown_ones), "What changed", caption)
    return Section("changes", "What changed, and when", (figure, table))


def _signed(value: Any, unit: Any) -> str:
    size = number(value)
    if size is None:
        return NONE
    sign = "+" if size > 0.0 else MINUS
    return f"{sign}{shown(abs(size), 3)}{' ' + clean(unit) if unit else ''}"


def _trends(data: Mapping[str, Any]) -> Section | None:
    if not data["trends"]:
        return None
    rows = tuple(
        cells(clean(one["ship"]), clean(one["words"]), _signed(one["slope"], one["unit"]), shown(one["error"], 2))
        for one in data["trends"][:SHIPS]
    )
    head = ("ship", "what", "a year", "±")
    table = Table("trends-table", "What grows or falls steadily, between steps", head, rows, (2, 3))
    return Section("trends", "What grows", (table,))


def _causes(data: Mapping[str, Any]) -> Section | None:
    found: Counter[str] = Counter()
    ships: dict[str, list[str]] = {}
    for one in data["cells"]:
        for tag in one["causes"]:
            found[tag] += 1
            ships.setdefault(tag, []).append(clean(one["ship"]))
    if not found:
        return None
    rows = tuple(
        cells(clean(tag), str(n), listing(list(dict.fromkeys(ships[tag])), 8)) for tag, n in found.most_common()
    )
    return Section(
        "causes",
        "Named causes",
        (Table("causes-table", "Causes that diagnoses named", ("cause", "dates", "ships"), rows, (1,)),),
    )


def _gains(data: Mapping[str, Any]) -> Section | None:
    ranking, pages = data["ranking"], _pages(data)
    if not ranking:
        return None
    rows = tuple(
        cells(
            Cell(clean(one["ship"]), link=pages.get(one["run"], "")),
            clean(one["date"]),
            shown(one["off_track"], 3),
            shown(one["tuned_track"], 3),
            shown(one["gain"], 3),
            share(one["gain"] / one["off_track"]) if number(one["off_track"]) else NONE,
        )
        for one in ranking[:SHIPS]
    )
    head = ("ship", "latest", "off track [m]", "when tuned [m]", "gain [m]", "share")
    about = (("when tuned [m]", "on trials that were not tuned on, where the job has such; else it flatters"),)
    table = Table("gains-table", "Ships by what their latest recalibration gains", head, rows, (2, 3, 4, 5), about)
    return Section("gains", "Who would gain by a recalibration", (table,))


def _classes(data: Mapping[str, Any]) -> Section | None:
    tables: list[Block] = []
    for place, one in enumerate(data["classes"]):
        rows = tuple(
            cells(
                clean(name),
                shown(row["before"], 4),
                shown(row["mean"], 4),
                shown(row["mean_error"], 2),
                shown(row["spread"], 2),
                shown(row["known"], 2),
            )
            for name, row in one["coefficients"].items()
        )
        head = ("coefficient", "before", "mean", "±", "spread", "known before to")
        title = f"Class {clean(one['name'])}: {count(one['ships'], 'ship')}"
        tables.append(Table(f"class-{place}-table", title, head, rows, (1, 2, 3, 4, 5), cards=True))
    said = (
        "Mean and spread of each coefficient among sister ships, one standard deviation.",
        "What was known before any trial is the scatter of its formula, or a quarter of its box.",
    )
    return Section("classes", "Sister ships", (Prose(said), *tables)) if tables else None


def _failures(data: Mapping[str, Any]) -> Section | None:
    if not data["failures"]:
        return None
    rows = tuple(
        cells(
            clean(one["ship"]), clean(one["date"]), clean(one["name"]), clean(problem["what"]), clean(problem["where"]),
            in_flags(clean(problem["why"])), in_flags(clean(problem["fix"])),
        )
        for one in data["failures"][:SHIPS]
        for problem in one["problems"]
    )  # fmt: skip
    head = ("ship", "date", "job", "what", "where", "why", "fix")
    return Section(
        "failures", "Jobs that could not run", (Table("failures-table", "Errors of jobs", head, rows, cards=True),)
    )


def _next(data: Mapping[str, Any]) -> Section:
    return Section("next", "What to do next", (Commands(advice.after_fleet(data)),))


def _rules(data: Mapping[str, Any]) -> Section:
    rules = data["rules"]
    none = share(1.0 - rules["level"])
    said = (
        "A change is a step in a straight line over time, with one slope all along.",
        "Errors of dates count as normal and independent of each other.",
        f"Chance is counted over all places and series: in {none} of fleets without any change none is reported.",
        "What changed on one date alone, and came back on the next, does not count.",
        "That two quantities change together says when to look, not why: a diagnosis of that date says more.",
    )
    return Section("rules", "What is assumed", (Prose(said, listed=True),))


def _made(data: Mapping[str, Any]) -> Section:
    keys = (("command", "command"), ("made", "created"), ("mmgtune", "mmgtune"), ("table of jobs", "table"))
    items = [(name, clean(data[key])) for name, key in keys if data.get(key)]
    items.append(("time of all jobs", f"{shown(data['jobs']['seconds'], 3)} s"))
    return Section("made", "How it was made", (pairs("made-table", "What was run", ("what", "value"), items),))


KIND = Kind(
    "fleet",
    (
        "jobs",
        "ships",
        "dates",
        "cells",
        "failures",
        "rules",
        "series",
        "changes",
        "trends",
        "ranking",
        "classes",
        "out",
    ),
    lambda folder, data: data,
    build,
)
