"""Traces and what trials must visit: what is there by the statistics and what a user may be told."""

import json
import math
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.diagnose.answering import judging, saying
from mmgtune.diagnose.answering.judging import Judge, _not_refuted, _of_effects, _telling_as_much
from mmgtune.diagnose.bench.hypotheses import Hypothesis, known_causes
from mmgtune.diagnose.bench.noise import ChannelNoise
from mmgtune.diagnose.bench.workbench import Point, make_workbench
from mmgtune.diagnose.causes import contributions as contributed
from mmgtune.diagnose.causes.belief import NEXT_TO_NOTHING
from mmgtune.diagnose.causes.cause import Cause, Trace
from mmgtune.diagnose.causes.contributions import (
    Contribution,
    _form_of_others,
    _is_sure,
    removed_by,
    set_aside,
    squares,
    takes_the_rest,
)
from mmgtune.diagnose.causes.doubted import Doubted, Leading
from mmgtune.diagnose.evidence.leftover import Leftover, _slow
from mmgtune.diagnose.evidence.whereabouts import Whereabouts
from mmgtune.diagnose.held_out.gain import BAND, expected, held_out
from mmgtune.diagnose.held_out.unseen import Unseen
from mmgtune.diagnose.record import ANSWERS, kind_of, record_of
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.diagnose.searching.search import Found
from mmgtune.diagnose.signatures.at_ends import AtEnds
from mmgtune.diagnose.signatures.intervals import Estimate, _in_units
from mmgtune.effects import Visited, effects, find_effect
from mmgtune.fitting.box import Box
from mmgtune.motions import simulate_trials
from mmgtune.profile import load_profile, tuned
from mmgtune.trial import load_trials, visited_by
from mmgtune.units import DEG, NORMAL_95
from tests.diagnose.beliefs import belief_with
from tests.diagnose.sensors import logged
from tests.hidden import plant
from tests.hidden.cases import Case, pair, single
from tests.hidden.plant import simulate, write
from tools.write_answers import answers, right

ROOT = Path(__file__).parent.parent.parent

SMALL = {"x": 0.01, "psi": 0.02}


@pytest.mark.parametrize(
    ("share", "channels", "indices", "trace"),
    [
        (0.005, SMALL, {"advance_m": 0.001, "overshoot_1_deg": 0.1}, True),
        (0.005, SMALL, {}, True),
        (0.02, SMALL, {}, False),
        (0.005, {"x": 0.01, "r": 0.08}, {}, False),
        (0.005, SMALL, {"advance_m": 0.02}, False),
        (0.005, SMALL, {"overshoot_1_deg": 0.6}, False),
        (0.005, SMALL, {"overshoot_1_deg": 0.4, "tactical_diameter_m": 0.009}, True),
    ],
    ids=["all small", "no index", "of the error", "of the noise", "advance", "overshoot", "degrees are no shares"],
)
def test_a_trace_is_small_in_every_respect(share, channels, indices, trace):
    assert Contribution(0.004, share, channels, indices).unnoticed == trace


@pytest.mark.parametrize(
    ("seen", "share", "trace"),
    [
        (0.0003, 0.0004, True),
        (0.004, 0.0004, True),
        (0.0003, 0.02, False),
        (0.02, 0.0003, False),
        (0.02, -0.01, True),
        (0.25, 0.0, True),
    ],
    ids=["the form of the others", "hardly seen", "held out", "seen", "does harm", "found on these trials alone"],
)
def test_a_cause_beside_larger_ones_has_to_help_where_nobody_looked(seen, share, trace):
    large = {"x": 40.0}, {"overshoot_1_deg": 3.0}
    assert Contribution(seen, share, *large).unnoticed == trace
    assert Contribution(seen, share, *large, form=0.03).unnoticed == (trace or share < 0.03)  # as of a hull


def test_values_of_runs_are_shown_by_the_trials_looked_at_alone():
    one = Contribution(0.00001, 0.008, {"y": 970.0}, {"overshoot_1_deg": 0.6}, bends=True)
    assert one.unnoticed  # bent to a stream in one part of the sea, on held-out trials too
    assert not replace(one, bends=False).unnoticed
    assert not replace(one, seen=0.004).unnoticed


def test_beside_values_of_runs_what_shows_on_held_out_trials_alone_is_no_more_than_these():
    """A zero of the speed log of 0.04 m/s stood beside a current of some runs, a millionth of what that explains."""
    one = Contribution(0.000005, 0.013, {"y": 1690.0}, {"overshoot_1_deg": 1.2}, 0.003, beside_runs=True)
    assert one.unnoticed
    assert not replace(one, beside_runs=False).unnoticed
    assert not replace(one, seen=0.001).unnoticed


def test_what_would_let_another_cause_err_is_noticed():
    """A ship a tenth lighter was a trace beside waves whose force was a seventh too large without that."""
    trace = Contribution(0.0009, 0.00004, {"psi": 3.8}, {"advance_m": 0.02})
    assert trace.unnoticed
    assert not replace(trace, moves=0.15).unnoticed
    assert replace(trace, moves=0.05).unnoticed
    assert trace.little
    assert not replace(trace, moves=0.15).little
    assert replace(trace, moves=0.15, share=-0.01).unnoticed
    assert replace(trace, moves=0.15, of_hull=0.95).unnoticed


def test_what_is_surely_there_beside_exact_causes_is_noticed():
    """A rudder that moved by 1.07 times its order was a trace beside a current, as if a current could look like it."""
    trace = Contribution(0.0009, 0.0004, {"psi": 1.3}, {"advance_m": 0.02})
    assert trace.unnoticed
    assert not replace(trace, sure=True).unnoticed
    assert not replace(trace, sure=True).little
    assert replace(trace, sure=True, share=-0.01).unnoticed


@pytest.mark.parametrize(
    ("tag", "variant", "beside", "size", "half", "by", "sure"),
    [
        ("log-zero", ("abeam",), "current by trial", 0.046, 0.0096, "", False),  # that was of a part of the sea
        ("rudder-gain", ("factor",), "current", 1.07, 0.02, "", True),
        ("rudder-gain", ("factor",), "current", 1.07, 0.03, "", False),  # its interval nearly reaches none
        ("rudder-gain", ("factor",), "current", 1.07, 0.02, "trial", False),
        ("rudder-gain", ("factor",), "current", 1.0002, 0.00001, "", False),  # not worth speaking of
        ("rudder-gain", ("starboard", "port"), "current", 1.07, 0.02, "", False),
        ("rudder-gain", ("factor",), "wave-drift", 1.07, 0.02, "", False),  # what waves leave may look like it
        ("rudder-gain", ("factor",), "wind", 1.07, 0.02, "", False),
        ("shallow-water", ("depth",), "current", 9.0, 1.3, "", True),  # none is at infinity
        ("shallow-water", ("depth",), "current", 9.0, 2.9, "", False),  # of its reciprocal
        ("rudder-stall", ("angle",), "current", 0.5, 0.2, "", False),
    ],
)
def test_a_cause_is_surely_there_three_half_widths_from_none_beside_exact_ones(
    tag, variant, beside, size, half, by, sure
):
    other_tag, _, other_by = beside.partition(" by ")
    other = find_effect(other_tag)
    cause, other = Hypothesis(find_effect(tag), variant, by), Hypothesis(other, other.variants[0], other_by)
    trials = [load_trials("suzaku").trials["turn_p35"]]
    bench = make_workbench(load_profile("suzaku"), trials, DiagnoseOptions(), [*cause.bases, *other.bases])
    names = cause.names if not by else ()
    unit = bench.sub_box(names[:1]).to_unit(np.array([size])) if names else np.zeros(0)
    final = SimpleNamespace(names=names[:1], unit=unit)
    sizes = {name: Estimate(name, size, size - half, size + half, 0.5 * half) for name in names}
    assert _is_sure(bench, SimpleNamespace(final=final, causes=[cause, other]), cause, sizes) == sure


def test_harm_is_that_of_most_runs_and_of_the_channels_that_it_can_change():
    """A gyro that was off by 12 standard errors was a trace: without it positions were told better, which it is not
    in."""
    one = Contribution(0.0002, -0.0004, {"r": 0.4, "x": -3.0}, {"advance_m": 0.0}, moves=0.2)
    assert one.harmful
    assert not replace(one, good=0.0003).harmful
    assert replace(one, good=-0.0003).harmful
    assert not replace(one, good=math.inf).unnoticed


def test_what_mass_and_inertia_need_to_be_a_ships_is_noticed():
    """A propeller that lost a tenth of its thrust was a trace beside a rudder's zero: added mass grew by a half."""
    trace = Contribution(0.0009, 0.0004, {"psi": 1.3}, {"advance_m": 0.02})
    assert trace.unnoticed
    assert trace.little
    assert not replace(trace, unlike_any="added mass in sway 38 % above").unnoticed
    assert not replace(trace, unlike_any="added mass in sway 38 % above").little


@pytest.mark.parametrize(
    ("force", "by", "tag", "moved"),
    [
        (6900.0, "", "steady-force", 0.15),
        (6900.0, "trial", "steady-force", 0.0),
        (6150.0, "", "steady-force", 0.0),
        (6150.0, "", "wave-drift", 0.025),
        (6090.0, "", "wave-drift", 0.0),
    ],
    ids=["beyond", "values of runs", "within twice its interval", "interval with groups of waves", "within that"],
)
def test_how_far_another_cause_is_off_without_one(monkeypatch, force, by, tag, moved):
    drift, draught = "effects.wave-drift.force", "effects.loading.draught"
    waves = SimpleNamespace(names=(drift,), by=by, effect=find_effect(tag))
    cause = SimpleNamespace(names=(draught,), by="")
    final = SimpleNamespace(names=(drift, draught), unit=[0.6, 0.4])
    fewer = SimpleNamespace(names=(drift,), unit=[force / 10_000.0])
    found = SimpleNamespace(final=final, causes=[waves, cause])
    bench = SimpleNamespace(values=lambda point: dict(zip(point.names, [force], strict=False)))
    monkeypatch.setattr(contributed, "typical", lambda *_: 0.1)
    monkeypatch.setattr(contributed, "size_of", lambda *_: 6.0)
    sizes = {drift: Estimate(drift, 6000.0, 5900.0, 6100.0, 50.0)}
    assert contributed._moved(bench, found, cause, fewer, sizes) == pytest.approx(moved)


