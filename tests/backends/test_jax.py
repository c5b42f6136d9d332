"""The third back end: the motion of the reference, derivatives right and finite, and what is said without it."""

import functools
import sys

import numpy as np
import pytest

from mmgtune.backends import Integrator, _made, get_backend, pad
from mmgtune.backends.differentiable import Log, matrix_of, rates_of, rollout
from mmgtune.backends.numpy_lanes import LaneModel
from mmgtune.backends.twins import twin
from mmgtune.effects import PLACES, effects
from mmgtune.errors import OptionError
from mmgtune.model import Model
from mmgtune.physics import elementary, kinematics
from mmgtune.physics.quantities import STATES, UNKNOWN, Surroundings
from mmgtune.profile import load_profile, with_all_effects, with_effects
from tests.backends.test_agree import backing, zigzag_like
from tests.effects.test_effects import STRONG, blown
from tests.runs import driven, measured, turn

jax = pytest.importorskip("jax")


EULER, RK4 = Integrator("euler"), Integrator("rk4")


@pytest.fixture(
    params=[
        "esso_osaka",
        *(
            pytest.param(name, marks=pytest.mark.long)
            for name in ("esso_osaka_3m_tuned", "kvlcc2", "suzaku", "suzaku_fam", "vectwin_3m")
        ),
    ]
)
def ship(request):
    """A model of each kind of profile; each is compiled for seconds, so one is enough for every day."""
    return Model(load_profile(request.param))


@pytest.fixture(autouse=True)
def _double():
    with jax.enable_x64(True):
        yield


def agree(model, cases, integrator=RK4, theta=None, initial=None):
    """Costs, residuals, states and what diverged are those of the reference to 1e-12; what JAX found."""
    theta = model.matrix() if theta is None else theta
    given = dict(initial=initial, integrator=integrator, keep_states=True, keep_residuals=True)
    found, expected = (get_backend(name).run(model, theta, cases, **given) for name in ("jax", "numpy"))
    assert np.array_equal(found.diverged, expected.diverged)
    assert np.max(np.abs(found.states - expected.states) / (1.0 + np.abs(expected.states))) < 1e-12
    np.testing.assert_allclose(found.cost, expected.cost, rtol=1e-11, atol=1e-20)
    np.testing.assert_allclose(found.residuals, expected.residuals, rtol=0.0, atol=1e-11)
    return found


@pytest.mark.long
def test_every_profile_moves_as_on_numpy(ship):
    integrator = Integrator("rk4", 2)  # euler is that of the tests below
    name = f"{ship.parts[-1].kind}.{ship.parts[-1].params._fields[0]}"
    theta = ship.matrix([name], ship.profile.value(name) * np.linspace(0.8, 1.2, 5)[None])
    agree(ship, zigzag_like(ship, 150), integrator, theta)


def test_ahead_and_astern(esso_osaka):
    found = agree(esso_osaka, backing(esso_osaka, 250), EULER, esso_osaka.matrix(["hull.C_D"], [[0.8, 1.0, 1.2]]))
    assert found.states[0, :, :, 3].min() < -0.02


def of_many_lengths(model, rng):
    """Pieces of the zigzag with samples missing here and there, and targets with weights that have gaps."""
    whole = blown(model, 120)
    kept = [np.sort(rng.choice(np.arange(1, 4 + n), size=n, replace=False)) for n in (116, 40, 90, 2, 77)]
    kept = [np.insert(one, 0, 0) for one in kept]
    weight = [rng.uniform(size=(len(k), 6)) * (rng.uniform(size=(len(k), 6)) > 0.4) for k in kept]
    for one in weight:
        one[0] = 0.0
    return pad(
        [whole.t[0, k] for k in kept],
        [whole.controls[0, k] for k in kept],
        [whole.initial[0]] * len(kept),
        [rng.standard_normal((len(k), 6)) for k in kept],
        weight,
        [whole.around[0, k] for k in kept],
    )


@pytest.mark.daily("integrator0")
@pytest.mark.parametrize("integrator", [EULER, Integrator("rk4", 2)])
def test_gaps_and_cases_of_different_length(suzaku, integrator):
    rng = np.random.default_rng(1)
    cases = of_many_lengths(suzaku, rng)
    initial = cases.initial[:, None] + 0.1 * rng.standard_normal((len(cases), 3, 6))
    agree(suzaku, cases, integrator, suzaku.matrix(["hull.R_0"], [[0.01, 0.017, 0.03]]), initial)


