"""The scatter of formulas as box and prior: what trials say is followed, what they do not say stays where it was."""

import json
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.components import split_name
from mmgtune.errors import OptionError
from mmgtune.fitting import FitOptions, LeaveOutOptions, SweepOptions, fit, leave_out, make_problem, sweep
from mmgtune.fitting.cmaes import search
from mmgtune.fitting.least_squares import solve
from mmgtune.fitting.weighing import n_independent, weigh
from mmgtune.profile import parse_profile
from mmgtune.trial import TrialSet
from tests.command import run
from tests.fitting.conftest import TRUTH, make_set, make_trial, solve_asked

LEAST = "least-squares"
QUICK = FitOptions(method=LEAST, starts=2)
MANY = tuple(f"hull.{name}" for name in ("R_0", "X_vv", "X_vr", "X_rr", "X_vvvv", "Y_v", "Y_r", "Y_vvv", "Y_vvr"))
MANY += tuple(f"hull.{name}" for name in ("Y_vrr", "Y_rrr", "N_v", "N_r", "N_vvv", "N_vvr", "N_vrr", "N_rrr"))


def scattered(profile, share, names):
    """The profile with a scatter of ``share`` of its value on each coefficient named."""
    sections = dict(profile.sections)
    for name in names:
        kind, symbol = split_name(name)
        section = sections[kind]
        now = section.coefficients[symbol]
        now = replace(now, scatter=share * abs(now.value))
        sections[kind] = replace(section, coefficients={**section.coefficients, symbol: now})
    return replace(profile, sections=sections)


@pytest.fixture(scope="module")
def formulas(suzaku):
    """SUZAKU, her twelve targets from formulas with a scatter of 20 %."""
    return scattered(suzaku.profile, 0.2, suzaku.profile.targets)


def test_the_box_is_two_scatters_unless_something_else_is_said(formulas, noisy):
    def limits(options=QUICK, profile=formulas):
        box = make_problem(profile, noisy, options).box
        return dict(zip(box.names, zip(*box.limits, strict=True), strict=True))

    R_0 = formulas.value("hull.R_0")
    assert limits()["hull.R_0"] == pytest.approx((0.6 * R_0, 1.4 * R_0))
    assert limits(replace(QUICK, a_r=0.1))["hull.R_0"] == pytest.approx((0.9 * R_0, 1.1 * R_0))
    hull = formulas.sections["hull"]
    own = {**hull.coefficients, "R_0": replace(hull.coefficients["R_0"], bounds=(0.01, 0.02))}
    bounded = replace(formulas, sections={**formulas.sections, "hull": replace(hull, coefficients=own)})
    assert limits(profile=bounded)["hull.R_0"] == (0.01, 0.02)


def test_without_scatter_or_without_prior_nothing_changes(suzaku, formulas, noisy):
    plain = fit(suzaku.profile, noisy, QUICK)
    assert plain.options.a_r == 0.5
    assert plain.beside is None
    without = fit(formulas, noisy, replace(QUICK, a_r=0.5, prior=False))
    elsewhere = fit(scattered(suzaku.profile, 0.2, ["hull.Y_v"]), noisy, QUICK)
    for other in (without, elsewhere):
        np.testing.assert_array_equal(other.unit, plain.unit)
        assert (other.J, other.theta, other.identifiability.stderr) == (
            plain.J,
            plain.theta,
            plain.identifiability.stderr,
        )
        assert other.to_dict()["beside"] is None


@pytest.mark.parametrize("phi", [0.0, 0.5, 0.9])
def test_independent_samples_of_known_autocorrelation(phi):
    rng = np.random.default_rng(1)
    parts = []
    for _ in range(8):
        values = np.zeros(4000)
        for k, new in enumerate(rng.standard_normal(4000)):
            values[k] = phi * values[k - 1] + new
        parts.append(values)
    assert n_independent(parts) == pytest.approx(32000 * (1.0 - phi) / (1.0 + phi), rel=0.15)


def test_a_constant_difference_is_one_number_a_series():
    assert n_independent([np.full(500, 0.3), np.full(200, -0.1)]) == 2.0
    assert n_independent([np.zeros(50)]) == 50.0
    slow, rng = np.repeat(np.random.default_rng(2).standard_normal(40), 100), np.random.default_rng(3)
    assert n_independent([slow + rng.standard_normal(4000)]) < 400  # noise on top does not hide what is slow


