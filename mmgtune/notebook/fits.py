"""Fits, alone and many of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..documents import finite
from ..profile.doubts import in_words
from ..report.pages import leave_out_page
from ..units import DIMENSIONLESS, NORMAL_95
from .ships import measured, simulated
from .view import Line, Room, Row, View

if TYPE_CHECKING:
    from ..fitting import FitResult, LeftOut, SweepResult
    from ..fitting.comparison import ComparedTrials, TrialComparison
    from ..posterior import Posterior

MOST_TOLD = 20
"""Numbers of a posterior that are drawn."""

SPARE = ("samples", "manoeuvre", "diverged", "off heading before [deg]", "off heading after [deg]")
"""Columns of the table of trials that text leaves out first."""

BOUND = {"low": "lower", "high": "upper"}


def fit(result: FitResult) -> View:
    """A row a coefficient: value, standard error, box, and what is to be known of it."""
    return View(
        repr(result), [result.sentence()], [coefficient(row) for row in result.coefficients()],
        result.warnings, spare=("what", "unit", "before"),
        rooms=lambda: {"": rooms(result)}, motions=lambda: compared(result.compared),
    )  # fmt: skip


def coefficient(row: Mapping[str, Any]) -> Row:
    """A coefficient of a fit as a row."""
    return {
        "coefficient": row["name"],
        "value": row["value"],
        "std.err": row["stderr"],
        "low": row["low"],
        "high": row["high"],
        "before": row["pre_determined"],
        "unit": "" if row["unit"] in DIMENSIONLESS else row["unit"],
        "bound": BOUND.get(row["at_bound"], ""),
        "determined": "" if row["determined"] else "no",
        "what": row["label"],
    }


def rooms(result: FitResult) -> list[Room]:
    """The coefficients of a fit in their box."""
    found = []
    for row in result.coefficients():
        size = (row["high"] or 0.0) - (row["low"] or 0.0)
        reach = NORMAL_95 * row["stderr"] / size if row["stderr"] is not None and size > 0.0 else None
        found.append(Room(row["name"], row["value"], row["position"], reach, row["at_bound"] or "", row["determined"]))
    return found


def trials(result: ComparedTrials) -> View:
    """A row a trial: how far off it is, before and after."""
    return View(repr(result), [], [_of_trial(one) for one in result], spare=SPARE, motions=lambda: compared(result))


def _of_trial(one: TrialComparison) -> Row:
    """Root mean squares off track and heading, J, and whether a simulation diverged; None where there is no number."""
    off = {which: one.off(which) for which in ("before", "after")}
    lost = [which for which in off if one.motions[which].diverged]
    return {
        "trial": one.trial.id,
        "role": one.role,
        "manoeuvre": one.trial.manoeuvre,
        "samples": one.trial.n_samples,
        **{f"off track {which} [m]": finite(of[0]) for which, of in off.items()},
        **{f"off heading {which} [deg]": finite(of[1]) for which, of in off.items()},
        **{f"J {which}": finite(one.J[which]) for which in off},
        "diverged": ", ".join(lost),
    }


def compared(trials: Sequence[TrialComparison]) -> Mapping[str, list[Line]]:
    """Trials as measured, and as simulated before and after."""
    found = {}
    for one in trials:
        lines = [measured(one.trial)]
        for which in ("before", "after"):
            if which in one.motions and not one.motions[which].diverged:
                lines.append(simulated(one.motions[which], which, which))
        found[one.trial.id] = lines
    return found


def sweep(result: SweepResult) -> View:
    """A row a width of the box: J, what is on a bound, and every coefficient."""
    rows = [
        {
            "a_r": a_r,
            "J tune": run.J,
            "J not used": judged,
            "at bound": len(run.at_bound),
            **run.theta,
        }
        for a_r, run, judged in zip(result.widths, result.runs, result.judged(), strict=True)
    ]
    return View(
        repr(result), [result.sentence()], rows, result.warnings,
        spare=tuple(reversed(list(result.runs[0].theta))),
        rooms=lambda: {f"a_r {a_r:g}": rooms(run) for a_r, run in zip(result.widths, result.runs, strict=True)},
        motions=lambda: compared(result.runs[result.best].compared),
    )  # fmt: skip


def left_out(result: LeftOut) -> View:
    """A row a kind of manoeuvre: errors with the profile's coefficients and with those fitted without the run."""
    rows = [
        {
            "manoeuvre": row["manoeuvre"],
            "runs": row["runs"],
            "off track before [m]": row["position_rms_m_before"],
            "off track left out [m]": row["position_rms_m_after"],
            "L_MSE before": row["L_MSE_before"],
            "L_MSE left out": row["L_MSE_after"],
            "share removed": row["share_removed"],
        }
        for row in result.rows()
    ]
    notes = [*result.warnings, *(f"{words}." for words in in_words(result.doubts))]
    return View(
        repr(result), [leave_out_page.verdict(result.to_dict())], rows, notes, motions=lambda: compared(result.compared)
    )


def posterior(result: Posterior) -> View:
    """A row a number: what trials leave open of it."""
    document = result.to_dict()
    rows = [
        {
            "number": row["name"],
            "median": row["median"],
            "5 %": row["low"],
            "95 %": row["high"],
            "deviation before": row["prior_deviation"],
            "unit": "" if row["unit"] in DIMENSIONLESS else row["unit"],
        }
        for row in document["numbers"]
    ]
    return View(repr(result), result.sentences(), rows, result.warnings, rooms=lambda: {"": _left_open(result)})


def _left_open(result: Posterior) -> list[Room]:
    """The numbers that trials say most of, in the middle 95 % of what was thought of them before."""
    values, room = result.particles.values, result.room
    before = NORMAL_95 * room.deviation
    reach = NORMAL_95 * values.std(axis=1) / (2.0 * before)
    median = np.median(values, axis=1)
    position = 0.5 + (median - room.centre) / (2.0 * before)
    return [
        Room(room.names[k], float(median[k]), float(position[k]), float(reach[k]))
        for k in np.argsort(reach)[:MOST_TOLD]
    ]
