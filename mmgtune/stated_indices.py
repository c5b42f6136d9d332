"""Trials of which only indices are known against a model: steered by her own helmsman, and read.

All trials and all candidates march as lanes of one call; see ``steering``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arrays import FloatArray
from .backends import get_backend
from .circumstances import without_reverse
from .components.propeller import ASTERN
from .errors import OptionError, Problem
from .manoeuvres.on_lanes import LaneRecord, stopping, turning, zigzag
from .model import Model
from .predictor import PhysicsPredictor, Predictor
from .profile import ShipProfile
from .steering import APPROACH, Orders, steer
from .trial import IndexTrial
from .trial.index_trial import INDICES, SMALLER, shown_index
from .units import DEG

UNREACHED = 1e3
"""Residual of an index that the model never reaches, in tolerances: finite, and far beyond any that it reaches."""

LANES = 1024
"""Lanes marched at one time; bounds the memory."""

NO_REVERSE = "its equations end where the propeller is reversed"

TURNED = 5.0 * DEG
"""How far a turn goes on beyond the last heading that is needed."""

NEEDED = {"time_90": 90.0, "speed_ratio_90": 90.0, "advance": 90.0, "transfer": 90.0, "initial_turning_distance": 10.0}
NEEDED |= {"tactical_diameter": 180.0, "time_180": 180.0, "speed_ratio_180": 180.0, "time_270": 270.0}
NEEDED |= {"time_360": 360.0, "speed_ratio_360": 360.0}
"""Change of heading an index needs [deg]; steady values need a turn and a half."""


@dataclass(frozen=True)
class IndexComparison:
    """One index of one trial: stated and simulated [SI], with its tolerance.

    simulated  None where the model does not reach it
    """

    trial: str
    role: str
    name: str
    stated: float
    tolerance: float
    assumed: bool
    simulated: Mapping[str, float | None]

    def off(self, which: str) -> float:
        """Simulated less stated, in tolerances."""
        value = self.simulated[which]
        return UNREACHED if value is None else (value - self.stated) / self.tolerance

    def to_dict(self, L_pp: float) -> dict[str, Any]:
        """For JSON, in the units people read: ship lengths, degrees."""

        def shown(value: float | None) -> float | None:
            return None if value is None else shown_index(self.name, value, L_pp)[0]

        return {
            "trial": self.trial,
            "role": self.role,
            "index": self.name,
            "words": INDICES[self.name].words,
            "unit": shown_index(self.name, 1.0, L_pp)[1],
            "stated": shown(self.stated),
            "tolerance": shown(self.tolerance),
            "assumed_tolerance": self.assumed,
            **{which: shown(value) for which, value in self.simulated.items()},
            "off": {which: None if value is None else self.off(which) for which, value in self.simulated.items()},
        }


def no_reverse(profile: ShipProfile, where: str = "", instead: str = "", why: str = NO_REVERSE) -> Problem | None:
    """What is wrong with revolutions astern of a ship; None where her equations have them."""
    propeller = without_reverse(profile)
    if propeller is None:
        return None
    what = f"the propeller '{propeller}' of '{profile.id}' has no revolutions astern"
    fix = f"take a profile with the propeller {', '.join(map(repr, ASTERN))}, or {instead}"
    return Problem(what, where, why, fix)


def possible(profile: ShipProfile, trials: Sequence[IndexTrial]) -> None:
    """Raises OptionError for what the ship cannot be asked for: all of it at once."""
    problems = []
    for one in trials:
        where = f"{one.path or one.id}, trial '{one.id}'"
        if profile.approach is None and (one.approach_speed is None or one.n is None):
            what = "the approach condition is not known"
            fix = "give approach_speed and n, or add [approach] to the profile"
            problems.append(Problem(what, where, f"profile '{profile.id}' has no [approach]", fix))
        gear = next((profile.actuator(i.name) for i in profile.arrangement.inputs if i.role == "rudder"), None)
        if gear is not None and not gear.low - 1e-9 <= one.rudder <= gear.high + 1e-9:
            problems.append(
                Problem(
                    f"the order is {one.rudder / DEG:.3g} deg of rudder",
                    where,
                    f"the rudder of '{profile.id}' goes from {gear.low / DEG:.3g} to {gear.high / DEG:.3g} deg",
                    "correct the order, or the limits of the profile",
                )
            )
        why, instead = "a stop is simulated with the propeller going astern", "leave the trial out"
        if one.astern is not None and (problem := no_reverse(profile, where, instead, why)):
            problems.append(problem)
        values = one.stated(profile.L_pp)
        for less, more in SMALLER:
            if less in values and more in values and values[less][0] >= values[more][0]:
                problems.append(Problem(f"{less} is not below {more}", where, "on no ship", "correct one"))
    if problems:
        raise OptionError(*problems)


def simulated(
    model: Model, theta: FloatArray, trials: Sequence[IndexTrial], backend: str = "compiled"
) -> list[FloatArray]:
    """The stated indices of each trial as candidates make them: (n_indices, n_candidates) each, SI, NaN if not reached.

    theta  (n_rows, n_candidates)
    """
    n_candidates = theta.shape[1]
    found = [np.empty((len(one.indices), n_candidates)) for one in trials]
    at_once = max(1, LANES // len(trials)) if trials else 1
    for first in range(0, n_candidates, at_once):
        part = slice(first, min(first + at_once, n_candidates))
        for into, values in zip(found, _march(model, theta[:, part], trials, backend), strict=True):
            into[:, part] = values
    return found


def residuals(model: Model, theta: FloatArray, trials: Sequence[IndexTrial], backend: str = "compiled") -> FloatArray:
    """Simulated less stated over the tolerance, (n_indices of all trials, n_candidates); see ``UNREACHED``."""
    rows = []
    for one, values in zip(trials, simulated(model, theta, trials, backend), strict=True):
        stated, tolerance = np.array(list(one.stated(model.L_pp).values())).T[:, :, None]
        rows.append(np.nan_to_num((values - stated) / tolerance, nan=UNREACHED, posinf=UNREACHED, neginf=-UNREACHED))
    return np.vstack(rows) if rows else np.zeros((0, theta.shape[1]))


def compare_stated(
    model: Model,
    thetas: Mapping[str, FloatArray],
    trials: Sequence[IndexTrial],
    roles: Mapping[str, str],
    backend: str = "compiled",
) -> list[IndexComparison]:
    """Every stated index beside what models make of it.

    thetas  (n_rows,) coefficients by what to call them, such as "before" and "after"
    roles   by trial: "tune", "test" or "other"
    """
    of = simulated(model, np.column_stack(list(thetas.values())), trials, backend)
    found = []
    for one, values in zip(trials, of, strict=True):
        for (name, (stated, tolerance)), row in zip(one.stated(model.L_pp).items(), values, strict=True):
            made = {which: float(v) if np.isfinite(v) else None for which, v in zip(thetas, row, strict=True)}
            assumed = one.indices[name].assumed
            found.append(IndexComparison(one.id, roles[one.id], name, stated, tolerance, assumed, made))
    return found


def physics_of(predictor: Predictor) -> PhysicsPredictor:
    """A predictor that can be steered on lanes.  Raises OptionError where it has no profile."""
    if not isinstance(predictor, PhysicsPredictor):
        what = f"'{predictor.name}' is no ship profile"
        raise OptionError(Problem(what, predictor.name, "trials given as indices are steered by a profile's gear"))
    return predictor


def _march(model: Model, theta: FloatArray, trials: Sequence[IndexTrial], backend: str) -> list[FloatArray]:
    n_candidates = theta.shape[1]

    def lanes(values: Sequence[Any]) -> Any:
        return np.repeat(np.array(values), n_candidates)

    speed = [one.approach_speed or model.profile.require_approach().speed for one in trials]
    n = [one.n or model.profile.require_approach().n for one in trials]
    checks = [np.inf if one.check is None else one.check for one in trials]
    astern = [n_0 if one.astern is None else one.astern for one, n_0 in zip(trials, n, strict=True)]
    orders = Orders(
        speed=lanes(speed),
        n=lanes(n),
        rudder=lanes([one.rudder for one in trials]),
        check=lanes(checks),
        legs=lanes([_legs(one) for one in trials]),
        until=lanes([_until(one) for one in trials]),
        revolutions=lanes(astern),
    )
    whole = steer(model, np.tile(theta, len(trials)), orders, get_backend(backend))
    found = []
    for k, one in enumerate(trials):
        at = slice(k * n_candidates, (k + 1) * n_candidates)
        record = LaneRecord(
            whole.h[at],
            whole.states[:, :, at],
            whole.end[at],
            whole.orders[:, at],
            APPROACH,
            np.where(orders.rudder[at] < 0.0, -1.0, 1.0),
        )
        with np.errstate(all="ignore"):
            values = (
                turning(record)
                if one.manoeuvre == "turning"
                else stopping(record)
                if one.manoeuvre == "stopping"
                else zigzag(record, orders.check[at])
            )
        never = np.full(n_candidates, np.nan)
        rows = np.array([values.get(name, never) for name in one.indices])
        rows[:, ~whole.sound[at]] = np.nan
        found.append(rows)
    return found


def _legs(one: IndexTrial) -> int:
    """Rudder orders until the last index of a zigzag is known; more than there will be for others."""
    if one.manoeuvre != "zigzag":
        return 1000
    known = {"overshoot_1": 2, "overshoot_2": 3, "overshoot_3": 4, "reach": 2, "period": 3}
    return max(known.get(name, 1) for name in one.indices)


def _until(one: IndexTrial) -> float:
    """Change of heading after which a turn is done [rad]."""
    if one.manoeuvre != "turning":
        return float("inf")
    return max(NEEDED.get(name, 540.0) for name in one.indices) * DEG + TURNED
