"""What other inputs than those in the log would change."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.diagnose import DiagnoseOptions
from mmgtune.diagnose.bench.inputs import DRAWS, changes
from mmgtune.diagnose.bench.workbench import make_workbench
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials

RUNS = 2


class Backend:
    """Runs that are lost: their states are numbers to the end, and huge."""

    def __init__(self, backend, lost):
        self.backend, self.lost = backend, lost

    def run(self, *args, **named):
        result = self.backend.run(*args, **named)
        lanes = np.zeros((RUNS, DRAWS + 1), dtype=bool)
        for lane in self.lost:
            lanes[lane] = True
        of_rows = np.repeat(lanes.ravel(), len(result.residuals) // lanes.size)
        residuals = np.where(of_rows[:, None], 1e200, result.residuals)
        return replace(result, residuals=residuals, diverged=result.diverged | lanes.reshape(-1, 1))


@pytest.mark.daily("lost1")
@pytest.mark.parametrize("lost", [[(1, 3)], [(1, 0)]])
def test_a_run_that_diverges_under_other_inputs_changes_nothing(lost):
    """Trials of one ship with the profile of another: half a diagnosis later eigenvalues did not converge."""
    first = next(iter(load_trials("suzaku")))
    same = [replace(first, id=f"run{k}") for k in range(RUNS)]
    bench = make_workbench(load_profile("suzaku"), same, DiagnoseOptions(effects=("rudder-offset",)))
    point = base_fit(bench)
    problem = bench.problem_of(point.names, point.integrator)
    usual = changes(problem, point.unit, point.offsets, seed=0)
    found = changes(replace(problem, backend=Backend(problem.backend, lost)), point.unit, point.offsets, seed=0)
    rows, copy = problem.rows_of_cases[1], lost[0][1]
    gone = slice(None) if copy == 0 else copy - 1
    assert np.abs(usual[rows]).max() > 0.0
    np.testing.assert_array_equal(found[rows][:, gone], 0.0)
    found[rows, gone] = usual[rows, gone]
    np.testing.assert_array_equal(found, usual)
