"""Channels that stand still while the ship moves are told; whole ones are not."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.trial import check_trial, load_trials

SUZAKU = load_trials("suzaku").trials


def codes(trial):
    return [one.code for one in check_trial(trial) if one.code in ("constant", "held")]


@pytest.mark.parametrize("name", SUZAKU)
def test_the_bundled_trials_have_none(name):
    assert codes(SUZAKU[name]) == []


def test_a_sway_that_was_filled_in_is_told():
    trial = SUZAKU["turn_p35"]
    assert codes(replace(trial, v_m=0.0 * trial.v_m)) == ["constant"]


def test_positions_held_between_updates_are_told():
    trial = SUZAKU["turn_p35"]
    last = 6 * (np.arange(trial.n_samples) // 6)
    held = replace(trial, x=trial.x[last], y=trial.y[last], u=trial.u[last])
    (found,) = [one for one in check_trial(held) if one.code == "held"]
    assert found.what == "'x', 'y' and 'u' stand still between updates, 6 s apart"
    assert codes(replace(trial, x=np.round(trial.x), y=np.round(trial.y))) == []  # few digits