@pytest.mark.long
def test_a_ship_lighter_than_her_profile_is_told_beside_waves(tmp_path):
    case = pair(3041)
    assert case.name == "pair-loading-and-wave-drift-3041"
    effects = case.effects | {"loading": {"draught": 0.85}}
    write(simulate(case.ship, effects, case.seed, case.noise), tmp_path)
    asked = DiagnoseOptions(effects=("loading", "wave-drift", "wind", "current"))
    said = diagnose(load_profile("suzaku"), load_trials(tmp_path), asked)
    assert {cause.tag for cause in said.causes} == {"loading", "wave-drift"}


@pytest.mark.parametrize(
    ("tag", "by", "beside", "share"),
    [
        ("hull-term", "", "shallow-water", 0.05),
        ("hull-term", "", "engine-droop", 0.05),
        ("hull-term", "", "rudder-offset", 0.02),
        ("rpm-scale", "", "engine-droop", 0.003),
        ("hull-term", "", "gyro-scale", 0.003),
        ("hull-term", "", "hull-term", 0.003),
        ("shallow-water", "", "hull-term", 0.003),
        ("current", "trial", "hull-term", 0.02),
        ("rudder-gain", "", "memory", 0.003),
        ("rudder-gain", "", "current", 0.0005),
        ("rudder-gain", "", "rudder-stall", 0.003),
        ("steady-force", "", "hull-term", 0.02),
        ("gyro-scale", "", "hull-term", 0.003),
        ("heading-filter", "", "heading-filter", 0.003),
    ],
)
def test_what_the_form_of_others_may_leave(tag, by, beside, share):
    """In water of 1.35 draughts by another formula a hull term was found that was a part of its form; so was one beside
    an engine of another law, and a tow beside a hull that is not the same on both sides."""
    cause, other = (
        Hypothesis(one, one.variants[0], by) for one, by in ((find_effect(tag), by), (find_effect(beside), ""))
    )
    assert _form_of_others(SimpleNamespace(causes=[cause, other]), cause) == share


def test_a_cause_that_takes_all_that_others_leave_is_no_matter_of_their_form():
    one = Contribution(0.002, 0.0002, {"u": 28.0}, {}, 0.003)
    assert one.unnoticed
    assert not replace(one, whole=True).unnoticed


@pytest.mark.parametrize(
    ("rest", "taken", "by", "whole"),
    [(2.8, 0.99, "", True), (2.8, 0.8, "", False), (0.1, 0.99, "", False), (2.8, 0.99, "trial", False)],
    ids=["log beside a tide", "a part of it", "hardly anything left", "values of runs bend to anything"],
)
def test_what_takes_the_rest(rest, taken, by, whole):
    n = 1000
    fewer = SimpleNamespace(chi2=n * (1.0 + rest))
    cause = SimpleNamespace(by=by, effect=SimpleNamespace(one_of_many=False))
    current = SimpleNamespace(by="", effect=find_effect("current"))
    found = SimpleNamespace(final=SimpleNamespace(chi2=fewer.chi2 - taken * n * rest), causes=[current, cause])
    bench = SimpleNamespace(problem=SimpleNamespace(n_residuals=n))
    assert takes_the_rest(bench, found, cause, fewer) == whole


@pytest.mark.parametrize(
    ("beside", "taken", "whole"),
    [
        (["speed-scale"], 0.7, True),
        (["speed-scale", "gyro-bias"], 0.7, True),
        (["speed-scale"], 0.4, False),
        (["speed-scale", "current"], 0.7, False),
        ([], 0.7, False),
    ],
)
def test_beside_sensors_alone_half_of_the_rest_is_no_matter_of_their_form(beside, taken, whole):
    """A play of 1.2 deg was a trace, a 170th of an error that was that of the speed log, and let the heading err by
    twice its noise."""
    fewer, n = SimpleNamespace(chi2=1300.0), 1000
    play = SimpleNamespace(by="", effect=find_effect("backlash"))
    causes = [*(SimpleNamespace(by="", effect=find_effect(tag)) for tag in beside), play]
    found = SimpleNamespace(final=SimpleNamespace(chi2=1300.0 - taken * 300.0), causes=causes)
    assert takes_the_rest(SimpleNamespace(problem=SimpleNamespace(n_residuals=n)), found, play, fewer) == whole


@pytest.mark.parametrize(
    ("error", "own", "form", "trace"),
    [
        (6.0, 0.4, 0.0005, False),  # a rate gyro that is off, beside a current
        (6.0, 0.4, 0.003, False),
        (6.0, 0.2, 0.003, True),  # formulas in place that are rough
        (6.0, 0.01, 0.0005, True),
        (0.15, 0.9, 0.0005, True),
    ],
)
def test_a_cause_in_a_channel_of_its_own_is_no_trace(error, own, form, trace):
    one = Contribution(0.002, 0.0001, {"x": 0.2, "r": error}, {}, form, {"x": 0.0002, "r": own})
    assert one.unnoticed == trace
    assert replace(one, share=-0.001).unnoticed == trace  # the wind's form, in positions
    assert replace(one, share=-0.01).unnoticed


@pytest.mark.parametrize(
    ("seen", "share", "named", "little"),
    [
        (0.0016, 0.011, {}, True),  # a calm beside a rudder that stalled
        (0.03, 0.001, {}, False),
        (0.001, 0.03, {}, False),
        (0.001, 0.001, {"whole": True}, False),
        (0.001, 0.001, {"own": {"psi": 0.6}}, False),
    ],
)
def test_what_is_named_though_it_is_not_told_from_others(seen, share, named, little):
    assert Contribution(seen, share, {"psi": 2.0}, {}, **named).little == little
    assert not Contribution(seen).little  # enough to tell that it is more


def test_a_trace_names_what_it_is_not_told_from():
    effect = find_effect("rudder-gain")
    sizes = {"effects.rudder-gain.factor": Estimate("factor", 0.977, 0.97, 0.985, 0.004)}
    trace = Trace(Cause("rudder-gain", effect, sizes, 0.0, None), Contribution(0.001, 0.001, {}, {}), ("flap",))
    assert "too little to be told: rudder-gain or flap, or coefficients that are off" in trace.sentence
    assert "If the first: the rudder moved by 0.977" in trace.sentence
    assert trace.to_dict()["alike"] == ["flap"]


@pytest.mark.parametrize(
    ("certainty", "left"), [(0.0, 0.25), (6.0, 4.0)], ids=["noise of a sensor", "the ship did move"]
)
def test_slow_noise_of_sensors_is_nothing_unknown(certainty, left):
    found = Leftover(4.0, {"psi": 4.0}, {}, {"heading and yaw rate": certainty}, {}, {}, at_most={"psi": 3.75})
    assert found.unknown == pytest.approx(left)
    elsewhere = replace(found, excess=2.0, channels={"x": 3.99, "psi": 0.01}, at_most={"x": 3.75})
    assert elsewhere.unknown == pytest.approx(0.125)  # heading and yaw rate fit


@pytest.mark.parametrize(("n_groups", "structured"), [(12, True), (8, False)])
def test_what_few_blocks_predict_of_one_channel_may_be_chance(n_groups, structured):
    """Four runs of 100 s of a model of 7 m: a clean ship with slow noise was "something that this program does not
    know"."""
    explained = {"x": ("time", 0.75), "y": ("time", 0.1)}
    left = Leftover(0.35, {"x": 0.37, "y": 0.35}, {}, {}, explained, {}, n_groups=n_groups)
    assert left.structured == structured
    assert replace(left, explained=dict.fromkeys("xy", ("time", 0.75))).structured


def test_positions_that_wander_no_more_than_their_noise_may_point_to_no_sensor():
    left = Leftover(6.0, {"x": 9.0, "y": 9.0, "r": 0.0}, {}, {}, {}, {})
    assert left.alone == "position"
    wandering = replace(left, slows={"x": 6.0, "y": 8.0}, at_most={"x": 9.0, "y": 9.0})
    assert wandering.alone == ""
    assert wandering.slow == pytest.approx(14.0 / 3.0)
    assert replace(wandering, at_most={"x": 6.0, "y": 9.0}).alone == "position"


def test_of_few_time_constants_slow_noise_is_known_no_better(suzaku):
    """The fewer independent samples, the more may be noise."""
    trials = list(load_trials("suzaku").trials.values())
    found = {}
    for n, some in (("few", trials[:1]), ("many", trials)):
        bench = make_workbench(suzaku.profile, some, DiagnoseOptions())
        channels = bench.noise.channels | {"x": ChannelNoise(phi=0.98, fading=4.0)}
        bench.know(replace(bench.noise, channels=channels))
        slow, found[n] = _slow(bench, "x", bench.sigma[0], 100.0)
        assert slow == pytest.approx(4.0)
        assert _slow(bench, "psi", bench.sigma[2], 100.0) == (0.0, 0.0)
        assert _slow(bench, "x", bench.sigma[0], 3.0) == (3.0, 3.0)
    assert 5.0 < found["many"] < found["few"]


