"""What differs from run to run is named as such, with the values of the runs; what does not is one for all."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.cli.diagnose import summary
from mmgtune.diagnose import DiagnoseOptions, diagnose, write_diagnosis
from mmgtune.diagnose.bench.hypotheses import Hypothesis
from mmgtune.diagnose.causes.by_run import ByRun
from mmgtune.diagnose.searching.refitting import Refitting
from mmgtune.diagnose.signatures.intervals import Estimate
from mmgtune.diagnose.signatures.intervals import _apart as apart_of
from mmgtune.diagnose.signatures.wording import quantity, range_in_words
from mmgtune.effects import find_effect
from mmgtune.effects.signs import UNLIMITED
from mmgtune.motions import simulate_trials
from mmgtune.profile import load_profile, parse_profile, with_effects
from mmgtune.report import render
from mmgtune.trial import load_trials
from mmgtune.units import DEG
from tests.diagnose.beliefs import belief_with
from tests.diagnose.sensors import logged
from tests.hidden.cases import Case, of_one_run, of_runs, tide
from tests.hidden.plant import NAMES, TUNING, simulate, write

pytestmark = pytest.mark.xdist_group("by run")

FEW = ("hull.R_0", "wake.w_P0", "rudder.eps", "rudder.gamma_Rp", "rudder.gamma_Rn")
"""Targets: the ship is the profile's own but for what is hidden, and a test has to end."""


def said_of(case: Case, folder, effects):
    """The diagnosis of the profile's ship with what differs between the runs of a case, from her files."""
    write(simulate({}, case.effects, case.seed, case.noise, case.of_trial), folder)
    options = DiagnoseOptions(effects=effects, targets=FEW)
    return diagnose(load_profile("suzaku"), load_trials(folder), options)


def misses(found, case, tag):
    """Differences to the truth in standard errors."""
    return [
        (one.value - case.of_trial.get(name, {}).get(tag, {}).get(parameter, 0.0)) / one.stderr
        for label, values in zip(found.groups, found.values, strict=True)
        for name in [label.removeprefix("trial:")]
        for parameter, one in values.items()
    ]


@pytest.fixture(scope="module")
def currents(tmp_path_factory):
    """A current of 0.35 m/s, towards another direction in each trial."""
    case = of_runs("current", 3, seed=1)
    return case, said_of(case, tmp_path_factory.mktemp("trials"), ("current", "rudder-offset"))


def test_another_current_in_each_run(currents):
    case, result = currents
    (cause,) = result.causes
    assert (result.verdict, cause.tag, cause.runs.by) == ("found", "current", "trial")
    assert cause.runs.groups == tuple(f"trial:{name}" for name in sorted(TUNING))
    off = np.abs(misses(cause.runs, case, "current"))
    assert np.sum(off < 1.96) >= 8
    assert off.max() < 3.5
    assert cause.runs.size(0)[0] == pytest.approx(0.35, abs=0.01)
    assert "The current differed from run to run: 0.35 m/s, towards no common direction." in result.sentence()


def test_runs_held_out_are_judged_on_what_follows_their_first_part(currents):
    _, result = currents
    assert result.gain.first_part == 0.4
    assert result.gain.share_removed > 0.99
    document = result.to_dict()
    assert document["gain"]["of_single_runs"]["estimated_on_first_share_of_run"] == 0.4
    assert "first 40 % of each run" in document["sentence"]
    assert document["gain"]["J_test_after"] < 0.05 * document["gain"]["J_test_before"]


