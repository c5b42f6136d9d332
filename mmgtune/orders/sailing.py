"""A manoeuvre to be simulated, and the watch that is kept on it: orders step by step, and the log."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass
from numbers import Rational
from types import NoneType

import numpy as np

from ..arrays import FloatArray, numbers_of
from ..errors import OptionError, Problem, brief, kind_of, must_be_a, reason
from ..inputs import Role
from ..limits import MANOEUVRE_STEPS, TRIAL_SAMPLES
from ..model import Model
from ..motions import Motion
from ..profile import ShipProfile
from .helmsmen import Helmsman, is_number, positive

FINE = 0.01
"""Step of the integration, fourth-order Runge-Kutta, as a share of the time the ship takes for its own length."""

LONGEST_STEP = 0.25
"""Longest step [s]; it is also how often the helmsman looks at the compass."""

ACTUATORS: tuple[Role, ...] = ("rudder", "propeller", "thruster")
"""What orders are given to, in the order in which a watch gives them."""


def sample_of(L_pp: float, speed: float) -> float:
    """Time between samples [s] of a simulated manoeuvre: ten per ship length travelled, one a second at least.

    L_pp [m], speed [m/s].  Models are quicker than ships.
    """
    return min(1.0, round(L_pp / speed / 10.0, 1) or 0.1)


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
    telegraph      revolutions [1/s] ordered by the time [s], in the place of ``n``; constant where None
    until_stopped  whether the run ends once the ship makes no way ahead
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
    telegraph: Callable[[float], float] | None = None
    until_stopped: bool = False

    def __post_init__(self) -> None:
        """Raises OptionError for a helmsman that cannot steer, such as a bare angle, and for numbers that are none."""
        lacking = [name for name in ("order", "finished") if not callable(getattr(self.helmsman, name, None))]
        if lacking:
            what = f"{kind_of(self.helmsman)} is no helmsman"
            why = f"it has no {' and no '.join(lacking)}: how the rudder is moved is not known"
            fix = "give orders, such as TurningOrder(radians(35)) or ZigzagOrder(radians(10))"
            raise OptionError(Problem(what, "helmsman", why, fix))
        must_be_a(self.id, str, "id")
        for name in _TAKES:
            _require_function(name, getattr(self, name))
        positive(longest=self.longest, sample=self.sample, **({} if self.step is None else {"step": self.step}))
        TRIAL_SAMPLES.require(self.longest / self.sample, "longest", OptionError)
        if not (self.speed is None or is_number(self.speed, above=0.0)):
            what = f"the approach speed is {brief(self.speed)}"
            raise OptionError(Problem(what, "speed", "it is in m/s", "give a number above 0"))
        if not (self.n is None or is_number(self.n)):
            what = f"the revolutions are {brief(self.n)}"
            raise OptionError(Problem(what, "n", "they are in 1/s", "give a number: rpm / 60"))
        if not is_number(self.heading):
            what = f"the approach heading is {brief(self.heading)}"
            raise OptionError(Problem(what, "heading", "it is in radians", "write math.radians(90.0) for 90 deg"))
        for name in ("speed", "n", "heading", "longest", "sample", "step"):
            if isinstance(given := getattr(self, name), Rational):
                object.__setattr__(self, name, float(given))

    def helmsman_of_its_own(self) -> Helmsman:
        """A copy of the helmsman, who may remember what he has seen, for one simulation."""
        return copy(self.helmsman)

    def approach(self, profile: ShipProfile) -> tuple[float, float]:
        """Speed [m/s] and revolutions [1/s] of the approach.  Raises OptionError where they are not known."""
        U_0 = self.speed if self.speed is not None else profile.require_approach().speed
        n_0 = self.n if self.n is not None else profile.require_approach().n
        if not U_0 > 0.0:
            raise OptionError(Problem(f"the approach speed is {U_0:g} m/s", "speed", fix="give a speed above 0"))
        return U_0, n_0


_TAKES = {
    "engine": ("the share of the approach speed left", "the revolutions as a share of n", "lambda share: 1.0"),
    "telegraph": ("the time [s]", "revolutions [1/s]", "lambda t: 1.7 if t < 60.0 else 0.0"),
}
"""What each function of a sailing takes and returns, and how one is written."""


def _require_function(name: str, given: object) -> None:
    """Raises OptionError for what cannot be called with one number; None is no function at all."""
    must_be_a(given, (Callable, NoneType), name)  # type: ignore[arg-type]
    if given is None:
        return
    takes, returns, example = _TAKES[name]
    try:
        inspect.signature(given).bind(0.0)  # type: ignore[arg-type]
    except TypeError as error:
        why, fix = f"it is given one number, {takes}, and returns {returns}", f"write {name}={example}"
        raise OptionError(Problem(f"{name} cannot be called: {reason(error)}", name, why, fix)) from error
    except ValueError:  # functions in C that do not say what they take
        return


def _number(name: str, function: Callable[[float], float], at: float) -> float:
    """What a function of a sailing returns.  Raises OptionError where it is no finite number."""
    found = function(at)
    number = found if isinstance(found, float) else numbers_of(found)
    if number is not None and np.ndim(number) == 0 and math.isfinite(number):
        return float(number)
    takes, returns, example = _TAKES[name]
    what = f"{name} returns {brief(found)} for {at:g}"
    raise OptionError(Problem(what, name, f"it is given {takes} and returns {returns}", f"write {name}={example}"))


class Watch:
    """One manoeuvre on its way: orders given step by step, and the log."""

    def __init__(self, sailing: Sailing, model: Model):
        self.sailing = sailing
        self.helmsman = sailing.helmsman_of_its_own()
        self.U_0, self.n_0 = sailing.approach(model.profile)
        longest = sailing.step or min(LONGEST_STEP, FINE * model.L_pp / self.U_0)
        self.steps = max(1, math.ceil(sailing.sample / longest - 1e-9))
        self.h = sailing.sample / self.steps
        MANOEUVRE_STEPS.require(sailing.longest / self.h, "step", OptionError)
        self.samples = round(sailing.longest / sailing.sample)
        self.over = self.samples < 1
        self.diverged = False
        self.late: list[float | None] = []  # how late the log of each input is [s]
        self.states: list[FloatArray] = []
        self.controls: list[FloatArray] = []

    def orders(self, step: int, shown: FloatArray, state: FloatArray) -> tuple[float, ...]:
        """What is ordered at a step, by ``ACTUATORS``; nothing new once the manoeuvre is over."""
        sailing = self.sailing
        if self.over:
            return 0.0, self.n_0, 0.0
        sample, k = divmod(step, self.steps)
        t = sample * sailing.sample + k * self.h
        rudder = self.helmsman.order(t, float(shown[2]) - sailing.heading)
        n, share = self.n_0, 1.0
        if sailing.telegraph is not None:
            n = _number("telegraph", sailing.telegraph, t)
        if sailing.engine is not None:
            share = _number("engine", sailing.engine, math.hypot(state[3], state[4]) / self.U_0)
        return rudder, n * share, 0.0

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
        done = self.helmsman.finished(float(self.states[-1][2] - self.sailing.heading))
        done = done or (self.sailing.until_stopped and self.states[-1][3] <= 0.0)
        self.over = self.diverged or done or len(self.states) > self.samples

    def motion(self, model: Model) -> Motion:
        """What was logged."""
        times: FloatArray = self.sailing.sample * np.arange(len(self.states), dtype=np.float64)
        logged = np.array(self.controls)
        for k, late in enumerate(self.late):
            if late is not None:
                logged[:, k] = np.interp(times - late, times, logged[:, k])
        return Motion(self.sailing.id, times, np.vstack(self.states), logged, self.diverged, model.inputs)
