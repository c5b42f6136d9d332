"""Gains of a heading controller judged in simulation, and whether that promises more than the true ship delivers.

Wakita, Akimoto and Maki, section 5.4: a proportional and derivative law brings the ship to another heading and keeps
her there; what counts is the integral of the absolute errors of heading and of yaw rate.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .arguments import ShipGiven, ship_of
from .arrays import FloatArray
from .displayed import Displayed
from .errors import OptionError, Problem
from .inputs import INPUTS
from .networks import named_ship
from .options.choice import must_be
from .options.studying import HeadingOptions
from .physics.actuation import actuated
from .physics.quantities import UNKNOWN
from .predictor import Fleet, Predictor, Uncertain, as_predictor
from .profile import Actuator, ShipProfile
from .run_files import HEADING_STUDY
from .units import DEG
from .writing_results import place_for, write_record

CLEARLY = 0.95
"""Share of the true score below which a promise is clearly too good."""


@dataclass(frozen=True, eq=False)
class Judged:
    """What a simulator makes of the gains.

    scores  (n_members, n_P, n_D) [rad s], infinite where a run left the world of ships
    """

    name: str
    method: str
    scores: FloatArray

    @property
    def views(self) -> dict[str, FloatArray]:
        """Scores (n_P, n_D) as a user of the simulator would read them: of one member, of their mean, of the worst."""
        if len(self.scores) == 1:
            return {"single": self.scores[0]}
        return {"single": self.scores[0], "mean": self.scores.mean(axis=0), "worst": self.scores.max(axis=0)}

    def to_dict(self, truth: FloatArray) -> dict[str, Any]:
        """For JSON, held against the true scores (n_P, n_D)."""
        each = [overrated(one, truth) for one in self.scores]
        return {
            "name": self.name,
            "method": self.method,
            "members": len(self.scores),
            "views": {
                name: {
                    "scores": _finite(scores),
                    "overrated": overrated(scores, truth),
                    "clearly_overrated": overrated(scores, CLEARLY * truth),
                }
                for name, scores in self.views.items()
            },
            "overrated_by_single_members": {
                "mean": float(np.mean(each)),
                "least": min(each),
                "most": max(each),
                "clearly": float(np.mean([overrated(one, CLEARLY * truth) for one in self.scores])),
            },
        }


@dataclass(frozen=True, eq=False)
class HeadingStudy(Displayed):
    """Scores of a grid of gains in the true system and in simulators.

    gains  (n,) both gains [deg of rudder per rad, and per rad/s]
    truth  (n, n) scores of the true system [rad s], proportional gain first
    """

    written_by = "write_heading_study"

    gains: FloatArray
    truth: FloatArray
    true_ship: str
    models: tuple[Judged, ...]
    options: HeadingOptions
    wall_s: float

    def __repr__(self) -> str:
        """In a line."""
        return f"HeadingStudy({len(self.gains)} x {len(self.gains)} gains, {len(self.models)} simulators)"

    def to_dict(self, command: str = "") -> dict[str, Any]:
        """For JSON."""
        return {
            "schema": 1,
            "kind": "heading-keeping",
            "truth": {"name": self.true_ship, "scores": _finite(self.truth)},
            "gains": self.gains.tolist(),
            "models": [one.to_dict(self.truth) for one in self.models],
            "options": self.options.to_dict(),
            "command": command,
            "wall_s": self.wall_s,
        }


Simulator = str | Path | Predictor
"""What is judged beside the true system."""


def study_heading_keeping(
    models: Simulator | Sequence[Simulator], truth: ShipGiven, options: HeadingOptions = HeadingOptions()
) -> HeadingStudy:
    """Judge every pair of gains in the true system and in each simulator.

    models  name or path of a profile or of trained networks, or a predictor; or several of these
    truth   profile of the true system; its actuators and propeller are those of the simulators too
    Raises OptionError for a truth without approach or actuators, and for a model that is driven otherwise or cannot be
    steered on lanes.
    """
    must_be(options, HeadingOptions)
    began = time.perf_counter()
    ship = ship_of(truth)
    several = list(models) if isinstance(models, Sequence) and not isinstance(models, str) else [models]
    known = [as_predictor(named_ship(one)) for one in several]
    for one in known:
        _agrees(one, ship)
    gains = options.gain_step * np.arange(1.0, int(options.gain_most / options.gain_step + 1e-9) + 1.0)
    true = kept(as_predictor(ship), ship, gains, options)[0]
    judged: list[Judged] = []
    for given, simulator in zip(several, (_many(one, options) for one in known), strict=True):
        taken = simulator.name in {ship.id, *(one.name for one in judged)}  # a tuned ship has the id of the true one
        name = str(given) if taken and isinstance(given, (str, Path)) else simulator.name
        judged.append(Judged(name, simulator.method, kept(simulator, ship, gains, options)))
    called = ship.id
    if isinstance(truth, (str, Path)) and ship.id in {one.name for one in judged}:  # it is not that simulator
        called = str(truth)
    return HeadingStudy(gains, true, called, tuple(judged), options, time.perf_counter() - began)


def kept(predictor: Predictor, ship: ShipProfile, gains: FloatArray, options: HeadingOptions) -> FloatArray:
    """Scores (n_members, n_P, n_D) [rad s] of all pairs of gains: eq. 32-33.

    ship  whose actuators follow the orders, at their rate, and whose propeller turns as in its approach

    Orders are given at every step from each member's own motion.
    """
    assert isinstance(predictor, Fleet)  # looked at before
    inputs = [INPUTS[name] for name in predictor.inputs]
    rudders = [k for k, one in enumerate(inputs) if one.role == "rudder"]
    gears = _gears(ship, [inputs[k].name for k in rudders])
    n = len(gains)
    P, D = (DEG * one.ravel() for one in np.meshgrid(gains, gains, indexing="ij"))
    members = predictor.n_members
    state = np.array([0.0, 0.0, 0.0, options.speed, 0.0, 0.0])
    low, high = max(one.low for one in gears), min(one.high for one in gears)
    rate = min(one.rate for one in gears)
    steps = max(1, round(options.duration / (predictor.own_step or options.step)))
    h, goal = options.duration / steps, options.turn * DEG
    controls = np.zeros((members, n * n, len(inputs)))
    controls[:, :, [k for k, one in enumerate(inputs) if one.role == "propeller"]] = ship.require_approach().n
    run = predictor.under_way(np.broadcast_to(state, (members, n * n, 6)), controls)
    still, rudder = np.array([UNKNOWN._replace(wind_known=1.0)]), np.zeros((members, n * n))
    score = np.zeros((members, n * n))
    with np.errstate(all="ignore"):
        for k in range(steps + 1):
            psi, r = run.states[..., 2], run.states[..., 5]
            score += (0.5 if k in (0, steps) else 1.0) * h * (np.abs(psi - goal) + np.abs(r))  # trapezoids
            order = np.clip(-P * (psi - goal) - D * r, low, high)
            rudder = actuated(rudder, order, rate, h, h)
            controls[:, :, rudders] = rudder[..., None]
            run.step(controls, still, h)
    return np.where(np.isfinite(score), score, np.inf).reshape(members, n, n)


def overrated(scores: FloatArray, truth: FloatArray) -> float:
    """Share of the gains at which a simulator promises a lower score than the true system has."""
    return float(np.mean(scores < truth))


def write_heading_study(
    result: HeadingStudy, folder: Path | str, command: str = "", *, overwrite: bool = False
) -> dict[str, Any]:
    """Write the record into a run folder.  Returns it.

    Raises OutputError where one is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, HeadingStudy, folder, HEADING_STUDY, overwrite=overwrite) as place:
        return write_record(result.to_dict(command), place, HEADING_STUDY)


