"""What is said of a component, of each of its coefficients, and of how components are put together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from ..displayed import Brief
from ..inputs import INPUTS, Input, Role

AT_LEAST_0, AT_MOST_0 = -1e-12, 1e-12
"""Limits of a field that let 0 itself in, where a limit of 0 would not."""


@dataclass(frozen=True, repr=False)
class Field(Brief):
    """One coefficient of a component.

    label    what it is, in words
    unit     SI unit, "-" for a pure number, "prime" for the prime system of the MMG standard method
    default  value where a profile leaves it out; None if the profile must give it, which holds for every term of a
             force: a term that a source does not have is written as 0
    low, high  impossible at or beyond these (exclusive), None where anything goes; AT_LEAST_0 and AT_MOST_0 let 0 in
    choices  words a profile may write instead of the number each stands for
    table    0 for a number; else the number of values of a table
    derived  computed from other numbers of the profile where it is left out
    """

    label: str
    unit: str = "-"
    default: float | None = None
    low: float | None = None
    high: float | None = None
    choices: dict[str, float] = field(default_factory=dict)
    table: int = 0
    derived: bool = False


@dataclass(frozen=True, repr=False)
class Component(Brief):
    """A kind of force (or the ship itself), the tag profiles name it by, its function and its coefficients."""

    kind: str
    tag: str
    title: str
    params: type[Any]
    fields: dict[str, Field]
    function: Callable[..., Any] | None
    cites: tuple[str, ...]

    def __post_init__(self) -> None:
        if tuple(self.fields) != self.params._fields:
            raise TypeError(f"{self.kind} '{self.tag}': fields {tuple(self.fields)} are not {self.params._fields}")


@dataclass(frozen=True, repr=False)
class Arrangement(Brief):
    """How components are put together: which a ship has, what drives her, and the function that combines their forces.

    control       NamedTuple of the inputs, each field one of ``inputs.INPUTS``
    components    NamedTuple of the components' functions; its fields are the kinds a profile has besides particulars
    coefficients  NamedTuple of ``ship`` and the same kinds
    breakdown     NamedTuple of what ``forces`` returns: ``flow``, ``hull``, ``total``, and whatever else there is
    forces        forces(State through the water, control, components, coefficients) -> breakdown
    """

    tag: str
    title: str
    control: type[Any]
    components: type[Any]
    coefficients: type[Any]
    breakdown: type[Any]
    forces: Callable[..., Any]
    cites: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        unknown = [name for name in self.control._fields if name not in INPUTS]
        lacking = [name for name in ("flow", "hull", "total") if name not in self.breakdown._fields]
        if unknown or lacking:
            raise TypeError(f"arrangement '{self.tag}': unknown inputs {unknown}, breakdown without {lacking}")
        if self.coefficients._fields != ("ship", *self.components._fields):
            raise TypeError(f"arrangement '{self.tag}': {self.coefficients._fields} are not ship and its components")

    @property
    def kinds(self) -> tuple[str, ...]:
        """Kinds of components a profile needs one of each, in the order of ``coefficients``."""
        return ("particulars", *self.components._fields)

    @property
    def inputs(self) -> tuple[Input, ...]:
        """What drives the ship, in the order of ``control``."""
        return tuple(INPUTS[name] for name in self.control._fields)

    def of_role(self, role: Role) -> tuple[int, ...]:
        """Places of the inputs of one role among all."""
        return tuple(k for k, one in enumerate(self.inputs) if one.role == role)


def polynomial(of: str, letter: str, terms: tuple[str, ...], unit: str = "-") -> dict[str, Field]:
    """Fields letter_1, letter_2, ... of the terms of a sum, in words."""
    return {f"{letter}_{k}": Field(f"{of}, {term}", unit) for k, term in enumerate(terms, start=1)}
