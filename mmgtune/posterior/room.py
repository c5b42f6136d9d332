"""Room in the form of a model: what may be otherwise than the profile says, and how far, before any trial is seen.

A model fitted with its targets alone is sure of the wrong thing, since nothing else may explain what the ship does.
So every coefficient of her components may differ, every effect that applies may be there, and smooth forces of unknown
form besides, each by as much as formulas and tests leave open: normal distributions about the profile's value, or about
the null of an effect.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..components import effect_tag
from ..displayed import Brief
from ..effects import Effect, Parameter, discrepancy, find_effect
from ..errors import Problem, ProfileError
from ..model import Model
from ..particles import Particles
from ..profile import ShipProfile, missing_for, scale_of, with_effects

TARGET = 0.2
"""Deviation of a coefficient that the profile lists as a target, as a share of its value, where no formula says it."""

OTHER = 0.1
"""The same of every other coefficient of hull, wake, propeller and rudder."""

MOST = 0.75
"""Coefficients stay within this share of their value: a sign that is known stays."""

ONE_SIDED = 0.5
"""Forces of unknown form that favour one side, over those that both sides share."""

IN_ROOM = (
    "discrepancy",
    "rudder-gain",
    "rudder-offset",
    "rpm-scale",
    "flap",
    "propeller-side-force",
    "resistance",
    "loading",
    "current",
    "wind",
    "wave-drift",
    "antenna",
    "heading-bias",
    "speed-scale",
    "gyro-scale",
    "gyro-bias",
)
"""Effects there is room for where they apply: those that can have either sign.  Lags, stall, shallow water and memory
have an end of their range as null; the forces of unknown form stand in for them."""

GEOMETRY = ("D_P", "A_R", "H_R", "x_R_", "flap_step", "phi_switch", "phi_min", "phi_max")
"""What is measured with a rule, and ends of tables."""

SOURCE = "room for what the profile leaves out"


@dataclass(frozen=True, eq=False, repr=False)
class Room(Brief):
    """What may differ, and by how much, as independent normal distributions cut at bounds.

    profile    with every effect that there is room for
    names      of the numbers, (n_names,) each below
    centre     most probable values before any trial, in coordinates: the value itself, or a component (``polar``)
    deviation  standard deviations
    low, high  bounds
    polar      pairs of numbers, a size and its direction [rad], that have components north and east as coordinates
    """

    profile: ShipProfile
    names: tuple[str, ...]
    centre: FloatArray
    deviation: FloatArray
    low: FloatArray
    high: FloatArray
    polar: tuple[tuple[int, int], ...]

    def __len__(self) -> int:
        return len(self.names)

    @property
    def box(self) -> tuple[FloatArray, FloatArray]:
        """Bounds (n_names,) of z, low and high."""
        return (self.low - self.centre) / self.deviation, (self.high - self.centre) / self.deviation

    def values(self, z: FloatArray) -> FloatArray:
        """Numbers (n_names, n) in profile units at z (n_names, n), standard deviations away from the centre."""
        found = self.centre[:, None] + self.deviation[:, None] * z
        found = np.clip(found, self.low[:, None], self.high[:, None])
        for i, j in self.polar:
            found[i], found[j] = np.hypot(found[i], found[j]), np.arctan2(found[j], found[i])
        return np.asarray(found)

    def coordinates(self, values: FloatArray) -> FloatArray:
        """z (n_names, n) of numbers (n_names, n) in profile units; the inverse of ``values`` within the bounds."""
        found = np.array(values)
        for i, j in self.polar:
            found[i], found[j] = values[i] * np.cos(values[j]), values[i] * np.sin(values[j])
        return np.asarray((found - self.centre[:, None]) / self.deviation[:, None])


def make_room(profile: ShipProfile, *, size: float = 1.0, without: tuple[str, ...] = ()) -> Room:
    """The room of a ship.

    size     of everything, over what is said above
    without  tags of effects to leave no room for
    """
    tags = [tag for tag in IN_ROOM if tag not in without]
    applying = {tag: effect for tag in tags if (effect := find_effect(tag)) and not missing_for(effect, profile)}
    put_in = {tag: {name: p.null for name, p in effect.plain.items()} for tag, effect in applying.items()}
    present = {effect.tag for effect in Model(profile).effects}
    whole = with_effects(profile, {tag: null for tag, null in put_in.items() if tag not in present}, SOURCE)
    rows: list[tuple[str, float, float, float, float]] = [*_coefficients(whole)]
    polar = []
    for effect in applying.values():
        found, pairs = _of_effect(whole, effect)
        polar += [(i + len(rows), j + len(rows)) for i, j in pairs]
        rows += found
    names, *numbers = zip(*rows, strict=True)
    centre, deviation, low, high = np.array(numbers)
    return Room(whole, tuple(names), centre, size * deviation, low, high, tuple(polar))


def room_of(particles: Particles) -> Room:
    """The room that particles were drawn in.  Raises ProfileError for particles that ``posterior`` did not make."""
    there = {tag for name in particles.names if (tag := effect_tag(name))}
    said = particles.facts.get("room", 1.0)
    size = float(said) if isinstance(said, (int, float)) and said > 0.0 else 1.0
    room = make_room(particles.profile, size=size, without=tuple(tag for tag in IN_ROOM if tag not in there))
    if sorted(room.names) != sorted(particles.names):
        what = f"the particles of '{particles.profile.id}' are not those of a posterior"
        raise ProfileError(Problem(what, fix="draw them with mmgtune posterior"))
    return room


def _coefficients(profile: ShipProfile) -> list[tuple[str, float, float, float, float]]:
    """Those of hull, wake, propeller and rudder; above water those that are targets, so where wind was measured."""
    rows = Model(profile).rows
    found = []
    for kind in (*profile.arrangement.kinds, "above_water"):
        if kind == "particulars" or kind not in profile.sections:
            continue
        section = profile.sections[kind]
        for symbol, coefficient in section.coefficients.items():
            name, field = f"{kind}.{symbol}", section.component.fields[symbol]
            if name not in rows or field.table or field.choices or symbol in GEOMETRY:
                continue
            if kind == "above_water" and name not in profile.targets:
                continue
            before = coefficient.pre_determined
            value = profile.value(name) if before is None else float(before)
            if value == 0.0:
                continue
            share = TARGET if name in profile.targets else OTHER
            deviation = share * abs(value) if coefficient.scatter is None else float(coefficient.scatter)
            reach = max(MOST * abs(value), 3.0 * deviation, abs(profile.value(name) - value))
            low = value - reach if field.low is None else max(value - reach, field.low)
            high = value + reach if field.high is None else min(value + reach, field.high)
            found.append((name, value, deviation, low, high))
    return found


def _of_effect(
    profile: ShipProfile, effect: Effect
) -> tuple[list[tuple[str, float, float, float, float]], list[tuple[int, int]]]:
    """Numbers of one effect, and pairs of them that are a size and a direction."""
    scale = scale_of(profile)
    found: list[tuple[str, float, float, float, float]] = []
    pairs: list[tuple[int, int]] = []
    parameters = list(effect.plain.items())
    acts = any(profile.value(f"{effect.kind}.{one}") != effect.parameters[one].null for one in effect.of_measured)
    for k, (symbol, parameter) in enumerate(parameters):
        name = f"{effect.kind}.{symbol}"
        deviation = _deviation(effect, symbol, parameter, profile)
        low, high = parameter.bounds(scale)
        of_log = symbol in effect.of_measured
        if parameter.chart == "polar":
            direction = f"{effect.kind}.{parameters[k + 1][0]}"
            size, towards = profile.value(name), profile.value(direction)
            pairs.append((len(found), len(found) + 1))
            found.append((name, size * np.cos(towards), deviation, -high, high))
            found.append((direction, size * np.sin(towards), deviation, -high, high))
        elif acts if of_log else parameter.chart == "linear" and low < parameter.null < high:
            value = profile.value(name)
            found.append((name, value, deviation, min(low, value), max(high, value)))
    return found, pairs


def _deviation(effect: Effect, symbol: str, parameter: Parameter, profile: ShipProfile) -> float:
    if symbol in effect.of_measured and parameter.unit == "-":
        return TARGET  # a factor
    typical = float(parameter.typical(scale_of(profile)))
    if effect.tag != discrepancy.EFFECT.tag:
        return typical
    return typical * (1.0 if discrepancy.shared_by_sides(symbol) else ONE_SIDED)


def tags_of(room: Room) -> list[str]:
    """Effects there is room for, in order."""
    return [tag for tag in dict.fromkeys(map(effect_tag, room.names)) if tag]
