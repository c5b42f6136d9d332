"""Tracks and time histories of many manoeuvres as one block of a page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..run_files import MOTIONS
from . import findings, tables_of_motion
from .blocks import Motions, Picture, Table
from .common import picture
from .figures import motions, tracks
from .forces import MOST, NO_SHIP, Ship
from .wording import ROLES, Channel, clean, number

if TYPE_CHECKING:
    from ..arrays import FloatArray

    Motion = Mapping[str, FloatArray]

FULL = f"All samples are in {MOTIONS} in the run folder."
THINNED = "Long motions are drawn from evenly spaced samples and the least and the greatest of every stretch."
FORCES = "Forces are the model's own along its own track, without what is not known of wind and current."


def of_trials(
    results: Sequence[Mapping[str, Any]],
    found: Mapping[str, Mapping[str, Motion]],
    inputs: Sequence[Channel],
    caption: str,
    *,
    words: Mapping[str, str] = tracks.WORDS,
    ship: Ship = NO_SHIP,
    first: str = "",
    data: Sequence[Table] = (),
    finding: str = "",
) -> Motions | None:
    """Measured and simulated motions of trials, None where there is nothing to draw.

    results  the trials' rows, in their order
    found    trial -> "measured", "before" or "after" -> columns
    words    of those that are shown; the last of them is the ship's own model
    first    the trial shown first; where it is empty, the one that fits worst
    finding  what the tracks show on paper; where it is empty, what tuning made of them as mean over trials
    """
    rows = [row for row in results if str(row["id"]) in found]
    if not rows:
        return None
    model = list(words)[-1]
    manoeuvres = []
    for row in rows:
        own = {which: motion for which, motion in found[str(row["id"])].items() if which in words}
        if len(rows) <= MOST and model in own:
            own[model] = ship.with_forces(own[model])
        manoeuvres.append(motions.Manoeuvre(clean(row["id"]), own, note=_note(row, words)))
    names = [str(row["id"]) for row in rows]
    worst = first if first in names else str(max(rows, key=lambda row: misfit_of(row, model))["id"])
    chosen = {id(row) for row in tracks.chosen(rows, model)}
    drawn = [one for one, row in zip(manoeuvres, rows, strict=True) if id(row) in chosen]
    runs = tracks.runs_of(words)
    said = finding or (findings.tracks(rows, words["after"]) if "after" in words else caption)
    closer = findings.distances(rows) if "after" in words else "The same over time."
    distances = (picture(tracks.distances(drawn, runs), "Distance off track", closer),)
    return of_manoeuvres(
        manoeuvres, runs, inputs, caption, said=said, drawn=drawn, selected=names.index(worst), L_pp=ship.L_pp,
        notes=(FULL,), more=distances, data=data, why="" if first else ", which fits worst",
    )  # fmt: skip


def of_manoeuvres(
    manoeuvres: Sequence[motions.Manoeuvre],
    runs: Sequence[motions.Run],
    inputs: Sequence[Channel],
    caption: str,
    *,
    said: str = "",
    drawn: Sequence[motions.Manoeuvre] | None = None,
    selected: int = 0,
    L_pp: float | None = None,
    notes: Sequence[str] = (),
    more: Sequence[Picture] = (),
    data: Sequence[Table] = (),
    title: str = "Tracks and time histories",
    why: str = "",
) -> Motions:
    """Motions of any models in manoeuvres of any kind; one at least.

    said   what the tracks show, under their picture on paper
    drawn  those of which there is a picture on paper
    more   further pictures for paper
    why    what is special about the one shown first
    """
    payload, thinned = motions.payload(manoeuvres, runs, inputs, L_pp=L_pp)
    forced = any(one["group"] == "force" for one in payload["channels"])
    drawn = list(manoeuvres[: tracks.PANELS]) if drawn is None else drawn
    words = f"{said} Marks every {tracks.tick_spacing(drawn):.0f} s; + is the start.".strip()
    if len(drawn) < len(manoeuvres):
        words += f" Shown are {len(drawn)} of {len(manoeuvres)}, those that fit worst." if said else ""
    alt = "Tracks of each manoeuvre, north up"
    first = manoeuvres[selected]
    static = (
        picture(tracks.tracks(drawn, runs, alt), "Tracks", words),
        *more,
        picture(tracks.histories(first, runs, inputs), "Time histories", f"Time histories of {first.name}{why}."),
    )
    said_too = [THINNED] * thinned + list(notes) + [FORCES] * forced
    names = tuple(one.name for one in manoeuvres)
    return Motions("motions", title, caption, payload, names, static, selected, tuple(said_too), tuple(data))


def numbers(
    results: Sequence[Mapping[str, Any]],
    found: Mapping[str, Mapping[str, Motion]],
    words: Mapping[str, str] = tracks.WORDS,
) -> tuple[Table, ...]:
    """Distances off track of every trial."""
    return (tables_of_motion.distances(results, found, words),)


def misfit_of(row: Mapping[str, Any], model: str = "after") -> float:
    """J of the model that is spoken of, greatest where the simulation diverged."""
    size = number(row.get(f"J_{model}"))
    return float("inf") if size is None else size


def _note(row: Mapping[str, Any], words: Mapping[str, str]) -> str:
    """What is said of a trial under its track."""
    parts = [clean(row.get("manoeuvre") or ""), ROLES.get(str(row.get("role")), "")]
    for which in ("before", "after"):
        text = findings.off_track_words(row, which)
        if text and which in words:
            parts.append(f"{words[which]} {text}")
    return " · ".join(part for part in parts if part)
