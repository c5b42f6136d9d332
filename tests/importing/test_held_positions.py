"""Positions that a log writes several times over until the next comes."""

import numpy as np
import pytest

from mmgtune import import_logs, propose_map
from mmgtune.importing.record import Series, updates_of
from mmgtune.units import DEG, KNOT

from .made import suzaku, write_csv

RUN = suzaku("zigzag_20")
T = np.arange(0.0, RUN.t[-1], 0.2)
FIX = np.floor(T + 1e-9).astype(int)
"""The position of each row: once a second, while the rest is logged five times."""


def test_the_first_row_of_each_is_kept_and_told(tmp_path):
    columns = {
        "time [s]": T.round(1), "north [m]": RUN.x[FIX].round(2), "east [m]": RUN.y[FIX].round(2),
        "heading [deg]": np.interp(T, RUN.t, RUN.psi) / DEG, "SOG [kn]": np.hypot(RUN.u, RUN.v_m)[FIX] / KNOT,
        "rudder [deg]": np.interp(T, RUN.t, RUN.delta) / DEG, "rpm": 60.0 * np.interp(T, RUN.t, RUN.n),
    }  # fmt: skip
    log = write_csv(tmp_path / "log.csv", columns)
    found = import_logs(log, propose_map(log), ".", dry_run=True)
    (trial,) = found.trials
    assert "positions stand still between updates, 1 s apart" in found.text()
    assert np.median(np.diff(trial.t)) == pytest.approx(1.0)
    assert [one["code"] for one in found.quality[0]["findings"] if one["severity"] == "warning"] == []
    began = found.quality[0]["began_s"]
    assert np.abs(trial.x - np.interp(trial.t + began, RUN.t, RUN.x)).max() < 0.01


def series(values):
    return Series(np.arange(float(len(values))), values)


def test_what_else_repeats_is_left_as_it_is():
    k = np.arange(400.0)
    assert updates_of(series(3.0 * k), series(k)) is None
    # Whole metres of a slow ship: the last digit repeats as often, and moves by one.
    assert updates_of(series(np.floor(0.2 * k)), series(np.floor(0.2 * k + 0.5))) is None
    irregular = np.sort(np.random.default_rng(1).choice(400, 100, replace=False))
    now_and_then = 7.3 * np.searchsorted(irregular, k)
    assert updates_of(series(now_and_then), series(now_and_then)) is None


def test_a_ship_that_lies_still_keeps_as_many_rows():
    k = np.floor(np.arange(400) / 4.0)
    x = np.where(k < 60, 3.21 * k, 3.21 * 60)
    kept = updates_of(series(x), series(0.5 * x))
    assert kept is not None
    assert np.array_equal(np.flatnonzero(kept), np.arange(0, 400, 4))
