"""Ensembles as predictors, as particles, and as files."""

from __future__ import annotations

import json
from itertools import islice, pairwise

import numpy as np
import pytest

from mmgtune.backends import pad
from mmgtune.errors import NetworkError, OptionError, TrialError
from mmgtune.networks import EnsemblePredictor, load_network, named_ship, save_network
from mmgtune.predictor import Paired, Predictor, Steerable, Uncertain
from mmgtune.scores import score
from mmgtune.trial import load_trials

from .made import ensemble
from .test_predicting import a_case, predict

ONE = EnsemblePredictor(ensemble())
CLOSE = {"rtol": 1e-5, "atol": 1e-5}
"""Single precision, over forty steps."""


def cases():
    return a_case(step=1.0), a_case(21, 1.0, seed=6)


def test_it_is_a_predictor_that_knows_and_can_be_steered():
    for kind in (Predictor, Steerable, Paired, Uncertain):
        assert isinstance(ONE, kind)
    for sampling in ("TS-infinity", "TS1"):
        for kind in (Predictor, Steerable, Paired):
            assert isinstance(ONE.drawn(5, 1, sampling), kind)
    assert (ONE.name, ONE.method) == ("toy ensemble", "ensemble, euler at 1 s")


def test_it_moves_by_the_equations_in_double_precision():
    """Euler's method written once more, without single precision."""
    from mmgtune.networks.feedforward import dense, evaluated, member
    from mmgtune.networks.motion import observed

    t, controls, state, around = a_case(step=1.0)
    found = predict(ONE, (t, controls, state, around)).states[0]
    for k in range(3):
        now = np.array(state)
        w, s = dense(member(ONE.ensemble.motion.layers, k)), member(ONE.ensemble.motion.standards, k)
        for control, wind in zip(controls[:-1], around[:-1, :2], strict=True):
            psi, u, v, r = now[2:]
            rates = evaluated(observed(now[None], control[None], wind[None]), w, s)[0]
            c, d = np.cos(psi), np.sin(psi)
            now = now + np.array([u * c - v * d, u * d + v * c, r, *rates])
        np.testing.assert_allclose(found[k, -1], now, rtol=1e-4, atol=1e-4)


def test_each_member_predicts_as_if_alone():
    together = predict(ONE, *cases())
    for k in range(3):
        alone = predict(EnsemblePredictor(ONE.ensemble.only([k])), *cases())
        np.testing.assert_allclose(together.states[:, k], alone.states[:, 0], **CLOSE)


def test_particles_of_ts_infinity_keep_to_one_member_each():
    members = predict(ONE, *cases()).states
    drawn = ONE.drawn(7, 4)
    which = next(drawn.members())
    found = predict(drawn, *cases()).states
    np.testing.assert_array_equal(found, members[:, which])
    assert sorted(np.bincount(which, minlength=3).tolist()) == [2, 2, 3]  # dealt out evenly
    assert set(next(ONE.drawn(3, 9).members()).tolist()) == {0, 1, 2}


def test_particles_of_ts1_change_members_and_differ_from_all():
    members = predict(ONE, *cases()).states
    found = predict(ONE.drawn(6, 4, "TS1"), *cases()).states
    assert all(np.abs(found[0, p, -1] - members[0, k, -1]).max() > 1e-3 for p in range(6) for k in range(3))
    draws = np.array(list(islice(ONE.drawn(6, 4, "TS1").members(), 40)))
    assert (np.diff(draws, axis=0) != 0).any(axis=0).all()
    assert all(np.bincount(row, minlength=3).tolist() == [2, 2, 2] for row in draws)


def test_ts1_of_one_member_is_that_member():
    alone = EnsemblePredictor(ONE.ensemble.only([1]))
    a, b = (predict(alone.drawn(3, 1, sampling), *cases()).states for sampling in ("TS-infinity", "TS1"))
    np.testing.assert_allclose(a, b, **CLOSE)


def test_ts1_gives_each_step_to_the_member_drawn_for_it():
    """A path of TS1 put together from steps of single members."""
    t, controls, state, _ = a_case(9, 1.0, wind=False)
    drawn = ONE.drawn(2, 8, "TS1")
    found = predict(drawn, (t, controls, state, np.zeros((9, len(a_case()[3][0]))))).states[0, 1]
    now = state
    for which, before, after in zip(drawn.members(), controls[:-1], controls[1:], strict=False):
        now = ONE.stepper(int(which[1]), now, before).step(before, after, 1.0)
    np.testing.assert_allclose(found[-1], now, **CLOSE)


@pytest.mark.parametrize("sampling", ["TS-infinity", "TS1"])
def test_the_same_seed_draws_the_same_particles_and_another_others(sampling):
    a, b, other = (predict(ONE.drawn(5, seed, sampling), *cases()).states for seed in (1, 1, 2))
    np.testing.assert_array_equal(a, b)
    assert np.abs(a - other).max() > 1e-3


@pytest.mark.parametrize("sampling", ["TS-infinity", "TS1"])
def test_cases_beside_it_change_nothing(sampling):
    both = predict(ONE.drawn(5, 1, sampling), *cases())
    alone = predict(ONE.drawn(5, 1, sampling), cases()[1])
    np.testing.assert_allclose(both.states[1, :, :21], alone.states[0], **CLOSE)


