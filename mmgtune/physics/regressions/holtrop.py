"""Resistance, wake and thrust deduction from main dimensions: Holtrop & Mennen 1982, Holtrop 1984.

Int. Shipbuilding Progress 29, 166-170 and 31, 272-276; as used in published implementations.  Single-screw ships with a
conventional stern and an open propeller; below a Froude number of 0.4 only.  Transom, appendages and bulb count as far
as they are given here.
"""

from typing import NamedTuple

import numpy as np

from ..elementary import where
from ..quantities import Lanes
from .formula import Formula

GRAVITY = 9.80665
VISCOSITY = 1.188e-6
"""Kinematic viscosity of sea water at 15 deg C [m^2/s]."""

_VALID = {"L/B": (3.9, 9.5), "B/d": (2.1, 4.0), "C_P": (0.55, 0.85), "Fn": (0.0, 0.45)}
FORMULA_1982 = Formula(
    "Holtrop & Mennen 1982, Int. Shipbuilding Progress 29, 166-170; as used in published implementations",
    _VALID,
    "limits over all kinds of ships in Holtrop 1984",
)
FORMULA_1984 = Formula(
    "Holtrop 1984, Int. Shipbuilding Progress 31, 272-276; as used in published implementations",
    _VALID,
    "limits over all kinds of ships in Holtrop 1984",
)


class Lines(NamedTuple):
    """What the formulas ask of a hull besides its speed.

    L stands for the length on the waterline; lcb forward of L/2 in % of L; C_st shape of the stern: -25 pram with
    gondola, -10 V, 0 normal, 10 U with Hogner stern; D_P propeller diameter.
    """

    L: Lanes  # [m]
    B: Lanes  # [m]
    d: Lanes  # mean draught [m]
    C_b: Lanes
    C_M: Lanes
    C_WP: Lanes
    lcb: Lanes  # [%]
    C_st: Lanes
    D_P: Lanes  # [m]
    A_BT: Lanes  # transverse area of the bulb [m^2]
    h_B: Lanes  # centre of that area above the keel [m]
    A_T: Lanes  # immersed area of the transom at rest [m^2]


def prismatic(lines):
    """C_P [-]."""
    return lines.C_b / lines.C_M


def wetted_surface(lines):
    """Wetted surface of the bare hull [m^2]: Holtrop & Mennen 1982."""
    L, B, d = lines.L, lines.B, lines.d
    shape = 0.453 + 0.4425 * lines.C_b - 0.2862 * lines.C_M - 0.003467 * B / d + 0.3696 * lines.C_WP
    return L * (2.0 * d + B) * np.sqrt(lines.C_M) * shape + 2.38 * lines.A_BT / lines.C_b


def friction(speed, length):
    """C_F of the ITTC 1957 line [-]; speed [m/s], length [m]."""
    reynolds = speed * length / VISCOSITY
    return 0.075 / (np.log10(reynolds) - 2.0) ** 2


def _run(lines):
    """Length of the run over L [-]."""
    C_P = prismatic(lines)
    return 1.0 - C_P + 0.06 * C_P * lines.lcb / (4.0 * C_P - 1.0)


def _volume(lines):
    return lines.L * lines.B * lines.d * lines.C_b


def form_factor(lines):
    """1 + k_1 [-]: Holtrop 1984."""
    L, B, d, C_P = lines.L, lines.B, lines.d, prismatic(lines)
    return (
        0.93
        + 0.487118
        * (1.0 + 0.011 * lines.C_st)
        * (B / L) ** 1.06806
        * (d / L) ** 0.46106
        * (1.0 / _run(lines)) ** 0.121563
        * (L**3 / _volume(lines)) ** 0.36486
        * (1.0 - C_P) ** -0.604247
    )


def _bulb(lines):
    """c_2 [-], what a bulb leaves of the wave resistance, c_3 of its size."""
    c_3 = 0.56 * lines.A_BT**1.5 / (lines.B * lines.d * (0.31 * np.sqrt(lines.A_BT) + lines.d - lines.h_B))
    return np.exp(-1.89 * np.sqrt(c_3))


def correlation(lines):
    """C_A, from model to ship with a standard roughness [-]: Holtrop 1984."""
    c_4 = np.minimum(lines.d / lines.L, 0.04)
    return (
        0.006 * (lines.L + 100.0) ** -0.16
        - 0.00205
        + 0.003 * np.sqrt(lines.L / 7.5) * lines.C_b**4 * _bulb(lines) * (0.04 - c_4)
    )