def best(scores: FloatArray, gains: FloatArray) -> tuple[float, float]:
    """The pair of gains with the least score."""
    p, d = np.unravel_index(int(np.argmin(scores)), scores.shape)
    return float(gains[p]), float(gains[d])


def _many(predictor: Predictor, options: HeadingOptions) -> Predictor:
    """Particles where members are not what is wanted already."""
    if isinstance(predictor, Uncertain) and (predictor.n_members == 1 or options.sampling == "TS1"):
        return predictor.drawn(options.particles, options.seed, options.sampling)  # type: ignore[arg-type]
    return predictor


def _agrees(predictor: Predictor, ship: ShipProfile) -> None:
    """Raises OptionError where a model cannot be steered as the true system is."""
    if ship.approach is None:
        why = "the propeller of the study turns as in the approach condition"
        raise OptionError(Problem(f"'{ship.id}' has no approach", "truth", why, "add [approach] to the profile"))
    true = {one.name for one in ship.arrangement.inputs}
    if set(predictor.inputs) != true:
        what = f"'{predictor.name}' is driven by {', '.join(predictor.inputs)}, the truth by {', '.join(sorted(true))}"
        raise OptionError(Problem(what, "truth", "orders go to both alike", "give models of one ship"))
    if not isinstance(predictor, Fleet):
        what = f"'{predictor.name}' cannot be steered on many lanes at once"
        raise OptionError(Problem(what, "MODEL", "it has no method under_way", "give a profile or a trained network"))
    if not any(INPUTS[name].role == "rudder" for name in predictor.inputs):
        raise OptionError(Problem(f"'{ship.id}' has no rudder", "truth", "a heading is kept by rudders"))
    _gears(ship, [name for name in predictor.inputs if INPUTS[name].role == "rudder"])


def _gears(ship: ShipProfile, rudders: Sequence[str]) -> list[Actuator]:
    """What moves the rudders.  Raises OptionError where a profile does not say."""
    found = [ship.actuator(name) for name in rudders]
    lacking = [name for name, one in zip(rudders, found, strict=True) if one is None]
    if lacking:
        what = f"'{ship.id}' does not say how {', '.join(lacking)} moves"
        raise OptionError(Problem(what, "truth", "orders are followed at a rate, within limits", "add [steering_gear]"))
    return [one for one in found if one is not None]


def _finite(scores: FloatArray) -> list[list[float | None]]:
    return [[float(value) if np.isfinite(value) else None for value in row] for row in scores]


def shares_of(model: Mapping[str, Any]) -> list[tuple[str, float, float]]:
    """Of a model in the record: each way to read it, and the shares of gains it overrates, and clearly so."""
    named = {"single": "one member", "mean": "mean of members", "worst": "worst member"}
    several = model["members"] > 1
    rows = []
    for view, found in model["views"].items():
        if view == "single" and several:
            own = model["overrated_by_single_members"]
            rows.append((f"{named[view]}, mean over all", own["mean"], own["clearly"]))
        else:
            words = named[view] if several else "as it is"
            rows.append((words, found["overrated"], found["clearly_overrated"]))
    return rows