def test_the_profile_keeps_nothing_of_a_run_and_the_record_all(currents, tmp_path):
    case, result = currents
    profile = parse_profile(result.extended_profile().text)
    assert "effects.current" not in profile.sections
    document = json.loads(json.dumps(write_diagnosis(result, tmp_path / "run"), allow_nan=False))
    (cause,) = document["causes"]
    assert cause["parameters"] == {}
    assert [row["trials"] for row in cause["by_run"]["values"]] == [[name] for name in sorted(TUNING)]
    for row in cause["by_run"]["values"]:
        truth = case.of_trial[row["group"]]["current"]
        towards = math.degrees(math.atan2(truth["east"], truth["north"]))
        assert abs(math.remainder(row["direction_deg"] - towards, 360.0)) < 4.0 * row["direction_stderr_deg"]
    render(tmp_path / "run")
    page = (tmp_path / "run" / "report.md").read_text().replace("\\", "")
    assert "| turn_m20 |" in page
    assert "differed from run to run" in page
    told = summary(result, "run", report=True)
    assert "calm water" not in told  # where no such profile is written
    (tmp_path / "run" / "calm.toml").write_text("")
    assert summary(result, f"{tmp_path}/run", report=True).endswith(f"of the day: {tmp_path}/run/calm.toml")
    assert [line.split()[0] for line in told.splitlines() if " m/s   " in line] == sorted(TUNING)


@pytest.mark.long
def test_a_current_that_hardly_differs_is_one_for_all(tmp_path):
    """A hundredth of it from run to run shows, and kept the whole current out of the profile."""
    strengths = dict(zip(NAMES, 0.45 + 0.006 * np.array([1, 1, -1, 1, 1, -1, -1, 1, -1, 1]), strict=True))
    of_trial = {name: {"current": {"north": -one, "east": 0.3 * one}} for name, one in strengths.items()}
    case = replace(of_runs("current", 3, seed=1), of_trial=of_trial)
    result = said_of(case, tmp_path, ("current",))
    (cause,) = result.causes
    assert result.verdict == "found"
    gains = {one.by: one.gain for one in result.candidates if one.parameters == ("north", "east")}
    assert gains["trial"] - gains[""] > 50.0
    assert cause.runs is None
    assert cause.estimates["effects.current.north"].value == pytest.approx(-0.45, abs=0.01)
    assert "effects.current" in parse_profile(result.extended_profile().text).sections


@pytest.mark.long
def test_a_current_in_one_run_only(tmp_path):
    case = of_one_run(seed=1)
    (name,) = case.of_trial
    result = said_of(case, tmp_path, ("current", "rudder-offset"))
    (cause,) = result.causes
    assert [cause.runs.shows(k) for k in range(5)] == [label == f"trial:{name}" for label in cause.runs.groups]
    assert f"in {name}, and none for certain in the other 4" in result.sentence()


@pytest.mark.long
def test_a_rudder_zero_that_differs(tmp_path):
    case = of_runs("rudder-offset", 3, seed=2)
    result = said_of(case, tmp_path, ("current", "rudder-offset"))
    (cause,) = result.causes
    assert (cause.tag, cause.runs.by) == ("rudder-offset", "trial")
    assert np.abs(misses(cause.runs, case, "rudder-offset")).max() < 3.5
    assert "The zero of the rudder differed from run to run" in result.sentence()


@pytest.mark.long
def test_a_rudder_that_stopped_half_way_in_one_run(tmp_path):
    """Of 35 deg to starboard she got 20, while the log holds the order."""
    case = of_runs("rudder-gain", 0, seed=5)
    case = replace(case, of_trial={"turn_p35": {"rudder-gain": {"factor": 20.0 / 35.0}}})
    result = said_of(case, tmp_path, ("rudder-gain", "rudder-offset", "rudder-stall"))
    (cause,) = result.causes
    assert (result.verdict, cause.tag, cause.runs.by) == ("found", "rudder-gain", "trial"), result.sentence()
    assert [cause.runs.shows(k) for k in range(5)] == [label == "trial:turn_p35" for label in cause.runs.groups]
    assert "The gain of the rudder differed from run to run: 0.5" in result.sentence()
    assert "in turn_p35, and none for certain in the other 4" in result.sentence()


