"""Columns in parts of a unit: tenths of a degree, ten-millionths of a position."""

import numpy as np
import pytest

from mmgtune.importing import import_logs, propose_map
from mmgtune.importing.proposing.scaled import factor_named, without_factor
from mmgtune.units import DEG

from .made import logged, turn, write_csv


@pytest.mark.parametrize(
    ("name", "factor", "rest"),
    [
        ("HDG_x10", 0.1, "HDG"),
        ("speed (x100)", 0.01, "speed"),
        ("LAT_1e7", 1e-7, "LAT"),
        ("lat [1e-7 deg]", 1e-7, "lat [deg]"),
        ("heading [0.1 deg]", 0.1, "heading [deg]"),
        ("HDG [deg x10]", 0.1, "HDG [deg]"),
        ("x10", 1.0, "x10"),
        ("Pos X", 1.0, "Pos X"),
        ("SOG [kn]", 1.0, "SOG [kn]"),
    ],
)
def test_what_a_name_says_of_parts(name, factor, rest):
    assert (factor_named(name), without_factor(name)) == (pytest.approx(factor), rest)


def whole(values, parts):
    """Values as whole numbers of parts of their unit."""
    return np.round(np.asarray(values) * parts).astype(int)


def proposed_trial(tmp_path, table):
    proposal = propose_map([write_csv(tmp_path / "log.csv", table)])
    assert proposal.imported == 1, proposal.text
    (back,) = import_logs(proposal.logs, proposal, ".", dry_run=True).trials
    return back


@pytest.mark.parametrize("headers", [("hdg_x10", "rudder_x10"), ("hdg [0.1 deg]", "rudder [0.1 deg]")])
def test_tenths_are_read(tmp_path, headers):
    trial = turn()
    table = {name: column for name, column in logged(trial).items() if name not in ("heading", "rudder")}
    for header, values in zip(headers, (trial.psi, trial.delta), strict=True):
        table[header] = whole(values / DEG, 10.0)
    back = proposed_trial(tmp_path, table)
    assert np.abs(back.psi - trial.psi).max() < 0.06 * DEG
    assert np.abs(back.delta - trial.delta).max() < 0.06 * DEG


@pytest.mark.parametrize("headers", [("lat", "lon"), ("LAT_1e7", "LON_1e7")])
def test_positions_in_ten_millionths_are_read(tmp_path, headers):
    """By their name, or as no latitude is 345 million degrees."""
    trial = turn()
    table = {name: column for name, column in logged(trial).items() if name not in ("north", "east")}
    table[headers[0]] = whole(35.0 + trial.x / 110_940.0, 1e7)
    table[headers[1]] = whole(139.0 + trial.y / 91_290.0, 1e7)
    back = proposed_trial(tmp_path, table)
    assert np.abs(back.x - (trial.x - trial.x[0])).max() < 1.0
    assert np.abs(back.y - (trial.y - trial.y[0])).max() < 1.0


def test_numbered_columns_are_in_no_parts(tmp_path):
    table = logged(turn())
    more = {f"state x{k}": np.linspace(0.0, k, 400) for k in (2, 3, 10)}
    proposal = propose_map([write_csv(tmp_path / "log.csv", table | more)])
    assert "scale" not in proposal.text
