"""``mmgtune trials map`` of logs without a track: nothing else is taken for the half that is missing."""

import numpy as np
import pandas as pd
import pytest

from mmgtune.importing import propose_map
from mmgtune.units import DEG

from .made import suzaku, write_csv


def half(trial, revolutions="RPM", place="East [m]"):
    """A turn of which one half of the position is not logged."""
    return {
        "Time [s]": trial.t,
        place: trial.y,
        "Heading [deg]": trial.psi / DEG,
        revolutions: 60.0 * trial.n,
        "Rudder [deg]": trial.delta / DEG,
    }


@pytest.mark.parametrize("revolutions", ["RPM", "Shaft", "n", "Prop rev", "CH07", "x1", "speed [kn]"])
def test_what_follows_the_turn_is_not_the_missing_half_of_the_position(tmp_path, revolutions):
    """Revolutions fall with the speed: beside one half of a track they follow the heading, not as positions do."""
    proposal = propose_map(write_csv(tmp_path / "log.csv", half(suzaku(), revolutions)))
    columns = {quantity: guess.column for quantity, guess in proposal.guesses.items()}
    assert columns["x"] is None
    assert "columns.x.column" in proposal.asks
    assert columns["psi"] == 2
    assert columns["delta"] == 4
    told = [note for note in proposal.notes if "have it exported" in note]
    assert columns["y"] == 1
    assert told
    assert "'East [m]' is called the position to the east" in told[0]


@pytest.mark.parametrize("name", ["Distance [m]", "Dist", "Afstand"])
@pytest.mark.parametrize("run", ["turn_p35", "zigzag_20"])
def test_the_distance_sailed_is_no_half_of_a_position(tmp_path, name, run):
    trial = suzaku(run)
    sailed = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(trial.x), np.diff(trial.y)))])
    columns = pd.DataFrame(half(trial, place="North [m]")).assign(**{"North [m]": trial.x, name: sailed})
    proposal = propose_map(write_csv(tmp_path / "log.csv", columns))
    assert proposal.guesses["y"].column is None
    assert "columns.y.column" in proposal.asks


@pytest.mark.parametrize("run", ["turn_p35", "zigzag_20"])
def test_a_column_without_a_name_that_only_grows_is_not_sure_to_be_a_position(tmp_path, run):
    trial = suzaku(run)
    sailed = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(trial.x), np.diff(trial.y)))])
    columns = pd.DataFrame(half(trial, place="North [m]")).assign(**{"North [m]": trial.x, "Value": sailed})
    guess = propose_map(write_csv(tmp_path / "log.csv", columns)).guesses["y"]
    assert guess.column is None or (guess.confidence == "likely" and "it only grows" in " ".join(guess.evidence))


def test_one_half_of_a_latitude_and_longitude_asks_for_the_other(tmp_path):
    columns = half(suzaku(), place="Latitude [deg]")
    columns["Latitude [deg]"] = 52.0 + columns["Latitude [deg]"] / 111.3e3
    proposal = propose_map(write_csv(tmp_path / "log.csv", columns))
    assert proposal.guesses["latitude"].column == 1
    assert "columns.longitude.column" in proposal.asks
    assert "x" not in proposal.guesses


def test_a_position_of_unnamed_columns_is_as_fast_north_as_east(tmp_path):
    """One half in another unit, or a half of something else, makes no track; the two halves of one do."""
    trial = suzaku()
    columns = pd.DataFrame(half(trial, "CH2", "CH1")).assign(CH3=trial.x)
    both = propose_map(write_csv(tmp_path / "both.csv", columns))
    assert [both.guesses[name].column for name in ("x", "y")] == [5, 1]
    mixed = propose_map(write_csv(tmp_path / "mixed.csv", columns.assign(CH3=trial.x / 4.0)))
    assert mixed.guesses["x"].column is None
    assert np.ptp(trial.x) > 100.0
