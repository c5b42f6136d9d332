"""A bundled trial written as a log in other units and conventions comes back as itself."""

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from mmgtune.importing import import_logs, load_map, parse_map
from mmgtune.trial import read_trial
from mmgtune.units import DEG, KNOT
from tests.importing.made import MAP, close, imported, logged, nmea, said, suzaku, turn, write_csv

NAMES = ["turn_p10", "turn_m20", "turn_p35", "turn_m40"]


@pytest.mark.parametrize("name", NAMES)
def test_other_units(tmp_path, name):
    trial = suzaku(name)
    close(imported(write_csv(tmp_path / "log.csv", logged(trial))), trial)


def test_other_units_signs_axes_origin_and_a_log_without_names(tmp_path):
    """Blank separated, two lines of text before, cp1252, y and rudder to port, heading mathematical, earth axes."""
    trial = suzaku()
    north = trial.u * np.cos(trial.psi) - trial.v_m * np.sin(trial.psi)
    east = trial.u * np.sin(trial.psi) + trial.v_m * np.cos(trial.psi)
    columns = [
        trial.t / 60.0, trial.x / 0.3048, -trial.y / 0.3048, np.mod(90.0 - trial.psi / DEG, 360.0), north * 3.6,
        -east * 3.6, -trial.r / DEG, trial.n * 60.0, -trial.delta,
    ]  # fmt: skip
    log = tmp_path / "log.dat"
    with log.open("w", encoding="cp1252") as file:
        file.write("Versuch für Schiff A\nSpalten: siehe Bericht\n")
        for row in np.column_stack(columns):
            file.write("  " + "   ".join(f"{value:.15e}" for value in row) + "\n")
    text = """
schema = 1
[log]
delimiter = "space"
encoding = "cp1252"
skip = 2
header = false
[time]
column = 1
unit = "min"
[velocity]
axes = "earth"
[columns.x]
column = 2
unit = "ft"
[columns.y]
column = 3
unit = "ft"
positive = "port"
[columns.psi]
column = 4
unit = "deg"
zero = "east"
positive = "counterclockwise"
[columns.u]
column = 5
unit = "km/h"
[columns.v]
column = 6
unit = "km/h"
positive = "west"
[columns.r]
column = 7
unit = "deg/s"
positive = "port"
[columns.n]
column = 8
unit = "rpm"
[columns.delta]
column = 9
unit = "rad"
positive = "port"
"""
    back = imported(log, text)
    close(back, trial)


def test_parquet_in_comes_out(tmp_path):
    trial = suzaku()
    pq.write_table(pa.table(logged(trial)), tmp_path / "log.parquet")
    close(imported(tmp_path / "log.parquet"), trial)


def test_dates_clocks_and_numbers_are_one_time(tmp_path):
    trial = turn()
    columns = logged(trial)
    dates = pd.Timestamp("2024-05-01T23:58:00") + pd.to_timedelta(trial.t, unit="s")
    for stamps in (dates.strftime("%Y-%m-%dT%H:%M:%S.%f"), dates.strftime("%H:%M:%S"), dates.strftime("%H:%M:%S,%f")):
        log = write_csv(tmp_path / "log.csv", {**columns, "time": stamps}, sep=";")
        close(imported(log), trial)


def test_what_the_motion_shows_need_not_be_said(tmp_path):
    """Signs of rudder and yaw rate, axes of velocities: found, undone and reported."""
    trial = suzaku("turn_p35")
    columns = logged(trial)
    columns["rudder"], columns["rate"] = -columns["rudder"], -columns["rate"]
    heading = columns["heading"] * DEG
    ahead, abeam = columns["ahead"], columns["abeam"]
    columns["ahead"] = ahead * np.cos(heading) - abeam * np.sin(heading)
    columns["abeam"] = ahead * np.sin(heading) + abeam * np.cos(heading)
    text = MAP.replace(', positive = "starboard"', "").replace('axes = "ship"', "")
    log = write_csv(tmp_path / "log.csv", columns)
    close(imported(log, text), trial, 1e-6)
    report = said(log, text)
    assert "rudder: a positive angle of the log turns the ship to port" in report
    assert "yaw rate: positive to port" in report
    assert "velocities: earth axes, as the positions show" in report


