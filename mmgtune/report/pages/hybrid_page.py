"""The report of a network beside a model of forces."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...how_far_off import rms_errors
from .. import learned_motions
from ..advice import shortest
from ..blocks import Block, Card, Commands, Page, Prose, Section, Table, cells
from ..common import banner_of_sources, of_training, picture, stopped_early
from ..figures.plot import Axis, Figure, Line, Look, Mark, Panel, Rule, model_look
from ..load import Kind
from ..tables import tone
from ..wording import MINUS, NONE, clean, count, number, percent, sentence, share, shown
from .learning_page import made_section


@dataclass(frozen=True)
class HybridRecord:
    """A hybrid as its folder holds it: hybrid.json."""

    folder: Path
    data: Mapping[str, Any]


def build(record: HybridRecord) -> Page:
    """Everything the report of a hybrid says."""
    data = record.data
    curves = _curves_figure(data["tried"])
    gained = bool(data["gained"])
    words = (
        "Of each kind of manoeuvre the window of median error, from its first measured state: measured, the model of "
        "forces alone, and with the network."
    )
    tracks = learned_motions.block(data, words, ("forces alone", "hybrid"))
    sections = [
        Section("tracks", "What it predicts", (tracks,)),
        Section("gains", "Gain on unseen runs", (_gains(data),)) if gained else None,
        _reading(data["reading"]) if gained else None,
        Section("learning", "How it was chosen", _curves(curves, data)),
        Section("next", "What to do next", (_next(record),)),
        made_section(data, [("memory of velocities", f"{shown(data['lag_s'], 3)} s")]),
    ]
    return Page(
        title=f"{clean(data['ship'])}: a network beside the model of forces",
        eyebrow=f"{clean(data['ship'])} · hybrid: a network beside the model of forces",
        verdict=verdict(data),
        banners=banner_of_sources(data["provenance"]["trials"].get("sources"), learned=True),
        warnings=(*stopped_early(data), *map(sentence, data.get("warnings", ()))),
        cards=_cards(data),
        sections=tuple(one for one in sections if one is not None),
    )


def verdict(data: Mapping[str, Any]) -> str:
    """What the network is worth on runs it has not seen; first of all that the training was stopped, where it was."""
    return of_training(data, _answer(data)) if data["gained"] else _answer(data)


def _answer(data: Mapping[str, Any]) -> str:
    if not data["gained"] and data["interrupted"]:
        return "Stopped before a network was chosen: the model is the profile as it is."
    if not data["gained"]:
        return "No gain: no network does better than the model of forces alone on runs it has not seen."
    parts = [
        f"{share(row['share_removed'])} in {clean(row['manoeuvre']) or 'all'} ({count(row['runs'], 'run')})"
        for row in data["gains"]
    ]
    removed = f"removes part of the model's error L_MSE: {', '.join(parts)}."
    if not data["scores"]:
        return f"On runs it has not seen the network {removed}"
    (place, heading), (first, first_heading) = (rms_errors(data, data["scores"][k]) for k in ("after", "before"))
    if place is None:
        return f"The hybrid diverges on held-out runs; on runs kept back in training the network {removed}"
    instead = "" if first is None else f" instead of {shown(first, 3)} m and {shown(first_heading, 2)}°"
    return (
        f"On held-out runs the hybrid is {shown(place, 3)} m off track and {shown(heading, 2)}° off heading{instead} "
        f"(root mean square); on runs kept back in training the network {removed}"
    )


def _cards(data: Mapping[str, Any]) -> tuple[Card, ...]:
    shown_cards = []
    scores = data["scores"]
    if scores:
        for k, label, unit, digits in ((0, "Off track, held out", " m", 3), (1, "Off heading, held out", "°", 2)):
            before, after = (rms_errors(data, scores[which])[k] for which in ("before", "after"))
            moved = 100.0 * (after - before) / before if before and after is not None else None
            shown_cards.append(
                Card(
                    label,
                    f"{shown(before, digits)} → {shown(after, digits)}{unit}",
                    percent(moved),
                    "root mean square",
                    tone(moved),
                )
            )
    for row in data["gains"][: 4 - len(shown_cards)]:
        moved = -100.0 * row["share_removed"]
        value = f"{shown(row['L_MSE_before'], 3)} → {shown(row['L_MSE_after'], 3)}"
        shown_cards.append(Card(f"L_MSE, {clean(row['manoeuvre'])}", value, percent(moved), "unseen runs", tone(moved)))
    return tuple(shown_cards)


def _gains(data: Mapping[str, Any]) -> Table:
    rows = []
    for row in data["gains"]:
        interval = row["share_removed_ci95"]
        within = f"{shown(100 * interval[0], 2)} to {shown(100 * interval[1], 2)} %" if interval else NONE
        rows.append(
            cells(
                clean(row["manoeuvre"]) or "not stated",
                str(row["runs"]),
                shown(row["L_MSE_before"], 3),
                shown(row["L_MSE_after"], 3),
                f"{shown(100 * row['share_removed'], 2)} %",
                within,
            )
        )
    return Table(
        "gains-table",
        "L_MSE of windows of runs that neither the network nor the model of forces was fitted to; intervals of 95 % by "
        "drawing runs anew, where there are three or more",
        ("manoeuvre", "runs", "model of forces", "hybrid", "removed", "interval"),
        tuple(rows),
        numeric=(1, 2, 3, 4, 5),
        cards=True,
    )


def _reading(found: Mapping[str, Any]) -> Section:
    """What the network says in known terms."""
    words = Prose(tuple(clean(one) for one in found["sentences"]))
    if not found["terms"]:
        return Section("reading", "What the network adds", (words,))
    rows = [
        cells(
            clean(one["title"]),
            clean(one["name"]),
            clean(one["written"]).replace("-", MINUS),
            share(one["share"]),
            *(share(one["shares"][name]) for name in ("X", "Y", "N")),
        )
        for one in found["terms"]
    ]
    table = Table(
        "terms-table",
        "Known causes with a force like the one the network adds; share: of what the causes above leave, on runs that "
        "the value was not found from",
        ("cause", "name", "value", "share", "surge", "sway", "yaw"),
        tuple(rows),
        numeric=(2, 3, 4, 5, 6),
        cards=True,
    )
    return Section("reading", "What the network adds", (words, table))


def _curves(curves: Figure | None, data: Mapping[str, Any]) -> tuple[Block, ...]:
    words = _curves_words(data)
    return (Prose((words,)),) if curves is None else (picture(curves, "Error on unseen runs", words),)


def _curves_words(data: Mapping[str, Any]) -> str:
    kept = (
        f"Kept: {data['updates']} updates, penalty {shown(data['penalty'], 3)}." if data["gained"] else "None was kept."
    )
    return (
        "Error with the network over error of the model of forces alone, on runs kept back, by kind of manoeuvre; "
        f"below 1 the network helps. {kept}"
    )


def _curves_figure(tried: Sequence[Mapping[str, Any]]) -> Figure | None:
    several = [one for one in tried if one["curve"]]
    panels = []
    kinds: list[str] = []
    for one in several:
        kinds = [key for key in one["curve"][0] if key not in ("step", "loss", "score")]
        marks: list[Mark] = [Rule(1.0, Look("ink", 0.9), upright=False)]
        for k, kind in enumerate(kinds):
            rows = [row for row in one["curve"] if number(row[kind]) is not None]
            look = replace(model_look(k), size=4.0)
            marks.append(Line([row["step"] for row in rows], [row[kind] for row in rows], look))
        title = f"penalty {shown(one['penalty'], 3)}: error over the model's [–]"
        panels.append(Panel(tuple(marks), Axis("updates of the weights"), Axis(), title))
    legend = tuple((clean(kind) or "all", replace(model_look(k), size=4.0)) for k, kind in enumerate(kinds))
    return Figure("curves", "Error on unseen runs by updates", tuple(panels), legend) if panels else None


def _next(record: HybridRecord) -> Commands:
    data = record.data
    path = shlex.quote(shortest(data["provenance"]["profile"].get("path") or data["ship"], "ship_profiles"))
    trials = shlex.quote(shortest(data["provenance"]["trials"].get("path") or "TRIALS", "trials"))
    if not data["gained"]:
        return Commands((("See what the profile gets wrong, and why", f"mmgtune diagnose -p {path} -t {trials}"),))
    model = shlex.quote(f"{record.folder.as_posix()}/model.safetensors")
    window = number(data["window_s"])
    restart = f" --restart {window:g}" if window else ""
    return Commands(
        (
            ("Score both on the same windows", f"mmgtune validate {path} {model} {trials}{restart}"),
            ("Simulate trials with it", f"mmgtune simulate -p {model} --trials {trials}"),
        )
    )


KIND = Kind("hybrid", ("gained", "gains", "reading", "tried", "drawn", "provenance", "sigma"), HybridRecord, build)
