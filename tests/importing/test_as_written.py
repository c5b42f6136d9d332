"""Dates and positions as people write them, workbooks, and MATLAB files."""

import datetime
import io
import struct
import zipfile
import zlib
from dataclasses import replace

import numpy as np
import openpyxl
import pandas as pd
import pytest
import scipy.io

from mmgtune.importing import propose_map
from mmgtune.importing.cells.dates import Dates
from mmgtune.importing.cells.degrees import degrees
from mmgtune.importing.cells.numerals import numbers_in
from mmgtune.importing.cells.stopwatch import in_digits, of_digits
from mmgtune.importing.formats import matlab, workbook
from mmgtune.importing.formats.sides import sided
from mmgtune.importing.proposing.sampling import sample_of
from mmgtune.limits import MATLAB_BYTES, SHEET_BYTES

from .made import MAP, UNITLESS, close, imported, printed, refusal, said, with_sides, write_csv

START = "2024-05-01 23:57:00"


def stamped(columns, form, start=START):
    """The same with dates for seconds."""
    stamps = [pd.Timestamp(start) + pd.Timedelta(seconds=float(t)) for t in columns["time"]]
    return {**columns, "time": [one.strftime(form) for one in stamps]}


# dates


@pytest.mark.parametrize("as_text", [True, False])
def test_times_of_day_in_digits(tmp_path, columns, plain, as_text):
    """235959 is followed by 000000; as numbers they jump at every full minute, and no longitude is a time."""
    stamps = stamped(columns, "%H%M%S")["time"]
    columns["time"] = [f"{one}.00" for one in stamps] if as_text else [int(one) for one in stamps]
    log = write_csv(tmp_path / "log.csv", {**columns, "lon": np.linspace(139.0, 139.1, 400)})
    proposal = propose_map([log])
    assert proposal.map().time.format == "hhmmss"
    assert proposal.asks == ()
    close(imported(log, proposal.text), plain, 1e-8)


def test_numbers_that_are_no_times_of_day():
    assert not in_digits(np.arange(0.0, 400.0))
    assert not in_digits(np.arange(0.0, 4000.0, 100.0))
    assert in_digits(np.array([5957.0, 5958.0, 5959.0, *np.arange(10000.0, 10008.0)]))
    assert of_digits(np.array([235959.5, 240000.0, 6000.0, -1.0])) == pytest.approx(
        [86399.5] + 3 * [np.nan], nan_ok=True
    )


@pytest.mark.parametrize("form", ["%Y-%m-%dT%H:%M:%S", "%H:%M:%S", ""])
def test_rows_that_are_written_newest_first(tmp_path, columns, plain, form):
    found = stamped(columns, form) if form else columns
    log = write_csv(tmp_path / "log.csv", pd.DataFrame(found)[::-1].to_dict("list"))
    proposal = propose_map([log])
    assert proposal.asks == proposal.problems == ()
    close(imported(log, proposal.text), plain, 1e-8)
    assert "the rows are written newest first, and were turned round" in said(log, proposal.text)


# numbers


def test_thousands_with_a_comma(tmp_path, columns, plain):
    columns["north"] = [f"{one:,.9f}" for one in columns["north"]]
    columns["east"] = [f"{one + 1e6:,.6f}" for one in columns["east"]]
    log = write_csv(tmp_path / "log.csv", columns, quoting=1)
    back = imported(log)
    assert np.abs(back.x - plain.x).max() < 1e-6
    assert np.abs(back.y - 1e6 - plain.y).max() < 1e-5
    assert propose_map([log]).problems == ()


