"""Fitted points on trials that they were not fitted to."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter

from mmgtune.backends import Integrator
from mmgtune.diagnose import DiagnoseOptions
from mmgtune.diagnose.bench.hypotheses import known_causes
from mmgtune.diagnose.bench.noise import ChannelNoise
from mmgtune.diagnose.bench.workbench import Point, Workbench, make_workbench
from mmgtune.diagnose.held_out.gain import Gain, held_out
from mmgtune.diagnose.held_out.unseen import Beside, Unseen
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.diagnose.searching.search import Found
from mmgtune.fitting import ComparedTrials
from mmgtune.motions import simulate_trials
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import load_trials
from tests.diagnose.sensors import NOISE, logged
from tests.hidden.cases import of_runs
from tests.hidden.plant import simulate, write

LAG = "effects.steering-lag.time_constant"


def test_values_of_runs_are_estimated_in_runs_held_out_and_each_run_is_compared_with_its_own(tmp_path):
    case = of_runs("current", 3, seed=1)
    write(simulate({}, case.effects, case.seed, case.noise, case.of_trial), tmp_path)
    trials = load_trials(tmp_path)
    seen = [trial for name, trial in trials.trials.items() if name not in trials.test][:2]
    test = [trials.trials[name] for name in sorted(trials.test)[:2]]
    wanted = ("effects.current.north", "effects.current.east")
    bench = make_workbench(load_profile("suzaku"), seen, DiagnoseOptions(targets=("hull.R_0",)), wanted)
    names = (*bench.targets, *(f"{name}@trial:{trial.whole}" for trial in seen for name in wanted))
    none = Point(bench.targets, bench.null(bench.targets), np.zeros((2, 6)), 0.0, Integrator())
    spreads = dict.fromkeys((f"{name}@trial" for name in wanted), 0.5)
    each = Point(names, bench.null(names), np.zeros((2, 6)), 0.0, Integrator(), spreads)
    beside = Beside.of(bench, (none, each), test)
    assert set(names) < set(beside.wide.names)
    values = dict(zip(beside.wide.names, bench.sub_box(beside.wide.names).from_unit(beside.units[-1]), strict=True))
    for trial, compared in zip(test, beside.compared(), strict=True):
        truth = case.of_trial[trial.whole]["current"]
        for name in wanted:
            assert abs(values[f"{name}@trial:{trial.whole}"] - truth[name.rpartition(".")[2]]) < 0.03
        assert compared.trial is trial
        assert compared.J["after"] < 0.1 * compared.J["before"]


@pytest.mark.parametrize(
    ("before", "after", "worse"),
    [
        ((800, 700), (900, 820), True),
        ((16_000, 8_000), (1_700, 40_000), False),
        ((800, 700), (810, 705), False),
        ((8, 7), (12, 10), False),
    ],
    ids=["every run", "one of two", "hardly", "as chance would"],
)
def test_causes_are_told_worse_by_most_test_trials_or_not_at_all(before, after, worse):
    excess = np.column_stack([before, after]).astype(float)
    gain = Gain("test", ComparedTrials(), excess, floor=100.0, chance=5.0)
    assert gain.worse is worse
    assert gain.mostly_remains  # in all of these
    assert not Gain("test", ComparedTrials(), excess, floor=100.0, chance=5.0, unsure=1e5).mostly_remains
    assert not Gain("each", ComparedTrials(), excess, floor=100.0, chance=5.0).worse


@pytest.mark.parametrize(
    ("after", "held_out", "unsure", "off"),
    [
        ((1_500, 900), "test", 0.0, True),
        ((1_500, 900), "test", 1_000.0, False),
        ((1_500, 900), "each", 0.0, False),
        ((20, 15), "test", 0.0, False),
        ((40_000, 20_000), "test", 0.0, False),
    ],
    ids=["a rudder slower under load", "coefficients known no better", "left out in turn", "noise", "most remains"],
)
def test_a_cause_of_another_form_leaves_far_more_than_noise_on_test_trials(after, held_out, unsure, off):
    excess = np.column_stack([(60_000, 30_000), after]).astype(float)
    assert Gain(held_out, ComparedTrials(), excess, floor=100.0, chance=5.0, unsure=unsure).form_is_off is off


def left_out(*excess: tuple[float, float], held_out="each") -> Gain:
    """Runs of 100 samples each that were left out in turn, with chi-squared beyond noise before and after causes."""
    compared = [SimpleNamespace(trial=SimpleNamespace(run=str(k), n_samples=100)) for k in range(len(excess))]
    return Gain(held_out, ComparedTrials(compared), np.array(excess), floor=600.0 * len(excess), chance=40.0)


@pytest.mark.parametrize(
    ("gain", "told", "remains"),
    [
        (left_out((3e5, 40.0), (1.5e8, 9e7), (1e6, 30.0)), (2, 3), False),
        (left_out((3e5, 40.0), (1.5e8, 9e7), (1e6, 2e5)), (1, 3), True),
        (left_out((3e5, 40.0), (1.5e8, 1.6e8), (1e6, 30.0)), (0, 3), True),
        (left_out((50.0, 40.0), (1.5e8, 9e7), (60.0, 30.0)), (0, 3), True),
        (left_out((3e5, 40.0), (1.5e8, 9e7)), (1, 2), True),
        (left_out((3e5, 40.0), (1.5e8, 9e7), (1e6, 30.0), held_out="test"), (0, 3), True),
    ],
    ids=["two of three", "one of three", "one is worse", "nothing to tell", "one of two", "kept for testing"],
)
def test_a_run_that_alone_shows_a_coefficient_does_not_refute_what_tells_the_others(gain, told, remains):
    assert gain.runs_told == told
    assert gain.remains is remains


def test_a_run_told_worse_refutes_nothing_where_coefficients_are_known_no_better():
    gain = left_out((3e5, 40.0), (1.5e6, 1.6e8), (1e6, 30.0))
    assert gain.runs_told == (0, 3)
    assert replace(gain, unsure=1.5e8).runs_told == (0, 3)
    assert replace(gain, unsure=1.7e8).runs_told == (2, 3)


def test_positions_that_wander_do_not_hide_what_a_cause_explains_of_unseen_trials():
    """A receiver errs by a metre for minutes, and the rudder lags: heading and yaw rate show what that explains."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(3)
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "turn_m20", "zigzag_20", "zigzag_10")]
    ship = with_effects(profile, {"steering-lag": {"time_constant": 1.5}}, "made")
    noise = ChannelNoise(phi=0.99, fading=100.0)  # in white noise of the sensors
    small = np.array([0.1, 0.1, *NOISE[2:]])
    made = []
    for trial, motion in zip(trials, simulate_trials(ship, trials), strict=True):
        one = logged(trial, motion, rng, small)
        steps = np.sqrt(1.0 - noise.phi**2) * rng.standard_normal((2, one.n_samples))
        steps[:, 0] = rng.standard_normal(2)
        x, y = small[:2, None] * lfilter([np.sqrt(noise.fading)], [1.0, -noise.phi], steps, axis=1)
        made.append(replace(one, x=one.x + x, y=one.y + y))
    options = DiagnoseOptions(targets=("hull.R_0", "hull.N_v", "hull.N_r"))
    (cause,) = [one for one in known_causes(profile, made, options) if one.names == (LAG,)]
    bench = make_workbench(profile, made[:2], options, cause.names)
    bench.know(replace(bench.noise, channels=bench.noise.channels | {"x": noise, "y": noise}))
    base = base_fit(bench)
    final = bench.refit((*base.names, LAG), np.append(base.unit, 0.2)[:, None], base.offsets)
    gain = held_out(Found(base, final, [cause]), Unseen(bench, made[2:]))
    assert gain.floor == 6 * sum(one.n_samples for one in made[2:])
    assert abs(gain.excess[:, 1].sum()) < 4.0 * gain.chance
    assert gain.share_removed > 0.9
    assert not gain.remains
    # A heading that wanders as far may be an error of the model, and is counted with its memory.
    bench.know(replace(bench.noise, channels=bench.noise.channels | {"psi": noise}))
    assert bench.noise.may_be_error
    counted = held_out(Found(base, final, [cause]), Unseen(bench, made[2:]))
    assert counted.floor == pytest.approx(sum(one.n_samples for one in made[2:]) * (3 * 101.0 + 3.0), rel=0.1)


