"""Networks of which it is known what they add, made without training, are read; nothing is found where nothing is."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from mmgtune.backends import LaneModel, pad
from mmgtune.learning.following import accelerations_by, added_by, follow, own_force, thinned
from mmgtune.learning.hybrid import ranges_of
from mmgtune.learning.reading import mass_matrix, read_network
from mmgtune.learning.samples import samples_of
from mmgtune.learning.selecting import select
from mmgtune.model import Model
from mmgtune.motions import breakdown
from mmgtune.networks.hybrid import Hybrid, HybridPredictor
from mmgtune.networks.residual import SIDES, ResidualWeights, _layers
from mmgtune.physics.quantities import UNKNOWN
from mmgtune.physics.rigid_body import accelerations
from mmgtune.predictor import as_predictor
from mmgtune.profile import load_profile, tuned, with_effects
from mmgtune.trial import load_trials, windows

MEMORY, STEP, WIDTH = 13.0, 1.0, 64
PIECE = -0.02


@pytest.fixture(scope="module")
def trials():
    data = load_trials("suzaku")
    return [data.trials[id] for id in ("turn_p10", "turn_m20", "turn_p35", "turn_m40", "zigzag_10", "zigzag_20")]


def imitating(profile, added, trials, seed=1):
    """A hybrid whose network adds about ``added(states, controls)`` (n, 3): random layers, the last least squares."""
    model = Model(profile)
    samples = samples_of(trials, model.inputs, STEP, model.draught)
    ranges = ranges_of(samples, MEMORY, [one.role for one in model.arrangement.inputs])
    n = len(ranges.deviation)
    rng = np.random.default_rng(seed)
    sees = (np.arange(n) < 3 + samples.controls.shape[1])[:, None]  # neither wind nor memory
    weights = ResidualWeights(
        0.5 * sees * rng.standard_normal((n, WIDTH)),
        rng.standard_normal(WIDTH),
        rng.standard_normal((WIDTH, WIDTH)) / np.sqrt(WIDTH),
        rng.standard_normal(WIDTH),
        np.eye(WIDTH)[:, :3],
    )
    states, controls = samples.states, samples.controls
    apparent = states[:, 3:5]  # in still air
    x = np.concatenate([states[:, 3:], controls, apparent, np.zeros((len(states), 3))], axis=1) / ranges.deviation
    hidden = [_layers(one, weights._replace(W_3=np.eye(WIDTH))) for one in (x, x * ranges.mirrored)]
    wanted = added(states, controls) / ranges.accelerations
    last = [
        np.linalg.lstsq(0.5 * (hidden[0] + side * hidden[1]), wanted[:, k], rcond=1e-4)[0]
        for k, side in enumerate(SIDES)
    ]
    return Hybrid(profile, weights._replace(W_3=np.array(last).T), ranges, MEMORY)


def between(one, other):
    """Accelerations that a profile gives beyond those of another."""

    def added(states, controls):
        both = []
        for model in map(Model, (one, other)):
            ship = LaneModel(model, model.matrix()[:, 0])
            both.append(np.array(ship.rates(states.T, model.arrangement.control(*controls.T), UNKNOWN, 1.0))[3:6].T)
        return both[1] - both[0]

    return added


@pytest.fixture(scope="module")
def lacking(trials):
    profile = load_profile("suzaku")
    whole = with_effects(profile, {"hull-term": {"N_rabsr": PIECE}}, "test")
    return imitating(profile, between(profile, whole), trials)


@pytest.fixture(scope="module")
def reading(lacking, trials):
    return read_network(lacking, trials)


def test_the_piece_is_named_first_with_its_value(reading):
    first = reading.terms[0]
    assert first.name == "hull-term.N_rabsr"
    assert first.value == pytest.approx(PIECE, rel=0.1)
    assert first.shares["N"] > 0.9
    assert first.unit == "prime"
    assert re.fullmatch(r"\d+ % of it in yaw looks like a hull term N_r\|r\| = -0\.0\d+\.", reading.sentences[2])
    assert re.match(
        r"The network adds \S+ k?N in surge, \S+ k?N in sway and [\d.]+ k?N m in yaw ", reading.sentences[0]
    )


def test_sizes_are_those_of_the_force_itself(lacking, reading, trials):
    """N' of the term in N m, against what physics says of the term along the same runs."""
    followed = follow(lacking, trials, 100.0, 4000)
    p = lacking.profile
    u, v, r = followed.at(followed.s)[3:6]
    U = np.hypot(u, v)
    unit = 0.5 * p.value("particulars.rho") * p.L_pp**2 * p.value("particulars.d") * U**2
    known = PIECE * unit * (r * p.L_pp / U) * np.abs(r * p.L_pp / U)
    yaw = next(one for one in reading.shares if one.component == "N")
    assert yaw.size == pytest.approx(np.sqrt(np.mean(known**2)), rel=0.1)
    assert yaw.own == pytest.approx(np.sqrt(np.mean(own_force(followed)[:, 2] ** 2)))
    assert max(one.size for one in reading.shares if one.component != "N") < 0.05 * yaw.size


