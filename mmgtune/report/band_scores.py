"""Scores of bands as reports show them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from .blocks import Prose, Section, Table, cells
from .wording import NONE, clean, share, shown

MEANING_OF_ONE = (
    "L_fit is the mean squared distance from what was measured over the noise that a trial states (Wakita et al., "
    "eq. 29); L_Eucl is the same distance, of velocities in m/s and rad/s (eq. 30); CRPS is the mean distance over the "
    "states, in their spread over the trials. Measured samples have the noise of their sensors."
)
"""What scores of one run are, which has no band."""

MEANING = (
    "L_fit is the mean squared distance of a particle from what was measured over the noise that a trial states "
    "(Wakita et al., eq. 29); "
    "L_Eucl is the mean squared distance of the particles' mean from what was measured, of velocities in m/s and "
    "rad/s; L_Maha the same over the covariance of the particles, 3 where that is right (Wakita et al., eq. 30, 31). "
    "CRPS and the width of the 90 % band are means over the states, in their spread over the trials. Measured samples "
    "have the noise of their sensors, bands have none."
)


SCORE_HEADS = (
    "windows",
    "L_fit",
    "L_Eucl",
    "L_Maha",
    "correlation",
    "CRPS",
    "50 % holds",
    "90 % holds",
    "width of 90 %",
)


def score_cells(scores: Mapping[str, Any]) -> list[str]:
    """A row of scores as texts, in the order of ``SCORE_HEADS``."""

    windows = str(scores["windows"])
    if scores["windows_lost"]:
        windows += f", {scores['windows_lost']} lost"
    return [
        windows,
        *(shown(scores[name], 3) for name in ("L_fit", "L_Eucl", "L_Maha", "correlation", "CRPS")),
        share(scores["coverage_50"], counted=True),
        share(scores["coverage_90"], counted=True),
        shown(scores["sharpness"], 3),
    ]


def known_scores(rows: Sequence[Sequence[Any]], first: int) -> tuple[tuple[str, ...], list[list[Any]]]:
    """Heads and rows of cells without the scores that no row has: of models of one member there is no band.

    first  cells before the scores
    """
    keep = [k for k in range(len(SCORE_HEADS)) if any(_text(row[first + k]) != NONE for row in rows)]
    heads = tuple(SCORE_HEADS[k] for k in keep)
    return heads, [[*row[:first], *(row[first + k] for k in keep)] for row in rows]


def _text(cell: Any) -> str:
    return str(getattr(cell, "text", cell))


def bands_section(models: Sequence[Mapping[str, Any]], of: str) -> Section | None:
    """How well the bands of the models that have some hold what was measured; None where none has.

    models  rows with "profile", and "bands" where there are any
    of      on what, as the end of the table's caption
    """
    found = [[clean(one["profile"]), *score_cells(one["bands"])] for one in models if one.get("bands")]
    if not found:
        return None
    heads, kept = known_scores(found, 1)
    rows = tuple(cells(*row) for row in kept)
    caption = f"Whether the bands held what was measured, on {of}"
    table = Table("bands-table", caption, ("model", *heads), rows, range(1, 1 + len(heads)))
    return Section("bands", "Bands", (table, Prose((MEANING,))))