def test_what_trials_do_not_know_stays_and_what_they_know_follows(suzaku):
    names = (*MANY, *(name for name in suzaku.profile.targets if name not in MANY))[:25]
    profile = scattered(suzaku.profile, 0.15, names)
    rng = np.random.default_rng(7)
    truth = {name: profile.value(name) * (1.0 + 0.15 * rng.uniform(-1.5, 1.5)) for name in names}
    trials = {id: make_trial(suzaku, id, angle, 240, truth, 1.0) for id, angle in (("p", 20.0), ("m", -35.0))}
    result = fit(profile, TrialSet(trials, ("p", "m"), (), "suzaku"), replace(QUICK, targets=names))
    assert len(result.box) == 25
    problem = make_problem(profile, TrialSet(trials, ("p", "m"), ()), replace(QUICK, targets=names))
    _, slopes = problem.central_jacobian(result.unit)
    rows = slopes[: problem.n_residuals] * (result.box.scatter / result.box.width)
    _, singular, directions = np.linalg.svd(rows / np.sqrt(result.beside.weight.s2), full_matrices=False)
    moved = (np.array(list(result.theta.values())) - result.box.centre) / result.box.scatter
    true = (np.array([truth[name] for name in result.box.names]) - result.box.centre) / result.box.scatter
    known, unknown = np.arange(25) < 4, singular < 0.2
    assert singular[3] > 5.0
    assert unknown.sum() >= 8
    assert np.abs(directions[unknown] @ moved).max() < 0.2
    assert np.abs(directions[known] @ (moved - true)).max() < 0.3
    assert np.abs(directions[known] @ true).max() > 1.0
    assert 1e-2 * result.J_before > result.J
    assert "the prior decides the rest" in result.identifiability.sentences[0]


@pytest.mark.long
def test_twice_the_data_half_the_pull(suzaku):
    names = ("hull.R_0", "wake.w_P0", "rudder.kappa")
    profile = scattered(suzaku.profile, 0.05, names)
    options = replace(QUICK, targets=names, a_r=0.5)
    off = {}
    for copies in (1, 2, 4):
        trials = {}
        for k in range(copies):
            one = make_set(suzaku, {name: TRUTH[name] for name in names}, noise=1.0, test=False)
            trials |= {f"{id}_{k}": replace(trial, id=f"{id}_{k}") for id, trial in one.trials.items()}
        data = TrialSet(trials, tuple(trials), (), "suzaku")
        problem = make_problem(profile, data, options)
        weighed, weight = weigh(problem, problem.box.to_unit(problem.box.pre))
        assert weight.settled
        fixed = off.setdefault("s2", weight.s2)
        assert weight.s2 == pytest.approx(fixed, rel=0.35)  # of one difference, not of their number
        start = problem.box.to_unit(problem.box.pre)[:, None]
        free = solve(problem.with_weight(1e-15), start)[0].unit
        off[copies] = np.linalg.norm(solve(weighed.with_weight(fixed), start)[0].unit - free)
    assert off[1] / off[2] == pytest.approx(2.0, rel=0.15)
    assert off[2] / off[4] == pytest.approx(2.0, rel=0.15)


@pytest.mark.long
def test_ships_drawn_from_the_prior_are_recovered_better_with_it(suzaku):
    names = tuple(dict.fromkeys((*MANY, *suzaku.profile.targets)))
    profile = scattered(suzaku.profile, 0.15, names)
    J = {True: [], False: []}
    for seed in range(6):
        rng = np.random.default_rng(seed)
        factors = 1.0 + 0.15 * np.clip(rng.standard_normal(len(names)), -1.8, 1.8)
        truth = {name: profile.value(name) * factor for name, factor in zip(names, factors, strict=True)}
        angles = {"t1": 20.0, "t2": -35.0, "a": -10.0, "b": 10.0, "c": 35.0, "d": -20.0}
        trials = {id: make_trial(suzaku, id, angle, 240, truth, 1.0) for id, angle in angles.items()}
        data = TrialSet(trials, ("t1", "t2"), ("a", "b", "c", "d"), "suzaku")
        for prior in J:
            found = fit(profile, data, replace(QUICK, targets=names, prior=prior, starts=1))
            J[prior].append(found.J_of("test", "after"))
    better = np.array(J[False]) / np.array(J[True])
    assert np.exp(np.mean(np.log(better))) > 1.3
    assert np.sum(better > 1.0) >= 5


def test_both_searches_make_the_same_small(formulas, noisy):
    problem = make_problem(formulas, noisy, replace(QUICK, targets=("hull.R_0", "wake.w_P0", "rudder.kappa")))
    start = problem.box.to_unit(problem.box.pre)
    problem, _ = weigh(problem, start)
    ends = solve(problem, start[:, None])[0]
    found = search(problem, 1, start, populations=(12,))
    assert pytest.approx(ends.J, rel=1e-6) == found.J
    np.testing.assert_allclose(found.unit, ends.unit, atol=1e-4)
    squares = problem.squares(ends.unit[:, None])["prior"][0]
    away = (problem.box.from_unit(ends.unit) - problem.box.centre) / problem.box.scatter
    assert squares == pytest.approx(np.sum(away**2))
    assert pytest.approx(problem.misfit(ends.unit[:, None])[0] + problem.weight * squares) == ends.J
    rows = problem.residuals(ends.unit[:, None])[0]
    assert len(rows) == problem.n_residuals + 3
    assert rows @ rows == pytest.approx(ends.J)


