"""Residuals of a simulation against a measurement are never independent: first-order autocorrelation taken out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import STATES
from .problem import FitProblem

LARGEST = 0.999
"""Largest autocorrelation assumed; beyond it a trial of some hundred samples says nothing more."""


@dataclass(frozen=True, eq=False)
class Whitening:
    """Per channel: autocorrelation of neighbouring residuals, and the deviation of what is new in each.

    A residual e_k becomes (e_k - phi e_(k-1)) / sigma, the first of a trial sqrt(1 - phi^2) e_1 / sigma.
    """

    phi: dict[str, float]
    sigma: dict[str, float]
    _series: list[tuple[str, IntArray]]

    def apply(self, values: FloatArray) -> FloatArray:
        """Residuals (n_residuals, ...) or their derivatives, whitened."""
        out = np.empty_like(values)
        for channel, rows in self._series:
            phi, sigma = self.phi[channel], self.sigma[channel]
            series = values[rows]
            out[rows[0]] = np.sqrt(1.0 - phi * phi) * series[0] / sigma
            out[rows[1:]] = (series[1:] - phi * series[:-1]) / sigma
        return out


def estimate_whitening(problem: FitProblem, residuals: FloatArray) -> Whitening:
    """Autocorrelation and deviation per channel from residuals (n_residuals,) at the optimum, pooled over trials."""
    series: list[tuple[str, IntArray]] = []
    for case in range(len(problem.cases)):
        for k, channel in enumerate(STATES):
            rows = problem.cases.rows[case, :, k]
            rows = rows[rows >= 0]
            if len(rows):
                series.append((channel, rows))
    phi: dict[str, float] = {}
    sigma: dict[str, float] = {}
    for channel in dict.fromkeys(name for name, _ in series):
        parts = [residuals[rows] for name, rows in series if name == channel]
        lagged = sum(float(part[1:] @ part[:-1]) for part in parts)
        power = sum(float(part[:-1] @ part[:-1]) for part in parts)
        phi[channel] = float(np.clip(lagged / power, 0.0, LARGEST)) if power > 0.0 else 0.0
        new = np.concatenate([part[1:] - phi[channel] * part[:-1] for part in parts])
        sigma[channel] = float(np.sqrt(np.mean(new * new))) if len(new) else 0.0
        sigma[channel] = sigma[channel] or 1e-12
    return Whitening(phi, sigma, series)
