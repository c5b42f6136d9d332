"""Warnings that imports give unasked, on logs with a known fault, and none on logs without."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.importing import import_logs, parse_map
from mmgtune.importing.doubts import gyro_drift
from mmgtune.units import DEG

from .made import MAP, logged, refusal, suzaku, turn, write_csv


def warned(tmp_path, columns, text=MAP):
    """What and fix of every warning on a log."""
    log = write_csv(tmp_path / "log.csv", columns)
    (quality,) = import_logs([log], parse_map(text), tmp_path, dry_run=True).quality
    return {one["what"]: one["fix"] for one in quality["findings"] if one["severity"] == "warning"}


def one_of(found, words):
    """The fix of the one warning with some words in it."""
    (fix,) = [fix for what, fix in found.items() if words in what]
    return fix


@pytest.mark.parametrize("name", ["turn_p35", "turn_m20", "zigzag_10", "zigzag_20"])
def test_a_good_log_has_none_of_these(tmp_path, name):
    found = warned(tmp_path, logged(suzaku(name)))
    words = ("drift apart", "velocities seem", "alone", "digits", "is moved")
    assert not [what for what in found if any(one in what for one in words)]


def test_a_bias_of_the_yaw_rate(tmp_path):
    trial = suzaku("zigzag_10")
    columns = logged(replace(trial, r=trial.r - 0.02 * DEG))
    fix = one_of(warned(tmp_path, columns), "drift apart")
    offset = float(fix.split('offset = "')[1].split(" deg/s")[0])
    assert offset == pytest.approx(0.02, rel=0.15)
    mended = MAP.replace(
        '"deg/min", positive = "starboard" }', f'"deg/min", positive = "starboard", offset = "{offset} deg/s" }}'
    )
    assert not [what for what in warned(tmp_path, columns, mended) if "drift apart" in what]


def test_a_factor_on_the_yaw_rate_of_a_turn(tmp_path):
    trial = suzaku("turn_p35")
    fix = one_of(warned(tmp_path, logged(replace(trial, r=trial.r / 1.05))), "drift apart")
    assert float(fix.split("scale = ")[1].split(" ")[0]) == pytest.approx(1.05, abs=0.01)


def fading(size, memory, n, seed):
    """(n,) noise that fades slowly, of which one sample tells the next."""
    rng, kept = np.random.default_rng(seed), np.exp(-1.0 / memory)
    noise = [rng.normal(0.0, size)]
    for _ in range(n - 1):
        noise.append(kept * noise[-1] + rng.normal(0.0, size * np.sqrt(1.0 - kept**2)))
    return np.array(noise)


@pytest.mark.parametrize("turns", [1.0, 0.0])
def test_noise_of_the_yaw_rate_that_fades_slowly_is_no_drift(turns):
    """What it adds up to looked like a line in a fifth of all runs; of a ship that goes straight, like a factor of
    0.016 on her yaw rate."""
    trial = suzaku("zigzag_10")
    psi, r = turns * trial.psi, turns * trial.r
    runs = [replace(trial, psi=psi, r=r + fading(0.03 * DEG, 25.0, len(r), seed)) for seed in range(40)]
    told = [one for run in runs for one in gyro_drift(run, "")]
    assert len(told) <= 2
    assert not [one for one in told if "scale" in one.fix]


def test_velocities_off_steadily_in_a_turn_are_of_no_other_point(tmp_path):
    """The way of a steady turn and a straight line are what velocities moved along earth axes leave too."""
    trial = suzaku("turn_p35")
    off = 0.03
    u, v = trial.u + off * np.cos(trial.psi), trial.v_m - off * np.sin(trial.psi)
    found = warned(tmp_path, logged(replace(trial, u=u, v_m=v)))
    assert not [what for what in found if "velocities seem" in what]


@pytest.mark.parametrize("name", ["turn_p35", "zigzag_10"])
@pytest.mark.parametrize(
    ("change", "column"),
    [
        (lambda trial: replace(trial, r=trial.r / 60.0), "columns.r"),
        (lambda trial: replace(trial, r=trial.r * DEG / 60.0), "columns.r"),
        (lambda trial: replace(trial, psi=trial.psi * DEG), "columns.psi"),
    ],
)
def test_a_rate_or_heading_in_another_unit_is_no_drift(tmp_path, name, change, column):
    """Offsets and factors were advised where a unit was wrong by 60 or 57."""
    found = warned(tmp_path, logged(change(suzaku(name))))
    assert column in one_of(found, "times as far as the yaw rate says")
    assert not [what for what in found if "drift apart" in what]


def test_a_heading_that_drifts(tmp_path):
    trial = suzaku("zigzag_20")
    drifting = trial.psi + 0.03 * DEG * trial.t
    found = warned(tmp_path, logged(replace(trial, psi=drifting)))
    assert "another compass" in one_of(found, "drift apart") or "offset" in one_of(found, "drift apart")


def test_velocities_moved_along_earth_axes(tmp_path):
    trial = suzaku("turn_p35")
    # Of a point 40 m ahead, the lever's velocity taken off along the earth's y axis.
    north = trial.u * np.cos(trial.psi) - (trial.v_m + 40.0 * trial.r) * np.sin(trial.psi)
    east = trial.u * np.sin(trial.psi) + (trial.v_m + 40.0 * trial.r) * np.cos(trial.psi) - 40.0 * trial.r
    columns = logged(trial)
    columns["ahead"], columns["abeam"] = north * 3600.0 / 1852.0, east * 3600.0 / 1852.0
    text = MAP.replace('axes = "ship"', 'axes = "earth"').replace('unit = "kn", positive = "starboard"', 'unit = "kn"')
    fix = one_of(warned(tmp_path, columns, text), "along earth axes")
    assert 'shifted = "earth-axes"' in fix
    assert float(fix.split('x = "')[1].split(" m")[0]) == pytest.approx(40.0, rel=0.05)
    mended = text.replace('axes = "earth"', 'axes = "earth"\nshifted = "earth-axes"\npoint = { x = "40 m", y = "0 m" }')
    assert not [what for what in warned(tmp_path, columns, mended) if "velocities seem" in what]


def test_velocities_of_another_point(tmp_path):
    trial = suzaku("turn_p35")
    columns = logged(replace(trial, v_m=trial.v_m + 60.0 * trial.r))
    fix = one_of(warned(tmp_path, columns), "velocities seem to be of a point")
    assert float(fix.split('x = "')[1].split(" m")[0]) == pytest.approx(60.0, rel=0.1)


def test_few_printed_digits(tmp_path):
    columns = logged(turn())
    columns["heading"] = np.round(columns["heading"] / 5.0) * 5.0
    fix = one_of(warned(tmp_path, columns), "'psi' is printed with")
    assert fix.startswith('say recover = "yaw-rate" in [columns.psi]')


def test_a_ship_moved_by_people(tmp_path):
    trial = suzaku("zigzag_10")
    head = 60
    n, delta, u = np.array(trial.n), np.array(trial.delta), np.array(trial.u)
    n[:head] = delta[:head] = 0.0
    u[:head] = np.linspace(0.0, u[head], head)
    columns = logged(replace(trial, n=n, delta=delta, u=u))
    assert one_of(warned(tmp_path, columns), "is moved") == 'say from = "first-order" in [cut]'
    cut = MAP + '[cut]\nfrom = "first-order"\n'
    assert not [what for what in warned(tmp_path, columns, cut) if "is moved" in what]
    log = write_csv(tmp_path / "log.csv", columns)
    (made,) = import_logs([log], parse_map(cut), tmp_path, dry_run=True).trials
    assert made.n_samples == trial.n_samples - head
    still = {**columns, "shaft": np.zeros(len(n)), "rudder": np.zeros(len(n))}
    log = write_csv(tmp_path / "log.csv", still)
    assert "cannot be cut at the first order" in refusal(
        lambda: import_logs([log], parse_map(cut), tmp_path, dry_run=True)
    )


def test_a_coasting_ship_is_not_moved(tmp_path):
    trial = suzaku("zigzag_10")
    n, delta, u = np.array(trial.n), np.array(trial.delta), np.array(trial.u)
    n[-80:] = delta[-80:] = 0.0
    u[-80:] = u[-80] * np.linspace(1.0, 0.5, 80)
    found = warned(tmp_path, logged(replace(trial, n=n, delta=delta, u=u, r=np.where(n == 0.0, 0.0, trial.r))))
    assert not [what for what in found if "is moved" in what]


def test_another_column_is_the_yaw_rate(tmp_path):
    trial = turn()
    columns = {**logged(trial), "p": 3.0 * np.sin(0.7 * trial.t)}
    open_sign = MAP.replace(
        'column = "rate", unit = "deg/min", positive = "starboard"', 'column = "p", unit = "deg/min"'
    )
    said = refusal(lambda: warned(tmp_path, columns, open_sign))
    assert "'p' is not the yaw rate, which the map says it is" in said
    assert 'fix: say column = "rate" in [columns.r]' in said
    stated = MAP.replace('column = "rate"', 'column = "p"')
    assert one_of(warned(tmp_path, columns, stated), "does not integrate") == 'say column = "rate" in [columns.r]'


def test_fixes_name_keys_of_the_map(tmp_path):
    columns = logged(turn())
    columns["rudder"] = columns["rudder"] * DEG * 60.0
    text = MAP.replace('rudder", unit = "deg"', 'rudder", unit = "rad"')
    said = refusal(lambda: warned(tmp_path, columns, text))
    assert "multiply" not in said
    assert "[columns.delta] of the map" in said


def test_midship_is_said_to_be_assumed(tmp_path):
    log = write_csv(tmp_path / "log.csv", logged(turn()))
    words = "positions are taken to be of midship, as the map has no [antenna]"
    (trial,) = import_logs([log], parse_map(MAP), tmp_path, dry_run=True).trials
    assert words in trial.note
    stated = MAP.replace('axes = "ship"', 'axes = "ship"\npoint = "midship"')
    (trial,) = import_logs([log], parse_map(stated), tmp_path, dry_run=True).trials
    assert words not in trial.note
