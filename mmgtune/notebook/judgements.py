"""What judges models: diagnosis, scores, comparisons, checks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..physics.quantities import STATES
from ..profile.doubts import in_words
from ..report.pages import comparison_page, models_page, validate_page
from .fits import compared
from .ships import measured, simulated
from .view import Line, Row, View

if TYPE_CHECKING:
    from ..arrays import FloatArray
    from ..checking import CheckReport
    from ..comparing_models import ModelComparison
    from ..comparing_profiles import Comparison
    from ..diagnose import Diagnosis
    from ..predictor import Predictor
    from ..trial import Trial
    from ..validating import Validation
    from ..voyages import VoyageValidation


def diagnosis(result: Diagnosis) -> View:
    """A row a hypothesis that was looked at, the likeliest first; what was found is said."""
    rows: list[Row] = [
        {
            "hypothesis": row.effect,
            "parameters": ", ".join((*row.parameters, *(("of each run",) if row.by else ()))),
            "score": row.score,
            "gain": row.gain,
            "by chance": row.p_value,
            "J test": row.J_test,
        }
        for row in result.candidates
    ]
    notes = [result.suggestion.sentence()] if result.suggestion else []
    notes += [f"{words}." for words in in_words(result.profile.doubts())]
    says = [f"Verdict: {result.verdict}. {result.sentence()}"]
    return View(
        repr(result), says, rows, notes, spare=("gain", "score"), motions=lambda: compared(result.gain.compared)
    )


def validation(result: Validation) -> View:
    """A row a model and trial: J and L_MSE."""
    rows: list[Row] = []
    several = any(model.predictor.n_members > 1 for model in result.profiles)
    for model in result.profiles:
        for one in model.scores:
            member = {"member": one.member + 1} if several else {}
            rows.append(
                {"model": model.name, "trial": one.id, **member, "manoeuvre": one.manoeuvre, "J": one.J,
                 "L_MSE": one.L_MSE}
            )  # fmt: skip
    notes = [f"{model.name}: {note}." for model in result.profiles for note in model.notes]
    says = [validate_page.verdict(validate_page.ValidationRecord(Path(), result.to_dict(), {}, ()))]
    return View(repr(result), says, rows, notes, spare=("manoeuvre",), motions=lambda: _validated(result))


def _validated(result: Validation) -> Mapping[str, list[Line]]:
    """Trials, or windows of them, as measured and as each model has them."""
    return alongside(result.pieces, {one.name: (one.predictor, one.offsets) for one in result.profiles})


def alongside(
    trials: Sequence[Trial], models: Mapping[str, tuple[Predictor, FloatArray | None]]
) -> Mapping[str, list[Line]]:
    """Trials as measured, and beside each what the first member of each model makes of it.

    models  each with what is added to the first measured states, (n_trials, 6), or None
    """
    from ..motions import motions

    found: dict[str, list[Line]] = {one.id: [measured(one)] for one in trials}
    for name, (predictor, offsets) in models.items():
        for run in motions(predictor, trials, offsets):
            if not run.diverged and run.member == 0:
                found[run.id].append(simulated(run, name))
    return found


def models(result: ModelComparison) -> View:
    """A row a model, convention and kind of manoeuvre: mean L_MSE over its members."""
    rows: list[Row] = []
    for model in result.models:
        for convention in ("windows", "whole"):
            for column in result.columns:
                cell = model.cell(convention, column)
                rows.append(
                    {"model": model.name, "begun anew": convention, "of": column.name, "L_MSE": cell.mean,
                     "deviation": cell.deviation, "diverged": cell.diverged}
                )  # fmt: skip
    notes = [f"{note}." for note in result.notes]
    says = [models_page.verdict(models_page.ModelsRecord(Path(), result.to_dict(), {}, ()))]
    return View(repr(result), says, rows, notes, spare=("diverged", "deviation"), motions=lambda: _compared(result))


def _compared(result: ModelComparison) -> Mapping[str, list[Line]]:
    """Whole trials as measured and as the first member of each model has them."""
    trials = list(result.data.trials.values())
    return alongside(trials, {one.name: (one.predictor, None) for one in result.models})


def profiles(result: Comparison) -> View:
    """A row a coefficient in which two profiles differ."""
    rows: list[Row] = [
        {"coefficient": row["name"], result.profiles[0]: row["a"], result.profiles[1]: row["b"], "unit": row["unit"]}
        for row in result.data["coefficients"]
        if row["a"] != row["b"]
    ]
    return View(repr(result), [comparison_page.verdict(comparison_page.ComparisonRecord(Path(), result.data))], rows)


def check(result: CheckReport) -> View:
    """A row a metric, the most severe first."""
    rows: list[Row] = [
        {
            "trial": item.trial,
            "metric": item.words,
            "baseline": item.baseline,
            "now": item.now,
            "allowed": item.allowed,
            "unit": item.unit,
            "status": item.status,
        }
        for of in result.by_status.values()
        for item in of
    ]
    return View(repr(result), [result.sentence()], rows, result.notes, spare=("unit", "allowed"))


def voyages(result: VoyageValidation) -> View:
    """A row a model: how many windows it does well and badly."""
    rows: list[Row] = []
    for name in result.predictors:
        rows.append({"model": name, "windows": result.n_windows, "median cVDM [%]": result.median(name),
                     **result.classes(name)})  # fmt: skip
    notes = [f"{name}: {note}." for name, of in result.notes.items() for note in of]
    return View(repr(result), [result.sentence()], rows, notes, motions=lambda: _windows(result))


def _windows(result: VoyageValidation) -> Mapping[str, list[Line]]:
    """The best, median and worst windows by the first model, as measured and as each model has them."""
    found: dict[str, list[Line]] = {}
    for one in result.drawn:
        runs = {("measured", "measured"): one.measured, **{(name, "model"): of for name, of in one.states.items()}}
        lines = [
            Line(*what, one.t, dict(zip(STATES, states.T, strict=True)))
            for what, states in runs.items()
            if what[1] == "measured" or np.isfinite(states).all()
        ]
        lines[0] = replace(lines[0], columns={**lines[0].columns, "delta": one.delta})
        found[result.id_of(one)] = lines
    return found
