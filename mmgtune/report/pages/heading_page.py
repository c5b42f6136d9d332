"""The report of a study of a heading controller's gains."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from ...heading_keeping import shares_of
from .. import advice
from ..blocks import Card, Commands, Page, Prose, Section, Table, cells
from ..common import options_fold, picture
from ..figures.plot import Axis, Bar, Dots, Figure, Look, Mark, Panel
from ..load import Kind
from ..tables import pairs
from ..wording import NONE, clean, count, fixed, share, shown

_WORDS = {"single": "first member", "mean": "mean of members", "worst": "worst member"}
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
    "Scores are integrals of the absolute errors of heading and of yaw rate (Wakita, Akimoto and Maki, eq. 33), lower "
    "is better; a gain of 60 orders 60 deg of rudder for 1 rad of error, or for 1 rad/s."
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
        "Scores by gain [rad s], colours by ratio; crosses mark gains at which a simulator promises more than is true. "
        "Of single members the first is drawn."
    )
    shares = _shares(data["models"])
    return Page(
        title="Heading keeping",
        eyebrow=f"{n} × {n} gains · true system {clean(data['truth']['name'])}",
        verdict=verdict(record),
        cards=_cards(data["models"]),
        sections=(
            Section(
                "maps", "Scores of the gains", (picture(_figure(record), "Gains", caption), Prose((_PROMISE, _SCORES)))
            ),
            Section("shares", "How often more is promised than is true", (shares,)),
            Section("next", "What to do next", (Commands(advice.after_heading_study(data)),)),
            _made(data),
        ),
    )


def verdict(record: HeadingRecord) -> str:
    """What the gains that each simulator takes for best are worth, its members read by the worst of them."""
    gains, truth = record.data["gains"], record.maps[0][1]
    said = []
    for model in record.data["models"]:
        view = list(model["views"])[-1]
        rows = [[math.inf if v is None else v for v in row] for row in model["views"][view]["scores"]]
        p, d = _least(rows)
        words = clean(model["name"]) + (f" ({_WORDS[view]})" if model["members"] > 1 else "")
        promised, true = (shown(of[p][d], 3) if math.isfinite(of[p][d]) else "no score" for of in (rows, truth))
        said.append(
            f"{words} takes K_P {shown(gains[p], 3)}, K_D {shown(gains[d], 3)} for best and promises {promised} rad s; "
            f"the true system gives {true}"
        )
    p, d = _least(truth)
    best = f"Its best is {shown(truth[p][d], 3)} rad s, at K_P {shown(gains[p], 3)}, K_D {shown(gains[d], 3)}"
    return f"{'; '.join(said)}. {best}." if math.isfinite(truth[p][d]) else f"{'; '.join(said)}."


def _least(rows: Sequence[Sequence[float]]) -> tuple[int, int]:
    """Place of the least score."""
    _, p, d = min((value, p, d) for p, row in enumerate(rows) for d, value in enumerate(row))
    return p, d


def _cards(models: Sequence[Mapping[str, Any]]) -> tuple[Card, ...]:
    return tuple(
        Card(f"Overrated, {words}", share(part, counted=True), note=clean(model["name"]))
        for model in models[:2]
        for words, part, _ in dict.fromkeys((shares_of(model)[0], shares_of(model)[-1]))
    )


def _shares(models: Sequence[Mapping[str, Any]]) -> Table:
    rows = [
        cells(clean(model["name"]), count(model["members"], "member"), words, fixed(100 * a, 1), fixed(100 * b, 1))
        for model in models
        for words, a, b in shares_of(model)
    ]
    headings = ("simulator", "members", "read by", "promises more [% of gains]", "clearly more [% of gains]")
    return Table("shares-table", "Share of the gains", headings, tuple(rows), numeric=(3, 4), cards=True)


def _figure(record: HeadingRecord) -> Figure:
    maps, gains = record.maps, record.data["gains"]
    finite = [v for _, rows in maps for row in rows for v in row if math.isfinite(v)]
    low, high = (min(finite), max(finite)) if finite else (0.0, 1.0)
    half = 0.5 * gains[0]
    edges = [gains[0] - half, *(0.5 * (a + b) for a, b in pairwise(gains)), gains[-1] + half]
    panels = []
    for title, rows in maps:
        marks: list[Mark] = [bar for k, row in enumerate(rows) for bar in _row(row, edges, k, low, high)]
        over: dict[str, list[tuple[float, float]]] = {"#111111": [], "#ffffff": []}
        for p, own, true in zip(gains, rows, maps[0][1], strict=True):
            for d, a, b in zip(gains, own, true, strict=True):
                if a < b:
                    over["#111111" if _shade(a, low, high) < len(_SHADES) // 2 else "#ffffff"].append((d, p))
        for color, places in over.items():
            if places:
                look = Look(color, marker="x", size=4.0)  # type: ignore[arg-type]
                marks.append(Dots([d for d, _ in places], [p for _, p in places], look))
        x, y = Axis("K_D [deg s/rad]", edges[0], edges[-1], grid=False), Axis("K_P [deg/rad]", edges[0], edges[-1])
        panels.append(Panel(tuple(marks), x, y, title, 0.9))
    legend: list[tuple[str, Look | tuple[str, float]]] = [
        (f"{shown(_score(part, low, high), 3)} rad s", (_SHADES[round(part * (len(_SHADES) - 1))], 1.0))
        for part in (0.0, 0.25, 0.5, 0.75, 1.0)
    ]
    legend.append(("promises more than is true", Look("ink", 0.0, marker="x", size=6.0)))
    alt = "Scores of gains in the true system and in simulators"
    return Figure("gains", alt, tuple(panels), tuple(legend))  # type: ignore[arg-type]


def _row(row: Sequence[float], edges: Sequence[float], k: int, low: float, high: float) -> list[Bar]:
    """A row of a map as bars, one for neighbours of one shade.

    Each reaches a little below the row above, which is drawn later: where they only touch, the paper shines through.
    """
    found: list[Bar] = []
    top = edges[k + 1] if k + 2 == len(edges) else edges[k + 1] + 0.05 * (edges[k + 2] - edges[k + 1])
    for j, value in enumerate(row):
        if not math.isfinite(value):
            continue
        shade = _SHADES[_shade(value, low, high)]
        last = found[-1] if found else None
        if last is not None and last.color == shade and last.x[1] == edges[j]:
            found[-1] = Bar((last.x[0], edges[j + 1]), last.y, shade)
        else:
            found.append(Bar((edges[j], edges[j + 1]), (edges[k], top), shade))
    return found


def _shade(value: float, low: float, high: float) -> int:
    """Place of a score in the map of colours; by ratios, since the worst members lie far above all that is true."""
    part = math.log(value / low) / math.log(high / low) if 0.0 < low < high else (value - low) / ((high - low) or 1.0)
    return round(part * (len(_SHADES) - 1))


def _score(part: float, low: float, high: float) -> float:
    """Score at a share of the map of colours, the inverse of ``_shade``."""
    return low * (high / low) ** part if 0.0 < low < high else low + part * (high - low)


def _made(data: Mapping[str, Any]) -> Section:
    items = [
        ("simulators", "; ".join(f"{clean(one['name'])} ({clean(one['method'])})" for one in data["models"])),
        ("command", clean(data["command"] or NONE)),
        ("time", f"{shown(data['wall_s'], 3)} s"),
    ]
    return Section(
        "made",
        "How it was made",
        (
            pairs("made-table", "What was run", ("what", "value"), items),
            *options_fold(data["options"]),
        ),
    )


KIND = Kind("heading-keeping", ("truth", "gains", "models", "options", "wall_s"), HeadingRecord, build)
