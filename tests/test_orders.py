"""Manoeuvres that march side by side are those that are sailed alone, to the last bit; on either way, to rounding."""

import math

import numpy as np
import pytest

from mmgtune.backends import get_backend, get_ready_backend
from mmgtune.backends.compiled import Compiled
from mmgtune.errors import OptionError
from mmgtune.model import Model
from mmgtune.orders import (
    Sailing,
    SpiralOrder,
    Straight,
    TurningOrder,
    Weave,
    ZigzagOrder,
    run_manoeuvre,
    run_manoeuvres,
)
from mmgtune.orders.ordering import order_by_order, serves
from mmgtune.orders.sailing import Watch
from mmgtune.orders.stepping import step_by_step
from mmgtune.profile import load_profile, with_effects
from tests.effects.test_effects import TOGETHER

ORDERS = (
    lambda: TurningOrder(math.radians(35.0), 10.0),
    lambda: TurningOrder(math.radians(-10.0), 10.0, until=0.2),
    lambda: ZigzagOrder(math.radians(20.0), math.radians(20.0), 10.0, legs=2),
)


def _sailed(way, model, theta, sailings):
    """Motions of manoeuvres by stepping, or on the compiled simulator."""
    watches = [Watch(sailing, model) for sailing in sailings]
    way(model, theta, watches)
    return [watch.motion(model) for watch in watches]


def _on_compiled(model, theta, watches):
    order_by_order(model, theta, watches, get_backend("compiled"))


@pytest.mark.daily("plain", "_on_compiled")
@pytest.mark.parametrize("way", [step_by_step, _on_compiled])
@pytest.mark.parametrize("effects", [{}, TOGETHER], ids=["plain", "every effect"])
def test_lanes_side_by_side_are_those_alone(effects, way):
    """With steps and lengths of their own; the second is left behind, and one goes on alone in the end."""
    model = Model(with_effects(load_profile("suzaku"), effects, "test"))
    how = [
        {"longest": 100.0, "speed": 5.0},
        {"longest": 40.0, "sample": 0.5, "step": 0.25},
        {"longest": 60.0, "heading": 2.0, "n": 1.5},
    ]
    theta = np.repeat(model.matrix(), 3, axis=1)
    theta[model.rows["hull.R_0"]] *= [1.0, 1.2, 0.9]
    sailings = [Sailing(order(), **of) for order, of in zip(ORDERS, how, strict=True)]
    together = _sailed(way, model, theta, sailings)
    for k, (order, of, lane) in enumerate(zip(ORDERS, how, together, strict=True)):
        (alone,) = _sailed(way, model, theta[:, [k]], [Sailing(order(), **of)])
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


HELMSMEN = (
    lambda: TurningOrder(math.radians(35.0), 10.0, until=2.0),
    lambda: ZigzagOrder(math.radians(20.0), math.radians(20.0), 10.0, legs=3),
    lambda: SpiralOrder(math.radians(20.0), 15.0, steps=5, at=10.0),
    lambda: Weave(13.0),
    Straight,
)


@pytest.mark.daily("plain")
@pytest.mark.parametrize("effects", [{}, TOGETHER], ids=["plain", "every effect"])
def test_order_by_order_is_step_by_step(effects):
    """On the compiled simulator the inputs and motions are those of stepping, whatever steps and lengths they have."""
    model = Model(with_effects(load_profile("suzaku"), effects, "test"))
    how = [{"longest": 150.0}, {"longest": 90.0, "sample": 0.5, "heading": 3.0}, {"longest": 20.0, "n": 1.5}]
    sailings = [Sailing(order(), **how[k % 3]) for k, order in enumerate(HELMSMEN)]
    theta = np.repeat(model.matrix(), len(sailings), axis=1)
    theta[model.rows["hull.R_0"]] *= [1.0, 1.2, 0.9, 1.1, 1.0]
    compiled = _sailed(_on_compiled, model, theta, sailings)
    again = [Sailing(order(), **how[k % 3]) for k, order in enumerate(HELMSMEN)]
    for found, stepped in zip(compiled, _sailed(step_by_step, model, theta, again), strict=True):
        assert np.array_equal(found.t, stepped.t)
        assert np.allclose(found.controls, stepped.controls, rtol=0.0, atol=1e-12)
        assert np.allclose(found.states, stepped.states, rtol=1e-11, atol=1e-10)
        assert not found.diverged