@pytest.mark.long
def test_what_uncertain_coefficients_bring_is_expected_of_held_out_trials(suzaku):
    """Ships that differ in their targets, tuned on two runs and looked at on the others."""
    profile, trials = suzaku.profile, load_trials("suzaku")
    tune, test = ("turn_p35", "zigzag_20"), ("turn_p10", "turn_m40", "zigzag_10")
    brought, foreseen = [], []
    for seed in range(5):
        rng = np.random.default_rng(seed)
        off = {name: profile.value(name) * (1.0 + rng.uniform(-0.3, 0.3)) for name in profile.targets}
        sailed = [trials.trials[name] for name in (*tune, *test)]
        motions = simulate_trials(tuned(profile, off, {}, {}, "made"), sailed, integrator=Integrator("rk4"))
        made = [logged(trial, motion, rng) for trial, motion in zip(sailed, motions, strict=True)]
        bench = make_workbench(profile, made[:2], DiagnoseOptions())
        base = base_fit(bench)
        found = Found(base, base)
        foreseen.append(expected(bench, found, made[2:]))
        brought.append(held_out(found, Unseen(bench, made[2:])).excess[:, 1].sum())
    assert all(one > 0.0 for one in foreseen)
    assert 0.2 < np.median(brought) / np.median(foreseen) < 5.0
    assert np.mean(np.array(brought) < BAND * np.array(foreseen)) >= 0.6


def test_the_side_that_no_trial_turned_to_is_expected_to_be_wrong(suzaku):
    """Her rudder works worse in turns to port than the profile's: runs to starboard tell nothing of it."""
    profile, trials = suzaku.profile, load_trials("suzaku")
    rng = np.random.default_rng(4)
    sailed = [trials.trials[name] for name in ("turn_p35", "turn_p20", "turn_p10", "turn_m20")]
    off = {"rudder.gamma_Rn": 0.85 * profile.value("rudder.gamma_Rn")}
    motions = simulate_trials(tuned(profile, off, {}, {}, "made"), sailed, integrator=Integrator("rk4"))
    *seen, starboard, port = [logged(trial, motion, rng) for trial, motion in zip(sailed, motions, strict=True)]
    bench = make_workbench(profile, seen, DiagnoseOptions())
    assert [tie.name for tie in bench.model.ties] == ["rudder.gamma_Rn"]
    base = base_fit(bench)
    found = Found(base, base)
    # The rudder's own force may be a little off too, which shows on either side.
    assert expected(bench, found, [port]) > 4.0 * expected(bench, found, [starboard])
    assert not held_out(found, Unseen(bench, [port])).remains


def test_a_run_that_is_lost_has_very_large_squares_and_none_that_is_no_number():
    off = np.zeros((2, 3, 6))
    off[0, 1] = [1.0, 2.0, np.nan, np.inf, 1e200, -3.0]
    assert squares(off).tolist() == [1.0, 4.0, 1e12, 1e12, 1e12, 9.0]


def test_of_targets_that_all_end_at_a_bound_nothing_is_expected(suzaku):
    trial = load_trials("suzaku").trials["turn_p35"]
    bench = make_workbench(suzaku.profile, [trial], DiagnoseOptions(targets=("hull.R_0",), leeway=0.0))
    at_bound = Point(bench.targets, np.ones(1), np.zeros((1, 6)), 0.0, bench.problem.integrator)
    assert expected(bench, Found(at_bound, at_bound), [trial]) == pytest.approx(0.0, abs=1e-6)


def test_what_was_not_asked_for_is_no_trace():
    assert not Contribution(0.4).unnoticed


def zigzags(most):
    """What trials of rudder angles up to ``most`` [deg] to either side visit."""
    n = 400
    t = np.arange(n, dtype=float)
    side = np.sign(np.sin(t / 20.0))
    return Visited(
        np.ones(n), most * DEG * side, 3.0 + 0.4 * side, 3.0 + 0.4 * side, 0.3 * side, 0.1 * side, np.full(n, 1.7)
    )


@pytest.mark.parametrize(
    ("tag", "found", "most", "believed"),
    [
        ("rudder-stall", {"angle": 33.0 * DEG}, 10.0, False),
        ("rudder-stall", {"angle": 8.5 * DEG}, 10.0, False),
        ("rudder-stall", {"angle": 33.0 * DEG}, 30.0, False),
        ("rudder-stall", {"angle": 33.0 * DEG}, 35.0, True),
        ("flap", {"factor": 1.3}, 10.0, False),
        ("flap", {"factor": 1.3}, 20.0, True),
    ],
)
def test_effects_of_large_angles_need_large_angles(tag, found, most, believed):
    missing = find_effect(tag).unvisited(found, zigzags(most))
    assert (missing == "") == believed
    assert believed or f"go to {most:.0f} deg" in missing


def test_effects_of_speed_and_load_need_several():
    one = replace(zigzags(20.0), speed=np.full(400, 3.0), ahead=np.full(400, 3.0))
    assert find_effect("resistance").unvisited({"slope": 1.0}, one)
    assert not find_effect("resistance").unvisited({"factor": 1.2}, one)
    assert not find_effect("resistance").unvisited({"slope": 1.0}, zigzags(20.0))
    assert find_effect("propeller-side-force").unvisited({"force": 1.5, "moment": 1.5}, one)
    assert not find_effect("propeller-side-force").unvisited({"force": 1.5, "moment": 1.5}, zigzags(20.0))
    straight = replace(one, rate=np.zeros(400))
    assert find_effect("shallow-water").unvisited({"depth": 8.0}, straight)
    assert not find_effect("shallow-water").unvisited({"depth": 8.0}, one)


def test_effects_of_changes_and_of_sides_need_them():
    both = zigzags(20.0)
    missing = find_effect("governor-lag").unvisited({"time_constant": 20.0}, both)
    assert missing == "revolutions that change by 2 %"
    slowed = replace(both, shaft=np.linspace(1.7, 1.5, 400))
    assert not find_effect("governor-lag").unvisited({"time_constant": 20.0}, slowed)
    gain = find_effect("rudder-gain")
    assert not gain.unvisited({"starboard": 1.1, "port": 0.9}, both)
    one = replace(both, rudder=np.abs(both.rudder))
    assert gain.unvisited({"starboard": 1.1, "port": 0.9}, one) == "2° of rudder to either side"
    assert not gain.unvisited({"factor": 1.1}, one)
    assert not gain.unvisited({"factor": 1.0, "curve": -0.1}, one)
    small = replace(both, rudder=0.5 * both.rudder)
    missing = gain.unvisited({"factor": 1.0, "curve": -0.1}, small)
    assert missing == "rudder angles beyond 15 deg (these go to 10 deg)"


def test_a_gyro_whose_factor_changes_needs_hard_turns():
    gyro, turning = find_effect("gyro-scale"), replace(zigzags(20.0), rate=np.linspace(-0.6, 0.6, 400))
    assert not gyro.unvisited({"factor": 1.0, "curve": -0.1}, turning)
    gentle = replace(turning, rate=0.2 * turning.rate)
    assert not gyro.unvisited({"factor": 1.1}, gentle)
    missing = gyro.unvisited({"factor": 1.0, "curve": -0.1}, gentle)
    assert missing == "yaw rates r L/U beyond 0.3 (these go to 0.12)"


def test_the_bundled_trials_visit_what_every_effect_is_about():
    seen = visited_by(load_trials("suzaku").trials.values(), 83.0)
    for effect in effects():
        if effect.unvisited is not None:
            typical = {"angle": 25.0 * DEG, "depth": 9.0, "slope": 1.0}
            found = {name: typical.get(name, 1.2) for name in effect.parameters}
            assert effect.unvisited(found, seen) == "", effect.tag


@pytest.mark.long
def test_ten_degree_zigzags_name_no_stall(tmp_path, monkeypatch):
    """Hidden is a force that grows no more beyond 6 deg: a stall fits that perfectly, and no rudder stalls there."""
    monkeypatch.setattr(plant, "TRIALS", tuple((f"zigzag_{k}", 10.0, 500.0) for k in range(3)))
    case = Case("early", single("rudder-stall", 3, seed=1).ship, {"rudder-stall": {"angle": 6.0 * DEG}}, 1, plant.WHITE)
    names = [name for name, *_ in plant.TRIALS]
    monkeypatch.setattr(plant, "sail", partial(plant.sail, names=names))
    write(simulate(case.ship, case.effects, case.seed, case.noise), tmp_path, names)
    result = diagnose(
        load_profile("suzaku"), load_trials(tmp_path), DiagnoseOptions(effects=("rudder-stall", "flap"), leeway=0.0)
    )
    assert result.causes == ()
    assert all("rudder angles beyond" in one.unvisited for one in result.candidates if (one.gain or 0.0) > 10.0)
    assert result.candidates[0].p_value < 1e-6  # but for that it would have been
    assert result.verdict in ("unexplained", "none")


def sum_of(
    *brought,
    tags=("tag",) * 5,
    groups=(),
    structured=False,
    explains_all=False,
    remains=False,
    by_run=0,
    removed=0.99,
    low=0.9,
    sized=True,
    excused=False,
    more=False,
    at_ends=False,
    left=0.0,
    bent="",
    before=3.0,
    of_traces=0.0,
    of_one_log=0,
    of_logs=0,
    akin=(),
):
    """What ``Belief.unclear`` sees of a sum of causes."""
    return belief_with(
        causes=[
            SimpleNamespace(
                runs=k < by_run,
                sized=sized,
                tag="wind",
                at_ends=at_ends,
                of_one_log=k < of_one_log,
                of_logs=k < of_logs,
                effect=SimpleNamespace(one_of_many=tags[k] == "hull-term", akin=akin),
            )
            for k in range(len(brought))
        ],
        contributions=list(zip(tags[: len(brought)], brought, strict=True)),
        groups=groups,
        leftover=SimpleNamespace(structured=structured, unknown=left or 0.2 * structured),
        of_traces=of_traces,
        chi2=(before, 1.0),
        explains_all=explains_all,
        gain=SimpleNamespace(mostly_remains=remains, share_removed=removed, surely_removed=low, tells_nothing=False),
        _told_by_none=False,
        _excused_by_gusts=excused,
        _bent=bent,
        more=more,
    )


CLEAR = Contribution(0.8)
SMALL_BUT_CLEAR = Contribution(0.01, 0.004, {"r": 0.5}, {})
APART = Contribution(0.003, 1e-6, {"psi": -0.4, "r": 0.3}, {}, own={"r": 0.4})
"""A gyro that smooths over a fifth of a second: nothing but the yaw rate shows it."""

