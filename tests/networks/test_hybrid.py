"""A network beside a model of forces: its equations, its predictor, its file."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from mmgtune.backends import Integrator, pad
from mmgtune.errors import NetworkError, ProfileError
from mmgtune.model import Model
from mmgtune.networks import Hybrid, HybridPredictor, load_network, named_ship, save_network
from mmgtune.networks.residual import Ranges, ResidualWeights, accelerations, inside
from mmgtune.physics.quantities import Surroundings
from mmgtune.predictor import PhysicsPredictor
from mmgtune.profile import load_profile

N = 10  # u, v, r, n, delta, wind ahead and starboard, and three of the memory


def a_hybrid(ship="esso_osaka_3m", *, size=1.0, seed=1, width=4, memory=5.0):
    rng = np.random.default_rng(seed)
    weights = ResidualWeights(
        rng.standard_normal((N, width)),
        rng.standard_normal(width),
        rng.standard_normal((width, width)),
        rng.standard_normal(width),
        size * rng.standard_normal((width, 3)),
    )
    sides = [1.0, -1.0, -1.0]
    ranges = Ranges(
        np.array([0.2, 0.05, 0.03, 10.0, 0.4, 1.2, 1.4, 0.01, 0.006, 0.004]),
        np.full(N, 3.0),
        np.array([0.008, 0.004, 0.002]),
        np.array([*sides, 1.0, -1.0, 1.0, -1.0, *sides]),
    )
    return Hybrid(load_profile(ship), weights, ranges, memory, {"type": "hybrid"})


def cases(n=121, step=0.5, *, mirror=False, seed=2):
    rng = np.random.default_rng(seed)
    t = step * np.arange(n)
    side = -1.0 if mirror else 1.0
    controls = np.column_stack([8.0 + np.cumsum(0.3 * rng.standard_normal(n)), side * 0.4 * np.sin(0.2 * t)])
    around = np.zeros((n, len(Surroundings._fields)))
    around[:, 0], around[:, 1], around[:, 2] = 0.6, side * 0.9, 1.0
    initial = np.array([0.0, 0.0, side * 0.3, 0.4, side * 0.02, side * 0.01])
    return pad([t], [controls], [initial], around=[around])


def test_a_silent_network_is_the_model_of_forces_to_the_bit():
    hybrid = a_hybrid(size=0.0)
    model = Model(hybrid.profile)
    alone = PhysicsPredictor(model, model.matrix(), Integrator(), "numpy").predict(cases())
    np.testing.assert_array_equal(HybridPredictor(hybrid).predict(cases()).states, alone.states)


def test_the_network_matters():
    a, b = (HybridPredictor(a_hybrid(size=s)).predict(cases()).states[0, 0, -1] for s in (0.0, 1.0))
    assert np.abs(a - b).max() > 0.05


def test_at_rest_with_nothing_acting_it_adds_nothing():
    hybrid = a_hybrid()
    assert not accelerations(np.zeros((3, N)), hybrid.weights, hybrid.ranges).any()


def test_port_and_starboard_are_mirror_images():
    hybrid = a_hybrid()
    x = np.random.default_rng(3).standard_normal((5, N))
    there = accelerations(x, hybrid.weights, hybrid.ranges)
    mirrored = accelerations(x * hybrid.ranges.mirrored, hybrid.weights, hybrid.ranges)
    np.testing.assert_allclose(mirrored, there * [1.0, -1.0, -1.0], rtol=1e-13, atol=1e-18)


def test_outside_the_data_it_falls_silent():
    hybrid = a_hybrid()
    x = np.zeros((4, N))
    x[:, 0] = [2.9, 3.0, 6.0, 12.0]
    np.testing.assert_allclose(inside(x, hybrid.ranges), [1.0, 1.0, np.exp(-4.0), np.exp(-36.0)])
    assert np.abs(accelerations(x[3], hybrid.weights, hybrid.ranges)).max() < 1e-12


def test_what_it_remembers_is_a_lag_of_the_velocities():
    """By an integration of its own: the memory follows (v - m) / T along the simulated velocities."""
    from mmgtune.backends.logged import Logged
    from mmgtune.backends.numpy_lanes import LaneRun
    from mmgtune.physics.quantities import State

    hybrid = a_hybrid()
    predictor = HybridPredictor(hybrid)
    given = cases()
    ship = predictor.lanes(predictor.model, predictor.model.matrix())
    log = Logged(predictor.model, given, 1, ship.shift)
    run = LaneRun(ship, State(*given.initial.T), log.inputs(1, 0.0), log.around(1, 0.0))
    velocities, kept = [run.s[3:6, 0]], [run.s[-3:, 0]]
    for k in range(1, given.t.shape[1]):
        run.step(log.inputs(k, 1.0), log.around(k, 1.0), np.array([0.5]), Integrator())
        velocities.append(run.s[3:6, 0])
        kept.append(run.s[-3:, 0])
    fine = 200
    memory = np.array(velocities[0])
    for a, b in pairwise(velocities):
        for k in range(fine):
            v = a + (k + 0.5) / fine * (b - a)
            memory = v + (memory - v) * np.exp(-0.5 / fine / hybrid.memory)
    np.testing.assert_allclose(kept[-1], memory, atol=2e-4 * np.abs(velocities).max())


def test_round_trip_with_its_profile(tmp_path):
    hybrid = a_hybrid()
    path = save_network(hybrid, tmp_path / "model.safetensors")
    again = load_network(path)
    assert isinstance(again, Hybrid)
    assert again.profile.text == hybrid.profile.text
    assert again.facts == {"type": "hybrid"}
    a, b = (HybridPredictor(one).predict(cases()).states for one in (hybrid, again))
    np.testing.assert_allclose(a, b, atol=1e-4)  # weights are kept in single precision
    found = named_ship(str(path), Integrator("euler"))
    assert found.method == "hybrid, euler"


def test_files_that_do_not_fit_are_refused(tmp_path):
    import json

    from safetensors.numpy import save_file

    hybrid = a_hybrid()
    arrays = {f"weights.{k}": np.float32(v) for k, v in hybrid.weights._asdict().items()}
    arrays |= {f"ranges.{k}": np.float32(v) for k, v in hybrid.ranges._asdict().items()}
    header = {"kind": "hybrid", "profile": hybrid.profile.text, "memory": 5.0, "facts": {}}

    def written(**changed):
        path = tmp_path / "changed.safetensors"
        text = json.dumps({**header, **changed})
        save_file(arrays, path, metadata={"format": "mmgtune network", "schema": "1", "network": text})
        return path

    assert load_network(written()).memory == 5.0
    for changed, words in (
        ({"memory": 0.0}, "memory is 0 s"),
        ({"memory": None}, "memory of the network"),
        ({"profile": 3}, "profile of the network"),
        ({"profile": load_profile("suzaku").text + "x" * (1 << 20)}, "too many"),
    ):
        with pytest.raises(NetworkError, match=words):
            load_network(written(**changed))
    with pytest.raises(ProfileError):
        load_network(written(profile="[ship"))
    arrays["weights.W_2"] = np.zeros((4, 3), np.float32)
    with pytest.raises(NetworkError, match="W_2 has the shape"):
        load_network(written())