@pytest.mark.long
def test_a_gyro_that_was_set_anew_for_each_run(tmp_path):
    case = of_runs("rudder-offset", 0, seed=3)
    off = dict(zip(sorted(TUNING), (3, -2, 0.5, -4, 1), strict=True))
    case = replace(case, of_trial={name: {"heading-bias": {"angle": angle * DEG}} for name, angle in off.items()})
    result = said_of(case, tmp_path, ("current", "heading-bias"))
    (cause,) = result.causes
    assert (result.verdict, cause.tag, cause.runs.by) == ("found", "heading-bias", "trial"), result.sentence()
    assert np.abs(misses(cause.runs, case, "heading-bias")).max() < 3.5
    assert "The error of the compass differed from run to run: -4 to 3°." in result.sentence()


@pytest.mark.long
def test_a_resistance_that_differs_though_it_is_a_target_too(tmp_path):
    """As between runs before and after docking: no one value of R_0 will do, and in no box."""
    case = of_runs("rudder-offset", 0, seed=1)
    fouled = {
        name: {"resistance": {"factor": factor}} for name, factor in zip(sorted(TUNING), (1, 1, 2, 2, 2), strict=True)
    }
    case = replace(case, of_trial=fouled)
    result = said_of(case, tmp_path, ("resistance", "hull-term", "rpm-scale"))
    (cause,) = result.causes
    assert (result.verdict, cause.tag, cause.runs.by) == ("found", "resistance", "trial"), result.sentence()
    sizes = [one.value for values in cause.runs.values for one in values.values()]
    assert sizes == pytest.approx([1, 1, 2, 2, 2], rel=0.05)


@pytest.mark.long
def test_a_current_that_changes_within_the_runs(tmp_path):
    case = tide(seed=1)
    result = said_of(case, tmp_path, ("current",))
    (cause,) = result.causes
    assert cause.runs.variant == ("north", "east", "north_rate", "east_rate")
    assert np.abs(misses(cause.runs, case, "current")).max() < 3.5
    assert "changed within a run by up to" in result.sentence()


@pytest.mark.long
def test_two_days_of_several_runs_are_told_apart_by_day(tmp_path):
    case = of_runs("current", 0, seed=1)
    first = {*sorted(TUNING)[:3], *sorted({*NAMES} - {*TUNING})[:3]}
    waters = ({"north": -0.1, "east": 0.1}, {"north": 0.25, "east": 0.2})
    case = replace(case, of_trial={name: {"current": waters[name in first]} for name in NAMES})
    write(simulate({}, case.effects, case.seed, case.noise, case.of_trial), tmp_path)
    trials = load_trials(tmp_path)
    of_day = {name: replace(one, group=f"day {2 - (name in first)}") for name, one in trials.trials.items()}
    options = DiagnoseOptions(effects=("current", "rudder-offset"), targets=FEW)
    result = diagnose(load_profile("suzaku"), replace(trials, trials=of_day), options)
    (cause,) = result.causes
    assert (cause.runs.by, cause.runs.variant) == ("group", ("north", "east"))
    said = result.sentence()
    assert "The current differed from group to group: 0.3" in said
    assert " m/s towards 039° in day 1 and 0.14" in said
    assert " m/s towards 135° in day 2." in said


def test_a_range_is_told_in_plain_numbers():
    assert range_in_words(586e3, 661e3, "N") == "590 to 660 kN"
    assert range_in_words(5.86, 6.61, "N") == "5.9 to 6.6 N"  # on a model ship
    assert quantity(6.10, 0.34, "N") == "6.10 ± 0.34 N"
    assert quantity(12e3, 340.0, "N m") == "12.00 ± 0.34 kN m"
    assert quantity(0.049552, 0.000098, "m/s") == "0.04955 ± 0.00010 m/s"
    assert quantity(0.050045, 0.000088, "m/s") == "0.05004 ± 0.00009 m/s"
    assert quantity(1.04031, 0.00065, "-") == "1.04031 ± 0.00065"
    assert quantity(0.00024, 0.00052, "m/s") == "0.00024 ± 0.00052 m/s"
    assert quantity(0.005 * DEG, 1e-4 * DEG, "rad/s") == "0.3000 ± 0.0060°/min"
    assert quantity(0.05 * DEG, 0.01 * DEG, "rad/s") == "0.050 ± 0.010°/s"
    assert quantity(math.inf, None, "N") == UNLIMITED
    assert range_in_words(0.2, 0.4, "m/s") == "0.2 to 0.4 m/s"
    assert range_in_words(0.947, 1.027, "-") == "0.95 to 1.03"
    assert range_in_words(0.87, 1.047, "-") == "0.87 to 1.05"
    assert range_in_words(0.3499, 0.3505, "m/s") == "0.35 m/s"


