"""The report of a study of a heading controller's gains."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..heading_keeping import shares_of
from .common import picture
from .drawing import FLAG, Drawn, grid_of
from .load import Kind
from .page import Page, Prose, Section, Table, Tile, cells
from .tables import pairs
from .wording import NONE, clean, count, shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WORDS = {"single": "one member", "mean": "mean of members", "worst": "worst member"}
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
        found = [(f"{clean(self.data['truth']['name'])}\ntrue", self.data["truth"]["scores"])]
        for model in self.data["models"]:
            for view, of in model["views"].items():
                words = _WORDS[view] if model["members"] > 1 else "as it is"
                found.append((f"{clean(model['name'])}\n{words}", of["scores"]))
        return [(title, [[math.inf if v is None else v for v in row] for row in rows]) for title, rows in found]


def build(record: HeadingRecord) -> Page:
    """Everything the report of a study of gains says."""
    data = record.data
    n = len(data["gains"])
    drawn = Drawn("gains", "Scores of gains in the true system and in simulators", lambda: _draw(record))
    caption = (
        "Scores by gain [rad s], on one scale; crosses mark gains at which a simulator promises more than is true."
    )
    shares = _shares(data["models"])
    return Page(
        title="Heading keeping",
        eyebrow=f"{n} × {n} gains · true system {clean(data['truth']['name'])}",
        verdict=_verdict(data["models"]),
        tiles=_tiles(data["models"]),
        sections=(
            Section("maps", "Scores of the gains", (picture(drawn, "Gains", caption), Prose((_PROMISE, _SCORES)))),
            Section("shares", "How often more is promised than is true", (shares,)),
            _made(data),
        ),
        figures={"gains": drawn},
    )


def _verdict(models: Sequence[Mapping[str, Any]]) -> str:
    said = []
    for model in models:
        rows = [f"{words} {shown(100 * share, 2)} %" for words, share, _ in shares_of(model)]
        said.append(f"{clean(model['name'])} promises more than is true at: {', '.join(rows)} of the gains")
    return "; ".join(said) + "."


def _tiles(models: Sequence[Mapping[str, Any]]) -> tuple[Tile, ...]:
    return tuple(
        Tile(f"Overrated, {words}", f"{shown(100 * share, 2)} %", note=clean(model["name"]))
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


def _draw(record: HeadingRecord) -> Figure:
    maps, gains = record.maps, record.data["gains"]
    finite = [v for _, rows in maps for row in rows for v in row if math.isfinite(v)]
    low, high = (min(finite), max(finite)) if finite else (0.0, 1.0)
    half = 0.5 * gains[0]
    edges = [gains[0] - half, *(0.5 * (a + b) for a, b in pairwise(gains)), gains[-1] + half]
    figure, axes = grid_of(len(maps), (2.7, 2.7))
    mesh = None
    for ax, (title, rows) in zip(axes, maps, strict=True):
        mesh = ax.pcolormesh(edges, edges, rows, vmin=low, vmax=high, cmap="cividis_r")
        over = [
            (d, p)
            for p, own, true in zip(gains, rows, maps[0][1], strict=True)
            for d, a, b in zip(gains, own, true, strict=True)
            if a < b
        ]
        if over:
            ax.plot(*zip(*over, strict=True), linestyle="", marker="x", markersize=2.5, color=FLAG)
        ax.set_title(title, fontsize="small")
        ax.set_xlabel("K_D [deg s/rad]")
        ax.set_ylabel("K_P [deg/rad]")
        ax.grid(visible=False)
    if mesh is not None:
        figure.colorbar(mesh, ax=axes, label="score [rad s]", shrink=0.8)
    return figure


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
            pairs("made-table", "What was run", ("", ""), items),
            pairs("options-table", "Options", ("option", "value"), chosen),
        ),
    )


KIND = Kind("heading-keeping", ("truth", "gains", "models", "options", "wall_s"), HeadingRecord, build)
