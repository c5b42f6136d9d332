"""What judges models: diagnosis, scores, comparisons, checks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from ..profile.doubts import in_words
from .fits import compared
from .ships import measured, simulated
from .view import Line, Row, View

if TYPE_CHECKING:
    from ..checking import CheckReport
    from ..comparing_models import ModelComparison
    from ..comparing_profiles import Comparison
    from ..diagnose import Diagnosis
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
    return View(repr(result), [], rows, notes, spare=("manoeuvre",), motions=lambda: _validated(result))


def _validated(result: Validation) -> Mapping[str, list[Line]]:
    """Trials, or windows of them, as measured and as each model has them."""
    found: dict[str, list[Line]] = {one.id: [measured(one)] for one in result.pieces}
    from ..motions import motions

    for model in result.profiles:
        for run in motions(model.predictor, result.pieces, model.offsets):
            if not run.diverged and run.member == 0:
                found[run.id].append(simulated(run, model.name))
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
    return View(repr(result), [], rows, notes, spare=("diverged", "deviation"))


def profiles(result: Comparison) -> View:
    """A row a coefficient in which two profiles differ."""
    rows: list[Row] = [
        {"coefficient": row["name"], result.profiles[0]: row["a"], result.profiles[1]: row["b"], "unit": row["unit"]}
        for row in result.data["coefficients"]
        if row["a"] != row["b"]
    ]
    return View(repr(result), [], rows)


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
    return View(repr(result), [result.sentence()], rows, notes)
