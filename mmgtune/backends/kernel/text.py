"""Words the text of a kernel is made of: slots of its arrays, loops over lanes, and what parts are called there."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ...components import Component
from ...effects import (
    ActuatorEffect,
    Effect,
    FactorsEffect,
    FilterEffect,
    FlowEffect,
    ForceEffect,
    LagEffect,
    SensorEffect,
)
from ...model import Model
from ...physics.quantities import STATES

WIDTH = 8
"""Lanes that march together; two AVX2 or one AVX-512 register of float64."""

N_STATES = len(STATES)

IN_KERNEL: tuple[type[Effect], ...] = (
    ActuatorEffect,
    FlowEffect,
    FactorsEffect,
    ForceEffect,
    LagEffect,
    SensorEffect,
    FilterEffect,
)
"""Effects that a kernel passes by in blocks without them, as its argument ``present`` says, in the model's order."""


def acting_in(model: Model, places: tuple[type[Effect], ...]) -> list[Effect]:
    """The effects of a model in some places."""
    return [effect for effect in model.effects if isinstance(effect, places)]


def any_of(effects: Sequence[Effect]) -> str:
    return " or ".join(flag_of(effect) for effect in effects)


def block_of(indent: int, lines: Sequence[str]) -> str:
    return "\n".join(" " * indent + line for line in lines)


def indented(lines: Sequence[str]) -> list[str]:
    return ["    " + line for line in lines]


def each_lane(lines: Sequence[str]) -> list[str]:
    """The lines for each lane in turn."""
    return [f"for l in range({WIDTH}):", *indented(lines)]


def where_present(effect: Effect, lines: Sequence[str]) -> list[str]:
    """The lines for each lane in turn, of blocks with the effect."""
    return [f"if {flag_of(effect)}:", *indented(each_lane(lines))]


def slot(array: str, k: int) -> str:
    """Number k of lane l in an array of the stack."""
    return f"{array}[{k * WIDTH} + l]"


def cell(row: int) -> str:
    return slot("p", row)


def name_of(part: Component) -> str:
    """What the kernel calls the function of a part: by its kind, since those of packages may be called anything."""
    return re.sub(r"\W", "_", f"of_{part.kind}")


def flag_of(effect: Effect) -> str:
    """What says in the kernel whether any lane of a block has an effect."""
    return re.sub(r"\W", "_", f"has_{effect.kind}")


def tuple_of(part: Component, array: str = "p") -> str:
    """The tuple of a component's coefficients of lane l."""
    return f"{name_of(part)}_load({array}, l)"
