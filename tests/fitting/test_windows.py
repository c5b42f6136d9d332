"""Fits on windows of a long trial."""

from dataclasses import replace

import numpy as np

from mmgtune.fitting import FitOptions, SweepOptions, fit, sweep
from mmgtune.report import render
from mmgtune.trial import TrialSet
from tests.fitting.conftest import make_set, make_trial


def test_windows_at_rest_and_a_short_remainder_stop_no_fit(suzaku):
    """The ship lies still at last, and the end leaves fewer seconds than lie between samples that count."""
    truth = {"hull.N_r": 1.1 * suzaku.profile.value("hull.N_r")}
    trial = make_trial(suzaku, "turn", 20.0, 210, truth)
    t = np.arange(0.0, 251.15, 0.1)
    columns = {name: np.interp(t, trial.t, getattr(trial, name)) for name in ("x", "y", "psi", "u", "v_m", "r")}
    still = t > trial.t[-1]
    columns |= {name: np.where(still, 0.0, columns[name]) for name in ("u", "v_m", "r")}
    inputs = {name: np.where(still, 0.0, np.interp(t, trial.t, getattr(trial, name))) for name in ("n", "delta")}
    long = replace(trial, t=t, **columns, **inputs)
    options = FitOptions(a_r=0.5, targets=("hull.N_r",), method="least-squares", starts=1, restart=50.0, every=2.0)
    result = fit(suzaku.profile, TrialSet({"turn": long}, ("turn",), (), "suzaku"), options)
    assert [one.trial.id for one in result.compared] == [f"turn@{start}" for start in (0, 50, 100, 150, 200)]
    assert np.isfinite(result.J)


def test_windows_are_not_called_trials(suzaku, tmp_path):
    """Eight windows of four trials were eight trials, in the verdict and in the report."""
    trials = make_set(suzaku, noise=1.0)
    length = max(trial.duration for trial in trials.trials.values()) / 2.0
    few = {"targets": ("hull.N_r",), "method": "least-squares", "starts": 1, "restart": length}
    swept = sweep(suzaku.profile, trials, SweepOptions(widths=(0.3,), **few), folder=tmp_path)
    cut = swept.compared(0, "test")
    assert len(cut) > len(trials.test)
    words = f"{len(cut)} windows of {len(trials.test)} trials"
    assert swept.recommended()["sentence"].startswith(f"On {words} not used for tuning, ")
    verdict = swept.runs[0].sentence()
    assert verdict.startswith(f"On {words} not used for tuning, ")
    assert f" of {len(cut)} of these windows improve." in verdict
    warned = swept.runs[0].warnings
    assert f"{len(trials.trials)} of {len(trials.trials)} trials are generated, not measured." in warned
    assert not [one for one in warned if "the ship is steered" in one]  # said of a window: its rudder is held
    off = swept.to_dict()["runs"][0]["off"]["test"]
    assert (off["trials"], off["windows"]) == (len(trials.test), len(cut))
    assert swept.runs[0].compared[0].to_dict()["part_of"] == trials.tune[0]
    for place in (tmp_path, tmp_path / "ar_0.3"):
        render(place)
        assert words in (place / "report.md").read_text(encoding="utf-8")


def test_windows_of_trials_left_out_in_turn_are_told_as_such(suzaku):
    trials = make_set(suzaku, noise=1.0, test=False)
    few = {"targets": ("hull.N_r",), "method": "least-squares", "starts": 1, "restart": 100.0}
    said = sweep(suzaku.profile, trials, SweepOptions(widths=(0.3,), **few)).recommended()["sentence"]
    assert f" windows of {len(trials.tune)} trials, each trial left out in turn, " in said
