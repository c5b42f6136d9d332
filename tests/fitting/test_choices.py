"""Windows, other objectives, outliers, regularisation, and runs left out."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.errors import OptionError
from mmgtune.fitting import FitOptions, LeaveOutOptions, fit, leave_out, make_problem, plan_leave_out
from mmgtune.fitting.leaving_out import leaving_out
from mmgtune.fitting.setting import make_setting
from mmgtune.motions import as_trial, simulate_trials
from mmgtune.trial import TrialSet, write_trial
from tests.command import run

QUICK = FitOptions(method="least-squares", starts=2)


def test_windows_recover_the_truth_too(suzaku, clean):
    found = fit(suzaku.profile, clean, replace(QUICK, restart=100.0))
    assert len(found.compared) > 3 * len(clean.trials)
    assert 1e-6 * found.J_before > found.J
    assert all(f"{name} = " in found.tuned_text() for name in clean.tune)


def test_the_standardised_objective_counts_all_states_over_their_spread(suzaku, clean):
    problem = make_problem(suzaku.profile, clean, replace(QUICK, objective="standardised"))
    weight = problem.cases.weight[0, 5]
    motion = np.concatenate([clean.trials[name].motion for name in clean.tune])
    assert weight[0] == pytest.approx(1.0 / np.var(motion[:, 0]))
    assert np.all(weight > 0.0)


def test_samples_far_apart_count_alone(suzaku, clean):
    dense = make_problem(suzaku.profile, clean, QUICK)
    thin = make_problem(suzaku.profile, clean, replace(QUICK, every=5.0))
    counted = np.flatnonzero(thin.cases.weight[0, :, 0])
    np.testing.assert_array_equal(counted[:3], [5, 10, 15])
    assert thin.n_residuals < dense.n_residuals / 4.5


@pytest.mark.long
def test_huber_shrugs_off_spikes(suzaku, clean):
    rng = np.random.default_rng(4)

    def spiked(trial):
        x = np.array(trial.x)
        x[rng.choice(np.arange(5, len(x)), len(x) // 25, replace=False)] += 80.0
        return replace(trial, x=x)

    bad = replace(clean, trials={name: spiked(trial) for name, trial in clean.trials.items()})
    few = replace(QUICK, targets=("hull.R_0", "wake.w_P0", "rudder.kappa"), starts=1)
    truth = fit(suzaku.profile, clean, few).theta
    errors = {}
    for loss in ("squares", "huber"):
        theta = fit(suzaku.profile, bad, replace(few, loss=loss)).theta
        errors[loss] = max(abs(theta[name] / value - 1.0) for name, value in truth.items())
    assert errors["huber"] < 0.3 * errors["squares"]


def test_regularisation_pulls_towards_what_was_known(suzaku, clean):
    away = []
    for share in (0.0, 1e-3, 1.0):
        found = fit(suzaku.profile, clean, replace(QUICK, regularise=share))
        away.append(float(np.linalg.norm(found.unit - 0.5)))
        # The certificate is of what was made small, the pull included.
        assert found.certificate.step_gain < 1e-6
    assert away[0] > away[1] > away[2]


@pytest.mark.parametrize(
    "wrong",
    [{"restart": 0.0}, {"every": -1.0}, {"loss": "cauchy"}, {"objective": "L1"}, {"regularise": -1.0},
     {"method": "cma-es", "loss": "huber"}],
)  # fmt: skip
def test_choices_that_make_no_sense(wrong):
    with pytest.raises(OptionError):
        replace(QUICK, **wrong)


def test_windows_of_a_run_are_left_out_together(clean):
    cut = clean.in_windows(100.0)
    parts = list(leaving_out(cut))
    assert len(parts) == len(clean.tune)
    for out, others in parts:
        assert len({name.partition("@")[0] for name in out}) == 1
        assert not set(out) & set(others)
        assert {*out, *others} == set(cut.tune)
    assert len(list(leaving_out(cut, 2))) == 2


def test_nothing_is_left_out_where_nothing_would_be_left(suzaku, clean):
    """A fit to no trial would be one to all: it is refused, and never scored as if it had not seen them."""
    (turn, *_) = clean.tune
    alone = TrialSet({turn: clean.trials[turn]}, (turn,), (), "suzaku")
    for data, folds, said in ((alone, 0, "only turn"), (clean, 1, "all runs are one part")):
        with pytest.raises(OptionError, match=said):
            leave_out(suzaku.profile, data, LeaveOutOptions(folds=folds))
        with pytest.raises(OptionError, match=said):
            plan_leave_out(suzaku.profile, data, LeaveOutOptions(folds=folds))
    setting = make_setting(suzaku.profile, clean, QUICK)
    assert len(setting.problem().cases) == len(clean.tune)
    assert len(setting.problem([turn]).cases) == 1


def test_trials_of_the_profile_itself_leave_nothing_to_tune(suzaku, clean):
    made = [as_trial(suzaku.profile, one) for one in simulate_trials(suzaku, list(clean.trials.values())[:3])]
    found = fit(suzaku.profile, made, QUICK)
    assert found.J_before == found.J == 0.0
    assert found.certificate.starts_agreeing == found.certificate.starts
    (row, *_) = leave_out(suzaku.profile, made, LeaveOutOptions(starts=1)).rows()
    assert row["share_removed"] == 0.0


def test_left_out_runs_are_scored_by_coefficients_that_never_saw_them(suzaku, noisy):
    few = replace(QUICK, targets=("hull.R_0", "wake.w_P0", "rudder.kappa"), starts=1)
    asked = LeaveOutOptions(targets=few.targets, starts=1, integrator=few.integrator)
    result = leave_out(suzaku.profile, noisy, asked)
    assert [one.id for one in result.after] == list(noisy.tune)
    row = result.rows()[0]
    assert row["manoeuvre"] == "all"
    assert row["L_MSE_after"] < row["L_MSE_before"]
    low, high = row["share_removed_ci95"]
    assert low <= row["share_removed"] <= high
    for runs, theta in zip(result.parts, result.thetas, strict=True):
        others = TrialSet(
            {n: t for n, t in noisy.trials.items() if n not in runs}, tuple(n for n in noisy.tune if n not in runs), ()
        )
        alone = fit(suzaku.profile, others, few).theta
        assert alone["hull.R_0"] == pytest.approx(theta["hull.R_0"], rel=1e-4)


def test_effects_are_put_in_to_be_tuned(tmp_path, clean):
    (tmp_path / "log").mkdir()
    for name in clean.tune:
        write_trial(clean.trials[name], tmp_path / "log" / f"{name}.parquet")
    fitted = run(
        "fit", "-t", "log", "--with-effects", "current,rudder-offset", "--method", "least-squares", "--starts", "1",
        "--no-report", "--quiet", "--json", "--out", "out", cwd=tmp_path,
    )  # fmt: skip
    assert fitted.code == 0, fitted.err
    theta = fitted.json()["theta"]
    assert len(theta) == 15  # twelve, the current's two, the rudder's zero; no trial measured a current
    assert abs(theta["effects.current.north"]) < 1e-3
    assert "[effects.current]" in (tmp_path / "out" / "profile.toml").read_text()
    assert run("profile", "validate", "out/profile.toml", cwd=tmp_path).code == 0


@pytest.mark.parametrize(("arguments", "said"), [(("curent",), "current"), (("flap", "-p", "kvlcc2"), "rudder.flap")])
def test_effects_that_cannot_be_put_in(arguments, said, tmp_path):
    ended = run("fit", "--with-effects", *arguments, "--dry-run", cwd=tmp_path)
    assert ended.code == 2
    assert said in ended.err


@pytest.mark.long
def test_the_leave_out_command(tmp_path, clean):
    (tmp_path / "log").mkdir()
    for name in clean.tune:
        write_trial(clean.trials[name], tmp_path / "log" / f"{name}.parquet")
    ended = run("leave-out", "-t", "log", "--targets", "R_0,kappa", "--starts", "1", "--quiet", "--json", cwd=tmp_path)
    assert ended.code == 0, ended.err
    document = ended.json()
    assert document["kind"] == "leave-out"
    assert len(document["parts"]) == 4
    shown = run("leave-out", "-t", "log", "--targets", "R_0", "--folds", "2", "--starts", "1", "--quiet", cwd=tmp_path)
    assert "2 fits" in shown.out
    assert shown.out.splitlines()[0].split()[:2] == ["left", "out"]
    assert "removed" in shown.out.splitlines()[0]
