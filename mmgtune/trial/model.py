"""A trial in memory."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Trial:
    """One manoeuvre: time, motion, inputs, and what is known about them.  All arrays (n_samples,), read-only.

    id         unique within a data set
    source     "measured", "generated", or "" where the file does not say
    t          time [s], strictly increasing
    x, y       midship position, north and east [m]; NaN in gaps, as in all motion channels
    psi        heading [rad], unwrapped
    u, v_m     velocity over ground in ship axes at midship [m/s]
    r          yaw rate [rad/s]
    n, delta   propeller revolutions [1/s], rudder angle [rad]
    extra      further columns by name
    noise      standard deviations of sensor noise by file column, where known
    """

    id: str
    ship: str
    manoeuvre: str
    source: str
    t: FloatArray
    x: FloatArray
    y: FloatArray
    psi: FloatArray
    u: FloatArray
    v_m: FloatArray
    r: FloatArray
    n: FloatArray
    delta: FloatArray
    extra: dict[str, FloatArray] = field(default_factory=dict)
    noise: dict[str, float] = field(default_factory=dict)
    note: str = ""
    path: Path | None = None
    sha256: str = ""

    def __post_init__(self) -> None:
        for name in ("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta"):
            column = np.array(getattr(self, name), dtype=np.float64)
            if column.shape != (len(self.t),):
                raise ValueError(f"{name} has shape {column.shape}, t has {len(self.t)} samples")
            column.setflags(write=False)
            object.__setattr__(self, name, column)

    @property
    def n_samples(self) -> int:
        """Number of samples."""
        return len(self.t)

    @property
    def duration(self) -> float:
        """Time from the first sample to the last [s]."""
        return float(self.t[-1] - self.t[0])

    @property
    def motion(self) -> FloatArray:
        """(n_samples, 6) x, y, psi, u, v_m, r."""
        return np.column_stack([self.x, self.y, self.psi, self.u, self.v_m, self.r])
