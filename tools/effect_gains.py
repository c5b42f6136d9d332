"""What each effect gains on trials once the coefficients of a profile are tuned, printed as a table of Markdown.

    python tools/effect_gains.py esso_osaka_3m esso --ar 1

The fit is that of docs/esso-osaka.md: least squares on the standardised error of windows of 100 s, compared every 2 s,
with a small pull to where the coefficients began.  The first row is the best of four starts with no effect put in.
Then every effect that applies is put in alone, and all coefficients are tuned again beside it from where the first row
ended: once with the effect absent, once with a typical size of it.  An effect with several variants, such as a term of
the hull, has a row for each.  Effects named by ``--with-effects`` are in every row, and tuned.
"""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np

from mmgtune.diagnose.bench.hypotheses import hypotheses
from mmgtune.fitting import FitOptions, in_pieces, make_problem
from mmgtune.fitting.least_squares import solve
from mmgtune.fitting.optimum import edge_ridge, random_starts
from mmgtune.model import Model
from mmgtune.profile import ShipProfile, load_profile, scale_of, with_all_effects, with_effects
from mmgtune.trial import TrialSet, load_trials, measured_wind

OPTIONS = FitOptions(
    method="least-squares", objective="standardised", restart=100.0, every=2.0, regularise=0.0005, starts=4
)


def tuned(
    profile: ShipProfile, trials: TrialSet, options: FitOptions, near: tuple[dict[str, float], ...] = ()
) -> tuple[float, dict[str, float]]:
    """J and coefficients by name of the best fit: from the sets ``near``, or from the starts of the options."""
    problem = make_problem(profile, trials, options)
    box = problem.box
    before = np.clip(box.to_unit(box.pre), 0.0, 1.0)
    starts = random_starts(problem, options, before, ())
    if near:
        starts = random_starts(problem, replace(options, starts=1), before, near)[:, 1:]
    ridge = edge_ridge(problem, options, before)
    ends = solve(problem, starts, ridge=ridge, anchor=before, tolerance=1e-5 * float(problem.costs(before[:, None])[0]))
    best = min(ends, key=lambda end: end.J + ridge * float(np.sum((end.unit - before) ** 2)))
    return best.J, dict(zip(box.names, box.from_unit(best.unit).tolist(), strict=True))


def print_gains(name: str, folder: str, a_r: float, tags: list[str]) -> None:
    """Fit and print, a row as soon as it is known."""
    trials = in_pieces(load_trials(folder), OPTIONS)
    profile = with_effects(load_profile(name), {tag: {} for tag in tags}, "put in to be tuned")
    own = [one for one in profile.names() if one.startswith(tuple(f"effects.{tag}." for tag in tags))]
    targets = (*profile.targets, *own)
    options = replace(OPTIONS, a_r=a_r, targets=targets)
    J_base, theta = tuned(profile, trials, options)
    print(f"| effect put in | J | gain |\n|---|---|---|\n| {', '.join(tags) or 'none'} | {J_base:.0f} | |", flush=True)
    wind = any(measured_wind(trial)[:, 2].any() for trial in trials.trials.values())
    size = scale_of(profile)
    for one in hypotheses(Model(with_all_effects(profile)), targets, (), wind, ()):
        ship = with_effects(profile, {one.tag: {}}, "put in to be tuned")
        typical = {f"{one.effect.kind}.{name}": one.effect.parameters[name].typical(size) for name in one.variant}
        near = (theta, {**theta, **typical})
        J, _ = tuned(ship, trials, replace(options, targets=(*targets, *one.names)), near)
        print(f"| {one.label} | {J:.0f} | {100.0 * (1.0 - J / J_base):z.1f} % |", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("profile")
    parser.add_argument("trials")
    parser.add_argument("--ar", type=float, default=0.5, help="half width of the box, as a share of each coefficient")
    parser.add_argument("--with-effects", default="", help="effects in every fit, comma-separated")
    given = parser.parse_args()
    print_gains(given.profile, given.trials, given.ar, [tag for tag in given.with_effects.split(",") if tag])
