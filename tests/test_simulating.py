"""What ``simulate`` says and writes: of each member by its own coefficients, and of what has no end."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

import mmgtune
from mmgtune.errors import OptionError
from mmgtune.motions import Motion, as_trial, breakdown
from mmgtune.options import SimulateOptions
from mmgtune.predictor import PhysicsPredictor
from mmgtune.profile import with_effects
from mmgtune.resources import folder
from mmgtune.stated_indices import compare_stated
from mmgtune.trial import TrialSet
from mmgtune.trial.index_trial import IndexTrial, Stated
from tests.command import typed

TURN = mmgtune.load_trials("suzaku")["turn_p35"]


@pytest.fixture(scope="module")
def otherwise(suzaku):
    """The profile's own coefficients and, second, another damping of the yaw rate."""
    theta = np.repeat(suzaku.matrix(), 2, axis=1)
    theta[suzaku.rows["hull.N_r"], 1] *= 1.5
    return PhysicsPredictor(suzaku, theta)


@pytest.fixture(scope="module")
def lost(suzaku):
    """A ship that leaves the world of ships as soon as she drifts."""
    theta = suzaku.matrix()
    theta[suzaku.rows["hull.X_vvvv"]] = 1e9
    return PhysicsPredictor(suzaku, theta)


def test_forces_are_those_of_the_member(suzaku, otherwise):
    own, other = mmgtune.simulate(otherwise, TURN).motions
    written = as_trial(otherwise, other, with_forces=True)
    forces = breakdown(suzaku, other.states, other.controls, other.around, otherwise.theta[:, 1])
    assert np.array_equal(written.extra["hull_N"], forces.hull.N)
    assert not np.allclose(forces.hull.N, breakdown(suzaku, other.states, other.controls, other.around).hull.N)
    assert written.note.endswith(", with other coefficients.")
    assert as_trial(otherwise, own).note == as_trial(suzaku.profile, own).note


def test_stated_indices_are_held_against_the_coefficients_of_the_predictor(suzaku, otherwise):
    stated = {"advance": Stated(200.0, 5.0)}
    trial = IndexTrial("delivery", "suzaku", "turning", math.radians(35.0), None, None, stated)
    data = TrialSet({}, (), (), "", stated={trial.id: trial}, tune_stated=(trial.id,))
    ship = replace(otherwise, theta=otherwise.theta[:, 1:])
    (said,) = mmgtune.validate([ship], data).profiles[0].stated
    (right,) = compare_stated(suzaku, {"simulated": ship.theta[:, 0]}, [trial], {trial.id: "tune"})
    (usual,) = compare_stated(suzaku, {"simulated": suzaku.matrix()[:, 0]}, [trial], {trial.id: "tune"})
    assert said.simulated == right.simulated != usual.simulated
    checked = mmgtune.record_baseline(ship, data, ("advance",))
    assert checked.trials[trial.id].metrics["advance"] == pytest.approx(
        100.0 * (right.simulated["simulated"] / right.stated - 1.0)
    )
    assert checked.coefficients == {}  # they are not the profile's


def test_a_check_is_of_one_member(otherwise):
    with pytest.raises(OptionError, match="2 parameter vectors"):
        mmgtune.record_baseline(otherwise, "suzaku")


def test_criteria_of_a_zigzag_are_those_of_its_order(suzaku):
    rows = {row["id"]: row for row in mmgtune.simulate("suzaku", "suzaku").rows()}
    assert [one["name"] for one in rows["zigzag_20"]["criteria"]] == ["first overshoot 20/20"]
    names = [one["name"] for one in rows["zigzag_10"]["criteria"]]
    assert names == ["initial turning distance", "first overshoot 10/10", "second overshoot 10/10"]
    assert all(one["passed"] is not None for one in rows["zigzag_10"]["criteria"])