def test_runs_that_the_others_tell_badly_are_too_few():
    assert left_out((5e3, 5e3), (200.0, 200.0)).too_few
    assert not left_out((300.0, 300.0), (200.0, 200.0)).too_few
    assert not left_out((5e3, 5e3), (200.0, 200.0), held_out="test").too_few


def test_a_point_is_refitted_without_each_run_once(monkeypatch):
    seen = [load_trials("suzaku").trials[name] for name in ("turn_p35", "turn_m35")]
    bench = make_workbench(load_profile("suzaku"), seen, DiagnoseOptions(targets=("hull.R_0",)))
    first, second = (Point(bench.targets, bench.null(bench.targets), np.zeros((2, 6)), 0.0, Integrator()) for _ in "ab")
    made = []
    refits = Workbench.refits
    monkeypatch.setattr(Workbench, "refits", lambda self, *a, **k: made.append(self) or refits(self, *a, **k))
    unseen = Unseen(bench, ())
    once = [points for points, _ in unseen.fits((first,))]
    again = [points for points, _ in unseen.fits((first, second))]
    assert len(made) == 4
    assert [points[0] for points in again] == [points[0] for points in once]
    assert [trials for _, trials in unseen.fits((first,))] == [[seen[0]], [seen[1]]]
    assert next(iter(Unseen(bench, seen[:1]).fits((first,)))) == ([first], seen[:1])
