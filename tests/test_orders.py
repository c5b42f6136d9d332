"""Manoeuvres that march side by side are those that are sailed alone, to the last bit."""

import math

import numpy as np
import pytest

from mmgtune.model import Model
from mmgtune.orders import Sailing, TurningOrder, ZigzagOrder, run_manoeuvre, run_manoeuvres
from mmgtune.profile import load_profile, with_effects
from tests.effects.test_effects import STRONG

ORDERS = (
    lambda: TurningOrder(math.radians(35.0), 10.0),
    lambda: TurningOrder(math.radians(-10.0), 10.0, until=0.2),
    lambda: ZigzagOrder(math.radians(20.0), math.radians(20.0), 10.0, legs=2),
)


@pytest.mark.slow(4)
@pytest.mark.parametrize("effects", [{}, STRONG], ids=["plain", "every effect"])
def test_lanes_side_by_side_are_those_alone(effects):
    """With steps and lengths of their own; the second is left behind, and one goes on alone in the end."""
    model = Model(with_effects(load_profile("suzaku"), effects, "test"))
    how = [
        {"longest": 100.0, "speed": 5.0},
        {"longest": 40.0, "sample": 0.5, "step": 0.25},
        {"longest": 60.0, "heading": 2.0, "n": 1.5},
    ]
    theta = np.repeat(model.matrix(), 3, axis=1)
    theta[model.rows["hull.R_0"]] *= [1.0, 1.2, 0.9]
    together = run_manoeuvres(
        model, [Sailing(order(), **of) for order, of in zip(ORDERS, how, strict=True)], theta=theta
    )
    for k, (order, of, lane) in enumerate(zip(ORDERS, how, together, strict=True)):
        alone = run_manoeuvre(model, order(), theta=theta[:, [k]], **of)
        assert np.array_equal(lane.states, alone.states)
        assert np.array_equal(lane.controls, alone.controls)
        assert np.array_equal(lane.t, alone.t)


def test_one_that_leaves_the_world_of_ships_touches_no_other():
    model = Model(load_profile("suzaku"))
    theta = np.repeat(model.matrix(), 2, axis=1)
    theta[model.rows["hull.X_vvvv"], 1] = 1e9
    sound, lost = run_manoeuvres(model, [Sailing(TurningOrder(0.6, 1.0), longest=60.0) for _ in range(2)], theta=theta)
    assert lost.diverged
    assert not sound.diverged
    alone = run_manoeuvre(model, TurningOrder(0.6, 1.0), longest=60.0)
    assert np.array_equal(sound.states, alone.states)