def test_estimated_initial_states_go_with_it(formulas, noisy):
    result = fit(formulas, noisy, replace(QUICK, initial="estimated"))
    assert result.beside.weight.settled
    assert result.certificate.step_gain < 1e-6
    assert all(error is not None and error > 0.0 for error in result.identifiability.stderr.values())
    for name, error in result.identifiability.stderr.items():
        assert error < formulas.coefficient(name).scatter


def test_a_tuned_profile_is_held_by_its_formulas_still(formulas, noisy):
    result = fit(formulas, noisy, replace(QUICK, targets=("hull.R_0", "wake.w_P0")))
    again = parse_profile(result.tuned_text())
    problem = make_problem(again, noisy, replace(QUICK, targets=("hull.R_0", "wake.w_P0")))
    assert problem.box.prior_of(0) == (formulas.value("hull.R_0"), pytest.approx(0.2 * formulas.value("hull.R_0")))
    assert again.value("hull.R_0") != formulas.value("hull.R_0")


def test_a_solve_is_told_from_another_by_its_prior(formulas, noisy):
    problem = make_problem(formulas, noisy, QUICK)
    start = problem.box.to_unit(problem.box.pre)[:, None]
    asked = [solve_asked(one, start) for one in (problem, problem.with_weight(2.0))]
    asked.append(solve_asked(make_problem(formulas, noisy, replace(QUICK, prior=False)), start))
    asked.append(solve_asked(make_problem(scattered(formulas, 0.1, ["hull.R_0"]), noisy, QUICK), start))
    assert len(set(asked)) == 4


@pytest.mark.long
def test_sweeps_and_leaving_out_follow(formulas, noisy):
    few = ("hull.R_0", "wake.w_P0")
    swept = sweep(
        formulas, replace(noisy, test=()), SweepOptions(targets=few, widths=(0.2, 0.4), starts=1, method=LEAST)
    )
    assert all(run.beside is not None for run in swept.runs)
    left = leave_out(formulas, noisy, LeaveOutOptions(targets=few, starts=1))
    assert left.to_dict()["weight"]["s2"] > 0.0
    assert left.options.a_r is None
    plain = leave_out(formulas, noisy, LeaveOutOptions(targets=few, starts=1, prior=False))
    assert "weight" not in plain.to_dict()
    assert plain.thetas != left.thetas


def test_a_user_sees_box_and_prior(formulas, tmp_path):
    ship = tmp_path / "ship.toml"
    ship.write_text(formulas.text)
    said = run("fit", "-p", ship, "-t", "suzaku", "--dry-run", cwd=tmp_path)
    assert said.code == 0, said.err
    assert "prior     12 targets by the scatter of their formulas" in said.out
    assert "within 2 scatters of the formulas, else +-0.5" in said.out
    assert "prior 0.017 +- 0.0034" in said.out
    without = run("fit", "-p", ship, "-t", "suzaku", "--dry-run", "--no-prior", "--ar", "0.3", cwd=tmp_path)
    assert "prior  " not in without.out
    assert "within +-0.3 of" in without.out
    flags = ("--method", "least-squares", "--starts", "1", "--targets", "hull.R_0,wake.w_P0")
    done = run("fit", "-p", ship, "-t", "suzaku", *flags, "-o", "run", cwd=tmp_path)
    assert done.code == 0, done.err
    assert "Prior: scatter of the formulas, weight" in done.out
    record = json.loads((tmp_path / "run" / "fit.json").read_text())
    assert record["options"]["a_r"] is None
    assert record["beside"]["weight"]["settled"]
    assert record["beside"]["squares"]["prior"]["before"] == 0.0
    assert record["coefficients"][0]["scatter"] == pytest.approx(0.0034)
    assert "Prior: scatter of the formulas" in (tmp_path / "run" / "report.md").read_text()
    again = run("fit", "-p", "run/profile.toml", "-t", "suzaku", *flags, "--dry-run", cwd=tmp_path)
    assert again.code == 0, again.err


def test_a_width_that_is_none_is_refused_as_before():
    with pytest.raises(OptionError):
        FitOptions(a_r=0.0)


def test_the_weight_of_trials_that_fit_exactly_is_small_and_finite(formulas, clean):
    problem = make_problem(formulas, clean, QUICK)
    _, weight = weigh(problem, problem.box.to_unit(problem.box.pre))
    assert 0.0 < weight.s2 < 1e-3
