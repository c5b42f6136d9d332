"""Lists of orders: what a CSV file says, what actuators make of it, and what is wrong with it."""

from __future__ import annotations

import numpy as np
import pytest

from mmgtune.errors import OptionError
from mmgtune.options import PredictOptions
from mmgtune.predicting import predict
from mmgtune.predicting.order_list import read_orders
from mmgtune.profile import Actuator
from mmgtune.units import DEG

INPUTS = ("n", "delta")


def listed(tmp_path, text):
    path = tmp_path / "orders.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_units_gaps_and_comments(tmp_path):
    text = "# berthing\nt [min], delta [deg], n [rpm]\n1, 0, 60\n\n2, 35,\n3, , -30\n4,,\n"
    found = read_orders(listed(tmp_path, text), INPUTS)
    np.testing.assert_allclose(found.t, [0.0, 60.0, 120.0, 180.0])
    np.testing.assert_allclose(found.ordered["delta"], [0.0, 35.0 * DEG, np.nan, np.nan])
    np.testing.assert_allclose(found.ordered["n"], [1.0, np.nan, -0.5, np.nan])


def test_orders_hold_and_actuators_take_their_time(tmp_path):
    found = read_orders(listed(tmp_path, "t, delta [rad]\n0,0\n10,0.2\n12,-0.2\n30,0"), INPUTS)
    gear = Actuator(-0.15, 0.15, 0.05)
    t, controls = found.carried_out(INPUTS, (None, gear), 1.5, 1.0)
    assert t[-1] == 30.0
    np.testing.assert_array_equal(controls[:, 0], 1.5)
    delta = dict(zip(t, controls[:, 1], strict=True))
    assert delta[10.0] == 0.0
    assert delta[11.0] == pytest.approx(0.05)
    assert delta[12.0] == pytest.approx(0.10)  # called back before it was there
    assert delta[14.0] == pytest.approx(0.0)
    assert delta[29.0] == pytest.approx(-0.15)  # no further than it goes
    at_once = found.carried_out(INPUTS, (None, None), 1.5, 1.0)[1][:, 1]
    assert at_once[np.searchsorted(t, 12.0)] == -0.2


def test_a_turn_as_a_list_is_the_turn(suzaku, tmp_path):
    turn = predict(suzaku, options=PredictOptions(turn=("20",)))
    approach = suzaku.profile.approach
    begin = 0.5 * suzaku.L_pp / approach.speed
    end = float(turn.runs[0].t[-1])
    text = f"t [s], delta [deg]\n0, 0\n{begin!r}, 20\n{end!r}, 20\n"
    found = predict(suzaku, listed(tmp_path, text))
    (run,) = found.runs
    assert run.id == "orders"
    for key in ("advance_m", "tactical_diameter_m", "time_180_s"):
        assert run.indices[key][0] == pytest.approx(turn.runs[0].indices[key][0], rel=0.01)
    (north, _, heading, _) = run.end(0.9)
    assert (north["mean"], north["unit"]) == (pytest.approx(run.states[0, -1, 0]), "m")
    assert heading["mean"] == pytest.approx(run.states[0, -1, 2] / DEG)
    np.testing.assert_allclose(run.states[0, -1, 3:], turn.runs[0].states[0, -1, 3:], rtol=2e-3)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("t [s], delta [deg]\n0, 5", "too short"),
        ("t [s], delta\n0, 5\n9, 5", "no unit"),
        ("t [s], delta [kn]\n0, 5\n9, 5", "no unit of 'delta'"),
        ("t [s], dleta [deg]\n0, 5\n9, 5", "did you mean 'delta'"),
        ("t [s], delta [deg], delta [rad]\n0, 5, 5\n9, 5, 5", "twice"),
        ("delta [deg]\n0\n9\n", "no column 't'"),
        ("t [s]\n0\n9\n", "nothing is ordered"),
        ("t [s], delta [deg]\n0, 5\n0, 5", "do not increase"),
        ("t [s], delta [deg]\n0, 5\n9, five", "line 3, column 'delta'"),
        ("t [s], delta [deg]\n0, 5\n, 5", "time is missing"),
        ("t [s], delta [deg]\n0, 5\n9, nan", "no number"),
        ("t [s], delta [deg]\n0, 5, 6\n9, 5", "3 cells"),
        ("t [s], delta [deg]\n0, 5\n1e9, 5", "too many"),
        ("t [s], delta [deg]\n0, 5\n1e-9, 5", "do not increase"),
        ("t [s], delta [deg]\n-1e308, 5\n1e308, 5", "column 't'"),
        ("t [s], n [rpm]\n0, 1e300\n9, 5", "line 2, column 'n'"),
        ("t [s], delta [rad]\n0, 0\n9, 35", "no ship is ordered more than 2 rad"),
        ("t [s], delta [deg]\n0, 0\n5, 60\n9, 0", "it goes from -45 to 45 °"),
        ("t [s], n [rpm]\n0, 100\n5, -90\n9, 5", "has no revolutions astern"),
        ("t [s], delta [deg]\n0, 1e300\n9, 5", "line 2, column 'delta'"),
        ('t [s], delta [deg]\n0, "' + 140_000 * "1" + '"\n9, 5', "no CSV file"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(suzaku, tmp_path, text, said):
    with pytest.raises(OptionError, match=r"orders\.csv") as error:
        predict(suzaku, listed(tmp_path, text))
    assert said in str(error.value)


def test_files_that_are_no_list(suzaku, tmp_path):
    with pytest.raises(OptionError, match="cannot be read"):
        predict(suzaku, tmp_path / "nowhere.csv")
    (tmp_path / "orders.csv").write_bytes(b"\xff\xfe\x00t")
    with pytest.raises(OptionError, match="cannot be read"):
        predict(suzaku, tmp_path / "orders.csv")
