"""Coverage of bands on generated ships with an effect that neither model nor room has, one line of JSON a case.

    python -m tools.band_coverage --out docs/bands.jsonl [--ships 50] [--seconds 300] [--leave-out] [--of fresh]

Ships, hidden effects and trials are those of ``tests.hidden``: targets drawn within 22 %, one typical effect of the
registry, an effect that no registry holds, or nothing.  Each ship is learnt from a few of her trials, in turn several
of both sides, starboard turns only, zigzags only, and what the paper tunes to; the others are predicted from their
logged inputs and compared with what perfect sensors would have logged.  A trial is inside where its rudder and its side
lie within those learnt from and its kind is among them, or is a turn between turns; outside else.  A run goes on with
what is missing in the file; ``--seconds`` are of processor time.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.errors import TrialError
from mmgtune.manoeuvres import turning_indices
from mmgtune.motions import motions, track_of
from mmgtune.options import PosteriorOptions
from mmgtune.particles import Particles
from mmgtune.posterior import posterior
from mmgtune.posterior.room import make_room
from mmgtune.predictor import PhysicsPredictor
from mmgtune.profile import ShipProfile, load_profile
from mmgtune.trial import Trial
from tests.hidden.cases import LADDER, TYPICAL, Case, null, single, unknown
from tests.hidden.plant import SILENT, simulate
from tests.hidden.unknown import UNKNOWN

DESIGNS = {
    "both sides": (
        ("turn_p10", "turn_m20", "zigzag_10"),
        ("turn_m10", "turn_p20"),
        ("turn_p35", "turn_m35", "turn_p40", "turn_m40"),
    ),
    "starboard turns": (("turn_p10", "turn_p35"), ("turn_p20",), ("turn_m10", "turn_m20", "turn_m35", "turn_p40")),
    "zigzags": (("zigzag_10", "zigzag_20"), (), ("turn_p20", "turn_m20", "turn_p35", "turn_m35")),
    "paper": (
        ("turn_p10", "turn_m20", "turn_p35", "turn_m40", "zigzag_10"),
        ("turn_m10", "turn_p20", "turn_m35", "zigzag_20"),
        (),
    ),
}
"""Trials learnt from, trials inside and trials outside their range."""

LEVEL = 0.9
"""Nominal coverage."""

N_PARTICLES = 200
FIRST, EVERY = 40, 20
"""Samples [s] that count: the order comes at 20 s."""

INDICES = ("advance", "transfer", "tactical_diameter")


def cases(of: str) -> Iterator[Case]:
    """A ship of her own for each effect: those of the registry in turn, then unknown ones, then a right model.

    of  "first", the ships that constants were chosen with; "fresh", ships drawn after that
    """
    for turn in [0] if of == "first" else range(1, 1000):
        seed = 100 * turn
        for tag in LADDER:
            yield single(tag, TYPICAL, seed := seed + 1)
        for k in range(turn % 3, len(UNKNOWN), 3):
            yield unknown(k, seed := seed + 1)
        yield null(seed + 1)


def scored(ship: PhysicsPredictor, before: PhysicsPredictor, trial: Trial) -> dict[str, Any]:
    """Coverage and widths of the bands of one trial whose motion is known."""
    at = np.arange(FIRST, trial.n_samples, EVERY)
    widths, covered, off = [], [], []
    indices: list[np.ndarray] = []
    truth = np.array(_indices(trial, ship.L_pp))
    for predictor in (ship, before):
        found = list(motions(predictor, [trial]))
        states = np.array([one.states[at] for one in found if not one.diverged])
        low, middle, high = np.quantile(states, [0.5 - 0.5 * LEVEL, 0.5, 0.5 + 0.5 * LEVEL], axis=0)
        covered.append(np.mean((trial.motion[at] >= low) & (trial.motion[at] <= high), axis=0))
        widths.append(high - low)
        off.append(np.abs(middle - trial.motion[at]))
        if trial.id.startswith("turn"):
            read = [_of_motion(one, ship.L_pp) for one in found[:100]]
            indices.append(np.nan_to_num(np.array(read), nan=np.inf))
    row = {
        "trial": trial.id,
        "covered": np.round(covered[0], 3).tolist(),
        "width_over_prior": np.round(np.median(widths[0] / np.maximum(widths[1], 1e-12), axis=0), 4).tolist(),
        "width_x_over_L": round(float(np.median(widths[0][:, 0]) / ship.L_pp), 4),
    }
    if indices:
        now, prior = (np.quantile(some, [0.05, 0.95], axis=0, method="nearest") / ship.L_pp for some in indices)
        inside = (truth / ship.L_pp >= now[0]) & (truth / ship.L_pp <= now[1])
        row["indices"] = {
            name: {
                "truth": round(float(truth[k] / ship.L_pp), 4),
                "low": _number(now[0, k]),
                "high": _number(now[1, k]),
                "prior_low": _number(prior[0, k]),
                "prior_high": _number(prior[1, k]),
                "covered": bool(inside[k]),
            }
            for k, name in enumerate(INDICES)
            if np.isfinite(truth[k])
        }
    return row


def _number(value: float) -> float | None:
    return round(float(value), 4) if np.isfinite(value) else None


def _indices(trial: Trial, L_pp: float) -> list[float]:
    if not trial.id.startswith("turn"):
        return [np.nan] * len(INDICES)
    found = turning_indices(track_of(trial), L_pp)
    return [np.nan if (value := getattr(found, name)) is None else value for name in INDICES]


def _of_motion(motion: Any, L_pp: float) -> list[float]:
    if motion.diverged:
        return [np.nan] * len(INDICES)
    try:
        found = turning_indices(motion.track(), L_pp)
    except TrialError:  # a particle that the rudder does not turn
        return [np.nan] * len(INDICES)
    return [np.nan if (value := getattr(found, name)) is None else value for name in INDICES]


def prior_of(profile: ShipProfile, options: PosteriorOptions) -> PhysicsPredictor:
    """Particles of the room alone."""
    room = make_room(profile, size=options.room, without=options.without)
    z = np.random.default_rng(2).standard_normal((len(room), N_PARTICLES))
    particles = Particles(room.profile, room.names, room.values(z), {})
    return particles.predictor(as_logged=True).drawn(N_PARTICLES, 1)


def study(case: Case, design: str, room: float, leave_out: bool) -> dict[str, Any]:
    """One ship learnt from the trials of one design."""
    began = time.process_time()
    profile = load_profile("suzaku")
    logged = {trial.id: trial for trial in simulate(case.ship, case.effects, case.seed, case.noise)}
    truth = {trial.id: trial for trial in simulate(case.ship, case.effects, case.seed, SILENT)}
    tune, inside, outside = DESIGNS[design]
    options = PosteriorOptions(
        particles=N_PARTICLES, room=room, without=tuple(t for t in case.effects if t in LADDER), leave_out=leave_out
    )
    started = time.process_time()
    found = posterior(profile, [logged[name] for name in tune], options)
    learnt = time.process_time() - started
    ship = found.particles.predictor(as_logged=True).drawn(N_PARTICLES, 1)
    before = prior_of(profile, options)
    return {
        "case": case.name,
        "design": design,
        "hidden": list(case.effects),
        "misfit": round(found.sized.misfit, 3),
        "temper": round(found.sized.temper, 2),
        "learnt": round(found.learnt, 1),
        "nonlinear": round(found.nonlinear, 2),
        "inside": [scored(ship, before, truth[name]) for name in inside],
        "outside": [scored(ship, before, truth[name]) for name in outside],
        "seconds_learning": round(learnt, 2),
        "seconds": round(time.process_time() - began, 2),
    }


def summary(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Coverage and widths over all rows, by place and by design."""
    found: dict[str, Any] = {"ships": len({row["case"] for row in rows}), "cases": len(rows), "nominal": LEVEL}
    for place in ("inside", "outside"):
        for design in ("all", *DESIGNS):
            trials = [t for row in rows if design in ("all", row["design"]) for t in row[place]]
            if not trials:
                continue
            indices = [one for t in trials for one in t.get("indices", {}).values()]
            narrow = [
                (one["high"] - one["low"]) / (one["prior_high"] - one["prior_low"])
                for one in indices
                if None not in (one["high"], one["low"], one["prior_high"], one["prior_low"])
            ]
            found[f"{place}, {design}"] = {
                "trials": len(trials),
                "time_series": round(float(np.mean([t["covered"] for t in trials])), 3),
                "by_channel": np.round(np.mean([t["covered"] for t in trials], axis=0), 3).tolist(),
                "indices": round(float(np.mean([one["covered"] for one in indices])), 3) if indices else None,
                "n_indices": len(indices),
                "width_over_prior_series": round(float(np.median([t["width_over_prior"] for t in trials])), 3),
                "width_over_prior_indices": round(float(np.median(narrow)), 3) if narrow else None,
                "width_of_indices_L": round(
                    float(np.median([one["high"] - one["low"] for one in indices if one["high"] is not None])), 3
                )
                if indices
                else None,
            }
    return found


def main() -> None:
    """Run what is missing, and print the summary."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--ships", type=int, default=100)
    parser.add_argument("--of", choices=("first", "fresh"), default="fresh")
    parser.add_argument("--seconds", type=float, default=300.0, help="of processor time, then stop")
    parser.add_argument("--room", type=float, default=1.0)
    parser.add_argument("--leave-out", action="store_true")
    given = parser.parse_args()
    os.nice(3)
    rows = [json.loads(line) for line in given.out.read_text().splitlines()] if given.out.is_file() else []
    done = {(row["case"], row["design"]) for row in rows}
    for _, case in zip(range(given.ships), cases(given.of), strict=False):
        for design in DESIGNS:
            if (case.name, design) in done or time.process_time() > given.seconds:
                continue
            rows.append(study(case, design, given.room, given.leave_out))
            with given.out.open("a") as file:
                file.write(json.dumps(rows[-1]) + "\n")
    print(json.dumps(summary(rows), indent=1))


if __name__ == "__main__":
    main()
