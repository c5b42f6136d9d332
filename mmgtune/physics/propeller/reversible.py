"""Propeller that turns either way on a ship that moves either way, with its side force."""

from typing import NamedTuple

import numpy as np

from ..elementary import where
from ..quantities import Force, Lanes, PropellerOut
from .coefficients import N_FLOOR

FADE = 0.1
"""Advance ratio over which the side force of a ship that goes astern with the propeller ahead sets in [-]."""


class ReversiblePropeller(NamedTuple):
    """Coefficients [-] of the four combinations of ahead and astern."""

    D_P: Lanes  # diameter [m]
    pitch_: Lanes  # pitch over diameter
    t_P: Lanes  # thrust deduction, revolutions ahead
    k_0: Lanes  # K_T = k_0 + k_1 J + k_2 J^2, revolutions ahead
    k_1: Lanes
    k_2: Lanes
    J_max: Lanes  # advance ratios beyond +-J_max count as that
    A_1: Lanes  # side force, revolutions astern
    A_2: Lanes
    A_3: Lanes
    A_4: Lanes
    A_5: Lanes
    A_6: Lanes  # side force, ship astern and revolutions ahead
    A_7: Lanes
    A_8: Lanes
    B_1: Lanes  # yaw moments likewise
    B_2: Lanes
    B_3: Lanes
    B_4: Lanes
    B_5: Lanes
    B_6: Lanes
    B_7: Lanes
    B_8: Lanes
    C_3: Lanes  # surge force, revolutions astern
    C_6: Lanes
    C_7: Lanes
    C_10: Lanes  # J_S from which C_6 + C_7 J_S holds


def reversible_propeller(flow, wake, n, ship, p):
    """Propeller force: ahead a polynomial of J; astern Hachii 2004; ship astern, propeller ahead Ueno et al. 2001.

    flow Flow, wake WakeOut, n [1/s], ship Ship, p ReversiblePropeller: floats or (n_lanes,) -> PropellerOut.
    As put together for the Esso Osaka model by Miyauchi et al. 2022; J_S = u / (n D_P) is the advance ratio of the
    ship, J = u_P / (n D_P) that of the propeller.

    Assumptions of this program, so that nothing jumps while the ship passes through rest: advance ratios are kept
    within +-J_max, with which all forces vanish with n; the side force of the last combination sets in over 0.1 of
    J_S.  The forces change slope, but little in size, where the pieces of the source meet.
    """
    n_D = np.maximum(np.abs(n), N_FLOOR) * p.D_P
    forward = n >= 0.0
    # Of the ship through water, over the tip speed: positive ahead whichever way the propeller turns.
    advance = np.minimum(np.maximum(flow.u / n_D, -p.J_max), p.J_max)
    J_P = np.minimum(np.maximum(wake.u_P / n_D, -p.J_max), p.J_max)
    J_S = where(forward, advance, -advance)

    K_ahead = p.k_0 + (p.k_1 + p.k_2 * J_P) * J_P
    K_astern = where(J_S >= p.C_10, p.C_6 + p.C_7 * J_S, p.C_3)
    K_T = where(forward, K_ahead, K_astern)
    kept = where(forward, 1.0 - p.t_P, 1.0)
    n_D2 = n * n * p.D_P * p.D_P
    X = kept * ship.rho * n_D2 * p.D_P * p.D_P * K_T

    sets_in = np.minimum(np.maximum(-J_S / FADE, 0.0), 1.0) * p.pitch_ * p.pitch_
    Y_ahead = sets_in * ((p.A_6 * J_S + p.A_7) * J_S + p.A_8)
    N_ahead = sets_in * ((p.B_6 * J_S + p.B_7) * J_S + p.B_8)
    slow = J_S > -0.06
    fast = J_S < -0.35
    Y_astern = where(slow, p.A_5, where(fast, p.A_3 + p.A_4 * J_S, p.A_1 + p.A_2 * J_S))
    N_astern = where(slow, p.B_5, where(fast, p.B_3 + p.B_4 * J_S, p.B_1 + p.B_2 * J_S))
    area = 0.5 * ship.rho * ship.L_pp * ship.d * n_D2
    Y = area * where(forward, Y_ahead, Y_astern)
    N = area * ship.L_pp * where(forward, N_ahead, N_astern)

    jet = (8.0 / np.pi) * K_T * n_D2
    J = where(forward, J_P, -J_P)
    return PropellerOut(force=Force(X=X, Y=Y, N=N), J=J, K_T=K_T, jet=jet, D_P=p.D_P, n=n)
