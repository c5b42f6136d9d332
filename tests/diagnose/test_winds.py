"""Winds whose force is off the formulas, in gusts: neither hides them, nor passes for something else."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.diagnose.answering import judging
from mmgtune.diagnose.answering.judging import _deformed
from mmgtune.diagnose.bench import beliefs, wave_groups, winds
from mmgtune.diagnose.bench.hypotheses import known_causes
from mmgtune.diagnose.bench.inputs import DRAWS, changes
from mmgtune.diagnose.bench.winds import ALONG, other_winds
from mmgtune.diagnose.bench.workbench import TOLERANCE, make_workbench
from mmgtune.diagnose.causes.cause import Cause
from mmgtune.diagnose.evidence.leftover import leftover
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.diagnose.searching.look import look
from mmgtune.diagnose.signatures.intervals import Estimate
from mmgtune.diagnose.signatures.linear import linearise
from mmgtune.diagnose.signatures.retuned import retuned, weighed
from mmgtune.effects import find_effect
from mmgtune.model import Model
from mmgtune.motions import simulate_trials
from mmgtune.physics.frame import to_ship
from mmgtune.physics.quantities import Surroundings
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import load_trials
from mmgtune.units import DEG
from tests.diagnose.evidence.made import make_trials
from tests.diagnose.sensors import logged

WIND = ("effects.wind.speed", "effects.wind.direction")
OFF = {"ahead": 0.75, "across": 1.3, "turning": 2.2, "arm": 0.04}


@pytest.fixture(scope="module")
def sailed():
    """Runs in a wind of 8 m/s from 40 deg on a ship whose wind force is not that of the formulas."""
    profile = load_profile("suzaku")
    rng = np.random.default_rng(3)
    windy = with_effects(profile, {"wind": {"speed": 8.0, "direction": 40.0 * DEG, **OFF}}, "made")
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "turn_m20", "zigzag_20")]
    made = []
    for trial, motion in zip(trials, simulate_trials(windy, trials), strict=True):
        made.append(logged(trial, motion, rng))
    return profile, made


def wind_on(profile, trials, **options):
    """A workbench, the wind fitted on it together with the targets, and what it is."""
    bench = make_workbench(profile, trials, DiagnoseOptions(integrator="rk4", **options), WIND)
    base = base_fit(bench)
    names = (*base.names, *WIND)
    start = np.append(base.unit, bench.sub_box(WIND).to_unit(np.array([6.0, 1.0])))
    point = bench.refit(names, start[:, None], base.offsets)
    return bench, point, bench.values(point)


@pytest.mark.long
def test_the_wind_is_found_though_its_force_is_off_the_formulas(sailed):
    bench, point, found = wind_on(*sailed)
    assert point.names[:4] == tuple(f"effects.wind.{name}" for name in OFF)
    assert point.names[-2:] == WIND
    assert point.chi2 / bench.problem.n_residuals < 1.05
    assert found["effects.wind.direction"] == pytest.approx(40.0 * DEG, abs=3.0 * DEG)
    # What counts is force: the speed is as well known as the factors on it are believed.
    assert found["effects.wind.speed"] ** 2 * found["effects.wind.across"] == pytest.approx(64.0 * 1.3, rel=0.15)
    assert found["effects.wind.turning"] == pytest.approx(2.2, abs=0.4)
    held, stiff, _ = wind_on(*sailed, leeway=0.0)
    assert not held.believed.forms
    assert stiff.chi2 - point.chi2 > 1000.0


def test_a_form_goes_with_its_effect(sailed):
    bench, point, _ = wind_on(*sailed)
    kept = [k for k, name in enumerate(point.names) if name not in WIND]
    names = [point.names[k] for k in kept]
    without = bench.refit(names, point.unit[kept][:, None], point.offsets, max_iterations=2)
    assert not set(without.names) & set(bench.believed.forms)


def test_a_problem_made_linear_knows_what_is_believed_of_forms(sailed):
    bench, point, _ = wind_on(*sailed)
    linear = linearise(bench, point)
    assert np.sum(linear.residual**2) == pytest.approx(point.chi2, abs=TOLERANCE)


def blown(profile, trials, speed=12.0):
    """Runs in a wind that was measured, on the ship of ``sailed``."""
    rng = np.random.default_rng(8)
    windy = with_effects(profile, {"wind": {"measured": 1.0, **OFF}}, "made")
    air = {"wind_speed": speed, "wind_dir": 40.0 * DEG}
    seen = [replace(one, extra={name: np.full(one.n_samples, value) for name, value in air.items()}) for one in trials]
    return [logged(one, motion, rng) for one, motion in zip(seen, simulate_trials(windy, seen), strict=True)]


def test_a_measured_wind_off_its_formulas_is_not_taken_up_by_the_hull(sailed):
    """No cause has to be named for it: a profile that has the wind has its formulas, which are off for every ship."""
    profile, trials = sailed
    own = with_effects(profile, {"wind": {"measured": 1.0}}, "as logged")
    bench = make_workbench(own, blown(profile, trials), DiagnoseOptions())
    point = base_fit(bench)
    assert point.chi2 / bench.problem.n_residuals < 1.05
    assert bench.values(point)["effects.wind.turning"] == pytest.approx(2.2, abs=0.4)
    moved = retuned(bench, point)
    assert weighed(moved).startswith("The wind of the profile fits best with factor on the moment of the formulas")
    stiff = make_workbench(own, bench.trials, DiagnoseOptions())
    stiff.believed = replace(stiff.believed, acting=frozenset())
    assert base_fit(stiff).chi2 > 1.5 * point.chi2
    assert not make_workbench(own, trials, DiagnoseOptions()).believed.of_acting  # nobody measured a wind


def test_nothing_wavers_where_no_wind_blows(sailed):
    profile, trials = sailed
    bench = make_workbench(profile, trials, DiagnoseOptions(), WIND)
    problem = bench.problem_of(bench.targets)
    theta = problem.theta(bench.null(bench.targets)[:, None])
    around, each = other_winds(problem.model, theta, problem.cases, 3, seed=0)
    np.testing.assert_array_equal(around, np.repeat(problem.cases.around[:, None], 4, axis=1))
    np.testing.assert_array_equal(each, np.broadcast_to(theta[:, None], each.shape))


def test_winds_that_may_have_blown_as_well(sailed):
    """The first is the steady one, simulated as if it had been measured; the others waver about it."""
    profile, trials = sailed
    model = Model(with_effects(profile, {"wind": {"speed": 8.0, "direction": 40.0 * DEG}}, "made"))
    cases = make_workbench(profile, trials, DiagnoseOptions(), WIND).problem.cases
    around, each = other_winds(model, model.matrix(), cases, 400, seed=1)
    north, east = (around[..., Surroundings._fields.index(f"wind_{name}")] for name in ("north", "east"))
    np.testing.assert_allclose(np.hypot(north, east)[:, 0], 8.0)
    np.testing.assert_allclose(np.arctan2(-east, -north)[:, 0], 40.0 * DEG)
    along = -north * np.cos(40.0 * DEG) - east * np.sin(40.0 * DEG)
    assert np.std(along[:, 1:]) == pytest.approx(8.0 * ALONG, rel=0.05)
    assert np.mean(along[:, 1:]) == pytest.approx(8.0, rel=0.01)
    lasting = along[:, 1:, : cases.n_samples[0]] - 8.0
    dt = float(np.diff(cases.t[0])[0])
    later = round(250.0 / 8.0 / dt)  # they fade to 1/e while 250 m of air pass
    kept = np.mean(lasting[0, :, later:] * lasting[0, :, :-later]) / np.mean(lasting[0] ** 2)
    assert kept == pytest.approx(np.exp(-1.0), abs=0.08)
    shape = each[model.rows["above_water.Y_1"], :, 1:]
    assert 0.0 < np.std(shape) < 0.3
    np.testing.assert_array_equal(shape[0], shape[1])  # one ship in all runs


def test_gusts_are_no_unknown_cause(sailed):
    """What they leave is excused, what a calm model leaves is not."""
    profile, trials = sailed
    rng = np.random.default_rng(8)
    windy = with_effects(profile, {"wind": {"measured": 1.0, **OFF}}, "made")
    made = []
    for trial in trials:
        gusts = 1.0 + 0.08 * np.sqrt(2.0) * np.sin(0.04 * trial.t + rng.uniform(0.0, 6.0))
        air = {"wind_speed": 8.0 * gusts, "wind_dir": np.full(trial.n_samples, 40.0 * DEG)}
        (motion,) = simulate_trials(windy, [replace(trial, extra=air)])
        made.append(logged(trial, motion, rng))
    bench, point, found = wind_on(profile, made)
    assert found["effects.wind.direction"] == pytest.approx(40.0 * DEG, abs=8.0 * DEG)
    problem = bench.problem_of(point.names, point.integrator)
    moved = changes(problem, point.unit, point.offsets, seed=0)
    assert moved.shape == (bench.problem.n_residuals, DRAWS)
    left = leftover(bench, point)
    assert point.chi2 / bench.problem.n_residuals > 1.2
    assert left.excess < 0.05 < left.left_open
    assert leftover(bench, base_fit(bench)).excess > 5.0


@pytest.mark.long
def test_gusts_are_no_larger_than_is_seen(sailed):
    bench, point, _ = wind_on(*sailed)
    linear, n = linearise(bench, point), bench.problem.n_residuals
    none = linear.residual[:, None][:, :0]
    usual = float(np.mean(np.sum(linear.wander**2, axis=0)))
    assert usual > 0.5 * n
    seen = linear.with_inputs_seen(point.chi2, none)  # the wind was steady
    left = np.sum(seen.wander**2, axis=0)
    assert 0.0 < left.min() < 0.05 * n
    np.testing.assert_allclose(
        left / left.min(), np.sum(linear.wander**2, axis=0) / np.sum(linear.wander**2, axis=0).min()
    )
    np.testing.assert_array_equal(seen.signature, linear.signature)
    assert linear.with_inputs_seen(n + usual, none) is linear
    explained = linear.with_inputs_seen(point.chi2, linear.wander[:, :4])  # they were seen in none of what is explained
    assert np.sum(explained.wander**2) > np.sum(seen.wander**2)
    assert linear.with_inputs_seen(point.chi2, linear.wander) is linear


@pytest.mark.daily("0.12-0.0")
@pytest.mark.parametrize(("gusts", "time_constant"), [(0.0, 4.0), (0.12, 0.0)])
def test_a_cause_beside_a_wind_is_told(gusts, time_constant):
    """A lag of the rudder is believed beside a steady wind, and nothing is that gusts left."""
    profile = load_profile("suzaku")
    rng = np.random.default_rng(5)
    lag = {"steering-lag": {"time_constant": time_constant}} if time_constant else {}
    ship = with_effects(profile, {"wind": {"measured": 1.0}, **lag}, "made")
    made = []
    for name in ("turn_p35", "turn_m20", "zigzag_20"):
        trial = load_trials("suzaku").trials[name]
        speed = np.full(trial.n_samples, 9.0)
        for k in range(1, trial.n_samples):  # a sample a second, 250 m long
            speed[k] = 9.0 + 0.965 * (speed[k - 1] - 9.0) + 0.262 * 9.0 * gusts * rng.standard_normal()
        air = {"wind_speed": speed, "wind_dir": np.full(trial.n_samples, 40.0 * DEG)}
        (motion,) = simulate_trials(ship, [replace(trial, extra=air)])
        made.append(logged(trial, motion, rng))
    options = DiagnoseOptions(
        integrator="rk4", effects=("wind", "steering-lag", "memory", "governor-lag", "rudder-gain")
    )
    known = known_causes(profile, made, options)
    bench = make_workbench(profile, made, options, [name for one in known for name in one.names])
    base = base_fit(bench)
    start = np.append(base.unit, bench.sub_box(WIND).to_unit(np.array([9.0, 40.0 * DEG])))
    point = bench.refit((*base.names, *WIND), start[:, None], base.offsets)
    step = look(bench, point, [one for one in known if one.tag != "wind"], first=False)
    assert step.accepted == bool(lag)
    if lag:
        assert step.refits[0].hypothesis.tag == "steering-lag"


def test_what_is_believed_beforehand_is_told():
    wind, lag = find_effect("wind"), find_effect("steering-lag")
    rows = (*beliefs.in_words(0.05, [wind, lag], 0), *winds.in_words([wind, lag]))
    told = {one["name"]: one["value"] for one in rows}
    assert told[", ".join(beliefs.OF_HULL)].endswith("5 %")
    assert told["propeller.K_T0, propeller.k_0"].endswith("1.5 %")
    assert told["rudder.f_alpha, rudder.f_a0, rudder.c_l01"].endswith("1 %")
    assert told["effects.wind.turning"] == "1 with a standard deviation of 0.5"
    assert told["effects.wind.arm"] == "0 with a standard deviation of 0.05"
    assert "12 %" in told["gusts"]
    assert len(told) == 4 + len(wind.form) + 1
    assert beliefs.in_words(0.0, [wind], 0) == winds.in_words([lag]) == []
    (tuned,) = beliefs.in_words(0.0, [wind], 31)
    assert tuned["name"] == "31 targets from formulas"


def test_a_form_at_the_end_of_its_range_is_told():
    """A wind of 8 m/s on another hull was 6.2 +- 0.7 m/s, with two and a half times the force across."""
    wind = find_effect("wind")
    sizes = {"speed": (6.2, 5.5, 6.9), "across": (2.5, 2.1, 2.5), "turning": (1.4, 0.8, 2.0)}
    estimated = {
        f"effects.wind.{name}": Estimate(name, *values, 0.1, at_end=name == "across") for name, values in sizes.items()
    }
    (said,) = _deformed([Cause("wind", wind, estimated, 0.0, None), Cause("integration-step", None, {}, 0.0, None)])
    assert "Of wind a part of its form ended at the end of its range (factor on the force across" in said
    assert "2.5)" in said
    inside = {name: one for name, one in estimated.items() if not name.endswith("across")}
    assert not _deformed([Cause("wind", wind, inside, 0.0, None)])


def test_a_stall_all_at_once_is_no_end_of_its_form():
    """A sharp stall at 23.9 deg for 24 was told to be of no known form."""
    stall = find_effect("rudder-stall")
    sizes = {"angle": (0.417, 0.414, 0.420), "slope": (0.0, -0.04, 0.03), "width": (4e-4, 7e-8, 0.1)}
    estimated = {
        f"effects.rudder-stall.{name}": Estimate(name, *values, 0.1, at_end=name == "width")
        for name, values in sizes.items()
    }
    assert not _deformed([Cause("rudder-stall", stall, estimated, 0.0, None)])


def test_the_mean_force_of_waves_differs_from_run_to_run(sailed):
    """By groups: half as much in a run four times as long, and nothing where no such force acts."""
    _, (trial, *_) = sailed
    wavy = Model(with_effects(load_profile("suzaku"), {"wave-drift": {"force": 4000.0, "direction": 1.0}}, "a test"))
    cases = SimpleNamespace(t=np.stack([trial.t, 4.0 * trial.t]))
    theta = np.repeat(np.repeat(wavy.matrix()[:, None], 2, axis=1), 4001, axis=2)
    drawn = wave_groups.other_waves(wavy, theta, cases, seed=1)
    force = wavy.rows["effects.wave-drift.force"]
    assert (drawn[:, :, 0] == theta[:, :, 0]).all()
    short, long = np.std(drawn[force, :, 1:], axis=1) / 4000.0
    lasting, duration = 8.0 * np.sqrt(wavy.L_pp / 9.81), np.ptp(trial.t)
    assert short == pytest.approx(0.3 * np.sqrt(2.0 * lasting / duration), rel=0.05)
    assert long == pytest.approx(0.5 * short, rel=0.05)
    assert np.mean(drawn[force, :, 1:]) == pytest.approx(4000.0, rel=0.01)
    others = [row for row in range(len(theta)) if row != force]
    assert (drawn[others] == theta[others]).all()
    calm = Model(load_profile("suzaku"))
    plain = np.repeat(calm.matrix()[:, None], 2, axis=1)
    assert wave_groups.other_waves(calm, plain, cases, seed=1) is plain


def test_what_is_assumed_of_waves_is_said_where_they_are_found():
    wave, lag = find_effect("wave-drift"), find_effect("steering-lag")
    (told,) = wave_groups.in_words([wave, lag])
    assert told["name"] == "groups of waves"
    assert "30 % of the mean force" in told["value"]
    assert wave_groups.in_words([lag]) == []


@pytest.mark.long
def test_a_wind_that_pushes_by_another_formula_is_not_two_causes():
    """It was "a wind of 3.9 m/s, and a force of 13 kN as of waves from there"; 8 m/s blew."""
    profile, speed, blows_from = load_profile("suzaku"), 8.0, 240.0 * DEG
    A_T, A_L = (profile.value(f"above_water.{name}") for name in ("A_T", "A_L"))

    def pushed(state):
        north = -speed * np.cos(blows_from) - state.u * np.cos(state.psi) + state.v_m * np.sin(state.psi)
        east = -speed * np.sin(blows_from) - state.u * np.sin(state.psi) - state.v_m * np.cos(state.psi)
        ahead, starboard = to_ship(state.psi, north, east)
        q, a = 0.5 * 1.225 * (ahead**2 + starboard**2), np.arctan2(-starboard, -ahead)
        turning = -0.09 * q * A_L * profile.L_pp * np.sin(2.0 * a)
        return -0.7 * q * A_T * np.cos(a), -0.85 * q * A_L * np.sin(a), turning

    trials = make_trials(Model(profile), beside=pushed, noise=0.5)
    result = diagnose(profile, trials, DiagnoseOptions(effects=("wind", "wave-drift", "current")))
    (told,) = result.causes
    assert {told.tag, *result.groups[0]} == {"wind", "wave-drift"}, result.sentence()
    assert result.verdict == "not-separable"


@pytest.mark.parametrize(
    ("tags", "by", "seen", "far", "holds", "told"),
    [
        (("wind", "wave-drift"), "", (0.03, 0.01), True, True, "wind"),
        (("wave-drift", "wind"), "", (0.01, 0.03), True, True, "wind"),
        (("wind", "wave-drift"), "", (0.11, 0.01), True, True, ""),
        (("wind", "wave-drift"), "", (0.03, 0.01), False, True, ""),  # as the formulas of both have them
        (("wind", "wave-drift"), "", (0.03, 0.01), True, False, ""),
        (("wind", "wave-drift"), "trial", (0.03, 0.01), True, True, ""),  # values of runs bend to anything
        (("wind", "current"), "", (0.03, 0.01), True, True, ""),
    ],
    ids=["either", "the other", "needed", "of their form", "one does not do", "of each run", "unlike"],
)
def test_of_two_that_act_alike_one_is_told(tags, by, seen, far, holds, told, monkeypatch):
    causes = [SimpleNamespace(tag=tag, effect=find_effect(tag), by=by) for tag in tags]
    found = SimpleNamespace(causes=causes, final=None)
    brought = tuple((one.tag, SimpleNamespace(seen=share)) for one, share in zip(causes, seen, strict=True))
    result = Answered(contributions=brought)
    monkeypatch.setattr(judging, "with_only", lambda bench, found, causes: SimpleNamespace(causes=causes))
    monkeypatch.setattr(judging, "contributions", lambda *asked: [])
    judge = SimpleNamespace(
        bench=SimpleNamespace(is_deformed=lambda point, effect: far),
        unseen=None,
        _judged=lambda found, brought: found,
        _compared=lambda result, found: Answered(((found.causes[0].tag, None),), (), holds, holds),
    )
    answer, left = judging.Judge._one_of_kin(judge, result, found)
    assert [one.tag for one in left.causes] == ([told] if told else list(tags))
    assert answer.groups == (((told, *({*tags} - {told})),) if told else ())


@dataclass
class Answered:
    """What an answer has of those causes."""

    contributions: tuple = ()
    groups: tuple = ()
    names_causes: bool = True
    explains_nearly_all: bool = True
