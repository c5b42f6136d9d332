"""What no trial can tell is found from the numbers alone, named, and not given a standard error."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.backends import STATES
from mmgtune.fitting import FitOptions, fit, make_problem
from mmgtune.fitting.identifiability import analyse
from mmgtune.fitting.whitening import estimate_whitening
from tests.fitting.conftest import TRUTH, make_set

pytestmark = pytest.mark.xdist_group("identifiability")

TRADED = {"rudder.t_R", "rudder.a_H", "rudder.x_H_", "rudder.eps", "rudder.gamma_Rp", "rudder.gamma_Rn"}


@pytest.fixture(scope="module")
def at_truth(suzaku, noisy):
    problem = make_problem(suzaku.profile, noisy, FitOptions(initial="estimated"))
    unit = problem.box.to_unit([TRUTH[name] for name in problem.box.names])
    return problem, analyse(problem, unit, np.zeros(12, dtype=bool))


def test_exactly_the_rudder_symmetry_is_found(at_truth):
    _, found = at_truth
    (direction,) = found.null_directions
    assert set(direction.weights) == TRADED
    # d ln eps = d ln gamma = 1 %;  d(1-t_R)/(1-t_R) = d(1+a_H)/(1+a_H) = d(x_R+a_H x_H)/(..) = -2 %
    t_R, a_H, x_H = TRUTH["rudder.t_R"], TRUTH["rudder.a_H"], TRUTH["rudder.x_H_"]
    d_t, d_a = 2 * (1 - t_R), -2 * (1 + a_H)
    d_x = (-2 * (-0.5 + a_H * x_H) - d_a * x_H) / a_H
    expected = {
        "rudder.eps": 1.0,
        "rudder.gamma_Rp": 1.0,
        "rudder.gamma_Rn": 1.0,
        "rudder.t_R": d_t / t_R,
        "rudder.a_H": d_a / a_H,
        "rudder.x_H_": d_x / x_H,
    }
    scale = direction.weights["rudder.eps"]
    for name, weight in direction.weights.items():
        assert weight / scale == pytest.approx(expected[name], rel=1e-3), name
    assert direction.largest_shift < 1e-4


def test_the_direction_is_said_in_words(at_truth):
    _, found = at_truth
    sentence = found.null_directions[0].sentence
    assert all(name in sentence for name in TRADED)
    assert "No trial can tell" in sentence
    assert found.sentences[0].startswith("11 of 12")


def test_traded_coefficients_have_no_standard_error_and_combinations_do(at_truth):
    _, found = at_truth
    assert {name for name, error in found.stderr.items() if error is None} >= TRADED
    assert set(found.undetermined) >= TRADED
    assert len(found.combinations) == 5
    assert all(0.0 < c.stderr < abs(c.value) for c in found.combinations)


def test_holding_one_member_removes_the_direction(suzaku, noisy):
    problem = make_problem(suzaku.profile, noisy, FitOptions(fixed=("eps",)))
    unit = problem.box.to_unit([TRUTH[name] for name in problem.box.names])
    found = analyse(problem, unit, np.zeros(11, dtype=bool))
    assert found.null_directions == ()
    assert not TRADED & {name for name, of in found.undetermined.items() if of.kind == "traded"}


def test_identifiable_option_holds_one_member(suzaku, noisy):
    options = FitOptions(method="least-squares", starts=2, identifiable=True)
    result = fit(suzaku.profile, noisy, options)
    assert len(result.held) == 1
    assert set(result.held) <= TRADED
    assert result.identifiability.null_directions == ()


@pytest.mark.long
def test_standard_errors_cover_the_truth(suzaku):
    """Over repeated noise the error of what is known stays within three standard errors in most cases."""
    from tests.fitting import conftest

    names = ("hull.R_0", "rudder.kappa", "wake.w_P0", "rudder.l_R_")
    inside = []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        trials = make_set(suzaku, noise=0.0)
        for name, trial in trials.trials.items():
            noisy_motion = trial.motion + conftest.NOISE * rng.standard_normal(trial.motion.shape)
            trials.trials[name] = replace(trial, **dict(zip(STATES, noisy_motion.T, strict=True)))
        fitted = fit(suzaku.profile, trials, FitOptions(method="least-squares", starts=2, initial="estimated"))
        for name in names:
            error = fitted.identifiability.stderr[name]
            if error is not None:
                inside.append(abs(fitted.theta[name] - TRUTH[name]) < 3.0 * error)
    assert len(inside) >= 12
    assert np.mean(inside) > 0.8


def test_a_coefficient_the_motion_does_not_show_is_undetermined(suzaku, clean):
    """u_R0 acts at bollard condition only, which no turn visits."""
    problem = make_problem(suzaku.profile, clean, FitOptions(targets=("rudder.u_R0", "hull.R_0")))
    found = analyse(problem, problem.box.to_unit(problem.box.pre), np.zeros(2, dtype=bool))
    assert "rudder.u_R0" in found.undetermined
    assert "hull.R_0" not in found.undetermined


def test_estimated_initial_states_count(suzaku, noisy):
    """Against the whole of it at once: targets and the six offsets of every case as one linear problem.

    Whitened derivatives of all residuals by both, and one row for what is known of each offset; the covariance of the
    targets is a block of the inverse of its normal matrix.
    """
    names = ("R_0", "w_P0", "N_r", "kappa", "a_H")
    problem = make_problem(suzaku.profile, noisy, FitOptions(targets=names, initial="estimated"))
    rng = np.random.default_rng(3)
    problem = problem.with_offsets(0.1 * problem.sigma * rng.uniform(-1.0, 1.0, problem.sigma.shape))
    unit = problem.box.to_unit([TRUTH.get(name, problem.box.pre[i]) for i, name in enumerate(problem.box.names)])
    found = analyse(problem, unit, np.zeros(len(names), dtype=bool))

    n_cases = len(problem.cases)
    whitening = estimate_whitening(problem, problem.residuals(unit[:, None])[0])
    columns = []
    for k in range(len(unit)):
        step = 1e-5 * np.eye(len(unit))[k]
        above, below = (problem.residuals((unit + side * step)[:, None])[0] for side in (1.0, -1.0))
        columns.append((above - below) / 2e-5 / problem.box.width[k])
    for case in range(n_cases):
        for k in range(6):
            step = np.zeros((n_cases, 1, 6))
            step[case, 0, k] = 0.02 * problem.sigma[case, k]
            here = problem.offsets[:, None]
            above, below = (problem.residuals(unit[:, None], here + side * step)[0] for side in (1.0, -1.0))
            columns.append((above - below) / 0.04)  # by a deviation
    joint = whitening.apply(np.column_stack(columns))
    known = np.hstack([np.zeros((6 * n_cases, len(unit))), np.eye(6 * n_cases)])
    joint = np.vstack([joint, known])
    scale = np.linalg.norm(joint, axis=0)
    covariance = np.linalg.inv((joint / scale).T @ (joint / scale)) / np.outer(scale, scale)
    covariance = covariance[: len(unit), : len(unit)]
    deviation = np.sqrt(np.diag(covariance))
    for i, name in enumerate(found.names):
        assert name not in found.undetermined
        assert found.stderr[name] == pytest.approx(deviation[i], rel=1e-4), name
    correlation = covariance / np.outer(deviation, deviation)
    assert found.correlation == pytest.approx(correlation, abs=1e-4)

    # They matter: states known exactly would make the coefficients look better known than they are.
    held = analyse(problem.from_measured(), unit, np.zeros(len(names), dtype=bool))
    assert max(found.stderr[name] / held.stderr[name] for name in found.names) > 1.05
