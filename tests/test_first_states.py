"""What noise of first samples alone brings to J, held against draws of it, and first states estimated."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from mmgtune.errors import OptionError
from mmgtune.evaluation import evaluate
from mmgtune.first_states import LARGEST, J_of_noise, estimated, in_words
from mmgtune.fitting import fit
from mmgtune.fitting.least_squares import fit_offsets
from mmgtune.fitting.setting import make_problem
from mmgtune.objective import make_objective
from mmgtune.options import FitOptions, ValidateOptions, VoyageOptions
from mmgtune.options.tuning import INITIAL
from mmgtune.predictor import Prediction, as_predictor
from mmgtune.profile import with_values
from mmgtune.trial.index_trial import IndexTrial, Stated
from mmgtune.trial.schema import ATTRIBUTES
from mmgtune.validating import validate
from mmgtune.voyages import validate_voyages
from tests.command import run
from tests.fitting.conftest import make_set

SIGMA = {"x": 0.4, "y": 0.4, "psi": 0.003, "u": 0.02, "v": 0.02, "r": 0.0005}
QUICK = FitOptions(method="least-squares", starts=1, targets=("R_0", "N_r", "Y_v"))


@pytest.fixture(scope="module")
def sailed(suzaku):
    """Trials that the model itself sailed, with no noise but what they say of their sensors."""
    whole = make_set(suzaku, truth={})
    return replace(whole, trials={name: replace(one, noise=SIGMA) for name, one in whole.trials.items()})


def noisy(trials, rng):
    """The same with noise in the first sample alone."""
    found = {}
    for name, one in trials.trials.items():
        columns = {}
        for column, sigma in SIGMA.items():
            values = np.array(getattr(one, ATTRIBUTES[column]))
            values[0] += sigma * rng.standard_normal()
            columns[ATTRIBUTES[column]] = values
        found[name] = replace(one, **columns)
    return replace(trials, trials=found)


def test_a_faultless_model_errs_by_what_noise_of_first_samples_brings(suzaku, sailed):
    trials = list(sailed.trials.values())
    expected = J_of_noise(as_predictor(suzaku), trials, make_objective(suzaku.L_pp))
    rng = np.random.default_rng(0)
    drawn = [[one.J for one in evaluate(suzaku, list(noisy(sailed, rng).trials.values()))] for _ in range(200)]
    np.testing.assert_allclose(np.mean(drawn, axis=0), expected, rtol=0.25)
    assert [one.J for one in evaluate(suzaku, trials)] == pytest.approx([0.0] * len(trials), abs=1e-9)


def test_a_fit_says_that_it_bent_to_the_noise_of_first_samples(suzaku, sailed):
    bent = noisy(sailed, np.random.default_rng(1))
    result = fit(suzaku.profile, bent, QUICK)
    (said,) = [one.words for one in result.warned() if one.code == "initial"]
    assert "initial=estimated" in said
    freed = fit(suzaku.profile, bent, replace(QUICK, initial="estimated"))
    assert not [one for one in freed.warned() if one.code == "initial"]
    assert freed.J_of_noise == freed.to_dict()["J_of_noise"] == {}


def test_a_fault_far_beyond_noise_is_not_put_down_to_it(suzaku, sailed):
    other = with_values(suzaku.profile, {"hull.N_r": 1.3 * suzaku.profile.value("hull.N_r")}, "made up")
    (scored,) = validate(other, sailed).profiles
    assert not [note for note in scored.notes if "first samples" in note]
    (noted,) = validate(suzaku, noisy(sailed, np.random.default_rng(2))).profiles
    assert any("first samples" in note for note in noted.notes)


def test_a_run_that_diverges_says_nothing_of_noise():
    assert in_words(10.0, float("nan"), "here") == in_words(10.0, 4.0, "here") == ""
    assert "J = 6 here" in in_words(10.0, 6.0, "here")


def test_first_states_are_found_where_they_were(suzaku, sailed):
    trials = list(noisy(sailed, np.random.default_rng(3)).trials.values())
    objective = make_objective(suzaku.L_pp)
    found = estimated(as_predictor(suzaku), trials, objective)
    before = sum(one.J for one in evaluate(suzaku, trials))
    assert sum(one.J for one in evaluate(suzaku, trials, offsets=found)) < 0.01 * before
    true = np.array([one.motion[0] for one in sailed.trials.values()])
    begun = np.array([trial.motion[0] for trial in trials]) + found
    off = (begun - true) / list(SIGMA.values())
    assert np.abs(off[:, :2]).max() < 0.15  # of its deviation
    assert np.abs(off[:, 2]).max() < 0.5  # sway and yaw rate, which fade, take up some of it


def test_they_are_those_of_a_fit(suzaku, sailed):
    bent = noisy(sailed, np.random.default_rng(4))
    problem = make_problem(suzaku.profile, bent, replace(QUICK, initial="estimated"))
    own = fit_offsets(problem, problem.box.to_unit(problem.box.pre))
    trials = [bent.trials[name] for name in bent.tune]
    found = estimated(as_predictor(suzaku), trials, make_objective(suzaku.L_pp))
    np.testing.assert_allclose(found / problem.sigma, own / problem.sigma, atol=0.02)


def test_validate_takes_out_what_their_noise_brings(suzaku, sailed):
    bent = noisy(sailed, np.random.default_rng(5))
    (measured,) = validate(suzaku, bent).profiles
    result = validate(suzaku, bent, ValidateOptions(initial="estimated"))
    (freed,) = result.profiles
    assert sum(one.J for one in freed.scores) < 0.01 * sum(one.J for one in measured.scores)
    assert not [note for note in freed.notes if "first samples" in note]
    assert measured.offsets is None
    assert np.all(np.abs(freed.offsets) <= LARGEST * np.array(list(SIGMA.values())) + 1e-12)
    assert result.to_dict()["initial"] == "estimated"


class Two:
    """A physics model and one that turns less, as the members of one predictor; runs of one are lost on demand."""

    name, L_pp, n_members, inputs, method = "two", 83.0, 2, ("n", "delta"), "rk4"

    def __init__(self, one, other, lost=None):
        self.several, self.lost = [as_predictor(one), as_predictor(other)], lost

    def predict(self, cases):
        made = [one.predict(cases) for one in self.several]
        diverged = np.concatenate([one.diverged for one in made], axis=1)
        if self.lost is not None:
            diverged[cases.n_samples == self.lost, 1] = True
        return Prediction(np.concatenate([one.states for one in made], axis=1), diverged)


def test_members_share_them_and_a_run_that_is_lost_keeps_its_own(suzaku, sailed):
    other = with_values(suzaku.profile, {"hull.N_r": 1.1 * suzaku.profile.value("hull.N_r")}, "made up")
    trials = list(noisy(sailed, np.random.default_rng(6)).trials.values())
    objective = make_objective(suzaku.L_pp)

    def total(offsets):
        return sum(one.J for one in evaluate(Two(suzaku, other), trials, offsets=offsets))

    both = estimated(Two(suzaku, other), trials, objective)
    assert total(both) < min(total(None), total(estimated(as_predictor(suzaku), trials, objective)))
    lost = [k for k, one in enumerate(trials) if one.n_samples == trials[0].n_samples]
    found = estimated(Two(suzaku, other, lost=trials[0].n_samples), trials, objective)
    assert not found[lost].any()


def test_the_command_says_how_runs_begin_and_draws_them_so(tmp_path):
    done = run("validate", "suzaku", "suzaku", "--initial", "estimated", "--out", "scores", cwd=tmp_path)
    assert "rk4, first states estimated" in done.out
    page = (tmp_path / "scores" / "report.html").read_text(encoding="utf-8")
    assert "from a state within the noise of the first measured one" in page
    run("validate", "suzaku", "suzaku", "--initial", "estimated", "--restart", "60", "--out", "windows", cwd=tmp_path)
    assert "Over 60 s from an estimated state" in (tmp_path / "windows" / "report.html").read_text(encoding="utf-8")
    drawn = pd.read_parquet(tmp_path / "scores" / "motions.parquet").groupby(["trial", "which"]).first()
    off = drawn.xs("suzaku", level="which")[["x", "y"]] - drawn.xs("measured", level="which")[["x", "y"]]
    assert (off.abs() > 1e-3).all(axis=None)


def test_indices_that_are_stated_alone_have_no_first_state():
    delivery = IndexTrial("delivery", "suzaku", "turning", 0.6, None, None, {"advance": Stated(240.0, 12.0)})
    measured, freed = (validate("suzaku", [delivery], ValidateOptions(initial=one)) for one in INITIAL)
    assert freed.profiles[0].offsets is None
    assert freed.profiles[0].stated == measured.profiles[0].stated


def test_a_trial_without_a_sample_to_compare_is_told(suzaku, sailed):
    (trial, *_) = sailed.trials.values()
    gaps = {name: np.where(np.arange(trial.n_samples) > 0, np.nan, getattr(trial, name)) for name in ("x", "y", "psi")}
    with pytest.raises(OptionError, match="has no sample to compare with"):
        estimated(as_predictor(suzaku), [replace(trial, **gaps)], make_objective(suzaku.L_pp))


def test_first_states_of_voyages_are_not_estimated(tmp_path):
    with pytest.raises(OptionError, match="first states of voyages are not estimated"):
        validate_voyages("suzaku", tmp_path, VoyageOptions(initial="estimated"))
