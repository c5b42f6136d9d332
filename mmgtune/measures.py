"""Seven distances between a measured and a simulated trajectory (Mathioudakis et al., eq. 10-16).

All take (n_samples, 6) arrays of x, y [m], psi [rad], u, v_m [m/s], r [rad/s] and leave out samples with a gap.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray

UNITS = {"MMD": "m", "MED": "m", "ASD": "mixed", "MSD": "mixed", "PMD": "%", "PED": "%", "cVDM": "%"}
"""Unit of each measure; "mixed" adds metres, radians and their rates as they are."""


@dataclass(frozen=True)
class Reference:
    """What cVDM is relative to, of the measured trajectory.

    length  path length [m]
    speed   mean speed [m/s]
    r_max   the ship's largest yaw rate [rad/s]; the paper has 0.0314 for its ship
    """

    length: float
    speed: float
    r_max: float


def reference_of(measured: FloatArray, r_max: float | None = None) -> Reference:
    """Path length and mean speed of a measured trajectory (n_samples, 6), and its largest yaw rate where none is given.

    Raises ValueError where fewer than two samples are complete or the ship does not move.
    """
    whole = measured[~np.isnan(measured).any(axis=1)]
    if len(whole) < 2:
        raise ValueError("fewer than two complete samples")
    length = float(np.sum(np.hypot(*np.diff(whole[:, :2], axis=0).T)))
    speed = float(np.mean(np.hypot(whole[:, 3], whole[:, 4])))
    r = float(np.abs(whole[:, 5]).max()) if r_max is None else r_max
    if min(length, speed, r) <= 0.0:
        raise ValueError("the measured ship does not move: relative distances do not exist")
    return Reference(length, speed, r)


def distance_measures(measured: FloatArray, simulated: FloatArray, reference: Reference) -> dict[str, float]:
    """All seven measures by name, (n_samples, 6) each; units in ``UNITS``.

    Headings are compared as they are: both unwrapped.  PMD and PED divide by the measured coordinates, so they depend
    on where the origin is; the paper's denominator of PMD can be zero or negative, and the sum of absolute values is
    used instead.  Raises ValueError where shapes differ or no sample is complete.
    """
    if measured.shape != simulated.shape or measured.ndim != 2 or measured.shape[1] != 6:
        raise ValueError(f"shapes {measured.shape} and {simulated.shape} are not (n_samples, 6) both")
    whole = ~(np.isnan(measured).any(axis=1) | np.isnan(simulated).any(axis=1))
    if not whole.any():
        raise ValueError("no complete sample to compare")
    d = np.abs(simulated[whole] - measured[whole])
    dx, dy, dpsi, du, dv, dr = d.T
    four, pose = d[:, :4], measured[whole, :4]
    return {
        "MMD": float(np.mean(dx + dy)),
        "MED": float(np.mean(np.hypot(dx, dy))),
        "ASD": float(np.mean(np.sum(d, axis=1))),
        "MSD": float(np.mean(np.sqrt(np.sum(d * d, axis=1)))),
        "PMD": 100.0 * _mean_share(np.sum(four, axis=1), np.sum(np.abs(pose), axis=1)),
        "PED": 100.0 * _mean_share(np.sqrt(np.sum(four**2, axis=1)), np.sqrt(np.sum(pose**2, axis=1))),
        "cVDM": 100.0
        * float(
            np.mean((dx + dy) / reference.length + dpsi / np.pi + (du + dv) / reference.speed + dr / reference.r_max)
        ),
    }


def _mean_share(part: FloatArray, whole: FloatArray) -> float:
    """Mean of part / whole over samples where the whole is not zero."""
    some = whole > 0.0
    return float(np.mean(part[some] / whole[some])) if some.any() else float("nan")
