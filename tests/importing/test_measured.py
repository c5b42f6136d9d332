"""Measured records of the Esso Osaka model, where they are at hand: they do not travel with the program."""

import os
from pathlib import Path

import numpy as np
import pytest

from mmgtune.importing import import_logs, load_map
from mmgtune.trial import load_trials

DATA = Path(os.environ.get("MMGTUNE_DATA", Path(__file__).parents[2].parent / "shared" / "data")) / "esso-osaka-frt"


@pytest.mark.skipif(not DATA.is_dir(), reason=f"no measured data at {DATA}; MMGTUNE_DATA names their folder")
def test_all_records_of_the_esso_osaka(tmp_path):
    logs = sorted(DATA.glob("*/*.csv"))
    assert len(logs) == 35
    result = import_logs(logs, load_map("frt-ds-esso", preset=True), tmp_path / "out")
    assert len(result.trials) == 35
    data = load_trials(tmp_path / "out")
    assert set(data.trials) == {trial.id for trial in result.trials}
    for trial, quality in zip(result.trials, result.quality, strict=True):
        assert np.diff(trial.t) == pytest.approx(0.1, abs=1e-6)
        ship, earth = quality["positions"]["ship_axes"], quality["positions"]["earth_axes"]
        assert ship < 0.1
        assert ship < earth
        assert quality["yaw"]["largest_difference_deg"] < 0.1 * quality["yaw"]["heading_turns_deg"] + 5.0, trial.id
        assert quality["rudder"]["side"] != "port"
        assert {"wind_speed", "wind_dir", "wind_speed_app", "wind_dir_app"} <= set(trial.extra)
        assert "CC BY-NC 4.0" in trial.note
    sides = [one["rudder"]["side"] for one in result.quality]
    assert sides.count("starboard") > 25
    # What the files record are orders: they jump in one sample.
    assert sum(one["controls"]["delta"]["orders"] for one in result.quality) > 20
