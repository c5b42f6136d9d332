"""What noise of first samples alone brings to J, held against draws of it."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.evaluation import evaluate
from mmgtune.first_states import J_of_noise, in_words
from mmgtune.fitting import fit
from mmgtune.objective import make_objective
from mmgtune.options import FitOptions
from mmgtune.predictor import as_predictor
from mmgtune.profile import with_values
from mmgtune.trial.schema import ATTRIBUTES
from mmgtune.validating import validate
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
    estimated = fit(suzaku.profile, bent, replace(QUICK, initial="estimated"))
    assert not [one for one in estimated.warned() if one.code == "initial"]
    assert estimated.J_of_noise == estimated.to_dict()["J_of_noise"] == {}


def test_a_fault_far_beyond_noise_is_not_put_down_to_it(suzaku, sailed):
    other = with_values(suzaku.profile, {"hull.N_r": 1.3 * suzaku.profile.value("hull.N_r")}, "made up")
    (scored,) = validate(other, sailed).profiles
    assert not [note for note in scored.notes if "first samples" in note]
    (noted,) = validate(suzaku, noisy(sailed, np.random.default_rng(2))).profiles
    assert any("first samples" in note for note in noted.notes)


def test_a_run_that_diverges_says_nothing_of_noise():
    assert in_words(10.0, float("nan"), "here") == in_words(10.0, 4.0, "here") == ""
    assert "J = 6 here" in in_words(10.0, 6.0, "here")