def by_run(tag, names, rows, given=None):
    """Values of runs, a row of estimates by parameter each."""
    labels = tuple(f"trial:run{k}" for k in range(len(rows)))
    ids = tuple((one,) for one in labels)
    return ByRun(find_effect(tag), names, "trial", labels, ids, tuple(rows), given or {})


def of_loading(values, stderr, apart):
    """Drafts of runs, each known to ``stderr``, and to ``apart`` beside the mean of all."""
    rows = [{"draught": Estimate("x", value, None, None, stderr, apart)} for value in values]
    return by_run("loading", ("draught",), rows)


def test_what_is_common_to_all_errors_is_told_once():
    found = of_loading((0.99, 0.81, 0.93), 0.03, 0.003)
    assert found.sentence == (
        "The loading differed from run to run: draught over the profile's 0.81 to 0.99, known to ± 0.0059 beside each "
        "other and to ± 0.059 all together"
    )
    assert found.table()[0] == ("run", "draught over the profile's", "from the mean")
    assert found.table()[1] == ("run0", "0.990 ± 0.059", "0.0800 ± 0.0059")
    row = found.to_dict()["values"][1]
    assert (row["from_mean"], row["from_mean_stderr"]) == (pytest.approx(-0.1), 0.003)


@pytest.mark.parametrize(("values", "may_be"), [((0.95, 1.1), True), ((0.69, 0.94), False)])
def test_one_hull_has_no_displacements_so_far_apart_at_a_draught(values, may_be):
    """Water of another depth in each run was 1.24 times the draught at 0.69 times the displacement."""
    effect = find_effect("loading")
    asked = Hypothesis(effect, ("displacement",), "trial", ("trial:a", "trial:b"))
    bench = SimpleNamespace(
        values=lambda _: dict(zip(asked.names, values, strict=True)),
        parameter=lambda _: effect.parameters["displacement"],
        model=SimpleNamespace(profile=load_profile("suzaku")),
    )
    assert Refitting(SimpleNamespace(bench=bench))._may_be_of_runs(asked, None) == may_be


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ((0.979, 1.06, 0.97, 0.975), "1.06 times the model's in run1 and 0.97 to 0.98 in the other 3"),
        ((0.92, 1.06, 0.98, 0.95), "0.92 to 1.06 times the model's"),
        ((0.98, 1.06), "0.98 to 1.06 times the model's"),
    ],
)
@pytest.mark.parametrize("apart", [0.003, None], ids=["known beside each other", "each known by itself"])
def test_one_run_that_is_off_beside_all_others_is_named(values, said, apart):
    rows = [{"factor": Estimate("x", value, None, None, 0.03 if apart else 0.003, apart)} for value in values]
    found = by_run("thrust", ("factor",), rows)
    assert f"The thrust of the propeller differed from run to run: {said}" in found.sentence


def test_values_that_differ_by_little_are_told_with_the_digits_that_show_it():
    """ "The gain of the rudder differed from run to run: 1, known to ± 0.0022"."""
    rows = [{"factor": Estimate("x", value, None, None, 0.005, 0.0006)} for value in (1.0015, 1.0067, 1.004, 1.003)]
    assert "differed from run to run: 1.002 to 1.007, known to" in by_run("rudder-gain", ("factor",), rows).sentence
    assert range_in_words(1.0, 1.004, "-") == "1"


def test_the_only_run_without_a_value_is_the_other_one():
    rows = [{"angle": Estimate("x", value * DEG, None, None, 0.04 * DEG)} for value in (1.0, 1.5, 0.01)]
    said = by_run("rudder-offset", ("angle",), rows).sentence
    assert said.endswith("1 to 1.5° in run0 and run1, and none for certain in the other one")


