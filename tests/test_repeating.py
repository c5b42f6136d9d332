"""Manoeuvres repeated by a model: its own come back, those of another ship do not."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.evaluation import evaluate
from mmgtune.motions import as_trial, trial_indices
from mmgtune.orders import TurningOrder, ZigzagOrder, run_manoeuvre
from mmgtune.repeating import Repeated, repeat, summary
from mmgtune.trial import write_trial
from mmgtune.trial.schema import ATTRIBUTES
from tests.command import run

pytestmark = pytest.mark.xdist_group("repeating")

RAD = math.radians(1.0)


@pytest.fixture(scope="module")
def sailed(suzaku):
    """A turn to port and a zigzag by the model itself, not northward."""
    orders = {"turn": TurningOrder(-25.0 * RAD, 30.0, 400.0 * RAD), "zigzag": ZigzagOrder(20.0 * RAD, 20.0 * RAD, 30.0)}
    return [
        as_trial(suzaku.profile, run_manoeuvre(suzaku, order, id=name, heading=1.2)) for name, order in orders.items()
    ]


def test_a_models_own_manoeuvres_come_back(suzaku, sailed):
    turn, zigzag = repeat(suzaku, sailed)
    assert (turn.manoeuvre, turn.order) == ("turning", "25 deg to port")
    assert (zigzag.manoeuvre, zigzag.order) == ("zigzag", "20/20 to starboard first")
    assert {"advance_over_L", "tactical_diameter_over_L", "steady_diameter_over_L"} <= set(turn.judged)
    assert {"overshoot_1_deg", "overshoot_2_deg"} <= set(zigzag.judged)
    # Rudder amidships does not keep this ship quite straight: how long that was before the order matters a little.
    for name, (measured, simulated) in (turn.judged | zigzag.judged).items():
        tolerance = {"abs": 0.6} if name.endswith("_deg") else {"rel": 0.02}
        assert simulated == pytest.approx(measured, **tolerance), name


def test_other_coefficients_turn_otherwise(suzaku, sailed):
    wider = suzaku.matrix(["hull.N_r"], [[1.5 * suzaku.profile.value("hull.N_r")]])
    measured, simulated = repeat(suzaku, sailed[:1], theta=wider)[0].judged["tactical_diameter_over_L"]
    assert simulated > 1.1 * measured


def test_only_standard_manoeuvres_without_gaps(suzaku, sailed):
    turn, zigzag = sailed
    x = np.array(turn.x)
    x[40:44] = np.nan
    straight = replace(zigzag, delta=np.zeros(zigzag.n_samples))
    wrapped = replace(turn, psi=(turn.psi + np.pi) % (2.0 * np.pi) - np.pi)
    brief = replace(turn, **{name: getattr(turn, name)[:2] for name in ATTRIBUTES.values()})
    assert repeat(suzaku, [replace(turn, x=x), straight, wrapped, brief]) == []
    for trial in (replace(turn, x=x), straight, wrapped, brief):
        assert trial_indices(trial, suzaku.L_pp) == {}


def test_a_model_that_goes_astray_has_no_indices(suzaku, sailed):
    wild = suzaku.matrix(["hull.N_rrr"], [[1e6]])
    (one,) = repeat(suzaku, sailed[:1], theta=wild)
    assert one.simulated == {}
    assert one.judged == {}
    assert summary([one]) == {}


def test_a_late_helmsman_does_not_change_the_order(suzaku):
    """A 35/5 zigzag whose rudder is reversed two degrees late is repeated as 35/5, where the trial says what it was."""
    late = as_trial(suzaku.profile, run_manoeuvre(suzaku, ZigzagOrder(35.0 * RAD, 7.0 * RAD, 30.0), id="late"))
    (one,) = repeat(suzaku, [replace(late, manoeuvre="zigzag 35/5")])
    assert one.order == "35/5 to starboard first"
    assert one.measured["heading_angle_deg"] == pytest.approx(5.0)
    assert one.simulated["execute_heading_1_deg"] < one.measured["execute_heading_1_deg"] - 1.5
    measured, simulated = one.judged["overshoot_1_deg"]
    assert simulated < measured - 1.5
    (record,) = evaluate(suzaku, [replace(late, manoeuvre="zigzag 35/5")])
    assert record.measured.indices["overshoot_1_deg"] == measured


def test_errors_by_hand():
    def zigzag(measured, simulated):
        return Repeated("a", "zigzag", "10/10", {"overshoot_1_deg": measured}, {"overshoot_1_deg": simulated})

    turn = Repeated("b", "turning", "35", {"advance_over_L": 4.0}, {"advance_over_L": 3.0})
    errors = summary([zigzag(10.0, 13.0), zigzag(8.0, 4.0), turn])
    assert errors["overshoot_1_deg"] == {"n": 2, "mean": -0.5, "rms": pytest.approx(math.sqrt(12.5))}
    assert errors["advance_over_L"] == {"n": 1, "mean": -0.25, "rms": 0.25}


@pytest.fixture
def folder(tmp_path, sailed):
    (tmp_path / "log").mkdir()
    for trial in sailed:
        write_trial(trial, tmp_path / "log" / f"{trial.id}.parquet")
    return tmp_path


def test_validate_shows_them(folder):
    shown = run("validate", "suzaku", "kvlcc2", "log", "--manoeuvres", cwd=folder)
    assert shown.code == 0, shown.err
    assert "turn: 25 deg to port" in shown.out
    assert "tactical diameter [L]" in shown.out
    assert "root mean square error" in shown.out
    own, other = run("validate", "suzaku", "kvlcc2", "log", "--manoeuvres", "--json", cwd=folder).json()["profiles"]
    assert [one["id"] for one in own["manoeuvres"]["runs"]] == ["turn", "zigzag"]
    errors = [ship["manoeuvres"]["errors"]["tactical_diameter_over_L"]["rms"] for ship in (own, other)]
    assert errors[0] < 0.02 < errors[1]


@pytest.mark.long
def test_leave_out_predicts_them(folder):
    command = ("leave-out", "-p", "suzaku", "-t", "log", "--ar", "0.1", "--targets", "N_r", "--starts", "1", "-q")
    document = run(*command, "--manoeuvres", "--json", cwd=folder).json()
    for when in ("before", "left_out"):
        assert [one["id"] for one in document["manoeuvres"][when]["runs"]] == ["turn", "zigzag"]
    assert "manoeuvres" not in run(*command, "--json", cwd=folder).json()
    assert "left out" in run(*command, "--manoeuvres", cwd=folder).out
