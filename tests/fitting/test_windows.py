"""Fits on windows of a long trial."""

from dataclasses import replace

import numpy as np

from mmgtune.fitting import FitOptions, fit
from mmgtune.trial import TrialSet
from tests.fitting.conftest import make_trial


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
