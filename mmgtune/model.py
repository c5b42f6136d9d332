"""A ship model as rows of numbers: the one map between coefficient names and the matrix simulators work on."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from .arguments import ShipGiven, ship_of
from .arrays import FloatArray, numbers_of
from .components import Component
from .effects import ClockEffect, CoefficientsEffect, Effect
from .errors import OptionError, Problem, ProfileError, all_of, among, brief

E = TypeVar("E", bound=Effect)


class Tie(NamedTuple):
    """A coefficient that follows another of the same ship where that one is changed: ``ratio`` times its value."""

    name: str
    to: str
    ratio: float


class Model:
    """The components and effects of a profile and their coefficients as one column of numbers.

    Simulators take a matrix with one row per number (a table has several) and one column per candidate, so that
    any coefficient can differ between lanes.

    profile  object, path or bundled name
    ties     coefficients that follow others
    """

    def __init__(self, profile: ShipGiven, ties: Sequence[Tie] = ()):
        self.profile = profile = ship_of(profile)
        self.ties = all_of(ties, Tie, "ties")
        self.arrangement = profile.arrangement
        self.parts: tuple[Component, ...] = tuple(profile.sections[kind].component for kind in self.arrangement.kinds)
        self.components = self.arrangement.components(*(part.function for part in self.parts[1:]))
        present = [section.component for section in profile.sections.values()]
        self.effects: tuple[Effect, ...] = tuple(part for part in present if isinstance(part, Effect))
        numbers = {name: value for section in profile.sections.values() for name, value in section.numbers.items()}
        self.rows: dict[str, int] = {name: row for row, name in enumerate(numbers)}
        self.base: FloatArray = np.array(list(numbers.values()))

    def __repr__(self) -> str:
        """In a line."""
        return f"Model({self.profile.id}: {len(self.rows)} coefficients, {len(self.effects)} effects)"

    def acting(self, kind: type[E]) -> tuple[E, ...]:
        """The effects that act at one place of the data flow, in the order in which they act."""
        return tuple(effect for effect in self.effects if isinstance(effect, kind))

    @property
    def clocks(self) -> tuple[ClockEffect, ...]:
        """The effects that shift the log of the inputs."""
        return self.acting(ClockEffect)

    @property
    def inputs(self) -> tuple[str, ...]:
        """What drives the ship: columns of trial files, in the order of ``Cases.controls``."""
        return tuple(one.name for one in self.arrangement.inputs)

    @property
    def tags(self) -> tuple[str, ...]:
        """The arrangement, components and effects in use."""
        parts = (f"{part.kind}:{part.tag}" for part in (*self.parts, *self.effects))
        return (f"arrangement:{self.arrangement.tag}", *parts)

    @cached_property
    def L_pp(self) -> float:
        """Length between perpendiculars [m]."""
        return self.profile.L_pp

    @cached_property
    def draught(self) -> float:
        """Draught of the profile [m]."""
        return self.profile.value("particulars.d")

    def numbers(self) -> dict[str, float]:
        """Every number of the profile by name, those of tables one by one."""
        return {name: float(self.base[row]) for name, row in self.rows.items()}

    def matrix(self, names: Sequence[str] = (), values: npt.ArrayLike | None = None) -> FloatArray:
        """Coefficients of candidates: ``values`` (n_names, n_candidates) for ``names``, the profile's elsewhere.

        Effects on coefficients have acted on what is returned.
        -> (n_rows, n_candidates); one column where there are no values.
        Raises ProfileError for an unknown name, OptionError for values of another shape.
        """
        rows = self.rows_of(names)
        if values is None:
            theta = self.base[:, None].copy()
        else:
            changed = numbers_of(values)
            if changed is None or changed.ndim != 2 or len(changed) != len(rows):
                there = "what holds no numbers" if changed is None else f"shape {changed.shape}"
                why, fix = "each name has a row, each candidate a column", f"give ({len(rows)}, n_candidates) numbers"
                raise OptionError(Problem(f"values come in {there}", "values", why, fix))
            theta = np.repeat(self.base[:, None], changed.shape[1], axis=1)
            theta[rows] = changed
            for tie in self.ties:
                if tie.to in names and tie.name not in names:
                    theta[self.rows[tie.name]] = tie.ratio * theta[self.rows[tie.to]]
        for effect, own, nulls in self._on_coefficients:
            if len(own) and np.all(theta[own] == nulls):
                continue
            e = self.parameters(effect, theta)
            now = {name: theta[row] for name, row in self.rows.items()}
            for name, value in effect.function(now, e).items():
                theta[self.rows[name]] = value
        return theta

    @cached_property
    def _on_coefficients(self) -> list[tuple[CoefficientsEffect, list[int], FloatArray]]:
        """Effects on coefficients, with the rows of their parameters and where these stand when it is absent (n, 1)."""
        found = []
        for effect in self.acting(CoefficientsEffect):
            rows = dict(zip(effect.params._fields, self.fields(effect), strict=True))
            nulls = [(row, null) for name, null in effect.nulls.items() for row in rows[name]]
            found.append((effect, [row for row, _ in nulls], np.array([[null] for _, null in nulls])))
        return found

    def rows_of(self, names: Sequence[str]) -> list[int]:
        """Rows of numbers by their names.  Raises ProfileError for a name that no number has."""
        several = [names] if isinstance(names, str) else names
        unknown = [name for name in several if not isinstance(name, str) or name not in self.rows]
        if unknown:
            where = str(self.profile.path or self.profile.id)
            found = (Problem(f"no number {brief(name)}", where, **among(name, list(self.rows))) for name in unknown)
            raise ProfileError(*found)
        return [self.rows[name] for name in several]

    def fields(self, component: Component) -> list[list[int]]:
        """Rows of each field of a component's tuple of coefficients: one, or those of a table."""
        borrowed = component.borrowed if isinstance(component, Effect) else {}
        found = []
        for symbol in component.params._fields:
            name = borrowed.get(symbol, f"{component.kind}.{symbol}")
            table = component.fields[symbol].table if symbol in component.fields else 0
            found.append([self.rows[f"{name}[{k}]"] for k in range(table)] if table else [self.rows[name]])
        return found

    def parameters(self, component: Component, theta: FloatArray) -> Any:
        """The tuple of a component's coefficients, lanes of shape (n_candidates,) out of (n_rows, n_candidates)."""
        tables = [symbol in component.fields and component.fields[symbol].table for symbol in component.params._fields]
        rows = self.fields(component)
        return component.params(
            *(
                tuple(theta[row] for row in of) if table else theta[of[0]]
                for of, table in zip(rows, tables, strict=True)
            )
        )

    def without_log(self, theta: FloatArray) -> FloatArray:
        """Coefficients (n_rows, ...) without what makes a log late, and what is read off it, for runs of which none is
        given.

        Dead times of the ship stay.
        """
        theta = self.without_readings(theta)
        for clock in self.clocks:
            if clock.late == "log":
                theta[self.fields(clock)[0]] = 0.0
        return theta

    def without_readings(self, theta: FloatArray) -> FloatArray:
        """Coefficients (n_rows, ...) without what effects read off a log, for runs that have one but are not driven by
        it."""
        theta = np.array(theta)
        for effect in self.effects:
            for name in effect.read_off:
                theta[self.rows[f"{effect.kind}.{name}"]] = effect.parameters[name].null
        return theta

    def coefficients(self, theta: FloatArray) -> Any:
        """The arrangement's tuple of the tuples the equations take, with lanes of shape (n_candidates,) out of a matrix
        (n_rows, n_candidates)."""
        return self.arrangement.coefficients(*(self.parameters(part, theta) for part in self.parts))
