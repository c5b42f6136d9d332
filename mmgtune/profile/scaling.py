"""The same ship at another size, by Froude's law: lengths times a scale, times and speeds times its root."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ..components import Field
from ..inputs import INPUTS
from ..metrics import METRICS
from .model import Actuator, Coefficient, Section, ShipProfile

POWERS = {"m": 1.0, "m^2": 2.0, "s": 0.5, "m/s": 0.5, "1/s": -0.5, "rad/s": -0.5, "1/s^2": -1.0, "N": 3.0}
"""Power of the scale that a number of a unit grows with; a unit that is not here has no length or time in it."""


def factor(unit: str, scale: float) -> float:
    """By what a number of that unit grows."""
    return float(scale ** POWERS.get(unit, 0.0))


def froude_scaled(profile: ShipProfile, scale: float, *, id: str, name: str) -> ShipProfile:
    """The ship ``scale`` times as long, in water of the same density, that moves alike.

    Coefficients without a dimension stay as they are: what viscosity changes is not in it.  Notes and sources stay;
    each number keeps what was known of the model's.
    """

    def grown(of: Field, one: Coefficient) -> Coefficient:
        by = factor(of.unit, scale)
        if by == 1.0:
            return one
        value = tuple(by * part for part in one.value) if isinstance(one.value, tuple) else by * one.value
        alone = {part: getattr(one, part) for part in ("pre_determined", "stderr", "scatter")}
        others: dict[str, Any] = {part: number if number is None else by * number for part, number in alone.items()}
        bounds = one.bounds and (by * one.bounds[0], by * one.bounds[1])
        return replace(one, value=value, bounds=bounds, **others)

    def section(old: Section) -> Section:
        fields = old.component.fields
        return replace(old, coefficients={k: grown(fields[k], one) for k, one in old.coefficients.items()})

    def actuator(input: str, old: Actuator) -> Actuator:
        one = INPUTS[input]
        size = factor(one.unit, scale)
        return Actuator(size * old.low, size * old.high, factor(one.rate_unit, scale) * old.rate)

    gear, approach = profile.steering_gear, profile.approach
    return replace(
        profile,
        id=id,
        name=name,
        sections={kind: section(old) for kind, old in profile.sections.items()},
        steering_gear=gear and replace(gear, rate=factor("rad/s", scale) * gear.rate),
        approach=approach
        and replace(approach, speed=factor("m/s", scale) * approach.speed, n=factor("1/s", scale) * approach.n),
        limits={metric: factor(METRICS[metric].unit, scale) * most for metric, most in profile.limits.items()},
        actuators={input: actuator(input, old) for input, old in profile.actuators.items()},
        provenance={},
        path=None,
        template="",
    )
