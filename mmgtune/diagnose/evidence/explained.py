"""How much of a residual one variable alone explains."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from ...arrays import FloatArray, IntArray
from .forces import ResidualForces

NODES = 5
"""Nodes of the function fitted to a variable: four degrees of freedom beside the mean, for every variable."""

BLOCK = 60.0
"""Length of the blocks of residual forces of trials [s]."""

FEWEST_BLOCKS = 3
"""Blocks below which nothing can be predicted from the others."""

BLOCKS = 20
"""Number of blocks where the caller names none."""


def share_explained(
    y: FloatArray,
    variables: Mapping[str, FloatArray],
    periodic: Sequence[str] = ("heading",),
    *,
    blocks: npt.ArrayLike | None = None,
    weights: npt.ArrayLike | None = None,
) -> dict[str, float]:
    """Share of the variance of a residual that a smooth function of each variable alone predicts.

    y          (n,) residual, in order of time within each trial, trials one after the other; NaN is left out
    variables  (n,) each, by name; where one is not finite, its unknown values form a level of their own
    periodic   those that are angles [rad] of which a full turn is the same
    blocks     (n,) labels: samples of one label are predicted from all others.  Twenty runs of equal length unless
               told; a block should be much longer than the residual is correlated
    weights    (n,) of squares, best the reciprocal of the noise's variance; positive; equal unless told

    -> 1 - (squared error of prediction) / (that of predicting the mean), by variable.  What is predicted was never
    used for the prediction, so that noise, also correlated noise, gives 0 or a little less, and not what the degrees
    of freedom buy.  0 for a residual without variance.

    The function is linear between five nodes: at quantiles of the variable and constant beyond the outer ones, or
    equally spaced round the turn.

    Raises ValueError where lengths differ, weights are not positive, or samples are in fewer than three blocks.
    """
    y = np.asarray(y, dtype=float)
    label = np.arange(len(y)) * BLOCKS // max(len(y), 1) if blocks is None else np.asarray(blocks)
    weight = np.ones(len(y)) if weights is None else np.asarray(weights, dtype=float)
    for name, values in {"blocks": label, "weights": weight, **variables}.items():
        if np.shape(values) != y.shape:
            raise ValueError(f"{name} has shape {np.shape(values)}, the residual {y.shape}")
    used = np.isfinite(y)
    _, member = np.unique(label[used], return_inverse=True)
    if not used.any() or member.max() + 1 < FEWEST_BLOCKS:
        raise ValueError(f"the residual is known in fewer than {FEWEST_BLOCKS} blocks")
    y, weight = y[used], weight[used]
    if not (np.isfinite(weight) & (weight > 0.0)).all():
        raise ValueError("weights are not all positive")
    weight = weight / weight.mean()
    return {
        name: _predicted(y, _basis(np.asarray(values, dtype=float)[used], name in periodic), member, weight)
        for name, values in variables.items()
    }


def explain_forces(forces: Sequence[ResidualForces]) -> dict[str, dict[str, float]]:
    """Shares of the residual forces of trials together that each of ``ResidualForces.variables`` explains.

    -> {"dX": {"heading": share, ...}, "dY", "dN", "dX'", "dY'", "dN'"}, each residual weighed by its noise

    A force like that of wind is a function in newtons, one like the hull's in prime values: what is behind a residual
    shows best in the one or the other.

    Raises ValueError for no trials, and where these last fewer than three blocks.
    """
    if not forces:
        raise ValueError("there are no trials")
    parts = [f.variables for f in forces]
    variables = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    blocks = _blocks(forces)
    return {
        name: share_explained(values, variables, blocks=blocks, weights=_weights(noise))
        for name, values, noise in _pooled(forces)
    }


def can_be_explained(forces: Sequence[ResidualForces]) -> bool:
    """Whether trials last long enough together for ``explain_forces``."""
    return bool(forces) and len(np.unique(_blocks(forces))) >= FEWEST_BLOCKS


def _blocks(forces: Sequence[ResidualForces]) -> IntArray:
    """(n,) label of each sample: trials one after the other, each in blocks."""
    numbers = [np.floor((f.time - f.time[0]) / BLOCK).astype(int) for f in forces]
    firsts = np.cumsum([0, *(number[-1] + 1 for number in numbers[:-1])])
    return np.concatenate([number + first for number, first in zip(numbers, firsts, strict=True)])


def noise_share(forces: Sequence[ResidualForces]) -> dict[str, float]:
    """Share of the same residuals' variance that is noise of the sensors: what no variable can explain.

    About 1 where there is nothing but noise.

    Raises ValueError for no trials.
    """
    if not forces:
        raise ValueError("there are no trials")
    shares = {}
    for name, values, noise in _pooled(forces):
        weight = _weights(noise)
        spread = np.sum(weight * (values - np.average(values, weights=weight)) ** 2)
        shares[name] = float(np.sum(weight * noise * noise) / spread) if spread > 0.0 else 0.0
    return shares


def _pooled(forces: Sequence[ResidualForces]) -> list[tuple[str, FloatArray, FloatArray]]:
    """Name, values and deviation of the noise, (n,) each, of each residual of all trials."""
    pooled = [
        np.concatenate([getattr(f, name) for f in forces]).T for name in ("force", "noise", "prime", "prime_noise")
    ]
    force, noise, prime, prime_noise = pooled
    SI = [(f"d{axis}", force[k], noise[k]) for k, axis in enumerate("XYN")]
    return SI + [(f"d{axis}'", prime[k], prime_noise[k]) for k, axis in enumerate("XYN")]


def _weights(noise: FloatArray) -> FloatArray:
    """Reciprocal variances; equal where there is no noise at all."""
    largest = float(noise.max())
    return 1.0 / np.maximum(noise / largest, 1e-3) ** 2 if largest > 0.0 else np.ones(len(noise))


def _basis(values: FloatArray, periodic: bool) -> FloatArray:
    """(n, NODES + 1) weights of the nodes of a function linear between them; the last is 1 where it is unknown."""
    known = np.isfinite(values)
    basis = np.zeros((len(values), NODES + 1))
    basis[~known, NODES] = 1.0
    if not known.any():
        return basis
    if periodic:
        place = np.mod(values[known], 2.0 * np.pi) / (2.0 * np.pi) * NODES
        nodes, hats = np.arange(NODES + 1.0), np.eye(NODES)[[*range(NODES), 0]]
    else:
        place = values[known]
        nodes = np.unique(np.quantile(place, np.linspace(0.01, 0.99, NODES)))
        hats = np.eye(NODES)[: len(nodes)]
    for k in range(NODES):
        basis[known, k] = np.interp(place, nodes, hats[:, k])
    return basis


def _predicted(y: FloatArray, basis: FloatArray, member: npt.NDArray[np.intp], weight: FloatArray) -> float:
    """Share of variance predicted for each block from all others; nodes that others do not know stay at the mean."""
    n_blocks = int(member.max()) + 1
    order = np.argsort(member, kind="stable")
    rows_of = np.split(order, np.searchsorted(member[order], np.arange(1, n_blocks)))

    def others(values: FloatArray) -> FloatArray:
        """(n_blocks, ...) sums of (n, ...) over all samples but those of each block."""
        own = np.zeros((n_blocks, *values.shape[1:]))
        for block, rows in enumerate(rows_of):
            own[block] = values[rows].sum(axis=0)
        return np.asarray(own.sum(axis=0) - own)

    weighed = basis * weight[:, None]
    sums, total = others(weighed), others(weight)
    mean = others(weight * y) / total
    products = others(weighed[:, :, None] * basis[:, None, :]) + np.eye(basis.shape[1])
    right = others(weighed * y[:, None]) - mean[:, None] * sums
    nodes = np.linalg.solve(products, right[:, :, None])[:, :, 0]
    centred = y - mean[member]
    spread = float(np.sum(weight * centred**2))
    error = float(np.sum(weight * (centred - np.sum(basis * nodes[member], axis=1)) ** 2))
    return 1.0 - error / spread if spread > 0.0 else 0.0
