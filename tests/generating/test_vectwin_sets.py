"""Trials made of the VecTwin model: what the paper asks for, the same from the same seed, and true to the model."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.errors import OptionError, OutputError
from mmgtune.generating import make_trials, sets, writing
from mmgtune.generating.pilot import Berthing, Joystick
from mmgtune.model import Model
from mmgtune.motions import simulate_trials
from mmgtune.options import MakeOptions
from mmgtune.profile import load_profile
from mmgtune.trial import check_trials, load_trials
from mmgtune.units import DEG
from tests.command import run

FEW = {"train-b": 27 * 40, "test-b": 14 * 30, "test-zt": 12 * 40, "test-r": 10 * 45}
"""Seconds of all trials of a set together, so that tests are quick."""

AS_PUBLISHED = dict(sets.PLANS)


@pytest.fixture(scope="module", autouse=True)
def _short():
    """Short trials, as long at either scale."""
    with pytest.MonkeyPatch.context() as patch:
        for name, plan in sets.PLANS.items():
            total = {"model": FEW[name], "full": FEW[name]}
            patch.setitem(sets.PLANS, name, replace(plan, total=total))
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """All sets, logged at every step."""
    out = tmp_path_factory.mktemp("made")
    make_trials("vectwin", out, MakeOptions(sample=0.1))
    return out


def test_sets_are_those_of_the_paper():
    """Table 4, and table 6 for the full scale."""
    assert {name: plan.total["model"] for name, plan in AS_PUBLISHED.items()} == {
        "train-b": 4770, "test-b": 2304, "test-zt": 2400, "test-r": 2000
    }  # fmt: skip
    assert (AS_PUBLISHED["train-b"].total["full"], AS_PUBLISHED["test-b"].total["full"]) == (32180, 16230)
    assert [len(plan.ids) for plan in AS_PUBLISHED.values()] == [27, 14, 12, 10]
    durations = AS_PUBLISHED["train-b"].durations("model", np.random.default_rng(1))
    assert durations.sum() == 4770
    assert durations.min() > 0.6 * 4770 / 27
    assert {*AS_PUBLISHED["train-b"].ids}.isdisjoint(AS_PUBLISHED["test-b"].ids)


@pytest.mark.daily("test-b")
@pytest.mark.parametrize("name", sets.PLANS)
def test_every_set_can_be_read_and_says_what_it_is(folder, name):
    shown, true = load_trials(folder / name), load_trials(folder / name / "truth")
    assert [*shown.trials] == [*true.trials]
    assert shown.ship == true.ship == "vectwin_3m"
    for one in shown.trials.values():
        assert one.source == "generated"
        assert one.noise == pytest.approx({"u": 0.01, "v": 0.01, "r": 0.1 * DEG})
        assert "Generated, not measured" in one.note
        assert {"delta_port", "delta_stbd", "n_bow", "wind_speed", "wind_dir"} <= set(one.extra)
        assert (one.n == 10.0).all()
    assert all(one.noise == {} for one in true.trials.values())
    doubts = [finding.what for found in check_trials(shown.trials).values() for finding in found]
    if not name.endswith("-b"):  # berthing in 40 s is none
        assert not any("turns away" in what for what in doubts)


def test_noise_is_as_large_as_it_says_and_nothing_else_differs(folder):
    shown, true = load_trials(folder / "train-b"), load_trials(folder / "train-b" / "truth")
    off = np.vstack([shown.trials[id].motion - one.motion for id, one in true.trials.items()])
    assert np.abs(off[:, :3]).max() == 0.0
    assert off[:, 3:].std(axis=0) == pytest.approx([0.01, 0.01, 0.1 * DEG], rel=0.03)
    assert np.abs(off[:, 3:].mean(axis=0) / off[:, 3:].std(axis=0)).max() < 0.05
    for id, one in true.trials.items():
        assert all(np.array_equal(shown.trials[id].extra[key], one.extra[key]) for key in one.extra)


@pytest.mark.long
@pytest.mark.parametrize("name", sets.PLANS)
def test_the_truth_is_the_profile(folder, name):
    """Simulated with the logged inputs and the logged wind, trials come out as they are."""
    ship = load_profile("vectwin_3m")
    trials = [*load_trials(folder / name / "truth").trials.values()]
    for trial, motion in zip(trials, simulate_trials(ship, trials), strict=True):
        assert np.abs(motion.states - trial.motion).max() < 1e-9


def test_actuators_keep_their_limits_and_rates(folder):
    for name in sets.PLANS:
        for trial in load_trials(folder / name).trials.values():
            for column, low, high, rate in (
                ("delta_port", -105 * DEG, 35 * DEG, 20 * DEG),
                ("delta_stbd", -35 * DEG, 105 * DEG, 20 * DEG),
                ("n_bow", -30.0, 30.0, 20.0),
            ):
                values = trial.extra[column]
                assert low - 1e-9 <= values.min()
                assert values.max() <= high + 1e-9
                assert np.abs(np.diff(values)).max() <= rate * 0.1 * (1.0 + 1e-9)


def test_manoeuvres_are_what_they_are_called(folder):
    trials = load_trials(folder / "test-zt" / "truth").trials
    for k in sets.ANGLES:
        turn, zigzag = trials[f"t{k:02d}"], trials[f"z{k:02d}"]
        assert turn.delta[-1] == pytest.approx(k * DEG)
        assert (turn.extra["wind_speed"] == 0.0).all()
        assert turn.psi[-1] > turn.psi[0]
        assert set(np.round(zigzag.delta / DEG)) >= {0.0, float(k)}
    assert {-10.0, 10.0} <= set(np.round(trials["z10"].delta / DEG))
    drawn = np.vstack([one.extra["delta_port"] for one in load_trials(folder / "test-r" / "truth").trials.values()])
    assert np.median(drawn) == pytest.approx(-80.0 * DEG, abs=12.0 * DEG)


@pytest.mark.long
def test_pilots_stop_their_ships():
    """At the end of the whole time the ships lie nearly still, wherever they began; they hover and use the thruster."""
    model = Model(load_profile("vectwin_3m"))
    plan = replace(sets.PLANS["test-b"], ids=("b1", "b2", "b3", "b4"), total={"model": 720, "full": 5000})
    found, _ = sets.sailed(model, plan, MakeOptions(wind="none"), 1.0)
    first, last = found.states[0], found.states[140]
    assert (first[3] > 0.3).all()
    assert np.abs(last[3]).max() < 0.1
    assert np.abs(found.controls[-30:, 1]).max() > 60.0 * DEG
    assert np.abs(found.controls[:, 3]).max() >= 8.0


def test_joysticks_give_what_is_asked():
    model = Model(load_profile("vectwin_3m"))
    stick = Joystick(model)
    u, X, N = np.zeros(3), np.array([0.0, 0.0, 1.5]), np.array([0.0, 1.0, 0.0])
    port, stbd = stick.pick(u, X, N, np.zeros(3), np.array([[-75.0] * 3, [75.0] * 3]) * DEG)
    k = [int(np.flatnonzero((stick.port == a) & (stick.stbd == b))[0]) for a, b in zip(port, stbd, strict=True)]
    assert stick.X[0, k] == pytest.approx(X, abs=0.4)
    assert stick.N[0, k] == pytest.approx(N, abs=0.4)
    assert (stick.port <= stick.stbd + 1e-9).all()


def test_the_same_seed_makes_the_same_whatever_else_is_made(folder, tmp_path):
    make_trials("vectwin", tmp_path / "again", MakeOptions(sets=("test-r",), sample=0.1))
    make_trials("vectwin", tmp_path / "other", MakeOptions(sets=("test-r",), sample=0.1, seed=2))
    first, again, other = (
        load_trials(place / "test-r").trials["r03"].motion for place in (folder, tmp_path / "again", tmp_path / "other")
    )
    assert np.array_equal(first, again)
    assert np.abs(first - other).max() > 0.1


@pytest.mark.long
def test_samples_of_a_second_are_those_of_every_step(folder, tmp_path):
    make_trials("vectwin", tmp_path, MakeOptions(sets=("test-r",)))
    fine, coarse = load_trials(folder / "test-r" / "truth"), load_trials(tmp_path / "test-r" / "truth")
    for id, trial in coarse.trials.items():
        assert np.array_equal(trial.motion, fine.trials[id].motion[::10])


def test_the_ship_at_full_scale_is_her_own_profile(tmp_path):
    """Speeds times the root of 50, noise of table 5; trials come out of the profile that lies beside them."""
    made = make_trials("vectwin", tmp_path, MakeOptions(sets=("test-r",), scale="full"))
    ship = load_profile(made.profile)
    assert ship.L_pp == 150.0
    assert ship.actuators["delta_port"].rate == pytest.approx(20.0 * DEG / 50.0**0.5)
    true, shown = load_trials(tmp_path / "test-r" / "truth"), load_trials(tmp_path / "test-r")
    assert true.ship == ship.id == "vectwin_150m"
    trials = [*true.trials.values()]
    for trial, motion in zip(trials, simulate_trials(ship, trials), strict=True):
        assert np.abs(motion.states - trial.motion).max() < 1e-8
    assert next(iter(shown.trials.values())).noise["r"] == pytest.approx(0.01 * DEG)
    assert max(one.u[0] for one in trials) <= 0.3 * 50.0**0.5


@pytest.mark.long
def test_wind_where_it_is_asked_for(tmp_path):
    make_trials("vectwin", tmp_path / "all", MakeOptions(sets=("test-zt",), wind="all"))
    make_trials("vectwin", tmp_path / "none", MakeOptions(sets=("test-r",), wind="none"))
    windy, calm = load_trials(tmp_path / "all" / "test-zt"), load_trials(tmp_path / "none" / "test-r")
    assert all(one.extra["wind_speed"].std() > 0.0 for one in windy.trials.values())
    assert all(one.extra["wind_speed"].max() == 0.0 for one in calm.trials.values())


def test_nothing_is_overwritten_and_unknown_ships_are_refused(tmp_path):
    (tmp_path / "test-r").mkdir()
    with pytest.raises(OutputError, match="exists already"):
        make_trials("vectwin", tmp_path, MakeOptions(sets=("test-r",)))
    with pytest.raises(OptionError, match="vectwin"):
        make_trials("vectwn", tmp_path)
    with pytest.raises(OptionError, match="unknown set"):
        MakeOptions(sets=("train",))
    assert set(writing.SHIPS) == {"vectwin"}


def test_plans_of_pilots_differ():
    model = Model(load_profile("vectwin_3m"))
    rng = np.random.default_rng(1)
    pilot = Berthing(model, rng, np.full(20, 170.0), np.zeros(20))
    headings = pilot.psi_plan[-1]
    assert np.ptp(headings) > 1.0
    assert (np.diff(pilot.times, axis=0) > 0.0).all()


def test_the_command(tmp_path):
    ended = run("trials", "make", "vectwn", "--out", "made", cwd=tmp_path)
    assert ended.code == 2
    assert "did you mean 'vectwin'?" in ended.err
    ended = run("trials", "make", "vectwin", "--out", "made", "--sets", "nothing", cwd=tmp_path)
    assert (ended.code, "unknown set 'nothing' (--sets)" in ended.err) == (2, True)
    assert not (tmp_path / "made").exists()
