"""Logs that are off in single runs: told apart from noise, and from what moves the ship."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune import DiagnoseOptions, diagnose, load_trials
from mmgtune.backends import STATES, Integrator
from mmgtune.diagnose.evidence.misread import LeftOut, both, in_words, is_of_few, misread_in, slow, without
from mmgtune.diagnose.evidence.odd_runs import off_track_in, put_right, turned_in, with_rudders_turned
from mmgtune.diagnose.folder import write_diagnosis
from mmgtune.effects import find_effect
from mmgtune.motions import simulate_trials
from mmgtune.profile import load_profile
from mmgtune.trial import check_trials
from mmgtune.trial.checks.control_checks import RUDDER_SIGN
from mmgtune.trial.checks.set_checks import found_in
from mmgtune.units import DEG
from tests.diagnose.sensors import NOISE, logged

TRIALS = [*load_trials("suzaku").trials.values()][:5]


def seen(change=lambda k, name, values: values, noise=1.0):
    """Trials as sensors show them, and what a model that is right leaves; of each run by ``change`` before noise."""
    rng = np.random.default_rng(1)
    trials, residuals = [], []
    for k, trial in enumerate(TRIALS):
        clean = trial.motion
        shown = np.column_stack([change(k, name, clean[:, i].copy()) for i, name in enumerate(STATES)])
        shown = shown + noise * NOISE * rng.standard_normal(shown.shape)
        trials.append(replace(trial, **dict(zip(STATES, shown.T, strict=True))))
        residuals.append(clean - shown)
    return trials, residuals, NOISE


def of_run(k, name, change):
    """A change of one channel of one run."""
    return lambda i, channel, values: change(values) if (i, channel) == (k, name) else values


@pytest.mark.parametrize(
    ("name", "change", "factor"),
    [
        ("r", lambda r: -r, -1.0),
        ("v_m", lambda v: 0.0 * v, 0.0),
        ("r", lambda r: 1.3 * r, 1.3),
        ("u", lambda u: 0.9 * u, 0.9),
    ],
)
def test_a_log_that_is_wrong_in_one_run_is_told_with_its_factor(name, change, factor):
    found = misread_in(*seen(of_run(2, name, change)))
    assert list(found) == [name]
    assert found[name] == {TRIALS[2].id: pytest.approx(factor, abs=0.03)}


def test_a_log_that_stood_still_from_some_time_on_is_told_without_a_factor():
    def stuck(u):
        return np.where(np.arange(len(u)) > len(u) // 3, u[0], u)

    found = misread_in(*seen(of_run(1, "r", lambda r: r + 3.0 * DEG * np.sin(np.linspace(0.0, 40.0, len(r))))))
    assert found == {"r": {TRIALS[1].id: None}}
    assert list(misread_in(*seen(of_run(0, "u", stuck)))) == ["u"]


def test_another_scale_from_run_to_run_is_told():
    factors = [1.0, 1.4, 0.6, 0.7, 1.8]
    found = misread_in(*seen(lambda k, name, values: factors[k] * values if name == "r" else values))
    told = {one.id: pytest.approx(by, abs=0.03) for one, by in zip(TRIALS, factors, strict=True) if by != 1.0}
    assert found == {"r": told}
    of_all = "the log of the yaw rate shows 0.60 to 1.80 times the motion that all else shows in 4 runs"
    assert in_words(found) == of_all
    assert not is_of_few(found, len(TRIALS))


@pytest.mark.parametrize(
    "change",
    [
        lambda k, name, values: values,
        of_run(3, "v_m", lambda v: v + 0.2 * np.random.default_rng(4).standard_normal(len(v))),  # white: a loose plug
        lambda k, name, values: 1.02 * values,
        lambda k, name, values: 1.3 * values if name == "r" else values,  # of a sensor
        lambda k, name, values: values + (k == 2) * 30.0 * NOISE[STATES.index(name)],  # all else says the same
        lambda k, name, values: values + (name == "u") * slowly(len(values), k),  # of a sensor, in all runs
        lambda k, name, values: np.full_like(values, np.nan) if name == "v_m" else values,
        lambda k, name, values: values + 0.1 if name == "v_m" else values,  # a log with a zero error, in all runs
    ],
    ids=["nothing", "white noise", "a little", "a scale", "all channels", "slow noise", "not measured", "a zero"],
)
def test_noise_and_what_moves_the_ship_are_no_misread_logs(change):
    assert misread_in(*seen(change)) == {}


def slowly(n, seed):
    """Noise that fades in 20 samples, five times the white one of u."""
    white, found = np.random.default_rng(seed).standard_normal(n), np.zeros(n)
    for k in range(1, n):
        found[k] = 0.95 * found[k - 1] + np.sqrt(1.0 - 0.95**2) * white[k]
    return 5.0 * NOISE[STATES.index("u")] * found


def test_what_is_slow_is_counted_beyond_white_noise_of_its_own():
    white = np.random.default_rng(0).standard_normal((4000, 2))
    white[:, 1] += 3.0
    np.testing.assert_allclose(slow(white, np.ones(2)), [0.0, 3.0], atol=0.3)
    assert slow(np.full((9, 1), np.nan), np.ones(1)) == 0.0
    assert slow(np.ones((9, 1)), np.zeros(1)) == 0.0


@pytest.mark.parametrize(("factor", "first"), [(0.5, 2.0), (0.0, 1.0), (None, 1.0), (-1.0, -1.0)])
def test_what_is_misread_is_left_out_but_for_where_it_begins(factor, first):
    trial = replace(TRIALS[0], u=np.ones(TRIALS[0].n_samples))
    right = without(trial, {"u": {trial.id: factor}, "r": {"another": -1.0}})
    assert right.u[0] == first
    assert np.isnan(right.u[1:]).all()
    assert np.array_equal(right.r, trial.r)
    assert without(trial, {}) is trial
    assert np.isnan(without(trial, {"v_m": {trial.id: factor}}).v_m[1:]).all()


def test_factors_are_by_the_motion_that_was_fitted_to_all_else():
    trial = TRIALS[0]
    gone = LeftOut(
        {"r": {trial.id: 1.13, "elsewhere": 0.9}, "u": {trial.id: None}}, {trial.id: trial, "elsewhere": trial}
    )
    of_all = gone.as_all_else_shows({trial.id: trial.motion / 1.3})
    assert of_all == {"r": {trial.id: pytest.approx(1.3), "elsewhere": 0.9}, "u": {trial.id: None}}
    assert gone.as_all_else_shows({trial.id: trial.motion[1:]}) == gone.misread  # in parts
    before = LeftOut({"v_m": {"first": -1.0}, "r": {"first": 2.0}}, {"first": trial})
    both = gone.beside(before)
    assert both.misread == {"u": {trial.id: None}, "v_m": {"first": -1.0}, "r": {**gone.misread["r"], "first": 2.0}}
    assert list(both.trials) == [trial.id, "elsewhere", "first"]
    assert gone.beside(None) is gone


@pytest.mark.parametrize(("runs", "few"), [(1, True), (2, True), (3, False)])
def test_the_others_show_what_is_right(runs, few):
    of_runs = dict.fromkeys("abc"[:runs], -1.0)
    assert is_of_few({"r": of_runs, "u": {"a": 0.9}}, 5) is few
    assert not is_of_few({}, 5)


@pytest.mark.parametrize(
    ("runs", "said"),
    [
        ({"a": -1.02}, "the log of the sway velocity shows -1.02 times the motion that all else shows in a"),
        ({"a": -0.001}, "the log of the sway velocity shows 0.00 times the motion that all else shows in a"),
        ({"a": None, "b": None}, "the log of the sway velocity shows another motion than all else in a and b"),
        (dict.fromkeys("abcd"), "the log of the sway velocity shows another motion than all else in 4 runs"),
    ],
)
def test_what_is_said(runs, said):
    assert in_words({"v_m": runs}) == said
    assert in_words({}) == ""


@pytest.mark.parametrize("offset", [0.0, 2.0 * DEG])
def test_the_answer_names_the_log_and_the_run(offset, tmp_path):
    """ "Nothing is wrong" was said of a run whose yaw rate had the other sign, as noise that fades slowly."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(3)
    sailed = simulate_trials(
        profile, [replace(one, delta=one.delta + offset) for one in TRIALS], integrator=Integrator("rk4")
    )
    made = [logged(trial, motion, rng) for trial, motion in zip(TRIALS, sailed, strict=True)]
    made[1] = replace(made[1], r=-made[1].r)
    asked = DiagnoseOptions(effects=("rudder-offset",), targets=("hull.R_0",), leeway=0.0)
    result = diagnose(profile, made, asked)
    shown = f"the log of the yaw rate shows -1.00 times the motion that all else shows in {made[1].id}"
    assert result.to_dict()["unexplained"]["misread"] == {"r": {made[1].id: pytest.approx(-1.0, abs=0.05)}}
    if offset:
        assert [cause.effect for cause in result.causes] == [find_effect("rudder-offset")]
        assert result.verdict == "found"
        assert result.sentence().startswith(f"T{shown[1:]}. Apart from that: The rudder")
    else:
        assert result.verdict == "unexplained"
        fits = "Without that log all others are fitted to the noise of the measurements."
        assert result.sentence() == f"Something is wrong with a sensor, and no known cause shows: {shown}. {fits}"
    document = write_diagnosis(result, tmp_path / "run")
    assert document["verdict"] == result.verdict