@pytest.mark.parametrize(
    ("texts", "numbers"),
    [
        (["1,001.5", "999", "-2,000"], [1001.5, 999.0, -2000.0]),
        (["1,234,567", "3"], [1234567.0, 3.0]),
        (["3,141", "2,5"], [np.nan, np.nan]),  # decimal commas
        (["3,141", "2,718"], [np.nan, np.nan]),  # as good as those
        (["1,001.5", "2,5"], [np.nan, np.nan]),
    ],
)
def test_commas_that_no_decimal_sign_can_be(texts, numbers):
    assert numbers_in(pd.Series(texts, dtype="string"), ".") == pytest.approx(numbers, nan_ok=True)


def test_cells_that_say_their_unit(tmp_path, columns, plain):
    units = {"ahead": " kn", "abeam": "kn", "heading": "°", "rate": " °/min", "rudder": " deg", "shaft": " rpm"}
    for name, unit in units.items():
        columns[name] = [f"{one:.9f}{unit}" for one in columns[name]]
    columns["rate"][7] = "N/A"
    log = write_csv(tmp_path / "log.csv", columns)
    assert propose_map([log]).problems == ()
    assert np.abs(imported(log).u - plain.u).max() < 1e-8
    wrong = MAP.replace('column = "ahead", unit = "kn"', 'column = "ahead", unit = "m/s"')
    assert "the map says 'ahead' is in m/s, its cells say kn" in refusal(lambda: imported(log, wrong))
    columns["ahead"][5] = "3.1 m/s"
    assert "a cell has a unit of its own, 'kn'" in refusal(lambda: imported(write_csv(tmp_path / "b.csv", columns)))


@pytest.mark.parametrize("order", ["dmy", "mdy", "ymd"])
def test_days_are_those_of_the_calendar(order):
    rng = np.random.default_rng(1)
    days = [datetime.date.fromordinal(int(one)) for one in rng.integers(693596, 802685, 500)]  # 1900 to 2199
    form = {"dmy": "%d/%m/%Y", "mdy": "%m/%d/%Y", "ymd": "%Y/%m/%d"}[order]
    texts = pd.Series([f"{one.strftime(form)} 12:30:15.5" for one in days], dtype="string")
    expected = [86400.0 * (one - datetime.date(1970, 1, 1)).days + 45015.5 for one in days]
    assert Dates(texts).since(order).tolist() == expected


@pytest.mark.parametrize(
    "text",
    [
        "31/02/2024 10:00",
        "29/02/2023 10:00",
        "00/05/2024 10:00",
        "01/13/2024 10:00",
        "1/5/2024 25:00",
        "1/5/2024 10:61",
    ],
)
def test_days_that_are_not(text):
    assert np.isnan(Dates(pd.Series([text], dtype="string")).since("dmy")).all()


@pytest.mark.parametrize(
    "form",
    [
        "%d/%m/%Y %H:%M:%S", "%m/%d/%Y %H:%M:%S", "%m/%d/%Y %I:%M:%S %p", "%d.%m.%y %H:%M:%S", "%d-%b-%Y %H:%M:%S",
        "%Y/%m/%d %H:%M:%S", "%H:%M:%S", "%I:%M:%S %p", "%Y-%m-%d %H:%M:%S CET", "%d/%m/%Y %H:%M:%S +0200",
        "%d/%m/%YT%H:%M:%SZ", "%d-%m-%Y %H.%M.%S", "%Y-%m-%dT%H:%M:%S+09:00",
    ],
)  # fmt: skip
def test_stamps_over_midnight(tmp_path, columns, plain, form):
    close(imported(write_csv(tmp_path / "log.csv", stamped(columns, form)), UNITLESS), plain)


