"""Runs without a trial behind them: inputs made by hand, simulated by either back end."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from mmgtune.backends import Cases, Integrator, get_backend, pad
from mmgtune.model import Model
from mmgtune.physics.quantities import Surroundings

FloatArray = npt.NDArray[np.float64]


def driven(model: Model, n: npt.ArrayLike, delta: npt.ArrayLike) -> FloatArray:
    """(n_samples, n_inputs) with n to every propeller and delta to every rudder, (n_samples,) each; thrusters rest."""
    by_role = {"propeller": np.asarray(n, dtype=float), "rudder": np.asarray(delta, dtype=float)}
    at_rest = 0.0 * by_role["rudder"]
    return np.column_stack([by_role.get(one.role, at_rest) for one in model.arrangement.inputs])


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
    controls = driven(model, np.full(len(t), approach.n if n is None else n), np.full(len(t), np.radians(degrees)))
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
    return result.states


def measured(
    t: FloatArray, depth: FloatArray | None = None, **around: tuple[FloatArray | float, FloatArray | float]
) -> FloatArray:
    """(n_samples, n_surroundings) measured at t (n_samples,): depth, and north and east of wind, current or wave."""
    found = np.zeros((len(t), len(Surroundings._fields)))
    at = Surroundings._fields.index
    if depth is not None:
        found[:, at("depth")], found[:, at("depth_known")] = depth, 1.0
    for name, components in around.items():
        found[:, at(f"{name}_known")] = 1.0
        for axis, values in zip(("north", "east"), components, strict=True):
            found[:, at(f"{name}_{axis}")] = values
            if name == "current":
                found[1:, at(f"{name}_{axis}_rate")] = np.diff(found[:, at(f"{name}_{axis}")]) / np.diff(t)
    return found
