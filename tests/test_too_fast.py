"""Speeds that no ship makes: one rule for approaches that are ordered, for profiles and for trials."""

import math
from dataclasses import replace

import pytest

import mmgtune
from mmgtune.components import speeds
from mmgtune.errors import OptionError
from mmgtune.orders.possible import possible_approach
from mmgtune.trial import check_trial


def refuses_order(speed: float, L_pp: float) -> bool:
    try:
        possible_approach(speed, None, L_pp, None)
    except OptionError:
        return True
    return False


def doubts_trial(speed: float, L_pp: float) -> bool:
    trial = next(iter(mmgtune.load_trials("suzaku").trials.values()))
    fast = replace(trial, u=trial.u * 0.0 + speed, v_m=trial.v_m * 0.0)
    return any("Froude number" in one.why for one in check_trial(fast, L_pp))


@pytest.mark.parametrize("froude", [1.0, 0.7])
def test_all_hold_the_same_limit(froude, monkeypatch):
    monkeypatch.setattr(speeds, "FROUDE", froude)
    L_pp = 100.0
    limit = froude * math.sqrt(9.81 * L_pp)
    for tells in (refuses_order, doubts_trial):
        assert (tells(0.99 * limit, L_pp), tells(1.01 * limit, L_pp)) == (False, True), tells