def test_what_the_steering_gear_and_formulas_do_not_reach_is_said():
    """A turn of 45 deg was that of 35 deg, without a word."""
    ship = mmgtune.load_profile("suzaku")
    gear = replace(ship, steering_gear=replace(ship.steering_gear, max_angle=math.radians(35.0)))
    made = mmgtune.simulate(gear, options=SimulateOptions(turn=("45", "-20"), zigzag=("50/20",)))
    (note,) = made.notes
    assert note == "turn_p45, zigzag_p50_20: the rudder stops at 35 deg, where the steering gear of the ship ends"
    assert not mmgtune.simulate(gear, options=SimulateOptions(turn=("35",))).notes
    shallow = with_effects(ship, {"shallow-water": {"depth": 1.1 * ship.value("particulars.d")}}, "a test")
    (note,) = mmgtune.simulate(shallow, options=SimulateOptions(turn=("20",))).notes
    assert note.startswith("water is down to 1.1 draughts deep, and the formulas of shallow water hold down to")


def test_a_start_from_rest_is_judged_by_nothing(suzaku):
    rest = replace(TURN, u=np.zeros(TURN.n_samples), v_m=np.zeros(TURN.n_samples))
    approach = replace(suzaku.profile, approach=None)
    (row,) = mmgtune.simulate(approach, [rest]).rows()
    assert {one["reason"] for one in row["criteria"]} == {"the test speed is 0"}
    assert mmgtune.repeat("suzaku", [rest, TURN])[0].id == TURN.id


def test_what_diverged_is_not_written(suzaku, lost, tmp_path):
    drifting = replace(TURN, id="drifting", v_m=np.full(TURN.n_samples, 2.0))
    both = PhysicsPredictor(suzaku, np.column_stack([suzaku.matrix(), lost.theta]))
    simulated = mmgtune.simulate(both, [drifting])
    assert [motion.diverged for motion in simulated] == [False, True]
    assert [path.name for path in simulated.write(tmp_path)] == ["drifting_0.parquet"]
    assert mmgtune.read_trial(tmp_path / "drifting_0.parquet").source == "generated"


@pytest.mark.parametrize(("turn", "diverged"), [(3.1, False), (3.2, True), (-3.2, True)])
def test_a_ship_spins_that_turns_by_more_than_half_a_turn_between_samples(turn, diverged):
    states = np.zeros((4, 6))
    states[2:, 2] = turn
    assert Motion("run", np.arange(4.0), states, np.zeros((4, 2)), diverged=False).diverged is diverged


def test_a_ship_that_spins_is_said_and_is_not_good(tmp_path):
    text = (folder("ship_profiles") / "suzaku.toml").read_text(encoding="utf-8")
    text, found = re.subn(r"(?m)^N_rrr *=.*", "N_rrr = 0.9", text)  # a yaw moment that grows with what it drives
    assert found == 1
    (tmp_path / "spinning.toml").write_text(text, encoding="utf-8")
    ended = typed("simulate", "-p", tmp_path / "spinning.toml", "--turn", "35", "--out", tmp_path / "out", "--json")
    assert ended.code == 1
    (run,) = ended.json()["runs"]
    assert (run["status"], run["indices"]) == ("diverged", {})
    (note,) = ended.json()["notes"]
    assert note == "turn_p35 diverged: the ship spins, or is faster than any; none of it is judged or written"
    assert not list((tmp_path / "out").glob("*.parquet"))


def test_a_manoeuvre_asked_for_twice_is_made_once(tmp_path):
    asked = SimulateOptions(turn=("35", "35", "-35"), zigzag=("10/10", "10/10"))
    simulated = mmgtune.simulate("suzaku", options=asked)
    assert [motion.id for motion in simulated] == ["turn_p35", "turn_m35", "zigzag_p10_10"]
    assert len(simulated.write(tmp_path)) == 3


