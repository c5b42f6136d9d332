"""Faults of real logs that a map undoes, made on purpose: shifted velocities, gyros, idle tails, pull-outs."""

import numpy as np
import pytest

from mmgtune.importing import import_logs, parse_map
from mmgtune.trial import read_trial
from mmgtune.units import DEG, KNOT
from tests.importing.made import MAP, close, imported, logged, refusal, said, turn, write_csv

AXES = 'axes = "ship"'


def three_digits(values):
    return np.array([float(f"{value:.2e}") for value in values])


@pytest.mark.parametrize("axes", ["ship", "earth"])
@pytest.mark.parametrize("faulty", [False, True])
def test_velocities_of_another_point(tmp_path, axes, faulty):
    """Of a point 11.2 m forward and 3 m to port; and moved to midship, but along earth axes."""
    trial = turn()
    ahead, abeam = 11.2, -3.0
    cos, sin = np.cos(trial.psi), np.sin(trial.psi)
    u, v = trial.u - abeam * trial.r, trial.v_m + ahead * trial.r
    north, east = u * cos - v * sin, u * sin + v * cos
    if faulty:
        north, east = north + abeam * trial.r, east - ahead * trial.r
    columns = logged(trial)
    pair = (north, east) if axes == "earth" else (north * cos + east * sin, east * cos - north * sin)
    columns["ahead"], columns["abeam"] = pair[0] / KNOT, pair[1] / KNOT
    log = write_csv(tmp_path / "log.csv", columns)
    stated = f'axes = "{axes}"\npoint = {{ x = "{ahead} m", y = "{abeam} m" }}'
    positive = "east" if axes == "earth" else "starboard"
    text = MAP.replace('"kn", positive = "starboard"', f'"kn", positive = "{positive}"').replace(AXES, stated)
    if faulty:
        assert np.abs(imported(log, text).v_m - trial.v_m).max() > 0.01
        text = text.replace("[columns]", 'shifted = "earth-axes"\n[columns]')
    back = imported(log, text)
    close(back, trial, 1e-9)
    assert "velocities moved to midship from 11.2 m forward" in back.note
    assert ("along earth axes instead of the ship's" in back.note) == faulty


def turned_far():
    """A zigzag that heads east, where headings are printed in steps of 0.1 and 1 deg, and its gyro's log."""
    trial = turn()
    columns = logged(trial)
    columns["heading"] = three_digits(trial.psi / DEG + 95.0)
    late = 0.8
    rate = np.interp(trial.t - late, trial.t, trial.r) + 0.005 * DEG
    columns["rate"] = rate / DEG * 60.0
    columns["north"], columns["east"] = columns["north"] * 0.0, columns["east"] * 0.0
    turned = trial.psi + 95.0 * DEG
    for name, way in (
        ("north", trial.u * np.cos(turned) - trial.v_m * np.sin(turned)),
        ("east", trial.u * np.sin(turned) + trial.v_m * np.cos(turned)),
    ):
        columns[name] = np.concatenate([[0.0], np.cumsum(0.5 * (way[1:] + way[:-1]) * np.diff(trial.t))])
    return trial, turned, columns


RECOVERED = MAP.replace('"heading", unit = "deg"', '"heading", unit = "deg", recover = "yaw-rate"')


def test_heading_from_the_yaw_rate(tmp_path):
    trial, turned, columns = turned_far()
    log = write_csv(tmp_path / "log.csv", columns)
    rough, back = imported(log), imported(log, RECOVERED)
    # One gyro for 400 s: what is left is its interpolation at corners, far below the 1 deg printed.
    assert np.abs(rough.psi - turned).max() > 0.4 * DEG
    assert np.abs(back.psi - turned).max() < 0.1 * DEG
    assert np.abs(back.r - trial.r).mean() < 0.5 * np.abs(rough.r - trial.r).mean()
    assert "a bias of 0.00" in back.note
    assert "rounding alone" in back.note
    columns["heading"] = columns["heading"] + 0.0123456
    assert "psi is printed with more than 6 digits" in said(write_csv(log, columns), RECOVERED)


