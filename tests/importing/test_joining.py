"""Logs with a sheet or a structure for each sensor, whose times are its own."""

import numpy as np
import pytest
import scipy.io

from mmgtune import import_logs, propose_map
from mmgtune.importing import parse_map
from mmgtune.importing.formats.matlab_columns import columns_of
from mmgtune.importing.record import Series, at_times_of
from mmgtune.units import DEG

from .made import refusal, turn
from .test_workbooks import book

RUN = turn()
FINE = np.arange(0.13, RUN.t[-1], 0.25)
"""Times of sensors that log four times as often as the positions, and never at the same moment."""


def at(times, values):
    return np.interp(times, RUN.t, values)


def sheet(times, name, values, time="time [s]"):
    return [[time, name], *([float(t), float(one)] for t, one in zip(times, values, strict=True))]


def each(own=RUN.t, other=RUN.t, named=False):
    """A sheet for each quantity: positions at times ``own``, the rest at ``other``."""
    values = {
        "North": (own, at(own, RUN.x)),
        "East": (own, at(own, RUN.y)),
        "Heading": (other, np.mod(at(other, RUN.psi) / DEG, 360.0)),
        "RPM": (other, 60.0 * at(other, RUN.n)),
        "Rudder": (other, at(other, RUN.delta) / DEG),
    }
    return {name: sheet(t, name if named else "value", one) for name, (t, one) in values.items()}


def answered(proposal):
    """The map, the side of the rudder answered where it is asked for."""
    assert set(proposal.asks) <= {"columns.delta.positive"}
    asked = next((line for line in proposal.text.splitlines() if line.startswith("delta = ")), "")
    return parse_map(
        proposal.text.replace(asked, asked[: asked.index("positive")] + 'positive = "starboard" }') if proposal.asks
        else proposal.text
    )  # fmt: skip


def one_trial(log):
    proposal = propose_map(log)
    return proposal, *import_logs(log, answered(proposal), ".", dry_run=True).trials


def close_to_run(trial, began, tolerance):
    t = trial.t + began
    for name in ("x", "y", "psi", "n", "delta"):
        true = at(t, getattr(RUN, name))
        off = getattr(trial, name) - true
        off = off - 2.0 * np.pi * np.round(off[0] / (2.0 * np.pi)) if name == "psi" else off
        assert np.nanmax(np.abs(off)) < tolerance * max(1.0, np.abs(true).max()), name


@pytest.mark.parametrize("named", [True, False])
def test_a_sheet_for_each_quantity_with_the_same_times(tmp_path, named):
    proposal, trial = one_trial(book(tmp_path / "log.xlsx", **each(named=named)))
    assert "join = true" in proposal.text
    assert 'sheet = ["North", "East", "Heading", "RPM", "Rudder"]' in proposal.text
    assert f'column = "{"Rudder" if named else "Rudder.value"}"' in proposal.text
    shown = "'North', 'East', 'Heading', 'RPM' and 'Rudder' have the same times and are put together"
    assert proposal.notes[0] == shown
    assert trial.n_samples == RUN.n_samples
    close_to_run(trial, 0.0, 1e-9)


def test_sheets_with_other_rates_and_other_moments(tmp_path):
    log = book(tmp_path / "log.xlsx", **each(other=FINE))
    proposal = propose_map(log)
    (trial,) = (found := import_logs(log, answered(proposal), ".", dry_run=True)).trials
    told = f"({RUN.n_samples}, {RUN.n_samples}, {len(FINE)}, {len(FINE)}, {len(FINE)} of them) and are put together"
    assert told in proposal.notes[0]
    assert proposal.notes[0] in found.quality[0]["notes"]
    assert "rate      every 0.25 s" in found.text()
    close_to_run(trial, 1.0, 0.02)


def test_the_two_of_a_position_may_be_logged_in_turn(tmp_path):
    sheets = each()
    late = RUN.t[:-1] + 0.4
    sheets["East"] = sheet(late, "value", at(late, RUN.y))
    _, trial = one_trial(book(tmp_path / "log.xlsx", **sheets))
    close_to_run(trial, 1.0, 1e-3)


def test_a_pair_is_brought_to_one_time_where_hardly_a_row_has_both():
    t = np.arange(8.0)
    x = Series(t, np.where(t % 2 == 0, 3.0 * t, np.nan))
    y = Series(t, np.where(t % 2 == 1, -2.0 * t, np.nan))
    assert np.array_equal(at_times_of(x, y).values[2::2], -2.0 * t[2::2])
    assert np.isnan(at_times_of(x, y).values[[0, 1, 3, 5, 7]]).all()
    both = Series(t, -2.0 * t)
    assert at_times_of(Series(t, 3.0 * t), both) is both
    holed = Series(t, np.where((t % 2 == 1) & (t != 3.0), -2.0 * t, np.nan))
    assert np.isnan(at_times_of(x, holed).values[[2, 4]]).sum() in (0, 2)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (lambda t: t[::-1], "the times of 'Rudder' fall back"),
        (lambda t: np.floor(t / 10.0), "are there more than once"),
        (lambda t: t + 1e5, "they have too little time in common"),
    ],
)
def test_what_times_do_not_allow_is_refused(tmp_path, change, why):
    sheets = each()
    sheets["Rudder"] = sheet(change(RUN.t), "value", RUN.delta / DEG)
    told = refusal(lambda: propose_map(book(tmp_path / "log.xlsx", **sheets)))
    assert "each sheet holds one quantity: 'North', 'East', 'Heading', 'RPM' and 'Rudder'" in told
    assert why in told
    assert "put them on one sheet" in told
    # A map made for others of the kind refuses such a one too.
    log_map = answered(propose_map(book(tmp_path / "good.xlsx", **each())))
    told = refusal(lambda: import_logs(tmp_path / "log.xlsx", log_map, ".", dry_run=True))
    assert "the sheets cannot be put together by their times" in told
    assert why in told


