"""The trial that would tell rivals apart: of a list of feasible ones, that on which they differ most."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends import STATES
from ..objective import Objective, cases_of
from ..orders import Helmsman, Straight, TurningOrder, Weave, ZigzagOrder, run_manoeuvre
from ..simulation import Motion, as_trial
from ..units import DEG
from .workbench import Point, Workbench


@dataclass(frozen=True)
class Suggestion:
    """A trial and how far it would separate the rivals.

    distance   root of the sum of squared differences between the rivals' predictions, in deviations of the noise
    positions  largest difference of position [m]
    """

    manoeuvre: str
    rivals: tuple[str, ...]
    distance: float
    positions: float

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "manoeuvre": self.manoeuvre,
            "separates": list(self.rivals),
            "distance_in_noise_deviations": self.distance,
            "largest_position_difference_m": self.positions,
        }


def menu(unit_time: float) -> list[tuple[str, Helmsman, float, float, float]]:
    """Feasible trials: words, helmsman, heading [rad], share of the approach revolutions, length [s].

    unit_time  time the ship takes for her own length [s]
    """
    found: list[tuple[str, Helmsman, float, float, float]] = []
    for heading in (0.0, 90.0):
        for angle in (35.0, -35.0, 15.0):
            side = "starboard" if angle > 0.0 else "port"
            words = f"turning test, rudder {abs(angle):.0f} deg to {side}, approach heading {heading:.0f} deg"
            found.append((words, TurningOrder(angle * DEG, until=4.0 * math.pi), heading * DEG, 1.0, 30.0 * unit_time))
    for angle in (10.0, 20.0):
        words = f"zigzag {angle:.0f}/{angle:.0f}"
        found.append((words, ZigzagOrder(angle * DEG, angle * DEG, legs=6), 0.0, 1.0, 30.0 * unit_time))
    words = "turning test, rudder 35 deg to starboard, at 70 % of the revolutions"
    found.append((words, TurningOrder(35.0 * DEG), 0.0, 0.7, 30.0 * unit_time))
    for heading in (0.0, 180.0):
        found.append((f"straight run on heading {heading:.0f} deg", Straight(), heading * DEG, 1.0, 12.0 * unit_time))
    words = "rudder orders of changing size every two ship lengths"
    found.append((words, Weave(2.0 * unit_time), 0.0, 1.0, 30.0 * unit_time))
    return found


def suggest(bench: Workbench, rivals: Sequence[tuple[str, Point]]) -> Suggestion | None:
    """The trial on which the rivals (words, fitted point) differ most; None where the approach is not known.

    Each keeps what it was fitted to; the predictions start from the same state.
    """
    profile = bench.model.profile
    if profile.approach is None or len(rivals) < 2:
        return None
    objective = Objective(dict(zip(STATES, bench.sigma, strict=True)), dict.fromkeys(STATES, 1.0))
    best: Suggestion | None = None
    for words, helmsman, heading, share, longest in menu(profile.L_pp / profile.approach.speed):
        n = share * profile.approach.n
        motion = run_manoeuvre(profile, helmsman, heading=heading, n=n, longest=longest, step=1.0)
        if motion.diverged:
            continue
        runs = [_predicted(bench, point, motion, objective) for _, point in rivals]
        apart = [
            (float(np.sqrt(np.nansum(((a - b) / bench.sigma) ** 2))), float(np.nanmax(np.hypot(*(a - b)[:, :2].T))))
            for i, a in enumerate(runs)
            for b in runs[:i]
        ]
        distance, positions = min(apart)
        if np.isfinite(distance) and (best is None or distance > best.distance):
            best = Suggestion(words, tuple(label for label, _ in rivals), distance, positions)
    return best


def _predicted(bench: Workbench, point: Point, motion: Motion, objective: Objective) -> FloatArray:
    problem = bench.problem_of(point.names, point.integrator).with_groups([frozenset()])
    cases = cases_of([as_trial(bench.model.profile, motion)], objective, problem.model.inputs, problem.model.draught)
    problem = problem.with_cases(cases)
    return np.asarray(problem.predictor(point.unit[:, None]).predict(cases).states[0, 0])