@pytest.mark.parametrize(("stderr", "apart"), [(0.003, None), (0.03, 0.003)], ids=["each by itself", "in step"])
def test_a_value_of_a_run_at_the_end_of_what_was_looked_for_is_said(stderr, apart):
    """One of the runs was another ship's: a loading of 1.4, and no word that it could be no more."""
    values = (0.95, 0.951, 1.4, 0.949)
    rows = [{"draught": Estimate("x", v, None, None, stderr, apart, at_end=v > 1.3)} for v in values]
    said = by_run("loading", ("draught",), rows).sentence
    assert "1.4 in run2 and 0.95 in the other 3" in said
    assert said.endswith("; in run2 it is at the end of what was looked for, and may lie beyond it")


def of_gains(values, rudder=(), shaft=()):
    """Gains of the rudder in runs with these largest rudder angles [deg] and revolutions [rpm]."""
    rows = [{"factor": Estimate("x", value, None, None, 0.004, 0.001)} for value in values]
    given = {
        "the largest rudder angle": tuple(angle * DEG for angle in rudder),
        "the revolutions": tuple(rpm / 60.0 for rpm in shaft),
    }
    return by_run("rudder-gain", ("factor",), rows, given)


@pytest.mark.parametrize(
    ("values", "rudder", "shaft", "said"),
    [
        (
            (0.893, 0.985, 0.958, 0.959, 0.985),
            (35.0, 10.0, 20.0, 20.0, 10.0),
            (106.0,) * 5,
            "the largest rudder angle of the runs (0.985 at 10°, 0.959 at 20°, 0.893 at 35°)",
        ),
        (
            (1.02, 1.04, 1.06, 1.08),
            (35.0, 20.0, 20.0, 35.0),
            (60.0, 80.0, 100.0, 120.0),
            "the revolutions of the runs (1.02 at 60 rpm, 1.06 at 100 rpm, 1.08 at 120 rpm)",
        ),
        ((0.893, 0.985, 0.958, 0.959, 0.935), (35.0, 10.0, 20.0, 20.0, 10.0), (106.0,) * 5, ""),  # any values
        ((0.893, 0.985, 0.985, 0.893), (35.0, 10.0, 10.0, 35.0), (), ""),  # two kinds of runs: a line through any
        ((0.893, 0.958, 0.985), (35.0, 20.0, 10.0), (), ""),
        ((0.95, 0.95, 0.95, 0.95), (35.0, 20.0, 10.0, 15.0), (), ""),
        ((0.893, 0.985, 0.958, 0.959, 0.985), (35.0, 10.0, 20.0, math.nan, 10.0), (), ""),
    ],
)
def test_values_that_follow_what_was_ordered_are_nothing_of_the_run(values, rudder, shaft, said):
    assert of_gains(values, rudder, shaft).goes_with == said


@pytest.mark.parametrize(
    ("values", "rudder", "shaft", "said"),
    [
        (
            (0.95, 0.951, 1.02, 1.021),
            (35.0, 20.0, 20.0, 35.0),
            (106.0, 106.0, 60.0, 60.0),
            "the revolutions of the runs (1.02 at 60 rpm, 0.95 at 106 rpm)",
        ),
        (
            (0.95, 0.95, 0.951, 0.951, 1.02),
            (35.0, 20.0, 20.0, 35.0, 20.0),
            (106.0,) * 4 + (60.0,),
            "",
        ),  # one of its kind
        ((0.95, 0.99, 1.02, 0.96), (35.0, 20.0, 20.0, 35.0), (106.0, 106.0, 60.0, 60.0), ""),
    ],
)
def test_values_of_two_kinds_of_runs_may_be_of_what_was_ordered(values, rudder, shaft, said):
    found = of_gains(values, rudder, shaft)
    assert (found.may_go_with, found.goes_with) == (said, "")
    assert (f"; it goes with {said}, so that what changes with it" in found.sentence) == bool(said)


