"""Residual forces by inverse dynamics: nothing for the true model, the missing force for a wrong one."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.backends import STATES, Integrator
from mmgtune.diagnose.evidence import residual_forces
from mmgtune.diagnose.evidence.forces import measured, needed_force, time_since_order
from mmgtune.diagnose.evidence.smoothing import smooth
from mmgtune.model import Model
from mmgtune.motions import simulate_trials
from mmgtune.physics.quantities import Surroundings
from mmgtune.physics.rigid_body import accelerations
from mmgtune.profile import with_effects
from mmgtune.trial import load_trials, surroundings
from tests.diagnose.evidence.conftest import WIND
from tests.diagnose.evidence.made import DEG, NOISE, make_trials, turn_order, zigzag_order
from tests.twin import sail, twin, with_value


def test_needed_force_undoes_accelerations(suzaku):
    random = np.random.default_rng(1)
    velocities = random.standard_normal((5, 3)) * [3.0, 1.0, 0.02]
    force = random.standard_normal((5, 3)) * [1e5, 1e5, 1e7]
    ship = suzaku.coefficients(suzaku.matrix()).ship
    slopes = np.column_stack(accelerations(*velocities.T, *force.T, ship))
    np.testing.assert_allclose(needed_force(ship, velocities, slopes), force, rtol=1e-9)


def test_nothing_is_left_of_the_true_model_but_noise(suzaku, plain):
    for trial in plain:
        found = residual_forces(suzaku, trial)
        assert len(found.time) > 0.9 * trial.n_samples
        scaled = found.force / found.noise
        # Some 400 samples correlated over 4 tau (10 to 20 s) are at least 20 independent ones, whose root mean square
        # has a deviation of 1 / sqrt(40) = 0.16, and whose mean one of 0.22: three of each, rounded up.
        assert np.all((np.sqrt(np.mean(scaled**2, axis=0)) > 0.5) & (np.sqrt(np.mean(scaled**2, axis=0)) < 1.5))
        assert np.all(np.abs(scaled.mean(axis=0)) < 0.7)
        # In prime values at the approach speed: below the resistance R_0' = 0.017, a fifth of Y_v' and N_r' each.
        straight = found.time < 60.0
        assert np.all(np.sqrt(np.mean(found.prime[straight] ** 2, axis=0)) < [0.01, 0.02, 0.004])


def test_without_noise_hardly_anything_is_left(suzaku):
    for trial in make_trials(suzaku, noise=0.0):
        # What remains is the spline's error where the rudder's rate jumps, far below any force of the ship.
        assert np.all(np.sqrt(np.mean(residual_forces(suzaku, trial).prime ** 2, axis=0)) < 2e-4)


@pytest.mark.long
def test_wrong_yaw_damping_shows_as_a_moment_by_yaw_rate(damped, plain):
    found = [residual_forces(damped, trial) for trial in plain]
    moment = np.concatenate([f.prime[:, 2] for f in found])
    yaw_rate = np.concatenate([f.yaw_rate for f in found])
    assert np.corrcoef(moment, yaw_rate)[0, 1] > 0.9
    # The ship is damped less than the model: 0.2 * 0.057 r', within the noise of the turns' slow part.
    assert np.polyfit(yaw_rate, moment, 1)[0] == pytest.approx(0.2 * 0.057, rel=0.15)


def test_a_force_of_the_earth_frame_is_found_with_its_size_and_direction(suzaku, blown):
    found = [residual_forces(suzaku, trial) for trial in blown]
    psi = np.concatenate([f.heading for f in found])
    dX, dY = (np.concatenate([getattr(f, name) for f in found]) for name in ("dX", "dY"))
    north = np.mean(dX * np.cos(psi) - dY * np.sin(psi))
    east = np.mean(dX * np.sin(psi) + dY * np.cos(psi))
    # Noise of some 4 kN and 12 kN per sample, over more than 80 independent samples.
    assert (north, east) == pytest.approx((WIND * np.cos(1.0), WIND * np.sin(1.0)), abs=0.15 * WIND)


@pytest.mark.long
def test_what_was_measured_around_the_ship_acts_as_in_the_simulation(suzaku):
    """A wind that turns, a current that grows, waves and a shoal: nothing is left of a model that acts on them."""
    acting = {tag: {"measured": 1.0} for tag in ("wind", "current", "waves", "shallow-water")}
    acting["waves"]["outside"] = 1.0  # a taper: a force that ends at 45 deg is no spline
    ship = with_effects(suzaku.profile, acting, "as measured")
    for still in make_trials(suzaku, noise=0.0)[1:3]:
        t = still.t
        extra = {
            "wind_speed": np.full(len(t), 12.0),
            "wind_dir": 0.5 + 0.002 * t,
            "current_speed": 0.2 + 0.002 * t,
            "current_dir": np.full(len(t), 2.0),
            "wave_height": np.full(len(t), 1.0),
            "wave_dir": np.full(len(t), 0.5),
            "depth": 40.0 - 0.05 * t,
        }
        logged = replace(still, extra=extra)
        (motion,) = simulate_trials(ship, [logged], integrator=Integrator("rk4", 4), backend="numpy")
        trial = replace(logged, **dict(zip(STATES, motion.states.T, strict=True)))
        found = residual_forces(Model(ship), trial)
        assert np.all(np.sqrt(np.mean(found.prime**2, axis=0)) < 2e-4)
        blind = residual_forces(Model(ship), replace(trial, extra={}))
        assert np.sqrt(np.mean(blind.prime[:, 1] ** 2)) > 5e-3


@pytest.mark.long
def test_water_carried_along_in_shallow_water_is_set_in_motion_too(suzaku):
    depth = 1.5 * suzaku.profile.value("particulars.d")
    ship = with_effects(suzaku.profile, {"shallow-water": {"depth": depth, "inertia": 0.8}}, "a test")
    deep = make_trials(suzaku, noise=0.0)[1]
    (motion,) = simulate_trials(ship, [deep], integrator=Integrator("rk4", 4), backend="numpy")
    trial = replace(deep, **dict(zip(STATES, motion.states.T, strict=True)))
    found = residual_forces(Model(ship), trial)
    assert np.all(np.sqrt(np.mean(found.prime**2, axis=0)) < 2e-4)


def test_noise_of_what_was_measured_around_the_ship_is_blunted(suzaku, plain):
    """As the motion is, so that the velocity through the water is no noisier than over ground."""
    ship = Model(with_effects(suzaku.profile, {"current": {"measured": 1.0}}, "as measured"))
    still = plain[0]
    here = {"current_speed": np.full(len(still.t), 0.5), "current_dir": np.ones(len(still.t))}
    trial = replace(still, extra=here)
    noisy = {**here, "current_speed": 0.5 + 0.1 * np.random.default_rng(2).standard_normal(len(still.t))}
    motion = smooth(trial)
    clean, rough = (measured(ship, one, motion) for one in (trial, replace(still, extra=noisy)))
    raw = surroundings(replace(still, extra=noisy), ship.draught)
    east = Surroundings._fields.index("current_east")
    assert np.std(rough[:, east] - clean[:, east]) < 0.7 * np.std(raw[:, east] - clean[:, east])
    assert clean[:, east] == pytest.approx(0.5 * np.sin(1.0))
    assert np.all(rough[:, Surroundings._fields.index("current_known")] == 1.0)


def test_gaps_are_bridged_or_left_out(suzaku, plain):
    trial = plain[0]
    motion = {name: getattr(trial, name).copy() for name in ("psi", "u", "v_m", "r")}
    motion["u"][::17] = np.nan
    motion["r"][[100, 101]] = np.nan
    for values in motion.values():
        values[200:260] = np.nan
        values[:5] = np.nan
    broken = residual_forces(suzaku, replace(trial, **motion))
    whole = residual_forces(suzaku, trial)
    assert np.isfinite(broken.force).all()
    assert np.isfinite(broken.noise).all()
    assert {100, 101} <= set(broken.sample)
    assert not set(range(200, 260)) & set(broken.sample)
    assert broken.sample.min() > 5 + 2 * broken.tau
    both = np.intersect1d(whole.sample, broken.sample)
    pair = [
        f.force[np.searchsorted(f.sample, both)] / f.noise[np.searchsorted(f.sample, both)] for f in (whole, broken)
    ]
    # The same noise, smoothed a little differently.
    assert np.sqrt(np.mean((pair[0] - pair[1]) ** 2)) < 0.7
    assert np.sqrt(np.mean(pair[1] ** 2)) < 1.5


def test_forces_of_a_ship_with_several_rudders(tmp_path):
    """Her own inputs drive her, not the mean rudder: no force is missing where the model is right."""
    ship = twin()
    sail(ship, tmp_path)
    trial = load_trials(tmp_path).trials["one"]
    right = residual_forces(ship, trial)
    without = residual_forces(Model(with_value(ship.profile, "thruster.k", 0.0)), trial)
    pushed = 2e4 * 2.0**2  # k n^2, of a thruster that turns all along
    assert np.median(without.dY - right.dY) == pytest.approx(pushed, rel=1e-6)
    assert np.abs(np.median(right.dY)) < 0.05 * pushed


def test_heading_may_be_missing(suzaku, plain):
    found = residual_forces(suzaku, replace(plain[0], psi=np.full(plain[0].n_samples, np.nan)))
    assert np.isnan(found.heading).all()
    assert np.isfinite(found.force).all()


def test_too_little_to_go_by_is_said(suzaku, plain):
    u = np.full(plain[0].n_samples, np.nan)
    u[:9] = 3.0
    with pytest.raises(ValueError, match="9 samples with u, v_m and r"):
        residual_forces(suzaku, replace(plain[0], u=u))


@pytest.mark.long
def test_the_smoothing_knows_what_noise_it_leaves(suzaku, plain):
    clean = make_trials(suzaku, noise=0.0)
    for noisy, true in zip(plain, clean, strict=True):
        motion = smooth(noisy)
        np.testing.assert_allclose(motion.noise, NOISE, rtol=0.15)  # from 420 samples
        error = (motion.states - true.motion)[motion.inner, 3:]
        # About 1 by the formula, more where the rudder's corners are blunted.
        ratio = np.sqrt(np.mean(error**2, axis=0)) / motion.value_noise[3:]
        assert np.all((ratio > 0.6) & (ratio < 1.6))


def test_time_since_order():
    t = np.arange(421.0)
    turn = time_since_order(t, turn_order(20.0, 420))
    assert np.isnan(turn[:60]).all()
    assert turn[61] == 0.0  # the first sample with the rudder moving
    assert turn[-1] == 420.0 - 61.0
    zigzag = time_since_order(t, zigzag_order(10.0, 420))
    assert list(np.flatnonzero(zigzag == 0.0)) == [*range(61, 420, 50)]
    noisy = turn_order(20.0, 420) + 0.2 * DEG * np.random.default_rng(1).standard_normal(421)
    assert list(np.flatnonzero(time_since_order(t, noisy) == 0.0)) == [61]
