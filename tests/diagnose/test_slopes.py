"""Derivatives by less work: where they are nearly the same, and only there."""

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.diagnose import DiagnoseOptions
from mmgtune.diagnose.bench import workbench
from mmgtune.diagnose.bench.hypotheses import Hypothesis
from mmgtune.diagnose.bench.slopes import quick_slopes
from mmgtune.diagnose.bench.workbench import TOLERANCE, make_workbench
from mmgtune.diagnose.signatures.foretelling import Foretelling
from mmgtune.diagnose.signatures.linear import linearise
from mmgtune.effects import find_effect
from mmgtune.fitting.least_squares import fit_offsets
from mmgtune.trial import Trial, load_trials


def every(trial, k):
    """A trial of which every k-th sample was logged."""
    columns = {name: getattr(trial, name)[::k] for name in ("x", "y", "psi", "u", "v_m", "r", "n", "delta")}
    return Trial(trial.id, trial.ship, trial.manoeuvre, trial.source, trial.t[::k], **columns)


@pytest.fixture(scope="module")
def trials():
    return [load_trials("suzaku").trials[name] for name in ("turn_p35", "zigzag_10")]


@pytest.mark.parametrize(("k", "name"), [(1, "euler"), (5, "heun"), (20, None)])
def test_the_least_work_that_will_do(suzaku, trials, k, name):
    bench = make_workbench(suzaku.profile, [every(trial, k) for trial in trials], DiagnoseOptions())
    assert quick_slopes(bench.problem_of(bench.targets), bench.null(bench.targets)) == (name and Integrator(name))


def test_none_is_less_work_than_the_paper_s_own(suzaku, trials):
    bench = make_workbench(suzaku.profile, trials, DiagnoseOptions(integrator="euler"))
    assert quick_slopes(bench.problem_of(bench.targets), bench.null(bench.targets)) is None


def test_what_has_to_be_precise_is_by_derivatives_of_its_own(suzaku, trials, monkeypatch):
    asked = []
    monkeypatch.setattr(workbench, "solve", lambda problem, starts, **how: asked.append(how) or [])
    bench = make_workbench(suzaku.profile, trials, DiagnoseOptions())
    bench.find_slopes()
    start, offsets = bench.null(bench.targets)[:, None], bench.problem.offsets
    for how in ({}, {"tolerance": 0.9 * TOLERANCE}, {"integrator": Integrator("rk4", 4)}):
        bench.refits(bench.targets, start, offsets, **how)
    bench.integrate(Integrator("rk4", 4))
    bench.refits(bench.targets, start, offsets)
    by = [how["slopes"] for how in asked]
    assert by == [Integrator("euler"), None, Integrator("rk4", 4), Integrator("rk4", 4)]


def test_signatures_are_nearly_the_same_and_the_residual_is(suzaku, trials):
    names = ("effects.current.north", "effects.thrust.factor")
    bench = make_workbench(suzaku.profile, trials, DiagnoseOptions(), names)
    bench.find_slopes()
    null = bench.null(bench.targets)
    offsets = fit_offsets(bench.problem_of(bench.targets), null)
    point = bench.refit(bench.targets, null[:, None], offsets, max_iterations=0)
    own, rough = (linearise(bench, point, names, roughly=roughly) for roughly in (False, True))
    off = np.linalg.norm(rough.signature - own.signature, axis=0) / np.linalg.norm(own.signature, axis=0)
    assert np.all((off > 0.0) & (off < 0.1))
    assert np.linalg.norm(rough.residual - own.residual) < 0.15 * np.linalg.norm(own.residual)


def test_where_the_other_method_diverges_all_is_by_the_problem_s_own(suzaku, trials):
    """A fit ended at once, and a diagnosis of the wrong ship in a LinAlgError."""
    names = ("effects.current.north",)
    bench = make_workbench(suzaku.profile, [every(trial, 20) for trial in trials], DiagnoseOptions(), names)
    bench.slopes = Integrator("euler")
    null = bench.null(bench.targets)
    problem = bench.problem_of(bench.targets)
    assert np.isfinite(problem.residuals(null[:, None])).all()
    assert not np.isfinite(bench.by_slopes(problem).residuals(null[:, None])).all()
    there = null[:, None]
    for rough, own in zip(problem.jacobians(there, slopes=bench.slopes), problem.jacobians(there), strict=True):
        np.testing.assert_allclose(rough, own, rtol=1e-9, atol=1e-9)
    point = bench.refit(bench.targets, null[:, None], problem.offsets, max_iterations=0)
    rough, own = (linearise(bench, point, names, roughly=roughly) for roughly in (True, False))
    np.testing.assert_allclose(rough.signature, own.signature, rtol=1e-9, atol=1e-9)
    water = Hypothesis(find_effect("current"), ("north",))
    (left,) = Foretelling(bench, point, own, [water]).left(water, np.append(point.unit, 0.6)[:, None])
    assert 0.0 < left < np.inf  # 0 where nothing can be told
