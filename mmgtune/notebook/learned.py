"""What was learned: networks, alone and beside a model of forces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..documents import finite
from ..learning.choosing import pieces_of
from ..motions import motions
from ..networks import EnsemblePredictor, HybridPredictor, NetworkPredictor
from ..options.learning import ROLES
from ..predictor import Predictor, as_predictor
from ..report.pages import ensemble_page, hybrid_page, learning_page
from ..scores import L_MSE, by_manoeuvre, by_member, by_run, off_by
from .judgements import alongside
from .ships import measured, simulated
from .view import Line, Row, View

if TYPE_CHECKING:
    from ..learning import Learned, LearnedEnsemble, LearnedHybrid, LearnedMixture
    from ..scores import TrialScore


def networks(result: Learned) -> View:
    """A row a role of trials and kind of manoeuvre: how far off the networks are, as means over them."""
    says = [learning_page.verdict(learning_page.LearningRecord(Path(), result.to_dict()))]
    model = NetworkPredictor(result.network)
    return _view(result, model, says)


def ensemble(result: LearnedEnsemble) -> View:
    """As of ``networks``, of an ensemble."""
    says = [ensemble_page.verdict(learning_page.LearningRecord(Path(), result.to_dict()))]
    model = EnsemblePredictor(result.ensemble)
    return _view(result, model, says)


def _view(result: Learned | LearnedEnsemble, model: Predictor, says: Sequence[str]) -> View:
    rows = _scored(result)
    return View(
        repr(result), says, rows, result.warnings, spare=("deviation",), motions=lambda: _members(result, model)
    )


def _scored(result: Learned | LearnedEnsemble) -> list[Row]:
    """Errors on windows of the trials it is judged by; what diverged has none."""
    rows: list[Row] = []
    for role, scores in result.scores.items():
        for kind, of in by_manoeuvre(scores).items():
            rows.append({"trials": ROLES[role], **_off(kind, of, result.task.sigma)})
    return rows


def _off(kind: str, scores: Sequence[TrialScore], sigma: Mapping[str, float]) -> Row:
    """Root mean squares over members, whose errors are averaged as a report does, and L_MSE with its deviation."""
    members = by_member(scores)
    errors = [L_MSE(of) for of in members]
    mean = sum(errors) / len(errors)
    spread = (sum((one - mean) ** 2 for one in errors) / (len(errors) - 1)) ** 0.5 if len(errors) > 1 else None
    off = off_by(scores, sigma)
    return {
        "manoeuvre": kind,
        "runs": len(by_run(scores)),
        "off track [m]": finite(off["position_rms_m"]),
        "off heading [deg]": finite(off["heading_rms_deg"]),
        "L_MSE": finite(mean),
        "deviation": None if spread is None else finite(spread),
    }


def _members(result: Learned | LearnedEnsemble, model: Predictor) -> Mapping[str, list[Line]]:
    """The trials it is judged by, or windows of them, as measured and as each network has them."""
    pieces = pieces_of(result.task.by_role[result.role], result.task.options.restart)
    found = {one.id: [measured(one)] for one in pieces}
    for run in motions(model, pieces):
        if not run.diverged:
            lines = found[run.id]
            words = f"{model.n_members} networks" if model.n_members > 1 else "network"
            line = simulated(run, words if len(lines) == 1 else "")
            lines.append(Line(line.words, "member" if model.n_members > 1 else line.kind, line.t, line.columns))
    return found


def hybrid(result: LearnedHybrid) -> View:
    """A row a kind of manoeuvre of runs that were not learned from: errors without the network and with it."""
    rows: list[Row] = [
        {
            "trials": ROLES["validation"],
            "manoeuvre": one.manoeuvre,
            "runs": one.runs,
            "off track without [m]": None,
            "off track with [m]": None,
            "L_MSE without": one.before,
            "L_MSE with": one.after,
            "share removed": one.share,
        }
        for one in result.gains
    ]
    if result.scores:
        before, after = (by_manoeuvre(result.scores[which]) for which in ("before", "after"))
        for kind in before:
            off = [off_by(of[kind], result.sigma)["position_rms_m"] for of in (before, after)]
            errors = [L_MSE(of[kind]) for of in (before, after)]
            rows.append(
                {
                    "trials": ROLES["test"],
                    "manoeuvre": kind,
                    "runs": len(by_run(before[kind])),
                    "off track without [m]": finite(off[0]),
                    "off track with [m]": finite(off[1]),
                    "L_MSE without": finite(errors[0]),
                    "L_MSE with": finite(errors[1]),
                    "share removed": finite(1.0 - errors[1] / errors[0]) if errors[0] else None,
                }
            )
    says = [hybrid_page.verdict(result.to_dict())]
    return View(repr(result), says, rows, result.warnings, motions=lambda: _beside(result))


def _beside(result: LearnedHybrid) -> Mapping[str, list[Line]]:
    """Trials held out, or else kept back, or windows of them: measured, by forces alone, and with the network."""
    pieces = pieces_of(result.test or result.splits[0].choose, result.options.restart)
    models = {"forces alone": as_predictor(result.hybrid.profile), "hybrid": HybridPredictor(result.hybrid)}
    return alongside(pieces, {name: (one, None) for name, one in models.items()})


def mixture(result: LearnedMixture) -> View:
    """A row a share that was tried: its errors over those of the model of forces, and L_MSE by kind of manoeuvre."""
    kinds = list(dict.fromkeys(kind for one in result.tried for kind in one.errors))
    several = any(one.network is not None for one in result.tried)
    rows: list[Row] = [
        {
            "share": one.share,
            **({"networks": one.network} if several else {}),
            "error": finite(one.score),
            **{f"L_MSE {kind or 'not stated'}": finite(one.errors[kind]) for kind in kinds},
            "kept": "yes" if (one.share, one.network) == (result.share, result.network) else "",
        }
        for one in result.tried
    ]
    return View(repr(result), [result.sentence()], rows, [*result.warnings, *result.notes])
