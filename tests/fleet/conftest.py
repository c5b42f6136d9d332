"""Small fleets: short pieces of the bundled trials, copied for several ships and dates."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from mmgtune.resources import folder
from mmgtune.trial import read_trial, write_trial
from mmgtune.trial.schema import ATTRIBUTES

FIT = 'options = { method = "least-squares", starts = 1, a_r = 0.3, targets = ["hull.R_0", "hull.Y_v", "wake.w_P0"] }'
TABLE = (
    """schema = 1

[[jobs]]
name = "state"
command = "fit"
profile = "suzaku"
trials = "logs/{ship}/{date}"
class = "coasters"
"""
    + FIT
)

QUICK = """schema = 1

[[jobs]]
command = "validate"
profile = "suzaku"
trials = "logs/{ship}/{date}"
options = { backend = "numpy" }
"""


def make_logs(base: Path, ships: tuple[str, ...], dates: tuple[str, ...]) -> None:
    """A short turn and zigzag for each ship and date; those of each begin at another time, so that none are alike."""
    whole = [read_trial(folder("trials") / "suzaku" / f"{name}.parquet") for name in ("turn_p35", "zigzag_20")]
    for k, (ship, date) in enumerate((ship, date) for ship in ships for date in dates):
        for trial in whole:
            thin = {name: getattr(trial, name)[k : k + 120 : 2] for name in ATTRIBUTES.values()}
            thin["t"] = thin["t"] - thin["t"][0]
            write_trial(replace(trial, **thin), base / "logs" / ship / date / f"{trial.id}.parquet", overwrite=True)


@pytest.fixture
def fleet(tmp_path: Path) -> Path:
    """A table of fits of three ships at two dates, in a folder with their logs."""
    make_logs(tmp_path, ("a1", "a2", "a3"), ("2025-01", "2025-02"))
    (tmp_path / "fleet.toml").write_text(TABLE, encoding="utf-8")
    return tmp_path / "fleet.toml"
