"""The trial that would tell rivals apart: of a list of feasible ones, that on which they differ most."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

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


class Feasible(NamedTuple):
    """A trial that can be sailed."""

    words: str
    helmsman: Helmsman
    heading: float  # at the approach [rad]
    share: float  # of the approach revolutions
    longest: float  # [s]
    engine: Callable[[float], float] | None = None  # share of the revolutions from the share of the speed left


SLOWER, HALF = 0.9, 0.5
"""Share of the approach speed at which the engine is told to go slower, and share of the revolutions then."""


def menu(unit_time: float) -> list[Feasible]:
    """Feasible trials.

    unit_time  time the ship takes for her own length [s]
    """
    found: list[Feasible] = []
    long = 30.0 * unit_time
    for heading in (0.0, 90.0):
        for angle in (35.0, -35.0, 15.0):
            side = "starboard" if angle > 0.0 else "port"
            words = f"turning test, rudder {abs(angle):.0f} deg to {side}, approach heading {heading:.0f} deg"
            found.append(Feasible(words, TurningOrder(angle * DEG, until=4.0 * math.pi), heading * DEG, 1.0, long))
    for angle in (10.0, 20.0):
        words = f"zigzag {angle:.0f}/{angle:.0f}"
        found.append(Feasible(words, ZigzagOrder(angle * DEG, angle * DEG, legs=6), 0.0, 1.0, long))
    words = "turning test, rudder 35 deg to starboard, at 70 % of the revolutions"
    found.append(Feasible(words, TurningOrder(35.0 * DEG), 0.0, 0.7, long))
    words = (
        "turning test, rudder 15 deg to starboard, the revolutions changed on the way: halved at once when a tenth"
        " of the speed is lost"
    )
    found.append(Feasible(words, TurningOrder(15.0 * DEG), 0.0, 1.0, long, lambda left: 1.0 if left > SLOWER else HALF))
    for heading in (0.0, 180.0):
        words = f"straight run on heading {heading:.0f} deg"
        found.append(Feasible(words, Straight(), heading * DEG, 1.0, 12.0 * unit_time))
    words = "rudder orders of changing size every two ship lengths"
    found.append(Feasible(words, Weave(2.0 * unit_time), 0.0, 1.0, long))
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
    for one in menu(profile.L_pp / profile.approach.speed):
        motion = run_manoeuvre(
            profile,
            one.helmsman,
            heading=one.heading,
            n=one.share * profile.approach.n,
            longest=one.longest,
            step=1.0,
            engine=one.engine,
        )
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
            best = Suggestion(one.words, tuple(label for label, _ in rivals), distance, positions)
    return best


def _predicted(bench: Workbench, point: Point, motion: Motion, objective: Objective) -> FloatArray:
    problem = bench.problem_of(point.names, point.integrator).with_groups([frozenset()])
    cases = cases_of([as_trial(bench.model.profile, motion)], objective, problem.model.inputs, problem.model.draught)
    problem = problem.with_cases(cases)
    return np.asarray(problem.predictor(point.unit[:, None]).predict(cases).states[0, 0])
