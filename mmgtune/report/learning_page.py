"""The report of networks trained on trials."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .advice import shortest
from .common import picture
from .drawing import AFTER, BEFORE, Drawn, grid_of, log_ticks, new_figure
from .load import Kind
from .page import Commands, Details, Page, Prose, Section, Table, Tile, cells
from .tables import pairs
from .wording import NONE, clean, count, listing, number, shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROLES = {"test": "held out", "validation": "validation", "learned": "learned from"}
MEANING = (
    "L_MSE is the mean over time of the sum over all six states of squared differences over their variance in the "
    "trials that tune (Wakita et al. 2022, eq. 26): 0 is perfect, and a model that knows only the mean has about 6."
)


@dataclass(frozen=True)
class LearningRecord:
    """A training as its folder holds it: learning.json."""

    folder: Path
    data: Mapping[str, Any]

    @property
    def members(self) -> list[dict[str, Any]]:
        """The networks, one a seed."""
        return list(self.data["members"])

    @property
    def role(self) -> str:
        """The trials that the report speaks of first: those held out, where there are any."""
        return next((role for role in ROLES if role in self.data["scores"]), "validation")

    @property
    def scores(self) -> Mapping[str, Any]:
        """Their scores."""
        found: Mapping[str, Any] = self.data["scores"][self.role]
        return found


def build(record: LearningRecord) -> Page:
    """Everything the report of a training says."""
    data = record.data
    tracks = Drawn("tracks", "Tracks as measured and as predicted", lambda: draw_tracks(data["drawn"]))
    curves = Drawn("curves", "Learning curves", lambda: draw_curves(record.members, "L_MSE of validation [–]"))
    sections = [
        Section("tracks", "What it predicts", (picture(tracks, "Tracks", tracks_words(record)),)),
        Section("scores", "Errors by kind of manoeuvre", (scores_table(record), Prose((MEANING,)))),
        Section("learning", "How it learned", (picture(curves, "Learning curves", _CURVES), *events_said(record))),
        Section("next", "What to do next", (next_steps(record),)),
        made_section(data, _more(data)),
    ]
    generated = data["provenance"]["trials"].get("sources") == ["generated"]
    banner = "The trials it learned from are generated, not measured: this says how the method works, not the ship."
    return Page(
        title=f"Networks of {clean(data['ship'])}: type {clean(data['type'])}",
        eyebrow=clean(data["recipe"]),
        verdict=_verdict(record),
        banners=(banner,) if generated else (),
        warnings=("The training was stopped early; --resume continues it.",) if data["interrupted"] else (),
        tiles=_tiles(record),
        sections=tuple(sections),
        figures={"tracks": tracks, "curves": curves},
    )


def _verdict(record: LearningRecord) -> str:
    position, heading = rms_errors(record.data, record.scores)
    window = number(record.data["window_s"])
    over = f"over {shown(window, 3)} s" if window else "over whole trials"
    return (
        f"{over.capitalize()} from a measured state the networks are {shown(position, 2)} m and {shown(heading, 2)}° "
        f"off (root mean square) on {count(len(record.scores['trials']), 'trial')} "
        f"{'that played no part' if record.role == 'test' else 'that chose among their weights'}."
    )


def rms_errors(data: Mapping[str, Any], row: Mapping[str, Any]) -> tuple[float | None, float | None]:
    """Root mean square error of position [m] and heading [deg]; None where it diverged."""
    parts, sigma = row["L_MSE_by_state"], data["sigma"]
    squares = {name: number(parts.get(name)) for name in ("x", "y", "psi")}
    if any(value is None for value in squares.values()):
        return None, None
    x, y, psi = ((squares[name] or 0.0) * sigma[name] ** 2 for name in ("x", "y", "psi"))
    return math.sqrt(x + y), math.degrees(math.sqrt(psi))


def _tiles(record: LearningRecord) -> tuple[Tile, ...]:
    data = record.data
    position, heading = rms_errors(data, record.scores)
    where = ROLES[record.role]
    best = [one["score"] for one in record.members if number(one["score"]) is not None]
    return (
        Tile(f"Position error, {where}", f"{shown(position, 2)} m", note="root mean square"),
        Tile(f"Heading error, {where}", f"{shown(heading, 2)}°", note="root mean square"),
        Tile(f"L_MSE, {where}", shown(record.scores["L_MSE"], 3), note=f"mean over {count(len(best), 'seed')}"),
        Tile("Learned from", count(len(data["learned_from"]), "trial"), note=f"chosen by {len(data['chosen_by'])}"),
    )


def tracks_words(record: LearningRecord) -> str:
    """What the figure of tracks shows."""
    return (
        f"Of each kind of manoeuvre the window of median error among the trials {ROLES[record.role]}: measured, and "
        f"as {count(len(record.members), 'network')} predict it from the first state and the "
        "inputs."
    )


def draw_tracks(drawn: Sequence[Mapping[str, Any]]) -> Figure:
    """Tracks as measured and as the members predict them, a kind of manoeuvre to each axes."""
    from matplotlib.lines import Line2D

    figure, axes = grid_of(max(len(drawn), 1), (2.9, 3.0))
    for ax, one in zip(axes, drawn, strict=False):
        for member in one["members"]:
            draw_line(ax, member, color=AFTER, linewidth=1.0, linestyle=(0, (6, 2.2)))
        draw_line(ax, one["measured"], color="black", linewidth=1.5)
        ax.set_title(f"{clean(one['manoeuvre']) or clean(one['id'])}: L_MSE {shown(one['L_MSE'], 2)}", fontsize="small")
    handles = [
        Line2D([], [], color="black", label="measured"),
        Line2D([], [], color=AFTER, linestyle=(0, (6, 2.2)), label="predicted"),
    ]
    figure.legend(handles=handles, loc="outside upper left", ncols=2, handlelength=3.6)
    return figure


def draw_line(ax: Axes, track: Mapping[str, Any], **style: Any) -> None:
    """A track over the ground, north up; gaps stay open."""
    east, north = ([math.nan if v is None else v for v in track[name]] for name in ("east_m", "north_m"))
    ax.plot(east, north, **style)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("east [m]")
    ax.set_ylabel("north [m]")


_CURVES = (
    "Loss on short windows of the trials learned from, and L_MSE on long windows of those that chose; a line a seed. "
    "The weights at the dot are kept: the loss on short windows hardly foretells the error on long ones."
)


def draw_curves(members: Sequence[Mapping[str, Any]], label: str) -> Figure:
    """Loss of each network by updates, and what it is watched by, named ``label``; a dot where one was kept."""
    figure = new_figure(7.6, 3.0)
    left, right = figure.subplots(1, 2)
    for one in members:
        for ax, key, color in ((left, "loss", BEFORE), (right, "score", AFTER)):
            rows = [row for row in one["curve"] if number(row[key]) is not None]
            marker = "." if len(rows) == 1 else None  # a line of one point is none
            ax.plot(
                [row["step"] for row in rows], [row[key] for row in rows], color=color, linewidth=1.0, marker=marker
            )
        if number(one["score"]) is not None and "best_step" in one:
            right.plot([one["best_step"]], [one["score"]], color=AFTER, marker="o", markersize=4)
    _scaled(left, "loss on short windows [–]")
    _scaled(right, label)
    return figure


def _scaled(ax: Axes, label: str) -> None:
    ax.set_xlabel("updates of the weights")
    ax.set_ylabel(label)
    if ax.lines:
        ax.set_yscale("log")
        log_ticks(ax.yaxis)


def scores_table(record: LearningRecord) -> Table:
    """Errors by role of the trials and kind of manoeuvre."""
    rows = []
    for role, words in ROLES.items():
        found = record.data["scores"].get(role)
        if found is None:
            continue
        for kind, row in found["by_manoeuvre"].items():
            position, heading = rms_errors(record.data, row)
            name = clean(kind) or "not stated"
            rows.append(
                cells(words, name, str(row["runs"]), shown(position, 3), shown(heading, 3), shown(row["L_MSE"], 3))
            )
    return Table(
        "scores-table",
        "Root mean square errors and L_MSE, means over the networks",
        ("trials", "manoeuvre", "runs", "position [m]", "heading [°]", "L_MSE [–]"),
        tuple(rows),
        numeric=(2, 3, 4, 5),
    )


def events_said(record: LearningRecord) -> tuple[Prose, ...]:
    """Where training diverged."""
    said = [
        f"Seed {one['seed']} diverged at update {event['step']} ({clean(event['why'])}) and went back to update "
        f"{event['back_to']} at {shown(100 * event['rate_factor'], 3)} % of the rate."
        for one in record.members
        for event in one["events"]
    ]
    return (Prose(tuple(said), listed=True, tone="warning"),) if said else ()


def next_steps(record: LearningRecord) -> Commands:
    """What the model can be used for."""
    model = f"{record.folder.as_posix()}/model.safetensors"
    made = record.data["provenance"]
    ship = shortest(made["profile"].get("path") or record.data["ship"], "ship_profiles")
    trials = shortest(made["trials"].get("path") or "TRIALS", "trials")
    window = number(record.data["window_s"])
    restart = f" --restart {window:g}" if window else ""
    return Commands(
        (
            ("Hold it against a profile on the same windows", f"mmgtune validate {ship} {model} {trials}{restart}"),
            ("Simulate trials with it", f"mmgtune simulate -p {model} --trials {trials}"),
        )
    )


def made_section(data: Mapping[str, Any], more: Sequence[tuple[str, str]]) -> Section:
    """What networks were made from, when and how."""
    made, trials = data["provenance"], data["provenance"]["trials"]
    items = [
        ("learned from", listing([clean(one) for one in trials["learned_from"]], 40)),
        ("held out", listing([clean(one) for one in data["held_out"]], 40)),
        ("licence of the trials", clean(trials.get("licence") or NONE)),
        ("cite for them", clean(trials.get("citation") or NONE)),
        ("step", f"{shown(data['step_s'], 3)} s"),
        *more,
        ("command", clean(made["command"] or NONE)),
        ("made by", f"mmgtune {clean(made['mmgtune'])}, {clean(made['created'])}"),
        ("time", f"{shown(data['wall_s'], 3)} s"),
    ]
    chosen = [(clean(name), clean(value)) for name, value in made["options"].items()]
    options = pairs("options-table", "Options", ("option", "value"), chosen)
    about = pairs("made-table", "What it was made from", ("", ""), items)
    return Section("made", "How it was made", (about, Details("All options", (options,))))


def _more(data: Mapping[str, Any]) -> list[tuple[str, str]]:
    return [
        ("chosen by", listing([clean(one) for one in data["chosen_by"]], 40)),
        ("inputs", ", ".join(clean(one) for one in data["inputs"])),
        ("memory", "runs on" if data["memory"] is None else f"{data['memory']} samples"),
        ("units of a layer", str(data["width"])),
    ]


KIND = Kind("learning", ("members", "scores", "drawn", "provenance", "sigma"), LearningRecord, build)
