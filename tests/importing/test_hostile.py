"""Hostile logs: each is refused with what, where, why and the fix, or its faults are marked; all logs are generated."""

import re
import zipfile
from functools import reduce
from operator import xor

import numpy as np
import pandas as pd
import pytest

from mmgtune.errors import LogError, OutputError
from mmgtune.importing import import_logs, load_map, parse_map, propose_map
from mmgtune.importing.formats.nmea import checksum
from mmgtune.trial import read_trial
from mmgtune.units import DEG
from tests.importing.made import (
    MAP,
    close,
    imported,
    logged,
    nmea,
    printed,
    refusal,
    said,
    sentence,
    suzaku,
    turn,
    with_sides,
    write_csv,
)  # fmt: skip


def refused(log, *words, text=MAP):
    answer = refusal(lambda: said(log, text))
    for word in words:
        assert word in answer, answer
    return answer


# what is refused


def test_two_receivers_that_talk_in_turn(tmp_path):
    """Positions 30 m apart made one track that jumped at every sample; who changes its name once is one receiver."""

    def read(talks):
        log = tmp_path / "log.txt"
        log.write_text("\n".join(sentence(one[1:].partition("*")[0]) for one in talks), encoding="utf-8")
        found = import_logs([log], load_map("nmea-0183", preset=True), tmp_path / "out", overwrite=True)
        return found.trials[0], found.text()

    lines = nmea(turn())
    other = [line.replace("$GPGGA", "$GNGGA") for line in nmea(turn(), start=86390.5, origin=(35.0003, 139.0))]
    pairs = zip(lines, other, strict=True)
    trial, report = read([one for pair in pairs for one in (pair if "GGA" in pair[0] else pair[:1])])
    assert np.abs(trial.x - turn().x).max() < 0.01
    assert "two sensors talk in turn: GPGGA is taken, and 400 GNGGA left out" in report
    half = len(lines) // 2
    trial, report = read([*lines[:half], *(line.replace("$GPGGA", "$GNGGA") for line in lines[half:])])
    assert trial.n_samples == turn().n_samples
    assert "in turn" not in report


def test_empty_binary_and_absent(log, tmp_path):
    log.write_bytes(b"")
    refused(log, "the log is empty", "log.csv")
    log.write_bytes(b"\x00\x01\x02" * 1000)
    refused(log, "the log is binary", "zero bytes", "convert it")
    log.write_text("time,north,east,heading,ahead,abeam,rate,shaft,rudder\n")
    refused(log, "no rows")
    refused(tmp_path / "nowhere.csv", "cannot be opened")
    (tmp_path / "cut.parquet").write_bytes(b"PAR1" + b"x" * 50)
    refused(tmp_path / "cut.parquet", "Parquet log cannot be read")


@pytest.mark.parametrize(
    ("name", "told", "fix"),
    [
        ("log.csv.gz", "compressed (gzip)", "unpack it first"),
        ("log.zip", "a zip archive", "unpack it first"),
        ("log.ods", "a spreadsheet in OpenDocument format", "save it as .xlsx or as CSV"),
        ("log.json", "JSON", "pandas.read_json"),
        ("log.jsonl", "JSON", "pandas.read_json"),
        ("log.feather", "an Arrow file", "pandas.read_feather"),
        ("log.gpx", "XML, such as GPX", "beside the track"),
        ("log.bag", "a recording of ROS", "export what the trial needs to CSV"),
        ("log.sqlite", "a database (SQLite)", "as CSV"),
    ],
)
def test_other_kinds_of_files_are_called_by_their_names(columns, tmp_path, name, told, fix):
    frame = pd.DataFrame(dict(columns))
    log = tmp_path / name
    kind = name.rpartition(".")[2]
    if kind in ("gz", "zip"):
        frame.to_csv(log)
    elif kind in ("json", "jsonl"):
        frame.to_json(log, orient="records", lines=kind == "jsonl")
    elif kind == "feather":
        frame.to_feather(log)
    elif kind == "ods":
        with zipfile.ZipFile(log, "w") as archive:
            archive.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
            archive.writestr("content.xml", "<table/>")
    elif kind == "gpx":
        log.write_text('<?xml version="1.0"?><gpx><trk/></gpx>', encoding="utf-8")
    else:
        log.write_bytes({"bag": b"#ROSBAG V2.0\n" + bytes(99), "sqlite": b"SQLite format 3" + bytes(99)}[kind])
    refused(log, f"the log is {told}", name, fix)
    with pytest.raises(LogError, match=re.escape(f"the log is {told}")):
        propose_map(log)


