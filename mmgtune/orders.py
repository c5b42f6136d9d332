"""Standard manoeuvres given as orders: a helmsman, a steering gear and the model, stepped together.

The rudder depends on the motion here, so these runs cannot be prepared as inputs; they march side by side on NumPy.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from .arrays import FloatArray
from .backends import LaneModel
from .backends.cases import Integrator
from .errors import OptionError, Problem
from .given import ShipGiven, ship_of
from .inputs import Role
from .model import Model
from .physics.quantities import UNKNOWN, State
from .profile import ShipProfile
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


@dataclass(frozen=True, eq=False)
class Sailing:
    """A manoeuvre to be simulated: who steers, from what approach, and for how long.

    speed    approach speed [m/s], the profile's where None
    n        propeller revolutions [1/s], the profile's where None
    heading  approach heading [rad]
    longest  time [s] after which the run ends in any case
    sample   time [s] between samples
    step     longest step of the integration and of the helmsman [s]; chosen from length and speed where None
    engine   revolutions as a share of ``n`` from the share of the approach speed left; constant where None
    """

    helmsman: Helmsman
    id: str = "run"
    speed: float | None = None
    n: float | None = None
    heading: float = 0.0
    longest: float = 1800.0
    sample: float = 1.0
    step: float | None = None
    engine: Callable[[float], float] | None = None

    def approach(self, profile: ShipProfile) -> tuple[float, float]:
        """Speed [m/s] and revolutions [1/s] of the approach.  Raises OptionError where they are not known."""
        if (self.speed is None or self.n is None) and profile.approach is None:
            raise OptionError(
                Problem(
                    "the approach condition is not known",
                    str(profile.path or profile.id),
                    "the profile has no [approach] section",
                    "add one, or give speed and rpm",
                )
            )
        U_0 = self.speed if self.speed is not None else profile.approach.speed  # type: ignore[union-attr]
        n_0 = self.n if self.n is not None else profile.approach.n  # type: ignore[union-attr]
        if not (U_0 > 0.0 and math.isfinite(U_0)):
            raise OptionError(Problem(f"the approach speed is {U_0:g} m/s", "speed", fix="give a speed above 0"))
        return U_0, n_0


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

    ship   object, path or bundled name
    theta  (n_rows, 1) coefficients, those of the profile where None
    The others are those of a ``Sailing``; see ``run_manoeuvres``, which raises what this raises.
    """
    sailing = Sailing(helmsman, id, speed, n, heading, longest, sample, step, engine)
    return run_manoeuvres(ship, [sailing], theta=theta)[0]


def run_manoeuvres(
    ship: ShipGiven | Model, sailings: Sequence[Sailing], *, theta: FloatArray | None = None
) -> list[Motion]:
    """Simulate manoeuvres given as orders, side by side, each with a helmsman and steps of its own.

    The order goes to every rudder, the revolutions to every propeller, each moved by its actuator in the profile;
    thrusters rest.

    ship   object, path or bundled name
    theta  (n_rows, n_sailings) coefficients, those of the profile where None
    Raises OptionError where the profile has no approach condition and none is given.
    """
    if not sailings:
        return []
    model = ship if isinstance(ship, Model) else Model(ship_of(ship))
    if theta is None:
        theta = np.repeat(model.matrix()[:, :1], len(sailings), axis=1)
    watches = [_Watch(sailing, model) for sailing in sailings]
    fleet = _Fleet(model, theta, watches)
    while fleet.under_way:
        fleet.step()
    return [watch.motion(model) for watch in watches]


