"""The run folder of a training: the model, what is said of it, and checkpoints until it is complete."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from ..arrays import FloatArray
from ..files import write_text
from ..networks import NetworkPredictor, save_network
from ..simulation import simulate
from ..validation import by_manoeuvre, summary
from .run import Learned, pieces_of

RESULT = "learning.json"
MODEL = "model.safetensors"
CHECKPOINTS = "training-*.safetensors"

POINTS = 200
"""Points of a drawn track, about."""


def document_of(result: Learned) -> dict[str, Any]:
    """Everything but the weights, for JSON."""
    task = result.task
    return {
        "schema": 1,
        "kind": "learning",
        "ship": result.network.ship,
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
        "held_out": [trial.id for trial in task.test],
        "scores": {role: summary(scores) for role, scores in result.scores.items() if scores},
        "drawn": drawn_of(result),
        "options": task.options.to_dict(),
        "provenance": result.provenance,
        "interrupted": result.interrupted,
        "wall_s": result.wall_s,
    }


def drawn_of(result: Learned) -> list[dict[str, Any]]:
    """Of each kind of manoeuvre the window of median error, as measured and by all members: tracks [m].

    Of the trials held out where there are any, else of those that chose.
    """
    role = "test" if result.scores["test"] else "validation"
    trials = result.task.test if role == "test" else result.task.split.choose
    pieces = {piece.id: piece for piece in pieces_of(trials, result.task.options.restart)}
    found = []
    for kind, scores in by_manoeuvre(result.scores[role]).items():
        by_window: dict[str, float] = {}
        for one in scores:
            by_window[one.id] = by_window.get(one.id, 0.0) + one.L_MSE / result.network.n_members
        id = sorted(by_window, key=lambda name: by_window[name])[len(by_window) // 2]
        of = pieces[id]
        every = slice(None, None, max(1, of.n_samples // POINTS))
        members = [one.states for one in simulate(NetworkPredictor(result.network), [of]) if not one.diverged]
        found.append(
            {
                "id": id,
                "manoeuvre": kind,
                "role": role,
                "L_MSE": float(by_window[id]) if math.isfinite(by_window[id]) else None,
                "measured": _track(of.motion[every]),
                "members": [_track(states[every]) for states in members],
            }
        )
    return found


def _track(states: FloatArray) -> dict[str, list[float | None]]:
    """North and east [m] to the centimetre; null in gaps."""
    return {
        name: [round(float(v), 2) if math.isfinite(v) else None for v in column]
        for name, column in (("north_m", states[:, 0]), ("east_m", states[:, 1]))
    }


def write_learned(result: Learned, folder: Path) -> dict[str, Any]:
    """Write a run folder, the record last; checkpoints stay where the training was stopped.  Returns the record."""
    save_network(result.network, folder / MODEL, overwrite=True)
    document = {**document_of(result), "out": str(folder)}
    write_text(folder / RESULT, json.dumps(document, indent=1, allow_nan=False, ensure_ascii=False) + "\n")
    if not result.interrupted:
        for path in folder.glob(CHECKPOINTS):
            path.unlink()
    return document
