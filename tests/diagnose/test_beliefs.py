"""Coefficients of the hull that are not tuned, and are a few per cent off: no cause, and nothing that hides one."""

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.diagnose.answering.detecting import told_apart
from mmgtune.diagnose.bench.beliefs import let_go, part_of
from mmgtune.diagnose.bench.workbench import Point, make_workbench
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.diagnose.signatures.intervals import estimates
from mmgtune.diagnose.signatures.linear import BOXED, Tuned, _from_bounds, linearise
from mmgtune.model import Model
from mmgtune.motions import simulate_trials
from mmgtune.profile import load_profile, tuned
from mmgtune.trial import load_trials
from tests.diagnose.sensors import logged


@pytest.fixture(scope="module")
def sailed():
    """Runs of a ship that is not quite the profile's: each coefficient of the hull off by 4 % or so."""
    profile = load_profile("suzaku")
    rng = np.random.default_rng(5)
    names = let_go(Model(profile), profile.targets, ())
    off = {name: profile.value(name) * (1.0 + 0.04 * part_of(name) * rng.standard_normal()) for name in names}
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "turn_m20", "zigzag_20")]
    made = []
    for trial, motion in zip(trials, simulate_trials(tuned(profile, off, {}, {}, "made"), trials), strict=True):
        made.append(logged(trial, motion, rng))
    return profile, made


def test_a_hull_a_little_off_is_no_error_beyond_noise(sailed):
    profile, trials = sailed
    left = {}
    for leeway in (0.0, 0.05):
        bench = make_workbench(profile, trials, DiagnoseOptions(leeway=leeway))
        bench.integrate(Integrator("rk4"))
        point = base_fit(bench)
        left[leeway] = point.chi2 / bench.problem.n_residuals
    assert left[0.0] > 1.05
    assert left[0.05] < 1.04  # what is believed of coefficients counted in
    moved = np.array([bench.values(point)[name] / profile.value(name) - 1.0 for name in bench.believed.leeway])
    assert 0.005 < np.sqrt(np.mean(moved**2)) < 0.1


def test_a_problem_made_linear_knows_what_fits_know(sailed):
    """A fall of chi-squared that it promises for a cause is that of the fit, coefficients with leeway re-tuned."""
    profile, trials = sailed
    bench = make_workbench(profile, trials, DiagnoseOptions(), ["effects.rudder-offset.angle"])
    point = base_fit(bench)
    linear = linearise(bench, point, ["effects.rudder-offset.angle"])
    assert np.sum(linear.residual**2) == pytest.approx(point.chi2, rel=1e-5)
    (direction,) = (linear.signature / np.linalg.norm(linear.signature, axis=0)).T
    promised = float(direction @ linear.residual) ** 2
    start = np.append(point.unit, bench.null(["effects.rudder-offset.angle"]))[:, None]
    end = bench.refit((*point.names, "effects.rudder-offset.angle"), start, point.offsets, tolerance=0.01)
    assert point.chi2 - end.chi2 == pytest.approx(promised, rel=0.2, abs=0.3)


def test_what_is_left_of_noise_and_leeway_together_has_variance_one():
    rng = np.random.default_rng(0)
    free, loose = rng.standard_normal((40, 3)), rng.standard_normal((40, 5)) * [0.01, 0.3, 1.0, 5.0, 200.0]
    taken = Tuned.by(free, loose)
    left = taken.out_of(np.eye(40))
    spread = left @ (np.eye(40) + loose @ loose.T) @ left.T
    Q = taken.free
    np.testing.assert_allclose(spread, np.eye(40) - Q @ Q.T, atol=1e-8)


@pytest.mark.parametrize("name", ["suzaku", "kvlcc2", "esso_osaka", "esso_osaka_3m", "vectwin_3m"])
def test_nothing_that_is_tuned_or_held_has_leeway(name):
    profile = load_profile(name)
    loose = let_go(Model(profile), profile.targets, ("N_v",))
    assert not set(loose) & {*profile.targets, "hull.N_v"}
    assert all(profile.value(one) != 0.0 for one in loose)
    kinds = {one.partition(".")[0] for one in loose}
    assert kinds <= {"hull", "particulars", "wake", "propeller", "rudder"}


@pytest.mark.daily("K_T0")
@pytest.mark.parametrize(("name", "factor"), [("propeller.K_T0", 1.06), ("propeller.C_PY0", 0.92)])
def test_curves_of_a_propeller_a_little_off_are_no_cause(name, factor):
    """Thrust and side force some per cent off the profile's were a tow, and a thruster left on."""
    profile = load_profile("suzaku")
    ship = tuned(profile, {name: factor * profile.value(name)}, {}, {}, "made")
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "turn_m20", "zigzag_20", "zigzag_10")]
    rng = np.random.default_rng(5)
    made = [logged(one, motion, rng) for one, motion in zip(trials, simulate_trials(ship, trials), strict=True)]
    asked = ("thrust", "steady-force", "propeller-side-force")
    verdicts = {}
    for leeway in (0.0, 0.05):
        verdicts[leeway] = diagnose(profile, made, DiagnoseOptions(effects=asked, leeway=leeway)).verdict
    assert verdicts[0.05] == "none"
    assert verdicts[0.0] != "none"


def test_no_leeway_is_nothing_beside_the_targets(suzaku):
    trials = [load_trials("suzaku").trials["zigzag_10"]]
    bench = make_workbench(suzaku.profile, trials, DiagnoseOptions(leeway=0.0))
    assert bench.tuned_alone == bench.targets
    assert bench.beliefs(bench.targets, {}) is None