@pytest.mark.parametrize("predictor", [ONE, ONE.drawn(4, 3), ONE.drawn(4, 3, "TS1")])
def test_steered_and_paired_it_goes_as_predicted(predictor):
    t, controls, state, around = a_case(12, 1.0, wind=False)
    around = np.zeros_like(around)
    expected = predict(predictor, (t, controls, state, around)).states[0]
    run = predictor.stepper(2, state, controls[0])
    for now, then in pairwise(controls):
        found = run.step(now, then, 1.0)
    np.testing.assert_allclose(found, expected[2, -1], **CLOSE)
    members = np.array([2, 0, 2])
    pairs = predictor.paired(pad([t] * 3, [controls] * 3, [state] * 3, around=[around] * 3), members)
    np.testing.assert_allclose(pairs, expected[members], **CLOSE)


def test_what_makes_no_sense_is_said():
    with pytest.raises(OptionError, match="unknown sampling 'TS2'") as error:
        ONE.drawn(5, 1, "TS2")
    assert "TS1" in error.value.problems[0].fix
    with pytest.raises(OptionError, match="0 particles"):
        ONE.drawn(0, 1)


@pytest.mark.parametrize("initial", [0, 4])
def test_round_trip(tmp_path, initial):
    one = ensemble(initial=initial)
    path = save_network(one, tmp_path / "model.safetensors")
    again = load_network(path)
    assert (again.ship, again.L_pp, again.inputs, again.step, again.facts) == (
        "toy",
        3.0,
        ("n", "delta"),
        1.0,
        one.facts,
    )
    assert again.initial == initial
    for a, b in zip(
        (*one.motion.layers, *one.motion.standards), (*again.motion.layers, *again.motion.standards), strict=True
    ):
        np.testing.assert_array_equal(np.float32(a), b)
    found = named_ship(str(path))
    np.testing.assert_allclose(
        predict(found, *cases()).states, predict(EnsemblePredictor(one), *cases()).states, **CLOSE
    )


def altered(tmp_path, change):
    """A file in whose header and arrays something is changed."""
    from safetensors.numpy import load_file, safe_open, save_file

    path = save_network(ensemble(), tmp_path / "whole.safetensors", overwrite=True)
    with safe_open(path, framework="numpy") as file:
        metadata = dict(file.metadata())
    arrays, header = load_file(path), json.loads(metadata["network"])
    change(arrays, header)
    save_file(arrays, tmp_path / "changed.safetensors", metadata={**metadata, "network": json.dumps(header)})
    return tmp_path / "changed.safetensors"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda a, h: a.pop("motion.W_hidden"), "lacks motion.W_hidden"),
        (lambda a, h: a.pop("start_standards.raw_mean"), "lacks start_standards.raw_mean"),
        (lambda a, h: a.update({"motion.W_hidden": np.zeros((3, 2, 5, 5), np.float32)}), "W_hidden has the shape"),
        (lambda a, h: a.update({"motion.W_in": np.zeros((7, 6), np.float32)}), "W_in has the shape"),
        (lambda a, h: a.update({"motion.b_out": np.full((3, 1, 3), np.inf, np.float32)}), "not finite"),
        (lambda a, h: a.update({"motion.b_out": np.zeros((3, 1, 3), np.int64)}), "no numbers"),
        (lambda a, h: a.update({"motion_standards.in_deviation": np.zeros((3, 1, 7), np.float32)}), "not above 0"),
        (lambda a, h: a.update({"start.W_in": np.zeros((3, 11, 6), np.float32)}), "sees 11 numbers"),
        (lambda a, h: a.update({"start.W_in": np.zeros((2, 12, 6), np.float32)}), "W_in has the shape"),
        (lambda a, h: h.update(initial=7), "sees 4 observations, not 7"),
        (lambda a, h: h.update(initial="4"), "initial of the network"),
        (lambda a, h: h.pop("initial"), "initial of the network"),
        (lambda a, h: h.update(inputs=["n"]), "W_in has the shape"),
        (lambda a, h: h.update(inputs=["n", "sails"]), "no input is called sails"),
        (lambda a, h: h.update(step=-1.0), "the step is -1"),
        (lambda a, h: h.update(L_pp=0.0), "the length is 0"),
    ],
)
def test_what_does_not_fit_is_named(tmp_path, change, words):
    with pytest.raises(NetworkError, match=words):
        load_network(altered(tmp_path, change))


def test_files_cut_short_are_refused(tmp_path):
    whole = save_network(ensemble(), tmp_path / "model.safetensors").read_bytes()
    for length in (0, 4, 100, len(whole) // 2, len(whole) - 1):
        (tmp_path / "cut.safetensors").write_bytes(whole[:length])
        with pytest.raises(NetworkError, match="cannot be read"):
            load_network(tmp_path / "cut.safetensors")


def test_where_there_is_none_those_that_are_bundled_are_named(tmp_path):
    with pytest.raises(NetworkError, match="no such trained model") as error:
        load_network(tmp_path / "none.safetensors")
    assert "Errno" not in str(error.value)
    assert "esso_osaka_3m_mixture" in error.value.problems[0].fix
    (tmp_path / "folder.safetensors").mkdir()
    with pytest.raises(NetworkError, match=r"(?s)a folder is no trained model.*has written"):
        load_network(tmp_path / "folder.safetensors")
    (tmp_path / "folder.safetensors" / "older.safetensors").touch()
    with pytest.raises(NetworkError, match=r"(?s)give the file in it: .*older\.safetensors"):
        load_network(tmp_path / "folder.safetensors")


def test_trials_of_another_ship_lack_what_drives_this_one():
    from dataclasses import replace

    trial = next(iter(load_trials("suzaku").trials.values()))
    other = replace(ONE.ensemble, inputs=("n", "n_bow"))
    with pytest.raises(TrialError, match="n_bow"):
        score(EnsemblePredictor(other), [trial], dict.fromkeys(("x", "y", "psi", "u", "v_m", "r"), 1.0))
