"""Do bands shrink as ``mmgtune plan`` says?  One line of JSON a ship.

    python -m tools.plan_shrinkage --out docs/plan-shrinkage.jsonl [--ships 8] [--hidden 12] [--seconds 240]

Ships and trials are those of ``tests.hidden``: some with nothing hidden, then some with an effect that neither the
model nor its room has, as in ``band_coverage``.  Each is learnt from her turns with 10 and 35 deg to
starboard, and asked for the tactical diameter to port.  The trial that tells most, one in the middle and the one that
tells least, of those that the plant sails, are then sailed by the plant with noise, all is learnt anew from three
trials, and the band is compared with what was promised.  A run goes on with what is missing in the file.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from itertools import islice
from pathlib import Path
from typing import Any

from mmgtune.options import PlanOptions, PosteriorOptions, PredictOptions
from mmgtune.particles import Particles
from mmgtune.planning import plan_trial
from mmgtune.posterior import posterior
from mmgtune.predicting import predict
from mmgtune.profile import load_profile
from tests.hidden.cases import LADDER, TYPICAL, Case, null, single
from tests.hidden.plant import simulate

LEARNT = ("turn_p10", "turn_p35")
QUESTION = "tactical diameter, turn -35"
SAILED = {
    "turn_p20": "turn_p20",
    "turn_m10": "turn_m10",
    "turn_m20": "turn_m20",
    "turn_m35": "turn_m35",
    "zigzag_p10_10": "zigzag_10",
    "zigzag_p20_20": "zigzag_20",
    "turn_p10": "turn_p10",
    "turn_p35": "turn_p35",
}
"""Trials of a plan that the plant sails, by what she calls them."""

AGAIN = 1000
"""Added to the seed of the noise of what is sailed next."""


def study(case: Case) -> dict[str, Any]:
    """Promised and real half widths [m] of one ship."""
    began = time.process_time()
    profile = load_profile("suzaku")
    options = PosteriorOptions(leave_out=False, without=tuple(tag for tag in case.effects if tag in LADDER))
    first = {trial.id: trial for trial in simulate(case.ship, case.effects, case.seed, case.noise)}
    anew = {trial.id: trial for trial in simulate(case.ship, case.effects, case.seed + AGAIN, case.noise)}
    learnt = [first[name] for name in LEARNT]
    now = posterior(profile, learnt, options).particles
    plan = plan_trial(now, QUESTION, PlanOptions(half_speed=False, kind=("turn", "zigzag")))
    known = [one for one in plan.trials if one.id in SAILED]
    rows = []
    for one in (known[0], known[len(known) // 2], known[-1]):
        after = posterior(profile, [*learnt, anew[SAILED[one.id]]], options).particles
        rows.append({"trial": one.id, "promised": round(one.half, 2), "real": round(half(after), 2)})
    return {
        "ship": case.name,
        "hidden": list(case.effects),
        "now": round(plan.half, 2),
        "order": [one.id for one in plan.trials],
        "linear": round(plan.linear, 3),
        "sailed": rows,
        "seconds": round(time.process_time() - began, 1),
    }


def half(particles: Particles) -> float:
    """Half the width of the band [m] as ``mmgtune predict`` has it."""
    options = PredictOptions(turn=("-35",), particles=len(particles))
    (run,) = predict(particles.predictor(), options=options).runs
    found = run.index("tactical_diameter_m", 0.9).half
    return float("nan") if found is None else found


def main() -> None:
    """Run what is missing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--ships", type=int, default=8, help="with nothing hidden")
    parser.add_argument("--hidden", type=int, default=12, help="with a hidden effect")
    parser.add_argument("--seconds", type=float, default=240.0, help="of processor time, then stop")
    given = parser.parse_args()
    os.nice(3)
    done = {json.loads(line)["ship"] for line in given.out.read_text().splitlines()} if given.out.is_file() else set()
    hidden = (single(tag, TYPICAL, 1) for tag in LADDER)
    every = [*(null(seed) for seed in range(1001, 1001 + given.ships)), *islice(hidden, given.hidden)]
    for case in every:
        if case.name in done or time.process_time() > given.seconds:
            continue
        row = study(case)
        with given.out.open("a") as file:
            file.write(json.dumps(row) + "\n")
        print(json.dumps(row), flush=True)


if __name__ == "__main__":
    main()