def test_antenna_and_velocities_not_measured(tmp_path):
    """Latitude, longitude, heading, rudder, a constant shaft: u, v and r follow, of midship."""
    import pyproj

    trial = turn()
    ahead, abeam = 30.0, -4.0
    x = trial.x + ahead * np.cos(trial.psi) - abeam * np.sin(trial.psi)
    y = trial.y + ahead * np.sin(trial.psi) + abeam * np.cos(trial.psi)
    for projection, name in (("tmerc", "transverse-mercator"), ("aeqd", "azimuthal-equidistant")):
        to = pyproj.Transformer.from_crs(f"+proj={projection} +lat_0=51.5 +lon_0=3.5", "EPSG:4326", always_xy=True)
        lon, lat = to.transform(y, x)
        columns = {key: logged(trial)[key] for key in ("time", "heading", "rudder")}
        log = write_csv(tmp_path / "log.csv", {**columns, "lat [deg]": lat, "lon [deg]": lon})
        text = f"""
schema = 1
[time]
column = "time"
unit = "s"
[antenna]
x = "{ahead} m"
y = "{abeam} m"
[position]
projection = "{name}"
origin = [51.5, 3.5]
[columns]
latitude = {{ column = "lat" }}
longitude = {{ column = "lon" }}
psi = {{ column = "heading", unit = "deg" }}
n = {{ value = "102 rpm" }}
delta = {{ column = "rudder", unit = "deg", positive = "starboard" }}
"""
        back = imported(log, text)
        inner = slice(5, -5)
        assert np.abs(back.x - trial.x).max() < 1e-3
        assert np.abs(back.y - trial.y).max() < 1e-3
        # A corner of the motion every rudder reversal, blunted by the smoothing.
        assert np.abs(back.u - trial.u)[inner].max() < 0.05
        assert np.abs(back.v_m - trial.v_m)[inner].max() < 0.05
        assert np.abs(back.r - trial.r)[inner].max() < 0.05 * np.abs(trial.r).max()
        assert back.n == pytest.approx(1.7)
        assert "u and v were not measured" in back.note
        assert "r was not measured" in back.note
        assert back.derived == ("u", "v", "r")
        assert back.antenna == (ahead, abeam)
        assert "projection of WGS 84" in back.note
    text = text.replace("[antenna]", "[velocity]\npoint = 'antenna'\n[antenna]")
    assert imported(log, text).n_samples == trial.n_samples


@pytest.mark.parametrize("fast", [1, 10])
def test_nmea_over_midnight(tmp_path, fast):
    trial = turn()
    log = tmp_path / "log.nmea"
    log.write_text("\n".join(nmea(trial, fast=fast)) + "\n")
    (path,) = import_logs([log], load_map("nmea-0183", preset=True), tmp_path / "out").files
    back = read_trial(path)
    assert back.n_samples == trial.n_samples
    assert np.abs(back.x - (trial.x - trial.x[0])).max() < 2e-3
    assert np.abs(back.y - (trial.y - trial.y[0])).max() < 2e-3
    assert np.abs(back.psi - trial.psi)[:-1].max() < 1e-3
    assert np.abs(back.u - trial.u)[:-1].max() < 1e-3
    assert np.abs(back.v_m - trial.v_m)[:-1].max() < 1e-3
    assert np.abs(back.r - trial.r).max() < 1e-5
    assert back.n == pytest.approx(trial.n)
    assert np.abs(back.delta - trial.delta).max() < 1e-5
    assert back.extra["wind_speed_app"] == pytest.approx(10.0 * KNOT)


def test_resampling_coarser_averages_and_finer_interpolates(tmp_path):
    trial = turn()
    log = write_csv(tmp_path / "log.csv", logged(trial))
    coarse = imported(log, step=5.0)
    assert coarse.n_samples == 80
    rows = np.searchsorted(trial.t, coarse.t)
    assert np.abs(coarse.psi - trial.psi[rows])[1:-1].max() < 0.01
    fine = imported(log, step=0.5)
    assert np.abs(fine.x[::2] - trial.x).max() < 1e-9
    assert np.diff(fine.t) == pytest.approx(0.5)


def test_thinning_keeps_the_first_position(tmp_path):
    """Beside the first sample there are only later ones: their mean lies ahead of it."""
    trial = turn()
    log = write_csv(tmp_path / "log.csv", logged(trial))
    for step in (5.0, 8.0):
        back = imported(log, step=step)
        assert abs(back.x[0] - trial.x[0]) < 0.05
        end = float(np.interp(back.t[-1], trial.t, trial.x))
        assert abs(back.x[-1] - end) < 0.3


