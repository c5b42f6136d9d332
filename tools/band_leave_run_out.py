"""Bands on measured runs: each, or a part of them, left out in turn and predicted from its logged inputs by the others.

    python -m tools.band_leave_run_out PROFILE TRIALS [--out FILE.json] [--folds 5] [--turn 35]

Prints a row a run: coverage of nominal 90 % bands by channel, and their width over that of the room alone.  ``--turn``
adds bands of advance and tactical diameter of turns of that rudder to both sides, from all runs and from the room
alone.  Trials that were cut from one run are left out together.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.arrays import FloatArray
from mmgtune.backends import get_backend
from mmgtune.manoeuvres.on_lanes import LaneRecord, turning
from mmgtune.options import PosteriorOptions
from mmgtune.posterior import posterior
from mmgtune.predictor import PhysicsPredictor
from mmgtune.profile import load_profile
from mmgtune.steering import APPROACH, Orders, steer
from mmgtune.trial import load_trials

from .band_coverage import prior_of, scored


def turns(ship: PhysicsPredictor, degrees: float) -> dict[str, list[float | None]]:
    """5, 50 and 95 % of advance and tactical diameter over L, of turns from the approach; None where never reached."""
    approach = ship.model.profile.approach
    assert approach is not None  # of the profiles this is for
    assert approach.n is not None
    n = ship.n_members
    full = np.full(n, 1.0)
    orders = Orders(
        approach.speed * full,
        approach.n * full,
        np.radians(degrees) * full,
        np.inf * full,
        np.ones(n, dtype=np.int64),
        np.radians(200.0) * full,
        approach.n * full,
    )
    found = steer(ship.model, ship.theta, orders, get_backend("compiled"))
    record = LaneRecord(found.h, found.states, found.end, found.orders, APPROACH, np.sign(degrees) * full)
    values: dict[str, FloatArray] = turning(record)
    quantiles = {}
    for name in ("advance", "tactical_diameter"):
        some = np.nan_to_num(values[name] / ship.L_pp, nan=np.inf)
        quantiles[name] = [
            round(float(q), 3) if np.isfinite(q) else None
            for q in np.quantile(some, [0.05, 0.5, 0.95], method="nearest")
        ]
    return quantiles


def main() -> None:
    """One posterior for each run left out, and one of all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("profile")
    parser.add_argument("trials")
    parser.add_argument("--out", type=Path)
    parser.add_argument("--quick", action="store_true", help="no kinds and sides left out within what is learnt from")
    parser.add_argument("--without", default="", help="effects to leave no room for, with commas between")
    parser.add_argument("--folds", type=int, default=0, help="parts of the runs left out together; 0: each by itself")
    parser.add_argument("--turn", type=float, default=35.0, help="rudder of the turns [deg], 0: none")
    given = parser.parse_args()
    profile = load_profile(given.profile)
    trials = list(load_trials(given.trials).trials.values())
    options = PosteriorOptions(
        particles=200, leave_out=not given.quick, without=tuple(filter(None, given.without.split(",")))
    )
    before = prior_of(profile, options)
    rows: list[dict[str, Any]] = []
    runs = list(dict.fromkeys(trial.run for trial in trials))
    n_folds = given.folds or len(runs)
    for fold in range(n_folds):
        began = time.process_time()
        left = [trial for trial in trials if trial.run in runs[fold::n_folds]]
        found = posterior(profile, [trial for trial in trials if trial not in left], options)
        ship = found.particles.predictor(as_logged=True).drawn(200, 1)
        for trial in left:
            row = scored(ship, before, trial)
            rows.append({**row, "misfit": round(found.sized.misfit, 2), "temper": round(found.sized.temper, 1)})
            print(
                f"{trial.id:34s} misfit {found.sized.misfit:6.2f} temper {found.sized.temper:7.1f} covered",
                row["covered"],
                "width/prior",
                row["width_over_prior"],
                f"{time.process_time() - began:.1f} s",
                flush=True,
            )
    whole = posterior(profile, trials, options)
    ship = whole.particles.predictor().drawn(200, 1)
    table: dict[str, Any] = {"runs": rows, "sentences": whole.sentences(), "turns": {}}
    for side in (1.0, -1.0) if given.turn else ():
        for name, of in (("posterior", ship), ("room", before)):
            key = f"{name}, {'starboard' if side > 0 else 'port'} {given.turn:g} deg"
            table["turns"][key] = turns(of, side * given.turn)
            print(key, table["turns"][key])
    table["covered"] = round(float(np.mean([row["covered"] for row in rows])), 3)
    print("covered", table["covered"], *whole.sentences(), sep="\n")
    if given.out:
        given.out.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
