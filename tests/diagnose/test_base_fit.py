"""The fit that a diagnosis begins with: on long precise runs it must not end where it cannot go on."""

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.diagnose import DiagnoseOptions
from mmgtune.diagnose.bench.workbench import make_workbench
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.fitting.least_squares import fit_offsets
from mmgtune.motions import simulate_trials
from mmgtune.profile import tuned
from mmgtune.trial import Trial, load_trials
from tests.diagnose.sensors import NOISE, logged

GOOD = 0.03 * NOISE
"""Sensors thirty times as good as those of most ships."""


def runs(profile, seed, turn, weave):
    """A turn and a weave of 1500 s each, of a ship whose targets are up to 22 % off the profile's."""
    rng = np.random.default_rng(seed)
    off = {name: profile.coefficient(name).value * (1.0 + rng.uniform(-0.22, 0.22)) for name in profile.targets}
    ship = tuned(profile, off, {}, {}, "made")
    t = np.arange(0.0, 1500.0, 3.0)
    zero = np.zeros_like(t)
    found = []
    for k, delta in enumerate(
        (
            np.clip(2.3 * (t - 10.0), 0.0, abs(turn)) * np.sign(turn),
            weave * np.clip(1.5 * np.sin(2.0 * np.pi * t / 120.0), -1.0, 1.0),
        )
    ):
        start = {"x": zero, "y": zero, "psi": zero + k, "u": zero + 3.0, "v_m": zero, "r": zero}
        trial = Trial(f"run_{k}", "suzaku", "", "generated", t, **start, n=zero + 1.7, delta=np.radians(delta))
        (motion,) = simulate_trials(ship, [trial], integrator=Integrator("rk4"))
        found.append(logged(trial, motion, rng, GOOD))
    return found


@pytest.mark.daily("damped")
@pytest.mark.parametrize(
    ("seed", "turn", "weave", "most"),
    [(3, 35.0, 20.0, 1.0), (2, -35.0, -10.0, 20.0)],
    ids=["initial states estimated from the first: 192 without", "their steps damped far from any fit: 58 without"],
)
def test_long_precise_runs_are_fitted(suzaku, seed, turn, weave, most):
    bench = make_workbench(suzaku.profile, runs(suzaku.profile, seed, turn, weave), DiagnoseOptions())
    assert base_fit(bench).chi2 / bench.problem.n_residuals < most


def test_initial_states_of_a_case_that_diverges_stay_as_measured(suzaku):
    wild = tuned(suzaku.profile, {"hull.X_vvvv": 500.0}, {}, {}, "made")
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "zigzag_10")]
    bench = make_workbench(wild, trials, DiagnoseOptions(targets=("wake.w_P0",)))
    problem, unit = bench.problem_of(bench.targets), np.array([0.5])
    offsets = fit_offsets(problem, unit)  # a warning would be an error here
    costs = problem.costs_by_case(unit[:, None], offsets[:, None])[:, 0]
    assert np.isinf(costs[0])
    assert np.isfinite(costs[1])
    assert np.all(offsets[0] == 0.0)


def test_a_refit_ends_where_it_is_when_all_is_to_stop(suzaku):
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "zigzag_10")]
    bench = make_workbench(suzaku.profile, trials, DiagnoseOptions())
    start, offsets = bench.null(bench.targets), bench.problem.offsets
    asked = []
    bench.stop = lambda: asked.append(1) or len(asked) > 2
    end = bench.refit(bench.targets, start[:, None], offsets, tolerance=1e-9)
    assert len(asked) == 3
    again = bench.refit(bench.targets, start[:, None], offsets, tolerance=1e-9)
    assert len(asked) == 4
    assert np.array_equal(again.unit, start)
    assert end.chi2 < again.chi2