MONTHS = {
    "en": "january february march april may june july august september october november december",
    "nl": "januari februari maart april mei juni juli augustus september oktober november december",
    "de": "januar februar märz april mai juni juli august september oktober november dezember",
    "de, short": "jän feb mrz apr mai jun jul aug sep okt nov dez",
    "fr": "janvier février mars avril mai juin juillet août septembre octobre novembre décembre",
    "fr, short": "janv. févr. mars avr. mai juin juil. août sept. oct. nov. déc.",
    "fr, plain": "janvier fevrier mars avril mai juin juillet aout septembre octobre novembre decembre",
    "it": "gennaio febbraio marzo aprile maggio giugno luglio agosto settembre ottobre novembre dicembre",
    "es": "enero febrero marzo abril mayo junio julio agosto septiembre octubre noviembre diciembre",
    "es, short": "ene feb mar abr may jun jul ago sept oct nov dic",
    "pt": "janeiro fevereiro março abril maio junho julho agosto setembro outubro novembro dezembro",
    "pt, short": "jan fev mar abr mai jun jul ago set out nov dez",
    "sv": "januari februari mars april maj juni juli augusti september oktober november december",
    "da": "januar februar marts april maj juni juli august september oktober november december",
    "no": "januar februar mars april mai juni juli august september oktober november desember",
    "pl": "stycznia lutego marca kwietnia maja czerwca lipca sierpnia września października listopada grudnia",
    "pl, short": "sty lut mar kwi maj cze lip sie wrz paź lis gru",
}


@pytest.mark.parametrize("language", MONTHS)
@pytest.mark.parametrize("mark", "-/ ")
def test_months_by_name(language, mark):
    for number, month in enumerate(MONTHS[language].split(), start=1):
        texts = pd.Series([f"12{mark}{one}{mark}2024 10:00:00" for one in (month, month.title())], dtype="string")
        expected = (datetime.date(2024, number, 12) - datetime.date(1970, 1, 1)).days * 86400.0 + 36000.0
        assert Dates(texts).since("dmy").tolist() == [expected, expected], month


def test_stamps_without_seconds(tmp_path, columns, plain):
    minutes = {**columns, "time": 60.0 * columns["time"]}
    trial = imported(write_csv(tmp_path / "log.csv", stamped(minutes, "%d/%m/%Y %H:%M")), slow(UNITLESS))
    assert trial.t == pytest.approx(60.0 * (plain.t - plain.t[0]))


def slow(text):
    """The map of a log without its velocities and its yaw rate."""
    return "\n".join(line for line in text.splitlines() if not line.startswith(("u =", "v =", "r =")))


def test_one_day_leaves_its_order_open(tmp_path, columns, plain):
    log = write_csv(tmp_path / "log.csv", stamped(columns, "%d/%m/%Y %H:%M:%S", "2024-05-01 10:00:00"))
    trial = imported(log, UNITLESS)
    close(trial, plain)
    assert "dates are read" not in trial.note


def test_order_is_asked_where_nothing_shows_it(tmp_path, columns):
    # From 1 February to 5 July, or from 2 January to 7 May.
    stamps = [f"{'01/02' if k < 200 else '05/07'}/2024 10:{k // 60:02d}:{k % 60:02d}" for k in range(400)]
    log = write_csv(tmp_path / "log.csv", {**columns, "time": stamps})
    assert 'say format = "dmy" or format = "mdy" in [time]' in refusal(lambda: imported(log, UNITLESS))


def test_what_the_map_says_counts(tmp_path, columns, plain):
    log = write_csv(tmp_path / "log.csv", stamped(columns, "%d/%m/%Y %H:%M:%S"))
    close(imported(log, UNITLESS.replace('"time"', '"time"\nformat = "dmy"')), plain)
    assert "time" in refusal(lambda: imported(log, UNITLESS.replace('"time"', '"time"\nformat = "ymd"')))


def test_serial_days(tmp_path, columns, plain):
    log = write_csv(tmp_path / "log.csv", {**columns, "time": 45413.9 + columns["time"] / 86400.0})
    assert 'unit = "d"' in refusal(lambda: imported(log, UNITLESS))
    close(imported(log, MAP.replace('unit = "s"', 'unit = "d"')), plain, 1e-5)