GROUP = (("a", "b"),)


@pytest.mark.parametrize(
    ("one", "said"),
    [
        (sum_of(CLEAR), ""),
        (sum_of(CLEAR, SMALL_BUT_CLEAR), ""),
        (sum_of(CLEAR, SMALL_BUT_CLEAR, SMALL_BUT_CLEAR), ""),
        (sum_of(CLEAR, SMALL_BUT_CLEAR, groups=GROUP), ""),
        (sum_of(CLEAR, CLEAR, CLEAR, CLEAR), "it takes 4 terms"),
        (sum_of(CLEAR, CLEAR, CLEAR, more=True), "it takes more than 3 terms"),
        (sum_of(CLEAR, CLEAR, CLEAR, APART), ""),
        (sum_of(CLEAR, CLEAR, CLEAR, CLEAR, APART), "it takes 5 terms"),
        (sum_of(CLEAR, CLEAR, CLEAR, replace(APART, share=0.002)), "it takes 4 terms"),  # it shows elsewhere too
        (sum_of(CLEAR, CLEAR, APART, groups=GROUP), ""),
        (sum_of(CLEAR, CLEAR, SMALL_BUT_CLEAR, groups=GROUP), "told from others"),
        (sum_of(CLEAR, CLEAR, SMALL_BUT_CLEAR, groups=GROUP, of_logs=1), "told from others"),
        (sum_of(CLEAR, CLEAR, SMALL_BUT_CLEAR, groups=GROUP, of_logs=2), ""),  # a clock beside a log and a compass
        (sum_of(CLEAR, CLEAR, CLEAR, groups=GROUP), ""),
        (sum_of(CLEAR, CLEAR, CLEAR, groups=GROUP, by_run=1), "told from others"),
        (sum_of(SMALL_BUT_CLEAR, SMALL_BUT_CLEAR), "do nearly as well"),
        (sum_of(SMALL_BUT_CLEAR, SMALL_BUT_CLEAR, explains_all=True), ""),
        (sum_of(SMALL_BUT_CLEAR, SMALL_BUT_CLEAR, explains_all=True, structured=True), "do nearly as well"),
        # A wave of the indicator's error was a gain, another trim in each run and a flap.
        (sum_of(*3 * [SMALL_BUT_CLEAR], explains_all=True, by_run=1), "do nearly as well"),
        (sum_of(*3 * [SMALL_BUT_CLEAR], explains_all=True), ""),
        (sum_of(CLEAR, SMALL_BUT_CLEAR, structured=True), "more than noise"),
        (sum_of(CLEAR, SMALL_BUT_CLEAR, left=0.03), "more than noise"),
        (sum_of(CLEAR, SMALL_BUT_CLEAR, left=0.03, explains_all=True), ""),
        (sum_of(CLEAR, SMALL_BUT_CLEAR, left=0.05, of_traces=0.049), ""),  # a trace that is there accounts for it
        (sum_of(CLEAR, SMALL_BUT_CLEAR, left=0.05, of_traces=0.02), "more than noise"),
        (sum_of(CLEAR, SMALL_BUT_CLEAR, left=0.01), ""),
        (sum_of(CLEAR, left=0.03), ""),
        (sum_of(CLEAR, CLEAR, left=0.03, tags=("memory", "memory")), ""),  # one of side force and moment, more of one
        (sum_of(CLEAR, CLEAR, left=0.03, tags=("hull-term", "hull-term")), "more than noise"),
        (sum_of(CLEAR, CLEAR, left=0.03), ""),  # noise that fades within seconds
        (sum_of(CLEAR, CLEAR, left=0.03, removed=0.97), "more than noise"),
        (sum_of(CLEAR, CLEAR, left=0.06), "more than noise"),
        (sum_of(CLEAR, CLEAR, left=0.03, structured=True), "more than noise"),
        (sum_of(CLEAR, Contribution(0.35), left=0.03), "more than noise"),
        (sum_of(*4 * [CLEAR], tags=("memory", "memory", "memory", "wind")), ""),
        (sum_of(CLEAR, CLEAR, before=1.09), "little beside noise"),
        (sum_of(CLEAR, CLEAR, before=1.12), ""),
        (sum_of(CLEAR, before=1.03), ""),
        (sum_of(CLEAR, before=1.03, by_run=1), ""),
        (sum_of(CLEAR, CLEAR, before=1.09, of_one_log=1), ""),  # a gyro, which is told by itself, and one more
        (sum_of(CLEAR, CLEAR, CLEAR, before=1.09, of_one_log=1), "little beside noise"),
        (sum_of(CLEAR, before=1.03, by_run=1, low=-0.3), "next to nothing"),  # 95 %, -33 to 98 %, with nothing there
        (
            sum_of(CLEAR, before=1.03, by_run=1, removed=0.01, low=-0.3),
            "next to nothing",
        ),  # a receiver that wanders, by run
        (sum_of(CLEAR, SMALL_BUT_CLEAR, remains=True), "on test trials"),
        (sum_of(CLEAR, CLEAR, CLEAR, by_run=2), "from run to run"),
        (sum_of(CLEAR, CLEAR, CLEAR, by_run=1), ""),
        (sum_of(CLEAR, CLEAR, by_run=2), "from run to run"),
        (sum_of(CLEAR, CLEAR, by_run=2, explains_all=True), ""),
        # The trim of an autopilot that was not logged was a wind and waves of each run, which bend to anything.
        (sum_of(CLEAR, CLEAR, by_run=2, explains_all=True, akin=("wind",)), "from run to run"),
        (sum_of(CLEAR, CLEAR, by_run=1, explains_all=True, akin=("wind",)), ""),
        (sum_of(CLEAR, CLEAR, by_run=1, removed=0.58, low=-0.07), "next to nothing"),
        (sum_of(CLEAR, CLEAR, removed=0.58, low=-0.07), ""),
        (sum_of(CLEAR, by_run=1, removed=0.58, low=-0.07), ""),
        (sum_of(CLEAR, CLEAR, CLEAR, removed=0.46), "removes little"),
        (sum_of(CLEAR, CLEAR, removed=-0.16), "removes little"),
        (sum_of(CLEAR, CLEAR, sized=False), "how large wind would be is not told"),
        (sum_of(CLEAR, CLEAR, sized=False, tags=("wind", "wind")), ""),  # without either most of the error comes back
        (sum_of(CLEAR, SMALL_BUT_CLEAR, sized=False, tags=("current", "wind")), "how large wind would be is not told"),
        (sum_of(CLEAR, removed=0.35, left=0.6, structured=True), "leaves more than noise"),  # a track without its sway
        (sum_of(CLEAR, removed=0.35, left=0.6), ""),
        (sum_of(CLEAR, removed=0.35, left=0.2, structured=True), ""),
        (sum_of(CLEAR, removed=0.6, left=0.6, structured=True), ""),
        (sum_of(CLEAR, sized=False), ""),
        (sum_of(CLEAR, sized=False, removed=0.2), "how large wind would be is not told"),
        (sum_of(CLEAR, removed=0.2), ""),
        (sum_of(CLEAR, CLEAR, removed=0.6), ""),
        (sum_of(CLEAR, at_ends=True, left=1.2), "at the end of its range"),
        (sum_of(CLEAR, at_ends=True, left=0.4), ""),
        (sum_of(CLEAR, CLEAR, at_ends=True, explains_all=True), "at the end of its range"),  # a rudder that saturates
        (sum_of(CLEAR, left=1.2), ""),
        (sum_of(CLEAR, removed=-0.16), ""),
        (sum_of(CLEAR, remains=True), ""),
        (sum_of(CLEAR, structured=True), ""),
        (sum_of(CLEAR, excused=True), "more than gusts"),
        (sum_of(CLEAR, by_run=1, bent="its values go with the rudder"), "go with"),
        (sum_of(CLEAR, SMALL_BUT_CLEAR, structured=True, explains_all=True), ""),
    ],
)
def test_a_sum_is_believed_where_each_of_it_is_clear(one, said):
    assert (one.unclear == "") == (said == "")
    assert said in one.unclear


def rival(tag, **more):
    return SimpleNamespace(hypothesis=SimpleNamespace(tag=tag, by="", variant=("size",), **more))


def test_who_doubts_a_second_form_of_an_effect_does_not_doubt_the_effect():
    memory, terms = (SimpleNamespace(tag=tag, effect=find_effect(tag)) for tag in ("memory", "hull-term"))
    both = [rival("loading")]
    assert _of_effects([memory, memory], [[], both]) == [[], []]
    assert _of_effects([memory, memory], [both, both]) == [both, both]
    assert _of_effects([terms, terms], [[], both]) == [[], both]  # each is another term
    assert _of_effects([memory, terms], [[], both]) == [[], both]


@pytest.mark.parametrize(
    ("by", "told", "J", "named"),
    [
        ("trial", 0.97, 0.32, ["backlash"]),
        ("trial", 0.97, 0.9, []),
        ("trial", 0.3, 0.32, []),
        ("", 0.97, 0.32, []),
    ],
)
def test_what_tells_unseen_runs_as_well_as_values_of_each_may_be_the_cause(by, told, J, named):
    """Play of a degree turns the blade less in each turn by another share: "the gain differed from run to run"."""
    cause = SimpleNamespace(tag="rudder-gain", by=by)
    candidates = [
        SimpleNamespace(effect="backlash", parameters=("size",), by="", J_test=J),
        SimpleNamespace(effect="flap", parameters=("size",), by="", J_test=4.6),
        SimpleNamespace(effect="wind", parameters=("size",), by="", J_test=None),
        SimpleNamespace(effect="clock-offset", parameters=("size",), by="trial", J_test=0.3),
    ]
    refits = [rival(one.effect) for one in candidates]
    found = SimpleNamespace(causes=[cause], steps=[SimpleNamespace(refits=refits)])
    gain = SimpleNamespace(J=(7.5, 0.22))
    result = SimpleNamespace(causes=[SimpleNamespace(gain_test=told)], candidates=candidates, gain=gain)
    assert [one.hypothesis.tag for one in _telling_as_much(result, found)] == named


