"""Effects: absent at their null bit for bit, alike in both back ends, and each does what it says."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from mmgtune.backends import Integrator, get_backend, pad
from mmgtune.backends.compiled import Compiled
from mmgtune.backends.logged import AT_ONCE
from mmgtune.backends.whole import whole_of
from mmgtune.components import COMPONENTS
from mmgtune.effects import FactorsEffect, effects, find_effect
from mmgtune.errors import ProfileError
from mmgtune.fitting.box import make_box
from mmgtune.model import Model
from mmgtune.orders import TurningOrder, run_manoeuvre
from mmgtune.physics.quantities import UNKNOWN, State, Surroundings
from mmgtune.profile import load_profile, missing_for, parse_profile, with_all_effects, with_effects
from mmgtune.resources import profile_names
from tests.backends.test_agree import zigzag_like
from tests.runs import measured, states, turn

STRONG = {
    "clock-offset": {"seconds": 1.3},
    "dead-time": {"seconds": 2.2},
    "steering-lag": {"time_constant": 2.5, "rate_limit": 0.05, "to_starboard": 0.04, "to_port": 0.06},
    "backlash": {"play": 0.05},
    "rudder-gain": {"factor": 0.9, "starboard": 1.1, "port": 0.95, "curve": -0.1},
    "rudder-offset": {"angle": 0.02},
    "rudder-limit": {"angle": 0.35},
    "governor-lag": {"time_constant": 40.0},
    "rpm-scale": {"factor": 1.03},
    "current": {"north": 0.2, "east": -0.1},
    "wind-drift": {"along": 0.02, "across": -0.005},
    "flap": {"factor": 0.9},
    "thrust": {"factor": 0.9},
    "propeller-side-force": {"force": 1.4, "moment": 0.7},
    "propeller-walk": {"share": 0.05},
    "shallow-water": {"depth": 10.0, "N_r": 0.1, "cross": 0.5, "inertia": 0.3},
    "loading": {"draught": 1.05, "trim": 0.1, "displacement": 0.97, "N_v": 0.3, "inertia": 0.5},
    "resistance": {"factor": 1.1, "slope": 1.0},
    "wind": {"speed": 8.0, "direction": 1.0},
    "waves": {"height": 2.0, "direction": 1.0},
    "wave-drift": {"force": 5000.0, "direction": 2.0},
    "steady-force": {"ahead": -2000.0, "side": 3000.0, "moment": -4e4},
    "rudder-stall": {"angle": 0.3, "slope": 0.4, "width": 0.1},
    "engine-droop": {"share": 0.2},
    "hull-asymmetry": {"Y_0": 0.002, "N_0": -0.0004},
    "hull-term": {"N_rabsr": -0.01, "Y_vvv": 0.1, "X_absr": 0.01},
    "discrepancy": {"Y_odd0": 0.01, "N_odd3": -0.002, "X_even5": 0.002, "N_even1": 0.001},
    "memory": {"time_constant": 6.0, "sway": 2.0, "yaw": 3.0},
    "antenna": {"x": 10.0, "y": 3.0, "x_alone": -6.0, "y_alone": 2.0},
    "heading-bias": {"angle": 0.03, "alone": -0.02},
    "compass-deviation": {"sine": 0.05, "cosine": -0.03, "sine_alone": 0.02, "cosine_of_twice_alone": 0.02},
    "water-log": {"north": 0.2, "east": -0.1},
    "log-misalignment": {"angle": 0.02},
    "speed-scale": {"factor": 1.02, "both": 0.99, "grows": 0.01},
    "log-zero": {"ahead": 0.05, "abeam": -0.03},
    "gyro-scale": {"factor": 1.03, "curve": 0.05},
    "gyro-bias": {"rate": 0.001},
    "position-latency": {"seconds": 1.5, "with_velocity": 1.0},
    "velocity-filter": {"over_ground": 4.0, "along_axes": 2.0, "yaw_rate": 3.0, "ahead": 1.5},
    "heading-filter": {"time_constant": 2.0, "alone": 1.0},
    "gyro-drift": {"heading": 3e-4, "heading_alone": -2e-4, "yaw_rate": 1e-6, "settles": 300.0},
}
TAGS = [effect.tag for effect in effects()]

TOGETHER = {tag: values for tag, values in STRONG.items() if tag not in ("discrepancy", "propeller-walk")}
"""Those of the kernel that diagnoses of this ship run on; what is no cause of hers has one of its own."""


@pytest.fixture(scope="module")
def ship():
    return load_profile("suzaku")


def blown(model, seconds=900):
    """The zigzag with wind measured all along, from changing directions."""
    cases = zigzag_like(model, seconds)
    t = cases.t[0]
    around = measured(
        t,
        wind=(5.0 * np.cos(t / 80.0), 6.0 * np.sin(t / 50.0)),
        current=(0.3 * np.cos(t / 60.0), 0.2 * np.sin(t / 40.0)),
        wave=(0.8 * np.cos(t / 90.0), 0.6 * np.sin(t / 70.0)),
        depth=8.0 + 2.0 * np.sin(t / 30.0),
    )
    return pad([t], [cases.controls[0]], [cases.initial[0]], around=[around])


def test_every_effect_has_a_strong_value():
    assert list(STRONG) == TAGS


@pytest.fixture(scope="module")
def base(ship):
    """Cases, and the run of the ship without effects in them, by what they are like and how long [s] they are."""

    @cache
    def run(like, seconds):
        cases = like(Model(ship), seconds)
        return cases, states(Model(ship), cases, backend="numpy")

    return run


@pytest.mark.parametrize("tag", TAGS)
def test_null_is_the_base_run_bit_for_bit_on_numpy(ship, base, tag):
    cases, without = base(blown, 120)
    null = states(Model(with_effects(ship, {tag: {}}, "test")), cases, backend="numpy")
    assert np.array_equal(without, null)


def hard_over(model, seconds=60):
    """Every input from one of its limits to the other and back; rudders to 35 deg, where none are said."""
    t = np.arange(float(seconds))
    approach = model.profile.approach
    columns = []
    for one in model.arrangement.inputs:
        gear = model.profile.actuators.get(one.name)
        far = {"propeller": 1.0 * (approach.n if approach else 1.0), "rudder": np.radians(35.0)}.get(one.role, 0.0)
        low, high = (gear.low, gear.high) if gear else (-far if one.role == "rudder" else far, far)
        columns.append(0.5 * (low + high) + 0.5 * (high - low) * np.sin(t / 10.0))
    start = np.array([0.0, 0.0, 0.0, approach.speed if approach else 1.0, 0.0, 0.0])
    return pad([t], [np.column_stack(columns)], [start])


@pytest.mark.parametrize("name", profile_names())
def test_where_a_search_has_effects_absent_they_are_not_there(name):
    """A rudder that goes no further than 60 deg was absent of no ship whose rudders go to 105: nothing was found."""
    profile = load_profile(name)
    plain, model = Model(profile), Model(with_all_effects(profile))
    cases = hard_over(plain)
    searched = [f"{one.kind}.{symbol}" for one in model.effects for variant in one.variants for symbol in variant]
    searched = list(dict.fromkeys(searched))
    box = make_box(model, searched, 0.5)
    null = box.from_unit(np.clip(box.to_unit(box.pre), 0.0, 1.0))
    base = states(plain, cases, backend="numpy", integrator=Integrator("rk4"))[0, 0]
    run = states(model, cases, model.matrix(searched, null[:, None]), "numpy", Integrator("rk4"))[0, 0]
    np.testing.assert_allclose(run, base, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("integrator", [Integrator("euler"), Integrator("rk4"), Integrator("rk4", 3)])
def test_null_is_the_base_run_bit_for_bit_compiled(ship, integrator):
    cases = blown(Model(ship))
    models = [Model(one) for one in (ship, with_all_effects(ship), with_effects(ship, {"discrepancy": {}}, "test"))]
    for model in models:
        get_backend("compiled").kernel(model)  # its own, not one of more effects
    base, *nulls = (states(model, cases, integrator=integrator) for model in models)
    for null in nulls:
        assert np.array_equal(base, null)


def test_among_all_effects_a_run_is_that_of_its_own_kernel_bit_for_bit(ship, monkeypatch):
    taken, take = [], Compiled.kernel
    monkeypatch.setattr(Compiled, "kernel", lambda self, model: (taken.append(model), take(self, model))[1])
    monkeypatch.setattr(Compiled, "_is_there", lambda self, one: len(one.effects) > 3)  # whatever others left
    model = Model(with_effects(ship, {tag: STRONG[tag] for tag in ("steering-lag", "current", "gyro-bias")}, "test"))
    theta, cases = np.column_stack([model.matrix()[:, 0], model.base]), blown(Model(ship), 300)
    backend, whole = Compiled(), whole_of(model)
    backend.run(whole.model, whole.theta(theta), cases)
    among = backend.run(model, theta, cases, keep_states=True)
    assert taken == [whole.model, whole.model]
    backend.kernel(model)
    own = backend.run(model, theta, cases, keep_states=True)
    assert taken[2:] == [model, model]
    assert np.array_equal(among.states, own.states)
    assert np.array_equal(among.cost, own.cost)
    for_long = Compiled()
    for_long.kernel(whole.model)
    monkeypatch.setattr("mmgtune.backends.compiled.WORTH_COMPILING", 1.5 * cases.steps * 2 * 4)
    for _ in range(2):
        for_long.run(model, theta, cases)
    assert taken[-2:] == [whole.model, model]  # once there is work enough, it gets its own


@pytest.mark.parametrize("backend", ["numpy", "compiled"])
def test_null_beside_lanes_with_every_effect_is_the_base_run_bit_for_bit(ship, backend):
    """Simulators pass by what no lane has; where one has it, the equations themselves must leave the others alone."""
    strong = Model(with_effects(ship, TOGETHER, "test"))
    model = Model(with_all_effects(ship))
    theta = np.column_stack([strong.matrix()[:, 0], model.matrix()[:, 0], strong.matrix()[:, 0]])
    cases = blown(Model(ship), 300)
    base, beside = states(Model(ship), cases, backend=backend), states(model, cases, theta, backend=backend)
    assert np.array_equal(base[:, 0], beside[:, 1])
    assert np.array_equal(beside[:, 0], beside[:, 2])
    assert np.abs(beside[:, 0] - beside[:, 1]).max() > 1.0


@pytest.mark.parametrize("tag", [tag for tag in TAGS if tag != "propeller-walk"])  # no cause of hers: below
def test_each_changes_the_run_and_can_be_written_and_read(ship, base, tag):
    stderr = {name: 0.1 * abs(value) for name, value in STRONG[tag].items()}
    read = parse_profile(with_effects(ship, {tag: STRONG[tag]}, "a test", {tag: stderr}).text)
    for name, value in STRONG[tag].items():
        assert read.value(f"effects.{tag}.{name}") == pytest.approx(value, rel=1e-12)
        assert read.coefficient(f"effects.{tag}.{name}").stderr == pytest.approx(0.1 * abs(value), rel=1e-12)
    cases, without = base(blown if tag == "wind-drift" else zigzag_like, 200)
    changed = states(Model(read), cases, backend="numpy")
    assert np.abs(changed - without).max() > 3e-4


@pytest.mark.long
def test_a_propeller_walks_where_the_profile_has_no_side_force_of_it():
    ship = load_profile("suzaku_fam")
    cases = zigzag_like(Model(ship), 200)
    null, walking = (
        parse_profile(with_effects(ship, {"propeller-walk": values}, "a test").text) for values in ({}, {"share": 0.05})
    )
    without, alike, changed = (states(Model(one), cases, backend="numpy") for one in (ship, null, walking))
    assert np.array_equal(without, alike)
    assert np.abs(changed - without).max() > 3e-4
    compiled = states(Model(walking), cases, backend="compiled")
    assert np.max(np.abs(compiled - changed) / (1.0 + np.abs(changed))) < 1e-9


@pytest.mark.parametrize("integrator", [Integrator("euler"), Integrator("rk4", 2)])  # every stage, every substep
@pytest.mark.parametrize("strong", [TOGETHER, {"discrepancy": STRONG["discrepancy"]}], ids=["causes", "no cause"])
def test_back_ends_agree_with_every_effect_at_once(ship, integrator, strong):
    model = Model(with_effects(ship, strong, "test"))
    cases = blown(model, 900 if integrator.name == "euler" else 300)
    compiled, reference = (states(model, cases, backend=name, integrator=integrator) for name in ("compiled", "numpy"))
    assert np.max(np.abs(compiled - reference) / (1.0 + np.abs(reference))) < 1e-9


def test_lanes_with_different_effects_do_not_touch_each_other(ship):
    model = Model(with_all_effects(ship))
    names = ["effects.current.north", "effects.memory.time_constant", "effects.clock-offset.seconds"]
    values = np.array([[0.0, 0.3, 0.0, 0.0], [0.0, 0.0, 7.0, 0.0], [0.0, 0.0, 0.0, -2.0]])
    cases = zigzag_like(model, 300)
    together = states(model, cases, model.matrix(names, values))
    for lane in range(4):
        alone = states(model, cases, model.matrix(names, values[:, lane : lane + 1]))
        assert np.array_equal(together[:, lane], alone[:, 0])


def test_current_moves_a_circle_and_leaves_the_ship_in_the_water_alone(ship):
    """With the same velocity through water the positions differ by current times time, and nothing else does."""
    north, east = 0.3, -0.2
    moved = Model(with_effects(ship, {"current": {"north": north, "east": east}}, "test"))
    cases = turn(moved, 20.0, 400.0)
    start = cases.initial[0] + np.array([0, 0, 0, north, east, 0])  # heading north
    drifting = pad([cases.t[0]], [cases.controls[0]], [start])
    still = states(Model(ship), cases, integrator=Integrator("rk4"))[0, 0]
    flown = states(moved, drifting, integrator=Integrator("rk4"))[0, 0]
    t = cases.t[0]
    assert np.allclose(flown[:, 0] - still[:, 0], north * t, atol=1e-3)
    assert np.allclose(flown[:, 1] - still[:, 1], east * t, atol=1e-3)
    assert np.allclose(flown[:, [2, 5]], still[:, [2, 5]], atol=1e-6)


def test_steering_lag_is_the_exact_first_order_response(ship):
    T = 4.0
    function = find_effect("steering-lag").function
    e = find_effect("steering-lag").params(T, np.inf, np.inf, np.inf)
    order = [min(max(0.0, t - 3.0), 10.0) for t in range(41)]  # a ramp
    blade = 0.0
    for before, after in pairwise(order):
        blade = function(before, after, blade, 1.0, e)
    fine, y = 1e-3, 0.0
    for k in range(40000):
        t = k * fine
        y += fine * (np.interp(t + 0.5 * fine, np.arange(41), order) - y) / T
    assert float(blade) == pytest.approx(y, abs=1e-3)


def test_clock_offset_is_the_shift_of_the_log(ship):
    late = Model(with_effects(ship, {"clock-offset": {"seconds": 3.0}}, "test"))
    cases = zigzag_like(late, 200)
    acted = cases.controls.copy()
    acted[0, :-3] = cases.controls[0, 3:]
    shifted = pad([cases.t[0]], [acted[0]], [cases.initial[0]])
    assert np.allclose(states(late, cases)[0, 0, :190], states(Model(ship), shifted)[0, 0, :190], atol=1e-9)


def test_a_late_log_is_read_alike_from_end_to_end(ship):
    """On NumPy it is read a part at a time; this run is longer than a part."""
    late = Model(with_effects(ship, {"clock-offset": {"seconds": 1.3}}, "test"))
    cases = zigzag_like(late, AT_ONCE + 40)
    compiled, reference = (states(late, cases, backend=name) for name in ("compiled", "numpy"))
    assert np.max(np.abs(compiled - reference) / (1.0 + np.abs(reference))) < 1e-9


def test_sensors_undo_what_they_do(ship):
    rng = np.random.default_rng(1)
    from mmgtune.backends import LaneModel
    from mmgtune.physics.quantities import State

    model = Model(
        with_effects(ship, {tag: STRONG[tag] for tag in TAGS if find_effect(tag).place in ("sensor", "filter")}, "test")
    )
    lanes = LaneModel(model, np.repeat(model.matrix(), 50, axis=1))
    true = State(*rng.normal(size=(6, 50)))
    assert np.allclose(lanes.unsensed(lanes.sensed(true)), true, atol=1e-12)


def test_the_first_sample_is_what_the_sensors_showed(ship):
    """The measured state begins a simulation as the sensors show it, also where they are wrong."""
    model = Model(with_effects(ship, {"antenna": {"x": 20.0}, "heading-bias": {"angle": 0.05}}, "test"))
    cases = turn(model, 20.0, 100.0)
    for backend in ("compiled", "numpy"):
        assert np.allclose(states(model, cases, backend=backend)[0, 0, 0], cases.initial[0])
        assert np.allclose(states(model, cases, backend=backend)[0, 0, 1], cases.initial[0], atol=4.0)


def test_measured_wind_counts_where_there_is_some(ship):
    steady = Model(with_effects(ship, {"wind": {"speed": 9.0, "direction": 0.7}}, "test"))
    by_log = Model(with_effects(ship, {"wind": {"measured": 1.0}}, "test"))
    cases = turn(steady, 20.0, 200.0)
    t, controls, start = cases.t[0], cases.controls[0], cases.initial[0]
    wind = measured(t, wind=(-9.0 * np.cos(0.7), -9.0 * np.sin(0.7)))
    logged = pad([t], [controls], [start], around=[wind])
    for backend in ("compiled", "numpy"):
        assert np.allclose(states(by_log, logged, backend=backend), states(steady, cases, backend=backend), atol=1e-9)
    without = states(by_log, cases)
    assert np.array_equal(without, states(Model(ship), cases))


def test_water_goes_with_the_wind_and_to_its_right():
    """Wind towards north seen from a ship that heads east: the water moves to port, and ahead where it veers right."""
    effect = find_effect("wind-drift")
    air, state = UNKNOWN._replace(wind_north=5.0, wind_known=1.0), State(0.0, 0.0, np.pi / 2.0, 0.0, 0.0, 0.0)
    along = effect.function(state, air, effect.params(along=0.02, across=0.0))
    across = effect.function(state, air, effect.params(along=0.0, across=0.02))
    np.testing.assert_allclose(along, (0.0, -0.1), atol=1e-15)
    np.testing.assert_allclose(across, (0.1, 0.0), atol=1e-15)


def test_ordered_manoeuvres_have_the_effects_too(ship):
    still = run_manoeuvre(ship, TurningOrder(0.5), longest=300.0)
    lagging = with_effects(ship, {"steering-lag": {"time_constant": 10.0}, "memory": {"time_constant": 8.0}}, "test")
    slow = run_manoeuvre(lagging, TurningOrder(0.5), longest=300.0)
    assert slow.channel("x")[:250].max() > still.channel("x")[:250].max() + 5.0
    drifting = run_manoeuvre(with_effects(ship, {"current": {"east": 0.5}}, "test"), TurningOrder(0.5), longest=300.0)
    assert drifting.channel("y")[200] > still.channel("y")[200] + 50.0


def test_one_lane_of_numbers_is_bit_equal_to_an_array_of_one(ship):
    from mmgtune.backends import LaneModel

    model = Model(with_effects(ship, {tag: STRONG[tag] for tag in TAGS}, "test"))
    start = np.array([0.0, 0.0, 0.3, 5.0, 0.4, 0.01])
    around = Surroundings(*np.linspace(0.3, 1.0, len(Surroundings._fields)))

    def end(theta, of):
        def inputs(k):
            return model.arrangement.control(of(1.5), of(0.4 * np.sin(0.3 * k)))

        run = LaneModel(model, theta).start(State(*map(of, start)), inputs(0))
        for k in range(1, 60):
            run.step(inputs(k), around, of(0.5), Integrator())
        return np.array(run.shown).ravel()

    numbers = end(model.matrix()[:, 0], np.float64)
    assert np.isfinite(numbers).all()
    assert np.array_equal(numbers, end(model.matrix(), lambda value: np.array([value])))


def test_parameters_are_targets_with_boxes_of_their_own(ship):
    model = Model(with_all_effects(ship))
    names = ("effects.current.north", "effects.shallow-water.depth", "effects.wind.speed", "effects.wind.direction")
    box = make_box(model, names, 0.5)
    rng = np.random.default_rng(1)
    unit = rng.uniform(0.05, 0.95, (4, 20))
    values = box.from_unit(unit)
    assert np.allclose(box.to_unit(values), unit)
    null = box.to_unit([0.0, np.inf, 0.0, 0.0])
    assert np.allclose(null, [0.5, 0.0, 0.5, 0.5])
    assert np.isinf(box.from_unit(null)[1])


@pytest.mark.parametrize("effect", effects(), ids=lambda effect: effect.tag)
def test_every_cause_can_be_said_whichever_parameters_were_found(effect):
    """Alone, and all together as where one was found after another; what stands in is never found beside the other."""
    together = [{name for variant in effect.variants for name in variant}] if not effect.stand_in else []
    for found in (*effect.variants, *together):
        shown = {name: f"<{name}>" for name in found}
        for pair, told in effect.told_as.items():  # north and east as size and direction
            if set(pair) <= set(found):
                shown |= {word: shown.pop(name) for name, word in zip(pair, told, strict=True)}
        sentence = effect.sentence(shown)
        for variant in effect.variants:
            if set(variant) <= set(found):
                assert all(f"<{name}>" in sentence for name in variant), sentence


@pytest.mark.parametrize(
    ("tag", "sizes", "said"),
    [
        (
            "wind",
            {"measured": "-1.01 ± 0.02"},
            "The wind measured in the trials acts on the ship the other way, with 1.01",
        ),
        ("wind", {"measured": "0.52 ± 0.02"}, "times its measured speed, as of knots taken for m/s"),
        ("current", {"measured": "1.95 ± 0.02"}, "times its measured speed, as of m/s taken for knots"),
        ("current", {"measured": "0.8"}, "with 0.8 times its measured speed"),
        ("current", {"turned": "-17.2 ± 0.3°"}, "The current is logged 17.2 ± 0.3° anticlockwise of where it sets to"),
    ],
)
def test_what_is_wrong_with_a_log_of_the_surroundings_is_said(tag, sizes, said):
    sentence = find_effect(tag).sentence(sizes)
    assert said in sentence
    assert ("knots" in sentence) == ("knots" in said)


def test_what_a_profile_gets_wrong_is_said(ship):
    with pytest.raises(ProfileError, match="unknown effect 'curent'"):
        parse_profile(ship.text + '\n[effects.curent]\nnorth = "1 m/s"\n')
    with pytest.raises(ProfileError, match=r"effects\.current\.north"):
        parse_profile(ship.text + "\n[effects.current]\nnorth = 1.0\n")
    with pytest.raises(ProfileError, match=r"unknown key 'effects\.current\.up'"):
        parse_profile(ship.text + '\n[effects.current]\nup = "1 m/s"\n')
    plain = load_profile("kvlcc2_l7")
    assert missing_for(find_effect("flap"), plain) == ["rudder.flap[0]"]
    with pytest.raises(ProfileError, match="'wind' does not apply"):
        parse_profile(plain.text + '\n[effects.wind]\nspeed = "8 m/s"\ndirection = "10 deg"\n')


@pytest.mark.parametrize("tags", [tuple(TOGETHER), ("discrepancy",)], ids=["causes", "no cause"])
def test_costs_of_all_lanes_stay_finite_at_the_corners_of_every_box(ship, tags):
    """No value a search may try makes the simulator fail."""
    model = Model(with_effects(ship, {tag: {} for tag in tags}, "test"))
    names = [f"effects.{tag}.{name}" for tag in tags for name in find_effect(tag).parameters]
    box = make_box(model, names, 0.5)
    corners = np.repeat(box.to_unit(box.pre)[:, None], 2 * len(names), axis=1)
    for k in range(len(names)):
        corners[k, 2 * k], corners[k, 2 * k + 1] = 0.0, 1.0
    cases = zigzag_like(model, 200)
    found = get_backend().run(model, model.matrix(names, box.from_unit(corners)), cases, keep_states=True)
    assert np.isfinite(found.states[~found.diverged]).all()
    assert found.diverged.mean() < 0.2


@pytest.mark.long
def test_a_current_is_fitted_like_any_coefficient(ship, tmp_path):
    """`fit` and `sweep` take parameters of effects as targets."""
    from mmgtune.fitting import FitOptions, fit
    from mmgtune.trial import load_trials
    from tests.hidden.cases import single
    from tests.hidden.plant import simulate, write

    case = single("current", 3, 2)
    write(simulate({}, case.effects, case.seed, case.noise), tmp_path)
    start = parse_profile(ship.text + '\n[effects.current]\nnorth = "0 m/s"\neast = "0 m/s"\n')
    options = FitOptions(
        method="least-squares",
        starts=2,
        initial="estimated",
        integrator="rk4",
        targets=("effects.current.north", "effects.current.east", "hull.R_0", "wake.w_P0"),
    )
    result = fit(start, load_trials(tmp_path), options)
    for name, value in case.effects["current"].items():
        assert result.theta[f"effects.current.{name}"] == pytest.approx(value, abs=0.01)
    tuned = parse_profile(result.tuned_text())
    assert tuned.value("effects.current.north") == result.theta["effects.current.north"]


def test_factors_are_on_coefficients_that_there_are():
    """A symbol that a component does not have is passed over, so that a wrong one would never be missed."""
    there = {f"{one.kind}.{symbol}" for one in COMPONENTS for symbol in one.params._fields}
    for effect in effects():
        if isinstance(effect, FactorsEffect):
            assert set(effect.changes) <= there


def test_shallow_water_changes_side_force_and_moment_of_every_hull():
    changed = find_effect("shallow-water").changes
    for hull in (one for one in COMPONENTS if one.kind == "hull"):
        lateral = [symbol for symbol in hull.params._fields if symbol.startswith(("Y_", "N_", "C_D"))]
        assert set(lateral) <= {name.removeprefix("hull.") for name in changed}, hull.tag


@pytest.mark.parametrize(
    ("sizes", "said"),
    [
        (
            {"to_starboard": "infinite", "to_port": "2.2 ± 0.1°/s"},
            "at once to starboard and at 2.2 ± 0.1°/s at most to port",
        ),
        ({"to_starboard": "2.2°/s", "to_port": "infinite"}, "at 2.2°/s at most to starboard and at once to port"),
        (
            {"to_starboard": "2.2°/s", "to_port": "1.1°/s"},
            "at 2.2°/s at most to starboard and at 1.1°/s at most to port",
        ),
    ],
)
def test_a_rudder_with_no_limit_to_one_side_in_words(sizes, said):
    """It followed "at infinite at most to starboard"."""
    gear = find_effect("steering-lag")
    assert gear is not None
    assert gear.sentence(sizes) == f"The rudder followed the logged angle {said}"