# positions


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("52°06.00001'N", 52.1 + 1e-5 / 60.0), ("52 06.6 N", 52.11), ("52°06'36\"N", 52.11), ("N52°06.6'", 52.11),
        ("5206.6N", 52.11), ("52.11 N", 52.11), ("00406.6W", -4.11), ("4°06,6'W", -4.11), ("-4°06.6'", -4.11),
        ("52:06:36 S", -52.11), ("52°61'N", np.nan), ("N 4 W", np.nan), ("52.11", np.nan), ("4°O", np.nan),
        ("51°60,0000'N", 52.0), ("51°59'60\"N", 52.0),  # rounded up
        ("52-06.6N", 52.11), ("S 52-06.6", -52.11), ("52-06.6", np.nan), ("2024-05-14", np.nan),
        ("", np.nan), ("💥", np.nan), ("1" * 5000, np.nan),
    ],
)  # fmt: skip
def test_degrees(text, value):
    found = degrees(pd.Series([text], dtype="string"))
    assert found == pytest.approx([value], abs=1e-12, nan_ok=True)


def test_positions_in_degrees_and_minutes(tmp_path, columns):
    import pyproj

    project = pyproj.Transformer.from_crs(
        "+proj=tmerc +lat_0=52 +lon_0=4 +k_0=1 +ellps=WGS84", "EPSG:4326", always_xy=True
    )
    lon, lat = project.transform(columns["east"], columns["north"])
    text = MAP.replace('x = { column = "north", unit = "m" }', 'latitude = { column = "north" }')
    text = text.replace('y = { column = "east", unit = "m" }', 'longitude = { column = "east" }')
    text += "[position]\norigin = [52.0, 4.0]\n"
    written = {
        **columns,
        "north": [f"{int(one)}°{60.0 * (one - int(one)):.7f}'N" for one in lat],
        "east": [f"{int(one)}°{60.0 * (one - int(one)):.7f}'E" for one in lon],
    }
    trial = imported(write_csv(tmp_path / "log.csv", written), text)
    assert trial.x == pytest.approx(columns["north"], abs=1e-3)
    assert trial.y == pytest.approx(columns["east"], abs=1e-3)


# sides


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("35.0S", 35.0), ("0.1 P", -0.1), ("p10", -10.0), ("STBD 5", 5.0), ("5,5 StB", 5.5), ("12 BB", -12.0),
        ("3 Port", -3.0), (".5S", 0.5), ("Stb. 5", 5.0), ("0.0", 0.0), ("0P", 0.0),
        ("MID", 0.0), ("Midships", 0.0), ("AMIDSHIPS", 0.0), ("Centre", 0.0), ("center", 0.0), ("zero", 0.0),
        ("MS", 0.0), ("Mittschiffs", 0.0), ("mitt", 0.0), ("Mitte", 0.0), ("mid 0.0", 0.0), ("0 MID", 0.0),
        ("MID 5", np.nan), ("null", np.nan), ("middle of it", np.nan),
        ("10", np.nan), ("-3P", np.nan), ("P 3 S", np.nan),
        ("P", np.nan), ("5 SE", np.nan), ("5N", np.nan), ("", np.nan), ("1" * 5000, np.nan), (None, np.nan),
    ],
)  # fmt: skip
def test_sides(text, value):
    found = sided(pd.Series([text], dtype="string"), ",")
    assert found == pytest.approx([value], abs=1e-12, nan_ok=True)


@pytest.mark.parametrize(
    ("form", "sides"), [("{size}{side}", "PS"), ("{side} {size}", "Port Stbd"), ("{size} {side}", "BB StB")]
)
def test_rudder_and_yaw_rate_with_sides(tmp_path, columns, plain, form, sides):
    """Nothing of the map says to which side they count, and nothing is asked."""
    sided_ones = {name: with_sides(columns[name], form, sides) for name in ("rudder", "rate")}
    log = write_csv(tmp_path / "log.csv", {**columns, **sided_ones})
    text = MAP.replace('"deg", positive = "starboard"', '"deg"').replace(
        '"deg/min", positive = "starboard"', '"deg/min"'
    )
    close(imported(log, text), plain, 1e-7)
    proposal = propose_map([log])
    assert (proposal.problems, proposal.asks, proposal.imported) == ((), (), 1)
    close(imported(log, proposal.text), plain, 1e-7)
    assert "its cells say the side" in proposal.guesses["delta"].evidence


