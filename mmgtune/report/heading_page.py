"""The report of a study of a heading controller's gains."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from ..heading_keeping import shares_of
from .blocks import Card, Fold, Page, Prose, Section, Table, cells
from .common import picture
from .load import Kind
from .plot import Axis, Bar, Dots, Figure, Look, Mark, Panel
from .tables import pairs
from .wording import NONE, clean, count, shown

_WORDS = {"single": "one member", "mean": "mean of members", "worst": "worst member"}
_SHADES = (
    "#fee838", "#eed649", "#dbc75a", "#c8b866", "#b7a96e", "#a59c74", "#948e77", "#848279", "#757575", "#666970",
    "#575d6d", "#47516c", "#35456c", "#1e3a6f", "#002e6c", "#00224e",
)  # fmt: skip
"""The map of colours cividis, which those who see few colours read too; low scores are light."""
_PROMISE = (
    "A simulator promises more than is true where its score is below that of the true system: a controller chosen "
    "there disappoints at sea. Clearly means by more than 5 %."
)
_SCORES = (
    "Scores are integrals of the absolute errors of heading and of yaw rate (eq. 33), lower is better; a gain of 60 "
    "orders 60 deg of rudder for 1 rad of error, or for 1 rad/s."
)


@dataclass(frozen=True)
class HeadingRecord:
    """A study as its folder holds it: heading_keeping.json."""

    folder: Path
    data: Mapping[str, Any]

    @property
    def maps(self) -> list[tuple[str, list[list[float]]]]:
        """Titles and scores of all maps, the truth first; infinite where a run diverged."""
        found = [(f"{clean(self.data['truth']['name'])}: true", self.data["truth"]["scores"])]
        for model in self.data["models"]:
            for view, of in model["views"].items():
                words = _WORDS[view] if model["members"] > 1 else "as it is"
                found.append((f"{clean(model['name'])}: {words}", of["scores"]))
        return [(title, [[math.inf if v is None else v for v in row] for row in rows]) for title, rows in found]


def build(record: HeadingRecord) -> Page:
    """Everything the report of a study of gains says."""
    data = record.data
    n = len(data["gains"])
    caption = (
        "Scores by gain [rad s], on one scale; crosses mark gains at which a simulator promises more than is true."
    )
    shares = _shares(data["models"])
    return Page(
        title="Heading keeping",
        eyebrow=f"{n} × {n} gains · true system {clean(data['truth']['name'])}",
        verdict=_verdict(data["models"]),
        cards=_cards(data["models"]),
        sections=(
            Section(
                "maps", "Scores of the gains", (picture(_figure(record), "Gains", caption), Prose((_PROMISE, _SCORES)))
            ),
            Section("shares", "How often more is promised than is true", (shares,)),
            _made(data),
        ),
    )


def _verdict(models: Sequence[Mapping[str, Any]]) -> str:
    said = []
    for model in models:
        rows = [f"{words} {shown(100 * share, 2)} %" for words, share, _ in shares_of(model)]
        said.append(f"{clean(model['name'])} promises more than is true at: {', '.join(rows)} of the gains")
    return "; ".join(said) + "."


def _cards(models: Sequence[Mapping[str, Any]]) -> tuple[Card, ...]:
    return tuple(
        Card(f"Overrated, {words}", f"{shown(100 * share, 2)} %", note=clean(model["name"]))
        for model in models[:2]
        for words, share, _ in shares_of(model)
    )


def _shares(models: Sequence[Mapping[str, Any]]) -> Table:
    rows = [
        cells(clean(model["name"]), count(model["members"], "member"), words, shown(100 * a, 3), shown(100 * b, 3))
        for model in models
        for words, a, b in shares_of(model)
    ]
    headings = ("simulator", "members", "read by", "promises more [% of gains]", "clearly more [% of gains]")
    return Table("shares-table", "Share of the gains", headings, tuple(rows), numeric=(3, 4))


def _figure(record: HeadingRecord) -> Figure:
    maps, gains = record.maps, record.data["gains"]
    finite = [v for _, rows in maps for row in rows for v in row if math.isfinite(v)]
    low, high = (min(finite), max(finite)) if finite else (0.0, 1.0)
    half = 0.5 * gains[0]
    edges = [gains[0] - half, *(0.5 * (a + b) for a, b in pairwise(gains)), gains[-1] + half]
    panels = []
    for title, rows in maps:
        marks: list[Mark] = [bar for k, row in enumerate(rows) for bar in _row(row, edges, k, low, high)]
        over = [
            (d, p)
            for p, own, true in zip(gains, rows, maps[0][1], strict=True)
            for d, a, b in zip(gains, own, true, strict=True)
            if a < b
        ]
        if over:
            marks.append(Dots([d for d, _ in over], [p for _, p in over], Look("flag", marker="x", size=4.0)))
        x, y = Axis("K_D [deg s/rad]", edges[0], edges[-1], grid=False), Axis("K_P [deg/rad]", edges[0], edges[-1])
        panels.append(Panel(tuple(marks), x, y, title, 0.9))
    legend: list[tuple[str, Look | tuple[str, float]]] = [
        (f"{shown(low + share * (high - low), 3)} rad s", (_SHADES[round(share * (len(_SHADES) - 1))], 1.0))
        for share in (0.0, 0.25, 0.5, 0.75, 1.0)
    ]
    legend.append(("promises more than is true", Look("flag", 0.0, marker="x", size=6.0)))
    alt = "Scores of gains in the true system and in simulators"
    return Figure("gains", alt, tuple(panels), tuple(legend))  # type: ignore[arg-type]


def _row(row: Sequence[float], edges: Sequence[float], k: int, low: float, high: float) -> list[Bar]:
    """A row of a map as bars, one for neighbours of one shade."""
    found: list[Bar] = []
    for j, value in enumerate(row):
        if not math.isfinite(value):
            continue
        shade = _SHADES[round((value - low) / ((high - low) or 1.0) * (len(_SHADES) - 1))]
        last = found[-1] if found else None
        if last is not None and last.color == shade and last.x[1] == edges[j]:
            found[-1] = Bar((last.x[0], edges[j + 1]), last.y, shade)
        else:
            found.append(Bar((edges[j], edges[j + 1]), (edges[k], edges[k + 1]), shade))
    return found


def _made(data: Mapping[str, Any]) -> Section:
    items = [
        ("simulators", "; ".join(f"{clean(one['name'])} ({clean(one['method'])})" for one in data["models"])),
        ("command", clean(data["command"] or NONE)),
        ("time", f"{shown(data['wall_s'], 3)} s"),
    ]
    chosen = [(clean(name), clean(value)) for name, value in data["options"].items()]
    return Section(
        "made",
        "How it was made",
        (
            pairs("made-table", "What was run", ("what", "value"), items),
            Fold("Options", (pairs("options-table", "Options", ("option", "value"), chosen),)),
        ),
    )


KIND = Kind("heading-keeping", ("truth", "gains", "models", "options", "wall_s"), HeadingRecord, build)
