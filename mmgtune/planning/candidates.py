"""Trials that can be sailed, and a ship's log of each before it is sailed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ..arrays import FloatArray
from ..inputs import INPUTS
from ..model import Model
from ..motions import as_trial
from ..options.planning import KINDS
from ..orders import Helmsman, Sailing, SpiralOrder, Straight, TurningOrder, Weave, ZigzagOrder, run_manoeuvres
from ..predicting.asked import Approach
from ..profile import ShipProfile
from ..simulating import turn_name, zigzag_name
from ..stated_indices import no_reverse
from ..trial import Trial
from ..trial.schema import MOTION
from ..units import DEG

TURNS = (10.0, 20.0, 35.0)
ZIGZAGS = (10.0, 20.0)
LARGEST_SPIRAL = 25.0 * DEG

LONGEST = 45.0
"""Times the ship takes for her own length after which a trial ends in any case."""

HOLD = 5.0
"""The same that a step of the spiral is kept."""

SHORT = 12.0
"""The same that a straight run lasts."""

SAMPLE = 0.1
"""The same between samples; never above a second."""


@dataclass(frozen=True)
class Candidate:
    """A trial that can be sailed.

    approach  speed and revolutions before the order
    longest   time after which it ends in any case [s]
    astern    whether the propeller is reversed from the start, and the trial over where the ship has no way left
    """

    id: str
    kind: str
    words: str
    helmsman: Helmsman
    approach: Approach
    longest: float
    astern: bool = False

    def sailing(self, L_pp: float) -> Sailing:
        """What is simulated."""
        sample = min(1.0, SAMPLE * L_pp / self.approach.speed)
        return Sailing(
            self.helmsman,
            self.id,
            self.approach.speed,
            self.approach.n,
            longest=self.longest,
            sample=sample,
            step=sample,
            telegraph=(lambda _: -self.approach.n) if self.astern else None,
            until_stopped=self.astern,
        )


def logs(profile: ShipProfile, asked: Sequence[Candidate], noise: FloatArray) -> list[Trial | None]:
    """What a profile's log of each would be, with the deviations (6,) of its sensors; None where it diverges."""
    deviations = dict(zip(MOTION, noise.tolist(), strict=True))
    motions = run_manoeuvres(profile, [one.sailing(profile.L_pp) for one in asked])
    return [None if motion.diverged else replace(as_trial(profile, motion), noise=deviations) for motion in motions]


def candidates(profile: ShipProfile, approach: Approach, kinds: Sequence[str], half: bool) -> list[Candidate]:
    """Trials of these kinds, of all where there are none, that the steering gear and the equations reach.

    half  also turns and zigzags at half the approach speed, with half the revolutions
    """
    wanted = kinds or KINDS
    slow = Approach(0.5 * approach.speed, 0.5 * approach.n)
    found = [*_turning(profile, approach, "")] + ([*_turning(profile, slow, " at half speed")] if half else [])
    return [one for one in [*found, *_others(profile, approach)] if one.kind in wanted]


def _turning(profile: ShipProfile, approach: Approach, at: str) -> Iterator[Candidate]:
    unit = profile.L_pp / approach.speed
    suffix = "_half" if at else ""
    for size in TURNS:
        for angle in (size * DEG, -size * DEG):
            if not _reached(profile, angle):
                continue
            turn = TurningOrder(angle, at=0.5 * unit)
            words = f"turn, {size:.0f} deg to {_side(angle)}{at}"
            yield Candidate(turn_name(angle) + suffix, "turn", words, turn, approach, LONGEST * unit)
    for size in ZIGZAGS:
        for angle in (size * DEG, -size * DEG):
            if not _reached(profile, angle) or not _reached(profile, -angle):
                continue
            zigzag = ZigzagOrder(angle, abs(angle), at=0.5 * unit)
            words = f"zigzag {size:.0f}/{size:.0f}, {_side(angle)} first{at}"
            name = zigzag_name(math.copysign(size, angle), size) + suffix
            yield Candidate(name, "zigzag", words, zigzag, approach, LONGEST * unit)


def _others(profile: ShipProfile, approach: Approach) -> Iterator[Candidate]:
    unit = profile.L_pp / approach.speed
    most = min(LARGEST_SPIRAL, _most(profile))
    for side in (most, -most):
        spiral = SpiralOrder(side, HOLD * unit, at=0.5 * unit)
        words = f"spiral from {most / DEG:.0f} deg to {_side(side)}"
        name = f"spiral_{'p' if side > 0.0 else 'm'}{most / DEG:.0f}"
        yield Candidate(name, "spiral", words, spiral, approach, 1.1 * 9.0 * HOLD * unit)
    if no_reverse(profile) is None:
        yield Candidate("stop", "stop", "crash stop", Straight(), approach, LONGEST * unit, astern=True)
    yield Candidate("straight", "straight", "straight run", Straight(), approach, SHORT * unit)
    if _reached(profile, 25.0 * DEG) and _reached(profile, -25.0 * DEG):
        words = "rudder orders of changing size every two ship lengths"
        yield Candidate("weave", "weave", words, Weave(2.0 * unit), approach, 30.0 * unit)


def _limits(profile: ShipProfile) -> list[tuple[float, float]]:
    gears = [profile.actuator(name) for name in Model(profile).inputs if INPUTS[name].role == "rudder"]
    return [(gear.low, gear.high) for gear in gears if gear]


def _reached(profile: ShipProfile, angle: float) -> bool:
    return all(low - 1e-9 <= angle <= high + 1e-9 for low, high in _limits(profile))


def _most(profile: ShipProfile) -> float:
    """Largest rudder angle to both sides [rad]."""
    return min([LARGEST_SPIRAL, *(min(-low, high) for low, high in _limits(profile))])


def _side(angle: float) -> str:
    return "starboard" if angle > 0.0 else "port"