def sailed_with(turned, offset=0.0):
    """Runs of the ship, some of whose rudder angles have the other sign."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(4)
    run = [replace(one, delta=one.delta + offset) for one in TRIALS]
    sailed = simulate_trials(profile, run, integrator=Integrator("rk4"))
    made = [logged(trial, motion, rng) for trial, motion in zip(TRIALS, sailed, strict=True)]
    return profile, {one.id: with_rudders_turned(one) if k in turned else one for k, one in enumerate(made)}


@pytest.mark.parametrize(("turned", "told"), [([], []), ([1], [1]), ([1, 3], [1, 3]), ([0, 1, 3], [])])
def test_rudders_of_another_sign_are_those_that_tell_the_run_turned_round(turned, told):
    profile, trials = sailed_with(turned)
    ids = list(trials)
    doubtful = [ids[k] for k in turned]
    assert list(found_in(check_trials(trials, profile.L_pp), RUDDER_SIGN)) == doubtful
    assert turned_in(profile, trials, doubtful) == [ids[k] for k in told]


def test_a_ship_that_something_else_turns_away_has_no_other_sign():
    """The yaw moment of a bank outweighs that of the rudder: turned round it tells more, not all of it."""
    profile, trials = sailed_with([1])
    of_bank = trials[TRIALS[1].id]
    off = 0.2 * (of_bank.r.max() - of_bank.r.min())
    shown = {**trials, of_bank.id: replace(of_bank, r=of_bank.r + off, v_m=of_bank.v_m - 20.0 * off)}
    assert turned_in(profile, shown, [of_bank.id]) == []
    right = with_rudders_turned(of_bank)
    assert turned_in(profile, {**trials, right.id: replace(right, r=-right.r)}, [right.id]) == []  # of the yaw rate


def test_a_run_that_is_told_as_logged_has_no_other_sign_however_badly_others_are_told():
    profile, trials = sailed_with([])
    ids = list(trials)
    lost = {id: replace(trial, x=1e3 * trial.x, y=1e3 * trial.y) for id, trial in trials.items() if id != ids[1]}
    assert turned_in(profile, {**trials, **lost}, [ids[1]]) == []


def test_all_rudders_are_turned_and_nothing_else():
    trial = replace(TRIALS[0], extra={"delta_port": TRIALS[0].delta + 1.0, "wind_speed": TRIALS[0].n})
    turned = with_rudders_turned(trial)
    for name, values in trial.columns.items():
        sign = -1.0 if name.startswith("delta") else 1.0
        assert np.array_equal(turned.columns[name], sign * values, equal_nan=True)


def in_feet(trial):
    """Positions in another unit."""
    return replace(trial, x=3.28 * trial.x, y=3.28 * trial.y)


def of_antenna(trial):
    """Positions of a point 60 m aft of midship, which a turn shows much more of than a zigzag."""
    return replace(trial, x=trial.x - 60.0 * np.cos(trial.psi), y=trial.y - 60.0 * np.sin(trial.psi))


def adrift(trial):
    """Positions that leave the way, by no factor."""
    bent = 40.0 * np.sin(0.05 * trial.t) * np.arange(trial.n_samples) / 20.0
    return replace(trial, x=trial.x + bent, y=trial.y - bent[::-1])


@pytest.mark.parametrize(
    ("change", "runs", "told"),
    [
        (in_feet, [2], {2: 3.28}),
        (in_feet, [2, 4], {2: 3.28, 4: 3.28}),
        (in_feet, [0, 2, 4], {}),  # which are right?
        (adrift, [1], {1: None}),
        (of_antenna, [1], {}),
        (lambda trial: replace(trial, x=1.01 * trial.x), [1], {}),  # hardly
        (lambda trial: replace(trial, v_m=-trial.v_m), [1], {}),  # the log of the sway velocity it is
        (lambda trial: replace(in_feet(trial), u=3.28 * trial.u), [1], {}),  # positions are not alone
    ],
    ids=["one", "two", "most", "no factor", "an antenna", "little", "another log", "two logs"],
)
def test_positions_that_alone_are_far_off_in_single_runs_are_told(change, runs, told):
    profile, trials = sailed_with([])
    ids = list(trials)
    made = {id: change(trial) if k in runs else trial for k, (id, trial) in enumerate(trials.items())}
    found = off_track_in(profile, made, [ids[k] for k in runs])
    assert found == {ids[k]: None if by is None else pytest.approx(by, rel=0.01) for k, by in told.items()}
    assert off_track_in(profile, made, []) == {}


def test_what_is_put_right_is_what_is_told():
    profile, trials = sailed_with([1])
    ids = list(trials)
    made = {**trials, ids[3]: in_feet(trials[ids[3]])}
    right, misread = put_right(profile, made, [ids[1]], [ids[3]])
    assert misread == {"delta": {ids[1]: -1.0}, "position": {ids[3]: pytest.approx(3.28, rel=0.01)}}
    assert np.array_equal(right[ids[1]].delta, -made[ids[1]].delta)
    assert np.isnan(right[ids[3]].x[1:]).all()
    assert np.isnan(right[ids[3]].y[1:]).all()
    assert right[ids[0]] is made[ids[0]]
    words = in_words(misread)
    assert "; the log of the position shows 3.2" in words
    assert words.endswith(f" times the motion that all else shows in {ids[3]}")
    assert put_right(profile, made, [], []) == (made, {})


@pytest.mark.parametrize("offset", [0.0, 2.0 * DEG])
def test_the_answer_says_that_a_rudder_was_put_right(offset, tmp_path):
    profile, trials = sailed_with([2], offset)
    asked = DiagnoseOptions(effects=("rudder-offset",), targets=("hull.R_0",), leeway=0.0)
    result = diagnose(profile, [*trials.values()], asked)
    turned = TRIALS[2].id
    assert result.to_dict()["unexplained"]["misread"] == {"delta": {turned: -1.0}}
    shown = f"rudder angle is logged with the other sign in {turned}, and taken with that of all other runs"
    if offset:
        assert [cause.effect for cause in result.causes] == [find_effect("rudder-offset")]
        assert result.sentence().startswith(f"The {shown}. Apart from that: The rudder")
    else:
        assert result.verdict == "unexplained"
        fits = "With that put right all logs are fitted to the noise of the measurements."
        assert result.sentence() == f"Something is wrong with a sensor, and no known cause shows: the {shown}. {fits}"
    assert write_diagnosis(result, tmp_path / "run")["unexplained"]["misread"] == {"delta": {turned: -1.0}}


def test_rudders_are_told_before_logs_of_the_motion():
    of_both = both({"r": {"a": 2.0}}, {"delta": {"b": -1.0}, "r": {"c": None}})
    assert [*of_both] == ["delta", "r"]
    assert of_both["r"] == {"a": 2.0, "c": None}
    told = "the rudder angle is logged with the other sign in 4 runs, and taken with that of all other runs"
    assert in_words({"delta": dict.fromkeys("abcd", -1.0)}) == told