def amidships(columns):
    """The same with a rudder that stands amidships from 150 to 190 s, and its cells with sides but for those."""
    rudder = np.round(columns["rudder"], 9)
    rudder[150:190] = 0.0
    cells = ["MID" if one == 0.0 else cell for one, cell in zip(rudder, with_sides(rudder), strict=True)]
    return {**columns, "rudder": rudder}, {**columns, "rudder": cells}


def test_amidships_is_zero(tmp_path, columns):
    """Not a gap, at which the log was cut into several trials; without sides, too."""
    numbers, cells = amidships(columns)
    text = MAP.replace('"deg", positive = "starboard"', '"deg"')
    as_numbers = imported(write_csv(tmp_path / "plain.csv", numbers))
    trial = imported(write_csv(tmp_path / "log.csv", cells), text)
    close(trial, as_numbers, 1e-7)
    assert "are no number" not in trial.note
    proposal = propose_map([tmp_path / "log.csv"])
    assert (proposal.problems, proposal.asks, proposal.imported, proposal.cuts) == ((), (), 1, ())
    count = cells["rudder"].count("MID")
    assert f"'rudder': {count} cells such as 'MID' are 0" in proposal.notes
    signed = ["MID" if one == 0.0 else f"{one:.9f}" for one in numbers["rudder"]]
    close(imported(write_csv(tmp_path / "signed.csv", {**cells, "rudder": signed})), as_numbers, 1e-7)
    as_gaps = said(tmp_path / "log.csv", text.replace("[time]", '[log]\nmissing = ["MID"]\n[time]'))
    assert "part 2 of 2 of the log, cut where delta is missing for 40 s (from 150 s of the log)" in as_gaps


def test_cells_that_cannot_be_read_are_told_by_the_map(tmp_path, columns):
    cells = amidships(columns)[1]
    cells["rudder"] = [cell.replace("MID", "?!") for cell in cells["rudder"]]
    proposal = propose_map([write_csv(tmp_path / "log.csv", cells)])
    count = cells["rudder"].count("?!")
    what = f"'rudder': {count} of 400 cells are no numbers and become gaps, the first is '?!' ({tmp_path / 'log.csv'})"
    assert proposal.notes == (what,)
    assert proposal.imported == 2
    why = ("log.csv is cut where delta is missing for 40 s (from 150 s of the log)",)
    assert proposal.cuts == why
    lines = proposal.lines()
    assert lines[lines.index("the map imports the log, as 2 trials") + 1].strip() == why[0]


def test_a_wind_from_the_bow_with_its_side(tmp_path, columns):
    wind = np.full(len(columns["time"]), -45.0)
    log = write_csv(tmp_path / "log.csv", {**columns, "wind": with_sides(wind)})
    trial = imported(log, MAP + 'wind_dir_app = { column = "wind", unit = "deg", direction = "from" }\n')
    assert np.degrees(trial.extra["wind_dir_app"]) == pytest.approx(315.0)


# workbooks


def book(rows, title="log", others=()):
    made = openpyxl.Workbook()
    made.active.title = title
    for row in rows:
        made.active.append(row)
    for name in others:
        made.create_sheet(name, 0)
    file = io.BytesIO()
    made.save(file)
    return file.getvalue()


def as_rows(columns):
    return [list(columns), *zip(*(np.asarray(one).tolist() for one in columns.values()), strict=True)]


