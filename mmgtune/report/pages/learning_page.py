"""The report of networks trained on trials."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...how_far_off import rms_errors
from ...inputs import INPUTS
from ...options.learning import ROLES
from .. import learned_motions
from ..advice import shortest
from ..blocks import Card, Commands, Page, Prose, Section, Table, cells
from ..common import banner_of_sources, made_rows, of_training, options_fold, picture, sources_rows, stopped_early
from ..figures.plot import Axis, Color, Dash, Dots, Figure, Line, Look, Mark, Panel
from ..load import Kind
from ..tables import pairs
from ..wording import clean, count, listing, number, sentence, shown

_PARTS = {
    "test": "that played no part",
    "validation": "that chose among their weights",
    "learned": "that they learned from, which says little of others",
}
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
    curves = curves_figure(record.members, "L_MSE of validation [–]")
    curves_words = _CURVES if data["chosen_by"] else _CURVES_OF_LOSS
    sections = [
        Section("tracks", "What it predicts", (learned_motions.block(data, tracks_words(record)),)),
        Section("scores", "Errors by kind of manoeuvre", (scores_table(record), Prose((MEANING,)))),
        Section("learning", "How it learned", (picture(curves, "Learning curves", curves_words), *events_said(record))),
        Section("next", "What to do next", (next_steps(record),)),
        made_section(data, _more(data)),
    ]
    return Page(
        title=f"Networks of {clean(data['ship'])}: type {clean(data['type'])}",
        eyebrow=f"{clean(data['ship'])} · networks of type {clean(data['type'])}: {clean(data['recipe'])}",
        verdict=verdict(record),
        banners=banner_of_sources(data["provenance"]["trials"].get("sources"), learned=True),
        warnings=(*stopped_early(data), *map(sentence, data.get("warnings", ()))),
        cards=_cards(record),
        sections=tuple(sections),
    )


def verdict(record: LearningRecord) -> str:
    """How far off the networks are, and on which trials; first of all that the training was stopped, where it was."""
    return of_training(record.data, f"{off_in_words(record, 'the networks are')} {_PARTS[record.role]}.")


def off_in_words(record: LearningRecord, of: str) -> str:
    """How far off networks are, as a sentence begins that says next which trials that is on.

    of  what the networks are called, with its verb
    """
    position, heading = rms_errors(record.data, record.scores)
    window = number(record.data["window_s"])
    over = f"over {shown(window, 3)} s" if window else "over whole trials"
    return (
        f"{over.capitalize()} from a measured state {of} {shown(position, 3)} m off track and "
        f"{shown(heading, 2)}° off heading (root mean square) on {count(len(record.scores['trials']), 'trial')}"
    )


def _cards(record: LearningRecord) -> tuple[Card, ...]:
    data = record.data
    position, heading = rms_errors(data, record.scores)
    where = ROLES[record.role]
    chosen_by = len(data["chosen_by"])
    return (
        Card(f"Off track, {where}", f"{shown(position, 3)} m", note="root mean square"),
        Card(f"Off heading, {where}", f"{shown(heading, 2)}°", note="root mean square"),
        Card(
            f"L_MSE, {where}", shown(record.scores["L_MSE"], 3), note=f"mean over {count(len(record.members), 'seed')}"
        ),
        Card(
            "Learned from",
            count(len(data["learned_from"]), "trial"),
            note=f"weights chosen by {chosen_by} more" if chosen_by else "none chose: the last weights are kept",
        ),
    )


def tracks_words(record: LearningRecord) -> str:
    """What the figure of tracks shows."""
    n = len(record.members)
    several = f"{count(n, 'network')} predict{'s' * (n == 1)}"
    return (
        f"Of each kind of manoeuvre the window of median error among the trials {ROLES[record.role]}: measured, and "
        f"as {several} it from the first state and the inputs."
    )


_CURVES = (
    "Loss on short windows of the trials learned from, and L_MSE on long windows of those that chose; a line a seed. "
    "The weights at the dot are kept: the loss on short windows hardly foretells the error on long ones."
)
_CURVES_OF_LOSS = (
    "Loss on short windows of the trials learned from; a line a seed. No trial was kept back to choose by: the mean of "
    "the last updates' weights is kept."
)


_SEED_COLORS: tuple[Color, ...] = ("after", "before", "flag", "third", "ink")
_SEED_DASHES: tuple[Dash, ...] = ("", "dash", "long", "dot")
"""As many colours as are told apart, and one dash less, so that twenty seeds differ in one or the other."""


def curves_figure(members: Sequence[Mapping[str, Any]], label: str) -> Figure:
    """Loss of each network by updates, and what it is watched by, named ``label``, if anything; a dot where one was
    kept.  A seed has one look in both."""
    panels = []
    looks = [seed_look(k) for k in range(len(members))]
    for key, words in (("loss", "loss on short windows [–]"), ("score", label)):
        marks: list[Mark] = []
        if key == "score" and not any(key in row for one in members for row in one["curve"]):
            continue
        for one, own in zip(members, looks, strict=True):
            rows = [row for row in one["curve"] if number(row.get(key)) is not None]
            look = replace(own, marker="o" if len(rows) == 1 else "")
            marks.append(Line([row["step"] for row in rows], [row[key] for row in rows], look))
            if key == "score" and number(one["score"]) is not None and "best_step" in one:
                marks.append(Dots([one["best_step"]], [one["score"]], Look(own.color, marker="o", size=6.0)))
        y = Axis(log=any(len(mark.x) for mark in marks if isinstance(mark, Line)))
        panels.append(Panel(tuple(marks), Axis("updates of the weights"), y, words))
    legend = [(f"seed {one['seed']}", look) for one, look in zip(members, looks, strict=True)]
    return Figure("curves", "Learning curves", tuple(panels), tuple(legend) if len(members) > 1 else ())


def seed_look(k: int) -> Look:
    """The curve of one seed among several: colours told apart by the colour-blind, and a dash of its own to each."""
    color, dash = _SEED_COLORS[k % len(_SEED_COLORS)], _SEED_DASHES[k % len(_SEED_DASHES)]
    return Look(color, 1.3, dash, size=4.0)


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
                cells(words, name, str(row["runs"]), shown(position, 3), shown(heading, 2), shown(row["L_MSE"], 3))
            )
    return Table(
        "scores-table",
        "Root mean square errors and L_MSE, means over the networks",
        ("trials", "manoeuvre", "runs", "off track [m]", "off heading [°]", "L_MSE [–]"),
        tuple(rows),
        numeric=(2, 3, 4, 5),
        cards=True,
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
    model = shlex.quote(f"{record.folder.as_posix()}/model.safetensors")
    made = record.data["provenance"]
    ship = shlex.quote(shortest(made["profile"].get("path") or record.data["ship"], "ship_profiles"))
    trials = shlex.quote(shortest(made["trials"].get("path") or "TRIALS", "trials"))
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
        *sources_rows(trials),
        ("step", f"{shown(data['step_s'], 3)} s"),
        *more,
        *made_rows(data),
    ]
    about = pairs("made-table", "What it was made from", ("what", "value"), items)
    return Section("made", "How it was made", (about, *options_fold(made["options"], "All options")))


def _more(data: Mapping[str, Any]) -> list[tuple[str, str]]:
    return [
        ("chosen by", listing([clean(one) for one in data["chosen_by"]], 40)),
        ("inputs", ", ".join(INPUTS[one].words if one in INPUTS else clean(one) for one in data["inputs"])),
        ("memory", "runs on" if data["memory"] is None else f"{data['memory']} samples"),
        ("units of a layer", str(data["width"])),
    ]


KIND = Kind("learning", ("members", "scores", "drawn", "provenance", "sigma"), LearningRecord, build)
