"""A hull that is further off than its profile is believed to be is no cause, and a cause is no such hull."""

from types import SimpleNamespace

import pytest

from mmgtune.diagnose import diagnose
from mmgtune.diagnose.bench.of_hull import PARTLY, explained_by_hull, in_words
from mmgtune.effects import find_effect
from mmgtune.options import DiagnoseOptions
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials
from tests.hidden.plant import simulate, write

OFF = {
    "hull.X_vv": 0.90,
    "hull.X_vr": 0.84,
    "hull.X_rr": 0.75,
    "hull.Y_v": 1.25,
    "hull.Y_r": 1.15,
    "hull.Y_vvv": 0.76,
    "hull.Y_vvr": 0.81,
    "hull.Y_vrr": 0.83,
    "hull.N_v": 1.10,
    "hull.N_r": 1.23,
    "hull.N_vvv": 0.86,
    "hull.N_vvr": 1.21,
    "hull.N_vrr": 1.24,
    "hull.N_rrr": 0.82,
}
"""Factors on the coefficients of a hull that is known worse than to 5 %."""


def diagnosed(folder, hidden, asked=("loading", "shallow-water", "gyro-bias"), **ship):
    profile = load_profile("suzaku")
    write(simulate({name: factor * profile.value(name) for name, factor in ship.items()}, hidden, seed=5), folder)
    return diagnose(profile, load_trials(folder), DiagnoseOptions(effects=asked))


def test_a_hull_far_off_is_no_loading(tmp_path):
    result = diagnosed(tmp_path, {}, **OFF)
    assert result.verdict == "none"
    (trace,) = result.traces
    assert trace.cause.tag == "loading"
    assert trace.contribution.like_hull
    assert "a hull further off than believed would explain as well" in result.sentence()
    assert "a hull further off than believed would explain it as well" in trace.sentence
    assert any("leeway=0.1" in note for note in result.warnings)
    assert not result.sentence().startswith("Nothing is wrong")  # it fits, by a hull that is far off


@pytest.mark.long
def test_a_loading_is_no_hull(tmp_path):
    result = diagnosed(tmp_path, {"loading": {"draught": 0.9}})
    assert [cause.tag for cause in result.causes] == ["loading"]
    (brought,) = [one for _, one in result.contributions]
    assert 0.0 < brought.of_hull < PARTLY
    assert not any("leeway" in note for note in result.warnings)


IN_SHALLOW_WATER = {
    "particulars.m_y_": 1.45,
    "particulars.J_zz_": 1.3,
    "hull.R_0": 1.17,
    "hull.Y_v": 1.45,
    "hull.Y_r": 1.4,
    "hull.N_v": 1.35,
    "hull.N_r": 1.25,
    "hull.Y_vvv": 1.4,
    "hull.N_vvv": 1.4,
}
"""Factors of formulas other than the program's, at 1.3 draughts."""


@pytest.mark.long
def test_a_ship_with_the_added_mass_of_no_ship_sailed_in_shallow_water(tmp_path):
    """A hull so far off tells test trials as well, and was "nothing wrong": of the ship and not of the water."""
    result = diagnosed(tmp_path, {}, ("shallow-water", "gyro-bias"), **IN_SHALLOW_WATER)
    assert [cause.tag for cause in result.causes] == ["shallow-water"]
    (brought,) = [one for _, one in result.contributions]
    assert brought.unlike_any.startswith("added mass in sway (m_y_)")
    assert "ithout shallow-water" in result.sentence()
    assert "as no ship has it" in result.sentence()


@pytest.mark.parametrize(
    ("share", "said"), [(0.3, ""), (0.6, "a hull 10 % off, beside the 5 % it was given, explains 60%"), (1.4, "100%")]
)
def test_what_a_hull_explains_is_told_from_half_on(share, said):
    told = in_words(SimpleNamespace(options=DiagnoseOptions()), "shallow-water", share)
    assert said in told
    assert bool(told) == bool(said)


def test_where_a_run_is_lost_without_a_cause_no_share_of_it_is_asked_for():
    """Of an infinite fall it would be no number, which no record of a diagnosis can hold."""
    bench = SimpleNamespace(believed=SimpleNamespace(leeway={"hull.Y_v": 0.05}))
    cause = SimpleNamespace(effect=find_effect("wind"), by="", instead=())
    assert explained_by_hull(bench, cause, SimpleNamespace(chi2=float("inf")), 1000.0) == 0.0
