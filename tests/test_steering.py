"""Helmsmen on lanes: the indices of single fine runs, smooth in the coefficients, each lane for itself."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.backends import Integrator, LaneModel, get_backend
from mmgtune.manoeuvres import stopping_indices, turning_indices, zigzag_indices
from mmgtune.manoeuvres.on_lanes import LaneRecord, stopping, turning, zigzag
from mmgtune.model import Model
from mmgtune.orders import TurningOrder, ZigzagOrder, run_manoeuvre
from mmgtune.physics.quantities import UNKNOWN, State
from mmgtune.profile import Actuator, load_profile, with_effects
from mmgtune.steering import APPROACH, PATIENCE, STEP, ModelLanes, Orders, steer, steer_lanes
from mmgtune.units import DEG

TURN, TWENTY, TEN = 35.0 * DEG, 20.0 * DEG, 10.0 * DEG


@pytest.fixture(scope="module")
def kvlcc2():
    return Model(load_profile("kvlcc2"))


def orders(model, rudder, check, legs=3, until=545.0 * DEG, astern=None):
    """Lanes from the profile's approach."""
    rudder, check = np.array(rudder, dtype=float), np.array(check, dtype=float)
    n, approach = len(rudder), model.profile.approach
    revolutions = approach.n if astern is None else astern
    until = np.where(np.isfinite(check), np.inf, until)
    return Orders(
        *np.full((2, n), [[approach.speed], [approach.n]]),
        rudder,
        check,
        np.full(n, legs),
        until,
        np.full(n, revolutions),
    )


def record_of(steered, rudder):
    return LaneRecord(
        steered.h, steered.states, steered.end, steered.orders, APPROACH, np.where(np.array(rudder) < 0, -1.0, 1.0)
    )


def march(model, rudder, check, theta=None, backend="compiled", **known):
    steered = steer(
        model,
        np.repeat(model.matrix(), len(rudder), axis=1) if theta is None else theta,
        orders(model, rudder, check, **known),
        get_backend(backend),
    )
    return steered, record_of(steered, rudder)


def stepped(model, order):
    """One lane stepped together with its helmsman, who sees each step before it is final: what ``steer`` has to find.

    order  one entry of each field of ``Orders``
    -> states (n_samples, 6), inputs (n_samples, n_inputs), fractional samples of the orders
    """
    h = STEP * model.L_pp / order.speed
    inputs = model.arrangement.inputs
    actuators = [model.profile.actuator(one.name) for one in inputs]
    ship = LaneModel(model, model.matrix()[:, 0])
    side, times = 0.0, []

    def moved(now, dt):
        n = order.revolutions if times else order.n
        of = {"rudder": side * order.rudder, "propeller": n, "thruster": 0.0}
        pairs = zip(inputs, now, actuators, strict=True)
        return [gear.moved(value, of[one.role], dt) if gear else of[one.role] for one, value, gear in pairs]

    def control(values):
        return model.arrangement.control(*map(np.float64, values))

    def after(values):
        run.now = before
        run.step(control(values), UNKNOWN, h, Integrator("rk4"))
        return np.array(run.shown)

    driven = [order.n if one.role == "propeller" else 0.0 for one in inputs]
    states, controls = [np.array([0.0, 0.0, 0.0, order.speed, 0.0, 0.0])], [driven]
    run = ship.start(State(*states[0]), control(driven))
    for k in range(PATIENCE):
        if k == APPROACH:
            side, times = 1.0, [float(k)]
        before = run.now
        then = moved(driven, h)
        shown = after(then)
        begin, end = (side * np.sign(order.rudder) * psi for psi in (states[-1][2], shown[2]))
        if times and begin < order.check <= end:
            share = (order.check - begin) / (end - begin)
            first = moved(driven, share * h)
            side = -side
            times.append(k + share)
            then = moved(first, (1.0 - share) * h)
            shown = after(then)
        driven = then
        states.append(shown)
        controls.append(then)
        stopped = order.revolutions < 0.0 and times and shown[3] <= 0.0
        if len(times) > order.legs or abs(shown[2]) >= order.until or stopped:
            break
    return np.array(states), np.array(controls), times


def with_memory(profile):
    """A gear and forces that lag, a compass that is off, clocks that differ; revolutions follow slowly."""
    values = {
        "steering-lag": {"time_constant": 6.0},
        "memory": {"time_constant": 20.0},
        "heading-bias": {"angle": 2.0 * DEG},
        "clock-offset": {"seconds": 3.0},
    }
    return replace(with_effects(profile, values, "a test"), actuators={"n": Actuator(-2.0, 2.0, 0.01)})


