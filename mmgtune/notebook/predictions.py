"""What is foretold: predictions with bands, trials to sail next, gains of a helmsman."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..manoeuvres.named import BY_KEY
from ..physics.quantities import STATES
from ..predicting.result import END
from ..report.pages import heading_page, plan_page, predict_page
from . import fits
from .ships import measured
from .view import Line, Row, View

if TYPE_CHECKING:
    from ..heading_keeping import HeadingStudy
    from ..planning import TrialPlan
    from ..predicting import FitBands, Foretold, Predicted

PARTICLES = 40
"""Particles of a prediction that are drawn."""


def prediction(result: Predicted) -> View:
    """A row a manoeuvre and index: the middle of the particles and the band that holds the share asked for.

    Of lists of orders, and of runs that show no index, also where the ship is at the end.
    """
    rows: list[Row] = []
    for run in result.runs:
        for key in run.indices:
            known, band = BY_KEY[key], run.index(key, result.level)
            rows.append(_banded(result, run, known.words, known.unit, band.to_dict(), run.measured.get(key)))
        if run.manoeuvre == "orders" or not run.indices:
            for (name, (words, unit, factor)), end in zip(END.items(), run.end(result.level), strict=True):
                last = factor * run.trial.motion[-1, STATES.index(name)] if run.trial else np.nan
                known_last = float(last) if np.isfinite(last) else None
                rows.append(_banded(result, run, f"{words} at the end", unit, end, known_last))
    says = [predict_page.verdict(predict_page.PredictRecord(Path(), result.to_dict(), {}, {}))]
    says += [f"Between low and high lie {result.options.level:g} % of the particles."] if result.has_band else []
    return View(repr(result), says, rows, result.notes, spare=("reached",), motions=lambda: _foretold(result))


def _banded(
    result: Predicted, run: Foretold, words: str, unit: str, band: Mapping[str, Any], measured: float | None
) -> Row:
    """A number of a run as particles have it."""
    return {
        "manoeuvre": run.id,
        "index": words,
        "median" if result.has_band else "predicted": band["median"],
        **({"low": band["low"], "high": band["high"]} if result.has_band else {}),
        "unit": unit,
        "measured": measured,
        **({"reached": f"{band['reached']} of {band['particles']}"} if result.has_band else {}),
    }


def _foretold(result: Predicted) -> Mapping[str, list[Line]]:
    """Each manoeuvre: measured where there is a trial, and the first particles that did not diverge."""
    found = {}
    for run in result.runs:
        lines = [measured(run.trial)] if run.trial else []
        for k, states in enumerate(run.sound[:PARTICLES]):
            columns = dict(zip(("x", "y", "psi", "u", "v_m", "r"), states.T, strict=True))
            words = f"{PARTICLES} of {len(run.sound)} particles" if len(run.sound) > PARTICLES else result.name
            lines.append(Line(words if k == 0 else "", "member" if len(run.sound) > 1 else "model", run.t, columns))
        found[run.id] = lines
    return found


def fit_bands(result: FitBands) -> View:
    """The manoeuvres that come of a fit, as of a prediction; without any what its trials leave open."""
    of = fits.posterior(result.posterior) if result.predicted is None else prediction(result.predicted)
    says = [result.fit.sentence(), *result.posterior.sentences()]
    return View(repr(result), says, of.rows, result.warnings, spare=of.spare)


def headings(result: HeadingStudy) -> View:
    """A row a pair of gains: scores of the true system, and of each simulator the mean of its members."""
    rows: list[Row] = []
    for i, first in enumerate(result.gains):
        for j, second in enumerate(result.gains):
            row: dict[str, Any] = {
                "K_P [deg/rad]": float(first),
                "K_D [deg s/rad]": float(second),
                f"{result.true_ship} [rad s]": float(result.truth[i, j]),
            }
            row |= {f"{one.name} [rad s]": float(np.mean(one.scores[:, i, j])) for one in result.models}
            rows.append(row)
    return View(repr(result), [heading_page.verdict(heading_page.HeadingRecord(Path(), result.to_dict()))], rows)


def plan(result: TrialPlan) -> View:
    """A row a trial that could be sailed, the one that tells most first."""
    rows: list[Row] = [
        {"trial": one.words, "duration [s]": one.duration, "half width after": one.half, "share that goes": one.shrinks}
        for one in result.trials
    ]
    says = [plan_page.verdict(result.to_dict())] if result.trials else []
    return View(repr(result), says, rows, result.notes)
