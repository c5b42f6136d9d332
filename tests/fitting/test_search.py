"""Search: bounds reached exactly, seeds, replay, certificate, sweep."""

import re
from dataclasses import fields, replace

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.cli.sweep import summary
from mmgtune.errors import OptionError
from mmgtune.fitting import (
    FitOptions,
    Hooks,
    LeaveOutOptions,
    SweepOptions,
    fit,
    least_squares,
    leave_out,
    make_problem,
    sweep,
)
from mmgtune.fitting.bounded import bounded_step, bounded_steps
from mmgtune.fitting.box import make_box
from mmgtune.fitting.cmaes import from_box, search, to_box
from mmgtune.fitting.least_squares import solve
from mmgtune.fitting.quadratic import Quadratic
from mmgtune.trial import load_trials
from tests.fitting.conftest import NOISE, make_set

pytestmark = pytest.mark.xdist_group("search")


@pytest.fixture(scope="module")
def problem(suzaku, noisy):
    return make_problem(suzaku.profile, noisy, FitOptions(a_r=0.1))


@pytest.fixture(scope="module")
def searched(problem):
    """A whole search, of two runs."""
    return search(problem, 1, problem.box.to_unit(problem.box.pre), populations=(12, 24))


def test_cosine_map_reaches_the_bounds():
    z = np.linspace(-3.0, 3.0, 2001)
    unit = to_box(z)
    assert unit.min() == 0.0
    assert unit.max() == pytest.approx(1.0, abs=1e-15)
    inside = np.linspace(0.0, 1.0, 101)
    np.testing.assert_allclose(to_box(from_box(inside)), inside, atol=1e-15)


def test_box_is_exact_at_its_ends(problem):
    box = problem.box
    assert np.array_equal(box.from_unit(np.zeros(12)), box.low)
    assert np.array_equal(box.from_unit(np.ones(12)), box.high)
    np.testing.assert_allclose(box.from_unit(box.to_unit(box.pre)), box.pre, rtol=1e-14)


def test_same_seed_same_search_and_numpy_s_stream_is_left_alone(problem):
    start = problem.box.to_unit(problem.box.pre)
    np.random.seed(5)  # noqa: NPY002 - the global stream is what must not matter
    one = search(problem, 3, start, populations=(12,))
    before = np.random.get_state()[1].tolist()  # noqa: NPY002
    np.random.seed(9)  # noqa: NPY002
    two = search(problem, 3, start, populations=(12,))
    np.random.seed(5)  # noqa: NPY002
    assert np.random.get_state()[1].tolist() == before  # noqa: NPY002
    other = search(problem, 4, start, populations=(12,))
    assert np.array_equal(one.unit, two.unit)
    assert not np.array_equal(one.unit, other.unit)


@pytest.mark.long
def test_replay_is_bit_identical(problem, searched):
    start, whole = problem.box.to_unit(problem.box.pre), searched
    asked = []

    def stop():
        asked.append(1)
        return len(asked) >= 40

    part = search(problem, 1, start, populations=(12, 24), stop=stop)
    assert not part.finished
    simulated = []
    rest = search(
        problem, 1, start, populations=(12, 24), recorded=part.costs, on_generation=lambda s: simulated.append(1)
    )
    assert np.array_equal(rest.unit, whole.unit)
    assert rest.history == whole.history
    assert len(simulated) == len(whole.history) - 40


