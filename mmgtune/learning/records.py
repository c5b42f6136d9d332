"""What a training leaves in its record: everything but the weights, and some motions to be drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..arrays import FloatArray
from ..documents import finite_values
from ..motions import simulate_trials
from ..networks import EnsemblePredictor, HybridPredictor, NetworkPredictor
from ..objective import spread
from ..predictor import Predictor, as_predictor
from ..scores import score, summary
from ..trial import Trial
from .choosing import pieces_of
from .reading import read_network

if TYPE_CHECKING:
    from .ensemble_run import LearnedEnsemble
    from .hybrid_run import LearnedHybrid
    from .run import Learned

POINTS = 200
"""Points of a drawn motion, about."""

POSITIONS = ("north_m", "east_m")
SHOWN = (*POSITIONS, "psi_rad", "u_m_s", "v_m_s", "r_rad_s")
"""Columns of drawn motions, in the order of the states."""


def of_networks(result: Learned) -> dict[str, Any]:
    """Everything but the weights, for JSON."""
    task = result.task
    return {
        "schema": 1,
        "kind": "learning",
        "ship": result.network.ship,
        "L_pp": result.network.L_pp,
        "type": task.options.type,
        "recipe": task.recipe.words,
        "width": result.network.width,
        "memory": result.network.memory,
        "step_s": result.network.step,
        "inputs": list(result.network.inputs),
        "window_s": task.options.restart,
        "sigma": task.sigma,
        "members": [one.to_dict() for one in result.members],
        "learned_from": [trial.id for trial in task.split.learn],
        "chosen_by": [trial.id for trial in task.split.choose],
        **_outcome(result, NetworkPredictor(result.network)),
    }


def of_hybrid(result: LearnedHybrid) -> dict[str, Any]:
    """Everything but the weights of a hybrid, for JSON."""
    trials = result.test or result.splits[0].choose
    models = [as_predictor(result.hybrid.profile), HybridPredictor(result.hybrid)]
    return {
        "schema": 1,
        "kind": "hybrid",
        "ship": result.hybrid.profile.id,
        "L_pp": result.hybrid.profile.L_pp,
        "gained": result.gained,
        "penalty": result.penalty,
        "updates": result.step,
        "lag_s": result.hybrid.memory,
        "step_s": result.step_s,
        "window_s": result.options.restart,
        "sigma": result.sigma,
        "gains": [one.to_dict() for one in result.gains],
        "tried": [
            {"penalty": penalty, "curve": [finite_values(row) for row in rows]}
            for penalty, rows in result.tried.items()
        ],
        "reading": _reading(result),
        "parts": [[trial.id for trial in split.choose] for split in result.splits],
        "held_out": [trial.id for trial in result.test],
        "scores": {which: summary(scores) for which, scores in result.scores.items()},
        "drawn": drawn(models, trials, result.options.restart, "test" if result.test else "validation"),
        "options": result.options.to_dict(),
        "warnings": list(result.warnings),
        "provenance": result.provenance,
        "events": list(result.events),
        "interrupted": result.interrupted,
        "wall_s": result.wall_s,
    }


def of_ensemble(result: LearnedEnsemble) -> dict[str, Any]:
    """Everything but the weights of an ensemble, for JSON."""
    task, part = result.task, result.ensemble.motion
    return {
        "schema": 1,
        "kind": "ensemble",
        "ship": result.ensemble.ship,
        "L_pp": result.ensemble.L_pp,
        "layers": part.n_layers,
        "width": part.width,
        "initial": result.ensemble.initial,
        "noise": dict(zip(("u", "v_m", "r"), task.noise.tolist(), strict=True)),
        "horizon_s": task.options.horizon * result.ensemble.step,
        "step_s": result.ensemble.step,
        "inputs": list(result.ensemble.inputs),
        "window_s": task.options.restart,
        "sigma": task.sigma,
        "members": [one.to_dict() for one in result.members],
        "learned_from": [trial.id for trial in task.split.learn],
        "watched_by": [trial.id for trial in task.split.choose],
        **_outcome(result, EnsemblePredictor(result.ensemble)),
    }


def _outcome(result: Learned | LearnedEnsemble, predictor: Predictor) -> dict[str, Any]:
    """How well what was trained does, and what it was trained with."""
    task = result.task
    return {
        "held_out": [trial.id for trial in task.test],
        "scores": {role: summary(scores) for role, scores in result.scores.items()},
        "drawn": drawn([predictor], task.by_role[result.role], task.options.restart, result.role),
        "options": task.options.to_dict(),
        "warnings": list(result.warnings),
        "provenance": result.provenance,
        "interrupted": result.interrupted,
        "wall_s": result.wall_s,
    }


def _reading(result: LearnedHybrid) -> dict[str, Any] | None:
    """What the network says along the runs it was trained on, None where there is none."""
    if not result.gained:
        return None
    split = result.splits[0]
    return read_network(result.hybrid, (*split.learn, *split.choose), restart=result.options.restart).to_dict()


def drawn(
    models: Sequence[Predictor], trials: Sequence[Trial], restart: float | None, role: str
) -> list[dict[str, Any]]:
    """Of each kind of manoeuvre the window of median error of the last model: motions as measured, and as all members
    of all models make them."""
    pieces = pieces_of(trials, restart)
    sigma = spread(trials)
    errors: dict[str, float] = {}
    for one in score(models[-1], pieces, sigma):
        errors[one.id] = errors.get(one.id, 0.0) + one.L_MSE / models[-1].n_members
    found = []
    for kind in dict.fromkeys(piece.manoeuvre for piece in pieces):
        several = sorted((piece for piece in pieces if piece.manoeuvre == kind), key=lambda piece: errors[piece.id])
        of = several[len(several) // 2]
        every = slice(None, None, max(1, of.n_samples // POINTS))
        found.append(
            {
                "id": of.id,
                "manoeuvre": kind,
                "role": role,
                "L_MSE": errors[of.id] if math.isfinite(errors[of.id]) else None,
                "t_s": [round(float(t), 3) for t in of.t[every] - of.t[0]],
                "measured": _motion(of.motion[every]),
                "members": [
                    _motion(motion.states[every])
                    for model in models
                    for motion in simulate_trials(model, [of])
                    if not motion.diverged
                ],
            }
        )
    return found


def _motion(states: FloatArray) -> dict[str, list[float | None]]:
    """States by name: positions to the centimetre, the rest to five digits; null in gaps."""
    return {
        name: [_short(float(v), name) if math.isfinite(v) else None for v in column]
        for name, column in zip(SHOWN, states.T, strict=True)
    }


def _short(value: float, name: str) -> float:
    return round(value, 2) if name in POSITIONS else float(f"{value:.5g}")