def test_the_way_is_that_of_the_predictor(lacking, trials):
    followed = follow(lacking, trials[:2], 100.0, 10**6)
    found = HybridPredictor(lacking).predict(followed.cases)
    for lane in range(len(followed.cases)):
        n = followed.cases.n_samples[lane]
        np.testing.assert_allclose(followed.s[:n, :6, lane], found.states[lane, 0, :n], rtol=1e-9, atol=1e-9)


def test_what_the_model_and_the_network_give_is_what_the_hybrid_marches_by(lacking, trials):
    """Differences of the velocities it shows, against the sum of both along the way."""
    followed = follow(lacking, windows(trials[2], 100.0)[:1], None, 10**6)
    model = followed.model
    both = accelerations_by(model, model.matrix()[:, 0], followed) + added_by(lacking, followed)
    moved = np.gradient(followed.s[:, 3:6, 0], followed.cases.t[0], axis=0)
    assert np.median(np.abs(both - moved)[5:-5] / np.abs(moved).max(axis=0)) < 0.005


def test_a_lag_follows_the_motion_from_the_beginning_of_the_window(trials):
    """The force of the effect memory against the hull's, passed through the exact first-order lag between samples."""
    profile = load_profile("suzaku")
    silent = imitating(profile, lambda states, controls: np.zeros((len(states), 3)), trials)
    followed = follow(silent, windows(trials[2], 100.0)[:1], None, 10**6)
    late = Model(with_effects(profile, {"memory": {"time_constant": 20.0}}, "test"))
    given, plain = (accelerations_by(one, one.matrix()[:, 0], followed) for one in (late, followed.model))
    lost = (given - plain) @ mass_matrix(late).T
    hull = breakdown(profile, followed.s[:, :6, 0], followed.control[:, :, 0]).hull
    t = followed.cases.t[0]
    for now, column in ((hull.Y, 1), (hull.N, 2)):
        behind = np.empty_like(now)
        behind[0] = now[0]
        for k in range(1, len(t)):
            behind[k] = now[k] + (behind[k - 1] - now[k]) * np.exp(-(t[k] - t[k - 1]) / 20.0)
        assert np.abs(lost[:, column]).max() > 0.2 * np.abs(now).max()
        np.testing.assert_allclose(lost[:, column], behind - now, atol=0.05 * np.abs(now).max())


@pytest.mark.long
def test_tuned_coefficients_count_before_any_term(trials):
    """What a coefficient that was tuned would give is no missing physics."""
    profile = load_profile("suzaku")
    name = "rudder.a_H"
    other = tuned(profile, {name: profile.value(name)}, {}, {})
    changed = tuned(profile, {name: 0.5 * profile.value(name)}, {}, {})
    found = read_network(imitating(other, between(profile, changed), trials), trials)
    assert found.tuned > 0.85
    assert name not in [term.name for term in found.terms]
    assert "could as well come from other values of the coefficients that were tuned" in " ".join(found.sentences)


def test_a_silent_network_says_nothing(trials, lacking):
    silent = Hybrid(lacking.profile, lacking.weights._replace(W_3=np.zeros((WIDTH, 3))), lacking.ranges, MEMORY)
    found = read_network(silent, trials[:3])
    assert found.sentences == ("The network adds no force.",)
    assert found.terms == ()


def test_classes_hold_more_of_the_force_than_of_the_time(reading):
    assert len(reading.classes) == 2
    assert all(0.03 <= one.time < one.force <= 1.0 for one in reading.classes)


def test_all_of_it_can_be_written(reading):
    document = json.loads(json.dumps(reading.to_dict(), allow_nan=False))
    assert document["terms"][0]["name"] == "hull-term.N_rabsr"
    assert document["runs"] == 6


def test_the_mass_matrix_is_that_of_the_equations():
    model = Model(load_profile("suzaku"))
    ship = model.coefficients(model.matrix()[:, 0]).ship
    rate = np.array([0.01, -0.02, 0.003])
    force = mass_matrix(model) @ rate
    moving = np.array(accelerations(2.0, 0.3, 0.02, *force, ship)) - accelerations(2.0, 0.3, 0.02, 0.0, 0.0, 0.0, ship)
    np.testing.assert_allclose(moving, rate, rtol=1e-10)


