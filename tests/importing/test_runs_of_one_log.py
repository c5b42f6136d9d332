"""Runs that stand in one log, one below the other, are runs of their own; parts of one run belong together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mmgtune.importing import import_logs, parse_map
from mmgtune.importing.importer import _runs
from mmgtune.importing.record import Record, Series

from .made import MAP, logged, turn, write_csv


def below(starts: list[float], step: float = 1.0) -> dict[str, np.ndarray]:
    """The same run several times over, its clock beginning at each start [s]."""
    columns = logged(turn())
    rows = {name: np.concatenate([one] * len(starts)) for name, one in columns.items()}
    return rows | {"time": np.concatenate([start + step * columns["time"] for start in starts])}


@pytest.mark.parametrize("starts", [[0.0, 7200.0, 14400.0], [0.0, 0.0, 0.0]], ids=["hours apart", "each from zero"])
def test_runs_one_below_the_other(tmp_path: Path, starts: list[float]) -> None:
    log = write_csv(tmp_path / "day.csv", below(starts))
    trials = import_logs([log], parse_map(MAP), tmp_path, dry_run=True).trials
    assert [trial.id for trial in trials] == ["day_1", "day_2", "day_3"]
    assert [trial.run for trial in trials] == ["day_1", "day_2", "day_3"]


def test_parts_of_one_run(tmp_path: Path) -> None:
    """The clock was set back by a minute."""
    columns = logged(turn())
    columns["time"] = columns["time"] - np.where(np.arange(400) >= 200, 60.0, 0.0)
    trials = import_logs([write_csv(tmp_path / "run.csv", columns)], parse_map(MAP), tmp_path, dry_run=True).trials
    assert [(trial.id, trial.run) for trial in trials] == [("run_1", "run"), ("run_2", "run")]


@pytest.mark.parametrize(
    ("spans", "runs"),
    [
        ([(0.0, 100.0)], [0]),
        ([(0.0, 100.0), (5000.0, 5100.0), (5090.0, 5200.0)], [0, 1, 1]),
        ([(0.0, 100.0), (2.0, 90.0), (60.0, 120.0), (0.0, 50.0)], [0, 1, 1, 2]),
    ],
)
def test_which_parts_are_of_one_run(spans: list[tuple[float, float]], runs: list[int]) -> None:
    records = [Record(Path("log"), {"x": Series(np.array(span), np.zeros(2))}) for span in spans]
    assert _runs(records) == runs
