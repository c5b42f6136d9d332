"""Scores of a model on trials, by hand and as a user asks for them."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.backends import STATES
from mmgtune.motions import simulate_trials
from mmgtune.objective import default_scales, spread
from mmgtune.scores import L_MSE, TrialScore, by_manoeuvre, by_run, improvement, score
from mmgtune.trial import write_trial
from tests.command import run
from tests.fitting.conftest import make_set


def _score(run: str, squares: float, n: int = 10, manoeuvre: str = "turning") -> TrialScore:
    return TrialScore(run, run, run, manoeuvre, 0.0, {"x": squares}, {"x": n}, n)


def test_spread_wraps_the_heading(suzaku):
    trial = next(iter(make_set(suzaku).trials.values()))
    turned = replace(trial, psi=trial.psi + 20.0 * np.pi)
    assert spread([turned])["psi"] == pytest.approx(spread([trial])["psi"])
    assert spread([trial])["psi"] < np.pi
    assert spread([trial])["x"] == pytest.approx(np.std(trial.x))


def test_both_measures_by_hand(suzaku):
    """Equation 26 of Wakita et al. 2022, and J of Suyama et al. 2023, over all samples after the first."""
    trials = list(make_set(suzaku, noise=1.0).trials.values())[:2]
    sigma = spread(trials)
    found = score(suzaku, trials, sigma)
    for trial, motion, one in zip(trials, simulate_trials(suzaku, trials), found, strict=True):
        difference = dict(zip(STATES, (motion.states - trial.motion)[1:].T, strict=True))
        squares = sum((difference[name] / sigma[name]) ** 2 for name in STATES)
        assert pytest.approx(np.mean(squares), rel=1e-9) == one.L_MSE
        scales = default_scales(83.0)
        assert pytest.approx(sum(np.sum((difference[c] / scales[c]) ** 2) for c in ("x", "y", "psi"))) == one.J


def test_a_gap_in_one_channel_leaves_the_others(suzaku):
    """A gap takes its own channel's samples out of J and L_MSE, and nobody else's."""
    trial = next(iter(make_set(suzaku, noise=1.0).trials.values()))
    x = np.array(trial.x)
    x[50:60] = np.nan
    sigma = spread([trial])
    (whole,) = score(suzaku, [trial], sigma)
    (found,) = score(suzaku, [replace(trial, x=x)], sigma)
    assert found.n_samples == whole.n_samples == trial.n_samples - 1
    assert found.counts == {**whole.counts, "x": trial.n_samples - 11}
    (motion,) = simulate_trials(suzaku, [trial])
    lost = np.sum((motion.states - trial.motion)[50:60, 0] ** 2)
    assert pytest.approx(whole.J - lost / 83.0**2, rel=1e-12) == found.J
    parts = {name: whole.squares[name] / whole.counts[name] for name in STATES}
    parts["x"] = (whole.squares["x"] - lost / sigma["x"] ** 2) / found.counts["x"]
    assert pytest.approx(sum(parts.values()), rel=1e-12) == found.L_MSE


def test_a_channel_nobody_measured_adds_nothing(suzaku):
    trial = next(iter(make_set(suzaku, noise=1.0).trials.values()))
    v = np.full(trial.n_samples, np.nan)
    v[0] = trial.v_m[0]
    (whole,) = score(suzaku, [trial], spread([trial]))
    (found,) = score(suzaku, [replace(trial, v_m=v)], spread([trial]))
    assert pytest.approx(whole.L_MSE - whole.squares["v_m"] / whole.counts["v_m"]) == found.L_MSE


def test_samples_count_alike_over_trials_of_any_length():
    assert L_MSE([_score("a", 10.0, 10), _score("b", 0.0, 30)]) == pytest.approx(0.25)
    assert np.isnan(L_MSE([]))


def test_groups():
    scores = [_score("a", 1.0), _score("b", 1.0, manoeuvre="zigzag"), replace(_score("a", 1.0), id="a@100")]
    assert {kind: len(of) for kind, of in by_manoeuvre(scores).items()} == {"turning": 2, "zigzag": 1}
    assert {name: len(of) for name, of in by_run(scores).items()} == {"a": 2, "b": 1}


def test_improvement_and_its_interval():
    before = [_score(str(k), 10.0) for k in range(12)]
    same = improvement(before, [_score(str(k), 4.0) for k in range(12)])
    assert same[0] == pytest.approx(0.6)
    assert same[1] == pytest.approx((0.6, 0.6))
    share, interval = improvement(before, [_score(str(k), 8.0 * (k % 2)) for k in range(12)])
    assert interval is not None
    assert interval[0] < share < interval[1]
    assert improvement(before[:2], before[:2])[1] is None


def test_the_command(tmp_path, suzaku):
    data = make_set(suzaku, noise=1.0)
    (tmp_path / "log").mkdir()
    for trial in data.trials.values():
        write_trial(trial, tmp_path / "log" / f"{trial.id}.parquet")
    ended = run("validate", "suzaku", "kvlcc2", "log", "--restart", "100", "--json", cwd=tmp_path)
    assert ended.code == 0, ended.err
    document = ended.json()
    good, other = document["profiles"]
    assert good["L_MSE"] < other["L_MSE"]
    assert good["by_manoeuvre"]["turning"]["runs"] == 8
    assert {row["id"] for row in good["trials"]} == set(data.trials)
    assert sum(row["windows"] for row in good["trials"]) > 2 * len(data.trials)
    shown = run("validate", "suzaku", "log", cwd=tmp_path)
    assert "L_MSE" in shown.out
    assert "turn_p10" in shown.out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("suzaku",), "missing"),
        (("suzaku", "suzaku", "--restart", "0"), "--restart"),
        (("suzaku", "suzaku", "--integrator", "leapfrog"), "leapfrog"),
        (("suzaku", "nowhere"), "no such trials"),
    ],
)
def test_wrong_arguments(arguments, said, tmp_path):
    ended = run("validate", *arguments, cwd=tmp_path)
    assert ended.code == 2
    assert said in ended.err
    assert "Traceback" not in ended.err


@pytest.fixture
def eastward(tmp_path, suzaku):
    """Turns whose northward positions are all the same number, the mean of which is not quite that number."""
    for trial in make_set(suzaku, noise=1.0).trials.values():
        write_trial(replace(trial, x=np.full(trial.n_samples, 0.1)), tmp_path / "log" / f"{trial.id}.parquet")
    return tmp_path


ONE_TARGET = ("--targets", "hull.R_0", "--starts", "1", "--quiet")


@pytest.mark.parametrize(
    "arguments",
    [
        ("validate", "suzaku", "log"),
        ("compare", "suzaku", "suzaku", "log"),
        ("predict", "suzaku", "--trials", "log"),
        ("fit", "--trials", "log", "--objective", "standardised", "--method", "least-squares", *ONE_TARGET),
    ],
)
def test_a_state_that_does_not_vary(arguments, eastward):
    ended = run(*arguments, cwd=eastward)
    assert ended.code == 2, ended.err
    assert "do not vary in x" in ended.err
    assert "fix: " in ended.err


@pytest.mark.long
def test_what_is_not_divided_by_the_spread_works_all_the_same(eastward):
    line = ("fit", "--trials", "log", "--objective", "standardised", "--channels", "u,v,r", "--initial", "estimated")
    fitted = run(*line, *ONE_TARGET, "--method", "least-squares", "--no-report", "--json", cwd=eastward)
    assert fitted.code == 0, fitted.err
    left_out = run("leave-out", "--trials", "log", "--folds", "2", *ONE_TARGET, "--json", cwd=eastward)
    assert left_out.code == 0, left_out.err
    assert left_out.json()["sigma"]["x"] is None
    assert "encountered" not in left_out.err
