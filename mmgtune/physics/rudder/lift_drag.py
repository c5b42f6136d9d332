"""Lift and drag of a rudder of any section, with stall."""

import numpy as np

from ..elementary import cos, sin

STALL_WIDTH = 0.17
"""Range of the sine of the inflow angle over which lift is lost beyond the stall angle [-]; assumption."""


def lift_and_drag(alpha, aspect, C_Q, C_D0, alpha_stall, stall_loss):
    """C_L and C_D of a rudder: Soding in Brix 1993, Manoeuvring Technical Manual.

    alpha inflow angle [rad]; aspect span^2 / area, C_Q of the cross flow, C_D0 at zero lift [-]; alpha_stall [rad];
    stall_loss share of the circulatory lift lost about 10 deg beyond it [-] (assumption): floats or (n_lanes,).
    """
    sin_a = sin(alpha)
    size = np.abs(sin_a)
    # Counted from the line of the rudder, so that inflow from behind stalls alike.
    beyond = np.minimum(np.maximum((size - sin(alpha_stall)) / STALL_WIDTH, 0.0), 1.0)
    kept = 1.0 - stall_loss * beyond * beyond * (3.0 - 2.0 * beyond)
    circulation = 2.0 * np.pi * aspect * (aspect + 0.7) / ((aspect + 1.7) * (aspect + 1.7)) * sin_a * kept
    C_L = circulation + C_Q * sin_a * size * cos(alpha)
    C_D = circulation * circulation / (np.pi * aspect) + C_Q * size * size * size + C_D0
    return C_L, C_D
