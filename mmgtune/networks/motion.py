"""What networks see of a ship, and how she gets on: shared by all kinds, as pure functions of NumPy alone.

Training differentiates them rebuilt on JAX.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..physics.frame import to_ship
from ..physics.integration import after_step
from ..physics.kinematics import pose_rate

Array = Any
"""An array of NumPy or of JAX, of any number type."""

SIDES = (1.0, -1.0, -1.0)
"""Velocities and accelerations where port and starboard change places: surge stays, sway and yaw change sign."""


def mirror(roles: Sequence[str]) -> Array:
    """(n_features,) -1 for what is ``observed`` and changes sign where port and starboard change places, else 1.

    roles  of the inputs; a rudder or a thruster then acts to the other side
    """
    inputs = [-1.0 if role in ("rudder", "thruster") else 1.0 for role in roles]
    return np.array([*SIDES, *inputs, 1.0, -1.0])


def observed(states: Array, controls: Array, wind: Array) -> Array:
    """(..., n_features): u, v_m, r, the inputs, apparent wind ahead and to starboard, in SI.

    states    (..., 6) x, y [m], psi [rad], u, v_m [m/s], r [rad/s]
    controls  (..., n_inputs)
    wind      (..., 2) velocity of the air over ground, north and east [m/s]

    The vector of the apparent wind points to where it comes from.
    Wakita et al. 2022, eq. 7; Wakita, Akimoto and Maki, eq. 1 and 11.
    """
    ahead, starboard = to_ship(states[..., 2], wind[..., 0], wind[..., 1])
    from_ahead = states[..., 3] - ahead
    from_starboard = states[..., 4] - starboard
    blows = np.stack([from_ahead, from_starboard], axis=-1)
    return np.concatenate([states[..., 3:6], controls, blows], axis=-1)


def moved(states: Array, rates: Array, h: Array) -> Array:
    """States (..., 6) after a step of h [s] of Euler's method at these accelerations (..., 3).

    h  a number, or an array that broadcasts with (..., 6)
    """
    psi, u, v_m, r = states[..., 2], states[..., 3], states[..., 4], states[..., 5]
    north, east, turning = pose_rate(psi, u, v_m, r)
    pose = np.stack([north, east, turning], axis=-1)
    return after_step(states, h, np.concatenate([pose, rates], axis=-1))
