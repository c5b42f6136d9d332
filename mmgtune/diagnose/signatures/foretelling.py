"""Predicted gain of a step of a hypothesis from a start, before anything is refitted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...arrays import BoolArray, FloatArray
from ..bench.hypotheses import Hypothesis
from ..bench.workbench import Point, Workbench
from .beside import free_with
from .linear import Linear

NEARBY = 1e-5
"""Step of derivatives by the parameters of a hypothesis at its start, in the unit cube."""

SHARES = (1.0, 0.3, 0.1)
"""Shares of a step at which it is tried: far from any fit it may lead too far."""


class Foretelling:
    """Steps of some hypotheses from starts, by their own derivatives there and by those of what is free at a point,
    initial states among it, taken at the point without any of them."""

    def __init__(self, bench: Workbench, point: Point, linear: Linear, asked: Sequence[Hypothesis]):
        names = tuple(dict.fromkeys((*point.names, *(name for one in asked for name in one.names))))
        self._bench, self._point, self._linear = bench, point, linear
        self._null = dict(zip(names, bench.null(names), strict=True))
        self._here = self._null | dict(zip(point.names, point.unit, strict=True))
        own = bench.problem_of(names, point.integrator).with_offsets(point.offsets)
        here = np.array([*self._here.values()])[:, None]
        self._problem, self._as_it_is = bench.by_slopes(own), bench.by_slopes(own).residuals(here)[0]
        if not np.isfinite(self._as_it_is).all():  # the other method diverges here
            self._problem, self._as_it_is = own, own.residuals(here)[0]

    def _simulated(self, columns: Sequence[Mapping[str, float]]) -> tuple[FloatArray, BoolArray]:
        """Residuals with re-tuning projected out (n_rows, k), and which runs diverge."""
        runs = self._problem.residuals(np.array([[*column.values()] for column in columns]).T).T
        lost = np.asarray(~np.isfinite(runs).all(axis=0))
        runs[:, lost] = self._as_it_is[:, None]
        change = self._bench.noise.apply(runs - self._as_it_is[:, None])
        return self._linear.residual[:, None] + self._linear.retuned(change), lost

    def _at(self, hypothesis: Hypothesis, start: FloatArray) -> dict[str, float]:
        """All names with a start (n_names,) of a hypothesis and what is free beside it."""
        gone = {name: self._null[name] for name in hypothesis.instead if name in self._here}
        return self._here | gone | dict(zip(free_with(self._point, hypothesis), start.tolist(), strict=True))

    def _steps(self, hypothesis: Hypothesis, starts: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """From starts (n_names, n_starts): the step of the own parameters (n_own, n_starts), within the cube,
        chi-squared at the starts, inf where a run diverges, and the predicted chi-squared."""
        own = hypothesis.names
        columns: list[Mapping[str, float]] = []
        for start in starts.T:
            there = self._at(hypothesis, start)
            columns += [there, *(there | {name: there[name] + float(_inside(there[name]))} for name in own)]
        left, lost = self._simulated(columns)
        left = left.reshape(len(left), starts.shape[1], 1 + len(own))
        lost = lost.reshape(starts.shape[1], 1 + len(own))
        steps = np.zeros((len(own), starts.shape[1]))
        before, after = np.full((2, starts.shape[1]), np.inf)
        for k, start in enumerate(starts[-len(own) :].T):
            base = left[:, k, 0]
            if lost[k, 0]:
                continue
            slopes = np.where(lost[k, 1:], 0.0, (left[:, k, 1:] - base[:, None]) / _inside(start))
            step = np.linalg.lstsq(slopes, -base, rcond=1e-6)[0]
            steps[:, k] = np.clip(start + step, 0.0, 1.0) - start
            end = base + slopes @ steps[:, k]
            before[k], after[k] = base @ base, end @ end
        return steps, before, after

    def left(self, hypothesis: Hypothesis, starts: FloatArray) -> FloatArray:
        """Chi-squared (n_starts,) that a step from each start (n_names, n_starts) would leave; inf where a run is lost,
        0 of all where the point itself is.
        """
        if not np.isfinite(self._as_it_is).all():
            return np.zeros(starts.shape[1])
        _, before, after = self._steps(hypothesis, starts)
        return np.minimum(before, after)

    def tried(self, hypothesis: Hypothesis, starts: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Where a step from each start leads, (n_names, n_starts), and chi-squared (n_starts,) there: of the whole
        step, of shares of it and of none the best; as ``left`` where a run is lost."""
        if not np.isfinite(self._as_it_is).all():
            return starts, np.zeros(starts.shape[1])
        steps, before, _ = self._steps(hypothesis, starts)
        n_own = len(steps)
        places = np.repeat(starts[:, :, None], len(SHARES), axis=2)
        places[-n_own:] += steps[:, :, None] * np.array(SHARES)
        left, lost = self._simulated([self._at(hypothesis, place) for place in places.reshape(len(starts), -1).T])
        chi2 = np.where(lost, np.inf, np.sum(left**2, axis=0)).reshape(starts.shape[1], len(SHARES))
        places = np.concatenate([places, starts[:, :, None]], axis=2)
        chi2 = np.column_stack([chi2, before])
        best = np.argmin(chi2, axis=1)
        every = np.arange(starts.shape[1])
        return places[:, every, best], chi2[every, best]


def _inside(z: FloatArray | float) -> FloatArray:
    """The step of derivatives at a place in the unit cube, inwards where that is its upper end."""
    return np.where(np.asarray(z) + NEARBY > 1.0, -NEARBY, NEARBY)