def test_heading_that_its_rate_does_not_follow(tmp_path):
    _, _, columns = turned_far()
    log = tmp_path / "log.csv"
    holed = {**columns, "rate": np.where(np.arange(400) // 50 == 3, np.nan, columns["rate"])}
    assert "r, which has a hole: both are as printed" in said(write_csv(log, holed), RECOVERED)
    columns["rate"] = -columns["rate"]
    answer = refusal(lambda: said(write_csv(log, columns), RECOVERED))
    assert "cannot be recovered from the yaw rate" in answer
    assert "rounding alone" in answer


def test_residual_of_integrated_velocities_is_reported(tmp_path):
    trial = turn()
    columns = logged(trial)
    for name in ("north", "east"):
        columns[name] = three_digits(columns[name])
    log = write_csv(tmp_path / "log.csv", columns)
    text = MAP
    for name in ("north", "east"):
        text = text.replace(f'"{name}", unit = "m"', f'"{name}", unit = "m", recover = "print-resolution"')
    (quality,) = import_logs([log], parse_map(text), tmp_path, dry_run=True).quality
    found = quality["positions"]
    for name in ("x", "y"):
        # The trapezoidal rule at 1 s cuts corners of a track with rudder reversals by some 5 cm.
        assert found[f"residual_{name}_m"] == pytest.approx(found[f"rounding_{name}_m"], rel=0.2, abs=0.05)
    assert "integrated velocities leave x by" in said(log, text)
    (quality,) = import_logs([log], parse_map(MAP), tmp_path, dry_run=True).quality
    assert quality["positions"]["rounding_x_m"] is None


def test_end_counted_back(tmp_path):
    log = write_csv(tmp_path / "log.csv", logged(turn()))
    back = imported(log, MAP + '[cut]\nstart = "10 s"\nend = "-20 s"\n')
    assert back.duration == pytest.approx(399.0 - 20.0 - 10.0)
    assert "the last 20 s of the log were dropped" in back.note
    assert "no stretch of 20 samples" in refusal(lambda: imported(log, MAP + '[cut]\nend = "-2000 s"\n'))


def test_idle_tail(tmp_path):
    columns = logged(turn())
    columns["shaft"], columns["rudder"] = columns["shaft"].copy(), columns["rudder"].copy()
    columns["shaft"][350:] = 0.0
    columns["rudder"][360:] = 0.0
    log = write_csv(tmp_path / "log.csv", columns)
    text = MAP + '[cut]\nto = "last-order"\n'
    back = imported(log, text)
    assert back.duration == pytest.approx(359.0)
    assert "the last 40 s were dropped: propeller and rudder stand at zero" in back.note
    both = imported(log, text + 'end = "-100 s"\n')
    assert both.duration == pytest.approx(299.0)
    # Idle in between is no tail.
    columns["shaft"][390:] = 90.0
    assert imported(write_csv(log, columns), text).n_samples == 400
    for name in ("shaft", "rudder"):
        columns[name] = np.zeros(400)
    answer = refusal(lambda: imported(write_csv(log, columns), text))
    assert "stand at zero throughout" in answer


def turn_and_pull_out():
    """A turn to starboard for 300 s, and 200 s with the rudder amidships."""
    t = np.arange(500.0)
    r, psi, x, y = (np.zeros(500) for _ in range(4))
    delta = np.interp(t, [0.0, 20.0, 30.0, 300.0, 310.0], [0.0, 0.0, 25.0, 25.0, 0.0]) * DEG
    for k in range(499):
        r[k + 1] = r[k] + 0.05 * (0.05 * delta[k] - r[k])
        psi[k + 1] = psi[k] + 0.5 * (r[k] + r[k + 1])
        x[k + 1] = x[k] + 3.0 * np.cos(0.5 * (psi[k] + psi[k + 1]))
        y[k + 1] = y[k] + 3.0 * np.sin(0.5 * (psi[k] + psi[k + 1]))
    return {
        "time": t, "north": x, "east": y, "heading": np.mod(psi / DEG, 360.0), "ahead": np.full(500, 3.0 / KNOT),
        "abeam": np.zeros(500), "rate": r / DEG * 60.0, "shaft": np.full(500, 90.0), "rudder": delta / DEG,
    }  # fmt: skip


def test_pull_out_is_a_trial_of_its_own(tmp_path):
    log = write_csv(tmp_path / "circle.csv", turn_and_pull_out())
    text = MAP + '[trial]\nmanoeuvre = "turning"\n[cut]\nsplit = "pull-out"\n'
    result = import_logs([log], parse_map(text), tmp_path / "out")
    assert [path.name for path in result.files] == ["circle.parquet", "circle_pull-out.parquet"]
    circle, out = (read_trial(path) for path in result.files)
    assert (circle.manoeuvre, out.manoeuvre) == ("turning", "pull-out")
    # What is left out to be predicted must not be known from its own other half.
    assert circle.run == out.run == "circle"
    assert circle.duration == pytest.approx(300.0, abs=3.0)
    assert circle.duration + out.duration == pytest.approx(499.0)
    assert out.t[0] == 0.0
    assert out.x[0] == circle.x[-1]
    assert out.psi[0] == circle.psi[-1]
    assert result.quality[1]["began_s"] == pytest.approx(circle.duration)
    # A zigzag has none.
    log = write_csv(tmp_path / "zigzag.csv", logged(turn()))
    zigzag = imported(log, text)
    assert zigzag.n_samples == 400
    assert zigzag.cut_from == ""


def test_rows_of_another_kind_of_log(tmp_path):
    """Columns known by their number only: of another log they would be read as something else."""
    columns = logged(turn())
    text = MAP.replace("[time]", "[log]\nheader = false\nfields = 9\n[time]")
    for number, name in enumerate(columns, start=1):
        text = text.replace(f'column = "{name}"', f"column = {number}")
    close(imported(write_csv(tmp_path / "log.csv", columns, header=False), text), turn())
    more = {**columns, "thrust": np.zeros(400)}
    answer = refusal(lambda: imported(write_csv(tmp_path / "log.csv", more, header=False), text))
    assert "the log is of another kind than the map is for" in answer
    assert "have 10 fields, and the map is for rows of 9" in answer


def test_what_logs_have_in_common_is_in_their_trials(tmp_path):
    """A folder a day, and one log that is of another loading."""
    logs = [tmp_path / day / name for day, name in (("may_3", "a.csv"), ("may_4", "b.csv"), ("may_4", "c.csv"))]
    for log in logs:
        log.parent.mkdir(exist_ok=True)
        write_csv(log, logged(turn()))
    text = MAP + '[trial]\ngroup = "{parent}"\n[[logs]]\nname = "c*"\ntrial = { group = "ballast" }\n'
    trials = import_logs(logs, parse_map(text), tmp_path / "out").trials
    assert [trial.group for trial in trials] == ["may_3", "may_4", "ballast"]
    assert [read_trial(tmp_path / "out" / f"{name}.parquet").group for name in "abc"] == ["may_3", "may_4", "ballast"]
    assert imported(logs[0]).group == ""


def test_logs_that_differ_by_name(tmp_path):
    logs = [write_csv(tmp_path / name, logged(turn())) for name in ("a_tc_1.csv", "a_zz_1.csv", "rest.csv")]
    text = MAP + (
        '[trial]\nship = "ketch"\n[cut]\nstart = "10 s"\n'
        '[[logs]]\nname = "*_tc_*"\ntrial = { manoeuvre = "turning", id = "circle" }\n'
        '[[logs]]\nname = "a_*"\ntrial = { manoeuvre = "zigzag" }\ncut = { end = "-20 s" }\n'
    )
    trials = import_logs(logs, parse_map(text), tmp_path / "out").trials
    assert [trial.id for trial in trials] == ["circle", "a_zz_1", "rest"]
    assert [trial.manoeuvre for trial in trials] == ["turning", "zigzag", ""]
    assert {trial.ship for trial in trials} == {"ketch"}
    assert [trial.duration for trial in trials] == pytest.approx([389.0, 369.0, 389.0])