def test_a_row_for_each_value_is_told(columns, tmp_path):
    frame = pd.DataFrame(dict(columns)).rename(columns={"heading": "gyro/heading", "rudder": "steering/rudder_angle"})
    log = tmp_path / "log.csv"
    frame.melt("time", var_name="signal").sort_values("time").to_csv(log, index=False)
    with pytest.raises(LogError, match="a row for each value: 'signal' says of what it is") as caught:
        propose_map(log)
    assert "a column for each of them" in str(caught.value)


def test_missing_column_names_the_closest(log, columns):
    columns["headng"] = columns.pop("heading")
    columns["shaft_rpm"] = columns.pop("shaft")
    answer = refused(write_csv(log, columns), "column 'heading' is missing", "did you mean 'headng'", "line 1")
    assert "column 'shaft' is missing" in answer


def test_unit_not_stated_is_asked_for(log, columns):
    text = MAP.replace('"rudder", unit = "deg"', '"rudder"').replace('"ahead", unit = "kn"', '"ahead"')
    answer = refused(write_csv(log, columns), "is 'rudder' in rad or deg?", 'unit = "deg"', "line", text=text)
    assert "its values run from -20" in answer
    assert "is 'ahead' in m/s or kn" in answer


def test_unit_of_the_map_against_that_of_the_header(log, columns):
    columns["rudder [rad]"] = columns.pop("rudder") * DEG
    refused(write_csv(log, columns), "the map says 'rudder [rad]' is in deg, its header says rad")


def test_cells_with_units_of_their_own(log, columns):
    columns["ahead"] = [
        f"{value:.3f}" if k != 7 else f"{value * 0.514:.3f} m/s" for k, value in enumerate(columns["ahead"])
    ]
    refused(write_csv(log, columns), "a cell has a unit of its own, 'm/s'", "line 9", "column 'ahead'")


@pytest.mark.parametrize(("name", "factor"), [("rate", DEG), ("ahead", 0.5144444)])
def test_units_that_change_within_the_log(log, columns, name, factor):
    changed = [name, "abeam"] if name == "ahead" else [name]
    for one in changed:
        columns[one][200:] *= factor
    refused(write_csv(log, columns), "changes within the log", "cut")


def test_degrees_called_radians(log, columns):
    text = MAP.replace('"rudder", unit = "deg"', '"rudder", unit = "rad"')
    refused(write_csv(log, columns), "rudder angle up to", "degrees", text=text)


