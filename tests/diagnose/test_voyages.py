"""Diagnosis of ordinary service, without one standard trial: windows of voyages, and what differs between these."""

from __future__ import annotations

import json

import numpy as np
import pytest

from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.diagnose.voyages.differences import differences
from mmgtune.diagnose.voyages.windows import choose_windows, looked_at
from mmgtune.errors import TrialError
from mmgtune.profile import load_profile
from mmgtune.trial import load_voyages
from tests.command import run
from tests.hidden.service import serve

FEW = ("hull.R_0", "wake.w_P0", "rudder.eps", "rudder.gamma_Rp", "rudder.gamma_Rn")
"""Targets: the ship is the profile's own but for what is hidden, and a test has to end."""


def of(result, tag):
    return next(one for one in result.differing if one.quantity.tag == tag)


@pytest.mark.long
def test_fouling_that_grows_over_twelve_voyages_is_growing_resistance(tmp_path):
    serve(tmp_path, [{"resistance": {"factor": 1.0 + 0.03 * k}} for k in range(12)], seed=1)
    result = diagnose("suzaku", tmp_path, DiagnoseOptions(effects=("resistance",), targets=FEW, windows=36))
    found = of(result, "resistance")
    ((slope, error),) = found.trend
    assert found.pattern == "trend", found.evidence
    assert slope == pytest.approx(0.03 / 1.165, rel=0.08)
    assert slope == pytest.approx(0.03 / 1.165, abs=4.0 * error)
    assert "Resistance grew by 2." in result.sentence()
    assert "12 voyages" in result.sentence()
    assert result.verdict == "found"
    json.dumps(result.to_dict(), allow_nan=False)


@pytest.mark.long
def test_a_log_whose_wind_is_low_is_found_from_voyages_alone(tmp_path):
    draw = np.random.default_rng(3)
    winds = [{"wind": {"speed": draw.uniform(5.0, 9.0), "direction": draw.uniform(0.0, 6.28)}} for _ in range(5)]
    serve(tmp_path, winds, seed=1, wind_log=0.8)
    result = diagnose("suzaku", tmp_path, DiagnoseOptions(effects=("wind",), targets=FEW, windows=25))
    assert [cause.tag for cause in result.causes] == ["wind"]
    factor = result.to_dict()["causes"][0]["parameters"]["measured"]["value"]
    assert factor == pytest.approx(1.25, abs=0.03)


def test_a_current_of_each_voyage_is_found(tmp_path):
    truth = np.array([[s * np.cos(a), s * np.sin(a)] for s, a in ((0.15, 0.0), (0.2, 1.3), (0.25, 2.6), (0.3, 3.9))])
    serve(tmp_path, [{"current": {"north": north, "east": east}} for north, east in truth], seed=1)
    result = diagnose("suzaku", tmp_path, DiagnoseOptions(effects=("current", "resistance"), targets=FEW, windows=24))
    found = of(result, "current")
    assert found.pattern == "each", found.evidence
    assert np.hypot(*(found.values - truth).T).max() < 0.05
    turned = np.arctan2(found.values[:, 1], found.values[:, 0]) - np.arctan2(truth[:, 1], truth[:, 0])
    assert np.degrees(np.abs((turned + np.pi) % (2.0 * np.pi) - np.pi)).max() < 10.0
    assert of(result, "resistance").pattern == "none"
    assert "The current differed from voyage to voyage" in result.sentence()
    assert result.verdict == "found"


@pytest.mark.long
def test_as_a_user_runs_it(tmp_path):
    serve(tmp_path / "logs", [{"current": {"north": 0.2 * k, "east": 0.0}} for k in range(3)], seed=2, courses=4)
    told = ("diagnose", "-p", "suzaku", "-t", str(tmp_path / "logs"), "--windows", "9", "--effects", "current")
    few = ("--targets", ",".join(FEW[:2]))
    plan = run(*told, *few, "--dry-run", cwd=tmp_path).out
    assert "9 of 15 windows" in plan
    text = run(*told, *few, "--out", str(tmp_path / "out"), cwd=tmp_path).out
    assert "The current differed from voyage to voyage" in text
    document = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    (current,) = document["voyages"]["differences"]
    assert [row["voyage"] for row in current["by_voyage"]] == ["voyage_01", "voyage_02", "voyage_03"]
    html = (tmp_path / "out" / "report.html").read_text()
    assert "From voyage to voyage" in html
    assert "current north [m/s]" in html  # a panel of the figure
    assert (tmp_path / "out" / "figures" / "differences.svg").is_file()


def test_windows_are_bounded_spread_and_the_same_again(tmp_path):
    serve(tmp_path, [{}, {}], seed=3)
    profile, options = load_profile("suzaku"), DiagnoseOptions(windows=11)
    one, other = (choose_windows(profile, load_voyages(tmp_path), options) for _ in range(2))
    assert list(one.trials.trials) == list(other.trials.trials)
    by_voyage = [trial.whole for trial in one.trials.trials.values()]
    assert sorted(by_voyage.count(name) for name in one.voyages) == [5, 6]
    activity = [np.std(trial.delta) for trial in one.trials.trials.values()]
    assert max(activity) > 2.0 * min(activity)
    assert all(trial.sha256 for trial in one.trials.trials.values())


def test_two_voyages_are_too_few_to_differ(tmp_path):
    assert differences(None, None, ["one", "other"]) == ()


def test_ships_at_rest_give_no_window(tmp_path):
    serve(tmp_path, [{}], seed=1, courses=2)
    with pytest.raises(TrialError, match="no window could be cut"):
        looked_at(load_profile("suzaku"), tmp_path, DiagnoseOptions(restart=5000.0))
