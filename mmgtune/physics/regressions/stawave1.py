"""Mean added resistance in waves from ahead: STAWAVE-1, ITTC 2014, Recommended Procedure 7.5-04-01-01.1."""

import numpy as np

from ..constants import GRAVITY
from ..elementary import where

LEAST = 1e-24
"""Square of a height [m^2] below which waves have no direction; far from the ends of either precision."""


def height_limit(L_pp):
    """Largest significant height [m] the formula holds for: the ship (L_pp [m]) hardly heaves and pitches up to it."""
    return 2.25 * np.sqrt(L_pp / 100.0)


def added_resistance(rho, B, L_BWL, height):
    """Mean resistance [N] that waves from ahead add: reflected by the bow, at any speed.

    rho [kg/m^3], B breadth [m], L_BWL from the bow to 95 % of the largest breadth on the waterline [m], height
    significant [m]: floats or (n_lanes,).  Mathioudakis et al., FAM, eq. 8.
    """
    return rho * GRAVITY / 16.0 * height * height * B * np.sqrt(B / L_BWL)


def from_ahead(ahead, starboard, taper):
    """Share [-] of that resistance in waves from any direction: 1 within 45 deg of the bow.

    ahead, starboard  vector towards where the waves come from, in the ship's axes
    taper             0: nothing outside of the sector, as the ITTC corrects nothing there; 1: a cosine that falls to
                      nothing at 90 deg (an assumption of this program)
    Floats or (n_lanes,).
    """
    a2, s2 = ahead * ahead, starboard * starboard
    size2 = np.maximum(a2 + s2, LEAST)
    twice = (a2 - s2) / size2  # cosine of twice the angle off the bow
    forward = ahead > 0.0
    beside = where(forward, taper * (1.0 - twice * twice), 0.0)
    return where(forward & (twice >= 0.0), 1.0, beside)
