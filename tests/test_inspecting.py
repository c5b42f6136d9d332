"""What trials hold, by the library."""

from dataclasses import replace

import pytest

import mmgtune
from tests.command import run

TRIALS = mmgtune.load_trials("suzaku")


def test_what_the_command_prints_is_what_the_library_finds(tmp_path):
    found = mmgtune.inspect_trials("suzaku")
    assert run("trials", "inspect", "suzaku", "--json", cwd=tmp_path).json() == found.to_dict()
    assert found.L_pp == mmgtune.load_profile("suzaku").L_pp
    assert [row["id"] for row in found.rows] == list(TRIALS.trials)
    assert found.notes == ()


def test_the_length_is_that_of_the_profile_and_another_ship_is_said():
    found = mmgtune.inspect_trials(TRIALS["turn_p35"], "kvlcc2")
    assert found.L_pp == 320.0
    (note,) = found.notes
    assert "'suzaku'" in note
    (own,) = mmgtune.inspect_trials(TRIALS["turn_p35"]).rows
    (row,) = found.rows
    lengths = own["indices"]["advance_over_L"] / row["indices"]["advance_over_L"]
    # The course of the approach, which the advance is along, is a mean over a way that is counted in lengths too.
    assert lengths == pytest.approx(320.0 / mmgtune.load_profile("suzaku").L_pp, rel=1e-3)


def test_trials_of_a_ship_that_nobody_knows_need_a_profile():
    for ship in ("Ever Given", ""):
        with pytest.raises(mmgtune.MmgtuneError, match="ship lengths") as caught:
            mmgtune.inspect_trials(replace(TRIALS["turn_p35"], ship=ship))
        assert "profile=NAME" in caught.value.problems[0].fix
