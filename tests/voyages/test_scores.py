"""Windows scored many at a time: the numbers of one evaluation, and the measures of each."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.evaluation import evaluate
from mmgtune.measures import Reference, cvdm_parts, distance_measures, distances, reference_of, references
from mmgtune.model import Model
from mmgtune.objective import spread
from mmgtune.predictor import PhysicsPredictor, Prediction
from mmgtune.profile import load_profile
from mmgtune.scores import L_MSE, score
from mmgtune.trial import windows
from mmgtune.units import DEG
from mmgtune.voyages.scores import cases_for, score_windows, windows_of
from mmgtune.voyages.spread import Spread
from mmgtune.voyages.table import Gathered
from mmgtune.voyages.turning import largest_yaw_rate, r_max_of
from tests.trial.made import made
from tests.voyages.conftest import with_nan

R_MAX = 0.0314


@pytest.fixture(scope="module")
def pieces(voyage):
    """Windows of different length, some with gaps."""
    spotted = with_nan(with_nan(voyage, "x", slice(130, 138)), "r", slice(700, 705))
    return [*windows(spotted, 120.0)[:20], *windows(spotted, 75.0)[:5], made(samples=40)]


def test_as_one_by_one(suzaku, pieces):
    """J, squares, counts and all seven measures are those of a record for each window."""
    together = windows_of(pieces)
    scores, states = score_windows(
        predictor := PhysicsPredictor(suzaku, suzaku.matrix()), together, cases_for(together, suzaku.inputs, None)
    )
    length, speed = references(together.motion)
    parts = cvdm_parts(scores.mean, length, speed, R_MAX)
    for k, record in enumerate(evaluate(predictor, pieces)):
        n = record.trial.n_samples
        np.testing.assert_array_equal(states[k, :n], record.states)
        assert scores.J[k] == pytest.approx(record.J, rel=1e-12)
        np.testing.assert_allclose(scores.squares[k], list(record.squares.values()), rtol=1e-12)
        np.testing.assert_array_equal(together.counts[k], list(record.counts.values()))
        reference = reference_of(record.measured.motion, R_MAX)
        single = distance_measures(record.measured.motion, record.states, reference)
        for name, values in scores.measures.items():
            assert values[k] == pytest.approx(single[name], rel=1e-12)
        assert sum(values[k] for values in parts.values()) == pytest.approx(single["cVDM"], rel=1e-12)


def test_features_of_a_window(pieces):
    found = windows_of(pieces).features()
    for k, one in enumerate(pieces):
        assert found["rudder"][k] == pytest.approx(np.abs(one.delta).mean())
        assert found["rudder_range"][k] == pytest.approx(np.ptp(one.delta))
        assert found["rudder_rate"][k] == pytest.approx(np.abs(np.diff(one.delta) / np.diff(one.t)).max())
        assert found["yaw_rate"][k] == pytest.approx(np.nanmean(np.abs(one.r)))
        reference = reference_of(one.motion)
        assert (found["path"][k], found["speed"][k]) == pytest.approx((reference.length, reference.speed))
    assert np.isnan(found["sea"]).all()
    assert np.isnan(found["depth"]).all()  # one of them knows none


def test_features_of_surroundings(voyage):
    pieces = windows(voyage, 120.0)[:3]
    found = windows_of(pieces).features()
    assert found["depth"][0] == pytest.approx(pieces[0].extra["depth"].mean())
    assert found["wind"][2] == pytest.approx(pieces[2].extra["wind_speed"].mean())
    felt = [
        replace(one, extra={"wind_speed_app": np.full(one.n_samples, 5.0), "wind_dir_app": np.zeros(one.n_samples)})
        for one in pieces
    ]
    apparent = windows_of(felt).features()["wind"]
    assert apparent[0] == pytest.approx(5.0 - pieces[0].u.mean(), abs=0.1)


class Lost:
    """A predictor with two members, of which one is lost in every second window."""

    name, L_pp, n_members, inputs, method = "lost", 83.0, 2, ("n", "delta"), "none"

    def predict(self, cases):
        states = np.repeat(cases.initial[:, None, None], cases.t.shape[1], axis=2).repeat(2, axis=1)
        diverged = np.zeros(states.shape[:2], dtype=bool)
        diverged[::2, 1] = True
        return Prediction(states, diverged)


def test_members_and_what_diverged(pieces):
    together = windows_of(pieces)
    scores, _ = score_windows(Lost(), together, cases_for(together, ("n", "delta"), None))
    assert scores.diverged.tolist() == [k % 2 == 0 for k in range(len(pieces))]
    assert np.isinf(scores.J[::2]).all()
    assert np.isinf(scores.measures["MED"][::2]).all()
    assert np.isfinite(scores.J[1::2]).all()


def test_tables_have_the_standardised_error_of_a_validation(suzaku, pieces):
    sigma = spread(pieces)
    gathered = Gathered()
    for some in (pieces[:7], pieces[7:]):
        together = windows_of(some)
        gathered.ids += [one.id for one in some]
        gathered.about += [(0, 0, one.n_samples, 0.0, one.duration) for one in some]
        gathered.features.append(together.features())
        gathered.counts.append(together.counts)
        scores, _ = score_windows(
            PhysicsPredictor(suzaku, suzaku.matrix()), together, cases_for(together, suzaku.inputs, None)
        )
        gathered.scores.setdefault("suzaku", []).append(scores)
    table = gathered.table(R_MAX)
    single = score(suzaku, pieces, sigma)
    assert table.L_MSE("suzaku", sigma) == pytest.approx(L_MSE(single), rel=1e-12)
    np.testing.assert_allclose(table.L_MSE_each("suzaku", sigma), [one.L_MSE for one in single], rtol=1e-12)


def test_spread_of_windows(pieces):
    whole = [one for one in pieces if one.n_samples == 121]
    gathered = Spread()
    for some in (whole[:4], whole[4:]):
        gathered.add(windows_of(some).motion)
    started = [replace(one, x=one.x - one.x[0], y=one.y - one.y[0]) for one in whole]
    assert gathered.sigma() == pytest.approx(spread(started), rel=1e-10)


def test_the_largest_yaw_rate_is_the_ships(suzaku):
    """SUZAKU's own turn at 45 deg: 1.3 deg/s with her pre-determined coefficients; the paper has 1.8 for the ship."""
    found = largest_yaw_rate(PhysicsPredictor(suzaku, suzaku.matrix()))
    assert found == pytest.approx(1.32 * DEG, rel=0.02)
    slow = largest_yaw_rate(PhysicsPredictor(kvlcc2 := Model(load_profile("kvlcc2")), kvlcc2.matrix()))
    assert slow is not None
    assert slow < 0.6 * found
    assert largest_yaw_rate(Lost()) is None


