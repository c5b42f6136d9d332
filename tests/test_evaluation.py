"""One evaluation: fit, validation, check and records agree to the last bit, with gaps and without; nothing warns."""

from dataclasses import fields, replace

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.checking.measuring import measure
from mmgtune.evaluation import evaluate
from mmgtune.fitting import fit, leave_out
from mmgtune.fitting.setting import make_setting
from mmgtune.measures import distance_measures, reference_of
from mmgtune.metrics import METRICS
from mmgtune.motions import as_trial, simulate_trials, trial_indices
from mmgtune.objective import make_objective, spread
from mmgtune.options import FitOptions, LeaveOutOptions, ValidateOptions
from mmgtune.orders import TurningOrder, run_manoeuvre
from mmgtune.profile import ShipProfile
from mmgtune.scores import score
from mmgtune.trial import TrialSet, load_trials, write_trial
from mmgtune.validating import validate
from tests.command import run
from tests.fitting.conftest import make_set

QUICK = FitOptions(method="least-squares", starts=1, targets=("R_0", "N_r"))
LEFT_OUT = LeaveOutOptions(starts=1, targets=("R_0", "N_r"), folds=2)


@pytest.fixture(scope="module", params=["whole", "gaps"])
def trials(request, suzaku) -> TrialSet:
    """Trials with sensor noise, without gaps or with some in single channels."""
    whole = make_set(suzaku, noise=1.0)
    if request.param == "whole":
        return whole
    holed = {}
    for k, (name, trial) in enumerate(whole.trials.items()):
        x, r = np.array(trial.x), np.array(trial.r)
        x[40 + k : 70] = np.nan
        r[90:] = np.nan
        holed[name] = replace(trial, x=x, r=r)
    return replace(whole, trials=holed)


def test_fit_validation_and_check_have_the_same_J(suzaku, trials):
    every = list(trials.trials.values())
    fitted = fit(suzaku.profile, trials, QUICK)
    scores = score(suzaku, every, spread(every))
    checked = measure(suzaku, every, ["J"])[0]
    before = [one.J["before"] for one in fitted.compared]
    assert before == [one.J for one in scores]
    assert before == [checked[trial.id]["J"] for trial in every]
    assert fitted.J_of("tune", "before") == sum(one.J for one in scores if one.id in trials.tune)
    # What the search itself made small is the same sum in another order.
    assert fitted.J_before == pytest.approx(fitted.J_of("tune", "before"), rel=1e-12)
    assert pytest.approx(fitted.J_of("tune", "after"), rel=1e-12) == fitted.J
    after = [one.J for one in score(fitted.tuned_profile(), every, spread(every))]
    assert after == pytest.approx([one.J["after"] for one in fitted.compared], rel=1e-12)


def test_leaving_out_and_validation_have_the_same_scores(suzaku, trials):
    left = leave_out(suzaku.profile, trials, LEFT_OUT)
    tuned = [trials.trials[name] for name in trials.tune]
    assert list(left.before) == score(suzaku, tuned, spread(tuned))


def test_the_records_by_hand(suzaku, trials):
    every = list(trials.trials.values())
    for trial, motion, record in zip(every, simulate_trials(suzaku, every), evaluate(suzaku, every), strict=True):
        assert np.array_equal(record.states, motion.states)
        difference = (motion.states - trial.motion)[1:]
        for k, (name, value) in enumerate(record.rms.items()):
            own = difference[np.isfinite(difference[:, k]), k]
            assert record.counts[name] == len(own)
            assert value == pytest.approx(np.sqrt(np.mean(own**2)), rel=1e-12)
        scale = np.array([83.0, 83.0, 0.25 * np.pi])
        assert pytest.approx(np.nansum((difference[:, :3] / scale) ** 2), rel=1e-12) == record.J
        assert record.measures == distance_measures(trial.motion, motion.states, reference_of(trial.motion))
        assert bool(record.indices) or np.isnan(trial.motion).any()


def test_runge_kutta_is_the_default_everywhere(suzaku):
    assert Integrator().name == "rk4"
    assert FitOptions().make_integrator() == Integrator()
    trial = next(iter(make_set(suzaku).trials.values()))
    (default,), (rk4,) = (
        simulate_trials(suzaku, [trial]),
        simulate_trials(suzaku, [trial], integrator=Integrator("rk4")),
    )
    assert np.array_equal(default.states, rk4.states)


def test_windows_are_held_a_portion_at_a_time(suzaku, monkeypatch):
    """A thousand windows scored: no run of the back end sees more than a portion of them."""
    from mmgtune import predictor

    trial = next(iter(make_set(suzaku, noise=1.0).trials.values()))
    seen = []
    asked = predictor.PhysicsPredictor.predict

    def watched(self, cases):
        seen.append(len(cases) * cases.t.shape[1])
        return asked(self, cases)

    monkeypatch.setattr(predictor.PhysicsPredictor, "predict", watched)
    many = [replace(trial, id=str(k)) for k in range(1000)]
    scores = score(suzaku, many, spread([trial]))
    assert len(scores) == 1000
    assert len({one.J for one in scores}) == 1
    assert len(seen) > 1
    assert max(seen) <= predictor.AT_ONCE


def test_a_thousand_windows_fit_into_little_memory(suzaku):
    """120 s at 10 Hz, a thousand times: what scoring needs besides the windows themselves stays below 100 MB."""
    import tracemalloc

    (turn,) = [run_manoeuvre(suzaku, TurningOrder(0.3), longest=120.0, sample=0.1)]
    trial = as_trial(suzaku.profile, turn)
    many = [replace(trial, id=str(k)) for k in range(1000)]
    tracemalloc.start()
    assert len(score(suzaku, many, spread([trial]))) == 1000
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 100e6


