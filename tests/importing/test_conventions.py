"""Angles, sides and lever arms, one at a time."""

import numpy as np
import pytest

from mmgtune.importing import conventions, parse_map
from mmgtune.importing.maps.mapping import Source
from mmgtune.importing.record import converted
from mmgtune.trial.headings import unwrapped
from mmgtune.units import DEG, KNOT
from tests.importing.made import MAP, imported, logged, refusal, said, suzaku, turn, write_csv


@pytest.mark.parametrize(
    ("source", "printed", "expected"),
    [
        (Source(), 30.0, 30.0),
        (Source(positive="counterclockwise"), 30.0, -30.0),
        (Source(zero="east"), 30.0, 120.0),
        (Source(zero="east", positive="counterclockwise"), 30.0, 60.0),
        (Source(offset=5.0 * DEG), 30.0, 35.0),
        (Source(scale=2.0), 30.0, 60.0),
    ],
)
def test_heading(source, printed, expected):
    assert converted("psi", np.array([printed]), source, "deg") == pytest.approx(expected * DEG)


def test_wind_to_is_wind_from_turned_round():
    (angle,) = converted("wind_dir", np.array([90.0]), Source(direction="to"), "deg")
    assert np.mod(angle, 2.0 * np.pi) == pytest.approx(270.0 * DEG)


@pytest.mark.parametrize("name", ["current_dir", "current_dir_at_4m"])
@pytest.mark.parametrize(("direction", "towards"), [("to", 90.0), ("from", 270.0)])
def test_a_current_is_counted_by_where_it_sets(name, direction, towards):
    (angle,) = converted(name, np.array([90.0]), Source(direction=direction), "deg")
    assert np.mod(angle, 2.0 * np.pi) == pytest.approx(towards * DEG)


def test_what_is_around_the_ship_is_imported(tmp_path):
    """Knots, degrees that start at east, feet, a current that comes from somewhere, layers and a constant."""
    trial = turn()
    columns = logged(trial)
    columns["drift"] = 1.0 + 0.5 * np.sin(trial.t / 60.0)
    columns["drift from"] = np.mod(350.0 + trial.t / 10.0, 360.0)
    columns["at 2 m"] = np.full(trial.n_samples, 0.4)
    columns["sounder"] = 12.0 + 0.01 * trial.t
    columns["sea"] = np.full(trial.n_samples, 1.25)
    columns["sea from east"] = np.full(trial.n_samples, 30.0)
    text = (
        MAP
        + """
current_speed = { column = "drift", unit = "kn" }
current_dir = { column = "drift from", unit = "deg", direction = "from" }
"current_speed_at_2.0m" = { column = "at 2 m", unit = "m/s" }
"current_dir_at_2.0m" = { value = "90 deg" }
depth = { column = "sounder", unit = "m" }
wave_height = { column = "sea", unit = "m" }
wave_dir = { column = "sea from east", unit = "deg", zero = "east", direction = "from" }
"""
    )
    extra = imported(write_csv(tmp_path / "log.csv", columns), text).extra
    assert extra["current_speed"] == pytest.approx(columns["drift"] * KNOT)
    off = extra["current_dir"] - columns["drift from"] * DEG - np.pi
    assert np.mod(off + 1.0, 2.0 * np.pi) == pytest.approx(1.0)
    assert extra["current_speed_at_2.0m"] == pytest.approx(0.4)
    assert extra["current_dir_at_2.0m"] == pytest.approx(np.pi / 2.0)
    assert extra["depth"] == pytest.approx(columns["sounder"])
    assert extra["wave_height"] == pytest.approx(1.25)
    assert extra["wave_dir"] == pytest.approx(120.0 * DEG)


def test_where_a_current_sets_must_be_said():
    text = MAP + 'current_dir = { column = "set", unit = "deg" }\n'
    assert "is 'current_dir' the direction it comes from or goes to?" in refusal(lambda: parse_map(text))