def wave_resistance(lines, speed, rho):
    """R_W [N] below a Froude number of 0.4: Holtrop 1984; speed [m/s], rho [kg/m^3]."""
    L, B, d, C_P = lines.L, lines.B, lines.d, prismatic(lines)
    V = _volume(lines)
    Fn = speed / np.sqrt(GRAVITY * L)
    slender = L**3 / V
    c_7 = where(B / L < 0.11, 0.229577 * (B / L) ** 0.33333, where(B / L > 0.25, 0.5 - 0.0625 * L / B, B / L))
    run = _run(lines) * L
    i_E = 1.0 + 89.0 * np.exp(
        -((L / B) ** 0.80856)
        * (1.0 - lines.C_WP) ** 0.30484
        * (1.0 - C_P - 0.0225 * lines.lcb) ** 0.6367
        * (run / B) ** 0.34574
        * (100.0 * V / L**3) ** 0.16302
    )
    c_1 = 2223105.0 * c_7**3.78613 * (d / B) ** 1.07961 * (90.0 - i_E) ** -1.37565
    c_5 = 1.0 - 0.8 * lines.A_T / (B * d * lines.C_M)
    c_15 = where(
        slender < 512.0, -1.69385, where(slender > 1726.91, 0.0, -1.69385 + (L / V ** (1.0 / 3.0) - 8.0) / 2.36)
    )
    c_16 = where(C_P < 0.8, 8.07981 * C_P - 13.8673 * C_P**2 + 6.984388 * C_P**3, 1.73014 - 0.7067 * C_P)
    lam = where(L / B < 12.0, 1.446 * C_P - 0.03 * L / B, 1.446 * C_P - 0.36)
    m_1 = 0.0140407 * L / d - 1.75254 * V ** (1.0 / 3.0) / L - 4.79323 * B / L - c_16
    m_4 = 0.4 * c_15 * np.exp(-0.034 * Fn**-3.29)
    return c_1 * _bulb(lines) * c_5 * V * rho * GRAVITY * np.exp(m_1 * Fn**-0.9 + m_4 * np.cos(lam * Fn**-2))


def resistance(lines, speed, rho):
    """Total resistance in calm water [N], without appendages: friction with form factor, waves, correlation.

    speed [m/s], rho [kg/m^3]: floats or (n_lanes,).
    """
    viscous = form_factor(lines) * friction(speed, lines.L) + correlation(lines)
    return 0.5 * rho * speed * speed * wetted_surface(lines) * viscous + wave_resistance(lines, speed, rho)


def _viscous(lines, speed):
    """C_V, the viscous resistance coefficient with correlation [-]."""
    return form_factor(lines) * friction(speed, lines.L) + correlation(lines)


def _afterbody(lines):
    """c_9, c_11 and C_P1 of the wake formulas [-]."""
    L, B, d, D = lines.L, lines.B, lines.d, lines.D_P
    S = wetted_surface(lines)
    c_8 = where(B / d < 5.0, B * S / (L * D * d), S * (7.0 * B / d - 25.0) / (L * D * (B / d - 3.0)))
    c_9 = where(c_8 < 28.0, c_8, 32.0 - 16.0 / (c_8 - 24.0))
    c_11 = where(d / D < 2.0, d / D, 0.0833333 * (d / D) ** 3 + 1.33333)
    return c_9, c_11, 1.45 * prismatic(lines) - 0.315 - 0.0225 * lines.lcb


def wake_1982(lines, speed):
    """Effective wake fraction at full scale [-]: Holtrop & Mennen 1982; speed [m/s]."""
    c_9, c_11, C_P1 = _afterbody(lines)
    C_V, C_P = _viscous(lines, speed), prismatic(lines)
    return (
        c_9 * C_V * lines.L / lines.d * (0.0661875 + 1.21756 * c_11 * C_V / (1.0 - C_P1))
        + 0.24558 * np.sqrt(lines.B / (lines.L * (1.0 - C_P1)))
        - 0.09726 / (0.95 - C_P)
        + 0.11434 / (0.95 - lines.C_b)
        + 0.75 * lines.C_st * C_V
        + 0.002 * lines.C_st
    )


def wake_1984(lines, speed):
    """Effective wake fraction at full scale [-]: Holtrop 1984; speed [m/s]."""
    c_9, c_11, C_P1 = _afterbody(lines)
    C_V, C_P = _viscous(lines, speed), prismatic(lines)
    c_19 = where(
        C_P < 0.7,
        0.12997 / (0.95 - lines.C_b) - 0.11056 / (0.95 - C_P),
        0.18567 / (1.3571 - lines.C_M) - 0.71276 + 0.38648 * C_P,
    )
    c_20 = 1.0 + 0.015 * lines.C_st
    return (
        c_9 * c_20 * C_V * lines.L / lines.d * (0.050776 + 0.93405 * c_11 * C_V / (1.0 - C_P1))
        + 0.27915 * c_20 * np.sqrt(lines.B / (lines.L * (1.0 - C_P1)))
        + c_19 * c_20
    )


def thrust_deduction_1982(lines):
    """Thrust deduction fraction [-]: Holtrop & Mennen 1982."""
    L, B, d = lines.L, lines.B, lines.d
    _, _, C_P1 = _afterbody(lines)
    c_10 = where(L / B > 5.2, B / L, 0.25 - 0.003328402 / (B / L - 0.134615385))
    return (
        0.001979 * L / (B - B * C_P1) + 1.0585 * c_10 - 0.00524 - 0.1418 * lines.D_P**2 / (B * d) + 0.0015 * lines.C_st
    )


def thrust_deduction_1984(lines):
    """Thrust deduction fraction [-]: Holtrop 1984."""
    L, B, d, C_P = lines.L, lines.B, lines.d, prismatic(lines)
    return (
        0.25014
        * (B / L) ** 0.28956
        * (np.sqrt(B * d) / lines.D_P) ** 0.2624
        / (1.0 - C_P + 0.0225 * lines.lcb) ** 0.01762
        + 0.0015 * lines.C_st
    )