class _Fleet:
    """Manoeuvres side by side, a lane to each; lanes that are over are left behind once they are half of all.

    driven  (n_inputs, n_lanes) what drives the ships now
    """

    def __init__(self, model: Model, theta: FloatArray, watches: list[_Watch]):
        self.model, self.theta, self.watches = model, theta, watches
        self.inputs = model.arrangement.inputs
        self.actuators = [model.profile.actuator(one.name) for one in self.inputs]
        self.h = np.array([one.h for one in watches])
        self.driven = np.array([[w.n_0 if one.role == "propeller" else 0.0 for w in watches] for one in self.inputs])
        self.steps = 0
        ship = LaneModel(model, theta[:, self._lanes])
        start = np.array([[0.0, 0.0, one.sailing.heading, one.U_0, 0.0, 0.0] for one in watches]).T
        self.run = ship.under_way(State(*start[:, self._lanes]), self._control())
        for k, shown in enumerate(self._shown()):
            watches[k].log(shown, self.driven[:, k])
            watches[k].late = [None if late is None else float(np.atleast_1d(late)[k]) for late in ship.late_log]

    @property
    def under_way(self) -> bool:
        """Whether any manoeuvre is not over."""
        return any(not watch.over for watch in self.watches)

    def step(self) -> None:
        """March by one step, each lane by its own, and log what is due."""
        seen = zip(self.watches, self._shown(), self._states(), strict=True)
        orders = np.array([watch.orders(self.steps, shown, state) for watch, shown, state in seen]).T
        for place, (one, actuator) in enumerate(zip(self.inputs, self.actuators, strict=True)):
            order = orders[ROLES.index(one.role)]
            self.driven[place] = actuator.moved(self.driven[place], order, self.h) if actuator else order
        with np.errstate(all="ignore"):
            self.run.step(self._control(), UNKNOWN, self.h[self._lanes], RK4)
        self.steps += 1
        due = [k for k, watch in enumerate(self.watches) if watch.due(self.steps)]
        if due:
            shown, states = self._shown(), self._states()
            for k in due:
                self.watches[k].log(shown[k], self.driven[:, k])
                self.watches[k].look(bool(np.isfinite(states[k]).all()))
            self._leave_behind()

    def _leave_behind(self) -> None:
        kept = [k for k, watch in enumerate(self.watches) if not watch.over]
        if 0 < 2 * len(kept) <= len(self.watches):
            self.watches = [self.watches[k] for k in kept]
            self.theta, self.h, self.driven = self.theta[:, kept], self.h[kept], self.driven[:, kept]
            self.run.keep(LaneModel(self.model, self.theta[:, self._lanes]), kept if len(kept) > 1 else kept[0])

    @property
    def _lanes(self) -> Any:
        # A lane alone is plain numbers, which NumPy is several times as quick with.
        return 0 if len(self.watches) == 1 else slice(None)

    def _control(self) -> Any:
        return self.model.arrangement.control(*(np.array(values)[self._lanes] for values in self.driven))

    def _shown(self) -> FloatArray:
        """(n_lanes, 6) what the sensors show."""
        return np.atleast_2d(np.array(self.run.shown).T)

    def _states(self) -> FloatArray:
        """(n_lanes, n_states)."""
        return np.atleast_2d(self.run.s.T)


ROLES: tuple[Role, ...] = ("rudder", "propeller", "thruster")
"""What orders are given to, in the order in which a watch gives them."""


class _Watch:
    """One manoeuvre on its way: orders given step by step, and the log."""

    def __init__(self, sailing: Sailing, model: Model):
        self.sailing = sailing
        self.U_0, self.n_0 = sailing.approach(model.profile)
        longest = sailing.step or min(LONGEST_STEP, FINE * model.L_pp / self.U_0)
        self.steps = max(1, math.ceil(sailing.sample / longest - 1e-9))
        self.h = sailing.sample / self.steps
        self.samples = round(sailing.longest / sailing.sample)
        self.over = self.samples < 1
        self.diverged = False
        self.late: list[float | None] = []  # how late the log of each input is [s]
        self.states: list[FloatArray] = []
        self.controls: list[FloatArray] = []

    def orders(self, step: int, shown: FloatArray, state: FloatArray) -> tuple[float, ...]:
        """What is ordered at a step, by ``ROLES``; nothing new once the manoeuvre is over."""
        sailing = self.sailing
        if self.over:
            return 0.0, self.n_0, 0.0
        sample, k = divmod(step, self.steps)
        rudder = sailing.helmsman.order(sample * sailing.sample + k * self.h, float(shown[2]) - sailing.heading)
        share = 1.0 if sailing.engine is None else sailing.engine(math.hypot(state[3], state[4]) / self.U_0)
        return rudder, self.n_0 * share, 0.0

    def due(self, step: int) -> bool:
        """Whether a sample is to be taken after so many steps."""
        return not self.over and step % self.steps == 0

    def log(self, shown: FloatArray, driven: FloatArray) -> None:
        """Take a sample."""
        self.states.append(shown)
        self.controls.append(driven.copy())

    def look(self, sound: bool) -> None:
        """Whether the manoeuvre is over with this sample."""
        self.diverged = not sound
        done = self.sailing.helmsman.finished(float(self.states[-1][2] - self.sailing.heading))
        self.over = self.diverged or done or len(self.states) > self.samples

    def motion(self, model: Model) -> Motion:
        """What was logged."""
        times: FloatArray = self.sailing.sample * np.arange(len(self.states), dtype=np.float64)
        logged = np.array(self.controls)
        for k, late in enumerate(self.late):
            if late is not None:
                logged[:, k] = np.interp(times - late, times, logged[:, k])
        return Motion(self.sailing.id, times, np.vstack(self.states), logged, self.diverged, model.inputs)