@pytest.mark.daily("compiled")
@pytest.mark.parametrize("backend", ["compiled", "numpy"])
@pytest.mark.parametrize("kind", ["gear", "at once", pytest.param("memory", marks=pytest.mark.long), "astern"])
def test_lanes_are_those_stepped_with_their_helmsmen(kvlcc2, esso_osaka, kind, backend):
    rudder, check, known = [TURN, -TEN, TWENTY, -TEN], [np.inf, TEN, TWENTY, 5.0 * DEG], {"until": 100.0 * DEG}
    model = kvlcc2
    if kind == "at once":
        model = Model(replace(model.profile, steering_gear=None))
    if kind == "memory":
        model = Model(with_memory(model.profile))
    if kind == "astern":
        model, known = esso_osaka, {"astern": -esso_osaka.profile.approach.n}
        rudder, check = [0.0, TEN], [np.inf, np.inf]
    steered, _ = march(model, rudder, check, backend=backend, **known)
    told = orders(model, rudder, check, **known)
    assert steered.sound.all()
    for lane in range(len(rudder)):
        states, controls, times = stepped(model, Orders(*(of[lane] for of in told)))
        part = slice(0, steered.end[lane] + 1)
        assert part.stop == len(states)
        np.testing.assert_allclose(steered.controls[part, :, lane], controls, rtol=0.0, atol=1e-9)
        np.testing.assert_allclose(steered.states[part, :, lane], states, rtol=1e-9, atol=1e-9)
        given = steered.orders[:, lane]
        assert given[~np.isnan(given)] == pytest.approx(times, abs=1e-9)
    if kind == "memory":
        assert 0.0 < steered.controls[APPROACH + 1, 1, 0] < TURN


def test_an_engine_follows_its_order_within_its_limits(esso_osaka):
    n = esso_osaka.profile.approach.n
    model = Model(replace(esso_osaka.profile, actuators={"n": Actuator(-0.5 * n, 2.0 * n, 0.1 * n)}))
    steered, _ = march(model, [0.0], [np.inf], until=np.inf, astern=-n)
    driven = steered.controls[:, steered.inputs.index("n"), 0]
    since = steered.h[0] * np.maximum(np.arange(len(driven)) - APPROACH, 0)
    assert driven == pytest.approx(np.maximum(n - 0.1 * n * since, -0.5 * n))


def test_indices_of_lanes_are_those_of_their_records(kvlcc2):
    rudder, check = [TURN, -TURN, TWENTY, -TEN], [np.inf, np.inf, TWENTY, TEN]
    steered, record = march(kvlcc2, rudder, check)
    turns, zigzags = turning(record), zigzag(record, np.array(check))
    for lane in (0, 1):
        single = turning_indices(steered.track(lane), kvlcc2.L_pp)
        for name, values in turns.items():
            assert values[lane] == pytest.approx(getattr(single, name), rel=1e-6), name
    for lane in (2, 3):
        single = zigzag_indices(steered.track(lane), kvlcc2.L_pp, (abs(rudder[lane]), check[lane]))
        for name in ("initial_turning_time", "initial_turning_distance", "reach", "period"):
            assert zigzags[name][lane] == pytest.approx(getattr(single, name), rel=1e-6), name
        for k, angle in enumerate(single.overshoot[:2], 1):
            assert zigzags[f"overshoot_{k}"][lane] == pytest.approx(angle, abs=0.005 * DEG)


def test_they_are_those_of_fine_single_runs(kvlcc2):
    steered, record = march(kvlcc2, [TURN, TWENTY], [np.inf, TWENTY], until=185.0 * DEG)
    turns, zigzags = turning(record), zigzag(record, np.array([np.inf, TWENTY]))
    helmsman = TurningOrder(TURN, 20.0, 185.0 * DEG)
    fine = turning_indices(run_manoeuvre(kvlcc2, helmsman, sample=0.5, step=0.1).track(), kvlcc2.L_pp)
    for name in ("advance", "transfer", "tactical_diameter"):
        assert turns[name][0] == pytest.approx(getattr(fine, name), abs=1e-3 * kvlcc2.L_pp)
    helmsman = ZigzagOrder(TWENTY, TWENTY, 20.0, 3)
    run = run_manoeuvre(kvlcc2, helmsman, sample=0.5, step=0.1)
    fine = zigzag_indices(run.track(), kvlcc2.L_pp, (TWENTY, TWENTY))
    for k in (1, 2):
        assert zigzags[f"overshoot_{k}"][1] == pytest.approx(fine.overshoot[k - 1], abs=0.05 * DEG)
    assert zigzags["reach"][1] == pytest.approx(fine.reach, rel=2e-3)
    assert steered.sound.all()