@pytest.mark.parametrize(
    ("integrator", "strong"), [pytest.param(EULER, False, marks=pytest.mark.long), (Integrator("rk4", 2), True)]
)
def test_every_effect_at_once_and_at_null(integrator, strong):
    ship = load_profile("suzaku")
    model = Model(with_effects(ship, STRONG, "test") if strong else with_all_effects(ship))
    agree(model, of_many_lengths(model, np.random.default_rng(2)), integrator)


@pytest.mark.long
def test_portions_change_nothing(suzaku, monkeypatch):
    """Lanes are run some at a time where there are many, each with its own case."""
    from mmgtune.backends import differentiable

    rng = np.random.default_rng(3)
    cases, theta = of_many_lengths(suzaku, rng), suzaku.matrix(["hull.R_0"], [[0.01, 0.02, 0.03]])
    run = functools.partial(get_backend("jax").run, suzaku, theta, cases, integrator=EULER)
    whole = run(keep_states=True, keep_residuals=True)
    monkeypatch.setattr(differentiable, "PORTION", 500)
    parts = run(keep_states=True, keep_residuals=True)
    for name in ("cost", "states", "residuals"):
        np.testing.assert_allclose(getattr(parts, name), getattr(whole, name), rtol=1e-12, atol=1e-12)


def test_a_diverging_lane_is_a_status_and_leaves_the_others_alone(suzaku):
    theta = suzaku.matrix(["hull.R_0"], [[0.017, 0.017]])
    theta[suzaku.rows["hull.X_vvvv"], 1] = 1e9
    result = get_backend("jax").run(suzaku, theta, turn(suzaku, 35.0))
    assert result.diverged.tolist() == [[False, True]]
    assert np.isfinite(result.cost[0, 0])
    assert result.cost[0, 1] == np.inf


@pytest.mark.long
def test_settings_of_jax_stay_as_they_were(suzaku):
    with jax.enable_x64(False):
        get_backend("jax").run(suzaku, suzaku.matrix(), turn(suzaku, 20.0, 20.0))
        assert jax.numpy.ones(1).dtype == np.float32


# ------------------------------------------------------------------------------------------------- derivatives

SPECIAL = {
    "at rest": (0.0, 0.0, 0.0, 0.0),
    "turning on the spot": (0.0, 0.0, 0.01, 0.0),
    "sideways": (0.0, 0.3, 0.0, 0.0),
    "straight ahead": (1.0, 0.0, 0.0, 0.0),
    "straight astern": (-0.5, 0.0, 0.0, 0.0),
    "astern, rudder over": (-0.5, 0.1, -0.01, 0.3),
    "ahead, drifting": (1.0, 0.1, 0.01, -0.3),
}
"""Shares of the approach speed ahead and to starboard, yaw rate [rad/s] and rudder [rad]."""

TURNS = (-1.0, 0.0, 1.0)
"""Propeller astern, stopped and ahead."""


def special(model):
    """States (n, 6) and inputs (n, n_inputs) of all combinations."""
    approach = model.profile.approach
    pairs = [(one, turns) for one in SPECIAL.values() for turns in TURNS]
    U = approach.speed
    states = np.array([(0.0, 0.0, 0.4, U * u, U * v, r) for (u, v, r, _), _ in pairs])
    n, delta = np.array([(approach.n * turns, delta) for (*_, delta), turns in pairs]).T
    return states, driven(model, n, delta)


def finite(tree):
    return all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(tree))


QUICK = {
    "xla_backend_optimization_level": 0,
    "xla_llvm_disable_expensive_passes": True,
    "xla_disable_hlo_passes": "fusion,cpu-multi-output-fusion",  # half of the time it takes to compile
}
"""What runs once need not be optimised."""


def differences(function, values, scale):
    """Central differences (n_values, ...) of a function of lanes, (n_values, n_lanes) -> (..., n_lanes), and what
    rounding may have made of them."""
    h = 1e-5 * np.where(values == 0.0, 1.0, np.abs(values))
    up, down = (function(values[:, None] + sign * np.diag(h)) for sign in (1.0, -1.0))
    found = np.moveaxis((up - down) / (2.0 * h), -1, 0)
    return found, 1e-14 * scale / h