def test_latitude_and_longitude_swapped(log, columns):
    columns["lat"], columns["lon"] = 139.0 + columns["east"] * 1.1e-5, 35.0 + columns["north"] * 9e-6
    text = MAP.replace('x = { column = "north", unit = "m" }', 'latitude = { column = "lat", unit = "deg" }')
    text = text.replace('y = { column = "east", unit = "m" }', 'longitude = { column = "lon", unit = "deg" }')
    refused(write_csv(log, columns), "latitude and longitude are swapped?", "beyond a pole", text=text)
    columns["lat"], columns["lon"] = columns["lon"].copy(), columns["lat"].copy()
    lost = np.where(columns["time"] % 20.0 == 0.0, -999.0, columns["lat"])
    words = ("20 latitudes are -999", "no value", 'missing = ["-999"] in [log]')
    refused(write_csv(log, {**columns, "lat": lost}), *words, text=text)
    assert "transverse mercator" in said(write_csv(log, columns), text)
    lat, lon = columns["lat"].copy() - 20.0, columns["lon"].copy() - 100.0
    lat[200:], lon[200:] = lon[200:].copy(), lat[200:].copy()
    refused(
        write_csv(log, {**columns, "lat": lat, "lon": lon}),
        "jumps to another part of the earth", "swapped", text=text,
    )  # fmt: skip
    swapped = text.replace('"lat"', '"_"').replace('"lon"', '"lat"').replace('"_"', '"lon"')
    moved = {**columns, "lat": columns["lat"] - 0.0, "lon": columns["lon"] - 100.0}
    moved["north"] = moved["east"] = np.zeros(400)
    refused(write_csv(log, moved), "swapped?", "along the heading", text=swapped)
    columns["lat"][100] = 0.0
    columns["lon"][100] = 0.0
    assert "gap       x: 1 sample from 100 to 100 s" in said(write_csv(log, columns), text)


def test_decimal_commas(log, columns):
    write_csv(log, columns, sep=";", decimal=",")
    refused(log, "numbers with a comma in them", 'decimal = ","', "line 2")
    close(imported(log, MAP + '[log]\ndecimal = ","\n'), turn())
    # Commas between fields too: nothing can tell them apart.
    log.write_text("\n".join(line.replace(";", ",") for line in log.read_text().splitlines()))
    refused(log, "more fields than the header", "decimal")


COMMAS = MAP + '[log]\ndecimal = ","\n'


@pytest.mark.parametrize("text", ["---", "-", "Sensor aus", "row of units"])
def test_decimal_commas_beside_texts(log, columns, text):
    written = printed(columns, ",")
    if text == "row of units":
        units = ("s", "m", "m", "deg", "kn", "kn", "deg/min", "rpm", "deg")
        written = {name: [unit, *column] for unit, (name, column) in zip(units, written.items(), strict=True)}
        close(imported(write_csv(log, written, sep=";"), COMMAS), turn(), 1e-6)
        return
    written["rate"][30] = text
    report = said(write_csv(log, written, sep=";"), COMMAS)
    assert "gap       r: 1 sample from 30 to 30 s" in report
    assert "numbers with a comma" in refusal(lambda: imported(log))
    proposal = propose_map([log])
    assert (proposal.problems, proposal.imported) == ((), 1)


def test_no_value_as_a_number_with_a_decimal_comma(log, columns):
    written = printed(columns, ",")
    written["rate"][30], written["rate"][31] = "-999,00", "off"
    report = said(write_csv(log, written, sep=";"), COMMAS.replace("[log]", '[log]\nmissing = ["-999,0"]'))
    assert "gap       r: 2 samples from 30 to 31 s" in report


@pytest.mark.parametrize(
    ("cells", "words"),
    [
        (lambda size: with_sides(size, "-{size}{side}"), "both a sign and a side"),
        (
            lambda size: [*with_sides(size)[:10], *(f"{one:.2f}" for one in size[10:])],
            "only some cells of the column say",
        ),
        (lambda size: with_sides(size, "{size} x{side}"), "a unit of its own, 'x"),
    ],
)
def test_sides_that_cannot_be_read(log, columns, cells, words):
    columns["rudder"] = cells(columns["rudder"])
    refused(write_csv(log, columns), words, "column 'rudder'")


def test_sides_that_come_late_in_a_long_log(log, columns, monkeypatch):
    monkeypatch.setattr("mmgtune.importing.formats.text.BLOCK", 100)
    size = columns["rudder"]
    columns["rudder"] = [*(f"{one:.9f}" for one in size[:100]), *with_sides(size[100:])]
    refused(write_csv(log, columns), "only some cells of the column say a side", "here a number has none")