def test_times_in_other_units_are_not_joined(tmp_path):
    sheets = each()
    sheets["Rudder"] = sheet(1000.0 * RUN.t, "value", RUN.delta / DEG, time="time [ms]")
    told = refusal(lambda: propose_map(book(tmp_path / "log.xlsx", **sheets)))
    assert "they count their times in ms and s" in told


@pytest.mark.parametrize("called", ["Time", "Date"])
def test_sheets_of_sensors_with_several_quantities_each(tmp_path, called):
    def row(t, *values):
        return [f"2024-05-14T10:{int(t) // 60:02d}:{t % 60:06.3f}", *map(float, values)]

    angles = (np.mod(at(FINE, RUN.psi) / DEG, 360.0), 60.0 * at(FINE, RUN.n), at(FINE, RUN.delta) / DEG)
    gps = [[called, "North [m]", "East [m]"], *map(row, RUN.t, RUN.x, RUN.y)]
    rest = [[called, "Heading [deg]", "Shaft [rpm]", "Rudder [deg]"], *map(row, FINE, *angles)]
    _, trial = one_trial(book(tmp_path / "log.xlsx", GPS=gps, Bridge=rest))
    close_to_run(trial, 1.0, 0.02)


def test_join_is_for_several_sheets():
    text = 'schema = 1\n[log]\nformat = "{form}"\n{sheet}join = true\n'
    told = refusal(lambda: parse_map(text.format(form="xlsx", sheet='sheet = "a"\n')))
    assert "'log.join' is true, but no sheets are named that could be joined" in told
    assert "'log.join' has no meaning for text" in refusal(lambda: parse_map(text.format(form="csv", sheet="")))


def held(other=FINE, late=0.05):
    return {
        "gps": {"t": RUN.t, "north": RUN.x, "east": RUN.y},
        "gyro": {"time": other, "heading": np.mod(at(other, RUN.psi) / DEG, 360.0)},
        "rudder": {"t": other + late, "value": at(other + late, RUN.delta) / DEG},
        "rpm": {"t": other, "value": 60.0 * at(other, RUN.n)},
    }


def test_a_structure_for_each_sensor(tmp_path):
    scipy.io.savemat(tmp_path / "log.mat", held())
    proposal, trial = one_trial(tmp_path / "log.mat")
    assert "'gyro' and 'gps' have times of their own" in proposal.notes[0]
    close_to_run(trial, 1.0, 0.02)


def test_a_structure_whose_sensor_is_read_later_has_its_own_times(tmp_path):
    """At 1 s a row, 0.3 s are a rate of 2.3 deg/s times that: it was taken for the same time."""
    late = RUN.t + 0.3
    of_rudder = {"t": late, "value": at(late, RUN.delta) / DEG}
    rest = {one: columns for one, columns in held(RUN.t).items() if one != "rudder"}
    scipy.io.savemat(tmp_path / "log.mat", rest | {"rudder": of_rudder})
    proposal, _ = one_trial(tmp_path / "log.mat")
    assert "'rudder' have times of their own" in proposal.notes[0]
    found = columns_of(tmp_path / "log.mat")
    rudder = np.asarray(found.columns[found.names.index("rudder.value")])
    time = np.asarray(found.columns[found.names.index("gps.t")])
    assert time[np.isfinite(rudder)] == pytest.approx(late)


def test_a_structure_without_times_in_common_is_left_out_and_told(tmp_path):
    scipy.io.savemat(tmp_path / "log.mat", held() | {"wind": {"t": 1e4 + FINE[:50], "speed": FINE[:50]}})
    found = columns_of(tmp_path / "log.mat")
    assert "wind.speed" not in found.names
    assert any(
        "'wind', which has times of its own" in one and "too little time in common" in one for one in found.notes
    )
    assert "wind.speed" in found.other


def test_a_timeseries_with_times_of_its_own_comes_with_the_others(tmp_path):
    several = {"Time": RUN.t, "Data": np.column_stack([RUN.x, RUN.y])}
    scipy.io.savemat(tmp_path / "log.mat", {"pos": several, "rudder": {"Time": FINE, "Data": at(FINE, RUN.delta)}})
    found = columns_of(tmp_path / "log.mat")
    rudder = np.asarray(found.columns[found.names.index("rudder.data")])
    assert np.array_equal(rudder[np.isfinite(rudder)], at(FINE, RUN.delta))
