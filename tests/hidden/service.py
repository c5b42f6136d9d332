"""The plant in ordinary service: course changes under an autopilot for half an hour, no trial among them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numba import njit

from .plant import STEP, WHITE, Noise, current, driven, logged_revolutions, noisy, rates, toward
from .suzaku import Parameters, coefficients

LEG = 150.0
"""Seconds a course is kept."""

MOST = np.radians(15.0)
"""Largest rudder angle of the autopilot."""


@njit(cache=True)
def keep_courses(s, n_0, psi_0, speed, courses, legs):
    """Sail courses one after the other: rows as ``plant.voyage``, at STEP."""
    per_leg = int(legs / STEP)
    steps = per_leg * len(courses)
    rows = np.zeros((steps + 1, 8))
    z, trying, rate = np.zeros(13), np.zeros(13), np.zeros((4, 13))
    z[2], z[3], z[9] = psi_0, speed, n_0
    gear = order = 0.0
    for k in range(steps + 1):
        t = k * STEP
        aim = psi_0 + courses[min(k // per_leg, len(courses) - 1)]
        if k % 10 == 0:
            order = toward(0.0, 0.8 * (aim - z[2]) - 25.0 * z[5], MOST)
        north, east = current(s, t, z[0])
        rows[k, :3] = z[:3]
        rows[k, 3] = z[3] + north * np.cos(z[2]) + east * np.sin(z[2])
        rows[k, 4] = z[4] - north * np.sin(z[2]) + east * np.cos(z[2])
        rows[k, 5] = z[5]
        rows[k, 6] = logged_revolutions(n_0, z[3], z[4])
        rows[k, 7] = gear
        half = driven(gear, order, s, 0.5 * STEP)
        whole = driven(gear, order, s, STEP)
        rates(s, t, z, gear, 0.0, n_0, rate[0])
        trying[:] = z + 0.5 * STEP * rate[0]
        rates(s, t + 0.5 * STEP, trying, half, 0.0, n_0, rate[1])
        trying[:] = z + 0.5 * STEP * rate[1]
        rates(s, t + 0.5 * STEP, trying, half, 0.0, n_0, rate[2])
        trying[:] = z + STEP * rate[2]
        rates(s, t + STEP, trying, whole, 0.0, n_0, rate[3])
        z += STEP / 6.0 * (rate[0] + 2.0 * rate[1] + 2.0 * rate[2] + rate[3])
        gear = whole
    return rows


def serve(
    folder: Path,
    effects: Sequence[Parameters],
    seed: int,
    noise: Noise = WHITE,
    wind_log: float = 0.0,
    courses: int = 10,
) -> None:
    """Write a voyage for each of ``effects`` to a folder.

    wind_log  factor on the true wind in what is logged of it; 0 where nothing is
    """
    from mmgtune.trial import Trial, write_trial

    for k, hidden in enumerate(effects):
        draw = np.random.default_rng([seed, k])
        s = coefficients({}, hidden)
        n_0, psi_0 = draw.uniform(90.0, 115.0) / 60.0, draw.uniform(-np.pi, np.pi)
        bends = np.cumsum(np.radians(draw.uniform(15.0, 70.0, courses)) * draw.choice((-1.0, 1.0), courses))
        rows = keep_courses(s, n_0, psi_0, 1.75 * n_0, bends, LEG)[:: round(1.0 / STEP)]
        rows = np.column_stack([np.arange(len(rows), dtype=float), rows])
        t, x, y, psi, u, v, r, n, delta = noisy(rows, noise, np.random.default_rng([seed, k, 1])).T.copy()
        extra = {}
        if wind_log:
            extra = {
                "wind_speed": np.full(len(t), wind_log * hidden["wind"]["speed"]),
                "wind_dir": np.full(len(t), hidden["wind"]["direction"]),
            }
        motion = {"x": x, "y": y, "psi": psi, "u": u, "v_m": v, "r": r, "n": n, "delta": delta}
        name = f"voyage_{k + 1:02d}"
        trial = Trial(name, "suzaku", "voyage", "generated", t, **motion, extra=extra)
        write_trial(trial, folder / f"{name}.parquet", overwrite=True)