def names_of(model):
    """All that a run is differentiated by."""
    return [*model.rows, *STATES, *model.inputs]


def close(names, derivatives, expected, rounding):
    """By each of the names, (n_names, ...), to 1e-6 of the largest number."""
    off, size = (np.abs(one).reshape(len(names), -1).max(axis=1) for one in (derivatives - expected, expected))
    bad = off > 1e-6 * size + rounding
    assert not bad.any(), [(names[k], off[k], size[k], rounding[k]) for k in np.flatnonzero(bad)]


def test_rates_have_derivatives_wherever_a_ship_can_be(ship):
    """By all coefficients, state and inputs: finite, and off the special places those of central differences."""
    rates = rates_of(ship)
    states, controls = special(ship)
    U, n = ship.profile.approach.speed, ship.profile.approach.n
    plain = [0.0, 0.0, 0.4, 0.9 * U, -0.12 * U, 0.3 * U / ship.L_pp]
    states = np.vstack([states, plain, plain])
    controls = np.vstack([controls, driven(ship, [1.1 * n, 1.1 * n], [0.21, 0.0])])
    theta = np.repeat(ship.matrix(), len(states), axis=1)
    for name in ("effects.wind.speed", "effects.waves.height"):  # jump, or begin with a square, where there are none
        if name in ship.rows:
            theta[ship.rows[name], -2:] = 1.0

    def of_one(theta, state, control):
        return rates(theta, state, control, UNKNOWN, 1.0)

    by_lane = jax.vmap(jax.jacrev(of_one, argnums=(0, 1, 2)), in_axes=(1, 0, 0))
    found = jax.jit(by_lane, compiler_options=QUICK)(theta, states, controls)
    assert finite(found)

    def on_numpy(values):
        rows = len(ship.rows)
        control = ship.arrangement.control(*values[rows + 6 :])
        return LaneModel(ship, values[:rows]).rates(values[rows : rows + 6], control, UNKNOWN, 1.0)

    for lane in (-2, -1):
        values = np.concatenate([theta[:, lane], states[lane], controls[lane]])
        expected, rounding = differences(on_numpy, values, U)
        derivatives = np.concatenate([one[lane] for one in found], axis=1).T
        if lane == -1 and ship.parts[-1].tag == "slip":  # other coefficients with the rudder on the other side
            derivatives[-1] = expected[-1]
        close(names_of(ship), derivatives, expected, rounding)


def few_steps(model, integrator, around, steps):
    """A function of the values of all coefficients, the initial state and the inputs: states shown over a few steps."""
    t = 0.7 * np.arange(steps + 1.0)[:, None]

    def run(values, initial, controls):
        theta = matrix_of(model, tuple(model.rows))(values)
        held = controls * jax.numpy.linspace(1.0, 1.1, steps + 1)[:, None, None]
        log = Log(t, np.array([steps + 1]), held, around)
        return rollout(model, theta[:, None], initial[None], log, integrator=integrator)[1:, 0]

    return run


def surrounded(steps):
    """Everything measured, (T, 1, n_surroundings)."""
    t = 0.7 * np.arange(steps + 1.0)
    whole = measured(t, wind=(3.0 + t, 2.0), current=(0.2 + 0.1 * t, 0.1), wave=(0.5, 0.3), depth=9.0 + t)
    return whole[:, None]


def with_effects_of(strong, places=PLACES):
    """SUZAKU with every effect of these places, at its null or off it."""
    chosen = {effect.tag: STRONG[effect.tag] if strong else {} for effect in effects() if effect.place in places}
    return Model(with_effects(load_profile("suzaku"), chosen, "test"))


@pytest.mark.long
def test_rates_have_derivatives_with_every_effect():
    """Backwards, from everywhere a ship can be, at the nulls and off them, with all measured and with nothing."""
    null, strong = (with_effects_of(off, ("flow", "coefficients", "factors", "force")) for off in (False, True))
    assert tuple(null.rows) == tuple(strong.rows)  # one compilation for both
    rates, matrix = rates_of(null), matrix_of(null, tuple(null.rows))

    def of_one(values, state, control, around):
        return rates(matrix(values), state, control, Surroundings(*around), 1.0)

    by_lane = jax.jit(
        jax.vmap(jax.jacrev(of_one, argnums=(0, 1, 2)), in_axes=(None, 0, 0, None)), compiler_options=QUICK
    )
    for values in (null.base, strong.base):
        for around in (surrounded(1)[1, 0], 0.0 * surrounded(1)[1, 0]):
            assert finite(by_lane(values, *special(null), around))


