"""Two ship profiles side by side: coefficients, forces, manoeuvres; what ``mmgtune profile compare`` does."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .arguments import ShipGiven, ship_of
from .arrays import FloatArray
from .components import effect_tag
from .displayed import Displayed
from .effects import Parameter
from .errors import OptionError, Problem
from .motions import breakdown
from .options import SimulateOptions
from .physics.prime import force_unit, moment_unit
from .physics.quantities import STATES
from .profile import ShipProfile
from .profile.changing import scale_of
from .run_files import COMPARISON
from .simulating import simulate
from .units import DEG
from .writing_results import place_for, write_record

ANGLES = tuple(float(angle) for angle in np.linspace(-30.0, 30.0, 61))
"""Drift angles forces are drawn over [deg]."""

YAW_RATES = tuple(float(rate) for rate in np.round(np.linspace(-1.0, 1.0, 41), 6))
"""Yaw rates forces are drawn over, r' [-]."""

TURNS = ("35", "-35", "10", "-10")
ZIGZAGS = ("10/10", "20/20")
INDICES = (
    "advance_over_L",
    "transfer_over_L",
    "tactical_diameter_over_L",
    "steady_diameter_over_L",
    "speed_ratio_360",
    "steady_drift_angle_deg",
    "overshoot_1_deg",
    "overshoot_2_deg",
    "initial_turning_distance_over_L",
    "period_s",
)
"""Indices that are compared, of those that manoeuvres have."""

POINTS = 300
"""Points a track is drawn with."""


@dataclass(frozen=True, eq=False)
class Comparison(Displayed):
    """Two profiles side by side, as plain numbers; ``data`` is the record.

    profiles  what they were called
    """

    written_by = "write_comparison"

    profiles: tuple[str, str]
    ships: tuple[ShipProfile, ShipProfile]
    data: Mapping[str, Any]

    def __repr__(self) -> str:
        """In a line."""
        differ = sum(row["a"] != row["b"] for row in self.data["coefficients"])
        return f"Comparison({self.profiles[0]} and {self.profiles[1]}: {differ} coefficients differ)"

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return dict(self.data)


def write_comparison(result: Comparison, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write the record into a run folder.  Returns it.

    Raises OutputError where one is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, Comparison, folder, COMPARISON, overwrite=overwrite) as place:
        return write_record(result.to_dict(), place, COMPARISON)


def compare_profiles(a: ShipGiven, b: ShipGiven) -> Comparison:
    """Two profiles: objects, paths or bundled names.

    Forces are at the approach speed of the first, with the revolutions of each, in the prime system of each.
    Raises OptionError where they are driven by different inputs.
    """
    ships = ship_of(a), ship_of(b)
    if ships[0].arrangement is not ships[1].arrangement:
        titles = " and ".join(ship.arrangement.title for ship in ships)
        raise OptionError(
            Problem("the ships are arranged differently", "profiles", titles, "compare profiles of a kind")
        )
    names = [
        Path(one).stem if isinstance(one, (str, Path)) else ship.id for one, ship in zip((a, b), ships, strict=True)
    ]
    if names[0] == names[1]:
        names = [f"{name} ({k})" for k, name in enumerate(names, 1)]
    U = scale_of(ships[0]).U
    data = {
        "schema": 1,
        "kind": "comparison",
        "profiles": [
            {
                "name": name,
                "id": ship.id,
                "path": str(ship.path or ""),
                "title": ship.name,
                "sha256": ship.sha256,
                "models": {kind: s.component.tag for kind, s in ship.sections.items()},
                "doubts": [one.to_dict() for one in ship.doubts()],
                "assumptions": len(ship.assumptions()),
            }
            for name, ship in zip(names, ships, strict=True)
        ],
        "speed_mps": U,
        "coefficients": _coefficients(*ships),
        "forces": {
            "over_drift": {"beta_deg": list(ANGLES), **_both(ships, lambda ship: _over_drift(ship, U))},
            "over_yaw_rate": {"r_prime": list(YAW_RATES), **_both(ships, lambda ship: _over_yaw_rate(ship, U))},
            "over_rudder": {"delta_deg": list(_rudder_angles(ships)), **_over_rudder(ships, U)},
        },
        "manoeuvres": _manoeuvres(ships),
    }
    return Comparison((names[0], names[1]), ships, data)


def _coefficients(a: ShipProfile, b: ShipProfile) -> list[dict[str, Any]]:
    """Every number either has, of effects those that differ; None where the other has no such."""
    rows = []
    numbers = [{name: ship.value(name) for name in ship.names() if _acts(ship, name)} for ship in (a, b)]
    for name in dict.fromkeys((*numbers[0], *numbers[1])):
        if effect_tag(name) and numbers[0].get(name) == numbers[1].get(name):
            continue
        ship = a if name in numbers[0] else b
        kind, _, symbol = name.rpartition(".")
        known = ship.sections[kind].component.fields[symbol]
        of = [numbers[k].get(name) for k in (0, 1)]
        scatters = (s.coefficient(name).scatter for s, value in ((b, of[1]), (a, of[0])) if value is not None)
        scatter = next((one for one in scatters if one is not None), None)
        rows.append(
            {
                "name": name,
                "label": known.label,
                "unit": known.unit,
                "a": of[0],
                "b": of[1],
                "scatter": scatter,
                "same_model": a.sections.get(kind) is not None
                and b.sections.get(kind) is not None
                and a.sections[kind].component is b.sections[kind].component,
            }
        )
    return rows


