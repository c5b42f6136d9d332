"""Warnings: each is given for the mistake it is about, seen through noise, and for that alone."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from mmgtune.arrays import FloatArray
from mmgtune.resources import trial_set_names
from mmgtune.trial import Trial, check_trial, load_trials, measured_around
from mmgtune.trial.kinematics import Reading, position_misfits
from mmgtune.trial.schema import known_column

from .made import DEG, changed, made, said, with_value

SEEDS = pytest.mark.parametrize("seed", [None, 1, 2, 3])


def only(trial: Trial, *expected: str) -> None:
    """The trial has one warning for each text, and no errors."""
    warnings = said(trial).splitlines()
    assert said(trial, "error") == ""
    assert len(warnings) == len(expected), warnings
    for text in expected:
        assert any(text in warning for warning in warnings), (text, warnings)


def in_earth_axes(trial: Trial) -> Trial:
    c, s = np.cos(trial.psi), np.sin(trial.psi)
    return replace(trial, u=trial.u * c - trial.v_m * s, v_m=trial.u * s + trial.v_m * c)


@pytest.mark.parametrize("name", trial_set_names())
def test_the_bundled_trials_are_sound(name: str) -> None:
    for trial in load_trials(name).trials.values():
        gaps = [f for f in check_trial(trial) if "gaps" in f.what]
        assert [f.severity for f in check_trial(trial) if f not in gaps] in ([], ["note"])
        assert not gaps or name == "voyages"


@SEEDS
def test_heading_that_is_not_unwrapped(seed: int | None) -> None:
    trial = changed(made(seed=seed), "psi", lambda psi: (psi + np.pi) % (2 * np.pi) - np.pi)
    only(trial, "the heading jumps by a full turn")
    assert "numpy.unwrap" in said(trial)


@SEEDS
@pytest.mark.parametrize("zigzag", [True, False])
@pytest.mark.parametrize("factor", [-1.0, 0.5, 2.0])
def test_yaw_rate_against_heading(seed: int | None, zigzag: bool, factor: float) -> None:
    trial = changed(made(seed=seed, zigzag=zigzag), "r", lambda r: factor * r)
    told = "the yaw rate does not integrate to the heading" if factor > 0 else "yaw rate and heading turn opposite ways"
    only(trial, told)  # and nothing of the rudder, which agrees with one of the two
    warnings = said(trial)
    ratio = re.search(r"turns ([\d.]+) times", warnings)
    assert ratio is not None
    assert float(ratio[1]) == pytest.approx(1.0 / abs(factor), rel=0.05)


@SEEDS
@pytest.mark.parametrize(
    ("change", "reading", "zigzag"),
    [
        (in_earth_axes, "if read in earth axes", False),
        (in_earth_axes, "if read in earth axes", True),
        (lambda trial: replace(trial, x=trial.y, y=trial.x), "with x east and y north", False),
        (lambda trial: replace(trial, v_m=-trial.v_m), "with v positive to port", False),
        (lambda trial: replace(trial, u=trial.u * 1.944, v_m=trial.v_m * 1.944), "with velocities in knots", False),
        (lambda trial: replace(trial, u=trial.u * 1.944, v_m=trial.v_m * 1.944), "with velocities in knots", True),
        (lambda trial: replace(trial, u=trial.u / 1.944, v_m=trial.v_m / 1.944), "in m/s before they were taken", True),
        (lambda trial: replace(trial, y=-trial.y), "with y positive west", False),
        (lambda trial: replace(trial, y=-trial.y), "with y positive west", True),
        (lambda trial: replace(trial, u=trial.u * 0.6), "nor do they fit if read in earth axes", False),
        (lambda trial: replace(trial, u=trial.u * 0.6), "nor do they fit if read in earth axes", True),
    ],
)
def test_velocities_against_positions(change: Any, reading: str, zigzag: bool, seed: int | None) -> None:
    start = made(seed=seed, zigzag=zigzag)
    # A zigzag about north could be read in earth axes; this one runs north-east.
    c = np.sqrt(0.5)
    start = replace(start, x=c * (start.x - start.y), y=c * (start.x + start.y), psi=start.psi + np.pi / 4)
    only(change(start), reading)


def test_the_fix_is_of_the_reading_that_fits() -> None:
    start = made(seed=1)
    knots = replace(start, u=start.u * 1.944, v_m=start.v_m * 1.944)
    for trial, fix in (
        (replace(start, x=start.y, y=start.x), "swap 'x' and 'y'"),
        (replace(start, v_m=-start.v_m), "change the sign of 'v'"),
        (knots, "multiply 'u' and 'v' by 0.5144"),
        (replace(start, u=start.u / 1.944, v_m=start.v_m / 1.944), "divide 'u' and 'v' by 0.5144"),
        (replace(start, y=-start.y), "change the sign of 'y': positive east"),
        (replace(start, y=1.3 * start.y), "give 'x' and 'y' in metres alike"),
        (replace(start, x=0.6 * start.x), "give 'x' and 'y' in metres alike"),
        (replace(start, psi=start.psi * DEG, r=start.r * DEG), "multiply 'psi' by 180/pi"),
        (in_earth_axes(start), "turn 'u' and 'v' into ship axes"),
        (replace(start, u=start.u * 0.6), "both velocities and positions at midship, not at an antenna"),
    ):
        (finding,) = [one for one in check_trial(trial) if one.code == "contradicted"]
        assert finding.fix.startswith(fix) or fix in finding.fix
        assert ("over ground" in finding.fix) == (fix.startswith("both"))
    stretched = replace(start, x=0.7 * start.x, y=1.2 * start.y)
    (finding,) = [one for one in check_trial(stretched) if one.code == "contradicted"]
    assert finding.why.endswith("they fit if 'x' is divided by 0.7 and 'y' is divided by 1.2")


def test_positions_of_an_antenna_are_told() -> None:
    start = made(seed=1, angle=35.0 * DEG)
    forward = replace(start, x=start.x + 25.0 * np.cos(start.psi), y=start.y + 25.0 * np.sin(start.psi))
    (finding,) = [one for one in check_trial(forward) if one.severity == "warning"]
    assert "they fit if they are of a point about 25 m forward" in finding.why
    assert finding.fix.startswith("give positions of midship: [antenna]")


@SEEDS
@pytest.mark.parametrize("kind", [{}, {"zigzag": True}, {"angle": -10 * DEG}])
def test_rudder_of_the_other_sign(seed: int | None, kind: dict[str, Any]) -> None:
    only(changed(made(seed=seed, **kind), "delta", np.negative), "the ship turns away from its rudder")


@SEEDS
@pytest.mark.parametrize("kind", [{}, {"zigzag": True}, {"angle": -10 * DEG}])
def test_orders_instead_of_positions(seed: int | None, kind: dict[str, Any]) -> None:
    only(made(seed=seed, rudder_rate=1e9, **kind), "these may be orders, not positions")


def test_engine_orders_instead_of_revolutions() -> None:
    only(with_value(made(), "n", slice(200, None), 0.9), "revolutions change by 48 rpm")


def test_a_telegraph_stands_still_before_it_changes_and_after() -> None:
    """However seldom it is logged; an engine takes its time, and what is measured is never quite the same twice."""
    slow = made(dt=3.0)
    only(with_value(slow, "n", slice(200, None), 1.4), "revolutions change by 18 rpm from one sample to the next")
    ramp = np.interp(slow.t, slow.t[[0, 200, 204, -1]], [1.7, 1.7, 1.4, 1.4])
    only(changed(slow, "n", lambda _: ramp))
    measured = np.where(slow.t < slow.t[200], 1.7, 1.4) + 0.002 * np.random.default_rng(0).normal(size=len(slow.t))
    only(changed(slow, "n", lambda _: measured))


def test_revolutions_per_minute() -> None:
    only(made(n=102.0), "divide 'n' by 60")
    only(made(n=12.0))


@SEEDS
@pytest.mark.parametrize(
    ("name", "value"), [("x", 900.0), ("psi", 60.0), ("u", 9.0), ("r", 0.2), ("delta", -0.5), ("n", 0.0)]
)
def test_spikes(seed: int | None, name: str, value: float) -> None:
    trial = with_value(made(seed=seed), name, 300, value)
    warnings = said(trial)
    assert f"'{name}' has 1 spike" in warnings
    assert f"column '{name}', row 300" in warnings
    assert "orders" not in warnings


@pytest.mark.parametrize("apart", [slice(None, None, 2), slice(None, None, 3)], ids=["in turn", "one in three"])
@pytest.mark.parametrize(
    ("name", "by", "told"),
    [("x", 30.0, "'x' and 'y' go to and fro by"), ("psi", 9.0 * DEG, "'psi' goes to and fro by")],
)
def test_two_sensors_that_log_in_turn(name: str, by: float, told: str, apart: slice) -> None:
    """Positions that alternated between two places 30 m apart passed for noise, of the log and of a diagnosis."""

    def moved(values: FloatArray) -> FloatArray:
        other = np.array(values)
        other[apart] += by
        return other

    assert told in said(changed(made(seed=1), name, moved))
    assert told not in said(changed(made(seed=1), name, lambda values: values + by))
    assert told not in said(made(seed=1, dt=0.1))  # noise larger than the way from sample to sample


@pytest.mark.parametrize(("name", "step"), [("x", 2.0), ("psi", 1.0 * DEG), ("u", 0.1), ("r", 0.2 * DEG), ("n", 0.02)])
def test_the_last_of_few_digits_is_no_spike(name: str, step: float) -> None:
    def printed(values: FloatArray) -> FloatArray:
        noisy = values + 0.4 * step * np.random.default_rng(1).normal(size=len(values))
        return np.asarray(np.round(noisy / step) * step)

    coarse = changed(made(seed=1), name, printed)
    assert "spikes" not in said(coarse)
    assert f"'{name}' has 1 spike" in said(with_value(coarse, name, 300, 60.0 * step + 900.0 * (name == "x")))


def test_one_step_of_revolutions_logged_in_halves_is_no_spike() -> None:
    steady = with_value(made(n=106.0 / 60.0), "n", 246, 105.5 / 60.0)
    only(steady)
    only(with_value(steady, "n", 300, 106.5 / 60.0))
    only(with_value(steady, "n", 300, 0.0), "'n' has 1 spike")


def test_the_steering_gear_of_a_model_is_quick() -> None:
    """A model of 3 m: its shaft makes 10 turns a second, its rudder 20 deg/s, and orders jump there too."""
    model = {"n": 10.0, "speed": 0.4, "dt": 0.5, "lag": 8.0}
    only(made(rudder_rate=20.0 * DEG, **model))
    only(made(rudder_rate=1e9, angle=35.0 * DEG, **model), "these may be orders, not positions")
    only(made(rudder_rate=20.0 * DEG, **{**model, "n": 1.7}), "these may be orders, not positions")


def test_gaps_of_all_columns_are_one_warning() -> None:
    trial = with_value(with_value(made(), "x", slice(40, 50), np.nan), "r", [41, 42], np.nan)
    only(trial, "'x' and 'r' have gaps: 2 to 10 of 500 samples; the longest has 10 samples, 11 s (")


def test_directions_in_degrees() -> None:
    blown = replace(made(), extra={"wind_speed": np.full(500, 8.0), "wind_dir": np.full(500, 270.0)})
    only(blown, "'wind_dir' is up to 270 rad")


@pytest.mark.parametrize("pair", [("wind_speed", "wind_dir"), ("wind_speed_app", "wind_dir_app")])
def test_half_a_wind(pair: tuple[str, str]) -> None:
    columns = {name: np.full(500, 2.0) for name in pair}
    straight = made(zigzag=True)  # no turn, so that any wind may be the true one
    whole = replace(straight, extra=columns)
    only(whole)
    assert measured_around(whole) == {"wind"}
    for kept, missing in (pair, pair[::-1]):
        half = replace(straight, extra={kept: columns[kept]})
        only(half, f"there is '{kept}' without '{missing}'")
        assert not measured_around(half)
    never_both = [np.where(np.arange(500) < 200, np.nan, 2.0), np.where(np.arange(500) < 200, 2.0, np.nan)]
    assert not measured_around(replace(made(), extra=dict(zip(pair, never_both, strict=True))))
    assert not measured_around(made())


@pytest.mark.parametrize(
    "pair",
    [
        ("current_speed", "current_dir"),
        ("current_speed_at_2.5m", "current_dir_at_2.5m"),
        ("wave_height", "wave_dir"),
    ],
)
def test_half_a_current_and_half_of_waves(pair: tuple[str, str]) -> None:
    whole = replace(made(), extra={name: np.full(500, 2.0) for name in pair})
    only(whole)
    assert len(measured_around(whole)) == 1
    for kept, missing in (pair, pair[::-1]):
        half = replace(made(), extra={kept: whole.extra[kept]})
        only(half, f"there is '{kept}' without '{missing}'")
        assert not measured_around(half)
    damaged = replace(made(), extra={name: np.full(500, 1e300) for name in pair})
    assert f"'{pair[0]}' is up to 1e+300" in said(damaged, "error")


@pytest.mark.parametrize(
    ("name", "value"), [("wave_height", 180.0), ("current_speed", 40.0), ("depth", -12.0), ("wind_speed", -3.0)]
)
def test_numbers_that_nothing_around_a_ship_has(name: str, value: float) -> None:
    partner = {"wave_height": "wave_dir", "current_speed": "current_dir", "wind_speed": "wind_dir"}.get(name)
    extra = {name: np.where(np.arange(500) == 40, value, 1.0), **({partner: np.zeros(500)} if partner else {})}
    only(replace(made(), extra=extra), f"'{name}' is {value:g}")
    assert f"column '{name}', row 40" in said(replace(made(), extra=extra))


def test_a_layer_of_the_water_is_known() -> None:
    """By unit and meaning, as any column."""
    layer = known_column("current_speed_at_2.5m")
    assert layer is not None
    assert layer.unit == "m/s"
    assert "2.5 m below the surface" in layer.meaning
    assert known_column("current_speed_at_m") is None
    assert known_column("wind_speed_at_2m") is None


def test_notes() -> None:
    uneven = replace(made(), extra={"wind_sped": np.ones(500)}, ignored=("helmsman",), source="")
    every_other = np.r_[0:100, 100:500:2]
    columns = {
        name: getattr(uneven, name)[every_other] for name in ("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta")
    }
    uneven = replace(uneven, **columns, extra={"wind_sped": np.ones(len(every_other))})
    only(uneven)
    notes = said(uneven, "note")
    assert "the time step varies between 1 and 2 s" in notes
    assert "meant to be 'wind_speed' [m/s]" in notes
    assert "'helmsman' holds no numbers" in notes
    assert "does not say whether it was measured" in notes


def test_worst_first() -> None:
    trial = with_value(made(source="generated"), "x", 40, np.nan)
    assert [f.severity for f in check_trial(trial)] == ["warning", "note"]


def test_spikes_of_a_channel_are_looked_for_once(monkeypatch):
    """Several checks pass over them; they took a third of an import."""
    from mmgtune.trial.checks import motion_checks

    looked, before = [], motion_checks.spikes
    monkeypatch.setattr(motion_checks, "spikes", lambda values, share: looked.append(share) or before(values, share))
    trial = load_trials("suzaku")["turn_p35"]
    check_trial(trial)
    assert len(looked) == 8
    check_trial(replace(trial, x=trial.x + 1.0))
    assert len(looked) == 16


def test_a_reading_alone_misses_positions_as_among_all():
    columns = load_trials("suzaku")["zigzag_20"].columns
    every = position_misfits(columns)
    assert list(every) == list(Reading)
    for reading in Reading:
        assert position_misfits(columns, among=(reading,)) == {reading: every[reading]}


def test_what_is_known_to_be_usable_is_not_looked_at_again():
    trial = load_trials("suzaku")["turn_p35"]
    assert check_trial(trial, usable=True) == check_trial(trial)
    broken = replace(trial, delta=100.0 * trial.delta)
    assert [one.severity for one in check_trial(broken)] == ["error"]