def test_workbook(tmp_path, columns, plain):
    path = tmp_path / "log.xlsx"
    path.write_bytes(book([["measured by X"], [], *as_rows(columns)], others=("cover",)))
    skipping = MAP.replace("[time]", "[log]\nskip = 2\n[time]")
    close(imported(path, skipping), plain)
    close(imported(path, skipping.replace("skip = 2", 'skip = 2\nsheet = "log"')), plain)
    assert "no sheet 'Log'" in refusal(lambda: imported(path, skipping.replace("skip = 2", 'skip = 2\nsheet = "Log"')))
    assert "column 'time' is missing" in refusal(lambda: imported(path))
    path.write_bytes(book(as_rows(columns)[1:]))
    numbered = MAP.replace("[time]", "[log]\nheader = false\nfields = 9\n[time]")
    for k, name in enumerate(columns, 1):
        numbered = numbered.replace(f'column = "{name}"', f"column = {k}")
    close(imported(path, numbered), plain)
    assert "rows of 8" in refusal(lambda: imported(path, numbered.replace("= 9\n[", "= 8\n[")))


@pytest.mark.parametrize("decimal", [".", ","])
def test_workbook_of_texts(tmp_path, columns, plain, decimal):
    path = tmp_path / "log.xlsx"
    path.write_bytes(book(as_rows(printed(columns, decimal)), others=("cover",)))
    close(imported(path, MAP if decimal == "." else MAP + '[log]\ndecimal = ","\n'), plain, 1e-6)
    assert sample_of(path).layout.get("decimal", ".") == decimal


def test_workbook_with_dates(tmp_path, columns, plain):
    stamps = [datetime.datetime(2024, 5, 1, 23, 57) + datetime.timedelta(seconds=t) for t in columns["time"].tolist()]
    path = tmp_path / "log.xlsx"
    path.write_bytes(book(as_rows({**columns, "time": stamps})))
    close(imported(path, UNITLESS), plain)
    path.write_bytes(book(as_rows({**columns, "time": [one.time() for one in stamps]})))
    close(imported(path, UNITLESS), plain)


def test_workbook_with_formulas(tmp_path, columns):
    rows = as_rows(columns)
    rows = [rows[0], *([*row[:3], f"=B{k}*2", *row[4:]] for k, row in enumerate(rows[1:], 2))]
    path = tmp_path / "log.xlsx"
    path.write_bytes(book(rows))
    assert "holds formulas without results" in refusal(lambda: imported(path))


def test_hostile_workbooks(tmp_path, columns, monkeypatch):
    monkeypatch.setattr(workbook, "SHEET_BYTES", replace(SHEET_BYTES, most=1 << 20))
    path = tmp_path / "log.xlsx"
    whole = book(as_rows(columns))

    def with_part(name, content):
        out = io.BytesIO()
        with zipfile.ZipFile(io.BytesIO(whole)) as old, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as new:
            for one in old.namelist():
                new.writestr(one, content if one == name else old.read(one))
        return out.getvalue()

    sheet = "xl/worksheets/sheet1.xml"
    cases = {
        b"PK\x03\x04" + bytes(100): "cannot be read",
        with_part(sheet, b"<!DOCTYPE a [<!ENTITY b 'c'>]><a/>"): "declares a document type",
        with_part(sheet, b"<worksheet" + b" " * (2 << 20)): "the limit is",
        with_part("xl/workbook.xml", b"<a/>"): "no sheet with cells",
        with_part("[Content_Types].xml", b""): "cannot be read",
        whole[:2000]: "cannot be read",
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600): "older kind",
        book([]): "no sheet with cells",
    }
    for content, words in cases.items():
        path.write_bytes(content)
        said = refusal(lambda: imported(path))
        assert words in said or "no rows" in said, (words, said)


def rewritten(whole, old_text, new_text):
    """A workbook with a text in its parts replaced."""
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(whole)) as old, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as new:
        for one in old.namelist():
            new.writestr(one, old.read(one).replace(old_text, new_text))
    return out.getvalue()


