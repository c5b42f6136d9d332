"""Trials made from simple kinematics: a first-order turn, with or without the noise of sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from math import cos, sin
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from mmgtune.errors import TrialError
from mmgtune.trial import Trial, check_trial, read_trial
from mmgtune.trial.model import FloatArray

DEG = np.pi / 180.0
NOISE = {"x": 0.4, "y": 0.4, "psi": 0.17 * DEG, "u": 0.02, "v": 0.02, "r": 0.03 * DEG}


def made(
    id: str = "turn_p20",
    *,
    angle: float = 20.0 * DEG,
    zigzag: bool = False,
    samples: int = 500,
    dt: float = 1.0,
    speed: float = 3.0,
    lag: float = 20.0,
    rudder_rate: float = 2.3 * DEG,
    n: float = 1.7,
    seed: int | None = None,
    **facts: Any,
) -> Trial:
    """A turn, or a zigzag, of a ship whose yaw rate follows the rudder with ``lag`` [s]; noisy where seeded."""
    sailed = _sailed(angle, zigzag, samples, dt, speed, lag, rudder_rate, n)
    columns = dict(zip(("t", "x", "y", "psi", "u", "v", "r", "n", "delta"), sailed.T.copy(), strict=True))
    if seed is not None:
        rng = np.random.default_rng(seed)
        for name, sigma in NOISE.items():
            columns[name] = columns[name] + sigma * rng.standard_normal(samples)
    columns["v_m"] = columns.pop("v")
    told = {"ship": "ketch", "manoeuvre": "zigzag" if zigzag else "turning", "source": "measured", **facts}
    return Trial(id=id, **columns, **told)


@cache
def _sailed(
    angle: float, zigzag: bool, samples: int, dt: float, speed: float, lag: float, rudder_rate: float, n: float
) -> FloatArray:
    """The run without noise, (n_samples, n_channels): many tests begin with the same."""
    fine = 10
    h = dt / fine
    x = y = psi = r = delta = 0.0
    order = angle
    rows = []
    for k in range(samples * fine):
        u, v = speed * (1.0 - 0.3 * abs(r) * lag), -speed * 5.0 * lag / 20.0 * r
        if k % fine == 0:
            rows.append((k * h, x, y, psi, u, v, r, n, delta))
        if zigzag and psi * order > abs(angle * order):
            order = -order
        delta += min(max(order - delta, -rudder_rate * h), rudder_rate * h)
        r += h / lag * (delta / lag - r)
        psi += h * r
        x += h * (u * cos(psi) - v * sin(psi))
        y += h * (u * sin(psi) + v * cos(psi))
    return np.array(rows)


def changed(trial: Trial, name: str, change: Any) -> Trial:
    """A copy with one channel replaced by a function of itself."""
    return replace(trial, **{name: change(np.array(getattr(trial, name)))})


def with_value(trial: Trial, name: str, rows: int | slice | Sequence[int], value: float) -> Trial:
    """A copy with a value put into some rows of one channel."""

    def put(values: FloatArray) -> FloatArray:
        values[rows] = value
        return values

    return changed(trial, name, put)


def write_raw(path: Path, columns: Mapping[str, Any], metadata: bytes | None = None) -> Path:
    """A Parquet file of any columns, right or wrong."""
    table = pa.table(dict(columns))
    pq.write_table(table.replace_schema_metadata({b"mmgtune": metadata} if metadata is not None else None), path)
    return path


def problems_of(path: Path) -> list[str]:
    """What reading the file complains about, each as the user sees it."""
    try:
        read_trial(path)
    except TrialError as error:
        return [str(problem) for problem in error.problems]
    return []


def said(trial: Trial, severity: str = "warning") -> str:
    """All findings of a severity, as text."""
    return "\n".join(f"{f.what} ({f.where}): {f.why}; {f.fix}" for f in check_trial(trial) if f.severity == severity)