@pytest.mark.long
def test_runs_have_derivatives_backwards_where_a_limit_is_infinite():
    """A rudder without a limit of its rate, behind a clock, remembered by the hull."""
    model = with_effects_of(False, ("clock", "actuator", "lag"))
    states, controls = special(model)
    weights = np.random.default_rng(1).standard_normal((len(states), 2, 6))

    def pulled(values, initial, control, weights):
        _, back = jax.vjp(few_steps(model, EULER, surrounded(2), 2), values, initial, control)
        return back(weights)

    by_lane = jax.jit(jax.vmap(pulled, in_axes=(None, 0, 0, 0)), compiler_options=QUICK)
    assert finite(by_lane(model.base, states, controls, weights))


@pytest.mark.long
def test_runs_have_derivatives_with_every_effect():
    """Forwards, by all that all effects have, on the way from parameters to what sensors show: finite from everywhere
    a ship can be, and off the special places those of central differences.
    """
    model = Model(with_effects(load_profile("suzaku"), STRONG, "test"))
    approach, around, steps = model.profile.approach, surrounded(3), 3
    base = model.base.copy()
    base[[row for name, row in model.rows.items() if name.endswith(".measured")]] = 0.9  # at 0 they jump
    initial = np.array([0.0, 0.0, 0.4, 0.9 * approach.speed, 0.2, 0.01])
    control = np.array([1.1 * approach.n, 0.21])
    states, controls = special(model)
    run = few_steps(model, EULER, around, steps)
    by_lane = jax.jit(jax.vmap(jax.jacfwd(run, argnums=(0, 1, 2)), in_axes=(None, 0, 0)), compiler_options=QUICK)
    everywhere = by_lane(base, np.vstack([states, initial]), np.vstack([controls, control]))
    assert finite(everywhere)
    found = [one[-1] for one in everywhere]
    t = 0.7 * np.arange(steps + 1.0)

    def on_numpy(values):
        """(T - 1, 6, n_lanes): the reference, candidate by candidate where inputs and start differ too."""
        rows = len(model.rows)
        theta = model.matrix(tuple(model.rows), values[:rows])
        shown = []
        for k in range(values.shape[1]):
            inputs = values[rows + 6 :, k] * np.linspace(1.0, 1.1, steps + 1)[:, None]
            cases = pad([t], [inputs], [values[rows : rows + 6, k]], around=[around[:, 0]])
            result = get_backend("numpy").run(model, theta[:, [k]], cases, integrator=EULER, keep_states=True)
            shown.append(result.states[0, 0, 1:])
        return np.stack(shown, axis=-1)

    values = np.concatenate([base, initial, control])
    expected, rounding = differences(on_numpy, values, approach.speed * t[-1])
    derivatives = np.moveaxis(np.concatenate([np.asarray(one) for one in found], axis=2), 2, 0)
    close(names_of(model), derivatives, expected, rounding)


@pytest.mark.long
def test_a_clock_at_a_sample_has_the_mean_of_two_slopes(suzaku):
    """A clock offset of nothing looks at the log where its slope changes: what a central difference sees there."""
    model = Model(with_effects(suzaku.profile, {"clock-offset": {}}, "test"))
    name, cases = "effects.clock-offset.seconds", zigzag_like(suzaku, 6)
    cases.initial[0, 4:] = -0.3, 0.01  # rudders have a bend where the ship goes straight

    def J(seconds):
        theta = matrix_of(model, [name])(seconds[None])[:, None]
        log = Log(cases.t.T, cases.n_samples, cases.controls.swapaxes(0, 1), cases.around.swapaxes(0, 1))
        return rollout(model, theta, cases.initial, log, integrator=EULER)[-1, 0]

    def on_numpy(seconds):
        theta = model.matrix([name], [[seconds]])
        result = get_backend("numpy").run(model, theta, cases, integrator=EULER, keep_states=True)
        return result.states[0, 0, -1]

    expected = (on_numpy(1e-4) - on_numpy(-1e-4)) / 2e-4
    assert np.allclose(jax.jit(jax.jacfwd(J))(np.array(0.0)), expected, rtol=1e-6, atol=1e-8)


