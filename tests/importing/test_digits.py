"""Digits that were not printed are made up for by the smoothest curve."""

import numpy as np
import pytest
from scipy.interpolate import make_smoothing_spline

from mmgtune.importing.cells.digits import _Smoothing, print_step, within_digits


@pytest.mark.parametrize("lam", [1e-6, 1e-2, 1.0, 1e2, 1e4])
@pytest.mark.parametrize("n", [5, 300])
def test_curves_are_the_cubic_smoothing_splines_of_scipy(n, lam):
    rng = np.random.default_rng(n)
    t = np.cumsum(rng.uniform(0.5, 1.5, n))
    values, step = np.sin(0.2 * t) + rng.normal(0.0, 0.1, n), rng.choice([0.1, 1.0], n)
    expected = make_smoothing_spline(t, values, w=1.0 / step**2, lam=lam)(t)
    assert _Smoothing(t, values, step**2)(lam) == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize("gap", [1e-3, 1.0, 60.0])
def test_a_curve_comes_back_from_its_rounded_values_however_often_it_was_logged(gap):
    t = gap * np.arange(400)
    true = 5.3 + 3.0 * np.sin(t / (40.0 * gap))
    found, digits, steps = within_digits(t, np.round(true, 2))
    assert digits == 3
    assert steps == pytest.approx(0.01)
    assert np.std(found - true) < 0.7 * np.std(np.round(true, 2) - true)


@pytest.mark.parametrize("gap", [1e-9, 1e-200])
def test_samples_that_all_but_coincide_are_smoothed_as_far_as_that_can_be_told(gap):
    t = np.cumsum(np.concatenate([[0.0, gap], np.where(np.arange(2000) % 2, max(gap, 1e-9), 1.0)]))
    printed = np.round(5.3 + 3.0 * np.sin(t / 40.0), 2)
    found, _, _ = within_digits(t, printed)
    assert np.mean(np.abs(found - printed) <= 0.005 + 1e-9) > 0.99


def test_the_step_of_numbers_with_as_many_decimals_is_one():
    """Headings in whole degrees have three digits from 100 on and two below it, yet steps of a degree everywhere."""
    heading = np.round(np.linspace(5.0, 330.0, 60))
    steps, digits = print_step(heading)
    assert digits == 3
    assert steps == pytest.approx(1.0)
    of_three_digits = np.array([float(f"{value:.2e}") for value in np.linspace(1.234, 330.0, 200)])
    assert sorted(set(print_step(of_three_digits)[0])) == pytest.approx([0.01, 0.1, 1.0])