@pytest.mark.parametrize(
    ("values", "hangs"),
    [
        ((0.02, 0.06, -0.05, -0.01, 0.02, 0.03, 0.03, -0.16), True),  # an engine that hunts, which no log shows
        ((0.02, 0.06, -0.05, -0.01, 0.02, 0.03, 0.03, -0.50), False),  # an indicator knocked before one run
        ((0.02, 0.06, -0.05, -0.01, 0.02, 0.03, 0.16, -0.16), False),
        ((0.02, 0.06, -0.16), False),
        ((0.02, 0.06, -0.05, -0.01), False),  # in none for certain
    ],
)
def test_values_that_hang_on_one_run_that_hardly_has_one(values, hangs):
    rows = [{"angle": Estimate("x", value * DEG, None, None, 0.04 * DEG)} for value in values]
    causes = (SimpleNamespace(runs=by_run("rudder-offset", ("angle",), rows)),)
    why = belief_with(causes=causes, chi2=(1.5, 1.0))._bent
    assert why == ("only one run has a value for certain, and hardly" if hangs else "")


@pytest.mark.parametrize(
    ("values", "chi2_after", "doubted"),
    [
        ((0.02, 0.06, -0.05, -0.01), 2.1, True),  # a bank, beside which two of the runs went
        ((0.02, 0.06, -0.05, -0.01), 1.9, False),
        ((0.02, 0.06, -0.05, -0.30), 2.1, False),
    ],
)
def test_values_of_which_none_is_certain_that_leave_far_more_than_noise(values, chi2_after, doubted):
    rows = [{"angle": Estimate("x", value * DEG, None, None, 0.04 * DEG)} for value in values]
    causes = (SimpleNamespace(runs=by_run("rudder-offset", ("angle",), rows)),)
    why = belief_with(causes=causes, chi2=(3.7, chi2_after), unlike_any="")._bent
    assert why == ("no run has a value of it for certain, and these leave far more than noise" if doubted else "")


def test_a_wind_that_is_nearly_the_same_in_each_run_is_said_to_be():
    def runs(*pairs):
        rows = [
            {
                "speed": Estimate("x", speed, None, None, 0.9),
                "direction": Estimate("x", degrees * DEG, None, None, 0.05),
            }
            for speed, degrees in pairs
        ]
        return by_run("wind", ("speed", "direction"), rows)

    assert runs((10.2, 239.6), (10.2, 244.2), (9.6, 242.4), (11.6, 238.0)).sentence == (
        "The wind was much the same in each run: 9.6 to 11.6 m/s, from 241°"
    )
    about_north = runs((10.2, 359.0), (10.2, 1.0)).sentence
    assert about_north.startswith("The wind was much the same")
    assert about_north.endswith(", from 0°")
    everywhere = runs((10.2, 239.6), (10.2, 59.6))
    assert everywhere.sentence == "The wind differed from run to run: 10 m/s, from no common direction"
    assert everywhere.points_everywhere
    assert not runs((10.2, 330.0), (14.2, 10.0)).points_everywhere
    about_north = runs((10.2, 330.0), (14.2, 10.0), (7.1, 350.0)).sentence
    assert about_north == "The wind differed from run to run: 7.1 to 14 m/s, from 330 to 010°"
    # An error common to all runs, as of the force of a wind, is larger than they differ by: the range is no interval.
    assert runs((10.2, 240.0), (11.4, 242.0)).sentence == (
        "The wind was much the same in each run: 10.2 to 11.4 m/s, each known to ± 1.8 m/s, from 241°"
    )


@pytest.mark.parametrize(("stderr", "apart"), [(0.03, 0.02), (0.03, None), (0.03, 0.05)])
def test_values_known_no_better_beside_each_other_are_told_alone(stderr, apart):
    found = of_loading((0.99, 0.81, 0.93), stderr, apart)
    assert ", and none for certain in the other 2" in found.sentence
    assert len(found.table()[0]) == 2
    assert found.to_dict()["values"][0]["from_mean"] is None


