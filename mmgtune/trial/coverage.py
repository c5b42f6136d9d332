"""What trials visit and what they do not: sides, rudder angles, speeds, astern.

What a fit, a diagnosis or a simulation says of the ship holds where measurements were; this says where that is.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..arrays import FloatArray
from ..effects import Visited
from ..units import DEG

SLOW = 0.2
"""Speed below which drift and r L / U are not asked for, as a share of the largest: near rest they may be anything."""

HARDLY_MEASURED = 0.1
"""Share of its samples from which a channel counts as measured."""

TURN = 5.0
"""Time [s] either way over which the yaw rate is taken from headings where no rate was measured."""

AT_REST = 0.02
"""Speed that is hardly any, as a share of the largest."""

ONE_SIDE, HARDLY = 0.25, 0.1
"""A side is visited where the rudder goes to it by more than the first share of what it goes to the other, and turning
by more than the second: a steady turn at full rudder is far beyond any weave, and a weave tells of both sides."""

LEAST_RUDDER = 2.0 * DEG
"""Rudder angle [rad] to a side that is no more than keeping a course."""

BEYOND = 0.15
"""What is asked for may exceed what was visited by this share of it."""

SLACK = 1.0 * DEG
"""The same of rudder angles [rad], for gears that miss their angle."""


SIDES = ("port", "starboard")


class Sailed(Protocol):
    """A trial, or the track of a simulated run: columns (n_samples,) in SI units."""

    @property
    def t(self) -> FloatArray: ...
    @property
    def psi(self) -> FloatArray: ...
    @property
    def u(self) -> FloatArray: ...
    @property
    def v_m(self) -> FloatArray: ...
    @property
    def r(self) -> FloatArray | None: ...
    @property
    def n(self) -> FloatArray | None: ...
    @property
    def delta(self) -> FloatArray: ...


def visited_by(trials: Iterable[Sailed], L_pp: float) -> Visited:
    """What trials visit, sample by sample.  L_pp [m]."""
    trials = list(trials)
    rows = [_samples(trial, L_pp) for trial in trials]
    columns: FloatArray = np.concatenate(rows) if rows else np.zeros((0, 7))
    seconds, rudder, speed, ahead, rate, drift, shaft = columns.T
    return Visited(seconds, rudder, speed, ahead, rate, drift, shaft, _antenna_of(trials))


def _antenna_of(trials: Sequence[Sailed]) -> tuple[float, float]:
    """Where the positions of all trials were moved to midship from; zeros where they were not, or from several."""
    found = {getattr(trial, "antenna", None) for trial in trials}
    common = found.pop() if len(found) == 1 else None
    return common or (0.0, 0.0)


def _samples(trial: Sailed, L_pp: float) -> FloatArray:
    """(n_samples, 7) the fields of ``Visited``."""
    if not len(trial.t):
        return np.zeros((0, 7))
    unknown = np.full(len(trial.t), np.nan)
    n = unknown if trial.n is None else trial.n
    u, v_m = _measured(trial.u), _measured(trial.v_m)
    r = unknown if trial.r is None else _measured(trial.r)
    if np.isnan(r).all():
        r = _slope(trial.psi, trial.t)
    step = np.diff(trial.t)
    seconds = np.concatenate([step[:1], step]) if len(step) else np.zeros(len(trial.t))
    seconds = np.minimum(seconds, 2.0 * float(np.median(seconds)))  # a pause of the log is no time spent anywhere
    speed = np.hypot(u, 0.0 if np.isnan(v_m).all() else v_m)  # sway hardly counts where it was never measured
    fastest = float(np.max(speed[np.isfinite(speed)], initial=0.0))
    under_way = speed > max(SLOW * fastest, 1e-9)
    rate = np.where(under_way, r * L_pp / np.where(under_way, speed, 1.0), np.nan)
    drift = np.where(under_way, np.arctan2(-v_m, u), np.nan)
    return np.column_stack([seconds, trial.delta, speed, u, rate, drift, n])


def _measured(values: FloatArray) -> FloatArray:
    """A channel, or NaN throughout where it has hardly a sample: one at the beginning says where a run starts alone."""
    known = np.count_nonzero(np.isfinite(values))
    return values if known > HARDLY_MEASURED * len(values) else np.full(len(values), np.nan)


def _slope(values: FloatArray, t: FloatArray) -> FloatArray:
    """(n_samples,) rates of a channel over ``TURN`` seconds either way, where noise hardly shows; NaN at the ends."""
    half = max(1, round(TURN / max(float(np.median(np.diff(t))), 1e-9))) if len(t) > 1 else 1
    found = np.full(len(t), np.nan)
    if len(t) > 2 * half:
        found[half:-half] = (values[2 * half :] - values[: -2 * half]) / (t[2 * half :] - t[: -2 * half])
    return found


def _to(side: str, pair: tuple[float, float]) -> float:
    """How far a range (to port, to starboard) goes to a side; 0 where it does not, or nothing is known."""
    low, high = pair
    return max(0.0, -low if side == "port" else high)


@dataclass(frozen=True)
class Coverage:
    """The range of what trials visit, each beyond which no more than a few seconds are spent.

    rudder    (to port, to starboard) [rad]: least and largest angle
    rate      least and largest r L / U [-], positive to starboard
    drift     least and largest drift angle [rad]
    speed     least and largest speed over ground [m/s]
    ahead     least and largest u [m/s]
    """

    rudder: tuple[float, float]
    rate: tuple[float, float]
    drift: tuple[float, float]
    speed: tuple[float, float]
    ahead: tuple[float, float]

    @classmethod
    def of(cls, trials: Iterable[Sailed], L_pp: float) -> Coverage:
        """What trials cover; NaN where a channel was never measured, and without trials.  L_pp [m]."""
        seen = visited_by(trials, L_pp)
        return cls(*(seen.span(getattr(seen, name)) for name in ("rudder", "rate", "drift", "speed", "ahead")))

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Coverage | None:
        """From ``to_dict``; None where it is not one."""
        try:
            unknown = (float("nan"), float("nan"))
            rudder, drift = (
                (float(low) * DEG, float(high) * DEG)
                for low, high in (data["rudder_deg"], data.get("drift_deg", unknown))
            )
            rate, speed, ahead = (
                (float(low), float(high)) for low, high in (data["yaw_rate"], data["speed_m_per_s"], data["u_m_per_s"])
            )
        except (KeyError, TypeError, ValueError):
            return None
        return cls(rudder, rate, drift, speed, ahead)

    def to_dict(self) -> dict[str, Any]:
        """For JSON and profiles, rounded to what can be told: angles in degrees; empty where nothing is known."""
        if not np.isfinite([*self.rudder, *self.rate, *self.speed, *self.ahead]).all():
            return {}

        def rounded(pair: tuple[float, float], digits: int, factor: float = 1.0) -> list[float]:
            return [round(factor * value, digits) + 0.0 for value in pair]

        return {
            "rudder_deg": rounded(self.rudder, 1, 1.0 / DEG),
            "yaw_rate": rounded(self.rate, 3),
            **({"drift_deg": rounded(self.drift, 1, 1.0 / DEG)} if np.isfinite(self.drift).all() else {}),
            "speed_m_per_s": rounded(self.speed, 3),
            "u_m_per_s": rounded(self.ahead, 3),
            "sides": list(self.sides),
            "astern": self.astern,
        }

    @property
    def sides(self) -> tuple[str, ...]:
        """Sides she turned to under rudder: "port", "starboard", both, or none."""
        found = []
        for side, other in (SIDES, SIDES[::-1]):
            rudder, rate = _to(side, self.rudder), _to(side, self.rate)
            if rudder > max(LEAST_RUDDER, ONE_SIDE * _to(other, self.rudder)) and rate > HARDLY * _to(other, self.rate):
                found.append(side)
        return tuple(found)

    @property
    def turns(self) -> str:
        """The sides she turned to under rudder, in words."""
        if len(self.sides) == 1:
            return f"turns to {self.sides[0]} only"
        return "turns to both sides" if self.sides else "no turn"

    def most_rate(self, side: str) -> float:
        """The largest r L / U [-] to a side, "port" or "starboard"; 0 where there was none."""
        return _to(side, self.rate)

    def hardly_turns(self, side: str) -> bool:
        """Whether a side she did not turn to counts as that though the rudder went there: a weave about a turn does."""
        return side not in self.sides and _to(side, self.rate) > 0.0 and _to(side, self.rudder) > LEAST_RUDDER

    @property
    def unseen_side(self) -> str:
        """The side she never turned to while she did to the other; "" where there is none."""
        if len(self.sides) != 1:
            return ""
        return "starboard" if self.sides[0] == "port" else "port"

    @property
    def astern(self) -> bool:
        """Whether she went astern."""
        return self.ahead[0] < -AT_REST * max(abs(self.ahead[1]), abs(self.ahead[0]))

    @property
    def sentence(self) -> str:
        """What was visited, in words."""
        if not self.to_dict():
            return "What the trials visit cannot be told: a channel was never measured."
        low, high = (value / DEG for value in self.rudder)
        rudder = f"rudder from {_side(low)} to {_side(high)}"
        astern = "also astern" if self.astern else "never astern"
        return (
            f"The trials visit: {rudder}, {self.turns}, speeds of {self.speed[0]:.3g} to {self.speed[1]:.3g} m/s, "
            f"{astern}."
        )

    def unvisited_by(self, other: Coverage) -> list[str]:
        """What another run goes to and these trials do not, in words; empty where they visit all of it."""
        if not (self.to_dict() and other.to_dict()):
            return []
        found = []
        for side in SIDES:
            asked, known = _to(side, other.rudder), _to(side, self.rudder)
            if asked > LEAST_RUDDER and asked > (1.0 + BEYOND) * known + SLACK:
                turns = (
                    f"no turn to {side}"
                    if side == self.unseen_side
                    else f"rudder to {side} up to {known / DEG:.0f} deg"
                )
                found.append(f"rudder of {asked / DEG:.0f} deg to {side}: they hold {turns}")
        slow, fast = self.speed
        if other.speed[1] > (1.0 + BEYOND) * fast:
            found.append(f"a speed of {other.speed[1]:.3g} m/s: theirs goes up to {fast:.3g} m/s")
        if other.speed[1] < (1.0 - BEYOND) * slow:
            found.append(f"speeds up to {other.speed[1]:.3g} m/s alone: theirs begins at {slow:.3g} m/s")
        if other.astern and not self.astern:
            found.append("going astern: they never do")
        return found


def _side(degrees: float) -> str:
    """A rudder angle with its side."""
    if abs(degrees) < 0.5:
        return "0 deg"
    return f"{abs(degrees):.0f} deg to {'starboard' if degrees > 0.0 else 'port'}"


BY_SIDE: Sequence[tuple[str, str]] = (
    ("rudder.gamma_Rp", "rudder.gamma_Rn"),
    ("wake.C_2p", "wake.C_2n"),
)
"""Coefficients that act on one side of the flow each: where it comes from port (starboard turns), from starboard."""
