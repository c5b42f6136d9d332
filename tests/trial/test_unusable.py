"""What makes a trial unusable, and that good ones are not called so."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mmgtune.trial import Trial, check_trial, read_trial, write_trial

from .made import DEG, changed, made, problems_of, said, with_value

SIGNS = pytest.mark.parametrize("sign", [1.0, -1.0])


def as_degrees(values: Any) -> Any:
    return values / DEG


@pytest.mark.parametrize("seed", [None, 1])
@pytest.mark.parametrize(("factor", "unit"), [(60.0, "rad/min"), (1.0 / DEG, "degrees per second")])
def test_a_yaw_rate_by_the_minute_is_not_in_degrees(factor: float, unit: str, seed: int | None) -> None:
    trial = made(seed=seed)
    (error,) = [one for one in check_trial(replace(trial, r=trial.r * factor)) if one.severity == "error"]
    assert error.what == f"'r' is in {unit}, not rad/s"


@pytest.mark.parametrize("seed", [None, 1])
@pytest.mark.parametrize("zigzag", [False, True])
@pytest.mark.parametrize(
    ("factor", "unit", "fix"),
    [
        (1.0 / 60.0, "min", "multiply 't' by 60"),
        (1.0 / 3600.0, "h", "multiply 't' by 3600"),
        (1000.0, "ms", "divide 't' by 1000"),
        (60.0, "sixtieths of a second", "divide 't' by 60"),
    ],
)
def test_time_that_is_not_in_seconds(factor: float, unit: str, fix: str, zigzag: bool, seed: int | None) -> None:
    """Times in minutes made a yaw rate in degrees of one in rad/s, by a factor of 60."""
    trial = made(seed=seed, zigzag=zigzag)
    (error,) = [one for one in check_trial(replace(trial, t=trial.t * factor)) if one.severity == "error"]
    assert (error.what, error.fix) == (f"'t' is in {unit}, not s", fix)


@pytest.mark.parametrize("seed", [None, 1, 2])
@pytest.mark.parametrize("kind", [{}, {"zigzag": True}, {"angle": -35 * DEG}, {"angle": 0.0}, {"speed": 0.0}])
def test_good_trials_have_no_errors_and_no_warnings(kind: dict[str, Any], seed: int | None) -> None:
    assert said(made(seed=seed, **kind), "error") == ""
    assert said(made(seed=seed, **kind)) == ""


@pytest.mark.parametrize("row", [0, 1, 2])
def test_too_few_samples(tmp_path: Path, row: int) -> None:
    trial = made(samples=5)
    short = Trial("a", "", "", "", **{name: getattr(trial, name)[:row] for name in ATTRIBUTES_OF})
    (problem,) = problems_of(write_trial(short, tmp_path / "a.parquet"))
    assert ("no samples", "one sample", "2 samples")[row] in problem
    assert check_trial(short)[0].severity == "error"
    assert short.duration == (short.t[-1] if row else 0.0)


def test_a_record_in_which_nothing_moves(tmp_path: Path) -> None:
    trial = made()
    still = {name: np.zeros(trial.n_samples) for name in ATTRIBUTES_OF[1:]}
    (problem,) = problems_of(write_trial(replace(trial, **still), tmp_path / "a.parquet"))
    assert "nothing moves in the whole trial" in problem
    moored = replace(trial, **{**still, "psi": np.full(trial.n_samples, 0.3), "delta": trial.delta})
    assert not said(moored, "error")  # the rudder was tried alongside


ATTRIBUTES_OF = ("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta")


@pytest.mark.parametrize(
    ("trial", "expected"),
    [
        (with_value(made(), "t", 7, 3.0), "time goes back (T, row 7: t = 3 s after 6 s"),
        (with_value(made(), "t", 7, 6.0 + 1e-9), "time goes on by less than 1e-07 s in 1 rows (T, row 7: 1e-09 s"),
        (with_value(made(), "t", 7, 6.0), "time repeats (T, row 7: t = 6 s after 6 s"),
        (with_value(made(), "t", 7, np.nan), "time is no number in 1 rows (T, row 7"),
        (with_value(made(), "n", [5, 8], np.nan), "'n' is no number in 2 rows (T, column 'n', row 5"),
        (with_value(made(), "delta", 5, np.nan), "'delta' is no number in 1 rows (T, column 'delta', row 5"),
        (with_value(made(), "n", 5, np.inf), "'n' is infinite in 1 rows (T, column 'n', row 5"),
        (with_value(made(), "psi", slice(0, 3), np.nan), "'psi' has no value in the first sample"),
        (with_value(made(), "psi", slice(0, 3), np.nan), "begins in row 3"),
        (with_value(made(), "v_m", slice(None), np.nan), "'v' has no values at all"),
        (with_value(made(), "x", 9, -np.inf), "'x' is infinite in 1 rows (T, column 'x', row 9"),
        (changed(made(), "delta", as_degrees), "rudder angle up to 20 rad (T, column 'delta')"),
        (with_value(made(), "delta", 9, 3.0), "only some samples"),
        (replace(made(), extra={"delta_port": np.full(500, 20.0)}), "(T, column 'delta_port')"),
    ],
)
def test_each_reason(tmp_path: Path, trial: Trial, expected: str) -> None:
    path = write_trial(trial, tmp_path / "a.parquet")
    (problem,) = problems_of(path)
    assert expected in problem.replace(str(path), "T")
    assert "fix:" in problem
    assert said(trial, "error")


@SIGNS
@pytest.mark.parametrize("zigzag", [True, False])
@pytest.mark.parametrize("seed", [None, 4])
@pytest.mark.parametrize("channel", ["psi", "r"])
def test_degrees_in_heading_or_yaw_rate(channel: str, seed: int | None, zigzag: bool, sign: float) -> None:
    trial = made(angle=sign * 20 * DEG, zigzag=zigzag, seed=seed)
    errors = said(changed(trial, channel, as_degrees), "error")
    assert f"'{channel}' is in degrees" in errors
    assert "57" in errors or not zigzag


@pytest.mark.parametrize("seed", [None, 4])
def test_degrees_in_both(seed: int | None) -> None:
    errors = said(changed(changed(made(seed=seed), "psi", as_degrees), "r", as_degrees), "error")
    assert "'psi' is in degrees" in errors
    assert "'r' is in degrees per second" in errors


def test_degrees_of_a_compass_that_wraps() -> None:
    trial = changed(made(seed=5), "psi", lambda psi: (psi / DEG) % 360.0)
    assert "'psi' is in degrees" in said(trial, "error")


def test_degrees_of_a_straight_run() -> None:
    straight = made(angle=0.0, seed=6)
    turned = replace(straight, x=straight.y, y=-straight.x, psi=straight.psi / DEG + 270.0)
    assert "'psi' is in degrees" in said(turned, "error")


def test_a_small_model_turning_fast_is_fine() -> None:
    trial = made(dt=0.1, speed=0.8, lag=1.1, angle=35 * DEG, rudder_rate=25 * DEG, n=12.0)
    assert trial.r.max() > 0.5
    assert said(trial, "error") == said(trial) == ""


def test_gaps_in_the_motion_are_allowed(tmp_path: Path) -> None:
    trial = with_value(with_value(made(seed=7), "x", slice(50, 60), np.nan), "x", 480, np.nan)
    trial = with_value(trial, "psi", slice(499, 500), np.nan)
    again = read_trial(write_trial(trial, tmp_path / "a.parquet"))
    warnings = said(again)
    assert "'x' and 'psi' have gaps: 1 to 11 of 500 samples; the longest has 10 samples, 11 s" in warnings
    assert "column 'x', row 50" in warnings
    assert len(warnings.splitlines()) == 1


def test_numbers_beyond_measure_do_not_upset_the_checks() -> None:
    for name in ATTRIBUTES_OF:
        for value in (np.nan, np.inf, -np.inf, 1e308, -1e308):
            check_trial(with_value(made(samples=30), name, [4, 5, 20], value))
            check_trial(with_value(made(samples=30), name, slice(1, None), value))
    for samples in (3, 4, 11):
        assert said(made(samples=samples), "error") == ""