def test_no_files_are_left_behind(problem, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cma_signals.in").write_text("{'timeout': 0}")
    found = search(problem, 1, problem.box.to_unit(problem.box.pre), populations=(12,))
    assert found.history[-1].generation > 20
    assert [p.name for p in tmp_path.iterdir()] == ["cma_signals.in"]


@pytest.mark.long
def test_least_squares_and_cma_es_agree_with_active_bounds(problem, searched):
    start = problem.box.to_unit(problem.box.pre)
    by_squares, by_cma = solve(problem, start[:, None])[0], searched
    assert ((by_squares.unit == 0.0) | (by_squares.unit == 1.0)).sum() >= 3
    assert pytest.approx(by_squares.J, rel=1e-4) == by_cma.J


def test_bounded_step_solves_the_bounded_quadratic():
    from scipy.optimize import lsq_linear

    rng = np.random.default_rng(0)
    for _ in range(50):
        A = rng.standard_normal((20, 6))
        b = 3.0 * rng.standard_normal(20)
        z = rng.uniform(size=6)
        found = bounded_step(A.T @ A, A.T @ b, z)
        elsewhere = bounded_step(A.T @ A, A.T @ b, z, start=np.round(rng.uniform(size=6)))
        np.testing.assert_allclose(elsewhere, found, atol=1e-9)
        best = lsq_linear(A, -b, bounds=(-z, 1.0 - z)).x + z
        value, least = (np.sum((A @ (point - z) + b) ** 2) for point in (found, best))
        assert value <= least * (1.0 + 1e-9)
        assert found.min() >= 0.0
        assert found.max() <= 1.0


def test_many_small_bounded_steps_at_once_are_those_one_by_one():
    rng = np.random.default_rng(3)
    for _ in range(200):
        A = rng.normal(size=(5, 8, 6)) * 10.0 ** rng.uniform(-2.0, 2.0, size=(5, 1, 6))
        hessian = A.transpose(0, 2, 1) @ A + 1e-3 * np.eye(6)
        z = np.clip(rng.uniform(-0.3, 1.3, size=(5, 6)), 0.0, 1.0)  # many on a bound
        gradient = (hessian @ rng.normal(scale=rng.choice([0.1, 1.0, 10.0]), size=(5, 6, 1)))[..., 0]
        found = bounded_steps(hessian, gradient, z)
        np.testing.assert_allclose(
            found, [bounded_step(*one) for one in zip(hessian, gradient, z, strict=True)], atol=1e-8
        )


def test_derivatives_that_foretold_a_step_serve_the_next_to_the_same_end(problem, monkeypatch):
    """With initial states estimated, as in a diagnosis."""
    made = []
    models = least_squares._Minimised.models
    monkeypatch.setattr(least_squares._Minimised, "models", lambda *given: made.append(1) or models(*given))
    estimated = problem.estimated(np.full((len(problem.cases), 6), 0.1))
    start = np.full((len(estimated.box.names), 1), 0.4)

    def end(settled):
        made.clear()
        monkeypatch.setattr(least_squares, "ITERATIONS_BEFORE_REUSE", settled)
        (found,) = solve(estimated, start, tolerance=1e-9, trusting=True)
        return found, len(made)

    (own, every), (kept, fewer) = end(10**9), end(1)
    assert fewer < every
    assert kept.converged
    assert pytest.approx(own.J, rel=1e-5) == kept.J


def test_a_start_of_which_the_linear_problem_promises_too_little_is_given_up(problem):
    start = problem.box.to_unit(problem.box.pre)[:, None]
    (whole,) = solve(problem, start, tolerance=1e-9, trusting=True)
    (given_up,) = solve(problem, start, tolerance=1e-9, trusting=True, hopeless=0.9 * whole.J)
    (going_on,) = solve(problem, start, tolerance=1e-9, trusting=True, hopeless=1.1 * whole.J)
    assert given_up.iterations < whole.iterations
    assert not given_up.converged
    assert whole.J < given_up.J < problem.costs(start)[0]
    assert going_on.J == whole.J


def test_a_start_that_is_stopped_says_what_going_on_promises(problem):
    start = problem.box.to_unit(problem.box.pre)[:, None]
    (whole,) = solve(problem, start, tolerance=1e-9, trusting=True)
    (stopped,) = solve(problem, start, max_iterations=2, tolerance=1e-9, trusting=True)
    assert not stopped.converged
    assert stopped.promised > 0.0
    assert whole.J < stopped.J - stopped.promised < stopped.J
    assert 0.0 <= whole.promised < 1e-6 * whole.J
    (plain,) = solve(problem, start, max_iterations=2)
    assert plain.promised == 0.0


def test_derivatives_are_taken_along_to_another_point(problem):
    estimated = problem.estimated(np.full((len(problem.cases), 6), 0.1))
    here = np.full((len(problem.box), 1), 0.5)
    offsets = np.zeros((len(problem.cases), 1, 6))
    _, slopes, by_offset = (one[0] for one in estimated.jacobians(here, offsets))
    at = offsets[:, 0]
    there = at + 0.01
    residuals = estimated.residuals(here + 0.05, there[:, None])[0]
    model = Quadratic(estimated, at, estimated.residuals(here, at[:, None])[0], slopes, by_offset, True)
    along, anew = (
        model.with_residuals(there, residuals),
        Quadratic(estimated, there, residuals, slopes, by_offset, True),
    )
    for name in ("hessian", "gradient", "settling"):
        np.testing.assert_allclose(getattr(along, name), getattr(anew, name), rtol=1e-12)
    step = np.full(len(problem.box), 0.01)
    np.testing.assert_allclose(along.offsets(step), anew.offsets(step), rtol=1e-12)


def test_least_squares_never_ends_above_its_start(problem):
    starts = np.random.default_rng(1).uniform(size=(12, 6))
    before = problem.costs(starts)
    assert all(end.J <= J for end, J in zip(solve(problem, starts, max_iterations=2), before, strict=True))


def test_certificate_of_a_bounded_optimum(suzaku, noisy):
    result = fit(suzaku.profile, noisy, FitOptions(a_r=0.1, method="least-squares", starts=8))
    certificate = result.certificate
    assert certificate.starts_agreeing == certificate.starts == 8
    assert certificate.projected_gradient < 1e-3
    assert certificate.step_gain < 1e-7
    assert {b.name for b in certificate.active} == set(result.at_bound)
    assert all(b.gain_per_percent > 0.0 for b in certificate.active)


def test_bound_multiplier_predicts_what_a_wider_bound_gains(suzaku, noisy):
    result = fit(suzaku.profile, noisy, FitOptions(a_r=0.1, method="least-squares", starts=2))
    bound = max(result.certificate.active, key=lambda b: b.gain_per_percent)
    problem = make_problem(suzaku.profile, noisy, FitOptions(a_r=0.1))
    i = problem.box.names.index(bound.name)
    step = 0.001 * abs(problem.box.pre[i])
    (problem.box.low if bound.side == "low" else problem.box.high)[i] += step * (-1 if bound.side == "low" else 1)
    start = problem.box.to_unit(list(result.theta.values()))
    wider = solve(problem, start[:, None])[0]
    assert pytest.approx(0.1 * bound.gain_per_percent, rel=0.1) == result.J - wider.J


def test_a_stop_keeps_the_best_so_far(suzaku, noisy):
    calls = []

    def stop():
        calls.append(1)
        return len(calls) > 30

    result = fit(suzaku.profile, noisy, FitOptions(), hooks=Hooks(stop=stop))
    assert result.interrupted
    assert result.J_before > result.J
    assert result.sentence().startswith("The fit was stopped before its end: ")
    assert replace(result, interrupted=False).sentence().startswith("On 4 trials not used for tuning")


@pytest.fixture(scope="module")
def swept():
    return sweep("suzaku", "suzaku", SweepOptions(widths=(0.6, 0.2, 0.4), method="least-squares", starts=4))


@pytest.mark.long
def test_j_never_rises_with_a_r(swept):
    assert swept.widths == [0.2, 0.4, 0.6]
    J = [run.J for run in swept.runs]
    assert J[0] >= J[1] >= J[2]


def test_every_test_trial_improves_on_the_bundled_trials(swept):
    for run in swept.runs:
        for one in run.compared:
            if one.role == "test":
                assert one.J["after"] < one.J["before"], (run.options.a_r, one.trial.id)


def test_recommendation_is_the_least_test_cost(swept):
    judged = swept.judged()
    assert swept.recommended()["a_r"] == swept.widths[int(np.argmin(judged))]
    assert swept.recommended()["by"] == "test set"


def test_a_sweep_is_told_by_metres_and_degrees_the_same_everywhere(swept):
    best = swept.to_dict()["runs"][swept.best]["off"]["test"]
    held = [one.off("after") for one in swept.runs[swept.best].compared if one.role == "test"]
    track, heading = np.mean(held, axis=0)
    assert best["trials"] == len(held)
    assert best["track_m"]["after"] == pytest.approx(track)
    assert best["heading_deg"]["after"] == pytest.approx(heading)
    said = f"is {track:#.3g} m off track and {heading:#.2g}° off heading instead of "
    assert swept.recommended()["sentence"].index(said) < swept.recommended()["sentence"].index("J is least")
    rows = dict(re.findall(r"^(off \w+ test \[\w+\]) .* (\S+) *$", summary(swept, "x", report=False), re.MULTILINE))
    assert swept.best == len(swept.runs) - 1
    assert rows == {"off track test [m]": f"{track:#.3g}", "off heading test [deg]": f"{heading:#.2g}"}


def test_without_test_trials_one_trial_is_left_out_at_a_time(suzaku):
    trials = make_set(suzaku, noise=1.0, test=False)
    swept = sweep(suzaku.profile, trials, SweepOptions(widths=(0.2, 0.4), method="least-squares", starts=2))
    assert swept.recommended()["by"] == "leave-one-trial-out"
    assert len(swept.leave_one_out) == 2
    assert swept.recommended()["a_r"] == 0.4  # the truth lies beyond 0.2
    assert f"{len(trials.tune)} trials, each left out in turn" in swept.recommended()["sentence"]
    off = swept.to_dict()["runs"][1]["off"]
    assert off["left-out"]["track_m"]["after"] < off["left-out"]["track_m"]["before"]


@pytest.mark.daily("choice0")
@pytest.mark.parametrize("choice", [{"regularise": 0.5}, {"loss": "huber"}, {"initial": "estimated"}])
def test_trials_left_out_by_a_sweep_and_by_leave_out_are_judged_alike(choice):
    """A sweep left out trials without the regularisation and the loss it fitted with."""
    trials = load_trials("suzaku")
    names = tuple(trials.trials)[:3]
    trials = replace(trials, trials={name: trials.trials[name] for name in names}, tune=names, test=())
    same = {"targets": ("hull.R_0", "wake.w_P0", "rudder.kappa"), "starts": 2, **choice}
    swept = sweep("suzaku", trials, SweepOptions(widths=(0.4,), method="least-squares", **same))
    left = leave_out("suzaku", trials, LeaveOutOptions(a_r=0.4, **same))
    near = 0.1 if "initial" in choice else 1e-3  # along a valley two fits end apart
    assert swept.leave_one_out == pytest.approx([sum(one.J for one in left.after)], rel=near)
    if "initial" in choice:  # every run left out from a state of its own, as trials kept for testing in a fit
        before = [one.J["before"] for one in swept.left_out[0]]
        assert before == pytest.approx([one.J for one in left.before])


def test_over_fitting_is_named(swept):
    """Doctored: a wider box that fits the tune trials better and the others worse, in J and in metres."""

    class Doctored(type(swept)):
        def judged(self):
            return [1.0, 2.0, 5.0]

        def held_out(self, i):
            return super().held_out(len(self.runs) - 1 - i)

    doctored = Doctored(swept.runs, None, 1.0)
    assert doctored.overfitting()["found"]
    assert re.search(r"trials not used are \S+ m off track .*, with a_r = 0.2 ", doctored.overfitting()["sentence"])
    assert "a_r = 0.4" in doctored.overfitting()["sentence"]
    assert doctored.recommended()["a_r"] == 0.2


def test_no_over_fitting_is_told_where_the_tracks_come_closer(swept):
    """Doctored: J rises on trials not used, and they are fewer metres off. That was called over-fitting."""

    class Doctored(type(swept)):
        def judged(self):
            return [1.0, 2.0, 5.0]

    told = Doctored(swept.runs, None, 1.0).overfitting()
    assert not told["found"]
    found = re.fullmatch(
        r"No clear over-fitting: at a_r = 0.6 J rises to 5 on trials not used, from 1, but their tracks come closer: "
        r"trials not used are (\S+) m off track and \S+° off heading, with a_r = 0.2 (\S+) m and \S+°\.",
        told["sentence"],
    )
    assert float(found[1]) < float(found[2])


def test_a_test_trial_that_comes_closer_is_not_called_worse(swept):
    """Doctored: J of a test trial rises though its track comes closer, as where a heading is further off."""
    run = swept.runs[-1]
    tests = [one for one in run.compared if one.role == "test"]
    assert all(one.closer for one in tests)

    class Risen(type(tests[0])):
        @property
        def J(self):
            return {"before": 1.0, "after": 1.1}

    risen = Risen(tests[0].trial, "test", tests[0].records)
    mixed = replace(run, compared=tuple(risen if one is tests[0] else one for one in run.compared))
    notes = [one for one in mixed.warned() if one.code in ("worse", "mixed")]
    assert [one.code for one in notes] == ["mixed"]
    assert notes[0].words.startswith(f"J rises on test trials that come closer in metres: {tests[0].trial.id}: ")
    n = len(tests)
    assert f"; J falls on {n - 1} of {n} of these trials, the track comes closer on {n}." in mixed.sentence()
    assert f"; {n} of {n} of these trials improve." in run.sentence()


@pytest.mark.parametrize("widths", [(), (0.2, 0.2), (0.2, -0.1)])
def test_impossible_widths_are_refused_before_any_work(suzaku, noisy, widths):
    with pytest.raises(OptionError):
        sweep(suzaku.profile, noisy, SweepOptions(widths=widths, method="least-squares"))


@pytest.mark.parametrize(
    "a_r", [0.2, pytest.param(0.4, marks=pytest.mark.long), pytest.param(0.6, marks=pytest.mark.long)]
)  # from most bounds met to fewest
def test_cma_es_and_least_squares_agree_on_the_bundled_trials(suzaku, a_r):
    problem = make_problem(suzaku.profile, load_trials("suzaku"), FitOptions(a_r=a_r))
    start = problem.box.to_unit(problem.box.pre)
    by_squares = solve(problem, start[:, None])[0].J
    by_cma = search(problem, 1, start, populations=(12, 24)).J
    assert by_cma == pytest.approx(by_squares, rel=1e-4)


def test_a_start_whose_neighbours_diverge_does_not_stop_the_others(suzaku, noisy):
    """A box so wide that parts of it blow up: those starts are given up, the others reach an optimum."""
    names = ("hull.X_vvvv", "hull.N_rrr")
    problem = make_problem(suzaku.profile, noisy, FitOptions(targets=names))
    problem = problem.with_targets(problem.model, make_box(problem.model, names, 400.0))
    starts = np.array([[0.5, 0.0, 1.0, 0.75], [0.5, 1.0, 1.0, 0.3]])
    before = problem.costs(starts)
    assert not np.isfinite(before).all()
    ends = solve(problem, starts)
    assert np.isfinite(ends[0].J)
    assert before[0] > ends[0].J


def test_derivatives_by_another_method_are_of_its_runs_and_residuals_of_their_own(problem):
    unit = np.column_stack([problem.box.to_unit(problem.box.pre), np.full(len(problem.box), 0.4)])
    own, other = (problem.with_integrator(Integrator(name)) for name in ("rk4", "euler"))
    residuals, slopes, by_offset = own.jacobians(unit, slopes=Integrator("euler"))
    np.testing.assert_allclose(residuals, own.jacobians(unit)[0], rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(slopes, other.jacobians(unit)[1])
    np.testing.assert_array_equal(by_offset, other.jacobians(unit)[2])
    assert np.abs(residuals - other.jacobians(unit)[0]).max() > 0.01


def test_rough_derivatives_lead_to_the_same_end(problem):
    """Where they lead nowhere, derivatives of the problem's own take their place: those of a wrong sign here."""
    start = problem.box.to_unit(problem.box.pre)[:, None]
    estimated = problem.estimated(np.repeat(NOISE[None], len(problem.cases), axis=0))
    (own,) = solve(estimated, start, tolerance=0.02, trusting=True)
    (rough,) = solve(estimated, start, tolerance=0.02, trusting=True, slopes=Integrator("euler"))
    assert pytest.approx(own.J, abs=0.1) == rough.J

    class Misled(type(estimated)):
        def jacobians(self, unit, offsets=None, slopes=None):
            residuals, by_target, by_offset = super().jacobians(unit, offsets, slopes)
            return residuals, by_target * (1.0 if slopes is None else -1.0), by_offset

    (misled,) = solve(Misled(**vars_of(estimated)), start, tolerance=0.02, trusting=True, slopes=Integrator("euler"))
    assert pytest.approx(own.J, abs=0.1) == misled.J


def vars_of(problem):
    return {one.name: getattr(problem, one.name) for one in fields(problem)}
