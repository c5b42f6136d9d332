"""Known terms of force: what each coefficient and each effect would add along runs that were followed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..components import effect_tag, split_name
from ..effects import Effect, FilterEffect, Parameter, Scale, SensorEffect, effects
from ..effects.hull_term import symbol
from ..fitting.box import parameter_of
from ..model import Model
from ..profile import ShipProfile, missing_for, scale_of, with_effects
from .following import Followed, accelerations_by
from .refitting import tuned_names

STEP = 1e-3
"""Step of derivatives by coefficients, over their size; that of one that is zero."""

STRAIGHT = 0.02
"""Half a typical value gives half its force within this share: the force is proportional to the value."""

SIZES = 8
"""Values of a parameter whose force is not, each the root of two smaller than the last."""

DIRECTIONS = 12
"""Directions of a size that has one."""

LARGEST = 3.0
"""Largest factor on the force of a value to which it is not proportional."""

VALUE = "{value}"
"""What stands for the value of a term in its words."""

SAME = 0.9999
"""Cosine between two forces from which they are one and the same."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A term with the force of one value.

    family    of candidates of which one at most is chosen
    told      the title with a place for the value, ``VALUE``
    settings  parameters {name: value in SI units} that give the force, the first the one that is told
    linear    whether the force is proportional to the value; else it may be larger or smaller, not reversed
    null      value without force, from which a linear one counts
    most      largest factor on the force worth believing
    force     (n, 3) X, Y [N], N [N m]
    """

    name: str
    family: str
    title: str
    told: str
    unit: str
    settings: dict[str, float]
    linear: bool
    null: float
    most: float
    force: FloatArray

    @property
    def value(self) -> float:
        """Of the first parameter."""
        return next(iter(self.settings.values()))


def candidates(followed: Followed, mass: FloatArray, scale: FloatArray) -> list[Candidate]:
    """Every term that acts along the runs, the same force once.

    mass   (3, 3) force that gives accelerations
    scale  (3,) that forces are compared in

    Coefficients are those of the profile that were tuned, that its [tuning] names, and of its hull; then every effect
    that acts on the ship, of each its parameters one by one.
    """
    base = accelerations_by(followed.model, followed.model.matrix()[:, 0], followed)
    found = []
    for one in [*_coefficients(followed, mass), *_effects(followed, mass, base)]:
        if np.isfinite(one.force).all() and np.any(one.force):
            found.append(one)
    flat = np.array([(one.force / scale).ravel() for one in found])
    flat /= np.sqrt(np.sum(flat * flat, axis=1))[:, None]
    alike = np.abs(flat @ flat.T) >= SAME
    kept: list[int] = []
    for k in range(len(found)):
        if not alike[k, kept].any():
            kept.append(k)
    return [found[k] for k in kept]


def _coefficients(followed: Followed, mass: FloatArray) -> Iterator[Candidate]:
    """Derivatives by coefficients of the profile."""
    model = followed.model
    hull = [name for name in model.rows if name.startswith("hull.")]
    present = [name for name in model.rows if effect_tag(name) and parameter_of(model, name)]
    for name in dict.fromkeys((*tuned_names(model.profile), *model.profile.targets, *hull, *present)):
        if name not in model.rows or not np.isfinite(now := model.base[model.rows[name]]):
            continue
        step = STEP * (abs(now) or 1.0)
        both = model.matrix([name], [[now - step, now + step]])
        below, above = (accelerations_by(model, both[:, k], followed) for k in (0, 1))
        section, coefficient = split_name(name)
        field = model.profile.sections[section].component.fields[coefficient]
        yield Candidate(
            name,
            name,
            f"a change of {name}",
            f"a change of {name} by {VALUE}",
            field.unit,
            {name: 1.0},
            True,
            0.0,
            np.inf,
            (above - below) / (2.0 * step) @ mass.T,
        )


def _effects(followed: Followed, mass: FloatArray, base: FloatArray) -> Iterator[Candidate]:
    """What effects would add that the profile does not have."""
    profile = followed.model.profile
    here = {effect.tag for effect in followed.model.effects}
    for effect in effects():
        if isinstance(effect, (FilterEffect, SensorEffect)) or effect.tag in here or missing_for(effect, profile):
            continue
        yield from _effect(effect, profile, followed, mass, base)


def _effect(
    effect: Effect, profile: ShipProfile, followed: Followed, mass: FloatArray, base: FloatArray
) -> Iterator[Candidate]:
    model = Model(with_effects(profile, {effect.tag: {}}, "asked of a network"))
    ship = scale_of(profile)

    def force(settings: dict[str, float]) -> FloatArray:
        names = [f"effects.{effect.tag}.{name}" for name in settings]
        theta = model.matrix(names, np.array([*settings.values()])[:, None])[:, 0]
        return np.asarray((accelerations_by(model, theta, followed) - base) @ mass.T)

    for names in _alone(effect):
        parameter = effect.parameters[names[0]]
        title, told = _told(effect, names[0])
        low, high = parameter.bounds(ship)
        most = max(abs(low - parameter.null), abs(high - parameter.null))
        made = (f"{effect.tag}.{names[0]}", f"{effect.tag}.{names[0]}", title, told, parameter.unit)
        if len(names) == 1 and parameter.chart == "linear":
            typical = parameter.typical(ship)
            whole = force({names[0]: parameter.null + typical})
            half = force({names[0]: parameter.null + 0.5 * typical})
            if np.abs(whole - 2.0 * half).max() <= STRAIGHT * np.abs(whole).max():
                yield Candidate(*made, {names[0]: 1.0}, True, parameter.null, most, whole / typical)
                continue
        for settings in _values(names, effect, ship):
            yield Candidate(*made, settings, False, parameter.null, LARGEST, force(settings))


def _alone(effect: Effect) -> list[tuple[str, ...]]:
    """Parameters that are asked for: each by itself, a size together with its direction."""
    names = [name for name in effect.parameters if name not in effect.pivots]
    found: list[tuple[str, ...]] = []
    skip = False
    for name, following in zip(names, [*names[1:], ""], strict=True):
        if not skip:
            polar = effect.parameters[name].chart == "polar"
            found.append((name, following) if polar else (name,))
        skip = not skip and effect.parameters[name].chart == "polar"
    return found


def _values(names: Sequence[str], effect: Effect, ship: Scale) -> Iterator[dict[str, float]]:
    """Values over the range an effect is looked for in, the null apart."""
    parameter: Parameter = effect.parameters[names[0]]
    if len(names) > 1:
        for direction in 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS:
            yield {names[0]: parameter.typical(ship), names[1]: float(direction)}
        return
    null = parameter.searched(parameter.null)
    for end in parameter.bounds(ship):
        for k in range(SIZES):
            value = null + (end - null) * 0.5 ** (0.5 * k)
            if value != null:
                yield {names[0]: parameter.searched(value)}


def _told(effect: Effect, name: str) -> tuple[str, str]:
    """What the term of a parameter is called, without and with its value."""
    if effect.tag == "hull-term":
        return symbol(name), f"a hull term {symbol(name)} = {VALUE}"
    if len(effect.parameters) == 1:
        return effect.title, f"{effect.title} ({VALUE})"
    words = name.replace("_", " ")
    return f"{effect.title} ({words})", f"{effect.title} ({words} {VALUE})"
