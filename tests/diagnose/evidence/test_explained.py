"""Shares of residuals: all of it for the cause, nothing for noise."""

import numpy as np
import pytest

from mmgtune.diagnose.evidence import explain_forces, noise_share, residual_forces, share_explained


@pytest.mark.long
def test_wrong_yaw_damping_is_explained_by_yaw_rate(damped, plain):
    found = [residual_forces(damped, trial) for trial in plain]
    shares = explain_forces(found)
    moment = shares["dN'"]
    assert max(moment, key=moment.__getitem__) == "yaw_rate"
    assert moment["yaw_rate"] > 0.85  # all but the noise
    assert noise_share(found)["dN'"] < 0.1
    assert all(abs(share) < 0.1 for name in ("dX", "dY") for share in shares[name].values())


def test_a_force_of_the_earth_frame_is_explained_by_heading(suzaku, blown):
    found = [residual_forces(suzaku, trial) for trial in blown]
    shares = explain_forces(found)
    noise = noise_share(found)
    for name in ("dX", "dY"):
        assert max(shares[name], key=shares[name].__getitem__) == "heading"
        # All but the noise; a few blocks have headings that no other has.
        assert shares[name]["heading"] > 0.8 * (1.0 - noise[name])
        assert sorted(shares[name].values())[-2] < 0.5
    assert all(share < 0.1 for share in shares["dN"].values())


def test_noise_is_not_explained(suzaku, plain):
    found = [residual_forces(suzaku, trial) for trial in plain]
    for shares in explain_forces(found).values():
        assert all(abs(share) < 0.1 for share in shares.values())
    assert all(0.6 < share < 1.4 for share in noise_share(found).values())


@pytest.mark.parametrize("seed", range(5))
def test_neither_white_nor_correlated_noise_is_explained(seed):
    random = np.random.default_rng(seed)
    white = random.standard_normal(2000)
    correlated = np.convolve(random.standard_normal(2019), np.ones(20) / 20.0, mode="valid")
    t = np.arange(2000.0)
    variables = {"time": t, "heading": 0.02 * t, "rudder": np.sign(np.sin(0.03 * t)), "rate": np.sin(0.011 * t)}
    for values in (white, correlated):
        assert all(-0.25 < share < 0.1 for share in share_explained(values, variables).values())
    assert all(abs(share) < 0.1 for share in share_explained(white, variables).values())


def test_a_function_of_a_variable_is_explained_by_it_alone():
    random = np.random.default_rng(1)
    a, b, heading = random.uniform(-1.0, 1.0, (3, 1000))
    turn = 20.0 * heading
    variables = {"a": a, "b": b, "heading": turn}
    assert share_explained(np.abs(a), variables)["a"] > 0.95
    assert share_explained(a + b, variables) == pytest.approx({"a": 0.5, "b": 0.5, "heading": 0.0}, abs=0.06)
    # A straight line between five points round the turn follows a cosine to a tenth.
    assert share_explained(np.cos(turn - 0.7), variables)["heading"] > 0.97
    shares = share_explained(np.cos(turn - 0.7), variables, periodic=())
    assert shares["heading"] < 0.3  # the same as a line from end to end is not


def test_what_is_unknown_is_a_level_of_its_own():
    random = np.random.default_rng(2)
    y = np.where(np.arange(1000) % 100 < 30, 1.0, 0.0) + 0.1 * random.standard_normal(1000)
    known = np.where(np.arange(1000) % 100 < 30, np.nan, random.uniform(size=1000))
    nothing = np.full(1000, np.nan)
    y[::7] = np.nan
    shares = share_explained(y, {"known": known, "nothing": nothing})
    assert shares["known"] > 0.9
    assert abs(shares["nothing"]) < 0.01


def test_weights_let_the_precise_samples_decide():
    random = np.random.default_rng(3)
    a = random.uniform(-1.0, 1.0, 1000)
    deviation = np.where(np.arange(1000) % 10 < 5, 0.1, 10.0)
    y = a + deviation * random.standard_normal(1000)
    assert share_explained(y, {"a": a}, weights=1.0 / deviation**2)["a"] > share_explained(y, {"a": a})["a"] + 0.1


def test_a_residual_without_variance_has_nothing_to_explain():
    assert share_explained(np.ones(100), {"a": np.arange(100.0)}) == {"a": 0.0}


def test_what_cannot_be_asked():
    y = np.ones(100)
    with pytest.raises(ValueError, match="a has shape"):
        share_explained(y, {"a": np.ones(99)})
    with pytest.raises(ValueError, match="fewer than 3 blocks"):
        share_explained(y, {"a": y}, blocks=np.arange(100) > 50)
    with pytest.raises(ValueError, match="fewer than 3 blocks"):
        share_explained(np.full(100, np.nan), {"a": y})
    with pytest.raises(ValueError, match="not all positive"):
        share_explained(y, {"a": y}, weights=0.0 * y)
    with pytest.raises(ValueError, match="no trials"):
        explain_forces([])