def test_sides_against_those_of_the_map(log, columns):
    columns["rudder"] = with_sides(columns["rudder"])
    text = MAP.replace('"rudder", unit = "deg", positive = "starboard"', '"rudder", unit = "deg", positive = "port"')
    answer = refusal(lambda: imported(write_csv(log, columns), text))
    assert "the map says 'rudder' is positive to port" in answer
    assert "line 16" in answer
    assert "remove 'positive' from [columns.delta]" in answer


def test_channel_without_numbers(log, columns):
    columns["rate"] = np.full(400, np.nan)
    refused(write_csv(log, columns), "no numbers at all", "column 'rate'")
    columns["rate"] = ["off"] * 400
    refused(write_csv(log, columns), "the column of 'r' holds text", "'off'", "line 2")


def test_wrong_encoding(log, columns):
    log.write_bytes("Schüttgut\n".encode("cp1252") * 5)
    refused(log, "the log is not utf-8", "cp1252")


def test_header_where_there_is_none(log, columns):
    write_csv(log, columns, header=False)
    refused(log, "numbers where names of columns should be", "header = false", "line 1")


def test_time_in_no_order(log, columns):
    rng = np.random.default_rng(1)
    order = rng.permutation(400)
    refused(write_csv(log, {name: values[order] for name, values in columns.items()}), "not in the order of time")


def test_signs_that_the_motion_does_not_show(log, columns):
    straight = {name: np.zeros(400) for name in columns} | {"time": columns["time"], "shaft": columns["shaft"]}
    straight["ahead"] = np.full(400, 10.0)
    straight["north"] = 10.0 * 0.514444 * columns["time"]
    text = MAP.replace(', positive = "starboard"', "").replace('axes = "ship"', "")
    answer = refused(write_csv(log, straight), "is the yaw rate positive to starboard or to port?", text=text)
    assert "are u and v in ship axes or in earth axes?" in answer
    text = MAP.replace('"rudder", unit = "deg", positive = "starboard"', '"rudder", unit = "deg"')
    refused(log, "does a positive rudder angle turn the ship to starboard or to port?", text=text)


def test_several_logs_say_everything_at_once(tmp_path, columns):
    one = write_csv(tmp_path / "one.csv", {name: values for name, values in columns.items() if name != "east"})
    (tmp_path / "two.csv").write_bytes(b"")
    good = write_csv(tmp_path / "good.csv", columns)
    logs = [one, tmp_path / "two.csv", good]
    answer = refusal(lambda: import_logs(logs, parse_map(MAP), tmp_path / "out"))
    assert "column 'east' is missing" in answer
    assert "the log is empty" in answer
    assert not (tmp_path / "out").exists()


# what is marked or put right


def test_wraps_of_the_heading(log):
    trial = suzaku("turn_p35")
    assert np.ptp(trial.psi) > 2.0 * np.pi
    columns = logged(trial)
    # Half a turn's jumps are wraps of -180..180.
    columns["heading"] = np.mod(columns["heading"] + 180.0, 360.0) - 180.0
    close(imported(write_csv(log, columns)), trial)


def test_repeated_time_stamps(log, columns):
    doubled = {name: np.insert(values, 100, values[99]) for name, values in columns.items()}
    report = said(write_csv(log, doubled))
    assert "1 rows are written twice" in report
    assert "line 102" in report
    close(imported(log), turn())
    doubled["north"][100] += 0.1
    report = said(write_csv(log, doubled))
    assert "1 rows repeat a time stamp" in report
    assert "line 102" in report
    close(imported(log), turn())


def test_rows_written_twice_throughout_are_not_taken_for_coarse_stamps(log, columns):
    rows = np.arange(0, 400, 4)
    doubled = {name: np.insert(values, rows + 1, values[rows]) for name, values in columns.items()}
    assert "100 rows are written twice" in said(write_csv(log, doubled))
    close(imported(log), turn())


