"""Cells, headers and stamps of logs that stand for nothing: what is said of them, and what becomes of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mmgtune.errors import LogError
from mmgtune.importing import Imported, import_logs

HEADER = "UTC,Lat [deg],Lon [deg],SOG [kn],COG [deg],HDG [deg],Shaft [rpm],Rudder [deg]"
MAP = """schema = 1
[trial]
ship = "suzaku"
[time]
column = "UTC"
[columns]
latitude = { column = "Lat [deg]" }
longitude = { column = "Lon [deg]" }
psi = { column = "HDG [deg]" }
sog = { column = "SOG [kn]" }
cog = { column = "COG [deg]" }
n = { column = "Shaft [rpm]" }
delta = { column = "Rudder [deg]", positive = "starboard" }
"""


def imported(
    folder: Path, header: str = HEADER, stamp: str = "2024-05-14T02:15:{:02d}Z", first: str = "6.0"
) -> Imported:
    rows = [header]
    for k in range(50):
        speed = first if k == 0 else "6.0"
        north = 34.6 + 6.0 * 0.514444 * k / 111_000.0
        rows.append(f"{stamp.format(k)},{north:.7f},135.0,{speed},0.{k % 7},0.{k % 5},104.0,{0.1 * (k % 3):.1f}")
    (folder / "log.csv").write_text("\n".join(rows), encoding="utf-8")
    (folder / "map.toml").write_text(MAP, encoding="utf-8")
    return import_logs(folder / "log.csv", folder / "map.toml", folder / "out", dry_run=True)


def test_a_speed_that_no_ship_has_is_a_gap(tmp_path: Path) -> None:
    """A first row of -9999 kn began a trial with u = -5144 m/s."""
    made = imported(tmp_path, first="-9999")
    (trial,) = made.trials
    assert np.nanmax(np.abs(trial.u)) < 10.0
    assert "up to 5.14e+03 m/s; taken as gaps" in str(made.to_dict())


def test_a_number_beyond_all_is_said_in_words(tmp_path: Path) -> None:
    said = str(imported(tmp_path, first="1e400").to_dict())
    assert "inf m/s" not in said


def test_a_column_that_is_there_twice(tmp_path: Path) -> None:
    header = HEADER.replace("Shaft [rpm],Rudder [deg]", "Shaft [rpm],Rudder [deg],HDG [deg]")
    with pytest.raises(LogError, match=r"column 'HDG \[deg\]' is there twice: columns 6 and 9") as error:
        imported(tmp_path, header)
    assert error.value.problems[0].fix == "give its number in place of its name, such as 6"


def test_stamps_that_cannot_be_read_are_no_question_of_units(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="time cannot be read as numbers, dates or times of day") as error:
        imported(tmp_path, stamp="14. Mai 2024 02:15:{:02d}")
    (problem,) = error.value.problems
    assert "the first stamp is '14. Mai 2024 02:15:00'" in problem.why
    assert "2024-05-14T02:15:00" in problem.why