def test_cut_to_the_manoeuvre(tmp_path):
    trial = suzaku()
    log = write_csv(tmp_path / "log.csv", logged(trial))
    cut = imported(log, MAP + '[cut]\nstart = "100 s"\nend = "400 s"\n')
    assert cut.duration == pytest.approx(300.0)
    assert cut.x[0] == pytest.approx(float(np.interp(100.0, trial.t, trial.x)))
    columns = {name: values.copy() for name, values in logged(trial).items()}
    before = 60
    step = trial.t[1] - trial.t[0]
    lead = {name: np.full(before, values[0]) for name, values in columns.items()}
    lead["time"] = trial.t[0] - step * np.arange(before, 0, -1)
    lead["north"] = columns["north"][0] + columns["ahead"][0] * KNOT * lead["time"]
    lead["rudder"] = np.zeros(before)
    joined = {name: np.concatenate([lead[name], columns[name]]) for name in columns}
    joined["rudder"][before] = 0.0
    log = write_csv(tmp_path / "log.csv", joined)
    cut = imported(log, MAP + '[cut]\nfrom = "first-rudder-order"\nlead = "10 s"\n')
    assert cut.t[0] == 0.0
    order = float(cut.t[np.flatnonzero(np.abs(cut.delta) > 1.0 * DEG)[0]])
    assert 8.0 <= order <= 14.0


def test_time_printed_with_three_digits_is_recovered(tmp_path):
    """As 1.23E+02: stamps repeat from 100 s on although the step is 0.135 s."""
    t = 0.135 * np.arange(3000)
    columns = logged(turn())
    grid = {name: np.interp(t, columns["time"], values) for name, values in columns.items() if name != "heading"}
    grid["heading"] = np.mod(np.interp(t, columns["time"], np.unwrap(columns["heading"], period=360.0)), 360.0)
    grid["time"] = np.array([float(f"{value:.2e}") for value in t])
    log = write_csv(tmp_path / "log.csv", grid)
    back = imported(log)
    assert back.n_samples == 3000
    assert np.abs(back.t - t).max() < 0.05
    assert "put back on a uniform step of 0.135" in back.note
    exact = imported(log, MAP.replace('unit = "s"', 'unit = "s"\nstep = "0.135 s"', 1))
    assert np.abs(exact.t - t).max() < 1e-9


def test_positions_printed_with_three_digits_are_smoothed_within_them(tmp_path):
    trial = turn()
    columns = logged(trial)
    for name in ("north", "east"):
        columns[name] = np.array([float(f"{value:.2e}") for value in columns[name]])
    log = write_csv(tmp_path / "log.csv", columns)
    text = MAP.replace('"north", unit = "m"', '"north", unit = "m", recover = "print-resolution"')
    rough, back = imported(log), imported(log, text)
    assert np.abs(back.x - columns["north"]).max() <= 5.0 + 1e-6
    assert np.std(back.x - trial.x) < 0.5 * np.std(rough.x - trial.x)
    assert "significant digits" in back.note


def test_the_map_is_stated_with_what_was_done(tmp_path):
    back = imported(write_csv(tmp_path / "log.csv", logged(turn())), MAP + '[trial]\nship = "ketch"\nid = "a-{stem}"\n')
    assert (back.id, back.ship, back.source) == ("a-log", "ketch", "measured")
    assert "imported with the map" in back.note
    assert (tmp_path / "out" / "import-report.json").exists()


def test_headers_with_units_need_no_units_in_the_map(tmp_path):
    trial = turn()
    units = ("s", "m", "m", "deg", "knots", "kn", "deg/min", "rpm", "degrees")
    columns = {f"{name} [{unit}]": values for (name, values), unit in zip(logged(trial).items(), units, strict=True)}
    import re

    text = re.sub(r', unit = "[^"]+"', "", MAP).replace('unit = "s"\n', "")
    close(imported(write_csv(tmp_path / "log.csv", columns), text), trial)


def test_presets_read(tmp_path):
    for name in ("frt-ds-esso", "nmea-0183", "simman-hsva", "simman-marin"):
        assert load_map(name, preset=True).name == name
    assert parse_map(MAP).format is None
