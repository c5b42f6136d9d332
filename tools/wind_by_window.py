"""What the error of each window of trials follows, and the factor on its wind that makes the error least.

    python tools/wind_by_window.py esso_osaka_3m_tuned esso

Windows of 50 s begin at a measured state; rests shorter than half of that are left out.  In each, the wind and the
water it drives are multiplied by one factor, and the factor with the least standardised error (L_MSE) is taken.  Rank
correlations are Spearman's, with the interval that holds 95 % of those of runs drawn anew: windows of one run are not
independent.
"""

from __future__ import annotations

import sys

import numpy as np
import numpy.typing as npt
from scipy.stats import rankdata

from mmgtune.backends import STATES, Integrator, get_backend
from mmgtune.model import Model
from mmgtune.objective import cases_of, make_objective, spread
from mmgtune.profile import load_profile
from mmgtune.scores import score
from mmgtune.trial import Trial, load_trials, measured_wind

FloatArray = npt.NDArray[np.float64]

WINDOW = 50.0
"""Length of the windows [s]."""

FACTORS = np.linspace(0.0, 3.0, 121)
"""Factors tried."""

SCALED = ("effects.wind.measured", "effects.wind-drift.along", "effects.wind-drift.across")

DRAWS = 2000
"""Times runs are drawn anew for an interval."""


def best_factors(model: Model, windows: list[Trial]) -> FloatArray:
    """(n_windows,) factor on the wind with the least standardised error; all factors are lanes of one call."""
    names = [name for name in SCALED if name in model.rows]
    values = np.outer([model.base[model.rows[name]] for name in names], FACTORS)
    cases = cases_of(windows, make_objective(model.L_pp, STATES, scales=spread(windows)), model.inputs, model.draught)
    found = get_backend().run(model, model.matrix(names, values), cases, integrator=Integrator("rk4"))
    return np.asarray(FACTORS[np.argmin(found.cost, axis=1)])


def circumstances(trial: Trial) -> dict[str, float]:
    """What the factor might follow: means over a window of wind [m/s], where it comes from, and position [m]."""
    north, east, _ = measured_wind(trial).T
    speed = np.maximum(np.hypot(north, east), 1e-9)
    from_north, from_east = -north / speed, -east / speed
    means = {
        "wind speed": speed,
        "wind from ahead": from_north * np.cos(trial.psi) + from_east * np.sin(trial.psi),
        "wind from starboard": from_east * np.cos(trial.psi) - from_north * np.sin(trial.psi),
        "wind from north": from_north,
        "wind from east": from_east,
        "x": trial.x,
        "y": trial.y,
    }
    return {name: float(np.nanmean(values)) for name, values in means.items()}


def correlation(a: FloatArray, b: FloatArray, of_run: list[npt.NDArray[np.int64]]) -> str:
    """Spearman's rank correlation over windows, and its interval; of_run are the windows of each run."""
    rng = np.random.default_rng(1)
    picks = [np.concatenate([of_run[k] for k in rng.integers(len(of_run), size=len(of_run))]) for _ in range(DRAWS)]
    r, *drawn = (np.corrcoef(rankdata(a[i]), rankdata(b[i]))[0, 1] for i in (np.concatenate(of_run), *picks))
    low, high = np.percentile(drawn, [2.5, 97.5])
    return f"{r:+.2f} ({low:+.2f} to {high:+.2f})"


def print_table(profile: str, folder: str) -> None:
    """Fit and print."""
    trials = load_trials(folder).in_windows(WINDOW).trials.values()
    windows = [trial for trial in trials if trial.t[-1] > 0.5 * WINDOW and measured_wind(trial)[:, 2].all()]
    runs = np.array([trial.run for trial in windows])
    of_run = [np.flatnonzero(runs == run) for run in dict.fromkeys(runs)]
    model = Model(load_profile(profile))
    factors = best_factors(model, windows)
    errors = np.array([one.L_MSE for one in score(model, windows, spread(windows))])
    quartiles = ", ".join(f"{value:.2f}" for value in np.percentile(factors, [25.0, 50.0, 75.0]))
    at_end = 100.0 * np.mean((factors == FACTORS[0]) | (factors == FACTORS[-1]))
    print(f"{len(windows)} windows of {WINDOW:g} s, {len(of_run)} runs")
    print(f"factor on the wind: mean {factors.mean():.2f}, standard deviation {factors.std(ddof=1):.2f}")
    print(f"quartiles {quartiles}; at an end of the scan {at_end:.0f} %\n")
    print("| | rank correlation with the factor | with the error |\n|---|---|---|")
    table = [circumstances(trial) for trial in windows]
    for name in table[0]:
        values = np.array([row[name] for row in table])
        print(f"| {name} | {correlation(factors, values, of_run)} | {correlation(errors, values, of_run)} |")


if __name__ == "__main__":
    print_table(sys.argv[1], sys.argv[2])