@pytest.mark.long
def test_limits_of_detection_are_those_of_a_hull_that_follows(sailed):
    """Shallow water changes coefficients that have leeway: it shows only where they would have to go far."""
    profile, trials = sailed
    depth = "effects.shallow-water.depth"
    apart = {}
    for leeway in (0.0, 0.05):
        bench = make_workbench(profile, trials, DiagnoseOptions(leeway=leeway), [depth])
        bench.integrate(Integrator("rk4"))
        linear = linearise(bench, base_fit(bench), [depth])
        apart[leeway] = told_apart(linear, [depth])
        typical, _ = (np.linalg.norm(look) for look in linear.looks([depth]))
    assert apart[0.05] < 0.5 * typical  # what is left of a large change because it bends does not count
    assert apart[0.05] < 0.1 * apart[0.0]


def test_a_wake_a_little_off_is_no_hull_term():
    """The tanker tunes two coefficients of her wake of five: errors of the others were N_r|r|, or a memory."""
    loose = let_go(Model(load_profile("kvlcc2")), load_profile("kvlcc2").targets, ())
    assert {"wake.C_2p", "wake.C_2n"} <= set(loose)
    assert "wake.x_P_" not in loose  # a length from a drawing


def test_an_interval_knows_how_far_targets_can_go(sailed):
    """An antenna was told to 51 m, as targets far outside their boxes would have imitated it."""
    profile, trials = sailed
    name, widths = "effects.rpm-scale.factor", []
    for a_r in (0.02, 0.5):
        bench = make_workbench(profile, trials[:1], DiagnoseOptions(a_r=a_r, effects=("rpm-scale",)), [name])
        names = (*bench.targets, name)
        at = Point(names, bench.null(names), np.zeros((1, 6)), 0.0, bench.problem.integrator)
        found = estimates(bench, at)[name]
        widths.append(found.high - found.low)
    assert widths[0] < 0.5 * widths[1]


def test_a_target_at_its_bound_may_be_within_it_as_far_as_chi_squared_lets_it(suzaku):
    """From nowhere near its optimum it hardly gets away; where all fits alike it may be anywhere in its box."""
    bench = make_workbench(suzaku.profile, list(load_trials("suzaku").trials.values())[:1], DiagnoseOptions())
    names = ("rudder.eps", "propeller.t_P", "hull.R_0", "rudder.a_H")
    at = Point(names, np.array([0.0, 0.4, 1.0, 1.0]), np.zeros((1, 6)), 0.0, bench.problem.integrator)
    columns = np.array([[3.0, 1.0, 0.0, 5.0], [0.0, 1.0, 4.0, 5.0]])
    of_each = _from_bounds(bench, at, ["rudder.a_H"], np.array([-50.0, 0.0]), columns).T
    assert of_each == pytest.approx(np.array([[3.0 / 150.0, 0.0], [0.0, 4.0 * BOXED]]))


def test_an_interval_knows_that_a_target_at_its_bound_may_be_within_it(sailed):
    """Thrust was told as 0.841 +- 0.006 for 0.88: t_P had ended at its bound, and only their product shows."""
    profile, trials = sailed
    t_P, name, widths = "propeller.t_P", "effects.thrust.factor", {}
    for targets in (("rudder.eps",), ("rudder.eps", t_P)):
        bench = make_workbench(profile, trials[:1], DiagnoseOptions(targets=targets, effects=("thrust",)), [name])
        names = (*bench.targets, name)
        unit = bench.null(names)
        if t_P in names:
            box = bench.sub_box(names)
            lowest = float(box.from_unit(np.zeros(len(names)))[names.index(t_P)])
            same = (1.0 - profile.value(t_P)) / (1.0 - lowest)
            unit = box.to_unit(np.array([profile.value("rudder.eps"), lowest, same]))
        for z in (0.0, 1e-9) if t_P in names else (None,):
            unit = np.array([z if one == t_P else own for one, own in zip(names, unit, strict=True)])
            there = bench.refit(names, unit[:, None], np.zeros((1, 6)), max_iterations=0)
            found = estimates(bench, there)[name]
            widths[z] = found.high - found.low
    assert widths[0.0] > 1.5 * widths[None]
    assert widths[0.0] <= 1.01 * widths[1e-9]  # as one inside, or less, as chi-squared grows inwards


@pytest.mark.parametrize(
    ("size", "form"), [("gyro-drift.heading", "gyro-drift.settles"), ("rudder-stall.angle", "rudder-stall.width")]
)
def test_an_interval_beside_a_form_at_its_end_is_as_wide_as_just_inside(sailed, size, form):
    """A drift of 0.3955 +- 0.0001 deg/min was 0.4: the derivative looked at times to settle that are negative."""
    profile, trials = sailed
    names = (f"effects.{size}", f"effects.{form}")
    bench = make_workbench(profile, trials[:1], DiagnoseOptions(effects=(size.partition(".")[0],)), [names[0]])
    widths = []
    for z in (0.0, 1e-3):
        unit = np.array([bench.null(names)[0] - 0.2, z])
        at = Point(names, unit, np.zeros((1, 6)), 0.0, bench.problem.integrator)
        found = estimates(bench, at)[names[0]]
        widths.append(found.high - found.low)
    assert widths[0] == pytest.approx(widths[1], rel=0.2)
