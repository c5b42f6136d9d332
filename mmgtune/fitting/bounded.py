"""Minimisation of convex quadratics within the unit cube."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray

MOST_CHANGES = 12
"""Rounds in which small problems choose again what is held at a bound, before they are solved one by one."""


def bounded_step(
    hessian: FloatArray, gradient: FloatArray, z: FloatArray, start: FloatArray | None = None
) -> FloatArray:
    """The point of the unit cube that minimises a convex quadratic around z, by an active-set method.

    Moves towards the minimum over the free coordinates up to the first bound, holds what met it, and releases a held
    coordinate once its slope points inwards.

    start  a point of the cube to begin at, such as the solution for another damping: most bounds are then known
    """
    n = len(z)
    point = z.copy() if start is None else start.copy()
    slope = gradient + hessian @ (point - z)
    held = ((point <= 0.0) & (slope > 0.0)) | ((point >= 1.0) & (slope < 0.0))
    for _ in range(3 * n):
        free = np.flatnonzero(~held)
        slope = gradient + hessian @ (point - z)
        if len(free):
            try:
                step = -np.linalg.solve(hessian[np.ix_(free, free)], slope[free])
            except np.linalg.LinAlgError:
                step = -np.linalg.lstsq(hessian[np.ix_(free, free)], slope[free], rcond=None)[0]
            room = np.where(step > 0.0, 1.0 - point[free], point[free])
            share = float(np.min(room / np.maximum(np.abs(step), 1e-300)))
            if share < 1.0:
                point[free] += share * step
                met = free[room <= share * np.abs(step) * (1.0 + 1e-12)]
                point[met] = np.where(point[met] > 0.5, 1.0, 0.0)
                held[met] = True
                continue
            point[free] += step
            slope = gradient + hessian @ (point - z)
        inwards = np.where(held & (point <= 0.0), -slope, np.where(held, slope, 0.0))
        if inwards.max() <= 1e-14 * np.abs(gradient).max():
            break
        held[int(np.argmax(inwards))] = False
    return np.clip(point, 0.0, 1.0)


def bounded_steps(hessian: FloatArray, gradient: FloatArray, z: FloatArray) -> FloatArray:
    """``bounded_step`` of k small problems at once, hessian (k, n, n), gradient and z (k, n) -> (k, n).

    What leaves the cube is held at its end, what is held and pulled inwards is let go, all at once, until nothing
    changes (Hintermueller, Ito & Kunisch 2003, a primal-dual active set); the few that cycle go one by one.
    """
    own = np.eye(z.shape[1])
    side = np.zeros(z.shape, dtype=int)
    for _ in range(MOST_CHANGES):
        held = side != 0
        to_end = np.where(held, (side > 0) - z, 0.0)
        pull = gradient + (hessian @ to_end[..., None])[..., 0]
        within = np.where(held[:, :, None] | held[:, None], own * held[:, None], hessian)
        step = to_end - np.linalg.solve(within, np.where(held, 0.0, pull)[..., None])[..., 0]
        slope = gradient + (hessian @ step[..., None])[..., 0]
        leaving = (z + step > 1.0).astype(int) - (z + step < 0.0)
        new = np.where(held, np.where(side * slope < 0.0, side, 0), leaving)
        changed = np.any(new != side, axis=1)
        side = new
        if not changed.any():
            return np.clip(np.where(held, side > 0, z + step), 0.0, 1.0)
    found = np.where(side != 0, side > 0, z + step).astype(float)
    for k in np.flatnonzero(changed):
        found[k] = bounded_step(hessian[k], gradient[k], z[k])
    return np.asarray(np.clip(found, 0.0, 1.0))
