"""The run folder of a training: the model, what is said of it, and checkpoints until it is complete."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..files import write_text
from ..networks import save_network
from ..validation import summary
from .run import Learned

RESULT = "learning.json"
MODEL = "model.safetensors"
CHECKPOINTS = "training-*.safetensors"


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
        "options": task.options.to_dict(),
        "provenance": result.provenance,
        "interrupted": result.interrupted,
        "wall_s": result.wall_s,
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
