"""The report of a check: whether a profile still reproduces its trials."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from ...metrics import METRICS
from ...run_files import CHECKED
from .. import advice, codes
from ..blocks import Block, Card, Cell, Commands, Fold, Nothing, Page, Prose, Section, Table, cells
from ..common import doubts, made_table, picture
from ..figures.plot import Axis, Bar, Color, Figure, Look, Mark, Panel, Rule
from ..load import Kind
from ..tables import tone
from ..wording import NONE, change, clean, coefficient_text, count, number, percent, sentence, share, shown

_WORDS = {
    "regressed": "worse", "ok": "as good", "improved": "better", "not comparable": "not comparable",
    "skipped": "not measured",
}  # fmt: skip
_SAID = {"pass": "Passed", "regressed": "Failed", "not comparable": "Not comparable"}
_TONES = {"regressed": "bad", "improved": "good", "not comparable": "note"}
_BARS = 14
_FAR = 4.0
"""Allowances at which a bar ends."""

_PASSES: tuple[Color, float] = ("good", 0.6)
_FAILS: tuple[Color, float] = ("flag", 0.85)

_LETTERS = 24
"""Letters of a line beside a bar, which a phone has room for."""


def build(data: Mapping[str, Any]) -> Page:
    """Everything the report of a check says."""
    sections = [
        _worst(data),
        _changed(data),
        _all(data),
        Section("next", "What to do next", (Commands(advice.after_check(data)),)) if data["next"] else None,
        _made(data),
    ]
    profile, trials = _file(data["profile"]), _file(data["trials"])
    compared = "its own limits" if data["baseline"] is None else _file(data["baseline"])
    problems = tuple(clean(one["what"]) for one in data["problems"])
    return Page(
        title=f"Check of {profile}",
        eyebrow=f"{profile} on {trials} against {compared}",
        verdict=_verdict(data),
        lead=_lead(data),
        warnings=(*problems, *(sentence(note) for note in data["notes"]), *doubts(data)),
        cards=_cards(data),
        sections=tuple(section for section in sections if section is not None),
    )


def _file(name: Any) -> str:
    """The name of a file without its folder."""
    return re.split(r"[\\/]", clean(name).rstrip("\\/"))[-1]


def _lead(data: Mapping[str, Any]) -> tuple[str, ...]:
    """What it is to pass: nothing is said of how good the model is."""
    if data["verdict"] not in ("pass", "regressed"):
        return ()
    limits = "within the limits that the profile sets itself"
    if data["baseline"] is not None:
        limits = "no worse than the committed baseline, but for its tolerances"
    return (f"To pass is to be {limits}; how well the model fits the trials is another question.",)


def _verdict(data: Mapping[str, Any]) -> str:
    """What came out, in words for what the line of a log begins with: that ends at two spaces."""
    said = "Could not run" if data["problems"] else _SAID[data["verdict"]]
    return f"{said}: {' '.join(clean(data['sentence']).partition('  ')[2].split())}"


def _cards(data: Mapping[str, Any]) -> tuple[Card, ...]:
    failed = [row for row in _ordered(data) if row["status"] == "regressed"]
    worst = next((row for row in failed if row["unit"]), failed[0] if failed else None)
    cards = []
    if worst is not None:
        unit = f" {clean(worst['unit'])}" if worst["unit"] else ""
        value = f"{shown(worst['baseline'], 3)} → {shown(worst['now'], 3)}{unit}"
        note = f"{_words(worst)} of {clean(worst['trial'])}; up to {shown(worst['allowed'], 3)}{unit} passes"
        cards.append(Card("Worst that has a unit", value, note=note, tone="bad"))
    else:
        cards += _means(data)
    counts = data["counts"]
    for status in ("regressed", "improved", "ok"):
        n = int(counts.get(status, 0))
        cards.append(Card(_WORDS[status].capitalize(), count(n, "metric"), tone=_TONES.get(status, "") if n else ""))
    return tuple(cards[:4])


def _means(data: Mapping[str, Any]) -> list[Card]:
    """Means over trials of the distance off track and the error of heading, where they are checked."""
    cards = []
    for metric, label, unit, digits in (
        ("MED", "Mean distance off track", " m", 3),
        ("rms_psi", "Off heading, rms", "°", 2),
    ):
        pairs = [(number(row["baseline"]), number(row["now"])) for row in data["items"] if row["metric"] == metric]
        known = [(a, b) for a, b in pairs if a is not None and b is not None]
        if known:
            before, after = (sum(pair[k] for pair in known) / len(known) for k in (0, 1))
            moved = change(before, after)
            value = f"{shown(before, digits)} → {shown(after, digits)}{unit}"
            note = f"mean of {count(len(known), 'trial')}"
            cards.append(Card(label, value, percent(moved), note, tone(moved, 1.0)))
    return cards


def _severity(row: Mapping[str, Any]) -> float:
    """Size over what passes, as the check itself has it: above 1 is a regression; infinite where it diverged."""
    now, allowed = number(row["now"]), number(row["allowed"])
    if now is None or not allowed:
        return float("inf") if row["status"] == "regressed" else 0.0
    return abs(now) / allowed


def _words(row: Mapping[str, Any]) -> str:
    """What people call a metric; older records may have one that is known no more."""
    known = METRICS.get(str(row["metric"]))
    if known is None:
        return clean(row["metric"])
    return "misfit J" if row["metric"] == "J" else known.words


def _ordered(data: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    rank = {"regressed": 0, "not comparable": 1, "improved": 2, "ok": 3}
    return sorted(data["items"], key=lambda row: (rank.get(row["status"], 4), -_severity(row)))


def _worst(data: Mapping[str, Any]) -> Section | None:
    rows = [row for row in _ordered(data) if row["status"] in ("regressed", "improved", "ok")]
    rows = sorted(rows, key=_severity, reverse=True)[:_BARS]
    if not rows:
        return Section("worst", "Metrics", (Nothing("Nothing could be compared."),))
    sizes = [100.0 * min(_severity(row), _FAR) for row in rows]
    limit = Look("ink", 1.4, "dash")
    marks: list[Mark] = [Rule(100.0, limit)]
    for k, (row, size) in enumerate(zip(rows, sizes, strict=True)):
        marks.append(Bar((0.0, size), (k - 0.3, k + 0.3), *(_FAILS if row["status"] == "regressed" else _PASSES)))
    names = [[clean(row["trial"]), *textwrap.wrap(_words(row), _LETTERS)] for row in rows]
    ticks = tuple((float(k), "\n".join(lines)) for k, lines in enumerate(names))
    x = Axis("share of what is allowed [%]", low=0.0, high=max(120.0, *sizes) + 5.0)
    y = Axis(low=len(rows) - 0.4, high=-0.6, ticks=ticks, grid=False)
    panel = Panel(tuple(marks), x, y, shape=-((14.0 * max(map(len, names)) + 8.0) * len(rows) + 50.0))
    failing = sum(row["status"] == "regressed" for row in rows)
    legend: list[tuple[str, Look | tuple[Color, float]]] = [("passes", _PASSES)]
    legend += [("fails", _FAILS)] if failing else []
    figure = Figure("metrics", "Size of each metric as a share of what is allowed", (panel,),
                    (*legend, ("as much as is allowed", limit)))  # fmt: skip
    caption = f"The {count(len(rows), 'metric')} nearest to failing"
    caption += (
        ", or beyond: bars that end left of the line pass." if failing else ": all pass, no bar crosses the line."
    )
    if any(_severity(row) > _FAR for row in rows):
        caption += f" Bars end at {_FAR:g} times what passes."
    title = "What changed" if failing else "Nearest to failing"
    told = codes.sentences(data.get("orders") or {})
    legend_of_trials = (Prose(told, listed=True),) if told else ()
    return Section("worst", title, (picture(figure, "Metrics", caption), *legend_of_trials))


def _changed(data: Mapping[str, Any]) -> Section | None:
    rows: Sequence[Mapping[str, Any]] = data["changed"]
    if not rows:
        return None
    lines = tuple(
        cells(
            clean(row["name"]),
            NONE if row.get("only") == "now" else coefficient_text(row["baseline"]),
            NONE if row.get("only") == "baseline" else coefficient_text(row["now"]),
            str(row["line"]) if row["line"] is not None else NONE,
            share(row["share"]),
        )
        for row in rows
    )
    heads = ("coefficient", "baseline", "now", "line of the profile", "undoes")
    about = (("undoes", "share of what J got worse by that this coefficient's old value alone takes back"),)
    table = Table("changed-table", "Coefficients that are not what they were", heads, lines, (1, 2, 3, 4), about)
    block: Block = table if len(lines) <= 24 else Fold(f"All {len(lines)} that changed", (table,))
    return Section("changed", "Changed coefficients", (block,))


def _all(data: Mapping[str, Any]) -> Section:
    lines = []
    for row in _ordered(data):
        unit = f" [{clean(row['unit'])}]" if row["unit"] else ""
        moved = number(row["change"])
        lines.append(
            cells(
                clean(row["trial"]),
                f"{_words(row)}{unit}",
                shown(row["baseline"]),
                shown(row["now"]),
                NONE if moved is None else percent(100.0 * moved),
                shown(row["allowed"]),
                Cell(_WORDS.get(row["status"], clean(row["status"])), _TONES.get(row["status"], "")),
                clean(row["reason"]),
            )
        )
    heads = ("trial", "metric", "baseline", "now", "change", "passes up to", "verdict", "why")
    table = Table("items-table", "All metrics, the worst first", heads, tuple(lines), range(2, 6))
    block: Block = table if len(lines) <= 24 else Fold(f"All {len(lines)} metrics", (table,))
    return Section("items", "All metrics", (block,) if lines else (Prose(("There are none.",)),))


def _made(data: Mapping[str, Any]) -> Section:
    items = [("profile", clean(data["profile"])), ("profile's hash (SHA-256)", clean(data["profile_sha256"])),
             ("baseline", clean(data["baseline"] or "none: limits of the trials alone")),
             ("simulated by", f"{clean(data['integrator'])}, {clean(data['backend'])}")]  # fmt: skip
    return Section("provenance", "Provenance", (made_table(data, items),))


KIND = Kind(
    "check",
    ("verdict", "sentence", "items", "changed", "counts", "next"),
    lambda _, data: data,
    build,
    record=CHECKED,
)
