"""A ship model as rows of numbers: the one map between coefficient names and the matrix simulators work on."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from .components import KINDS, Component
from .physics.mmg import Coefficients, Components
from .profile import ShipProfile

FloatArray = npt.NDArray[np.float64]


class Model:
    """The components of a profile and their coefficients as one column of numbers.

    Simulators take a matrix with one row per number (a table has several) and one column per candidate, so that
    any coefficient can differ between lanes.
    """

    def __init__(self, profile: ShipProfile):
        self.profile = profile
        self.parts: tuple[Component, ...] = tuple(profile.sections[kind].component for kind in KINDS)
        self.components = Components(*(part.function for part in self.parts[1:]))
        self.rows: dict[str, int] = {}
        numbers: list[float] = []
        for kind in KINDS:
            for symbol, coefficient in profile.sections[kind].coefficients.items():
                value = coefficient.value
                values = value if isinstance(value, tuple) else (value,)
                for k, number in enumerate(values):
                    name = f"{kind}.{symbol}[{k}]" if isinstance(value, tuple) else f"{kind}.{symbol}"
                    self.rows[name] = len(numbers)
                    numbers.append(number)
        self.base: FloatArray = np.array(numbers)

    @property
    def tags(self) -> tuple[str, ...]:
        """The components in use, which is all a compiled simulator depends on."""
        return tuple(f"{part.kind}:{part.tag}" for part in self.parts)

    @cached_property
    def L_pp(self) -> float:
        """Length between perpendiculars [m]."""
        return self.profile.L_pp

    def matrix(self, names: Sequence[str] = (), values: npt.ArrayLike | None = None) -> FloatArray:
        """Coefficients of candidates: ``values`` (n_names, n_candidates) for ``names``, the profile's elsewhere.

        -> (n_rows, n_candidates); one column where there are no names.  Raises KeyError for an unknown name.
        """
        if values is None:
            return self.base[:, None].copy()
        changed = np.asarray(values, dtype=float)
        theta = np.repeat(self.base[:, None], changed.shape[1], axis=1)
        theta[[self.rows[name] for name in names]] = changed
        return theta

    def coefficients(self, theta: FloatArray) -> Coefficients:
        """The tuples the equations take, with lanes of shape (n_candidates,) out of a (n_rows, n_candidates) matrix."""
        row = 0
        tuples: list[Any] = []
        for part in self.parts:
            fields: list[Any] = []
            for field in part.fields.values():
                fields.append(tuple(theta[row : row + field.table]) if field.table else theta[row])
                row += field.table or 1
            tuples.append(part.params(*fields))
        return Coefficients(*tuples)
