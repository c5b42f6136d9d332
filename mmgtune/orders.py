"""Standard manoeuvres given as orders: a helmsman, a steering gear and the model, stepped together.

The rudder depends on the motion here, so these runs cannot be prepared as inputs; they are single runs on NumPy.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .arrays import FloatArray
from .backends import LaneModel
from .backends.numpy_lanes import STILL
from .errors import OptionError, Problem
from .model import Model
from .physics.quantities import Control, State
from .profile import ShipProfile, SteeringGear
from .simulation import Motion

FINE = 0.01
"""Step of the integration, fourth-order Runge-Kutta, as a share of the time the ship takes for its own length."""

LONGEST_STEP = 0.25
"""Longest step [s]; it is also how often the helmsman looks at the compass."""


RUDDER_MOST, HEADING_MOST = 1.6, 2.0 * math.pi
"""Rudder angle and check heading [rad] beyond which degrees are meant."""


def in_radians(angle: float, name: str, most: float) -> None:
    """Raises OptionError where an angle [rad] is so large that it must be in degrees."""
    if not abs(angle) <= most:
        fix = f"write math.radians({angle:g}) if {angle:g} deg is meant"
        raise OptionError(Problem(f"the {name} is {angle:g} rad", "", "orders are in radians", fix))


class Helmsman(Protocol):
    """Turns time and heading into rudder orders; may remember what it has seen."""

    def order(self, t: float, heading: float) -> float:
        """Rudder ordered [rad] at time t [s] and heading off the approach course [rad]."""
        ...

    def finished(self, heading: float) -> bool:
        """Whether the manoeuvre is complete."""
        ...


@dataclass
class TurningOrder:
    """One rudder angle [rad], starboard positive, from time ``at`` [s] until the heading changed by ``until`` [rad]."""

    angle: float
    at: float = 20.0
    until: float = math.radians(540.0)

    def __post_init__(self) -> None:
        """Raises OptionError for an angle that must be degrees."""
        in_radians(self.angle, "rudder angle", RUDDER_MOST)

    def order(self, t: float, heading: float) -> float:
        """See ``Helmsman``."""
        return self.angle if t >= self.at else 0.0

    def finished(self, heading: float) -> bool:
        """See ``Helmsman``."""
        return abs(heading) >= self.until


@dataclass
class ZigzagOrder:
    """Rudder [rad] put over to the other side whenever the heading passes ``heading`` [rad]; ``legs`` orders in all."""

    rudder: float
    heading: float
    at: float = 20.0
    legs: int = 5
    _side: float = 0.0
    _given: int = 0

    def __post_init__(self) -> None:
        """Raises OptionError for angles that must be degrees."""
        in_radians(self.rudder, "rudder angle", RUDDER_MOST)
        in_radians(self.heading, "check heading", HEADING_MOST)

    def order(self, t: float, heading: float) -> float:
        """See ``Helmsman``."""
        if self._given == 0 and t >= self.at:
            self._side, self._given = 1.0, 1
        elif self._given and heading * self._side * math.copysign(1.0, self.rudder) >= abs(self.heading):
            self._side, self._given = -self._side, self._given + 1
        return self._side * self.rudder

    def finished(self, heading: float) -> bool:
        """See ``Helmsman``."""
        return self._given > self.legs


def move_rudder(delta: float, ordered: float, gear: SteeringGear | None, dt: float) -> float:
    """Rudder angle [rad] after dt [s] of a gear with constant rate; at once where there is no gear."""
    if gear is None:
        return ordered
    goal = min(max(ordered, -gear.max_angle), gear.max_angle)
    return delta + min(max(goal - delta, -gear.rate * dt), gear.rate * dt)


def run_manoeuvre(
    ship: ShipProfile | Model,
    helmsman: Helmsman,
    *,
    id: str = "run",
    speed: float | None = None,
    n: float | None = None,
    heading: float = 0.0,
    longest: float = 1800.0,
    sample: float = 1.0,
    step: float | None = None,
    engine: Callable[[float], float] | None = None,
    theta: FloatArray | None = None,
) -> Motion:
    """Simulate a manoeuvre given as orders, sampled every ``sample`` seconds.

    speed    approach speed [m/s], the profile's where None
    n        propeller revolutions [1/s], the profile's where None
    heading  approach heading [rad]
    longest  time [s] after which the run ends in any case
    step     longest step of the integration and of the helmsman [s]; chosen from length and speed where None
    engine   revolutions as a share of ``n`` from the share of the approach speed left; constant where None
    theta    (n_rows, 1) coefficients, those of the profile where None
    Raises OptionError where the profile has no approach condition and none is given.
    """
    model = ship if isinstance(ship, Model) else Model(ship)
    profile = model.profile
    if (speed is None or n is None) and profile.approach is None:
        raise OptionError(
            Problem(
                "the approach condition is not known",
                str(profile.path or profile.id),
                "the profile has no [approach] section",
                "add one, or give speed and rpm",
            )
        )
    U_0 = speed if speed is not None else profile.approach.speed  # type: ignore[union-attr]
    n_0 = n if n is not None else profile.approach.n  # type: ignore[union-attr]
    if not (U_0 > 0.0 and math.isfinite(U_0)):
        raise OptionError(Problem(f"the approach speed is {U_0:g} m/s", "speed", fix="give a speed above 0"))
    ship_now = LaneModel(model, model.matrix() if theta is None else theta)
    start = State(*np.array([[0.0], [0.0], [heading], [U_0], [0.0], [0.0]]))
    delta, revolutions = 0.0, n_0
    logged = Control(np.array([n_0]), np.array([0.0]))
    chain = ship_now.moved([logged], [logged], None, np.zeros(1))
    state = np.array([*start, *ship_now.lag_start(start, chain[-1])])

    def shown() -> FloatArray:
        """The six states as the sensors show them."""
        return np.array(ship_now.sensed(State(*state[:6])))[:, 0]

    longest_step = step or min(LONGEST_STEP, FINE * model.L_pp / U_0)
    steps = max(1, math.ceil(sample / longest_step - 1e-9))
    h = sample / steps
    rows: list[FloatArray] = [shown()]
    controls = [(revolutions, delta)]
    diverged = False
    for i in range(round(longest / sample)):
        for k in range(steps):
            t = i * sample + k * h
            seen = shown()
            delta = move_rudder(delta, helmsman.order(t, float(seen[2] - heading)), profile.steering_gear, h)
            if engine is not None:
                revolutions = n_0 * engine(math.hypot(state[3, 0], state[4, 0]) / U_0)
            before = chain
            with np.errstate(all="ignore"):
                reached = Control(np.array([revolutions]), np.array([delta]))
                chain = ship_now.moved(before, [reached], before, np.array([h]))
                state = _rk4(ship_now, state, before[-1], chain[-1], h)
        rows.append(shown())
        controls.append((revolutions, delta))
        diverged = not bool(np.isfinite(state).all())
        if diverged or helmsman.finished(float(rows[-1][2] - heading)):
            break
    times: FloatArray = sample * np.arange(len(rows), dtype=np.float64)
    inputs = np.array(controls)
    if ship_now.shift is not None:
        inputs = np.column_stack([np.interp(times - ship_now.shift, times, column) for column in inputs.T])
    return Motion(id, times, np.vstack(rows), inputs, diverged)


def _rk4(ship: LaneModel, state: FloatArray, now: Control, then: Control, h: float) -> FloatArray:
    """One step of the classical Runge-Kutta method, inputs linear over the step."""

    def rate(f: float, s: FloatArray) -> FloatArray:
        control = Control(*(a + f * (b - a) for a, b in zip(now, then, strict=True)))
        return ship.rates(s, control, STILL, h)

    k1 = rate(0.0, state)
    k2 = rate(0.5, state + 0.5 * h * k1)
    k3 = rate(0.5, state + 0.5 * h * k2)
    k4 = rate(1.0, state + h * k3)
    return np.asarray(state + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4))