def test_where_r_max_comes_from(suzaku):
    largest = np.linspace(0.0, 0.02, 1001)
    ship = PhysicsPredictor(suzaku, suzaku.matrix())
    assert r_max_of(0.05, [("a", ship)], largest) == (0.05, "as given")
    assert r_max_of(None, [("a", Lost()), ("b", ship)], largest)[1].startswith("largest of b in its own turn")
    found, words = r_max_of(None, [("a", Lost())], largest)
    assert found == pytest.approx(0.01998)
    assert "quantile" in words
    assert np.isnan(r_max_of(None, [("a", Lost())], np.zeros(3))[0])


def test_samples_behind_the_end_do_not_count():
    rng = np.random.default_rng(1)
    measured = rng.normal(size=(3, 10, 6))
    simulated = measured + rng.normal(size=(3, 10, 6))
    measured[1, 6:] = np.nan
    measured[2] = np.nan
    found = distances(measured, simulated)
    short = distance_measures(measured[1, :6], simulated[1, :6], Reference(1.0, 1.0, 1.0))
    assert found.measures["MSD"][1] == pytest.approx(short["MSD"])
    assert np.isnan(found.measures["MED"][2])
    length, speed = references(measured)
    assert length[1] == pytest.approx(reference_of(measured[1]).length)
    assert np.isnan(speed[2])