@pytest.mark.parametrize(
    ("told", "J", "left"), [(0.9, 8.3, []), (0.9, 7.6, ["wind"]), (0.9, None, ["wind"]), (0.4, 8.3, ["wind"])]
)
def test_what_test_trials_refute_is_no_rival(told, J, left):
    """A gain of the rudder to starboard "or wave-drift", with which J of test trials was twenty times that without."""
    candidates = [
        SimpleNamespace(effect="wind", parameters=("size",), by="", J_test=J),
        SimpleNamespace(effect="wind", parameters=("size",), by="trial", J_test=70.0),
    ]
    result = SimpleNamespace(
        causes=[SimpleNamespace(gain_test=told)], candidates=candidates, gain=SimpleNamespace(J=(7.5, 0.2))
    )
    assert [one.hypothesis.tag for one in _not_refuted(result, [rival("wind")])] == left


@pytest.mark.parametrize(
    ("one", "chance"),
    [
        (sum_of(CLEAR, sized=False, removed=0.2), True),
        (sum_of(CLEAR, removed=0.2), False),
        (sum_of(CLEAR, CLEAR, before=1.09), True),
        (sum_of(CLEAR, CLEAR, left=0.03, before=1.12), False),
    ],
)
def test_what_is_little_beside_noise_may_be_chance(one, chance):
    """Beside noise alone two causes that were not believed made it an error of less than none that nobody knows."""
    assert one.is_chance == chance


def test_where_a_cause_alone_is_not_believed_none_is_asked_for(monkeypatch):
    """Without a wind the inertia was what no ship's is, of a rudder logged in whole degrees: "an error with 0 %"."""
    wind = SimpleNamespace(tag="wind")
    found = SimpleNamespace(causes=[wind], base="base")
    monkeypatch.setattr(judging, "unlike_without", lambda *_: "k_zz 40 % above")
    monkeypatch.setattr(judging, "with_only", lambda bench, found, causes: SimpleNamespace(causes=causes))
    asked = [least.causes for least, _ in Judge._least(SimpleNamespace(bench=None), found)]
    assert asked == [[wind], []]
    monkeypatch.setattr(judging, "unlike_without", lambda *_: "")
    assert [least.causes for least, _ in Judge._least(SimpleNamespace(bench=None), found)] == [[]]


@pytest.mark.parametrize(
    ("chance", "unclear", "fails", "explained", "nothing"),
    [
        (True, "why", True, 0.5, True),
        (False, "why", True, 0.05, True),
        (False, "why", True, 0.5, False),
        (False, "", False, 0.05, False),
        (False, "", True, 0.05, True),  # not told by test trials, whose inputs are as coarse
        (False, "", True, 0.5, False),
    ],
)
def test_what_is_not_believed_and_removes_nothing_leaves_what_there_was(chance, unclear, fails, explained, nothing):
    """Coarse inputs excused all that was left, and "something is wrong: an error with 0 % of the noise is left"."""
    found = {"causes": [SimpleNamespace()], "is_chance": chance, "unclear": unclear, "fails": fails}
    one = belief_with(**found, explained_share=explained)
    assert one.is_next_to_nothing == nothing


@pytest.mark.parametrize(
    ("explained", "held_out", "sized", "doubt", "everywhere", "leads"),
    [
        (0.97, 0.9, True, None, False, True),
        (0.97, 0.9, True, "", False, True),
        (0.97, 0.9, True, "", True, False),  # waves of each run from everywhere, of a thrust that falls with drift
        (0.97, 0.9, True, "they go with the rudder angle", False, False),  # not of the run: no size of its cause
        (0.7, 0.9, True, None, False, False),
        (0.97, 0.5, True, None, False, False),
        (0.97, 0.9, False, None, False, False),
    ],
)
def test_of_a_sum_that_is_not_believed_the_first_is_told_with_its_size_where_it_is_most(
    explained, held_out, sized, doubt, everywhere, leads
):
    """An antenna 110 m aft, beside a form of the hull that nobody knows, was named without its size."""
    runs = None if doubt is None else SimpleNamespace(doubt=doubt, points_everywhere=everywhere)
    sentence = "The antenna stood 110 m aft"
    cause = SimpleNamespace(
        sized=sized, at_ends=False, tag="antenna", sentence=sentence, runs=runs, estimates={"ahead": None}
    )
    gain = SimpleNamespace(share_removed=held_out, surely_removed=0.0)
    another = SimpleNamespace(sized=True, at_ends=False, tag="hull-term")
    first = SimpleNamespace(causes=(cause,), explained_share=explained, gain=gain)
    leading = Leading.of(SimpleNamespace(causes=(another, cause)), first)
    assert (leading is not None) == leads
    if leading is not None:
        assert leading.sentence == f"Most of it, {100 * held_out:.0f} %, would be antenna: the antenna stood 110 m aft."
        plain = SimpleNamespace(**vars(cause) | {"runs": None, "estimates": {"ahead": None, "up": None}})
        told = Leading.of(
            SimpleNamespace(causes=(another, cause)), SimpleNamespace(**vars(first) | {"causes": (plain,)})
        )
        assert told is not None
        assert told.cause is plain  # in a plainer form its size is that of this form


@pytest.mark.parametrize(
    ("one", "beyond"),
    [
        (sum_of(CLEAR, CLEAR, SMALL_BUT_CLEAR, groups=GROUP), True),
        (sum_of(CLEAR, CLEAR, CLEAR, groups=GROUP), False),
        (sum_of(CLEAR, CLEAR, CLEAR), False),
        (sum_of(SMALL_BUT_CLEAR, SMALL_BUT_CLEAR), False),
        (sum_of(CLEAR, CLEAR, CLEAR, more=True), True),
        (sum_of(CLEAR, CLEAR, more=True), True),
    ],
)
def test_what_is_beyond_all_takes_three_terms_that_are_not_believed(one, beyond):
    assert one.is_beyond_all == beyond


@pytest.mark.parametrize(
    ("tag", "chi2", "left_open", "excused"),
    [
        ("wind", (3.0, 1.3), 120.0, True),
        ("wind", (3.0, 1.3), 2.0, False),
        ("wind", (7.5, 1.14), 5.8, False),
        ("wind", (30.0, 1.3), 120.0, False),
        ("current", (3.0, 1.3), 120.0, False),
    ],
    ids=["a tug", "little", "gusts of a tenth of 9 m/s", "gusts of a gale", "no wind"],
)
def test_a_wind_does_not_excuse_what_no_gusts_leave(tag, chi2, left_open, excused):
    cause, leftover = SimpleNamespace(effect=find_effect(tag)), SimpleNamespace(left_open=left_open)
    assert belief_with(causes=(cause,), chi2=chi2, leftover=leftover)._excused_by_gusts == excused


def test_how_often_answers_were_right_is_what_the_study_says():
    """The file that travels with the program is what the tool makes of the study's results."""
    rows = [json.loads(line) for line in (ROOT / "docs" / "hidden.jsonl").read_text(encoding="utf-8").splitlines()]
    assert json.loads(ANSWERS.read_text(encoding="utf-8")) == answers(rows)
    assert sum(one["of"] for one in answers(rows)["answers"].values()) == len(rows)


@pytest.mark.parametrize(
    ("row", "is_right"),
    [
        ({"verdict": "none", "outcome": "clear", "hidden": {}, "above_limit": None}, True),
        ({"verdict": "none", "outcome": "missed", "hidden": {"wind": {}}, "above_limit": False}, True),
        ({"verdict": "none", "outcome": "missed", "hidden": {"wind": {}}, "above_limit": True}, False),
        ({"verdict": "unexplained", "outcome": "right", "hidden": {"unknown-bank": {}}, "above_limit": None}, True),
        ({"verdict": "unexplained", "outcome": "unexplained", "hidden": {"wind": {}}, "above_limit": True}, False),
        ({"verdict": "found", "outcome": "partly", "hidden": {"wind": {}, "flap": {}}, "above_limit": True}, False),
        ({"verdict": "not-separable", "outcome": "grouped", "hidden": {"wind": {}}, "above_limit": True}, True),
    ],
)
def test_which_answers_count_as_right(row, is_right):
    assert right(row) == is_right


def test_a_kind_the_study_never_gave_says_so():
    assert "No answer of this kind" in record_of("a new kind").sentence
    assert kind_of("found", [1, 2], []) == "two causes"
    assert kind_of("not-separable", [1], [("a", "b")]) == "a group"
    assert record_of("two causes").of >= record_of("two causes").right > 0


@pytest.mark.parametrize(
    ("runs", "excess", "structured", "believed"),
    [(True, 5.0, True, False), (False, 5.0, True, True), (True, 0.3, True, True), (True, 5.0, False, True)],
    ids=["of runs", "one for all", "hardly more than noise", "without a shape"],
)
def test_values_of_runs_that_leave_a_shape_are_not_believed(runs, excess, structured, believed):
    told = {
        "causes": (SimpleNamespace(runs=runs or None),),
        "leftover": SimpleNamespace(excess=excess, unknown=excess, structured=structured),
        "explained_share": 0.99,
    }
    assert belief_with(**told, explains_all=False)._mostly_left is not believed
    assert not belief_with(**told, explains_all=True)._mostly_left


@pytest.mark.parametrize(
    ("unknown", "structured", "share", "believed"),
    [(12.7, False, 0.75, False), (2.98, False, 0.99, True), (0.5, False, 0.75, True), (0.5, True, 0.75, False)],
)
def test_what_leaves_more_than_the_noise_and_removes_no_more_than_most_is_not_believed(
    unknown, structured, share, believed
):
    """A heading that was 10 s late in one run was "depth 4.56 ± 0.46 m" there, beside which the heading erred by eight
    times its noise."""
    leftover = SimpleNamespace(excess=unknown, unknown=unknown, structured=structured)
    told = {"causes": (SimpleNamespace(runs=None),), "leftover": leftover, "explained_share": share}
    assert belief_with(**told, explains_all=False)._mostly_left is not believed


