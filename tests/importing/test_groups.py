"""Names of columns in two rows: what stands above several says what they are of."""

import csv

import numpy as np
import pytest

from mmgtune.importing import import_logs, propose_map

from .made import logged, turn

NAMES = ("time", "North", "East", "Course", "Speed", "Order", "Actual", "rev.")


def log_of(tmp_path, above):
    """A log whose names are short, with a row above them."""
    table = logged(turn())
    speed = np.hypot(table["ahead"], table["abeam"])
    order = np.roll(table["rudder"], -3)
    columns = ("time", "north", "east", "heading")
    values = [*(table[one] for one in columns), speed, order, table["rudder"], table["shaft"]]
    with (tmp_path / "log.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerows([["Yard no. 123"], above, NAMES, ["s", "m", "m", "deg", "kts", "deg", "deg", "min-1"]])
        writer.writerows(zip(*values, strict=True))
    return tmp_path / "log.csv"


def test_the_row_above_says_what_columns_are_of(tmp_path):
    above = ["", "GPS", "", "Gyro", "GPS", "Steering gear", "", "M/E"]
    proposal = propose_map([log_of(tmp_path, above)])
    assert proposal.imported == 1, proposal.text
    assert 'delta = { column = "Actual"' in proposal.text
    assert 'sog = { column = "Speed"' in proposal.text
    assert not [note for note in proposal.notes if "no heading is found" in note]
    (back,) = import_logs(proposal.logs, proposal, ".", dry_run=True).trials
    trial = turn()
    for name in ("psi", "delta", "n"):
        assert getattr(back, name) == pytest.approx(getattr(trial, name), abs=1e-6), name


@pytest.mark.parametrize("above", [[], ["Ship", "Suzaku"], ["Yard no. 123"], ["a", "1.5", "", "", "c", "d", "", "f"]])
def test_other_rows_above_say_nothing(tmp_path, above):
    proposal = propose_map([log_of(tmp_path, above)])
    assert [note for note in proposal.notes if "no heading is found: 'Course'" in note]
