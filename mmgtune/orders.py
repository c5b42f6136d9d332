"""Standard manoeuvres given as orders: a helmsman, a steering gear and the model, stepped together.

The rudder depends on the motion here, so these runs cannot be prepared as inputs; they are single runs on NumPy.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from .arrays import FloatArray
from .backends import LaneModel
from .backends.cases import Integrator
from .errors import OptionError, Problem
from .given import ShipGiven, ship_of
from .model import Model
from .physics.quantities import UNKNOWN, State
from .simulation import Motion

FINE = 0.01
"""Step of the integration, fourth-order Runge-Kutta, as a share of the time the ship takes for its own length."""

LONGEST_STEP = 0.25
"""Longest step [s]; it is also how often the helmsman looks at the compass."""


RK4 = Integrator("rk4")
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


@dataclass
class SpiralOrder:
    """Dieudonne's spiral: rudder from one side to the other in ``steps``, each kept for ``hold`` [s].

    rudder  of the first and, to the other side, of the last step [rad]
    """

    rudder: float
    hold: float
    steps: int = 9
    at: float = 20.0
    _t: float = 0.0

    def order(self, t: float, heading: float) -> float:
        """See ``Helmsman``."""
        self._t = t
        k = min(math.floor((t - self.at) / self.hold), self.steps - 1)
        return 0.0 if t < self.at else self.rudder * (1.0 - 2.0 * k / (self.steps - 1))

    def finished(self, heading: float) -> bool:
        """See ``Helmsman``."""
        return self._t >= self.at + self.steps * self.hold


@dataclass
class Weave:
    """Rudder orders of changing size and sign every ``hold`` seconds: excites everything a little."""

    hold: float

    def order(self, t: float, heading: float) -> float:
        """See ``Helmsman``."""
        k = int(t // self.hold)
        return math.radians(25.0) * math.sin(2.4 * k) * (0.4 + 0.6 * math.cos(1.1 * k) ** 2)

    def finished(self, heading: float) -> bool:
        """See ``Helmsman``."""
        return False


@dataclass
class Straight:
    """Rudder amidships."""

    def order(self, t: float, heading: float) -> float:
        """See ``Helmsman``."""
        return 0.0

    def finished(self, heading: float) -> bool:
        """See ``Helmsman``."""
        return False


def run_manoeuvre(
    ship: ShipGiven | Model,
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

    The order goes to every rudder, the revolutions to every propeller, each moved by its actuator in the profile;
    thrusters rest.

    ship     object, path or bundled name
    speed    approach speed [m/s], the profile's where None
    n        propeller revolutions [1/s], the profile's where None
    heading  approach heading [rad]
    longest  time [s] after which the run ends in any case
    step     longest step of the integration and of the helmsman [s]; chosen from length and speed where None
    engine   revolutions as a share of ``n`` from the share of the approach speed left; constant where None
    theta    (n_rows, 1) coefficients, those of the profile where None
    Raises OptionError where the profile has no approach condition and none is given.
    """
    model = ship if isinstance(ship, Model) else Model(ship_of(ship))
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
    ship_now = LaneModel(model, (model.matrix() if theta is None else theta)[:, 0])
    start = State(*np.array([0.0, 0.0, heading, U_0, 0.0, 0.0]))
    inputs = model.arrangement.inputs
    actuators = [profile.actuator(one.name) for one in inputs]
    driven = [n_0 if one.role == "propeller" else 0.0 for one in inputs]

    def control() -> Any:
        return model.arrangement.control(*map(np.float64, driven))

    run = ship_now.under_way(start, control())
    longest_step = step or min(LONGEST_STEP, FINE * model.L_pp / U_0)
    steps = max(1, math.ceil(sample / longest_step - 1e-9))
    h = sample / steps
    rows: list[FloatArray] = [np.array(run.shown)]
    controls = [tuple(driven)]
    diverged = False
    for i in range(round(longest / sample)):
        for k in range(steps):
            t = i * sample + k * h
            seen = float(run.shown.psi)
            share = 1.0 if engine is None else engine(math.hypot(run.s[3], run.s[4]) / U_0)
            orders = {"rudder": helmsman.order(t, seen - heading), "propeller": n_0 * share, "thruster": 0.0}
            for place, (one, actuator) in enumerate(zip(inputs, actuators, strict=True)):
                order = orders[one.role]
                driven[place] = actuator.moved(driven[place], order, h) if actuator else order
            with np.errstate(all="ignore"):
                run.step(control(), UNKNOWN, h, RK4)
        rows.append(np.array(run.shown))
        controls.append(tuple(driven))
        diverged = not bool(np.isfinite(run.s).all())
        if diverged or helmsman.finished(float(rows[-1][2] - heading)):
            break
    times: FloatArray = sample * np.arange(len(rows), dtype=np.float64)
    logged = np.array(controls)
    for k, late in enumerate(ship_now.late_log):
        if late is not None:
            logged[:, k] = np.interp(times - late, times, logged[:, k])
    return Motion(id, times, np.vstack(rows), logged, diverged, model.inputs)