def test_stamps_of_whole_seconds_over_a_faster_log(log, columns):
    columns["time"] = np.floor(0.5 * columns["time"])
    for name in ("ahead", "abeam", "rate"):
        columns[name] *= 2.0
    report = said(write_csv(log, columns))
    assert "put back on a uniform step of 0.5 s" in report
    assert np.diff(imported(log).t) == pytest.approx(0.5)


def test_single_stamps_off_the_others(log, columns):
    columns["time"][50] = 3600.0
    columns["time"][200] = 3.0
    report = said(write_csv(log, columns))
    assert "2 rows have a time stamp off the others" in report
    assert "line 52" in report
    assert imported(log).n_samples == 400


def test_clock_set_back_cuts_the_record(log, columns):
    columns["time"][250:] -= 100.0
    result = import_logs([write_csv(log, columns)], parse_map(MAP), log.parent / "out")
    assert [path.name for path in result.files] == ["log_1.parquet", "log_2.parquet"]
    assert "the clock was set back by 99 s" in result.text()
    assert [trial.n_samples for trial in result.trials] == [250, 150]


def test_clock_set_forward_is_a_gap(log, columns):
    columns["time"][250:] += 100.0
    back = import_logs([write_csv(log, columns)], parse_map(MAP), log.parent / "out")
    # Controls are unknown in it as well: two trials.
    assert [trial.n_samples for trial in back.trials] == [250, 150]


def test_gaps_of_motion_are_marked_not_invented(log, columns):
    for name in ("north", "east"):
        columns[name][100:120] = np.nan
        columns[name][200:202] = np.nan
    back = imported(write_csv(log, columns))
    assert np.isnan(back.x[100:120]).all()
    assert np.isfinite(np.delete(back.x, [*range(100, 120), 200, 201])).all()
    assert "gap       x: 20 samples from 100 to 119 s" in said(log)


def test_rows_that_are_missing_are_bridged_and_counted(log, columns):
    kept = np.delete(np.arange(len(columns["time"])), [200, 201])
    result = import_logs(
        [write_csv(log, {name: values[kept] for name, values in columns.items()})], parse_map(MAP), log.parent / "out"
    )
    (trial,) = result.trials
    assert trial.n_samples == len(columns["time"])
    (counted,) = re.findall("bridged   .*", result.text())
    for name in ("x", "y", "psi", "n", "delta"):
        assert f"{name}: 2 samples" in counted
    assert "holes of up to 5 steps were bridged linearly" in result.text()


def test_gap_of_a_control_cuts_the_trial(log, columns):
    columns["rudder"][150:190] = np.nan
    columns["shaft"][300:302] = np.nan
    result = import_logs([write_csv(log, columns)], parse_map(MAP), log.parent / "out")
    assert [trial.n_samples for trial in result.trials] == [150, 210]
    assert "bridged   n: 2 samples" in result.text()
    assert "part 2 of 2 of the log, cut where delta is missing for 40 s (from 150 s of the log)" in result.text()
    for path in result.files:
        read_trial(path)


def test_spikes_are_marked_and_counted(log, columns):
    columns["north"][100] += 500.0
    columns["heading"][150] = (columns["heading"][150] + 90.0) % 360.0
    report = said(write_csv(log, columns))
    assert "spikes    x: 1, psi: 1" in report
    back = imported(log)
    assert np.isnan(back.x[100])
    assert np.isnan(back.psi[150])
    assert np.isfinite(back.x[99])


def test_rows_that_are_damaged(log, columns):
    write_csv(log, columns)
    lines = log.read_text().splitlines()
    lines[100] += ",1,2,3"
    lines[200] = lines[200][:20]
    lines[300] = ""
    lines[350] = lines[350].replace(",", ",?", 1)
    log.write_text("\n".join(lines))
    report = said(log)
    assert "1 line has too many fields and was dropped" in report
    assert "line 101" in report
    assert "row without a time was dropped" in report
    assert "1 cell of" in report
    back = imported(log)
    assert back.n_samples == 400
    assert np.isfinite(back.delta).all()


