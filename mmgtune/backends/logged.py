"""What the log says to every lane: inputs and surroundings at any share of a step between samples."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..model import Model
from ..physics.integration import between
from ..physics.quantities import HELD, Surroundings
from .cases import Cases

AT_ONCE = 256
"""Steps for which an input is read later in the log in one go."""


class Logged:
    """Inputs and surroundings of n_cases * n_candidates lanes, candidates of a case side by side.

    shift  for each input (n_lanes,) how late its log is [s], None where no lane's is
    """

    def __init__(self, model: Model, cases: Cases, n_candidates: int, shift: Sequence[FloatArray | None]):
        self.control = model.arrangement.control
        self.cases = cases
        self.n_candidates = n_candidates
        self.shift = shift
        self._read: dict[tuple[float, int], tuple[int, FloatArray]] = {}

    def per_lane(self, values: FloatArray) -> FloatArray:
        """(n_lanes,) of (n_cases,)."""
        return np.repeat(values, self.n_candidates)

    def inputs(self, k: int, f: float) -> Any:
        """The inputs at the share f of the step that ends at sample k."""
        return self.control(*(self._input(k, f, column) for column in range(self.cases.controls.shape[2])))

    def around(self, k: int, f: float) -> Surroundings:
        """The surroundings there."""
        found = between(self.cases.around[:, k - 1], self.cases.around[:, k], f)
        for name in HELD:
            column = Surroundings._fields.index(name)
            found[:, column] = self.cases.around[:, k, column]
        return Surroundings(*(self.per_lane(values) for values in found.T))

    def _input(self, k: int, f: float, column: int) -> FloatArray:
        cases, shift = self.cases, self.shift[column]
        value = self.per_lane(between(cases.controls[:, k - 1, column], cases.controls[:, k, column], f))
        if shift is None:
            return value
        first, read = self._read.get((f, column), (k, value[:0]))
        if not 0 <= k - first < len(read):
            end = min(k + AT_ONCE, cases.t.shape[1]) if f > 0.0 else k + 1  # a run begins once
            first, read = k, self._shifted(shift, column, f, k, end)
            self._read[f, column] = first, read
        return np.where(shift == 0.0, value, read[k - first])

    def _shifted(self, shift: FloatArray, column: int, f: float, first: int, end: int) -> FloatArray:
        """An input read later in the log, (end - first, n_lanes), at the share f of the steps that end at samples from
        first to before end."""
        cases = self.cases
        late = shift.reshape(len(cases), -1)
        time = between(cases.t[:, first - 1 : end - 1], cases.t[:, first:end], f)
        moved = [
            np.interp(time[case][:, None] + late[case], cases.t[case, :n], cases.controls[case, :n, column])
            for case, n in enumerate(cases.n_samples)
        ]
        return np.concatenate(moved, axis=1)
