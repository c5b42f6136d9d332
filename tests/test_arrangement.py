"""Another arrangement is not another program: two rudders and a thruster, from outside, through everything."""

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.errors import TrialError
from mmgtune.fitting import FitOptions, fit
from mmgtune.model import Model
from mmgtune.motions import as_trial, breakdown, simulate_trials
from mmgtune.orders import TurningOrder, run_manoeuvre
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import load_trials, read_trial, write_trial
from tests.runs import states, turn
from tests.twin import sail, twin, with_controls, with_value

RK4 = Integrator("rk4")


@pytest.fixture(scope="module")
def ship():
    return twin()


@pytest.fixture(scope="module")
def single():
    return Model(load_profile("kvlcc2"))


@pytest.mark.parametrize("backend", ["compiled", "numpy"])
def test_two_half_rudders_are_one(ship, single, backend):
    """Both at one angle they steer as the single rudder they were cut from; the thruster at rest does nothing."""
    one = turn(single, 20.0, 400.0)
    n, delta = one.controls[0].T
    two = with_controls(one, [n, delta, delta, 0.0 * n])
    expected, found = (
        states(model, cases, backend=backend, integrator=RK4) for model, cases in ((single, one), (ship, two))
    )
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9)


def test_back_ends_agree_with_every_input_moving(ship):
    cases = turn(ship, 0.0, 500.0)
    t = cases.t[0]
    n = cases.controls[0, :, 0] * (1.0 + 0.2 * np.sin(t / 50.0))
    moving = with_controls(cases, [n, 0.4 * np.sin(t / 40.0), 0.3 * np.cos(t / 25.0), 3.0 * np.sin(t / 70.0)])
    theta = ship.matrix(["thruster.k"], np.linspace(0.0, 4e4, 9)[None])
    compiled, reference = (states(ship, moving, theta, backend, RK4) for backend in ("compiled", "numpy"))
    np.testing.assert_allclose(compiled, reference, rtol=1e-9, atol=1e-9)
    assert np.abs(compiled[0, -1] - compiled[0, 0]).max() > 1.0


def test_effects_on_rudders_move_both_and_those_without_a_part_do_not_apply(ship):
    from mmgtune.effects import find_effect
    from mmgtune.profile import missing_for

    off = Model(with_effects(ship.profile, {"rudder-offset": {"angle": 0.05}, "rpm-scale": {"factor": 1.02}}, "a test"))
    cases = turn(ship, 0.0, 300.0)
    n = cases.controls[0, :, 0]
    expected = with_controls(cases, [1.02 * n, 0.05 + 0.0 * n, 0.05 + 0.0 * n, 0.0 * n])
    logged = with_controls(cases, [n, 0.0 * n, 0.0 * n, 0.0 * n])
    np.testing.assert_allclose(states(off, logged), states(ship, expected), rtol=1e-9, atol=1e-9)
    assert missing_for(find_effect("rudder-stall"), ship.profile) == ["rudder"]
    assert missing_for(find_effect("rudder-stall"), load_profile("kvlcc2")) == []


def test_orders_trials_files_and_forces_follow_the_names(ship, tmp_path):
    motion = run_manoeuvre(ship, TurningOrder(0.5), longest=400.0)
    assert motion.inputs == ("n", "delta_port", "delta_stbd", "n_bow")
    assert motion.controls[-1, 1] == motion.controls[-1, 2] == pytest.approx(0.5)
    trial = as_trial(ship.profile, motion, with_forces=True)
    assert {"hull_X", "rudder_port_N", "rudder_stbd_F_N", "thruster_Y", "delta_stbd", "n_bow"} <= set(trial.extra)
    again = read_trial(write_trial(trial, tmp_path / "turn.parquet"))
    np.testing.assert_allclose(again.inputs(ship.inputs), motion.controls)
    repeated = simulate_trials(ship, [again], integrator=RK4)[0]
    assert np.abs(repeated.states[:, :2] - motion.states[:, :2]).max() < 0.05 * ship.L_pp
    assert breakdown(ship, motion.states, motion.controls).thruster.Y[-1] == 0.0


def test_a_trial_without_an_input_says_which(ship):
    trial = load_trials("suzaku").trials["turn_p35"]
    with pytest.raises(TrialError, match=r"(?s)'delta_port'.*port rudder angle"):
        simulate_trials(ship, [trial])


def test_its_coefficients_are_fitted(ship, tmp_path):
    sail(ship, tmp_path)
    wrong = with_value(ship.profile, "thruster.k", 1.4e4)
    options = FitOptions(method="least-squares", starts=2, targets=("thruster.k",), integrator="rk4")
    assert fit(wrong, load_trials(tmp_path), options).theta["thruster.k"] == pytest.approx(2e4, rel=1e-6)
