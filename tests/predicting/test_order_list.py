"""Lists of orders: what a CSV file says, what actuators make of it, and what is wrong with it."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from mmgtune.errors import OptionError
from mmgtune.options import PredictOptions
from mmgtune.planning import plan_trial
from mmgtune.predicting import predict
from mmgtune.predicting.order_list import read_orders
from mmgtune.predicting.order_table import orders_in
from mmgtune.profile import Actuator
from mmgtune.simulating import simulate
from mmgtune.trial import load_trials, windows
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


BERTHING = {"t [min]": [1, 2, 3, 4], "delta [deg]": [0, 35, None, np.nan], "n [rpm]": [60.0, None, -30.0, None]}


@pytest.mark.parametrize(
    "table",
    [
        BERTHING,
        pd.DataFrame(BERTHING),
        pd.DataFrame(BERTHING).set_index("t [min]"),
        pd.DataFrame(BERTHING).set_index(pd.to_timedelta([1, 2, 3, 4], unit="min")).drop(columns="t [min]"),
    ],
    ids=["dict", "frame", "time as index", "times as index"],
)
def test_a_table_says_what_the_file_does(table, tmp_path):
    found = orders_in(table, INPUTS)
    read = read_orders(listed(tmp_path, "t [min], delta [deg], n [rpm]\n1, 0, 60\n2, 35,\n3, , -30\n4,,\n"), INPUTS)
    np.testing.assert_array_equal(found.t, read.t)
    assert list(found.ordered) == list(read.ordered)
    for name, ordered in found.ordered.items():
        np.testing.assert_array_equal(ordered, read.ordered[name])


ORDERS = pd.DataFrame({"t [s]": [0, 20, 80, 140], "delta [deg]": [0, 35, -10, 0], "n [rpm]": [106, 106, 50, 50]})


def test_a_table_is_predicted_as_the_file_is_and_its_frame_says_where_she_ends(suzaku, tmp_path):
    ORDERS.to_csv(tmp_path / "orders.csv", index=False)
    read, found = predict(suzaku, tmp_path / "orders.csv"), predict(suzaku, ORDERS)
    frame = found.to_frame()
    assert frame.equals(read.to_frame())
    (run,) = found.runs
    assert (run.id, run.words) == ("orders", "3 orders of a table")
    assert frame["index"].tolist() == [f"{what} at the end" for what in ("north", "east", "heading", "speed")]
    assert frame["unit"].tolist() == ["m", "m", "deg", "m/s"]
    np.testing.assert_allclose(frame["predicted"], run.states[0, -1, :4] / [1.0, 1.0, DEG, 1.0], rtol=1e-12)
    assert "north at the end" in found.summary()


def test_a_piece_of_a_trial_that_shows_no_index_ends_beside_what_was_measured(suzaku):
    piece = windows(load_trials("suzaku").trials["turn_p35"], 30.0)[2]
    frame = predict(suzaku, [piece]).to_frame().set_index("index")
    assert frame.loc["north at the end", "measured"] == pytest.approx(piece.x[-1])
    assert frame.loc["heading at the end", "measured"] == pytest.approx(np.degrees(piece.psi[-1]))


@pytest.mark.parametrize(
    ("table", "said"),
    [
        (ORDERS.drop(columns="t [s]"), "there is no column 't' (orders)"),
        (ORDERS[["t [s]"]], "nothing is ordered"),
        (ORDERS.rename(columns={"delta [deg]": "delta"}), "write 'delta [deg]' or 'delta [rad]'"),
        (ORDERS.rename(columns={"delta [deg]": "rudder [deg]"}), "nothing is driven by 'rudder'"),
        (ORDERS.iloc[:1], "too short"),
        (ORDERS.iloc[::-1], "do not increase (orders, row 1, column 't')"),
        (ORDERS.assign(**{"delta [deg]": "hard over"}), "column 'delta' holds no numbers"),
        (ORDERS.assign(**{"delta [deg]": np.inf}), "(orders, row 0, column 'delta')"),
        (ORDERS.assign(**{"delta [deg]": 60.0}), "it goes from -45 to 45"),
        (ORDERS.assign(**{"t [s]": [0, None, 2, 3]}), "the time is missing (orders, row 1, column 't')"),
        (ORDERS.assign(**{"t [s]": [0, 1, 2, 1e9]}), "too many"),
        ({**ORDERS.to_dict("list"), "n [rpm]": [1]}, "'n' has 1 rows, 't' 4"),
        ({}, "there is no column 't'"),
    ],
)
def test_what_is_wrong_in_a_table_is_said_in_short(suzaku, table, said):
    with pytest.raises(OptionError) as error:
        predict(suzaku, table)
    assert said in str(error.value)
    assert max(map(len, str(error.value).splitlines())) < 160


def test_a_table_elsewhere_is_refused_without_its_text(suzaku):
    for call in (
        lambda: simulate(suzaku, ORDERS),
        lambda: predict(suzaku, trials=ORDERS),
        lambda: simulate(ORDERS),
        lambda: plan_trial(ORDERS, "tactical diameter, turn -35"),
    ):
        with pytest.raises(OptionError, match="a DataFrame ") as error:
            call()
        assert "106" not in str(error.value)
    with pytest.raises(OptionError, match="a table of orders is for predict"):
        simulate(suzaku, ORDERS)
    with pytest.raises(OptionError, match=r"^a ShipProfile has no particles of coefficients \(model\)"):
        plan_trial(suzaku.profile, "tactical diameter, turn -35")
