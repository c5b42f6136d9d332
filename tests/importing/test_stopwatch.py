"""Stamps of two numbers: hours and minutes of a day, or minutes and seconds of a stopwatch."""

import numpy as np
import pandas as pd
import pytest

from mmgtune.errors import LogError
from mmgtune.importing import import_logs, parse_map, propose_map
from mmgtune.importing.cells.periods import Periods
from mmgtune.importing.cells.stopwatch import times_told

from .made import UNITLESS, close, imported, logged, refusal, turn, write_csv

VELOCITIES = ("ahead", "abeam")


def stopped(seconds, over=False):
    """Seconds as mm:ss; ``over``: beginning again after 59:59."""
    return [f"{int(t) // 60 % 60 if over else int(t) // 60:02d}:{int(t) % 60:02d}" for t in seconds]


def watched(columns, without=(), **changed):
    """A log by a stopwatch, some of its columns left out, others changed."""
    return {name: one for name, one in {**columns, "time": stopped(columns["time"]), **changed}.items()
            if name not in without}  # fmt: skip


@pytest.mark.parametrize(
    ("stamps", "expected"),
    [
        (["10:00:00", "10:00:01"], "clock"),
        (["10:00 AM", "10:01 AM"], "clock"),
        (["23:58", "23:59", "00:00", "00:01"], "clock"),
        (["24:58", "24:59", "25:00", "25:01"], "mm:ss"),
        (["00:00.0", "00:00.5", "00:01.0"], "mm:ss"),
        (["00:00,0", "00:00,5", "00:01,0"], "mm:ss"),
        (["99:59", "100:00"], "mm:ss"),
        (["59:58", "59:59", "1:00:00", "1:00:01"], "mm:ss"),
        (["9:59:59", "10:00", "10:00:01"], "clock"),
        (["00:00", "00:01", "00:02"], "clock or mm:ss"),
        (["23:58", "23:59", "10:00", "10:01"], "clock or mm:ss"),
        (["0.0", "1.0", "2.0"], ""),
        ([], ""),
    ],
)
def test_what_stamps_show(stamps, expected):
    assert times_told(pd.Series(stamps, dtype="string")) == expected


def test_motion_tells_minutes_from_hours(tmp_path, columns, plain):
    """300 s were 5 hours, and the map was sure of it."""
    log = write_csv(tmp_path / "log.csv", watched(columns))
    proposal = propose_map([log])
    guess = proposal.guesses["t"]
    assert (guess.keys, guess.confidence) == ({"format": "mm:ss"}, "sure")
    assert "as hours and minutes it does not" in guess.evidence[-1]
    assert proposal.asks == proposal.problems == ()
    (trial,) = import_logs([log], proposal.map(), ".", dry_run=True).trials
    close(trial, plain)


def test_motion_tells_hours_from_minutes(tmp_path, columns):
    slow = {name: columns[name] / 60.0 for name in (*VELOCITIES, "rate")}
    guess = propose_map([write_csv(tmp_path / "log.csv", watched(columns, **slow))]).guesses["t"]
    assert (guess.keys, guess.confidence) == ({"format": "clock"}, "sure")


def test_no_ship_is_as_quick_as_minutes_would_have_her(tmp_path, columns):
    far = {name: 60.0 * columns[name] for name in ("north", "east")}
    log = write_csv(tmp_path / "log.csv", watched(columns, (*VELOCITIES, "rate"), **far))
    guess = propose_map([log]).guesses["t"]
    assert (guess.keys, guess.confidence) == ({"format": "clock"}, "sure")


def test_it_is_asked_where_nothing_tells(tmp_path, columns, plain):
    log = write_csv(tmp_path / "log.csv", watched(columns, (*VELOCITIES, "rate")))
    proposal = propose_map([log])
    assert proposal.asks == ("time.format",)
    assert proposal.guesses["t"].confidence == "asked"
    # How far she goes with each turn depends on it.
    assert proposal.guesses["n"].confidence == "likely"
    with pytest.raises(LogError, match=r"are the stamps hours and minutes, or minutes and seconds\?"):
        proposal.map()
    (question,) = [line for line in proposal.text.splitlines() if line.startswith("format = ") and "?" in line]
    answered = parse_map(proposal.text.replace(question, 'format = "mm:ss"'))
    (trial,) = import_logs([log], answered, ".", dry_run=True).trials
    assert trial.duration == plain.duration
    np.testing.assert_allclose(trial.x, plain.x, atol=1e-6)


