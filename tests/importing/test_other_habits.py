"""Logs as they are written elsewhere: Japanese ones, degrees to the west, shafts in radians a second."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mmgtune.importing import import_logs, propose_map
from mmgtune.importing.cells.stopwatch import of_day, times_told
from mmgtune.importing.proposing.bearings import _counts_against

from .made import close, imported, logged, suzaku, turn, with_sides, write_csv

NAMES = {
    "time": "時刻", "north": "北位置[m]", "east": "東位置[m]", "heading": "船首方位[度]", "rate": "回頭角速度[度/秒]",
    "ahead": "前後速度[kt]", "abeam": "左右速度[kt]", "rudder": "舵角[度]", "shaft": "回転数[回転/分]",
}  # fmt: skip


def test_a_japanese_log(tmp_path: Path) -> None:
    """East was taken for the time, and neither times nor sides were read."""
    trial = suzaku("zigzag_20")
    columns = logged(trial)
    columns["rate"] = columns["rate"] / 60.0
    minutes = [f"{int(t) // 60:02d}分{int(t) % 60:02d}.0秒" for t in columns["time"]]
    written = columns | {"time": minutes, "rudder": with_sides(columns["rudder"], "{side}{size}", "左 右")}
    log = tmp_path / "log.txt"
    table = pd.DataFrame({NAMES[name]: one for name, one in written.items()})
    table.to_csv(log, index=False, sep="\t", encoding="cp932")
    proposal = propose_map([log])
    assert proposal.asks == proposal.problems == ()
    (found,) = import_logs([log], proposal.map(), ".", dry_run=True).trials
    close(found, trial)


@pytest.mark.parametrize(
    ("stamps", "seconds"),
    [
        (["00分59.5秒", "1分00.5秒"], [59.5, 60.5]),
        (["12時34分56秒", "12时34分57秒"], [45296.0, 45297.0]),
        (["1h02m03s", "1h02m04.5s"], [3723.0, 3724.5]),
        (["2 min 5 sec", "2 min 6 sec"], [125.0, 126.0]),
    ],
)
def test_stamps_that_say_their_units(stamps: list[str], seconds: list[float]) -> None:
    texts = pd.Series(stamps, dtype="string")
    assert times_told(texts) == "clock"
    assert of_day(texts).tolist() == seconds


@pytest.mark.parametrize("name", ["LON (deg W)", "Longitude West", "lon [°W]"])
def test_degrees_that_count_to_the_west(tmp_path: Path, name: str) -> None:
    """The heading was said to count counterclockwise, and the rudder to port."""
    columns = {one: values for one, values in logged(turn()).items() if one not in ("ahead", "abeam", "rate")}
    north, east = columns.pop("north"), columns.pop("east")
    columns["LAT (deg N)"] = 29.3 + north / 111.3e3
    columns[name] = 94.7 - east / (111.3e3 * np.cos(np.radians(29.3)))
    log = write_csv(tmp_path / "log.csv", columns)
    proposal = propose_map([log])
    assert proposal.guesses["longitude"].keys["positive"] == "west"
    assert proposal.guesses["psi"].keys["positive"] == "clockwise"
    assert proposal.guesses["delta"].keys["positive"] == "starboard"
    found = imported(log, proposal.text)
    assert np.corrcoef(found.y, turn().y)[0, 1] > 0.999


@pytest.mark.parametrize(
    ("quantity", "name", "against"),
    [
        ("longitude", "LON (deg W)", True), ("longitude", "Longitude_W", False), ("longitude", "lon [°W]", True),
        ("longitude", "Lon E/W", False), ("longitude", "Longitude (west)", True), ("longitude", "Longitude", False),
        ("latitude", "LAT (N/S)", False), ("latitude", "Lat S", True), ("latitude", "Latitude South", True),
        ("latitude", "lats", False), ("x", "S", False),
    ],
)  # fmt: skip
def test_sides_that_names_say(quantity: str, name: str, against: bool) -> None:
    assert _counts_against(quantity, name) == against


def test_a_compass_that_would_count_counterclockwise_is_doubted(tmp_path: Path) -> None:
    columns = {one: values for one, values in logged(turn()).items() if one not in ("ahead", "abeam", "rate")}
    north, east = columns.pop("north"), columns.pop("east")
    columns |= {"Lat": 29.3 + north / 111.3e3, "Lon": 94.7 - east / (111.3e3 * np.cos(np.radians(29.3)))}
    proposal = propose_map([write_csv(tmp_path / "log.csv", columns)])
    assert proposal.guesses["psi"].confidence == "likely"
    assert any("as no compass does: where 'Lon' is to the west" in note for note in proposal.notes)


@pytest.mark.parametrize("sides", [(1, -1), (1, 1)])
@pytest.mark.parametrize("positive", ["starboard", "port"])
def test_turns_logged_every_ten_seconds(tmp_path: Path, positive: str, sides: tuple[int, int]) -> None:
    """Forty rows a run were told by names alone; the side of a rudder shows where there are turns to both."""
    logs = []
    for k, side in enumerate(sides):
        circle = suzaku("turn_p35")
        one = replace(circle, y=side * circle.y, psi=side * circle.psi, r=side * circle.r, delta=side * circle.delta)
        columns = {name: values[::10] for name, values in logged(replace(one, v_m=side * one.v_m)).items()}
        columns["heading"] = np.round(columns["heading"])
        columns["rudder"] = columns["rudder"] * (1.0 if positive == "starboard" else -1.0)
        logs.append(write_csv(tmp_path / f"log{k}.csv", columns))
    proposal = propose_map(logs)
    assert proposal.guesses["psi"].confidence == "sure"
    said = str(proposal.guesses["delta"].keys["positive"])
    assert said == positive if set(sides) == {1, -1} else said.startswith("?")


@pytest.mark.parametrize("exchanged", [True, False])
def test_positions_whose_names_are_exchanged_are_doubted(tmp_path: Path, exchanged: bool) -> None:
    """With x and y as their names say the compass counted counterclockwise from east, which was "sure"."""
    columns = logged(turn())
    north, east = columns.pop("north"), columns.pop("east")
    columns |= {"X nord (m)": east if exchanged else north, "Y est (m)": north if exchanged else east}
    proposal = propose_map([write_csv(tmp_path / "log.csv", columns)])
    assert proposal.guesses["psi"].confidence == ("likely" if exchanged else "sure")
    assert any("exchange the columns of x and y" in note for note in proposal.notes) == exchanged


@pytest.mark.parametrize("below", ["1/s", "rps", "Hz"])
def test_revolutions_in_a_second_whatever_they_are_called(tmp_path: Path, below: str) -> None:
    """A map in rps was refused by the import of a log that says 1/s."""
    columns = logged(turn())
    columns["n"] = columns.pop("shaft") / 60.0
    log = write_csv(tmp_path / "log.csv", columns)
    head, _, rows = log.read_text().partition("\n")
    log.write_text(f"{head}\ns,m,m,deg,kn,kn,deg/min,deg,{below}\n{rows}")
    (found,) = import_logs([log], propose_map([log]).map(), ".", dry_run=True).trials
    assert np.abs(found.n - 1.7).max() < 1e-6


@pytest.mark.parametrize("below", [False, True])
def test_a_shaft_in_radians_a_second(tmp_path: Path, below: bool) -> None:
    columns = logged(turn())
    columns["Shaft speed" if below else "Shaft speed [rad/s]"] = columns.pop("shaft") * (2.0 * np.pi / 60.0)
    log = write_csv(tmp_path / "log.csv", columns)
    if below:
        head, _, rows = log.read_text().partition("\n")
        log.write_text(f"{head}\ns,m,m,deg,kn,kn,deg/min,deg,rad/s\n{rows}")
    proposal = propose_map([log])
    assert proposal.guesses["n"].keys["unit"] == "rad/s"
    (found,) = import_logs([log], proposal.map(), ".", dry_run=True).trials
    assert np.abs(found.n - 1.7).max() < 1e-6