def test_unwrapping_sees_over_gaps():
    turning = np.linspace(0.0, 20.0, 200)
    wrapped = np.mod(turning, 2.0 * np.pi)
    wrapped[50:55] = np.nan
    back = unwrapped(wrapped, 2.0 * np.pi)
    known = np.isfinite(wrapped)
    assert np.abs(back - turning)[known].max() < 1e-12
    assert np.isnan(back[~known]).all()


def test_velocities_of_an_antenna_are_moved_to_midship(tmp_path):
    trial = turn()
    ahead, abeam = 40.0, 6.0
    columns = logged(trial)
    columns["north"] = trial.x + ahead * np.cos(trial.psi) - abeam * np.sin(trial.psi)
    columns["east"] = trial.y + ahead * np.sin(trial.psi) + abeam * np.cos(trial.psi)
    columns["ahead"] = (trial.u - abeam * trial.r) / (1852.0 / 3600.0)
    columns["abeam"] = (trial.v_m + ahead * trial.r) / (1852.0 / 3600.0)
    text = MAP.replace('axes = "ship"', 'axes = "ship"\npoint = "antenna"') + "[antenna]\nx = '40 m'\ny = '6 m'\n"
    back = imported(write_csv(tmp_path / "log.csv", columns), text)
    for name in ("x", "y", "u", "v_m"):
        assert np.abs(getattr(back, name) - getattr(trial, name)).max() < 1e-9


@pytest.mark.parametrize("name", ["turn_p10", "turn_m20", "turn_p20", "turn_m10", "turn_p40"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rudder_sign_of_the_bundled_trials(name, sign):
    trial = suzaku(name)
    columns = dict(trial.columns) | {"delta": sign * trial.delta}
    evidence = conventions.rudder_evidence(trial.t, columns)
    # In doubt is allowed, wrong is not.
    assert evidence.side in (0, int(sign))


@pytest.mark.parametrize(
    ("agreement", "gain", "samples", "side", "doubt"),
    [
        (1.0, 155.0, 391, 1, ""),
        (-1.0, -4.5, 391, -1, ""),
        (1.0, 2.5, 391, 0, "yaw acceleration per rudder angle +2.5 standard errors; 4 are needed"),
        (0.5, 7.0, 391, 0, "yaw acceleration per rudder angle +7.0 standard errors; 8 are needed"),
        (1.0, 155.0, 49, 0, "in 49 samples; 50 are needed"),
        (0.1, 155.0, 391, 0, "to either side"),
        (1.0, -20.0, 391, 0, "speak for opposite sides"),
    ],
)
def test_a_side_in_doubt_says_why(agreement, gain, samples, side, doubt):
    evidence = conventions.RudderEvidence(agreement, gain, samples)
    assert evidence.side == side
    assert doubt in evidence.doubt
    assert bool(doubt) == bool(evidence.doubt)


def test_the_report_says_why_the_side_is_in_doubt(log, columns):
    # A rudder that stands, and a ship that turns to its side all the time.
    columns["rudder"][:] = 20.0
    columns["rate"] = np.abs(columns["rate"]) + 1.0
    columns["heading"] = np.mod(np.cumsum(columns["rate"]) / 60.0, 360.0)
    assert "this run alone does not tell by which side of it the ship turns (yaw acceleration per rudder angle" in said(
        write_csv(log, columns)
    )


def test_v_to_port_is_found(tmp_path):
    trial = suzaku("turn_p35")
    columns = logged(trial)
    columns["abeam"] = -columns["abeam"]
    log = write_csv(tmp_path / "log.csv", columns)
    text = MAP.replace('"kn", positive = "starboard"', '"kn"')
    assert "velocities: ship axes, v to port" in said(log, text)
    assert np.abs(imported(log, text).v_m - trial.v_m).max() < 1e-9


def test_earth_axes_need_both_velocities():
    text = MAP.replace('axes = "ship"', 'axes = "earth"').replace('u = { column = "ahead", unit = "kn" }\n', "")
    assert "velocities in earth axes are of use only together" in refusal(lambda: parse_map(text))
