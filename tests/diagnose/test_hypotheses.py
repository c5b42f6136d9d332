"""Which causes a diagnosis looks for: those that act on what trials have measured, or what stands in for it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.diagnose.bench.hypotheses import known_causes, not_looked_for, of_runs
from mmgtune.diagnose.searching.refitting import akin
from mmgtune.diagnose.searching.search import _left
from mmgtune.options import DiagnoseOptions
from mmgtune.profile import load_profile, parse_profile, with_effects
from mmgtune.trial import load_trials

MEASURED = {
    "wind": ("wind_speed", "wind_dir"),
    "current": ("current_speed", "current_dir"),
    "waves": ("wave_height", "wave_dir"),
    "shallow-water": ("depth",),
}


@pytest.fixture(scope="module")
def trials():
    return list(load_trials("suzaku").trials.values())[:2]


def variants(trials, tag, profile="suzaku"):
    found = known_causes(load_profile(profile), trials, DiagnoseOptions())
    return [one.variant for one in found if one.tag == tag]


@pytest.mark.parametrize("tag", MEASURED)
def test_measured_in_any_trial_is_what_is_looked_for(trials, tag):
    n = trials[0].n_samples
    seen = replace(trials[0], extra={name: np.full(n, 6.0) for name in MEASURED[tag]})
    turned = [("turned",), ("measured", "turned")] if tag in ("wind", "current") else []  # not aligned
    assert variants([seen, trials[1]], tag) == [("measured",), *turned]
    others = [other for other in MEASURED if other != tag]
    assert all(("measured",) not in variants([seen, trials[1]], other) for other in others)


def test_without_columns_the_constants_are(trials):
    assert variants(trials, "wind") == [("speed", "direction")]
    tide = ("north", "east", "north_rate", "east_rate")
    assert variants(trials, "current") == [("north", "east"), tide, (*tide, "carried")]
    assert variants(trials, "shallow-water") == [("depth",)]
    assert variants(trials, "waves") == []


def test_what_a_crew_and_the_day_change_is_looked_for_run_by_run_too():
    several = list(load_trials("suzaku").trials.values())[:4]
    found = known_causes(load_profile("suzaku"), several, DiagnoseOptions())
    by_run = {one.tag for one in of_runs(found, several)}
    assert {"current", "wind", "rudder-offset", "heading-bias", "gyro-bias", "clock-offset", "loading"} <= by_run
    assert not {"antenna", "memory", "flap"} & by_run


def test_a_wind_nobody_measured_is_looked_for_though_a_measured_one_would_act(trials):
    assert load_profile("esso_osaka").value("effects.wind.measured") == 1.0
    assert variants(trials, "wind", "esso_osaka") == [("speed", "direction")]


def test_what_acts_much_like_the_best_is_fitted_too(trials):
    known = known_causes(load_profile("suzaku"), trials, DiagnoseOptions())
    by_tag = {one.tag: SimpleNamespace(hypothesis=one, power=1.0) for one in known}
    order = list(by_tag.values())

    def beside(best, *others):
        fitted = [(by_tag[tag], SimpleNamespace(chi2=2.0 + k)) for k, tag in enumerate((best, *others))]
        return [score.hypothesis.tag for score in akin(order, fitted, 100.0)]

    assert beside("wave-drift", "current") == ["wind"]
    assert beside("wind") == ["wave-drift"]
    assert beside("wave-drift", "wind") == []
    assert beside("current", "wave-drift") == []
    by_tag["wind"].power = 0.0
    assert beside("wave-drift") == []
    assert akin(order, [], 100.0) == []


def test_a_form_with_more_parameters_is_fitted_beside_one_that_explains_much(trials):
    known = known_causes(load_profile("suzaku"), trials, DiagnoseOptions())
    order = [SimpleNamespace(hypothesis=one, power=0.0) for one in known]

    def beside(left):
        fitted = [
            (score, SimpleNamespace(chi2=left.get(score.hypothesis.label)))
            for score in order
            if score.hypothesis.label in left
        ]
        return [score.hypothesis.label for score in akin(order, fitted, 100.0)]

    assert beside({"flap": 10.0, "rudder-gain (factor)": 40.0}) == ["rudder-gain (factor, curve)"]
    assert beside({"flap": 10.0, "rudder-gain (factor)": 60.0}) == []
    assert beside({"flap": 10.0, "rudder-gain (factor)": 40.0, "rudder-gain (factor, curve)": 30.0}) == []


def test_what_the_profile_has_already_is_looked_for_from_there(trials):
    """A log of another sense or unit, or a zero error of another day, was never asked for where the profile had it."""
    n = trials[0].n_samples
    seen = replace(trials[0], extra={name: np.full(n, 0.5) for name in MEASURED["current"]})
    own = with_effects(load_profile("suzaku"), {"current": {"measured": 1.0}}, "a test")
    stated = {one.variant: one.stated for one in known_causes(own, [seen], DiagnoseOptions()) if one.tag == "current"}
    assert stated == {("measured",): True, ("turned",): False, ("measured", "turned"): True}
    several = list(load_trials("suzaku").trials.values())[:4]
    own = with_effects(load_profile("suzaku"), {"current": {"north": 0.2}}, "a test")
    known = known_causes(own, several, DiagnoseOptions())
    assert all(one.stated for one in known if one.tag == "current")
    assert "current" not in {one.tag for one in of_runs(known, several)}  # one for all, as the profile has it


def test_what_a_profile_has_no_section_for_is_said():
    assert not_looked_for(load_profile("suzaku"), ()) == []
    model = load_profile("kvlcc2_l7")
    assert not_looked_for(model, ()) == ["wind was not looked for: the profile has no [above_water]"]
    assert not_looked_for(model, ("current",)) == []
    assert not_looked_for(load_profile("vectwin_3m"), ()) == []  # another propeller is no section that is missing


def test_what_refines_a_cause_is_looked_for_beside_it_only():
    """Of a tide how it carries a ship along: no trial shows that before a tide is known."""
    known = known_causes(load_profile("suzaku"), list(load_trials("suzaku").trials.values())[:2], DiagnoseOptions())
    tide = next(one for one in known if one.variant == ("north", "east", "north_rate", "east_rate"))
    (refining,) = (one for one in known if one.refines)
    assert set(refining.variant) == {*tide.variant, "carried"}
    for causes, there in (((), False), ((tide,), True), ((next(one for one in known if one.tag == "memory"),), False)):
        assert (refining in _left(known, SimpleNamespace(causes=causes), ())) == there


def test_a_current_that_carries_ships_along_as_theory_has_it_can_be_stated():
    """Its share of 1 was refused as too large."""
    stated = with_effects(load_profile("suzaku"), {"current": {"north": 0.1, "carried": 1.0}}, "a test")
    assert parse_profile(stated.text, "stated.toml").value("effects.current.carried") == 1.0


def test_the_other_part_of_a_form_is_looked_for_with_the_part_that_is_known(trials):
    """A vane that is off beside the wind it measures was looked for as a third cause, of which nothing was left: a
    traceback."""
    n = trials[0].n_samples
    seen = replace(trials[0], extra={name: np.full(n, 0.5) for name in MEASURED["wind"]})
    known = known_causes(load_profile("suzaku"), [seen], DiagnoseOptions(effects=("wind", "steering-lag")))

    def left(*variant):
        causes = [one for one in known if one.variant == variant]
        return [one.variant for one in _left(known, SimpleNamespace(causes=causes), ()) if one.tag == causes[0].tag]

    assert left("measured") == [("measured", "turned")]
    assert left("measured", "turned") == []
    assert ("time_constant", "rate_limit") in left("rate_limit")
    assert ("time_constant",) not in left("rate_limit")


def test_what_may_differ_between_runs_is_looked_for_by_run():
    """Of a receiver late in one run a compass was told, as latency had one value for all runs."""
    trials = list(load_trials("suzaku").trials.values())[:4]
    known = known_causes(load_profile("suzaku"), trials, DiagnoseOptions())
    differing = {name for one in of_runs(known, trials) for name in one.bases}
    for name in (
        "position-latency.seconds",
        "position-latency.with_velocity",
        "gyro-scale.factor",
        "speed-scale.factor",
    ):
        assert f"effects.{name}" in differing
    assert "effects.gyro-scale.curve" not in differing