@pytest.mark.parametrize(
    ("misread", "alone", "unknown", "of_one_log", "fails"),
    [
        ({"r": {"a": -1.0}}, "", 0.0, True, True),
        ({"r": {"a": -1.0}}, "", 0.0, False, False),  # a current is one, whatever one log shows besides
        ({}, "u", 0.8, True, True),
        ({}, "u", 0.2, True, False),
        ({}, "", 0.8, True, False),
    ],
)
def test_an_error_of_a_log_that_is_off_otherwise_is_not_believed(misread, alone, unknown, of_one_log, fails):
    leftover = SimpleNamespace(misread=misread, alone=alone, unknown=unknown)
    causes = (SimpleNamespace(of_one_log=of_one_log),)
    assert belief_with(causes=causes, leftover=leftover, explained_share=0.7)._of_a_misread_log is fails


@pytest.mark.parametrize(
    ("structured", "surely", "faint", "said"),
    [
        (True, -9.0, False, NEXT_TO_NOTHING),
        (True, 0.1, False, ""),
        (False, -9.0, False, ""),
        (False, 0.1, True, NEXT_TO_NOTHING),
    ],
)
def test_values_of_each_run_that_may_do_nothing_elsewhere_and_leave_a_shape_are_not_believed(
    structured, surely, faint, said
):
    """A bank beside all runs was a wind of each, 2.8 to 9.7 m/s, that removed -939 to 98 % of what is held out."""
    one = belief_with(
        causes=(SimpleNamespace(runs="one each", sized=True, tag="wind", at_ends=False),),
        contributions=(("wind", CLEAR),),
        leftover=SimpleNamespace(structured=structured, unknown=0.1),
        gain=SimpleNamespace(share_removed=0.8, surely_removed=surely),
        _told_by_none=False,
        _excused_by_gusts=False,
        _bent="",
        _faint=faint,
    )
    assert one.unclear == said


@pytest.mark.parametrize(
    ("tells_nothing", "share", "seen", "structured", "believed"),
    [
        (True, 0.999, (0.72, 0.29), False, True),
        (False, 0.999, (0.72, 0.29), False, False),
        (True, 0.99, (0.72, 0.29), False, False),
        (True, 0.999, (0.72, 0.1), False, False),
        (True, 0.999, (0.72, 0.29), True, False),
    ],
)
def test_a_sum_stands_where_held_out_trials_have_hardly_an_error_to_remove(
    tells_nothing, share, seen, structured, believed
):
    """A scale of the gyro and a lag of the gear: on the test run both together did less than uncertain coefficients."""
    one = belief_with(
        causes=tuple(
            SimpleNamespace(runs=None, sized=True, tag=tag, at_ends=False, of_one_log=True, effect=None) for tag in "ab"
        ),
        contributions=tuple(zip("ab", map(Contribution, seen), strict=True)),
        groups=(),
        of_traces=0.0,
        leftover=SimpleNamespace(structured=structured, unknown=0.0),
        explained_share=share,
        gain=SimpleNamespace(share_removed=0.44, surely_removed=0.3, tells_nothing=tells_nothing, mostly_remains=False),
        _told_by_none=False,
        _excused_by_gusts=False,
        _bent="",
        _faint=False,
    )
    assert ("removes little" in one.unclear) is not believed


@pytest.mark.parametrize(
    ("tag", "ended", "at_ends"),
    [
        ("propeller-side-force", {"force": True, "moment": True}, True),
        ("propeller-side-force", {"force": True, "moment": False}, False),
        ("wave-drift", {"force": True, "direction": False}, True),
        ("steering-lag", {"rate_limit": False}, False),
        ("current", {}, False),
    ],
)
def test_whether_a_cause_is_at_the_end_of_its_range(tag, ended, at_ends):
    effect = find_effect(tag)
    sizes = {f"{effect.kind}.{name}": Estimate(name, 1.0, 0.9, 1.0, 1.0, at_end=end) for name, end in ended.items()}
    assert Cause(tag, effect, sizes, 0.0, None).at_ends is at_ends


@pytest.mark.parametrize(
    ("searched", "at_end"),
    [
        ((0.97, 0.01), False),  # 1.5 deviations from the end
        ((0.97, 0.06), False),
        ((0.99, 0.06), True),  # a draught of 1.39 times the profile's, of 1.4, that stood for a depth of water
        ((1.0, 0.06), True),
        ((0.3, 0.12), False),  # a rate of 0.05 rad/s, somewhere from 0.03 to 0.3: far from an end, by its reciprocal
        ((0.0, 0.12), True),
    ],
)
@pytest.mark.parametrize("reciprocal", [(), (0,)])
def test_an_interval_cut_off_beside_its_value_is_at_an_end(searched, at_end, reciprocal):
    z, deviation = searched
    box = Box(("effects.a.b",), np.array([0.05]), np.array([0.5]), np.array([40.0]), reciprocal=reciprocal)
    bench = SimpleNamespace(sub_box=lambda _: box, parameter=lambda _: SimpleNamespace(null=0.0))
    point = SimpleNamespace(names=box.names, unit=np.array([z]))
    assert _in_units(bench, point, box.names, np.array([[deviation**2]]))["effects.a.b"].at_end is at_end


@pytest.mark.parametrize(("deviation", "low"), [(0.0, None), (0.1, pytest.approx(1.0 / (0.1 * 50.0 * NORMAL_95)))])
def test_a_side_without_a_limit_has_no_infinite_interval(deviation, low):
    """Of a gear slow to port alone: "Out of range float values are not JSON compliant: inf"."""
    box = Box(("effects.a.b",), np.array([0.0]), np.array([0.0]), np.array([50.0]), reciprocal=(0,))
    bench = SimpleNamespace(sub_box=lambda _: box, parameter=lambda _: SimpleNamespace(null=0.0))
    point = SimpleNamespace(names=box.names, unit=np.zeros(1))
    one = _in_units(bench, point, box.names, np.array([[deviation**2]]))["effects.a.b"]
    assert (one.value, one.low, one.high, one.stderr) == (np.inf, low, None, None)


@pytest.mark.parametrize(
    ("tag", "estimated", "sized"),
    [
        ("wave-drift", {"force": (0.0, 82e3), "direction": (0.2, 1.0)}, False),  # 36 +- 46 kN: its direction is no size
        (
            "wave-drift",
            {"force": (0.0, 82e3), "direction": (0.2, 1.0), "turning": (0.1, 0.2)},
            False,
        ),  # nor is its form
        ("wave-drift", {"force": (20e3, 82e3), "direction": (-1.0, 1.0)}, True),
        ("antenna", {"x": (-34.0, -30.0), "y": (-0.1, 0.1)}, True),
        ("rpm-scale", {"factor": (0.955, 1.001)}, False),
        ("memory", {"time_constant": (1.0, None)}, True),
        ("rudder-stall", {"angle": (0.4, None)}, False),  # absent at infinity
        ("current", {}, True),  # values of runs
    ],
)
def test_whether_the_size_of_a_cause_is_told(tag, estimated, sized):
    effect = find_effect(tag)
    sizes = {f"{effect.kind}.{name}": Estimate(name, 1.0, *ends, 1.0) for name, ends in estimated.items()}
    assert Cause(tag, effect, sizes, 0.0, None).sized is sized


def test_a_sum_that_is_doubted_says_what_has_values_of_runs():
    """ "More would be removed by current", of a current that was named."""
    causes = (SimpleNamespace(tag="current", runs=None), SimpleNamespace(tag="wind", runs="one each"))
    whole = SimpleNamespace(contributions=(("current", None), ("wind", None)), unclear="they bend", causes=causes)
    doubted = Doubted.of(whole)
    assert doubted.sentence.startswith("More would be removed by current + wind of each run, but they bend, ")
    assert doubted.to_dict() == {"effects": ["current", "wind"], "why": "they bend"}


@pytest.mark.parametrize(
    ("tag", "found", "said", "sized"),
    [
        ("rudder-offset", {"angle": (2.5, 1.0)}, "; by the profile the rudder stood 1° to starboard", True),
        ("rudder-offset", {"angle": (1.1, 1.0)}, "; by the profile the rudder stood 1° to starboard", False),
        ("rudder-offset", {"angle": (0.0, 1.0)}, "; by the profile the rudder stood 1° to starboard", True),
        ("rudder-offset", {"angle": (2.5, None)}, "", True),
        (
            "wind",
            {"speed": (8.0, 8.0), "direction": (90.0, 30.0)},
            "; by the profile a wind of 8 m/s blew from 30°",
            True,
        ),
        ("wind", {"measured": (0.5, 1.0)}, "", True),  # as whoever puts a logged wind into a profile has it
    ],
)
def test_what_the_profile_has_of_a_cause_is_said_beside_it(tag, found, said, sized):
    """ "The rudder stood 0.0 deg to starboard" of a profile with an offset of a degree that was put right since."""
    effect, sizes = find_effect(tag), {}
    for name, (value, stated) in found.items():
        unit = DEG if effect.parameters[name].unit == "rad" else 1.0
        ends = (unit * (value - 0.2), unit * (value + 0.2), 0.1 * unit)
        own = None if stated is None else unit * stated
        sizes[f"{effect.kind}.{name}"] = Estimate(name, unit * value, *ends, stated=own)
    cause = Cause(tag, effect, sizes, 0.0, None)
    assert cause.sized is sized
    assert said in cause.sentence
    assert ("by the profile" in cause.sentence) == bool(said)


