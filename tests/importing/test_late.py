"""Columns of a device whose clock is off are read at the times they are of."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from .made import MAP, close, imported, logged, refusal, said, suzaku, turn, write_csv

LATE = MAP.replace('shaft", unit', 'shaft", late = "40 s", unit').replace(
    'rudder", unit', 'rudder", late = "40 s", unit'
)


def with_controls_late(columns: dict[str, np.ndarray], late: float) -> dict[str, np.ndarray]:
    """The columns with rudder and revolutions logged so many seconds later."""
    then = columns["time"] - late
    return columns | {name: np.interp(then, columns["time"], columns[name]) for name in ("rudder", "shaft")}


def test_what_was_logged_late_is_put_right(tmp_path: Path) -> None:
    truth = turn()
    trial = imported(write_csv(tmp_path / "run.csv", with_controls_late(logged(truth), 40.0)), LATE)
    # The last 40 s of the motion have no rudder any more.
    close(trial, imported(write_csv(tmp_path / "part.csv", {k: v[:-40] for k, v in logged(truth).items()})))
    assert trial.n_samples == truth.n_samples - 40


def test_what_was_logged_before_it_happened(tmp_path: Path) -> None:
    early = LATE.replace('"40 s"', '"-40 s"')
    log = write_csv(tmp_path / "run.csv", with_controls_late(logged(turn()), -40.0))
    assert np.abs(imported(log, early).delta - turn().delta[40:]).max() < 1e-9
    assert "n and delta: taken 40 s later than logged, as the map says" in said(log, early)


def test_the_report_says_what_the_map_can(tmp_path: Path) -> None:
    log = write_csv(tmp_path / "run.csv", with_controls_late(logged(suzaku("zigzag_20")), 60.0))
    told = said(log)
    assert "s before what is logged of her rudder" in told
    key = told.partition('say late = "')[2].partition('"')[0]
    assert float(key.removesuffix(" s")) == pytest.approx(60.0, abs=8.0)
    assert "what is logged of her rudder" not in said(log, LATE.replace('"40 s"', f'"{key}"'))


def test_what_a_map_may_not_say(tmp_path: Path) -> None:
    log = write_csv(tmp_path / "run.csv", logged(turn()))
    assert "'x' and 'y' are late by different times" in refusal(
        lambda: imported(log, MAP.replace('north", unit', 'north", late = "3 s", unit'))
    )
    assert "'columns.n.late': unit 'm' is not one of s" in refusal(
        lambda: imported(log, LATE.replace('"40 s"', '"40 m"', 1))
    )
    assert "'columns.n' has a value and keys of a column" in refusal(
        lambda: imported(
            log, MAP.replace('n = { column = "shaft", unit = "rpm" }', 'n = { value = "9 rpm", late = "1 s" }')
        )
    )
    assert "have 0 s in common" in refusal(lambda: imported(log, LATE.replace('"40 s"', '"4000 s"', 1)))
