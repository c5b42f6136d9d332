"""The two losses of Wakita et al. 2022, on windows of the samples."""

from __future__ import annotations

from typing import Any

from ..backends.twins import jax_module
from ..networks.recurrent import Scales, Weights
from .rolling import follow, roll


def trajectory_loss(
    w: Weights,
    scales: Scales,
    states: Any,
    controls: Any,
    wind: Any,
    h: float,
    memory: int | None,
    sigma: Any,
    signs: Any = None,
) -> Any:
    """Mean square of roll-outs less measured states over ``sigma`` (6,): eq. 24.

    states (T + 1, n, 6), controls (T, n, n_inputs), wind (T, n, 2); signs as of ``roll``
    """
    jnp = jax_module().numpy
    found = roll(w, scales, states[0], controls, wind, h, memory, signs)
    return jnp.mean(((found - states) / sigma)[1:] ** 2)


def acceleration_loss(
    w: Weights,
    scales: Scales,
    states: Any,
    controls: Any,
    wind: Any,
    memory: int | None,
    measured: Any,
    sigma: Any,
    signs: Any = None,
) -> Any:
    """Mean square of accelerations less those of differentiated measurements over ``sigma`` (3,): eq. 17.

    states (T, n, 6), measured (T, n, 3); samples without a measured acceleration do not count
    """
    jnp = jax_module().numpy
    found = follow(w, scales, states, controls, wind, memory, signs)
    there = jnp.isfinite(measured)
    off = jnp.where(there, found - jnp.where(there, measured, 0.0), 0.0) / sigma
    return jnp.sum(off**2) / jnp.maximum(jnp.sum(there), 1)