def _acts(ship: ShipProfile, name: str) -> bool:
    """Whether a number is the ship's, or that of an effect at other than its null."""
    kind, _, symbol = name.rpartition(".")
    field = ship.sections[kind].component.fields[symbol]
    return not (effect_tag(name) and isinstance(field, Parameter)) or ship.value(name) != field.null


def _both(ships: tuple[ShipProfile, ShipProfile], of: Callable[[ShipProfile], Any]) -> dict[str, Any]:
    return {"a": of(ships[0]), "b": of(ships[1])}


def _forces(ship: ShipProfile, states: FloatArray, delta: FloatArray, part: str) -> dict[str, list[float]]:
    """One part of the forces [prime] along states (n, 6) with revolutions of the approach and rudder angles (n,)."""
    inputs = ship.arrangement.inputs
    n = ship.approach.n if ship.approach else 0.0
    controls = np.stack(
        [
            delta if one.role == "rudder" else np.full(len(states), n if one.role == "propeller" else 0.0)
            for one in inputs
        ],
        axis=1,
    )
    found = getattr(breakdown(ship, states, controls), part)
    force = getattr(found, "force", found)
    rho, L, d = (ship.value(f"particulars.{name}") for name in ("rho", "L_pp", "d"))
    U = np.hypot(states[:, 3], states[:, 4])
    units = {"X": force_unit(rho, L, d, U), "Y": force_unit(rho, L, d, U), "N": moment_unit(rho, L, d, U)}
    return {axis: [float(f) for f in np.asarray(getattr(force, axis)) / unit] for axis, unit in units.items()}


def _states(U: float, beta: FloatArray, r: FloatArray) -> FloatArray:
    zero = np.zeros(len(beta))
    return np.stack([zero, zero, zero, U * np.cos(beta), -U * np.sin(beta), r], axis=1)


def _over_drift(ship: ShipProfile, U: float) -> dict[str, list[float]]:
    """Hull force over the drift angle, not turning."""
    beta = np.array(ANGLES) * DEG
    return _forces(ship, _states(U, beta, 0.0 * beta), 0.0 * beta, "hull")


def _over_yaw_rate(ship: ShipProfile, U: float) -> dict[str, list[float]]:
    """Hull force over the yaw rate, without drift."""
    r = np.array(YAW_RATES) * U / ship.L_pp
    return _forces(ship, _states(U, 0.0 * r, r), 0.0 * r, "hull")


def _rudder_angles(ships: tuple[ShipProfile, ShipProfile]) -> tuple[float, ...]:
    """Rudder angles to draw over [deg], as far as both steering gears go."""
    most = min((ship.steering_gear.max_angle / DEG for ship in ships if ship.steering_gear), default=35.0)
    return tuple(float(angle) for angle in np.round(np.linspace(-most, most, 61), 6))


def _over_rudder(ships: tuple[ShipProfile, ShipProfile], U: float) -> dict[str, Any]:
    """Rudder force with the hull's reaction, going straight; nothing where the arrangement has no part "rudder"."""
    delta = np.array(_rudder_angles(ships)) * DEG
    if "rudder" not in ships[0].arrangement.breakdown._fields:
        return {"a": None, "b": None}
    return _both(ships, lambda ship: _forces(ship, _states(U, 0.0 * delta, 0.0 * delta), delta, "rudder"))


def _manoeuvres(ships: tuple[ShipProfile, ShipProfile]) -> dict[str, Any]:
    """Standard manoeuvres of both: indices that both have, and tracks of the turns in lengths of the ship.

    One that diverged has none.
    """
    if any(ship.approach is None or ship.steering_gear is None for ship in ships):
        return {"indices": [], "tracks": {}}
    options = SimulateOptions(turn=TURNS, zigzag=ZIGZAGS)
    both = [simulate(ship, options=options) for ship in ships]
    found = [{row["id"]: row["indices"] for row in one.rows()} for one in both]
    rows = [
        {"manoeuvre": id, "index": name, "a": found[0][id][name], "b": found[1][id][name]}
        for id in found[0]
        for name in INDICES
        if all(isinstance(one[id].get(name), float) for one in found)
    ]
    tracks: dict[str, Any] = {}
    motions: dict[str, Any] = {}
    for key, one, ship in zip("ab", both, ships, strict=True):
        for motion in (motion for motion in one if not motion.diverged):
            every = slice(None, None, max(1, len(motion.t) // POINTS))
            columns = {"t": motion.t, **dict(zip(STATES, motion.states.T, strict=True))}
            motions.setdefault(motion.id, {})[key] = {
                name: [float(f"{value:.6g}") for value in values[every]] for name, values in columns.items()
            }
            if motion.id.startswith("turn"):
                north, east = np.round(motion.states[every, :2] / ship.L_pp, 4).T.tolist()
                tracks.setdefault(motion.id, {})[key] = {"north": north, "east": east}
    return {"indices": rows, "tracks": tracks, "motions": motions, "L_pp": ships[0].L_pp}
