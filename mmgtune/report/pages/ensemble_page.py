"""The report of an ensemble trained on trials."""

from __future__ import annotations

from typing import Any

from ...how_far_off import rms_errors
from ...options.learning import ROLES
from ..blocks import Card, Page, Prose, Section, Table, cells
from ..common import banner_of_sources, of_training, picture, stopped_early
from ..learned_motions import block
from ..load import Kind
from ..wording import clean, count, listing, number, sentence, shown
from .learning_page import (
    MEANING,
    LearningRecord,
    curves_figure,
    events_said,
    made_section,
    next_steps,
    off_in_words,
    scores_table,
    tracks_words,
)

_LOSS = (
    "The loss is the mean over samples of the squared errors of u, v_m and r over the noise that was stated, of "
    "roll-outs along windows of the trials (negative log-likelihood, eq. 27): 3 is as near as the noise lets it be."
)


def build(record: LearningRecord) -> Page:
    """Everything the report of an ensemble says."""
    data = record.data
    networks = count(len(record.members), "network")
    watched = "runs kept back" if data["watched_by"] else "all windows learned from"
    curves = curves_figure(record.members, f"loss on {watched} [–]")
    curves_words = (
        "Loss of each network on the windows of an update, and, of the running mean of its weights, on "
        f"{watched}. Each is trained to the end: none is chosen."
    )
    return Page(
        title=f"Ensemble of {clean(data['ship'])}",
        eyebrow=f"{clean(data['ship'])} · ensemble of {networks} of {data['layers']} × {data['width']} units",
        verdict=verdict(record),
        banners=banner_of_sources(data["provenance"]["trials"].get("sources"), learned=True),
        warnings=(*stopped_early(data), *map(sentence, data.get("warnings", ()))),
        cards=_cards(record),
        sections=(
            Section("tracks", "What its members predict", (block(data, tracks_words(record)),)),
            Section("scores", "Errors by kind of manoeuvre", (scores_table(record), Prose((MEANING,)))),
            Section(
                "learning",
                "How it learned",
                (picture(curves, "Learning curves", curves_words), _members(record), Prose((_LOSS,))),
            ),
            *(Section("events", "Where it diverged", events_said(record)) for _ in events_said(record)),
            Section("next", "What to do next", (next_steps(record),)),
            made_section(data, _more(data)),
        ),
    )


def verdict(record: LearningRecord) -> str:
    """How far off the members are, and on which trials; first of all that the training was stopped, where it was."""
    off = off_in_words(record, "its members are")
    said = f"{off} {ROLES[record.role]}; how far they disagree says where the data tell them little."
    return of_training(record.data, said)


def _cards(record: LearningRecord) -> tuple[Card, ...]:
    data = record.data
    position, heading = rms_errors(data, record.scores)
    where = ROLES[record.role]
    losses = [one["score"] for one in record.members if number(one["score"]) is not None]
    mean = sum(losses) / len(losses) if losses else None
    return (
        Card(f"Off track, {where}", f"{shown(position, 3)} m", note="root mean square, mean over members"),
        Card(f"Off heading, {where}", f"{shown(heading, 2)}°", note="root mean square, mean over members"),
        Card("Loss", shown(mean, 3), note="3 is as near as the noise lets it be"),
        Card("Learned from", count(len(data["learned_from"]), "trial"), note=count(len(record.members), "member")),
    )


def _members(record: LearningRecord) -> Table:
    rows = [
        cells(str(k), str(one["seed"]), str(one["steps"]), shown(one["loss"], 3), shown(one["score"], 3))
        for k, one in enumerate(record.members)
    ]
    headings = ("member", "seed", "updates", "loss of updates [–]", "loss of what it is watched by [–]")
    return Table("members-table", "Members", headings, tuple(rows), numeric=(0, 1, 2, 3, 4))


def _more(data: Any) -> list[tuple[str, str]]:
    noise = data["noise"]
    watched = [clean(one) for one in data["watched_by"]]
    return [
        *([("watched by", listing(watched, 40))] if watched else []),
        ("inputs", ", ".join(clean(one) for one in data["inputs"])),
        ("window of the loss", f"{shown(data['horizon_s'], 3)} s"),
        ("observations of a start", str(data["initial"]) if data["initial"] else "none: as observed"),
        (
            "noise of u, v_m, r",
            f"{shown(noise['u'], 3)} m/s, {shown(noise['v_m'], 3)} m/s, {shown(noise['r'], 3)} rad/s",
        ),
    ]


KIND = Kind("ensemble", ("members", "scores", "drawn", "provenance", "sigma", "noise"), LearningRecord, build)
