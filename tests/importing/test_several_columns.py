"""What stands in several columns of a log: hours, minutes and seconds."""

import numpy as np
import pandas as pd
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
        ('column = ["rudder", "Min"]\nunit = ["h", "min"]', "does not hold the hours of a time in several columns"),
        ('column = ["Sec", "Hour", "Min"]\nunit = ["h", "min", "s"]', "does not hold the hours"),
    ],
)
def test_what_is_wrong_with_columns_of_time_is_told(tmp_path, stamps, told):
    log = write_csv(tmp_path / "log.csv", clock(turn()))
    (tmp_path / "map.toml").write_text(MAP.replace('column = "time"\nunit = "s"', stamps), encoding="utf-8")
    ended = run("trials", "import", str(log), "--map", "map.toml", "-o", "out", cwd=tmp_path)
    assert ended.code == 2
    assert told in ended.err


def test_a_header_that_says_another_unit_than_the_map(tmp_path):
    log = write_csv(tmp_path / "log.csv", clock(turn(), ("Hour", "M [min]", "S [s]")))
    text = PARTED.replace('"Min", "Sec"', '"S", "M"')
    assert "the map says 'S [s]' is in min, its header says s" in refusal(lambda: imported(log, text))