def test_runs_in_which_it_shows_are_named():
    """A compass that was off on the second of two days was "none for certain in 3 of 6"."""
    found = of_loading((0.81, 0.99, 0.8, 1.0), 0.03, None)
    assert found.sentence.endswith(
        ": draught over the profile's 0.8 to 0.81 in run0 and run2, and none for certain in the other 2"
    )


def test_values_of_which_none_shows_are_not_told_to_differ():
    """Gains of 1.028 to 1.034, none of them beyond doubt, were told to have "differed from run to run: 1"."""
    found = of_loading((1.01, 0.99, 1.02, 1.0), 0.03, None)
    assert found.sentence.endswith(" may have differed from run to run, in none for certain")


def test_errors_beside_the_mean_are_free_of_what_all_have_in_common():
    names = ("effects.loading.draught@trial:a", "effects.loading.draught@trial:b", "effects.loading.trim")
    own, common = 0.01, 0.2
    covariance = own**2 * np.eye(3)
    covariance[:2, :2] += common**2
    found = apart_of(names, covariance)
    assert found == {name: pytest.approx(0.5 * own**2) for name in names[:2]}


def test_a_clock_that_is_late_in_one_run_is_a_trace_where_it_is_next_to_nothing():
    """ "No cause that was looked for shows" was said beside a clock 2.7 s late in one of eight runs."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(3)
    names = ("turn_p35", "turn_m20", "turn_p10", "turn_m35", "zigzag_10", "zigzag_20")
    trials = [load_trials("suzaku").trials[name] for name in names]
    made = [logged(*pair, rng) for pair in zip(trials, simulate_trials(profile, trials), strict=True)]
    made[1] = replace(made[1], delta=np.interp(made[1].t - 2.0, made[1].t, made[1].delta))
    options = DiagnoseOptions(effects=("clock-offset",), targets=("hull.R_0", "wake.w_P0"))
    result = diagnose("suzaku", made, options)
    assert (result.verdict, result.causes) == ("none", ())
    assert "none of the causes that were looked for is more than a trace" in result.sentence()
    (trace,) = result.traces
    assert "s in turn_m20, and none for certain in the other 5" in trace.sentence
    runs = trace.cause.runs
    late = runs.values[runs.groups.index("trial:turn_m20")]["seconds"]
    assert late.value == pytest.approx(2.0, abs=2.0 * late.stderr)
    told = summary(result, "run", report=False)
    assert "There is a trace of a cause, left out as it changes nothing that would be noticed: the clock" in told


@pytest.mark.daily("gyro-scale")
@pytest.mark.parametrize(
    ("tag", "name", "value", "said"),
    [
        ("position-latency", "seconds", 3.0, "The latency of the receiver differed from run to run: "),
        ("gyro-scale", "factor", 0.9, "The factor of the rate gyro differed from run to run: "),
        ("speed-scale", "factor", 1.1, "The factor of the speed log differed from run to run: "),
    ],
)
def test_a_sensor_that_was_another_one_in_one_run(tag, name, value, said):
    """A receiver 3 s late in one run was a compass 2.5 deg off there."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(3)
    trials = [load_trials("suzaku").trials[one] for one in ("turn_p35", "turn_m20", "zigzag_10", "zigzag_20")]
    ships = [profile, with_effects(profile, {tag: {name: value}}, "made"), profile, profile]
    sailed = [*(simulate_trials(ship, [trial])[0] for ship, trial in zip(ships, trials, strict=True))]
    made = [logged(*pair, rng) for pair in zip(trials, sailed, strict=True)]
    options = DiagnoseOptions(effects=(tag, "heading-bias"), targets=("hull.R_0", "wake.w_P0"))
    result = diagnose("suzaku", made, options)
    assert (result.verdict, [cause.tag for cause in result.causes]) == ("found", [tag]), result.sentence()
    runs = result.causes[0].runs
    assert result.sentence().startswith(said)
    assert "in turn_m20, and none for certain in the other 3" in result.sentence()
    found = runs.values[runs.groups.index("trial:turn_m20")][name]
    assert found.value == pytest.approx(value, abs=3.0 * found.stderr)