def test_indices_are_smooth_in_the_coefficients(kvlcc2):
    """Differences over steps of 1e-6 and 1e-3 agree: no step of the march shows in them."""
    row = kvlcc2.rows["hull.N_r"]
    steps = np.array([0.0, 1e-6, 1e-3, -1e-6, -1e-3])
    theta = np.repeat(kvlcc2.matrix(), len(steps), axis=1)
    theta[row] *= 1.0 + steps
    n = len(steps)
    _, record = march(kvlcc2, [TWENTY] * n, [TWENTY] * n, theta)
    for name, values in zigzag(record, np.full(n, TWENTY)).items():
        if name in ("overshoot_1", "overshoot_2", "reach", "period", "initial_turning_time"):
            near, far = (values[1] - values[3]) / 2e-6, (values[2] - values[4]) / 2e-3
            assert near == pytest.approx(far, rel=0.05), name
    _, record = march(kvlcc2, [TURN] * n, [np.inf] * n, theta)
    for name, values in turning(record).items():
        near, far = (values[1] - values[3]) / 2e-6, (values[2] - values[4]) / 2e-3
        if name.startswith("steady"):  # means over a stretch that ends with a sample
            continue
        assert near == pytest.approx(far, rel=0.05), name


def test_a_lane_is_the_same_whatever_marches_beside_it(kvlcc2):
    alone, _ = march(kvlcc2, [-TEN], [TEN])
    rows = kvlcc2.matrix()
    wild = rows.copy()
    wild[kvlcc2.rows["hull.N_v"]] *= -1e6
    among, _ = march(kvlcc2, [TURN, -TEN, TEN], [np.inf, TEN, TEN], np.hstack([rows, rows, wild]))
    end = alone.end[0]
    assert among.end[1] == end
    np.testing.assert_array_equal(among.states[: end + 1, :, 1], alone.states[: end + 1, :, 0])
    assert among.sound[:2].all()


def test_what_a_ship_never_reaches_is_not_a_number(kvlcc2):
    theta = kvlcc2.matrix()
    theta[kvlcc2.rows["rudder.f_alpha"]] = 1e-6  # a rudder that does nothing, on a ship that keeps her course
    theta[kvlcc2.rows["hull.N_r"]] *= 4.0
    _, record = march(kvlcc2, [TWENTY, TURN], [TWENTY, np.inf], np.repeat(theta, 2, axis=1))
    assert np.isnan(zigzag(record, np.array([TWENTY, np.inf]))["initial_turning_time"][0])
    assert np.isnan(turning(record)["advance"][1])


def test_a_ship_stops_with_her_propeller_astern(esso_osaka):
    approach = esso_osaka.profile.approach
    steered, record = march(esso_osaka, [0.0, 0.0], [np.inf, np.inf], until=np.inf, astern=-approach.n)
    found = stopping(record)
    single = stopping_indices(steered.track(0), esso_osaka.L_pp, APPROACH * steered.h[0])
    for name, values in found.items():
        assert values[0] == pytest.approx(getattr(single, name), rel=1e-9)
    assert 0.0 < found["head_reach"][0] <= found["track_reach"][0]
    assert 2.0 < found["track_reach"][0] / esso_osaka.L_pp < 20.0
    assert single.to_dict()["track_reach_over_L"] == pytest.approx(found["track_reach"][0] / esso_osaka.L_pp)
    harder, record = march(esso_osaka, [0.0], [np.inf], until=np.inf, astern=-1.5 * approach.n)
    assert stopping(record)["track_reach"][0] < found["track_reach"][0]
    assert harder.sound.all()


@pytest.mark.parametrize("check", [np.inf, TWENTY])
def test_a_manoeuvre_ends_where_every_lane_is_lost(kvlcc2, check):
    """A heading that is infinite passed the check heading of turns, which is at infinity, a thousand times over."""

    class Lost(ModelLanes):
        marches = 0

        def march(self, lanes, cases):
            self.marches += 1
            found = super().march(lanes, cases)
            found[:, 12:] = np.inf
            return found

    ships = Lost(kvlcc2, np.repeat(kvlcc2.matrix(), 2, axis=1), get_backend("numpy"))
    steered = steer_lanes(ships, orders(kvlcc2, [TURN, -TURN], [check, check], legs=1000))
    assert ships.marches == 1
    assert not steered.sound.any()
    assert steered.end.tolist() == [12, 12]
