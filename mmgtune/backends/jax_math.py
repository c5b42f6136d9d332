"""NumPy's names on JAX, for twins: ``jax.numpy``, with roots and angles whose derivatives are finite everywhere.

A ship at rest has speed 0, and a square root or an angle has no derivative there; JAX then gives NaN, which spreads to
every coefficient.  Values are those of ``jax.numpy``; only derivatives at the one point are set, to 0, which is what a
central difference finds of a speed or of an angle that jumps.
"""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp


def sqrt(x: Any) -> Any:
    """Square root, of derivative 0 at 0."""
    none = jnp.equal(x, 0.0)
    return jnp.where(none, 0.0 * x, jnp.sqrt(jnp.where(none, 1.0, x)))


def hypot(a: Any, b: Any) -> Any:
    """Length of a vector, of derivative 0 at its origin."""
    return sqrt(jnp.square(a) + jnp.square(b))


def arctan2(y: Any, x: Any) -> Any:
    """Angle of the point (x, y), of derivative 0 at the origin, where its value is still that of the signed zeros."""
    origin = jnp.equal(jnp.square(x) + jnp.square(y), 0.0)  # where JAX would divide by that
    there = jax.lax.stop_gradient(jnp.arctan2(y, x))
    return jnp.where(origin, there, jnp.arctan2(jnp.where(origin, 0.0, y), jnp.where(origin, 1.0, x)))


def __getattr__(name: str) -> Any:
    return getattr(jnp, name)
