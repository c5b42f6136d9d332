"""What stands in several columns of a log: hours, minutes and seconds; degrees, minutes and hemisphere."""

import numpy as np
import pandas as pd
import pyproj
import pytest

from mmgtune.importing import import_logs, parse_map, propose_map
from tests.command import run

from .made import MAP, close, imported, logged, refusal, turn, write_csv

STAMPS = 'column = ["Hour", "Min", "Sec"]\nunit = ["h", "min", "s"]'
PARTED = MAP.replace('column = "time"\nunit = "s"', STAMPS)


def clock(trial, names=("Hour", "Min", "Sec"), start=86390.0):
    """A trial's columns with the time of day in three of them, over midnight."""
    columns = logged(trial)
    t = np.mod(start + columns.pop("time"), 86400.0)
    parts = ((t // 3600.0).astype(int), (t % 3600.0 // 60.0).astype(int), np.round(t % 60.0, 6))
    return dict(zip(names, parts, strict=True)) | columns


# time


@pytest.mark.parametrize(
    ("names", "how"),
    [
        (("Hour", "Min", "Sec"), {}),
        (("Stunde", "Minute", "Sekunde"), {"sep": ";", "decimal": ","}),
        (("HH", "MM", "SS"), {"sep": "\t"}),
        (("UTC_h", "UTC_m", "UTC_s"), {}),
        (("Time [h]", "Time [min]", "Time [s]"), {}),
        (("heures", "minutes", "secondes"), {"sep": ";", "decimal": ","}),
    ],
)
def test_a_map_of_hours_minutes_and_seconds(tmp_path, names, how):
    trial = turn()
    log = write_csv(tmp_path / "log.csv", clock(trial, names), **how)
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    assert (proposal.guesses["t"].keys["column"], proposal.guesses["t"].keys["unit"]) == ([*names], ["h", "min", "s"])
    close(imported(log, proposal.text), trial)


def test_dates_beside_them_are_not_needed(tmp_path):
    trial = turn()
    dates = {"Year": 2024, "Month": 5, "Day": np.where(trial.t < 10.0, 30, 31)}
    log = write_csv(tmp_path / "log.csv", dates | clock(trial))
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == proposal.left == ()
    assert "the date in 'Year', 'Month' and 'Day' is not needed" in "; ".join(proposal.guesses["t"].evidence)
    close(imported(log, proposal.text), trial)


def test_milliseconds_of_their_own(tmp_path):
    trial = turn()
    columns = clock(trial, start=86390.25)
    seconds = columns.pop("Sec")
    columns = {"Hour": columns.pop("Hour"), "Min": columns.pop("Min"), "Sec": seconds // 1.0} | {
        "ms": np.round(1000.0 * (seconds % 1.0)),
        **columns,
    }
    log = write_csv(tmp_path / "log.csv", columns)
    proposal = propose_map(log)
    assert proposal.guesses["t"].keys["unit"] == ["h", "min", "s", "ms"]
    close(imported(log, proposal.text), trial)


def test_newest_first_and_a_row_of_units(tmp_path):
    trial = turn()
    columns = clock(trial)
    frame = pd.DataFrame(columns)[::-1].astype(str)
    units = pd.DataFrame([["h", "min", "s", "m", "m", "deg", "kn", "kn", "deg/min", "rpm", "deg"]], columns=[*columns])
    log = tmp_path / "log.csv"
    pd.concat([units, frame]).to_csv(log, index=False)
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    close(imported(log, proposal.text), trial)


def test_what_bounds_a_column_is_not_time(tmp_path):
    """Least and greatest are called min and max."""
    columns = logged(turn())
    noise = np.random.default_rng(1).uniform(0.0, 50.0, len(columns["time"]))
    log = write_csv(tmp_path / "log.csv", columns | {"Torque min": noise // 1.0, "min": noise // 1.0, "sec": noise})
    assert propose_map(log).guesses["t"].column == 0


@pytest.mark.parametrize("form", ["parquet", "xlsx"])
def test_of_other_files(tmp_path, form):
    trial, log = turn(), tmp_path / f"log.{form}"
    frame = pd.DataFrame(clock(trial))
    frame.to_parquet(log) if form == "parquet" else frame.to_excel(log, index=False)
    close(imported(log, PARTED), trial)
    close(imported(log, propose_map(log).text), trial)


def test_a_row_that_lacks_a_part_has_no_time(tmp_path):
    columns = clock(turn())
    columns["Sec"] = np.where(np.arange(len(columns["Sec"])) == 50, np.nan, columns["Sec"])
    columns["Min"] = np.where(np.arange(len(columns["Sec"])) == 80, 75, columns["Min"])
    log = write_csv(tmp_path / "log.csv", columns)
    (quality,) = import_logs(log, parse_map(PARTED), ".", dry_run=True).quality
    assert any("2 rows without a time were dropped, the first in" in note for note in quality["notes"])


@pytest.mark.parametrize(
    ("stamps", "told"),
    [
        ('column = ["Hour", "Min", "Sec"]', "time has several columns and no units"),
        ('column = ["Hour", "Min"]\nunit = ["min", "h"]', "the longest first"),
        ('column = ["Hour", "Min"]\nunit = ["h"]', "for 2 columns of time"),
        ('column = ["Hour", "Min"]\nunit = ["h", "kn"]', "'time.unit' is ['h', 'kn']"),
        ("column = []\nunit = []", "for 0 columns of time"),
        ('column = ["Hour", ""]\nunit = ["h", "min"]', "'time.column' is"),
        (f'{STAMPS}\nformat = "clock"', "'time.format' has no meaning for time in several columns"),
        (STAMPS.replace("Min", "Minuten"), "column 'Minuten' is missing from the log"),
        ('column = ["Hour", "Hour"]\nunit = ["h", "min"]', "column 'Hour' is named twice for time"),
        ('column = ["Hour", "Zone"]\nunit = ["h", "min"]', "it has no numbers at all"),
        ('column = ["rudder", "Min"]\nunit = ["h", "min"]', "does not hold the hours of a time in several columns"),
        ('column = ["Sec", "Hour", "Min"]\nunit = ["h", "min", "s"]', "does not hold the hours"),
    ],
)
def test_what_is_wrong_with_columns_of_time_is_told(tmp_path, stamps, told):
    log = write_csv(tmp_path / "log.csv", clock(turn()) | {"Zone": "UTC"})
    (tmp_path / "map.toml").write_text(MAP.replace('column = "time"\nunit = "s"', stamps), encoding="utf-8")
    ended = run("trials", "import", str(log), "--map", "map.toml", "-o", "out", cwd=tmp_path)
    assert ended.code == 2
    assert told in ended.err


def test_a_header_that_says_another_unit_than_the_map(tmp_path):
    log = write_csv(tmp_path / "log.csv", clock(turn(), ("Hour", "M [min]", "S [s]")))
    text = PARTED.replace('"Min", "Sec"', '"S", "M"')
    assert "the map says 'S [s]' is in min, its header says s" in refusal(lambda: imported(log, text))


# positions

NAMES = ("lat_deg", "lat_min", "lat_NS", "lon_deg", "lon_min", "lon_EW")


def fixed(trial, origin=(35.0, 139.0)):
    """A trial's columns with latitude and longitude in place of its positions, as decimal degrees."""
    columns = logged(trial)
    crs = f"+proj=tmerc +lat_0={origin[0]} +lon_0={origin[1]} +ellps=WGS84 +k_0=1"
    project = pyproj.Transformer.from_crs(crs, "EPSG:4326", always_xy=True)
    lon, lat = project.transform(columns.pop("east"), columns.pop("north"))
    return {"time": columns.pop("time"), "lat": lat, "lon": lon} | columns


def split(columns, names=NAMES, letters=True, signed="degrees"):
    """The same with degrees and minutes apart.

    letters  with the hemisphere; without, where the sign stands: with the "degrees" (-0 too), the "minutes", or "both"
    """
    out = {"time": columns["time"]}
    for name, sides, own in (("lat", "NS", names[:3]), ("lon", "EW", names[3:])):
        value = columns[name]
        minus, size = value < 0.0, np.abs(value)
        degrees = np.floor(size).astype(int)
        minutes = (size - degrees) * 60.0
        sign = np.where(minus & (not letters), "-", "")
        before = [sign if signed in (part, "both") or letters else "" for part in ("degrees", "minutes")]
        if signed == "minutes" and not letters:
            before = ["", sign]
            before[0] = np.where(degrees > 0, sign, "")
        out[own[0]] = [f"{a}{b}" for a, b in zip(np.broadcast_to(before[0], len(value)), degrees, strict=True)]
        out[own[1]] = [f"{a}{b:.9f}" for a, b in zip(np.broadcast_to(before[1], len(value)), minutes, strict=True)]
        if letters:
            out[own[2]] = np.where(minus, sides[1], sides[0])
    return out | {name: one for name, one in columns.items() if name not in ("lat", "lon", "time")}


def one_column(tmp_path, columns):
    """The trial of the same positions in one column each."""
    log = write_csv(tmp_path / "plain.csv", columns)
    geographic = 'latitude = { column = "lat", unit = "deg" }\nlongitude = { column = "lon", unit = "deg" }'
    text = MAP.replace('x = { column = "north", unit = "m" }\ny = { column = "east", unit = "m" }', geographic)
    assert geographic in text
    return imported(log, text)


ORIGINS = [(35.0, 139.0), (-33.5, -70.0001), (0.0001, -0.0001), (-0.5, 0.9999), (59.99995, -0.5)]
"""With minutes that begin anew, degrees that are -0, and a change of hemisphere."""


@pytest.mark.daily("origin1", "origin3")
@pytest.mark.parametrize("origin", ORIGINS)
@pytest.mark.parametrize("signed", ["letters", "degrees", "minutes", "both"])
def test_degrees_and_minutes_of_all_quarters(tmp_path, origin, signed):
    columns = fixed(turn(), origin)
    log = write_csv(tmp_path / "log.csv", split(columns, letters=signed == "letters", signed=signed))
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    parts = ("minutes", "hemisphere") if signed == "letters" else ("minutes",)
    for one, own in (("latitude", NAMES[:3]), ("longitude", NAMES[3:])):
        keys = proposal.guesses[one].keys
        assert [keys[part] for part in parts] == list(own[1 : 1 + len(parts)])
    close(imported(log, proposal.text), one_column(tmp_path, columns), 1e-6)


@pytest.mark.parametrize(
    ("names", "how"),
    [
        (("Lat Grad", "Lat Minuten", "N/S", "Lon Grad", "Lon Minuten", "E/W"), {"sep": ";", "decimal": ","}),
        (("Lat deg", "min", "hemi", "Lon deg", "min.1", "hemi.1"), {"sep": "\t"}),
        (("Breite [deg]", "Breite [min]", "NS", "L\u00e4nge [deg]", "L\u00e4nge [min]", "EW"), {"sep": ";"}),
        (("LAT\u00b0", "LAT'", "LAT H", "LON\u00b0", "LON'", "LON H"), {}),
        (("Breite Grad", "Breite Min", "N/S", "Laenge Grad", "Laenge Min", "E/W"), {"sep": ";", "decimal": ","}),
    ],
)
def test_names_of_degrees_and_minutes(tmp_path, names, how):
    columns = fixed(turn(), (-33.5, -70.0001))
    parted = split(columns, names)
    if how.pop("decimal", "") == ",":
        parted = {name: [str(one).replace(".", ",") for one in values] for name, values in parted.items()}
    log = write_csv(tmp_path / "log.csv", parted, **how)
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    assert [proposal.guesses["latitude"].keys[one] for one in ("minutes", "hemisphere")] == list(names[1:3])
    close(imported(log, proposal.text), one_column(tmp_path, columns), 1e-6)


@pytest.mark.parametrize("form", ["parquet", "xlsx"])
def test_degrees_and_minutes_of_other_files(tmp_path, form):
    columns = fixed(turn(), (-33.5, -70.0001))
    frame = pd.DataFrame(split(columns)).astype({"lat_deg": int, "lat_min": float, "lon_deg": int, "lon_min": float})
    log = tmp_path / f"log.{form}"
    frame.to_parquet(log) if form == "parquet" else frame.to_excel(log, index=False)
    close(imported(log, propose_map(log).text), one_column(tmp_path, columns), 1e-6)


def test_seconds_and_a_hemisphere_of_decimal_degrees(tmp_path):
    columns = fixed(turn(), (-33.5, -70.0001))
    plain = one_column(tmp_path, columns)
    letters = columns | {"lat": -columns["lat"], "lon": -columns["lon"], "NS": "S", "EW": "W"}
    log = write_csv(tmp_path / "letters.csv", letters)
    proposal = propose_map(log)
    assert [proposal.guesses[one].keys for one in ("latitude", "longitude")] == [
        {"hemisphere": "NS"},
        {"hemisphere": "EW"},
    ]
    close(imported(log, proposal.text), plain, 1e-6)
    parted = split(columns)
    for name in ("lat", "lon"):
        minutes = np.array([float(one) for one in parted[f"{name}_min"]])
        parted[f"{name}_min"], parted[f"{name}_sec"] = np.floor(minutes).astype(int), 60.0 * (minutes % 1.0)
    log = write_csv(tmp_path / "seconds.csv", parted)
    proposal = propose_map(log)
    assert proposal.guesses["latitude"].keys == {"minutes": "lat_min", "seconds": "lat_sec", "hemisphere": "lat_NS"}
    close(imported(log, proposal.text), plain, 1e-6)


GEOGRAPHIC = MAP.replace(
    'x = { column = "north", unit = "m" }\ny = { column = "east", unit = "m" }',
    'latitude = { column = "lat_deg", minutes = "lat_min", hemisphere = "lat_NS" }\n'
    'longitude = { column = "lon_deg", minutes = "lon_min", hemisphere = "lon_EW" }',
)


def test_rows_that_make_no_position_are_gaps(tmp_path):
    parted = split(fixed(turn(), (-33.5, -70.0001)))
    parted["lat_min"][50], parted["lon_min"][51], parted["lat_NS"][52] = "71.5", "", ""
    parted["lon_deg"][53], parted["lat_deg"][54], parted["lat_NS"][55] = "70.5", "x", "Q"
    log = write_csv(tmp_path / "log.csv", parted)
    (quality,) = import_logs(log, parse_map(GEOGRAPHIC), ".", dry_run=True).quality
    notes = "; ".join(quality["notes"])
    first = "3 of 400 rows make no latitude, the first is '33 71.5 S' (line 52): minutes and seconds are 60 at most"
    assert first in notes
    assert "1 of 400 rows make no longitude, the first is '70.5" in notes
    assert "all but the last part are to be whole" in notes


@pytest.mark.parametrize(
    ("wrong", "right", "told"),
    [
        ('minutes = "lat_min"', 'minutes = "lat min"', "column 'lat min' is missing from the log"),
        ('minutes = "lat_min"', 'seconds = "lat_min"', "'columns.latitude.seconds' is given without minutes"),
        ('minutes = "lat_min"', "minutes = 0", "'columns.latitude.minutes' is 0"),
        ('minutes = "lat_min"', 'minutes = "lat_deg"', "column 'lat_deg' is named twice for geographic latitude"),
        ('minutes = "lat_min"', 'minutes = "shaft"', "minutes and seconds are 60 at most"),
        ('"lat_deg", minutes', '"rate", minutes', "all but the last part are to be whole"),
        ('hemisphere = "lat_NS"', 'hemisphere = "lon_EW"', "the hemisphere is neither N nor S"),
        ('column = "lat_deg", ', "", "'columns.latitude.minutes' is given without the degrees"),
        ('hemisphere = "lat_NS"', 'hemisphere = "lat_NS", positive = "south"', "both 'hemisphere' and 'positive'"),
        ('hemisphere = "lat_NS"', 'unit = "rad"', "'columns.latitude.unit' is 'rad', beside 'minutes'"),
        ('hemisphere = "lat_NS"', 'unit = "ddmm"', "'columns.latitude.unit' is 'ddmm', beside 'minutes'"),
        ('hemisphere = "lat_NS"', 'unit = "ddmmm"', "error: unit of 'latitude' is 'ddmmm'"),
        ('column = "heading"', 'column = "heading", minutes = "rate"', "'columns.psi.minutes' is for latitude"),
    ],
)
def test_what_is_wrong_with_columns_of_positions_is_told(tmp_path, wrong, right, told):
    log = write_csv(tmp_path / "log.csv", split(fixed(turn(), (-33.5, -70.0001))))
    assert wrong in GEOGRAPHIC
    (tmp_path / "map.toml").write_text(GEOGRAPHIC.replace(wrong, right, 1), encoding="utf-8")
    ended = run("trials", "import", str(log), "--map", "map.toml", "-o", "out", cwd=tmp_path)
    assert ended.code == 2
    assert told in ended.err


def test_a_sign_that_contradicts_the_letter(tmp_path):
    parted = split(fixed(turn(), (33.5, 70.0001)))
    log = write_csv(tmp_path / "log.csv", parted | {"lat_deg": [f"-{one}" for one in parted["lat_deg"]]})
    assert "the sign says the other hemisphere than the letter" in refusal(lambda: imported(log, GEOGRAPHIC))