def test_a_sheet_that_says_it_is_huge(tmp_path, columns, plain):
    whole = book(as_rows(columns))
    (tmp_path / "log.xlsx").write_bytes(rewritten(whole, b'ref="A1:I401"', b'ref="A1:XFD1048576"'))
    close(imported(tmp_path / "log.xlsx"), plain)


def test_a_row_beyond_those_that_sheets_have(tmp_path, columns):
    whole = book(as_rows(columns))
    (tmp_path / "log.xlsx").write_bytes(rewritten(whole, b'<row r="9"', b'<row r="99999999999"'))
    assert "a sheet of 1048577 rows" in refusal(lambda: imported(tmp_path / "log.xlsx"))


# MATLAB files


def saved(path, held, **how):
    scipy.io.savemat(path, held, **how)
    return path


@pytest.mark.parametrize("compressed", [False, True])
def test_matlab(tmp_path, columns, plain, compressed):
    path = tmp_path / "log.mat"
    close(imported(saved(path, columns, do_compression=compressed)), plain)
    more = {"log": columns, "L": 320.0, "name": "a ship", "cells": np.array([[1, "a"]], dtype=object)}
    close(imported(saved(path, more, do_compression=compressed)), plain)
    named = MAP.replace("[time]", '[log]\nvariable = "log"\n[time]')
    close(imported(path, named), plain)
    assert "no variable 'lag'" in refusal(lambda: imported(path, named.replace('"log"', '"lag"')))
    numbered = MAP
    for k, name in enumerate(columns, 1):
        numbered = numbered.replace(f'column = "{name}"', f'column = "data {k}"')
    matrix = {"data": np.column_stack(list(columns.values())).astype(np.float64)}
    close(imported(saved(path, matrix, do_compression=compressed), numbered), plain)


def test_matlab_numbers_of_all_types(tmp_path, columns):
    held = {
        kind: np.arange(30, dtype=kind).reshape(5, 6) for kind in ("i1", "u1", "i2", "u2", "i4", "u4", "i8", "f4", "f8")
    }
    found = matlab.variables(saved(tmp_path / "log.mat", held))
    assert {name: one.tolist() for name, one in found.items()} == {name: one.tolist() for name, one in held.items()}


def test_hostile_matlab_files(tmp_path, columns, monkeypatch):
    monkeypatch.setattr(matlab, "MATLAB_BYTES", replace(MATLAB_BYTES, most=1 << 20))
    path = saved(tmp_path / "log.mat", columns)
    whole = path.read_bytes()
    bomb = zlib.compress(bytes(2 << 20), 9)
    deep = b""
    for _ in range(300):
        body = struct.pack("<IIII", 6, 8, 1, 0) + struct.pack("<IIii", 5, 8, 1, 1) + struct.pack("<II", 1, 0) + deep
        deep = struct.pack("<II", 14, len(body)) + body
    cases = {
        whole[:5000]: "are left",
        whole[:128] + struct.pack("<II", 15, len(bomb)) + bomb: "the limit",
        whole[:128] + deep: "no columns of numbers",
        b"MATLAB 7.3 MAT-file" + bytes(600): "version 7.3",
        b"\x89HDF\r\n\x1a\n" + bytes(600): "version 7.3",
        b"MATLAB 5.0" + bytes(600): "no MATLAB file of version 5",
        whole[:128] + struct.pack("<II", 14, 2**31): "are left",
        whole[:128]: "no columns of numbers",
    }
    for content, words in cases.items():
        path.write_bytes(content)
        assert words in refusal(lambda: imported(path)), words


def test_report_of_a_workbook_counts_rows(tmp_path, columns):
    rows = as_rows({**columns, "time": columns["time"]})
    rows[10] = [None, *rows[10][1:]]
    (tmp_path / "log.xlsx").write_bytes(book(rows))
    assert "row 11" in said(tmp_path / "log.xlsx")