def test_an_objective_of_ones_own_counts_in_J_alone(suzaku):
    every = list(make_set(suzaku, noise=1.0).trials.values())[:1]
    paper = evaluate(suzaku, every)[0]
    (late,) = evaluate(suzaku, every, make_objective(83.0, ["u"], (100.0, 200.0)))
    assert late.J < paper.J
    assert late.rms == paper.rms


@pytest.fixture
def wild(suzaku) -> ShipProfile:
    """A ship that spins up without bound."""
    from mmgtune.profile import parse_profile

    text = suzaku.profile.text
    lines = ["N_rrr = 400.0" if line.startswith("N_rrr = ") else line for line in text.splitlines()]
    return parse_profile("\n".join(lines) + "\n")


def test_nothing_warns_where_a_simulation_diverges(wild, suzaku):
    """Warnings are errors here."""
    trials = make_set(suzaku, noise=1.0)
    every = list(trials.trials.values())
    records = evaluate(wild, every)
    assert any(record.diverged for record in records)
    for record in records:
        assert record.J >= 0.0
        assert record.rms
        assert record.measures
        assert record.indices is not None
    assert all(
        row["L_MSE"] is None
        for row in validate({"wild": wild}, trials, ValidateOptions(manoeuvres=True)).to_dict()["profiles"]
    )
    checked = measure(wild, every, list(METRICS))[0].values()
    assert any(value == np.inf for values in checked for value in values.values())
    left = leave_out(wild, trials, LEFT_OUT)
    assert left.rows()[0]["L_MSE_before"] is None
    assert [row["J_before"] for row in left.rows()]


@pytest.mark.parametrize(
    "command",
    [
        ("validate", "wild.toml", "log"),
        ("check", "wild.toml", "log", "--baseline", "check.json", "--update-baseline"),
        ("simulate", "-p", "wild.toml", "--trials", "log"),
        ("leave-out", "-p", "wild.toml", "-t", "log", "--targets", "R_0", "--starts", "1", "--folds", "2"),
    ],
)
def test_no_command_warns_where_a_simulation_diverges(command, wild, suzaku, tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONWARNINGS", "error")
    (tmp_path / "wild.toml").write_text(wild.text, encoding="utf-8")
    (tmp_path / "log").mkdir()
    for trial in list(make_set(suzaku, noise=1.0).trials.values())[:3]:
        write_trial(trial, tmp_path / "log" / f"{trial.id}.parquet")
    ended = run(*command, cwd=tmp_path)
    assert ended.code == (1 if command[0] == "simulate" else 0), ended.err
    assert "Warning" not in ended.err
    assert "diverge" in ended.out or command[0] == "check"


def test_one_model_is_made_for_a_fit(suzaku, monkeypatch):
    """Held and estimated initial states, all trials and held directions share a setting."""
    import mmgtune.fitting.run as fitting

    made = []

    def counted(*arguments):
        made.append(arguments)
        return make_setting(*arguments)

    monkeypatch.setattr(fitting, "make_setting", counted)
    for options in (
        QUICK,
        replace(QUICK, initial="estimated"),
        replace(QUICK, identifiable=True, loss="huber"),
    ):
        made.clear()
        result = fit(suzaku.profile, make_set(suzaku, noise=1.0), options)
        assert len(made) == 1
        assert result.evaluations > 10


def test_a_problem_does_not_change(suzaku):
    setting = make_setting(suzaku.profile, make_set(suzaku, noise=1.0), replace(QUICK, initial="estimated"))
    problem = setting.problem()
    for field in fields(problem):
        with pytest.raises(AttributeError):
            setattr(problem, field.name, None)
    unit = problem.box.to_unit(problem.box.pre)[:, None]
    moved = problem.with_offsets(problem.sigma)
    held = moved.from_measured()
    assert held.costs(unit) == problem.costs(unit)
    assert moved.costs(unit) != problem.costs(unit)
    assert held.evaluations == moved.evaluations == problem.evaluations == 4
    assert np.array_equal(held.estimated(problem.sigma).prior, problem.prior)
    found = moved.states(unit)
    assert np.array_equal(found.states[:, 0, 0], moved.cases.initial + problem.sigma)
    assert np.array_equal(moved.states(unit, np.zeros((4, 1, 6))).states, problem.states(unit).states)


@pytest.mark.parametrize("n_missing", [1, 3, 4])
@pytest.mark.parametrize("first", [100, 478])
def test_indices_of_a_record_with_a_few_cells_missing(n_missing, first, tmp_path):
    """One cell without a heading took all indices of the run away, without a word."""
    whole = load_trials("suzaku")["turn_p35"]
    psi, usual = np.array(whole.psi), trial_indices(whole, 83.0)
    psi[first : first + n_missing] = np.nan
    n_missing = int(np.isnan(psi).sum())
    gapped = replace(whole, psi=psi)
    found = trial_indices(gapped, 83.0)
    assert bool(found) == (n_missing <= 3)
    for name in ("advance_m", "tactical_diameter_m") if found else ():
        assert found[name] == pytest.approx(usual[name], rel=1e-3)
    write_trial(gapped, tmp_path / "turn_p35.parquet")
    said = run("trials", "inspect", "turn_p35.parquet", cwd=tmp_path).out
    assert ("no manoeuvring indices: they are read over gaps of up to 3 samples" in said) != bool(found)
