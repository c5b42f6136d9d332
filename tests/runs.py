"""Runs without a trial behind them: inputs made by hand, simulated by either back end."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from mmgtune.backends import Cases, Integrator, get_backend, pad
from mmgtune.model import Model

FloatArray = npt.NDArray[np.float64]


def turn(
    model: Model,
    degrees: float,
    seconds: float = 600.0,
    dt: float = 1.0,
    initial: Sequence[float] | None = None,
    n: float | None = None,
) -> Cases:
    """One case: constant rudder from the start at the profile's approach condition."""
    approach = model.profile.approach
    assert approach is not None
    t = np.arange(round(seconds / dt) + 1) * dt
    controls = np.column_stack([np.full(len(t), approach.n if n is None else n), np.full(len(t), np.radians(degrees))])
    start = np.array([0.0, 0.0, 0.0, approach.speed, 0.0, 0.0] if initial is None else initial, dtype=float)
    return pad([t], [controls], [start])


def states(
    model: Model,
    cases: Cases,
    theta: FloatArray | None = None,
    backend: str = "compiled",
    integrator: Integrator = Integrator(),
) -> FloatArray:
    """States (n_cases, n_candidates, T, 6)."""
    result = get_backend(backend).run(
        model, model.matrix() if theta is None else theta, cases, integrator=integrator, keep_states=True
    )
    assert result.states is not None
    return result.states
