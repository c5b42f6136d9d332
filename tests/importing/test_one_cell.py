"""What stands in one cell: degrees and minutes in one number, latitude and longitude in one text."""

import numpy as np
import pandas as pd
import pytest

from mmgtune.importing import import_logs, parse_map, propose_map
from mmgtune.importing.cells.position_pair import pair_in
from tests.command import run

from .made import MAP, close, imported, turn, write_csv
from .test_several_columns import ORIGINS, fixed, one_column

LOCAL = 'x = { column = "north", unit = "m" }\ny = { column = "east", unit = "m" }'


def ddmm(degrees, whole):
    """Degrees as 5206.0001, with a minus to the south and west."""
    size = np.abs(degrees)
    minutes = np.round((size % 1.0) * 60.0, 7)
    carried = minutes >= 60.0
    number = (np.floor(size) + carried).astype(int) * 100.0 + np.where(carried, 0.0, minutes)
    return [f"{'-' if d < 0.0 else ''}{one:0{whole + 8}.7f}" for d, one in zip(degrees, number, strict=True)]


def angle(degrees, sides, form):
    """Degrees in words: of a "side" behind or "before", in degrees, minutes and "seconds"."""
    size, side = abs(degrees), sides[int(degrees < 0.0)]
    whole = int(size)
    minutes = (size - whole) * 60.0
    if form == "before":
        return f"{side}{whole}°{minutes:.7f}'"
    if form == "seconds":
        return f"{whole}°{int(minutes):02d}'{(minutes % 1.0) * 60.0:.6f}\"{side}"
    return f"{whole} {minutes:.7f} {side}"


@pytest.mark.daily("origin0")
@pytest.mark.parametrize("origin", [(35.0, 139.0), (-33.5, -170.0001), (35.0, -0.0001)])
@pytest.mark.parametrize("letters", [True, False])
def test_degrees_and_minutes_in_one_number(tmp_path, origin, letters):
    columns = fixed(turn(), origin)
    written = {"lat": ddmm(columns["lat"], 4), "lon": ddmm(columns["lon"], 5)}
    if letters:
        written = {name: [one.lstrip("-") for one in values] for name, values in written.items()}
        written |= {"NS": np.where(columns["lat"] < 0, "S", "N"), "EW": np.where(columns["lon"] < 0, "W", "E")}
    log = write_csv(tmp_path / "log.csv", columns | written)
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    assert proposal.guesses["latitude"].keys["unit"] == proposal.guesses["longitude"].keys["unit"] == "ddmm"
    assert ("hemisphere" in proposal.guesses["latitude"].keys) is letters
    close(imported(log, proposal.text), one_column(tmp_path, columns), 1e-5)


def test_numbers_that_are_no_degrees_and_minutes(tmp_path):
    columns = fixed(turn(), (35.0, 139.0))
    written = {"lat": ddmm(columns["lat"], 4), "lon": ddmm(columns["lon"], 5)}
    written["lat"][50] = "3571.5"
    log = write_csv(tmp_path / "log.csv", columns | written)
    text = propose_map(write_csv(tmp_path / "good.csv", columns | {**written, "lat": ddmm(columns["lat"], 4)})).text
    (quality,) = import_logs(log, parse_map(text), ".", dry_run=True).quality
    assert "1 of 400 rows make no latitude, the first is '3571.5' (line 52)" in "; ".join(quality["notes"])
    for of, told in (
        ({"lat": np.full(400, 3571.5)}, "minutes are less than 60"),
        ({"lat": np.full(400, 9512.5)}, "latitude and longitude are swapped?"),
    ):
        log = write_csv(tmp_path / "wrong.csv", columns | written | of)
        (tmp_path / "map.toml").write_text(text, encoding="utf-8")
        ended = run("trials", "import", str(log), "--map", "map.toml", "-o", "out", cwd=tmp_path)
        assert ended.code == 2
        assert told in ended.err
    for name in ("x", "psi"):
        (tmp_path / "map.toml").write_text(MAP.replace('unit = "m"', 'unit = "ddmm"'), encoding="utf-8")
        ended = run("trials", "import", str(log), "--map", "map.toml", "-o", "out", cwd=tmp_path)
        assert "unit of 'x' is 'ddmm'" in ended.err, name