@pytest.mark.parametrize(
    ("held_out", "share", "left", "open_", "explained", "rest", "of_log", "misses"),
    [
        ("each", 0.55, 52.0, 383.0, 0.999, 0.0, False, True),  # the blade stuck for a minute in two runs of five
        ("each", 0.55, 30.0, 383.0, 0.999, 0.0, False, False),  # no more than logs of a sample a second leave open
        ("each", 0.55, 52.0, 383.0, 0.999, 0.0, True, False),  # a speed log 3 % off: in no other state does it show
        ("each", 0.55, 52.0, 383.0, 0.999, 0.06, True, True),
        ("each", -0.08, 2.3, 0.0, 0.9, 0.0, False, False),  # two turns and two zigzags: too few without one
        ("each", 0.55, 1.5, 0.0, 0.9, 0.0, False, False),
        ("each", 0.64, 52.0, 0.0, 0.999, 0.0, False, False),  # a slow gear, all that there is in three runs
        ("each", 0.64, 52.0, 0.0, 0.9, 0.0, False, True),
        ("each", 0.34, 2.5, 0.0, 0.67, 0.02, False, False),  # a hull with a list: of 7 % of the noise it leaves 2 %
        ("each", 0.34, 2.5, 0.0, 0.67, 0.04, False, True),
        ("each", 0.34, 3.5, 0.0, 0.67, 0.02, False, True),
        ("test", 0.55, 52.0, 0.0, 0.9, 0.0, False, False),  # said beside the answer
    ],
)
def test_what_tells_no_run_from_the_others_is_not_believed(
    held_out, share, left, open_, explained, rest, of_log, misses
):
    one = belief_with(
        gain=SimpleNamespace(held_out=held_out, left=left, share_removed=share, surely_removed=0.0),
        leftover=SimpleNamespace(left_open=open_, structured=False),
        causes=[SimpleNamespace(of_one_log=of_log)],
        rest=rest,
        leaves_open=open_ > 0.3,
        explained_share=explained,
        contributions=[("steering-lag", CLEAR)],
    )
    assert one._misses_each is misses


@pytest.mark.parametrize(
    ("explained", "held_out", "all_of_it"), [(0.999, 0.985, True), (0.997, 0.99, False), (0.999, 0.97, False)]
)
def test_what_a_cause_of_slightly_another_form_would_leave_is_all(explained, held_out, all_of_it):
    gain = SimpleNamespace(share_removed=held_out, surely_removed=0.9)
    assert belief_with(explained_share=explained, gain=gain).explains_all is all_of_it


@pytest.mark.parametrize(
    ("there", "shaped", "stays"), [("seen", False, False), ("seen", True, True), ("all", False, True)]
)
def test_a_cause_that_is_alone_is_a_trace_where_nothing_needs_it_and_it_does_harm(suzaku, there, shaped, stays):
    """The rate gyro is off in the runs looked at, or in the test runs too."""
    profile, trials = suzaku.profile, load_trials("suzaku")
    rng = np.random.default_rng(5)
    sailed = [trials.trials[name] for name in ("turn_p35", "turn_m20", "zigzag_20", "turn_m40", "zigzag_10")]
    motions = simulate_trials(profile, sailed, integrator=Integrator("rk4"))
    made = [logged(trial, motion, rng) for trial, motion in zip(sailed, motions, strict=True)]
    off = len(made) if there == "all" else 3
    made = [replace(one, r=one.r + 0.1 * DEG) if k < off else one for k, one in enumerate(made)]
    cause = next(one for one in known_causes(profile, made, DiagnoseOptions()) if one.tag == "gyro-bias")
    bench = make_workbench(profile, made[:3], DiagnoseOptions(), cause.names)
    base = base_fit(bench)
    final = bench.refit(
        (*base.names, *cause.names), np.append(base.unit, bench.null(cause.names))[:, None], base.offsets
    )
    found = Found(base, final, [cause])
    before = (
        Leftover(9.0, {"r": 9.0}, {}, {"heading and yaw rate": 99.0}, {}, {})
        if shaped
        else Leftover(0.0, {}, {}, {}, {}, {})
    )
    assert before.structured == shaped
    traces, brought = set_aside(bench, found, Unseen(bench, made[3:]), before)
    assert [one.hypothesis for one in traces] == ([] if stays else [cause])
    assert len(brought) == len(found.causes) == stays
    assert stays or traces[0].contribution.harmful


NOTHING_NOTICED = Leftover(0.0, {}, {}, {}, {}, {})
NOTICED = Leftover(0.4, {"x": 0.4}, {}, {"position and velocity": 9.0}, {}, {})


@pytest.mark.parametrize(
    ("degrees", "before", "trace"),
    [(0.04, NOTHING_NOTICED, True), (0.3, NOTHING_NOTICED, False), (0.04, NOTICED, False)],
)
def test_a_cause_that_is_alone_and_slight_is_a_trace(suzaku, degrees, before, trace):
    """A rudder's zero of a few hundredths of a degree may be beyond doubt, and nobody would notice it; but where more
    than noise is left without it, it is the answer to what that is."""
    profile, trials = suzaku.profile, load_trials("suzaku")
    rng = np.random.default_rng(5)
    sailed = [trials.trials[name] for name in ("turn_p35", "turn_m20", "zigzag_20")]
    motions = simulate_trials(profile, sailed, integrator=Integrator("rk4"))
    made = [logged(trial, motion, rng) for trial, motion in zip(sailed, motions, strict=True)]
    made = [replace(one, delta=one.delta - degrees * DEG) for one in made]
    cause = next(one for one in known_causes(profile, made, DiagnoseOptions()) if one.tag == "rudder-offset")
    bench = make_workbench(profile, made, DiagnoseOptions(), cause.names)
    base = base_fit(bench)
    start = np.append(base.unit, bench.null(cause.names))[:, None]
    found = Found(base, bench.refit((*base.names, *cause.names), start, base.offsets), [cause])
    traces, brought = set_aside(bench, found, Unseen(bench, []), before)
    assert [one.hypothesis for one in traces] == ([cause] if trace else [])
    assert [one.slight for one in brought] == ([] if trace else [False])


def unexplained(**more):
    """What is read of an unexplained answer when it is put into words: of one without any cause, or with more."""
    no = dict.fromkeys(("looked_for_none", "tells_a_part", "misses_test", "of_a_sensor"), False)
    logs = {"jumped": {}, "ended": {}, "wrong_logs": {}}
    none = {"between": (), "causes": (), "contributions": (), "contradicted": "", "unclear": ""}
    beside = {"together": None, "leading": None, "ends": None, "options": DiagnoseOptions(), "whereabouts": None}
    return SimpleNamespace(**{"verdict": "unexplained", **no, **logs, **none, **beside, **more})


def test_what_is_most_of_what_cannot_be_named_stands_in_the_headline():
    """An abbreviation in the first sentence cut the headline in two when it was found by its full stop."""
    most = SimpleNamespace(sentence="Most of it, approx. 81 %, would be antenna.")
    seen = unexplained(
        causes=(SimpleNamespace(tag="antenna", runs=None),),
        contributions=(("antenna", None), ("hull-term", None)),
        explained_share=0.99,
        together=SimpleNamespace(sentence="All trials together say more."),
        unclear="one of them is a trace",
        tells_a_part=True,
        leading=most,
    )
    said = saying.said(seen)
    assert said.headline == f"{said.first} {most.sentence}"
    assert said.explained == f"{said.why} All trials together say more."
    assert said.why.startswith("The best partial explanation, antenna + hull-term, removes 99 %")
    assert said.sentence == f"{said.first} {said.why} {most.sentence} All trials together say more."
    seen.leading, seen.together, seen.contradicted = None, None, "Logs contradict each other, approx. by 3 deg."
    seen.causes += (SimpleNamespace(tag="wind", runs="one each"),)
    seen.contributions += (("hull-term", None), ("wind", None))
    assert ", antenna + 2 times hull-term + wind of each run, removes" in saying.said(seen).why
    seen.contributions += (("wind", None),)  # its speed, and how it turns
    assert ", antenna + 2 times hull-term + wind of each run, removes" in saying.said(seen).why
    assert ": this sum stands for" in saying.said(seen).why
    seen.contributions = seen.contributions[:1]
    assert ", antenna, removes" in saying.said(seen).why
    assert ": this stands for" in saying.said(seen).why
    seen.ends, unlike = AtEnds(("hull.Y_v",) * 5, (), 10), "5 of 10 coefficients end at the end of their range"
    assert unlike not in saying.said(seen).why  # logs first
    first, seen.contradicted = seen.contradicted, ""
    assert unlike in saying.said(seen).why
    assert saying.said(seen).headline.startswith("Something is wrong that this program cannot name.")
    assert f"{unlike}: the ship may also be unlike her profile" in saying.said(seen).why  # one cause removes 99 %
    for seen.ends, seen.explained_share in (
        (AtEnds(("hull.Y_v",) * 5, ("hull.Y_v",) * 5, 10), 0.99),
        (AtEnds(("hull.Y_v",) * 5, (), 10), 0.8),
    ):
        assert saying.said(seen).headline.startswith("This ship may be unlike her profile in many ways, which ")
        assert f"{unlike}." in saying.said(seen).why
    runs = dict(zip("abcdef", (0.4, 0.3, 0.1, 0.1, 0.1, 0.0), strict=True))
    seen.whereabouts = Whereabouts(runs, {}, {}, {}, {}, {}, (), {}, {}, {})  # as of a ship that passed by in two runs
    assert saying.said(seen).headline.startswith("Something is wrong that this program cannot name.")
    assert unlike not in saying.said(seen).why
    assert not replace(seen.whereabouts, runs=runs | {"a": 0.3, "f": 0.1}).in_few
    seen.whereabouts = None
    seen.explained_share = 0.99
    seen.contradicted = first
    said = saying.said(seen)
    assert said.headline == seen.contradicted
    assert said.explained.startswith("Something is wrong that this program cannot name. The best")


