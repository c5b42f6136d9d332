"""Coefficients of groups of cases: each case has its own, and derivatives know it."""

from __future__ import annotations

import numpy as np
import pytest

from mmgtune.backends import get_backend
from mmgtune.fitting.box import make_box
from mmgtune.fitting.least_squares import solve
from mmgtune.fitting.problem import FitProblem
from mmgtune.model import Model
from mmgtune.objective import cases_of, make_objective
from mmgtune.profile import with_effects

NAMES = ("hull.R_0", *(f"effects.rudder-offset.angle@day:{day}" for day in ("a", "b")))


@pytest.fixture(scope="module")
def problem(suzaku, clean):
    """Three trials: two of a day, one of another."""
    model = Model(with_effects(suzaku.profile, {"rudder-offset": {"angle": 0.0}}, "test"))
    trials = list(clean.trials.values())[:3]
    cases = cases_of(trials, make_objective(model.L_pp), model.inputs, model.draught)
    box = make_box(model, ("hull.R_0", "effects.rudder-offset.angle"), 0.5).part(NAMES)
    groups = [frozenset({"day:a", "trial:1"}), frozenset({"day:b"}), frozenset({"day:a"})]
    return FitProblem.of(model, cases, box, get_backend("compiled"), sigma=np.full((3, 6), 0.1)).with_groups(groups)


UNIT = np.array([0.4, 0.55, 0.3])


def test_each_case_has_the_value_of_its_group(problem):
    assert problem.box.low[1] == problem.box.low[2] == pytest.approx(-np.radians(10.0))
    theta = problem.theta(UNIT[:, None])
    angle, R_0 = (problem.model.rows[name] for name in ("effects.rudder-offset.angle", "hull.R_0"))
    values = problem.box.from_unit(UNIT)
    assert theta[angle, :, 0] == pytest.approx([values[1], values[2], values[1]])
    assert theta[R_0, :, 0] == pytest.approx(values[0])


def test_derivatives_are_those_of_the_groups(problem):
    residuals, slopes, _ = problem.jacobians(UNIT[:, None])
    step = 1e-6
    for k in range(3):
        moved = UNIT.copy()
        moved[k] += step
        expected = (problem.residuals(moved[:, None])[0] - residuals[0]) / step
        np.testing.assert_allclose(slopes[0, :, k], expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())
    rows = problem.rows_of_cases
    assert np.all(slopes[0, rows[1], 1] == 0.0)
    assert np.all(slopes[0, rows[0], 2] == 0.0)
    assert np.any(slopes[0, rows[2], 1] != 0.0)


def test_beliefs_hold_values_together(problem):
    apart = np.array([[0.0, 1.0, -1.0]]) * 1e6
    (free,) = solve(problem, UNIT[:, None], max_iterations=30)
    (held,) = solve(problem, UNIT[:, None], max_iterations=30, beliefs=(apart, np.zeros(3)))
    assert held.unit[1] == pytest.approx(held.unit[2], abs=1e-4)
    assert held.J >= free.J
    aim = np.array([0.4, 0.6, 0.6])
    (drawn,) = solve(problem, UNIT[:, None], max_iterations=30, beliefs=(1e6 * np.eye(3)[1:], aim))
    assert drawn.unit[1:] == pytest.approx(aim[1:], abs=1e-3)