@pytest.mark.long
def test_something_learnt_may_stand_beside_the_rates(suzaku):
    """``by`` takes the place of the rates: here those of the model, and a constant acceleration of 0.01 m/s^2."""
    cases = turn(suzaku, 0.0, 20.0)
    log = Log(cases.t.T, cases.n_samples, cases.controls.swapaxes(0, 1), cases.around.swapaxes(0, 1))

    def run(by):
        return np.asarray(rollout(suzaku, suzaku.matrix(), cases.initial, log, integrator=EULER, by=by))

    def pushed(ship):
        def rates(s, control, around, h):
            x, y, psi, u, v_m, r = ship.rates(s, control, around, h)
            return x, y, psi, u + 0.01, v_m, r

        return rates

    plain, more = run(None), run(pushed)
    assert more[1, 0, 3] - plain[1, 0, 3] == pytest.approx(0.01, rel=1e-9)
    assert np.array_equal(run(lambda ship: ship.rates), plain)


# ------------------------------------------------------------------------------------------------------- twins

FACTOR = 2.0


def even(n):
    return True if n == 0 else odd(n - 1)


def odd(n):
    return False if n == 0 else even(n - 1)


def of_a_module(x):
    return elementary.sin(FACTOR * x) + np.linalg.norm(x)


def closing(inner):
    def outer(x):
        return inner(x) + x

    return outer


def scaled(x, by):
    return elementary.cos(by * x)


def test_twins_of_functions_of_all_kinds():
    x = np.array([0.3, 0.4])

    def traced(function):
        return np.asarray(jax.jit(twin(function))(x))

    np.testing.assert_allclose(traced(of_a_module), np.sin(2.0 * x) + 0.5, rtol=1e-14)
    np.testing.assert_allclose(traced(closing(elementary.exp)), np.exp(x) + x, rtol=1e-14)
    np.testing.assert_allclose(traced(functools.partial(scaled, by=3.0)), np.cos(3.0 * x), rtol=1e-14)
    np.testing.assert_allclose(traced(closing(functools.partial(scaled, by=3.0))), np.cos(3.0 * x) + x, rtol=1e-14)
    assert twin(even)(10)
    assert not twin(even)(7)
    assert twin(of_a_module) is twin(of_a_module)
    assert twin(even).__globals__["odd"].__globals__["even"] is twin(even)
    assert kinematics.np is np  # what was rebuilt is left as it was


@pytest.mark.parametrize("zero", [0.0, -0.0])
def test_angles_and_speeds_at_rest(zero):
    flow = twin(kinematics.flow)
    assert flow(zero, 0.0, 0.0, 83.0).beta == kinematics.flow(zero, 0.0, 0.0, 83.0).beta
    assert finite(jax.jacrev(lambda u, v: tuple(flow(u, v, 0.0, 83.0)), argnums=(0, 1))(zero, 0.0))
    with jax.enable_x64(False):  # squares of small numbers vanish there
        assert finite(jax.grad(lambda u: flow(u, u, 0.0, 83.0).beta)(np.float32(1e-25)))


def test_what_is_compiled_is_kept_beside_the_kernels(tmp_path):
    """In a process of its own, which imports JAX through the program; a setting of one's own counts."""
    import os
    import subprocess
    import sys

    text = "from mmgtune.backends.twins import jax_module; print(jax_module().config.jax_compilation_cache_dir)"
    usual = {k: v for k, v in os.environ.items() if not k.startswith("JAX_")} | {"MMGTUNE_CACHE": str(tmp_path)}
    for more, folder in (({}, tmp_path / "kernels" / "jax"), ({"JAX_COMPILATION_CACHE_DIR": "mine"}, "mine")):
        command = [sys.executable, "-c", text]
        found = subprocess.run(command, env=usual | more, capture_output=True, text=True, check=True)
        assert found.stdout.strip() == str(folder)


def test_without_jax(monkeypatch, suzaku):
    monkeypatch.setitem(sys.modules, "jax", None)
    _made.cache_clear()
    try:
        with pytest.raises(OptionError, match=r"pip install 'mmgtune\[learn\]'"):
            get_backend("jax")
        from tests.command import typed

        ended = typed("validate", "suzaku", "suzaku", "--backend", "jax")
        assert ended.code == 2
        assert "pip install 'mmgtune[learn]'" in ended.err
        assert "Traceback" not in ended.err
    finally:
        _made.cache_clear()
