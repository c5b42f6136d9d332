"""The trial that would tell rivals apart: of a list of feasible ones, that on which they differ most.

One that was sailed already is not among them: the rivals do equally well on it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...backends import STATES
from ...motions import Motion, as_trial
from ...objective import Objective, cases_of
from ...orders import Helmsman, Straight, TurningOrder, Weave, ZigzagOrder, run_manoeuvre
from ...trial import Trial
from ...units import DEG
from ..bench.workbench import Point, Workbench


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
    sailed: Callable[[Trial], bool]  # whether a trial has such rudder angles
    engine: Callable[[float], float] | None = None  # share of the revolutions from the share of the speed left


SLOWER, HALF = 0.9, 0.5
"""Share of the approach speed at which the engine is told to go slower, and share of the revolutions then."""


ANY = math.inf
"""A heading that does not matter; simulated from north."""

ALIKE = 0.2
"""Relative difference of rudder angles within which two are alike."""

LEAST = 2.0 * DEG
"""Rudder angle [rad] below which the rudder is amidships."""


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
            order = TurningOrder(angle * DEG, until=4.0 * math.pi)
            found.append(Feasible(words, order, heading * DEG, 1.0, long, partial(turned, angle=angle * DEG)))
    for angle in (10.0, 20.0):
        words = f"zigzag {angle:.0f}/{angle:.0f}"
        found.append(
            Feasible(
                words,
                ZigzagOrder(angle * DEG, angle * DEG, legs=6),
                ANY,
                1.0,
                long,
                partial(checked, angle=angle * DEG),
            )
        )
    words = "turning test, rudder 35 deg to starboard, at 70 % of the revolutions"
    found.append(Feasible(words, TurningOrder(35.0 * DEG), ANY, 0.7, long, partial(turned, angle=35.0 * DEG)))
    words = (
        "turning test, rudder 15 deg to starboard, the revolutions changed on the way: halved at once when a tenth"
        " of the speed is lost"
    )
    order, engine = TurningOrder(15.0 * DEG), _slower
    found.append(Feasible(words, order, ANY, 1.0, long, partial(turned, angle=15.0 * DEG), engine))
    for heading in (0.0, 180.0):
        words = f"straight run on heading {heading:.0f} deg"
        found.append(Feasible(words, Straight(), heading * DEG, 1.0, 12.0 * unit_time, straight))
    words = "rudder orders of changing size every two ship lengths"
    found.append(Feasible(words, Weave(2.0 * unit_time), ANY, 1.0, long, wove))
    return found


def _slower(left: float) -> float:
    return 1.0 if left > SLOWER else HALF


def _legs(trial: Trial) -> FloatArray:
    """The largest rudder angle of each stretch to one side [rad], small ones left out."""
    delta = trial.delta[np.isfinite(trial.delta)]
    away = delta[np.abs(delta) > max(LEAST, 0.1 * float(np.max(np.abs(delta), initial=0.0)))]
    if not len(away):
        return away
    stretches = np.split(away, np.flatnonzero(np.diff(np.sign(away))) + 1)
    return np.array([one[np.argmax(np.abs(one))] for one in stretches])


def turned(trial: Trial, angle: float) -> bool:
    """Whether the rudder was held to one side, about at an angle [rad]."""
    legs = _legs(trial)
    return len(legs) == 1 and abs(legs[0] - angle) < ALIKE * abs(angle)


def checked(trial: Trial, angle: float) -> bool:
    """Whether the rudder went from side to side, about by an angle [rad] each time."""
    legs = _legs(trial)
    return len(legs) > 1 and bool(np.all(np.abs(np.abs(legs) - angle) < ALIKE * angle))


def straight(trial: Trial) -> bool:
    """Whether the rudder stayed about amidships."""
    return bool(np.isfinite(trial.delta).any()) and not len(_legs(trial))


def wove(trial: Trial) -> bool:
    """Whether rudder angles to both sides were of changing size."""
    legs = np.abs(_legs(trial))
    return len(legs) > 2 and float(legs.min()) < (1.0 - 2.0 * ALIKE) * float(legs.max())


def holds(trials: Sequence[Trial], one: Feasible, n: float) -> bool:
    """Whether such a trial was sailed: by rudder angles, heading, and revolutions n [1/s] of the approach."""

    def alike(trial: Trial) -> bool:
        began = float(np.nanmedian(trial.n[: max(3, trial.n_samples // 20)]))
        ended = float(np.nanmedian(trial.n[-max(3, trial.n_samples // 5) :]))
        slowed = ended < (1.0 - 2.0 * ALIKE) * began
        off = abs(math.remainder(float(trial.psi[0]) - one.heading, 2.0 * math.pi)) if one.heading != ANY else 0.0
        as_fast = abs(began - one.share * n) < 0.5 * ALIKE * n
        return one.sailed(trial) and off < 0.25 * math.pi and as_fast and slowed == (one.engine is not None)

    return any(alike(trial) for trial in trials)


def suggest(bench: Workbench, rivals: Sequence[tuple[str, Point]]) -> Suggestion | None:
    """The trial on which the rivals (words, fitted point) differ most; None where the approach is not known, or all
    were sailed.

    Each keeps what it was fitted to; the predictions start from the same state.
    """
    profile = bench.model.profile
    if profile.approach is None or len(rivals) < 2:
        return None
    objective = Objective(dict(zip(STATES, bench.sigma, strict=True)), dict.fromkeys(STATES, 1.0))
    best: Suggestion | None = None
    feasible = menu(profile.L_pp / profile.approach.speed)
    for one in [one for one in feasible if not holds(bench.trials, one, profile.approach.n)]:
        motion = run_manoeuvre(
            profile,
            one.helmsman,
            heading=0.0 if one.heading == ANY else one.heading,
            n=one.share * profile.approach.n,
            longest=one.longest,
            step=1.0,
            engine=one.engine,
        )
        if motion.diverged:
            continue
        runs = [_predicted(bench, point, motion, objective) for _, point in rivals]
        distance, positions = min(_apart(a, b, bench.sigma) for i, a in enumerate(runs) for b in runs[:i])
        if np.isfinite(distance) and (best is None or distance > best.distance):
            best = Suggestion(one.words, tuple(label for label, _ in rivals), distance, positions)
    return best


def _apart(a: FloatArray, b: FloatArray, sigma: FloatArray) -> tuple[float, float]:
    """Distance of two motions (n_samples, 6) in deviations of the noise, and the largest of their positions [m];
    infinite where one of them ran away."""
    with np.errstate(over="ignore"):
        distance = np.sqrt(np.nansum(((a - b) / sigma) ** 2))
    return float(distance), float(np.nanmax(np.hypot(*(a - b)[:, :2].T)))


def _predicted(bench: Workbench, point: Point, motion: Motion, objective: Objective) -> FloatArray:
    problem = bench.problem_of(point.names, point.integrator).with_groups([frozenset()])
    cases = cases_of([as_trial(bench.model.profile, motion)], objective, problem.model.inputs, problem.model.draught)
    problem = problem.with_cases(cases)
    return np.asarray(problem.predictor(point.unit[:, None]).predict(cases).states[0, 0])