@pytest.mark.daily("origin1")
@pytest.mark.parametrize("origin", ORIGINS)
@pytest.mark.parametrize("form", ["side", "before", "seconds", "plain", "commas", "point"])
def test_latitude_and_longitude_in_one_column(tmp_path, origin, form):
    columns = fixed(turn(), origin)
    pairs = list(zip(columns["lat"], columns["lon"], strict=True))
    both = {
        "plain": [f"{a:.9f}, {b:.9f}" for a, b in pairs],
        "commas": [f"{a:.9f} {b:.9f}".replace(".", ",") for a, b in pairs],
        "point": [f"POINT ({b:.9f} {a:.9f})" for a, b in pairs],
    }.get(form) or [f"{angle(a, 'NS', form)} {angle(b, 'EW', form)}" for a, b in pairs]
    others = {name: one for name, one in columns.items() if name not in ("lat", "lon")}
    log = write_csv(tmp_path / "log.csv", {"time": others.pop("time"), "Position": both} | others)
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    assert "its cells hold both" in "; ".join(proposal.guesses["longitude"].evidence)
    assert 'longitude = { column = "Position" }' in proposal.text
    close(imported(log, proposal.text), one_column(tmp_path, columns), 1e-5)


def test_cells_that_are_no_position_are_gaps(tmp_path):
    columns = fixed(turn(), (35.0, 139.0))
    both = [f"{a:.9f} {b:.9f}" for a, b in zip(columns["lat"], columns["lon"], strict=True)]
    both[50], both[51] = "no fix", ""
    log = write_csv(tmp_path / "log.csv", columns | {"Position": both})
    named = 'latitude = { column = "Position" }\nlongitude = { column = "Position" }'
    (quality,) = import_logs(log, parse_map(MAP.replace(LOCAL, named)), ".", dry_run=True).quality
    notes = "; ".join(quality["notes"])
    assert "latitude: 1 cell of 400 is no number, the first is 'no fix' (line 52); taken as gaps" in notes


@pytest.mark.parametrize("text", ["35,0", "35,0000", "12 34", "95.0, 3.0", "12.5", "27.11.2026 12:00:00", "10 P", ""])
def test_what_is_no_position(text):
    found = pair_in(pd.Series([text], dtype="string"))
    assert np.isnan(found["latitude"]).all()
    assert np.isnan(found["longitude"]).all()


@pytest.mark.parametrize("sep", ["\t", ";", ","])
def test_blanks_within_cells_divide_no_columns(tmp_path, sep):
    """Dates and times, 5.0 P and 34.5 N: by blanks more of the fields were numbers, and the rudder lost its side."""
    trial = turn()
    columns = fixed(trial, (-33.5, -70.0001))
    stamps = (pd.Timestamp("2026-05-04 08:00:00") + pd.to_timedelta(columns.pop("time"), unit="s")).strftime(
        "%Y-%m-%d %H:%M:%S.0"
    )
    written = {
        "Date/Time UTC": stamps,
        "lat": [f"{abs(one):.9f} S" for one in columns["lat"]],
        "lon": [f"{abs(one):.9f} W" for one in columns["lon"]],
        "rudder": [f"{abs(one):.6f} {'S' if one > 0.0 else 'P'}" for one in columns["rudder"]],
    }
    log = write_csv(
        tmp_path / "log.csv", {**written, **{k: v for k, v in columns.items() if k not in written}}, sep=sep
    )
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    assert "its cells say the side" in "; ".join(proposal.guesses["delta"].evidence)
    back = imported(log, proposal.text)
    assert np.abs(back.delta - trial.delta).max() < 1e-6
    plain = one_column(tmp_path, {"time": trial.t, **columns})
    assert np.abs(back.x - plain.x).max() < 1e-3
