"""Values of each run around a common mean: how much they explain once they are integrated out.

Ten currents of ten runs would explain something by chance alone, and twenty free parameters are not what a crew means
by "the current differed".  So values are drawn from a normal distribution of unknown mean and spread; what counts is
the likelihood of mean and spread, the values themselves integrated out (a random-effects model: Laird & Ware 1982,
Biometrics 38, 963-974).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray

STEPS = 24
"""Number of spreads tried, from one too small to matter to one so large that it does not constrain the values."""

ROUGHLY = 8
"""Number of spreads tried for simulated data, of which there are thousands of sets."""

ROUNDING = 1e-13
"""Share of the largest variance of noise below which another one is not told from none."""

SAME = 1e-7
"""Directions shorter than this share of the longest are numerical noise."""


@dataclass(frozen=True, eq=False)
class Spread:
    """What a hierarchy makes of residuals.

    gain    twice the logarithm of the likelihood, over that of no effect, at the best mean and spread
    spread  that spread, in the unit of the values
    volume  of it, what the integration costs: ln det (V / noise)
    values  (n_groups * n_parameters,) the most probable values
    """

    gain: float
    spread: float
    volume: float
    values: FloatArray


class Hierarchy:
    """The linear problem r = -A b + noise, with b = X m + u, u normal of one spread.

    shown  (k, n_groups * n_parameters) A in an orthonormal basis of its columns, group by group
    noise  (k, k) covariance of the residual there
    n_parameters  of a group
    """

    def __init__(self, shown: FloatArray, noise: FloatArray, n_parameters: int):
        variances, axes = np.linalg.eigh(noise)
        # What one log of the inputs leaves open may be so much that the rest drowns in rounding.
        self._whiten = (axes / np.sqrt(np.maximum(variances, ROUNDING * variances[-1]))).T
        A = self._whiten @ shown
        self._A = A
        self._X = np.tile(np.eye(n_parameters), (A.shape[1] // n_parameters, 1))
        U, length, _ = np.linalg.svd(A, full_matrices=False)
        kept = length > SAME * length.max(initial=1e-300)
        self._U, self._square = U[:, kept], length[kept] ** 2
        self._rest = len(A) - int(kept.sum())
        self._M = self._U.T @ A @ self._X

    def spreads(self, n: int) -> FloatArray:
        """Spreads worth trying, none first."""
        if not len(self._square):
            return np.zeros(1)
        low, high = 0.3 / np.sqrt(self._square.max()), 30.0 / np.sqrt(self._square.min())
        return np.concatenate([[0.0], np.geomspace(low, max(high, 1e3 * low), n)])

    def gains(self, data: FloatArray, spreads: FloatArray) -> FloatArray:
        """(n_spreads, n_draws) gain of data (k, n_draws), each with its best mean."""
        d = self._U.T @ (self._whiten @ data)
        square = np.sum(d**2, axis=0)
        found = np.empty((len(spreads), d.shape[1]))
        for i, spread in enumerate(spreads):
            weight = 1.0 / (1.0 + spread**2 * self._square)
            left = np.sum(weight[:, None] * d**2, axis=0)
            pull = self._M.T @ (weight[:, None] * d)
            stiff = self._M.T @ (weight[:, None] * self._M)
            left -= np.sum(pull * (np.linalg.pinv(stiff, rcond=1e-9, hermitian=True) @ pull), axis=0)
            found[i] = square - left + np.sum(np.log(weight))
        return found

    def best(self, data: FloatArray) -> Spread:
        """The best mean and spread for data (k,)."""
        spreads = self.spreads(STEPS)
        at = int(np.argmax(self.gains(data[:, None], spreads)[:, 0]))
        near = spreads[max(at - 1, 0)], spreads[min(at + 1, len(spreads) - 1)]
        finer = np.concatenate([[spreads[at]], np.linspace(*near, STEPS)])
        gains = self.gains(data[:, None], finer)[:, 0]
        spread = float(finer[int(np.argmax(gains))])
        weight = 1.0 / (1.0 + spread**2 * self._square)
        return Spread(float(gains.max()), spread, float(-np.sum(np.log(weight))), self._values(data, spread, weight))

    def _values(self, data: FloatArray, spread: float, weight: FloatArray) -> FloatArray:
        d = self._U.T @ (self._whiten @ data)
        stiff = self._M.T @ (weight[:, None] * self._M)
        mean = -np.linalg.pinv(stiff, rcond=1e-9, hermitian=True) @ (self._M.T @ (weight * d))
        off = self._A.T @ (self._U @ (weight * (d + self._M @ mean)))
        return np.asarray(self._X @ mean - spread**2 * off)
