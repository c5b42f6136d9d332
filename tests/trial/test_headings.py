"""Headings that begin anew after a full turn go on where a trial is read."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.trial import load_trials, read_trial, trial_of, write_trial
from mmgtune.trial.headings import going_on

TURN = 2.0 * np.pi


@pytest.fixture(scope="module")
def turn():
    return load_trials("suzaku").trials["turn_m35"]


def wrapped(psi, low=-np.pi):
    return np.mod(psi - low, TURN) + low


@pytest.mark.parametrize("low", [-np.pi, 0.0])
def test_a_file_and_a_table_are_read_alike(turn, low, tmp_path):
    """A diagnosis of four turns had a false cause, as their headings missed by full turns."""
    assert np.ptp(turn.psi) > TURN
    shown = wrapped(turn.psi, low)
    path = write_trial(replace(turn, psi=shown), tmp_path / "a.parquet")
    columns = {"t": turn.t, "x": turn.x, "y": turn.y, "psi": shown, "u": turn.u, "v": turn.v_m, "r": turn.r}
    for read in (read_trial(path), trial_of({**columns, "n": turn.n, "delta": turn.delta}, "a")):
        off = (read.psi - turn.psi) / TURN
        np.testing.assert_allclose(off, round(off[0]), atol=1e-9)


def test_a_heading_that_goes_on_is_left_alone(turn):
    assert going_on(turn.psi, turn.t, turn.r) is turn.psi
    degrees = np.degrees(wrapped(turn.psi, 0.0))  # told elsewhere
    assert going_on(degrees, turn.t, turn.r) is degrees


@pytest.mark.parametrize("rate", ["of the ship", "in degrees", "unknown"])
def test_across_a_gap_the_yaw_rate_says_how_far_she_turned(turn, rate):
    late = np.abs(turn.psi) > np.pi
    first = int(np.argmax(late)) + 5
    gap = slice(first, first + int(1.4 * np.pi / np.median(np.abs(turn.r[late]))))
    psi, r = np.array(turn.psi), np.array(turn.r)
    assert abs(psi[gap][-1] - psi[gap][0]) > np.pi
    psi[gap] = np.nan
    r = {"of the ship": r, "in degrees": np.degrees(r), "unknown": np.full(len(r), np.nan)}[rate]
    off = (going_on(wrapped(psi), turn.t, r) - psi) / TURN
    before, behind = off[: gap.start], off[gap.stop :]
    np.testing.assert_allclose(before, round(before[0]), atol=1e-9)
    np.testing.assert_allclose(behind, round(behind[0]), atol=1e-9)
    assert (round(behind[0]) == round(before[0])) == (rate == "of the ship")
    assert np.isnan(off[gap]).all()
