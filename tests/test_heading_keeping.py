"""Gains of a heading controller in the true system and in simulators."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.cli.study import summary
from mmgtune.errors import OptionError
from mmgtune.heading_keeping import Judged, best, kept, overrated, study_heading_keeping, write_heading_study
from mmgtune.networks import EnsemblePredictor, NetworkPredictor
from mmgtune.options import HeadingOptions
from mmgtune.physics.actuation import actuated
from mmgtune.predictor import as_predictor, stepper_of
from mmgtune.profile import load_profile
from mmgtune.report import render
from mmgtune.resources import folder

from .networks.made import ensemble, network
from .networks.test_hybrid import HybridPredictor, a_hybrid

SHIP = load_profile("esso_osaka_3m")
FEW = HeadingOptions(speed=0.4, duration=20.0, gain_step=40.0, gain_most=80.0, step=0.5)
GAINS = np.array([40.0, 80.0])


def by_hand(predictor, member, P, D, h):
    """One ship, one pair of gains, step by step with the stepper."""
    gear = SHIP.actuator("delta")
    state, rudder, score = np.array([0.0, 0.0, 0.0, 0.4, 0.0, 0.0]), 0.0, 0.0
    before = np.array([SHIP.approach.n, 0.0])
    run = stepper_of(predictor, member, state, before)
    steps = round(20.0 / h)
    for k in range(steps + 1):
        score += (0.5 if k in (0, steps) else 1.0) * h * (abs(state[2] - np.pi / 2) + abs(state[5]))
        order = np.radians(-P * (state[2] - np.pi / 2) - D * state[5])
        rudder = actuated(rudder, np.clip(order, gear.low, gear.high), gear.rate, h, h)
        then = np.array([SHIP.approach.n, rudder])
        state = run.step(before if predictor.own_step is None else then, then, h)
        before = then
    return score


@pytest.mark.parametrize(
    "predictor",
    [
        as_predictor(SHIP),
        HybridPredictor(a_hybrid()),
        NetworkPredictor(network(members=2, step=0.5)),
        EnsemblePredictor(ensemble(step=0.5)),
        EnsemblePredictor(ensemble(step=0.5)).drawn(2, 1, "TS1"),
    ],
    ids=lambda one: one.name,
)
def test_scores_are_those_of_ships_steered_one_by_one(predictor):
    scores = kept(predictor, SHIP, GAINS, FEW)
    assert scores.shape == (predictor.n_members, 2, 2)
    if isinstance(predictor, HybridPredictor):  # its stepper begins anew at each step, and so forgets
        assert np.isfinite(scores).all()
        return
    for member in range(predictor.n_members):
        for i, j in ((0, 1), (1, 0)):
            expected = by_hand(predictor, member, GAINS[i], GAINS[j], 0.5)
            assert scores[member, i, j] == pytest.approx(expected, rel=1e-4)


def test_the_ship_gets_to_her_heading():
    """The longer it takes, the less the score of a good pair of gains grows."""
    first, last = (
        kept(as_predictor(SHIP), SHIP, GAINS, replace(FEW, duration=seconds))[0, 1, 1] for seconds in (60.0, 120.0)
    )
    assert last - first < 0.1 * first


def test_the_truth_promises_what_it_delivers():
    result = study_heading_keeping("esso_osaka_3m", "esso_osaka_3m", FEW)  # one need not be a list
    np.testing.assert_array_equal(result.models[0].scores[0], result.truth)
    assert overrated(result.truth, result.truth) == 0.0
    assert overrated(0.9 * result.truth, result.truth) == 1.0


def test_the_worst_member_promises_least():
    result = study_heading_keeping([EnsemblePredictor(ensemble(members=4))], SHIP, FEW)
    (one,) = result.models
    assert (one.views["worst"] >= one.views["mean"]).all()
    shares = [overrated(scores, result.truth) for scores in one.scores]
    assert overrated(one.views["worst"], result.truth) <= min(shares)
    said = one.to_dict(result.truth)["overrated_by_single_members"]
    assert (said["least"], said["most"]) == (min(shares), max(shares))
    assert said["mean"] == pytest.approx(np.mean(shares))


def test_simulators_with_the_id_of_the_true_ship_go_by_the_name_they_were_given(tmp_path):
    copy = tmp_path / "tuned.toml"
    shutil.copy(folder("ship_profiles") / f"{SHIP.id}.toml", copy)
    result = study_heading_keeping([str(copy), "suzaku"], SHIP, replace(FEW, duration=2.0))
    assert [one.name for one in result.models] == [str(copy), "suzaku"]
    assert result.true_ship == SHIP.id
    said = summary(result.to_dict())
    assert str(copy) in said
    assert f"gains in {SHIP.id}" in said
    turned = study_heading_keeping([SHIP.id], copy, replace(FEW, duration=2.0))  # the truth is the tuned ship
    assert (turned.true_ship, [one.name for one in turned.models]) == (str(copy), [SHIP.id])
    (one,) = study_heading_keeping([as_predictor(SHIP)], SHIP, replace(FEW, duration=2.0)).models
    assert one.name == SHIP.id  # an object was given by no name


def test_runs_that_diverge_promise_nothing():
    truth = np.array([[1.0, 2.0]])
    one = Judged("wild", "", np.array([[[0.5, np.inf]], [[0.5, 0.5]]]))
    document = one.to_dict(truth)
    assert document["views"]["worst"] == {"scores": [[0.5, None]], "overrated": 0.5, "clearly_overrated": 0.5}
    assert best(np.array([[3.0, 1.0], [2.0, np.inf]]), GAINS) == (40.0, 80.0)


def test_what_cannot_be_studied_is_said():
    with pytest.raises(OptionError, match="driven by"):
        study_heading_keeping([EnsemblePredictor(replace(ensemble(), inputs=("n", "n_bow")))], SHIP, FEW)
    with pytest.raises(OptionError, match="no approach"):
        study_heading_keeping([SHIP], replace(SHIP, approach=None), FEW)
    with pytest.raises(OptionError, match="does not say how delta moves"):
        study_heading_keeping([SHIP], replace(SHIP, steering_gear=None, actuators={}), FEW)
    for given in ({"gain_step": 0.0}, {"gain_step": np.nan}, {"gain_most": np.nan}, {"gain_most": np.inf}):
        (name,) = given
        with pytest.raises(OptionError, match=f"^{name} is ") as error:
            HeadingOptions(**given)
        assert [one.where for one in error.value.problems] == [name]
    with pytest.raises(OptionError, match="inf gains"):
        HeadingOptions(gain_step=1e-320)
    with pytest.raises(OptionError, match="0 gains"):
        HeadingOptions(gain_step=10.0, gain_most=5.0)
    with pytest.raises(OptionError, match="step is 1e-09"):
        HeadingOptions(step=1e-9)


def test_what_is_left_behind(tmp_path):
    result = study_heading_keeping([EnsemblePredictor(ensemble()), SHIP], SHIP, FEW)
    document = write_heading_study(result, tmp_path, "mmgtune study heading-keeping")
    assert document == json.loads((tmp_path / "heading_keeping.json").read_text())
    text = next(path for path in render(tmp_path) if path.suffix == ".html").read_text()
    assert "Heading keeping" in text
    p, d = best(result.truth, GAINS)
    assert f"Its best is {result.truth.min():.3g} rad s, at K_P {p:g}, K_D {d:g}." in text
    assert "--gain-step 20" in re.sub("</?span>", "", text)
    assert "worst member" in text
    said = summary(document)
    assert "2 x 2 gains in esso_osaka_3m" in said
    assert "worst member" in said