def test_a_rate_in_degrees_is_one_of_a_second_or_of_a_minute(tmp_path, columns):
    """deg/s by a stopwatch is deg/min by a clock: it tells nothing, and is told by nothing, unless its name says it."""
    rate = columns["rate"] / 60.0
    bare = propose_map([write_csv(tmp_path / "bare.csv", watched(columns, VELOCITIES, rate=rate))])
    assert bare.asks == ("time.format",)
    assert bare.guesses["r"].confidence == "likely"
    named = {**watched(columns, (*VELOCITIES, "rate")), "rate [deg/s]": rate}
    guess = propose_map([write_csv(tmp_path / "named.csv", named)]).guesses["t"]
    assert (guess.keys, guess.confidence) == ({"format": "mm:ss"}, "sure")


@pytest.mark.parametrize(("name", "form"), [("time [mm:ss]", "mm:ss"), ("time (hh:mm)", "clock"), ("min:sec", "mm:ss")])
def test_names_tell(tmp_path, columns, name, form):
    stamps, rest = watched(columns)["time"], watched(columns, ("time", *VELOCITIES, "rate"))
    guess = propose_map([write_csv(tmp_path / "log.csv", {name: stamps, **rest})]).guesses["t"]
    assert (guess.keys, guess.confidence) == ({"format": form}, "sure")


def test_one_log_shows_it_of_all(tmp_path, columns):
    log = watched(columns, (*VELOCITIES, "rate"))
    logs = [
        write_csv(tmp_path / "long.csv", {**log, "time": stopped(columns["time"] + 3600.0)}),
        write_csv(tmp_path / "short.csv", log),
    ]
    guess = propose_map(logs).guesses["t"]
    assert (guess.keys, guess.confidence) == ({"format": "mm:ss"}, "sure")


def test_an_import_asks_too(tmp_path, columns, plain):
    log = write_csv(tmp_path / "log.csv", watched(columns))
    answer = refusal(lambda: imported(log, UNITLESS))
    assert "are the stamps hours and minutes, or minutes and seconds?" in answer
    assert 'format = "clock"' in answer
    assert 'format = "mm:ss"' in answer
    close(imported(log, UNITLESS.replace('"time"', '"time"\nformat = "mm:ss"')), plain)


def test_a_wrong_answer_is_refused_with_what_to_change(tmp_path, columns):
    log = write_csv(tmp_path / "log.csv", watched(columns))
    answer = refusal(lambda: imported(log, UNITLESS.replace('"time"', '"time"\nformat = "clock"')))
    assert "'t' is in sixtieths of a second" in answer
    assert "correct format, unit or scale in [time] of the map" in answer


@pytest.mark.parametrize("over", [True, False])
def test_over_the_hour(tmp_path, columns, plain, over):
    log = write_csv(tmp_path / "log.csv", {**columns, "time": stopped(columns["time"] + 3400.0, over)})
    close(imported(log, UNITLESS), plain)


def test_hours_once_there_are_any(tmp_path, columns, plain):
    seconds = columns["time"].astype(int) + 3400
    stamps = [f"{t // 60:02d}:{t % 60:02d}" if t < 3600 else f"1:{t // 60 - 60:02d}:{t % 60:02d}" for t in seconds]
    close(imported(write_csv(tmp_path / "log.csv", {**columns, "time": stamps}), UNITLESS), plain)


def test_tenths_of_seconds(tmp_path, columns, plain):
    log = write_csv(tmp_path / "log.csv", {**columns, "time": [f"{one}.0" for one in stopped(columns["time"])]})
    close(imported(log, UNITLESS), plain)
    assert propose_map([log]).guesses["t"].confidence == "sure"


def test_a_gap_is_no_hour_that_was_set_back(tmp_path, columns):
    """A stray stamp of zero is undone; half an hour without a row is that."""
    stamps = stopped(columns["time"] + 2400.0)
    stamps[200] = "00:00"
    trial = imported(write_csv(tmp_path / "log.csv", {**columns, "time": stamps}), UNITLESS)
    assert trial.duration == columns["time"][-1]


def test_a_clock_of_twelve_hours_goes_on_at_one(tmp_path):
    """A column of AM and PM beside it is not needed."""
    trial = turn()
    columns = logged(trial)
    stamps = pd.Timestamp("2026-05-01 12:57:03") + pd.to_timedelta(columns.pop("time"), unit="s")
    log = write_csv(
        tmp_path / "log.csv",
        {"Time": stamps.strftime("%I:%M:%S"), "AM/PM": stamps.strftime("%p"), **columns},
    )
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    assert proposal.imported == 1
    close(imported(log, proposal.text), trial)


def test_a_clock_of_24_hours_that_is_set_back_to_one_does_not_go_on():
    seconds = np.array([12.9, 12.99, 1.01, 1.02, 13.0]) * 3600.0
    assert np.array_equal(Periods().over_midnight(seconds), seconds)
    assert np.allclose(np.diff(Periods().over_midnight(seconds[:4])) / 3600.0, [0.09, 0.02, 0.01])