def test_a_comparison_with_a_ship_that_diverges_is_written(tmp_path):
    wild = mmgtune.load_profile("suzaku")
    sections = dict(wild.sections)
    hull = sections["hull"]
    far = replace(hull.coefficients["X_vvvv"], value=1e9)
    sections["hull"] = replace(hull, coefficients={**hull.coefficients, "X_vvvv": far})
    found = mmgtune.compare_profiles("suzaku", replace(wild, sections=sections))
    assert set(found.data["manoeuvres"]["motions"]["turn_p35"]) == {"a"}
    assert mmgtune.write_comparison(found, tmp_path)["out"] == str(tmp_path)
    assert "NaN" not in (tmp_path / "comparison.json").read_text()
    mmgtune.render(tmp_path)


def test_a_crash_stop_is_that_of_predict_and_ends_with_the_ship_at_rest():
    esso = mmgtune.load_profile("esso_osaka")
    stop, slower = (mmgtune.simulate(esso, options=SimulateOptions(stop=True, astern=n)) for n in (None, "50"))
    (row,), (motion,) = stop.rows(), stop
    assert motion.states[-1, 3] <= 0.0 < motion.states[-2, 3]
    n, begins = motion.mean_of("propeller"), row["indices"]["execute_time_s"]
    assert n[motion.t < begins - 1e-9] == pytest.approx(esso.approach.n)
    assert n[-1] == pytest.approx(-esso.approach.n)
    assert 0.4 < begins * esso.approach.speed / esso.L_pp < 0.6
    assert not motion.controls[:, motion.inputs.index("delta")].any()

    foretold = mmgtune.predict(esso, options=mmgtune.PredictOptions(stop=True)).to_dict()["runs"][0]["indices"]
    by_name = {one["index"]: one["median"] for one in foretold}
    for name in ("track_reach_m", "head_reach_m", "stopping_time_s"):
        assert row["indices"][name] == pytest.approx(by_name[name], rel=0.01)
    (reach,) = row["criteria"]
    assert (reach["name"], reach["limit"], reach["passed"]) == ("track reach", 15.0, True)
    assert reach["value"] == pytest.approx(row["indices"]["track_reach_m"] / esso.L_pp)
    assert slower.rows()[0]["indices"]["track_reach_m"] > 1.1 * row["indices"]["track_reach_m"]


@pytest.mark.parametrize(
    ("ship", "options", "said"),
    [
        ("suzaku", {"stop": True}, "no revolutions astern"),
        ("esso_osaka", {"stop": True, "astern": "1e6"}, "(astern)"),
        ("esso_osaka", {"stop": True, "astern": "1"}, "astern is in 1/min"),
        ("esso_osaka", {"stop": True, "astern": "0"}, "the revolutions are 0 (astern)"),
        ("esso_osaka", {"stop": True, "astern": "1,5"}, "'1,5' cannot be read (astern)"),
        ("esso_osaka", {"stop": True, "rpm": "1e6"}, "(rpm)"),
    ],
)
def test_a_stop_that_no_ship_makes_is_refused(ship, options, said):
    with pytest.raises(OptionError, match=re.escape(said)):
        mmgtune.simulate(ship, options=SimulateOptions(**options))


def test_orders_beside_trials_and_revolutions_astern_without_a_stop_are_refused():
    with pytest.raises(OptionError, match="no stop is asked for"):
        SimulateOptions(astern="50")
    with pytest.raises(OptionError, match="trials have their own inputs"):
        mmgtune.simulate("esso_osaka", [TURN], SimulateOptions(stop=True))


@pytest.mark.long
def test_a_stop_in_words(tmp_path):
    ended = typed("simulate", "-p", "esso_osaka", "--stop", "--out", tmp_path / "run")
    assert ended.code == 0
    assert "crash stop" in ended.out
    assert "IMO track reach" in ended.out
    assert "turn" not in ended.out
    assert "crash stop" in (tmp_path / "run" / "report.md").read_text()
    assert (tmp_path / "run" / "stop.parquet").is_file()
