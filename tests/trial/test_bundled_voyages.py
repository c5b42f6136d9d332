"""The voyages that travel with the program: made again as they are, and sound."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.resources import folder
from mmgtune.trial import check_trial, load_voyages, read_trial, write_trial

VOYAGES = folder("trials") / "voyages"


@pytest.mark.long
def test_a_voyage_is_made_again_to_the_last_bit(tmp_path):
    from tools import generate_suzaku_voyages as making

    plan = making.PLANS[-1]
    again = making.voyage(plan, len(making.PLANS))
    there = read_trial(VOYAGES / f"{plan.id}.parquet")
    assert list(again.columns) == list(there.columns)
    for name, values in again.columns.items():
        np.testing.assert_array_equal(values, there.columns[name], err_msg=name)
    one, other = (write_trial(again, tmp_path / name) for name in ("one.parquet", "other.parquet"))
    assert one.read_bytes() == other.read_bytes()


def test_they_are_voyages_of_hours_and_few_bytes():
    found = load_voyages("voyages").voyages
    assert [one.id for one in found] == [f"voyage_{k:02d}" for k in range(1, 13)]
    assert all(one.is_voyage and one.source == "generated" and one.sealed for one in found)
    assert 6.0 < sum(one.duration for one in found) / 3600.0 < 10.0
    assert sum(one.path.stat().st_size for one in found) < 2e6


def test_they_warn_of_nothing_but_gaps():
    for path in sorted(VOYAGES.glob("*.parquet")):
        trial = read_trial(path)
        findings = [one for one in check_trial(trial, L_pp=83.0) if one.severity != "note"]
        assert findings, "the satellites are lost twice"
        assert all(one.code == "gaps" for one in findings), findings
        whole = {name: np.interp(trial.t, trial.t[np.isfinite(v)], v[np.isfinite(v)]) for name, v in _motion(trial)}
        assert [one.severity for one in check_trial(replace(trial, **whole), L_pp=83.0)] == ["note"]


def test_headings_cross_the_ends_of_the_compass():
    trial = read_trial(VOYAGES / "voyage_05.parquet")
    crossings = np.abs(np.diff(np.floor(trial.psi / np.pi))).sum()
    assert crossings >= 20
    assert np.abs(np.diff(trial.psi)).max() < 0.1


def test_each_is_logged_in_its_own_way():
    logged = [set(one.columns) for one in load_voyages("voyages").voyages]
    for name in ("wind_speed", "wind_speed_app", "depth", "wave_height", "current_speed"):
        assert 0 < sum(name in columns for columns in logged) < len(logged), name


def _motion(trial):
    return [(name, getattr(trial, name)) for name in ("x", "y", "u", "v_m")]