def test_a_ship_that_is_lost_ends_there_order_by_order_too():
    model = Model(load_profile("suzaku"))
    theta = np.repeat(model.matrix(), 2, axis=1)
    theta[model.rows["hull.X_vvvv"], 1] = 1e9
    sound, lost = _sailed(_on_compiled, model, theta, [Sailing(TurningOrder(0.6, 1.0), longest=60.0) for _ in range(2)])
    assert lost.diverged
    assert not sound.diverged
    assert len(lost.t) < len(sound.t)


def test_only_few_orders_are_sailed_order_by_order():
    class Nervous(TurningOrder):
        def order(self, t, heading):
            return 0.1 * math.sin(t)

    model = Model(load_profile("suzaku"))

    def asked(helmsman, **how):
        return serves(Watch(Sailing(helmsman, **how), model))

    assert asked(TurningOrder(0.5))
    assert not asked(TurningOrder(0.5), longest=30.0)
    assert not asked(TurningOrder(0.5), engine=lambda left: left)
    assert not asked(Nervous(0.5))


def test_a_simulator_that_would_have_to_be_compiled_is_not_asked(monkeypatch):
    model = Model(load_profile("suzaku"))
    get_backend("compiled").kernel(model)
    assert get_ready_backend(model) is get_backend("compiled")
    monkeypatch.setattr(Compiled, "_is_there", lambda self, model: False)
    assert get_ready_backend(model) is None
    assert np.isfinite(run_manoeuvre(model, TurningOrder(0.5), longest=30.0).states).all()


@pytest.mark.daily("Straight")
@pytest.mark.parametrize("order", HELMSMEN)
def test_an_order_sailed_twice_is_the_same_twice(order):
    """What a helmsman remembers is of one simulation."""
    helmsman = order()
    first, again = (run_manoeuvre("suzaku", helmsman, longest=200.0) for _ in range(2))
    assert np.array_equal(first.states, again.states)
    assert np.array_equal(first.controls, again.controls)


@pytest.mark.parametrize(
    ("wrong", "what"),
    [
        ({"sample": 0.0}, "sample is 0"),
        ({"sample": -1.0}, "sample is -1"),
        ({"step": 0.0}, "step is 0"),
        ({"longest": math.nan}, "longest is nan"),
        ({"longest": 1e12}, "too many"),
        ({"speed": "12 kn"}, "approach speed is '12 kn'"),
        ({"speed": 0.0}, "approach speed is 0"),
        ({"n": math.nan}, "revolutions are nan"),
        ({"heading": "north"}, "heading is 'north'"),
    ],
)
def test_what_cannot_be_sailed_is_refused_in_words(wrong, what):
    with pytest.raises(OptionError, match=what) as caught:
        run_manoeuvre("suzaku", TurningOrder(0.6), **wrong)
    (problem,) = caught.value.problems
    assert problem.where in wrong
    assert problem.fix


@pytest.mark.parametrize(
    "order",
    [
        lambda: SpiralOrder(20.0, 60.0),
        lambda: SpiralOrder(0.3, 60.0, steps=1),
        lambda: SpiralOrder(0.3, 0.0),
        lambda: ZigzagOrder(0.2, 0.2, legs=0),
        lambda: ZigzagOrder(0.2, 0.2, legs=2.5),
        lambda: TurningOrder(0.6, at=-1.0),
        lambda: TurningOrder(0.6, until=0.0),
        lambda: Weave(0.0),
    ],
)
def test_orders_that_make_no_sense_are_refused(order):
    with pytest.raises(OptionError) as caught:
        order()
    assert caught.value.problems[0].fix
