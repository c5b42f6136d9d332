"""The trial that would tell rivals apart: of a list of feasible ones, that on which they differ most, each tuned anew
to it as far as what was sailed leaves open.

One that was sailed already is not among them: the rivals do equally well on it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...backends import STATES
from ...motions import as_trial
from ...objective import Objective
from ...orders import Helmsman, Sailing, Straight, TurningOrder, Weave, ZigzagOrder, run_manoeuvres
from ...trial import Trial
from ...units import DEG
from ..bench.workbench import Point, Workbench
from ..held_out.unseen import problem_on
from ..signatures.intervals import covariance

TELLS = 5.0
"""Distance in deviations of the noise from which a trial would tell rivals apart."""


@dataclass(frozen=True)
class Suggestion:
    """What would separate the rivals: a trial and how far it would, and what to measure.

    manoeuvre  the best of the trials that were tried; "" where there is none
    distance   root of the sum of squared differences that no rival can take up, in deviations of the noise
    positions  largest such difference of position [m]
    tried      how many trials
    measures   what to measure that tells a rival from all else, by its tag
    """

    manoeuvre: str
    rivals: tuple[str, ...]
    distance: float
    positions: float
    tried: int
    measures: Mapping[str, str] = field(default_factory=dict)

    @property
    def trial_tells(self) -> bool:
        """Whether the manoeuvre would tell."""
        return bool(self.manoeuvre) and self.distance >= TELLS

    def sentence(self) -> str:
        """What would tell, in words."""
        measures = " or ".join(f"{words} ({tag})" for tag, words in self.measures.items())
        if self.trial_tells:
            beside = f" So would, without a trial: {measures}." if measures else ""
            return f"A trial that would tell: {self.manoeuvre}.{beside}"
        tried = f"None of {self.tried} trials that were tried would tell" if self.tried else ""
        told = f"What would tell: {measures}" if measures else ""
        return "".join(f"{words}. " for words in (tried, told) if words).rstrip()

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "manoeuvre": self.manoeuvre,
            "separates": list(self.rivals),
            "distance_in_noise_deviations": self.distance,
            "largest_position_difference_m": self.positions,
            "trial_tells": self.trial_tells,
            "trials_tried": self.tried,
            "measures": dict(self.measures),
            "in_words": self.sentence(),
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

    def sailing(self, n: float) -> Sailing:
        """How it is simulated, with revolutions n [1/s] of the approach."""
        heading = 0.0 if self.heading == ANY else self.heading
        return Sailing(
            self.helmsman, n=self.share * n, heading=heading, longest=self.longest, step=1.0, engine=self.engine
        )


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
    words = "straight run at 50 % of the revolutions, until the speed is steady"
    found.append(Feasible(words, Straight(), ANY, 0.5, long, straight))
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
    """What would tell which of the rivals (tag, fitted point) it is; None where nothing is known that would.

    The predictions start from the same state, known to the noise of the sensors.  Without an approach, or where all
    trials were sailed, measurements are left.
    """
    profile = bench.model.profile
    if len(rivals) < 2:
        return None
    effects = {effect.tag: effect for effect in bench.model.effects}
    measures = {tag: effects[tag].told_by for tag, _ in rivals if tag in effects and effects[tag].told_by}
    best = Suggestion("", tuple(tag for tag, _ in rivals), 0.0, 0.0, 0, measures)
    if profile.approach is None:
        return best if measures else None
    objective = Objective(dict(zip(STATES, bench.sigma, strict=True)), dict.fromkeys(STATES, 1.0))
    fitted = [_Fitted.of(bench, point) for _, point in rivals]
    feasible = menu(profile.L_pp / profile.approach.speed)
    asked = [one for one in feasible if not holds(bench.trials, one, profile.approach.n)]
    for one, motion in zip(
        asked, run_manoeuvres(profile, [one.sailing(profile.approach.n) for one in asked]), strict=True
    ):
        if motion.diverged:
            continue
        trial = as_trial(profile, motion)
        runs = [rival.on(bench, trial, objective) for rival in fitted]
        distance, positions = min(apart(a, b, bench.sigma) for a in runs for b in runs if a is not b)
        if np.isfinite(distance) and distance > best.distance:
            best = replace(best, manoeuvre=one.words, distance=distance, positions=positions)
    return replace(best, tried=len(asked)) if best.manoeuvre or measures else None


class Foretold(NamedTuple):
    """What a fitted point foretells of a trial, in deviations of the noise.

    states   (n_rows,) by sample and channel
    channel  (n_rows,) which of the states a row is, and of which sample
    sample   (n_rows,)
    spread   (n_rows, k) by how much the point may be otherwise: columns of a root of the covariance
    """

    states: FloatArray
    channel: IntArray
    sample: IntArray
    spread: FloatArray


@dataclass(frozen=True, eq=False)
class _Fitted:
    """A fitted point, and a root (n_names, n_names) of the covariance of what is free in it, in the unit cube."""

    point: Point
    names: tuple[str, ...]
    root: FloatArray

    @classmethod
    def of(cls, bench: Workbench, point: Point) -> _Fitted:
        names, spread = covariance(bench, point, at_bounds=True)
        size, directions = np.linalg.eigh(spread)
        return cls(point, names, directions * np.sqrt(np.maximum(size, 0.0)))

    def on(self, bench: Workbench, trial: Trial, objective: Objective) -> Foretold:
        problem = problem_on(bench, self.point, [trial], objective).with_groups([frozenset()])
        states, slopes, by_offset = (one[0] for one in problem.jacobians(self.point.unit[:, None]))
        assert problem.sigma is not None  # problems on other trials estimate initial states
        moved = slopes[:, [self.point.names.index(name) for name in self.names]] @ self.root
        begun = by_offset * problem.sigma[0]  # the first sample is known to its noise
        sample, channel = np.nonzero(problem.cases.weight[0] > 0.0)
        return Foretold(states, channel, sample, np.hstack([moved, begun]))


def apart(true: Foretold, other: Foretold, sigma: FloatArray) -> tuple[float, float]:
    """How far what is true would be from what another rival makes of it, and the largest difference of positions [m];
    infinite where one of them ran away.

    The other is tuned anew to the trial, as far as the trials that it was fitted to leave open: with its spread A the
    difference d counts d' (1 + A A')^-1 d, in deviations of the noise.
    """
    d, A = true.states - other.states, other.spread
    if not (np.isfinite(d).all() and np.isfinite(A).all()):
        return math.inf, math.inf
    with np.errstate(over="ignore"):
        left = d - A @ np.linalg.solve(np.eye(A.shape[1]) + A.T @ A, A.T @ d)
        distance = np.sqrt(max(float(d @ left), 0.0))
    x, y = (np.zeros(int(other.sample.max(initial=0)) + 1) for _ in range(2))
    for name, of in (("x", x), ("y", y)):
        rows = other.channel == STATES.index(name)
        of[other.sample[rows]] = left[rows] * sigma[STATES.index(name)]
    return float(distance), float(np.hypot(x, y).max())
