"""Trials that hold little: the answer has no number that is none, and what cannot be told is left out."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from mmgtune import DiagnoseOptions, diagnose, load_trials
from mmgtune.trial import Trial

ATTRIBUTES = ("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta")


def short(trial: Trial) -> Trial:
    """The first minute."""
    return replace(trial, **{name: getattr(trial, name)[:60] for name in ATTRIBUTES})


def straight(trial: Trial) -> Trial:
    """Steady speed to the north without a trace of noise."""
    still = {name: np.zeros(trial.n_samples) for name in ("y", "psi", "v_m", "r", "delta")}
    u, n = np.full(trial.n_samples, 3.0), np.full(trial.n_samples, 1.7)
    return replace(trial, **still, x=3.0 * trial.t, u=u, n=n)


@pytest.mark.parametrize("made", [short, straight], ids=["short", "straight and free of noise"])
def test_every_number_of_the_answer_is_one(made):
    trials = load_trials("suzaku")
    few = {name: made(trials.trials[name]) for name in ("turn_p35", "turn_m40")}
    result = diagnose(
        "suzaku", replace(trials, trials=few, tune=tuple(few), test=()), DiagnoseOptions(effects=("current",))
    )
    said = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    assert said["verdict"] in ("none", "found")
    assert "forces_before" not in said["evidence"] or made is not short