def test_selection_agrees_with_least_squares_part_by_part():
    rng = np.random.default_rng(3)
    n, runs = 300, np.repeat(np.arange(5), 60)
    columns = rng.standard_normal((n, 2, 4))
    y = 2.0 * columns[..., 1] - 0.5 * columns[..., 3] + 0.3 * rng.standard_normal((n, 2))
    found = select(
        y, columns, list("abcd"), given=[], one_way=np.zeros(4, dtype=bool), most=np.full(4, np.inf), run=runs
    )
    assert [one.column for one in found.chosen] == [1, 3]
    gone = np.zeros(2)
    for part in range(5):
        here = runs == part
        flat = columns[~here][..., 1].ravel()
        factor = flat @ y[~here].ravel() / (flat @ flat)
        gone += (y[here] ** 2).sum(axis=0) - ((y[here] - factor * columns[here][..., 1]) ** 2).sum(axis=0)
    first = found.chosen[0]
    assert first.share == pytest.approx(gone.sum() / (y**2).sum(), rel=1e-6)
    np.testing.assert_allclose(first.shares, gone / (y**2).sum(axis=0), rtol=1e-6)
    # The second is chosen with the first free, and counts by what the first leaves.
    both = np.linalg.lstsq(columns[..., [1, 3]].reshape(-1, 2), y.ravel(), rcond=None)[0]
    assert found.chosen[1].factor == pytest.approx(both[1], rel=1e-6)


def test_nothing_is_selected_from_noise_and_none_beyond_its_limits():
    rng = np.random.default_rng(4)
    columns = rng.standard_normal((300, 1, 30))
    runs = np.repeat(np.arange(6), 50)
    free = {"one_way": np.zeros(30, dtype=bool), "most": np.full(30, np.inf), "run": runs}
    names = [str(k) for k in range(30)]
    assert select(rng.standard_normal((300, 1)), columns, names, given=[], **free).chosen == ()
    y = -3.0 * columns[..., 7]
    assert select(y, columns, names, given=[], **free).chosen[0].factor == pytest.approx(-3.0)
    assert select(y, columns, names, given=[], **{**free, "one_way": np.ones(30, dtype=bool)}).chosen == ()
    assert select(y, columns, names, given=[], **{**free, "most": np.full(30, 2.0)}).chosen == ()
    assert select(y, columns, names, given=[7], **free).given == pytest.approx(1.0)


def test_instants_are_thinned_evenly():
    counts = np.ones((100, 7), dtype=bool)
    counts[50:, 3] = False
    few = thinned(counts, 50)
    assert 25 <= few.sum() <= 50
    assert not (few & ~counts).any()


# Outside the data: limits on what a network may do where it has seen nothing.


def sailed(hybrid, speed, n, rudder, seconds=600.0, step=2.0):
    """Way of the model of forces alone and of the hybrid, (T, 6) each."""
    approach = hybrid.profile.approach
    t = np.arange(0.0, seconds, step)
    controls = np.column_stack([np.full(len(t), n * approach.n), np.full(len(t), rudder)])
    cases = pad([t], [controls], [np.array([0.0, 0.0, 0.0, speed * approach.speed, 0.0, 0.0])])
    both = [one.predict(cases) for one in (as_predictor(hybrid.profile), HybridPredictor(hybrid))]
    assert not any(one.diverged.any() for one in both)
    return [one.states[0, 0] for one in both]


@pytest.mark.daily("1.0--1.0")
@pytest.mark.parametrize(
    ("speed", "n", "rudder"), [(1.0, 1.0, np.radians(35.0)), (1.0, -1.0, 0.0), (2.0, 2.0, np.radians(20.0))]
)
def test_outside_the_data_the_hybrid_stays_in_the_world_of_ships(lacking, speed, n, rudder):
    """A turn of 35 deg for ten minutes, a crash stop, twice the approach speed: no faster than the model of forces by
    a tenth of the approach speed, and no quicker turn by half of its own."""
    model, hybrid = sailed(lacking, speed, n, rudder)
    approach = lacking.profile.approach.speed
    fastest = [np.hypot(one[:, 3], one[:, 4]).max() for one in (model, hybrid)]
    turning = [np.abs(one[:, 5]).max() * lacking.profile.L_pp / approach for one in (model, hybrid)]
    assert fastest[1] <= fastest[0] + 0.1 * approach
    assert turning[1] <= 1.5 * turning[0] + 0.35


def test_at_twice_the_speed_it_is_the_model_of_forces(lacking):
    """The first ten ship lengths, before she has slowed down to speeds there was data of: within a hundredth of the
    way, whatever the network says."""
    loud = Hybrid(lacking.profile, lacking.weights._replace(W_3=20.0 * lacking.weights.W_3), lacking.ranges, MEMORY)
    model, hybrid = sailed(loud, 2.2, 2.2, np.radians(10.0), 60.0)
    way = np.hypot(*np.diff(model[:, :2], axis=0).T).sum()
    assert np.hypot(*(model - hybrid)[:, :2].T).max() < 0.01 * way
