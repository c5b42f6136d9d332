"""The report of a plan: which trial to sail next."""

from __future__ import annotations

import shlex
import textwrap
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..advice import Advice, again
from ..blocks import Card, Commands, Page, Prose, Section, Table, cells
from ..common import made_rows, picture
from ..figures.plot import Axis, Bar, Figure, Look, Mark, Panel, Rule
from ..figures.svg import LETTERS
from ..load import Kind
from ..tables import pairs
from ..wording import NONE, clean, count, fixed, percent, sentence, share, shown

_BARS = 20
"""Trials drawn, those that tell most."""

_MEANING = (
    "Nothing is sailed: each trial is simulated, and its information, believed as far as that of the trials the "
    "particles learnt from, is added to what they know. What is left of the band is its width in the mean of what may "
    "come out."
)


@dataclass(frozen=True)
class PlanRecord:
    """A plan as its folder holds it: plan.json."""

    folder: Path
    data: Mapping[str, Any]

    @property
    def trials(self) -> list[dict[str, Any]]:
        """Trials, the one that tells most first."""
        return list(self.data["trials"])

    @property
    def unit(self) -> str:
        """Of the question, with a space before."""
        unit = clean(self.data["question"]["unit"])
        return "" if unit == "-" else f" {unit}"


def verdict(data: Mapping[str, Any]) -> str:
    """Which trial to sail next, and what it would tell."""
    asked, best = data["question"], data["trials"][0]
    of, order = clean(asked["words"]), clean(asked["order"])
    if not best["shrinks"] > 0.0:
        return f"No trial looked at tells anything of the {of}, {order}."
    narrower = percent(100.0 * best["shrinks"]).lstrip("+")
    return f"To sail next: {clean(best['trial'])}. It would narrow the band of the {of} ({order}) by {narrower}."


def build(record: PlanRecord) -> Page:
    """Everything the report of a plan says."""
    data, asked, best = record.data, record.data["question"], record.trials[0]
    level = shown(data["options"]["level"], 3)
    words = f"{clean(asked['words'])}, {clean(asked['order'])}"
    half = f"± {shown(asked['half_width'], 2)}{record.unit}"
    cards = (
        Card(words.capitalize(), f"{shown(asked['mean'], 3)} {half}", note=f"half the band of {level} %, as it is now"),
        Card(
            "After the best trial",
            f"± {shown(best['half_width_after'], 2)}{record.unit}",
            percent(-100.0 * best["shrinks"]),
            clean(best["trial"]),
            "good" if best["shrinks"] > 0.0 else "",
        ),
        Card("It takes", f"{fixed(best['duration_s'], 0)} s", note="from the approach to its end"),
        Card(
            "Looked at",
            count(len(record.trials), "trial"),
            note=f"{len(data['left_out'])} could not be judged" if data["left_out"] else "",
        ),
    )
    sections = [
        Section("trials", "Which trial tells most", (_picture(record, level), _table(record), Prose((_MEANING,)))),
        *(
            [Section("lost", "Left out", (Prose(tuple(map(sentence, data["left_out"])), listed=True),))]
            if data["left_out"]
            else []
        ),
        Section("next", "What to do next", (Commands(_advice(data)),)),
        _made(data),
    ]
    return Page(
        title=f"{clean(data['ship'])}: the trial to sail next",
        eyebrow=f"{clean(data['ship'])} · {clean(asked['text'])}",
        verdict=verdict(data),
        warnings=tuple(sentence(note) for note in data["notes"]),
        cards=cards,
        sections=tuple(sections),
    )


def _picture(record: PlanRecord, level: str) -> Any:
    rows = record.trials[:_BARS]
    now = float(record.data["question"]["half_width"])
    marks: list[Mark] = [
        Rule(now, Look("flag", 1.4, "dash")),
        *(
            Bar((0.0, float(row["half_width_after"])), (k - 0.31, k + 0.31), "after" if k == 0 else "muted", 0.85)
            for k, row in enumerate(rows)
        ),
    ]
    ticks = tuple((float(k), beside_its_bar(row)) for k, row in enumerate(rows))
    y = Axis(low=len(rows) - 0.4, high=-0.6, ticks=ticks, grid=False)
    unit = record.unit.strip() or "–"
    x = Axis(f"half the band of {level} % after it [{unit}]", low=0.0, high=1.05 * now)
    lines = max(words.count("\n") + 1 for _, words in ticks)
    panel = Panel(tuple(marks), x, y, shape=-((11.0 + 14.0 * lines) * len(rows) + 60.0))
    drawn = Figure("trials", "Half the band after each trial", (panel,), (("now", Look("flag", 1.4, "dash")),))
    more = f" Drawn are {len(rows)} of {len(record.trials)}." if len(rows) < len(record.trials) else ""
    return picture(drawn, "Trials", f"Half the band that each trial would leave, the shortest first.{more}")


def beside_its_bar(row: Mapping[str, Any]) -> str:
    """A trial in the room of an axis, also of a narrow one."""
    return "\n".join(textwrap.wrap(clean(row["trial"]).replace(" deg", "°"), LETTERS))


def _table(record: PlanRecord) -> Table:
    rows = tuple(
        cells(
            clean(row["trial"]),
            f"± {shown(row['half_width_after'], 2)}{record.unit}",
            percent(100.0 * row["shrinks"]).lstrip("+"),
            f"{fixed(row['duration_s'], 0)} s",
        )
        for row in record.trials
    )
    heads = ("trial", "half the band after it", "shrinks by", "takes")
    return Table("trials-table", "Trials, the one that tells most first", heads, rows, (1, 2, 3), cards=True)


def _advice(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from a plan."""
    model = shlex.quote(clean(data["model"]))
    kind, _, angles = clean(data["question"]["asked"]).partition(" ")
    flag = f"--{kind} {angles}".strip()
    return (
        ("See what the particles say of the question before anything is sailed", f"mmgtune predict {model} {flag}"),
        ("Repeat this plan", again(data["provenance"]["command"])),
    )


def _made(data: Mapping[str, Any]) -> Section:
    items = [
        ("particles", clean(data["model"])),
        ("profile's hash (SHA-256)", clean(data["sha256"] or NONE)),
        ("particles that answer", f"{data['question']['particles']}"),
        ("share told by straight lines", share(data["linear_share"])),
        *made_rows(data),
    ]
    return Section("made", "How it was made", (pairs("made-table", "What it was made from", ("what", "value"), items),))


KIND = Kind("plan", ("question", "trials", "left_out", "linear_share", "provenance", "model"), PlanRecord, build)
