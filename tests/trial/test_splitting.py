"""Which trials a suggested split tests."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest

from mmgtune.trial import load_trials
from mmgtune.trial.splitting import suggested_split


@pytest.fixture(scope="module")
def trials():
    """Turns of 10, 20, 35 and 40 deg to both sides, zigzags 10/10 and 20/20."""
    return load_trials("suzaku").trials


def kinds(ids):
    return Counter(id.partition("_")[0] for id in ids)


def test_turns_to_both_sides_and_a_zigzag_are_tested(trials):
    tune, test = suggested_split(list(trials.values()))
    assert test == ("turn_m10", "turn_p10", "zigzag_10")
    assert sorted([*tune, *test]) == sorted(trials)


def test_a_turn_and_a_zigzag_of_four_are_tested(trials):
    """It was one zigzag alone: nothing told how the tuning turns."""
    names = ("turn_m20", "turn_p35", "zigzag_10", "zigzag_20")
    tune, test = suggested_split([trials[name] for name in names])
    assert tune == ("turn_p35", "zigzag_20")
    assert test == ("turn_m20", "zigzag_10")


def test_logs_that_name_no_manoeuvre_are_told_by_their_rudder(trials):
    """Two turns and two zigzags of a ship's log: both turns tuned, and both zigzags tested."""
    names = ("turn_p35", "turn_m35", "zigzag_20", "zigzag_10")
    tune, test = suggested_split([replace(trials[name], manoeuvre="") for name in names])
    assert tune == ("turn_m35", "zigzag_20")
    assert test == ("turn_p35", "zigzag_10")


def test_pieces_of_a_run_stay_together(trials):
    def cut(name, run):
        return replace(trials[name], cut_from=run)

    alone = trials["turn_m20"]
    day = [cut("turn_p35", "day"), cut("turn_p20", "day"), cut("zigzag_20", "day")]
    assert suggested_split([*day, alone])[1] == ("turn_m20",)
    assert suggested_split([*day, cut("turn_m10", "other"), cut("zigzag_10", "other")])[1] == ("turn_m10", "zigzag_10")
    assert suggested_split(day) == (("turn_p35", "turn_p20", "zigzag_20"), ())


@pytest.mark.parametrize(
    ("names", "tested"),
    [
        (("turn_p35",), ()),
        (("turn_p35", "zigzag_20"), ("zigzag_20",)),
        (("turn_p35", "turn_m35", "zigzag_20"), ("turn_p35",)),
        (("turn_p10", "turn_p20", "turn_m35"), ("turn_p10",)),
        (("turn_p10", "turn_p20", "turn_m10", "turn_m20"), ("turn_p10", "turn_m10")),
        (("zigzag_10", "zigzag_20"), ("zigzag_10",)),
    ],
)
def test_no_kind_is_left_without_trials_to_tune_to(trials, names, tested):
    tune, test = suggested_split([trials[name] for name in names])
    assert set(test) == set(tested)
    assert len(tune) >= len(test)
    if len(names) > 2:
        assert set(kinds(tune)) == set(kinds(names))