@pytest.mark.parametrize(
    ("unknown", "off", "said"),
    [
        (21.5, False, " Where it was found, an error 5 times the noise of the sensors is left: the form of what was "),
        (0.9, False, ""),
        (
            21.5,
            True,
            " What is left there is 7 times the noise of the sensors, more than coefficients known no better ",
        ),
    ],
)
def test_causes_that_leave_far_more_than_noise_are_of_another_form(unknown, off, said, monkeypatch):
    """A current that turned within half a minute was told as one that grows, and no word of what it left."""
    for name, told in (
        ("_of_the_named", "A tide."),
        ("clock_rate", ""),
        ("_at_ends", ""),
        ("_brought", ["Adding it."]),
    ):
        monkeypatch.setattr(saying, name, lambda *_, told=told: told)
    seen = SimpleNamespace(
        verdict="found",
        causes=(SimpleNamespace(tag="current", effect=object()),),
        gain=SimpleNamespace(form_is_off=off, left=7.0),
        leftover=SimpleNamespace(unknown=unknown),
        doubted=None,
        differs_by_run=False,
    )
    told = saying._of_causes(seen)
    assert told.startswith(f"A tide. Adding it.{said}")
    assert ("the form of what was found is not quite that of the ship" in told) == bool(said)


@pytest.mark.parametrize(
    ("sized", "at_ends", "told"),
    [(True, False, True), (False, False, False), (True, True, False)],
    ids=["told", "perhaps none", "at the end of its range"],
)
def test_how_large_the_best_that_is_known_would_be_is_said_where_it_is_told(sized, at_ends, told):
    """Of an antenna on a mast that swayed, found to a foot, the answer said that it removed 64 % of the error."""
    antenna = SimpleNamespace(
        tag="antenna", effect="one", runs=None, sized=sized, at_ends=at_ends, sentence="The antenna stood 24 m aft"
    )
    left = SimpleNamespace(unknown=6.4, noticed=True, offsets={}, changed={})
    seen = SimpleNamespace(
        causes=(antenna,),
        contributions=(("antenna", None),),
        contradicted="",
        looked_for_none=False,
        unclear="",
        tells_a_part=True,
        leftover=left,
        misses_test=False,
        of_a_sensor=False,
        explained_share=0.64,
        options=DiagnoseOptions(),
    )
    said = saying._of_the_unknown(seen).why
    assert said.startswith("The best of what is known, antenna, removes 64 % of the error and leaves")
    assert said.endswith("If it is a part of what is wrong, the antenna stood 24 m aft.") == told
    seen.causes *= 2
    assert "a part of what is wrong" not in saying._of_the_unknown(seen).why


@pytest.mark.parametrize(
    ("asked", "first", "last"),
    [
        ((), "this program does not know: the re-tuned model leaves", "no known cause accounts for it."),
        (("flap",), "nothing of what was looked for explains it: the re-tuned", "Only flap was looked for."),
        (
            ("flap", "antenna"),
            "nothing of what was looked for explains it: the",
            "Only flap and antenna were looked for.",
        ),
    ],
)
def test_an_answer_of_few_effects_says_that_no_others_were_looked_for(asked, first, last):
    """Of a current, with two others asked for: "no known cause accounts for it", and a ship unlike her profile."""
    left = SimpleNamespace(unknown=60.0, noticed=True, offsets={}, changed={})
    ends = SimpleNamespace(
        first="This ship is unlike.", why=lambda unclear: "Many ends.", unlike=False, from_formulas=False
    )
    seen = unexplained(leftover=left, ends=ends, options=DiagnoseOptions(effects=asked))
    said = saying.said(seen)
    assert first in said.first
    assert said.sentence.endswith(last if asked else f"{last} This ship is unlike. Many ends.")
    seen.of_a_sensor, seen.wrong_logs, seen.misread, left.noticed = True, {"r": {"a": 2.0}}, {}, False
    assert "looked for" not in saying.said(seen).sentence


@pytest.mark.parametrize(
    ("removed", "surely", "most", "too_few", "said"),
    [
        (0.96, 0.0, False, False, "removes 96 % of the error on trials not used, and runs are too few"),
        (0.96, 0.9, False, False, "Adding it removes 96 % of the error on trials not used."),
        (0.96, 0.9, False, True, "Adding it removes 96 % of the error on trials not used."),
        (0.4, 0.0, False, False, "a model whose hull may be 5 % off"),
        (
            0.4,
            0.0,
            False,
            True,
            "removes 99 % of the error where all runs are fitted together, and 40 % of it on trials not",
        ),
        (-0.1, -0.5, False, True, "of the error on trials not used does not show"),
        (0.4, 0.0, True, True, "all of the error in 2 of 3 runs left out in turn; the other shows coefficients that"),
        (0.96, 0.9, True, False, "Adding it removes 96 % of the error on trials not used."),
    ],
)
def test_how_sure_a_gain_is_stands_beside_it(removed, surely, most, too_few, said):
    gain = SimpleNamespace(
        share_removed=removed, surely_removed=surely, tells_most_runs=most, runs_told=(2, 3), too_few=too_few
    )
    seen = SimpleNamespace(gain=gain, options=SimpleNamespace(leeway=0.05), choice=None, explained_share=0.99)
    assert said in saying._gained(seen, "it", "on trials not used")


@pytest.mark.parametrize(
    ("removed", "of_hull", "said"),
    [
        (0.96, 0.3, ["Adding it removes 96 % of the error on trials not used."]),
        (
            0.96,
            0.97,
            [
                "Adding it removes 96 % of the error on trials not used.",
                "Without shallow-water the model takes TOO MUCH",
            ],
        ),
        (-0.1, 0.3, ["Re-tuned without shallow-water, the model is no worse on trials not used, but takes TOO MUCH"]),
    ],
    ids=["needless to say", "a hull further off would do", "trials not used are told as well without"],
)
def test_what_no_ship_has_is_said_where_that_decides(removed, of_hull, said):
    gain = SimpleNamespace(
        share_removed=removed,
        surely_removed=removed,
        tells_most_runs=False,
        runs_told=(1, 1),
        too_few=False,
        held_out="test",
    )
    water = Contribution(1.0, of_hull=of_hull, unlike_any="TOO MUCH")
    seen = SimpleNamespace(
        gain=gain,
        options=SimpleNamespace(leeway=0.05),
        choice=None,
        explained_share=0.99,
        causes=("one",),
        contributions=(("shallow-water", water),),
    )
    assert saying._brought(seen) == [one.replace("TOO MUCH", "TOO MUCH, as no ship has it.") for one in said]


@pytest.mark.parametrize(
    ("noticed", "structured", "chi2", "may_be"),
    [
        (False, False, 1.1, True),
        (True, False, 1.02, True),  # a receiver that wanders for minutes: 12 times the white noise, and no shape
        (True, False, 1.1, False),
        (True, True, 1.02, False),
    ],
)
def test_what_has_no_shape_and_is_next_to_nothing_may_be_noise(noticed, structured, chi2, may_be):
    judge = SimpleNamespace(before=SimpleNamespace(noticed=noticed, structured=structured))
    for runs, asked in (
        (None, may_be),
        (SimpleNamespace(in_none=False), may_be),
        (SimpleNamespace(in_none=True), True),
    ):
        result = SimpleNamespace(chi2=(chi2, 1.0), causes=[SimpleNamespace(runs=runs)])
        assert Judge._may_be_noise(judge, result) is asked  # of values that no run has for certain nothing is left


@pytest.mark.parametrize(
    ("trace", "removed"),
    [
        (SMALL_BUT_CLEAR, 0.04),
        (replace(SMALL_BUT_CLEAR, share=-0.1), 0.0),  # it does harm: what it bends to is something else
        (replace(SMALL_BUT_CLEAR, of_hull=1.0), 0.0),
        (None, 0.0),
    ],
)
def test_what_traces_remove_is_accounted_for_where_they_are_no_other_thing(trace, removed, monkeypatch):
    monkeypatch.setattr(contributed, "leftover", lambda bench, point: SimpleNamespace(unknown=point))
    traces = [SimpleNamespace(contribution=trace)] if trace else []
    assert removed_by(None, traces, 0.01, 0.05) == pytest.approx(removed)


@pytest.mark.parametrize(
    ("fading", "said"),
    [
        ({}, ""),
        ({"x": 0.9, "y": 1.4}, ""),  # a few times the white part, as of many receivers
        ({"x": 1.8, "y": 2.4, "psi": 0.74 * DEG}, "2.4 m in the positions and 0.74° in the heading, count as noise"),
        ({"psi": 0.74 * DEG}, "Errors that fade slowly, 0.74° in the heading"),
        ({"u": 1.0}, ""),
    ],
)
def test_slow_errors_that_count_as_noise_are_told(fading, said):
    """Time stamps that jittered by 1.2 s were no more than "the noise of the measurements"."""
    white = {"x": 0.3, "y": 0.3, "psi": 0.1 * DEG, "u": 0.02}
    noise = {name: {"white": one, "fading": fading.get(name, 0.0)} for name, one in white.items()}
    told = saying._fading(SimpleNamespace(noise=noise))
    assert said in told
    assert bool(told) == bool(said)


@pytest.mark.parametrize(
    ("before", "left", "share"),
    [((0.0, 8.97), (0.0, 0.4), 0.96), ((8.97, 0.0), (0.36, 0.0), 0.96), ((0.0, 8.97), (0.0, 8.97), 0.0)],
    ids=["a stall that inputs of 10 s excused", "one that they do not", "what inputs leave open and no cause removes"],
)
def test_what_inputs_may_have_left_open_is_explained_where_a_cause_removes_it(before, left, share):
    """Each by what is in excess of the noise, and what inputs may have left open besides."""
    known = [SimpleNamespace(excess=one, unknown=one, left_open=left_open) for one, left_open in (before, left)]
    assert judging._explained(SimpleNamespace(causes=["stall"]), *known) == pytest.approx(share, abs=0.01)
    assert judging._explained(SimpleNamespace(causes=[]), *known) == 0.0