def test_orders_are_told_from_positions(log, columns):
    columns["rudder"] = np.where(columns["rudder"] > 0.0, 20.0, -20.0)
    assert "ORDERS?" in said(write_csv(log, columns))


def test_nmea_faults(tmp_path):
    trial = turn()
    lines = nmea(trial)
    lines[70] = lines[70].replace("$GP", "$GL")
    lines[300] = lines[300][:10]
    lines.insert(400, "\x02 noise")
    lines.insert(500, sentence("GPXXX,1,2"))
    log = tmp_path / "log.txt"
    log.write_text("\r\n".join(lines))
    report = said(log, 'schema = 1\n[log]\nformat = "nmea"\n')
    assert "1 sentences with a bad checksum were dropped, the first in line 71" in report
    preset = load_map("nmea-0183", preset=True)
    for kind, words in (
        ("RSA", "the rudder angle"),
        ("HDT", "a heading"),
        ("GGA", "a position"),
        ("RPM", "revolutions"),
    ):
        log.write_text("\n".join(line for line in lines if kind not in line))
        answer = refusal(lambda: import_logs([log], preset, tmp_path / "out"))
        assert words in answer
        assert f"log {kind}" in answer or "HDT or THS" in answer
    log.write_text("\n".join(line for line in lines if "RPM" not in line))
    text = 'schema = 1\n[log]\nformat = "nmea"\n[columns.n]\nvalue = "102 rpm"\n'
    assert imported(log, text).n[0] == pytest.approx(1.7)


def test_nmea_whose_clock_is_set_back(tmp_path):
    trial = turn()
    per = len(nmea(trial)) // trial.n_samples
    late, early = nmea(trial, start=40000.0, fast=1), nmea(trial, start=39800.0, fast=1)
    log = tmp_path / "log.nmea"
    log.write_text("\n".join([*late[: 250 * per], *early[250 * per :]]))
    result = import_logs([log], load_map("nmea-0183", preset=True), tmp_path / "out")
    assert [one.n_samples for one in result.trials] == [250, 150]
    assert "the clock was set back by 199 s" in result.text()


def test_nmea_whose_rudder_is_never_valid(tmp_path):
    log = tmp_path / "log.nmea"
    log.write_text("\n".join(sentence("IIRSA,0.0,V,,") if "RSA" in line else line for line in nmea(turn())))
    preset = load_map("nmea-0183", preset=True)
    assert "fewer than two valid samples of rudder angle" in refusal(lambda: import_logs([log], preset, tmp_path))
    log.write_text("\n".join(nmea(turn())[:7]))
    assert "fewer than two" in refusal(lambda: import_logs([log], preset, tmp_path))


def test_checksums():
    for length in range(0, 130):
        body = bytes(33 + (7 * k + length) % 90 for k in range(length))
        assert checksum(body) == reduce(xor, body, 0)


def test_nothing_is_replaced_silently(log, columns):
    write_csv(log, columns)
    out = log.parent / "out"
    import_logs([log], parse_map(MAP), out)
    with pytest.raises(OutputError, match="exists already"):
        import_logs([log], parse_map(MAP), out)
    import_logs([log], parse_map(MAP), out, overwrite=True)


def test_long_logs_are_thinned(log, columns, monkeypatch):
    monkeypatch.setattr("mmgtune.importing.formats.table.MOST_ROWS", 150)
    monkeypatch.setattr("mmgtune.importing.formats.text.BLOCK", 40)
    report = said(write_csv(log, columns))
    assert "the log has 400 rows; every 4th was kept, 100 in all" in report
    assert imported(log).t[1] == pytest.approx(4.0)
