"""Known truth is recovered, as far as any trial can tell it."""

import numpy as np
import pytest

from mmgtune.fitting import FitOptions, fit, make_problem
from mmgtune.fitting.combinations import COMBINATIONS
from tests.fitting.conftest import TRUTH

pytestmark = pytest.mark.xdist_group("recovery")

QUICK = FitOptions(method="least-squares", starts=6)


@pytest.fixture(scope="module")
def result(suzaku, clean):
    return fit(suzaku.profile, clean, QUICK)


def known(suzaku, values):
    """Identifiable combinations and the coefficients outside the symmetry."""
    everything = {name: suzaku.profile.value(name) for name in suzaku.profile.names()} | dict(values)
    found = {c.expression: c.value(everything) for c in COMBINATIONS}
    return found | {
        n: everything[n] for n in ("hull.R_0", "propeller.t_P", "wake.w_P0", "wake.C_w", "rudder.kappa", "rudder.l_R_")
    }


def test_cost_falls_below_a_millionth(result):
    assert 1e-6 * result.J_before > result.J
    assert result.J_of("test", "after") < 1e-6 * result.J_of("test", "before")


def test_identifiable_combinations_are_recovered(suzaku, result):
    truth, fitted = known(suzaku, TRUTH), known(suzaku, result.theta)
    for name, value in truth.items():
        assert fitted[name] == pytest.approx(value, rel=1e-3), name


def test_with_eps_held_at_the_truth_every_coefficient_is_recovered(suzaku, clean):
    problem = make_problem(suzaku.profile, clean, FitOptions(fixed=("eps",), method="least-squares"))
    assert "rudder.eps" not in problem.box.names
    at_truth = suzaku.profile.text.replace("eps = 1.27", "eps = 1.15")
    from mmgtune.profile import parse_profile

    fitted = fit(parse_profile(at_truth), clean, FitOptions(fixed=("eps",), method="least-squares", starts=6))
    for name, value in fitted.theta.items():
        assert value == pytest.approx(TRUTH[name], rel=2e-3), name


@pytest.mark.long
def test_cma_es_alone_reaches_the_cost_too(suzaku, clean):
    from mmgtune.fitting.cmaes import search

    problem = make_problem(suzaku.profile, clean, FitOptions())
    start = problem.box.to_unit(problem.box.pre)
    found = search(problem, 1, start, populations=(12,))
    assert 1e-6 * problem.costs(start[:, None])[0] > found.J


def test_estimated_initial_states_recover_more_than_measured_ones(suzaku, noisy):
    errors = {}
    for initial in ("measured", "estimated"):
        fitted = fit(suzaku.profile, noisy, FitOptions(method="least-squares", starts=4, initial=initial))
        found, truth = known(suzaku, fitted.theta), known(suzaku, TRUTH)
        errors[initial] = np.array([abs(found[name] / truth[name] - 1.0) for name in truth])
    assert np.median(errors["estimated"]) < 0.5 * np.median(errors["measured"])
    assert errors["estimated"].max() < 0.1


@pytest.mark.long
def test_a_tenfold_finer_set_of_starts_finds_nothing_better(suzaku, noisy):
    few, many = (fit(suzaku.profile, noisy, FitOptions(method="least-squares", starts=k)).J for k in (2, 20))
    assert few == pytest.approx(many, rel=1e-4)


def test_other_targets_by_pattern(suzaku, clean):
    fitted = fit(suzaku.profile, clean, FitOptions(method="least-squares", starts=2, targets=("hull.Y_*",), a_r=0.2))
    assert set(fitted.theta) == {"hull.Y_v", "hull.Y_r", "hull.Y_vvv", "hull.Y_vvr", "hull.Y_vrr", "hull.Y_rrr"}
    assert fitted.J_before > fitted.J
