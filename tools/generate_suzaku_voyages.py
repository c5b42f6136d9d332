"""Make the sample voyages of SUZAKU in ``trials/voyages``: generated, not measured.

Logs of a coaster's ordinary days: harbours, coastal legs under an autopilot, course changes, a few tests at sea; each
in its own wind, tide, waves and depth.  The ship is none of the models of the program.  Her main dimensions are those
of SUZAKU; her equations are written here, and differ from any profile's in form:

- hull: friction line with an allowance for fouling, lift of a slender body in u v and u r, drag of the cross-flow by
  strips; all of it with factors for shallow water
- propeller by a table over the advance ratio; wake that fades with cross-flow; engine with governor, droop and lag
- rudder with flap by a table with stall, in a jet that develops behind the propeller; flow straightened unevenly
- steering gear with dead time and a limited rate
- wind by Blendermann's formulas at the height of the superstructure, with gusts; the anemometer stands higher
- tide that turns within 12.42 h and differs along the way; drift by waves from all sides, with the height squared

The coefficients below are the truth, and stay here.

    python tools/generate_suzaku_voyages.py [FOLDER]
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numba import njit

from mmgtune.trial import Trial, write_trial

STEP = 0.1
"""Step of the integration, Runge-Kutta [s]."""

PER_SECOND = round(1.0 / STEP)
RHO, RHO_AIR, G = 1025.0, 1.225, 9.81
NU = 1.19e-6
"""Kinematic viscosity of sea water [m^2/s]."""

L, B, D = 83.0, 13.5, 3.8
X_G = 0.93
MASS = RHO * 0.737 * L * B * D
M_X, M_Y = 0.055 * MASS, 0.72 * MASS
I_ZZ = MASS * (0.245 * L) ** 2 + MASS * X_G**2 + 0.045 * MASS * L**2 / 1.6
WETTED = 1400.0
FORM, ROUGH = 0.36, 0.65e-3
"""Form factor and roughness allowance of the friction line."""

Y_UV, Y_UR, N_UV, N_UR = -0.335, 0.076, -0.080, -0.064
"""Lift of the hull over 0.5 rho L d, times u v, L u r; moments times L."""

X_VV, X_VR = 0.02, 0.80
"""Drag by drift (here a little thrust) over 0.5 rho L d; share of the added mass M_Y v r that the hull gives back."""

STRIPS = 12
ENDS, MIDDLE = 1.70, 0.75
"""Cross-flow drag at the ends of the hull and amidships."""

D_P, X_P = 2.8, -0.48 * L
WAKE, WAKE_FADES, THRUST_LOSS, ASIDE = 0.36, 0.05, 0.15, 0.025
"""Wake, how it fades with the cross-flow; share of the thrust lost at the hull, and that acts to the side."""

K_T = np.array([0.318, 0.296, 0.268, 0.235, 0.198, 0.158, 0.115, 0.069, 0.021, -0.030, -0.085])
K_Q = np.array([0.0340, 0.0322, 0.0299, 0.0271, 0.0240, 0.0206, 0.0167, 0.0124, 0.0077, 0.0025, -0.0030])
"""Over the advance ratio J = 0, 0.1, ... 1."""

GOVERNOR, DROOP, TORQUE = 7.0, 0.12, 4.5e3
"""Lag [s]; share of the revolutions lost where the torque over their square is twice that [N m s^2]."""

A_R, X_R = 6.282, -0.482 * L
C_N = np.array([0.0, 0.24, 0.47, 0.69, 0.90, 1.10, 1.28, 1.44, 1.57, 1.66, 1.70, 1.62, 1.48, 1.36, 1.28])
"""Normal force of rudder with flap over the angle that counts, 0, 5, ... 70 deg; stall beyond 50."""

FLAP = 0.42
"""Share of the flap angle that counts as rudder angle; the flap turns as far as the blade, up to 35 deg."""

A_H, X_H, LOSS_R = 0.21, -0.43 * L, 0.05
STRAIGHTENED, SIDES, LEVER = 0.40, 0.06, -0.86 * L
GEAR_RATE, DEAD_TIME = np.radians(2.4), 6
"""Rate of the steering gear [rad/s]; steps before it moves."""

A_T, A_L = 170.0, 750.0
DRAG_AHEAD, DRAG_ABEAM, CROSS, AT_HEIGHT, ANEMOMETER = 0.62, 0.86, 0.45, 6.5, 22.0
"""Blendermann's coefficients; height of the wind that acts and of the anemometer [m], wind being told at 10 m."""

TIDE = 2.0 * np.pi / (12.42 * 3600.0)
WAYPOINT, HEADING, HELM, CIRCLE, ZIGZAG = range(5)
REACHED = 160.0
"""Distance [m] at which a waypoint counts as reached."""


@njit(cache=True)
def read_off(table, place):
    """A table at a place in steps of its entries, linear, held at its ends."""
    k = int(min(max(place, 0.0), len(table) - 1.000001))
    share = min(max(place - k, 0.0), 1.0)
    return table[k] + share * (table[k + 1] - table[k])


@njit(cache=True)
def hull(u, v, r, shallow, fouling):
    """X [N], Y [N], N [N m]; shallow is draught over depth."""
    U = max(np.hypot(u, v), 0.05)
    more = 1.0 + 1.1 * shallow**2 + 2.0 * shallow**4
    friction = 0.075 / (np.log10(U * L / NU) - 2.0) ** 2 * (1.0 + FORM) + ROUGH * fouling
    waves = 0.3e-3 * (U / np.sqrt(G * L) / 0.15) ** 4
    X = -0.5 * RHO * WETTED * u * abs(u) * (friction + waves) * (1.0 + 0.45 * shallow**2)
    area = 0.5 * RHO * L * D
    X += area * X_VV * v * v - X_VR * M_Y * v * r
    Y = area * (Y_UV * more * u * v + Y_UR * u * r * L)
    N = area * L * (N_UV * more * u * v + N_UR * (1.0 + 0.6 * shallow**2) * u * r * L)
    for k in range(STRIPS):
        x = L * ((k + 0.5) / STRIPS - 0.5)
        across = v + r * x
        drag = MIDDLE + (ENDS - MIDDLE) * (2.0 * x / L) ** 2
        part = -0.5 * RHO * D * (L / STRIPS) * drag * (1.0 + 1.5 * shallow**2) * across * abs(across)
        Y += part
        N += part * x
    return X, Y, N


@njit(cache=True)
def propeller(u, v, r, n):
    """Thrust [N], torque [N m] and inflow [m/s]."""
    across = (v + X_P * r) / max(u, 0.3)
    wake = WAKE / (1.0 + across**2 / WAKE_FADES)
    inflow = (1.0 - wake) * u
    n = max(n, 0.05)
    place = 10.0 * inflow / (n * D_P)
    return (
        RHO * n * n * D_P**4 * read_off(K_T, place),
        RHO * n * n * D_P**5 * read_off(K_Q, place),
        inflow,
    )


@njit(cache=True)
def rudder(u, v, r, thrust, inflow, delta):
    """X [N], Y [N], N [N m] of the rudder and what it does to the hull."""
    load = max(thrust, 0.0) / (0.5 * RHO * 0.25 * np.pi * D_P**2)
    jet = inflow + 0.5 * (np.sqrt(inflow**2 + load) - inflow) * 1.77
    ahead = 0.74 * jet + 0.26 * inflow
    side = v + LEVER * r
    kept = STRAIGHTENED + SIDES * np.tanh(4.0 * side / max(u, 0.3))
    across = kept * side
    angle = delta + np.arctan2(-across, max(ahead, 0.05))
    flap = min(max(delta, -0.61), 0.61)
    counts = angle + FLAP * flap
    force = read_off(C_N, abs(np.degrees(counts)) / 5.0) * (1.0 if counts >= 0.0 else -1.0)
    F = 0.5 * RHO * A_R * (ahead**2 + across**2) * force
    X = -(1.0 - LOSS_R) * (F * np.sin(delta) + 0.012 * 0.5 * RHO * A_R * ahead**2)
    return X, -(1.0 + A_H) * F * np.cos(delta), -(X_R + A_H * X_H) * F * np.cos(delta)


@njit(cache=True)
def wind_force(psi, u, v, north, east):
    """X [N], Y [N], N [N m] of air that moves over ground at 10 m, on a ship that does; Blendermann."""
    less = (AT_HEIGHT / 10.0) ** (1.0 / 7.0)
    ahead = less * (north * np.cos(psi) + east * np.sin(psi)) - u
    aside = less * (-north * np.sin(psi) + east * np.cos(psi)) - v
    q = 0.5 * RHO_AIR * (ahead**2 + aside**2)
    e = np.arctan2(-aside, -ahead)  # where it comes from, off the bow
    under = 1.0 - 0.5 * CROSS * (1.0 - DRAG_AHEAD * A_T / (DRAG_ABEAM * A_L)) * np.sin(2.0 * e) ** 2
    X = -q * A_T * DRAG_AHEAD * np.cos(e) / under
    Y = -q * A_L * DRAG_ABEAM * np.sin(e) / under
    return X, Y, Y * (-0.02 * L - 0.17 * L * (abs(e) - 0.5 * np.pi))


@njit(cache=True)
def wave_force(psi, height, come_from):
    """X [N], Y [N], N [N m] of drift by waves of a significant height [m]."""
    off = come_from - psi
    square = height * height
    X = -6.2e3 * square * (0.12 + 0.88 * np.cos(off) * abs(np.cos(off)))
    Y = -1.25e4 * square * np.sin(off) * abs(np.sin(off))
    return X, Y, 1.6e3 * L * square * np.sin(2.0 * off)


@njit(cache=True)
def tide(about, t, along):
    """Velocity of the water to north and east [m/s]; about: largest, least, axis, phase, how much it varies, mean."""
    vary = 1.0 + about[4] * np.sin(along / 2600.0 + about[3])
    main = about[0] * vary * np.cos(TIDE * t + about[3]) + about[5]
    other = about[1] * np.sin(TIDE * t + about[3])
    return (
        main * np.cos(about[2]) - other * np.sin(about[2]),
        main * np.sin(about[2]) + other * np.cos(about[2]),
    )


@njit(cache=True)
def rates(z, order, delta, water, air, sea, shallow, fouling, out):
    """Rates of x, y, psi, u, v (through water), r, n into ``out``."""
    psi, u, v, r, n = z[2], z[3], z[4], z[5], z[6]
    c, s = np.cos(psi), np.sin(psi)
    u_g, v_g = u + water[0] * c + water[1] * s, v - water[0] * s + water[1] * c
    thrust, torque, inflow = propeller(u, v, r, n)
    X, Y, N = hull(u, v, r, shallow, fouling)
    X_R_, Y_R_, N_R_ = rudder(u, v, r, thrust, inflow, delta)
    X_W, Y_W, N_W = wind_force(psi, u_g, v_g, air[0], air[1])
    X_S, Y_S, N_S = wave_force(psi, sea[0], sea[1])
    X += (1.0 - THRUST_LOSS) * thrust + X_R_ + X_W + X_S + (MASS + M_Y) * v * r + MASS * X_G * r * r
    Y += ASIDE * thrust + Y_R_ + Y_W + Y_S - (MASS + M_X) * u * r
    N += ASIDE * thrust * X_P + N_R_ + N_W + N_S - MASS * X_G * u * r
    a, b, d = MASS + M_Y, MASS * X_G, I_ZZ
    out[0], out[1], out[2] = u_g * c - v_g * s, u_g * s + v_g * c, r
    out[3] = X / (MASS + M_X)
    out[4] = (d * Y - b * N) / (a * d - b * b)
    out[5] = (a * N - b * Y) / (a * d - b * b)
    out[6] = (order * (1.0 - DROOP * (torque / (TORQUE * order * order) - 1.0)) - n) / GOVERNOR


@njit(cache=True)
def between(angle):
    """An angle in -pi to pi."""
    return angle - 2.0 * np.pi * np.floor(angle / (2.0 * np.pi) + 0.5)


@njit(cache=True)
def bounded(value, most):
    return min(max(value, -most), most)


@njit(cache=True)
def sail(legs, start, tidal, weather, gusts, distances, depths, fouling, yaw_noise):
    """Rows each second: x, y, psi, u, v over ground, r, n, rudder, air north, east, depth.

    legs      (n_legs, 7): kind, two or three numbers of it, largest rudder angle [rad], revolutions [1/s], longest [s]
    start     heading, speed, revolutions; tidal: see ``tide``; weather: wind [m/s, rad], share of gusts, waves [m, rad]
    gusts     (n_steps, 2) standard normal; yaw_noise (n_seconds,) what the autopilot hears too much [rad]
    """
    rows = np.zeros((len(yaw_noise), 11))
    z, trying, k_ = np.zeros(7), np.zeros(7), np.zeros((4, 7))
    z[2], z[3], z[6] = start[0], start[1], start[2]
    water, air, sea = np.zeros(2), np.zeros(2), np.array([weather[3], weather[4]])
    waiting = np.zeros(DEAD_TIME + 1)
    order = delta = summed = gust = veer = along = 0.0
    leg, begun, sign, orders = 0, 0, 1.0, 0
    psi_0 = z[2]
    for k in range(len(yaw_noise) * PER_SECOND):
        t = k * STEP
        kind, aim, other, most = int(legs[leg, 0]), legs[leg, 1], legs[leg, 2], legs[leg, 4]
        over = t - begun * STEP >= legs[leg, 6]
        if kind == WAYPOINT:
            over = over or np.hypot(aim - z[0], other - z[1]) < REACHED
        elif kind == CIRCLE:
            over = over or abs(z[2] - psi_0) >= other
        elif kind == ZIGZAG:
            over = over or orders > legs[leg, 3]
        if over:
            leg += 1
            if leg == len(legs):
                return rows[: k // PER_SECOND]
            begun, psi_0, sign, orders, summed = k, z[2], 1.0, 0, 0.0
            kind, aim, other, most = int(legs[leg, 0]), legs[leg, 1], legs[leg, 2], legs[leg, 4]
        shown = read_off(depths, along / (distances[1] - distances[0]))
        north, east = tide(tidal, t, along)
        water[0], water[1] = north, east
        gust += -gust * STEP / 25.0 + weather[2] * np.sqrt(2.0 * STEP / 25.0) * gusts[k, 0]
        veer += -veer * STEP / 70.0 + 0.05 * np.sqrt(2.0 * STEP / 70.0) * gusts[k, 1]
        speed, come_from = weather[0] * (1.0 + gust), weather[1] + veer
        air[0], air[1] = -speed * np.cos(come_from), -speed * np.sin(come_from)
        if k % PER_SECOND == 0:
            heard = z[2] + yaw_noise[k // PER_SECOND]
            if kind == CIRCLE:
                order = aim
            elif kind == ZIGZAG:
                if orders == 0 or sign * (z[2] - psi_0) >= other:
                    sign = sign if orders == 0 else -sign
                    orders += 1
                    order = sign * aim
            else:
                wanted = aim
                if kind == WAYPOINT:
                    wanted = np.arctan2(other - z[1], aim - z[0])
                miss = between(wanted - heard)
                summed = bounded(summed + 0.002 * miss, np.radians(6.0))
                asked = 0.9 * miss - 26.0 * z[5] + summed
                if kind == HELM:
                    if k // PER_SECOND % 7 == 0:
                        order = bounded(np.radians(5.0) * np.round(asked * 1.3 / np.radians(5.0)), most)
                elif abs(asked - order) > np.radians(0.4):
                    order = bounded(np.radians(0.5) * np.round(asked / np.radians(0.5)), most)
            c, s = np.cos(z[2]), np.sin(z[2])
            row = rows[k // PER_SECOND]
            row[:3] = z[:3]
            row[3], row[4] = z[3] + north * c + east * s, z[4] - north * s + east * c
            row[5], row[6], row[7] = z[5], z[6], delta
            row[8], row[9], row[10] = air[0], air[1], shown
        for i in range(DEAD_TIME):
            waiting[i] = waiting[i + 1]
        waiting[DEAD_TIME] = order
        after = delta + bounded(waiting[0] - delta, GEAR_RATE * STEP)
        half = 0.5 * (delta + after)
        shallow = D / shown
        n_o = legs[leg, 5]
        rates(z, n_o, delta, water, air, sea, shallow, fouling, k_[0])
        trying[:] = z + 0.5 * STEP * k_[0]
        rates(trying, n_o, half, water, air, sea, shallow, fouling, k_[1])
        trying[:] = z + 0.5 * STEP * k_[1]
        rates(trying, n_o, half, water, air, sea, shallow, fouling, k_[2])
        trying[:] = z + STEP * k_[2]
        rates(trying, n_o, after, water, air, sea, shallow, fouling, k_[3])
        z += STEP / 6.0 * (k_[0] + 2.0 * k_[1] + 2.0 * k_[2] + k_[3])
        along += STEP * np.hypot(z[3], z[4])
        delta = after
    return rows


@dataclass(frozen=True)
class Plan:
    """A voyage before it is sailed.

    legs      rows of ``sail``
    heading   at the start [deg]; rpm then
    wind      speed at 10 m [m/s], where it comes from [deg]
    waves     significant height [m], where they come from [deg]
    tide      largest, least [m/s], axis [deg], phase [rad], variation along the way, residual current [m/s]
    depths    along the way, evenly over 12 km [m]
    logs      what else is logged: "wind", "apparent", "depth", "waves", "current"
    fouling   roughness over that of the first voyage
    """

    id: str
    about: str
    legs: tuple[tuple[float, ...], ...]
    heading: float
    rpm: float
    wind: tuple[float, float]
    waves: tuple[float, float]
    tide: tuple[float, float, float, float, float, float]
    depths: tuple[float, ...]
    logs: tuple[str, ...]
    fouling: float


def steer(headings: str, each: float, rpm: float, most: float, kind: int = HEADING) -> tuple[tuple[float, ...], ...]:
    """Legs of a heading [deg] each, in order, by autopilot or by hand."""
    return tuple(
        (kind, np.radians(float(one)), 0.0, 0.0, np.radians(most), rpm / 60.0, each) for one in headings.split()
    )


def legs_to(points: str, rpm: float, most: float) -> tuple[tuple[float, ...], ...]:
    """Legs to waypoints, "north,east" [m] each."""
    places = [tuple(float(part) for part in one.split(",")) for one in points.split()]
    return tuple((WAYPOINT, *place, 0.0, np.radians(most), rpm / 60.0, 3600.0) for place in places)


def circle(angle: float, through: float, rpm: float) -> tuple[tuple[float, ...], ...]:
    """A turn with a rudder angle [deg] through a change of heading [deg]."""
    return ((CIRCLE, np.radians(angle), np.radians(through), 0.0, 0.0, rpm / 60.0, 1200.0),)


def zigzag(angle: float, rpm: float) -> tuple[tuple[float, ...], ...]:
    """A zigzag of five orders."""
    return ((ZIGZAG, np.radians(angle), np.radians(angle), 5.0, 0.0, rpm / 60.0, 900.0),)


PLANS = (
    Plan("voyage_01", "harbour departure by hand",
         steer("20 45 30 60 85", 100.0, 74.0, 20.0, HELM) + steer("110 90 70 95 120", 130.0, 100.0, 15.0, HELM)
         + steer("120 105 120", 260.0, 140.0, 8.0),
         20.0, 72.0, (2.5, 250.0), (0.1, 230.0), (0.05, 0.01, 70.0, 0.6, 0.3, 0.00),
         (8.0, 8.5, 9.5, 12.0, 16.0, 22.0, 28.0), ("wind", "depth"), 1.0),
    Plan("voyage_02", "coastal leg under the autopilot",
         legs_to("3300,1350 6400,3900 9000,3400 12400,5400", 160.0, 10.0),
         25.0, 158.0, (4.0, 300.0), (0.4, 290.0), (0.09, 0.02, 30.0, 2.2, 0.25, 0.01),
         (30.0, 34.0, 42.0, 38.0, 25.0, 30.0, 45.0), ("wind", "depth", "waves", "current"), 1.02),
    Plan("voyage_03", "course changes by rudder angles of 5 to 20 deg",
         steer("300", 150.0, 150.0, 6.0) + steer("330 290 320", 190.0, 150.0, 5.0)
         + steer("10 325 5", 190.0, 150.0, 10.0) + steer("310 20 315", 180.0, 140.0, 15.0)
         + steer("40 320 0", 170.0, 140.0, 20.0),
         300.0, 150.0, (2.0, 180.0), (0.2, 200.0), (0.04, 0.01, 100.0, 4.0, 0.2, 0.00),
         (55.0, 60.0, 60.0), (), 1.04),
    Plan("voyage_04", "turning circles and zigzags at sea",
         steer("90", 150.0, 112.0, 6.0) + circle(10.0, 380.0, 112.0) + steer("90", 200.0, 150.0, 10.0)
         + circle(-20.0, 380.0, 150.0) + steer("90", 220.0, 150.0, 10.0) + circle(35.0, 380.0, 150.0)
         + steer("100", 240.0, 150.0, 10.0) + zigzag(10.0, 150.0) + steer("90", 220.0, 150.0, 8.0)
         + zigzag(20.0, 150.0) + steer("80", 120.0, 150.0, 8.0),
         90.0, 112.0, (1.5, 20.0), (0.2, 40.0), (0.04, 0.01, 60.0, 1.0, 0.1, 0.01),
         (70.0, 80.0, 80.0), ("wind", "waves"), 1.06),
    Plan("voyage_05", "northward and southward, over 0 and 180 deg time and again",
         steer("355 5 352 8 350 10 355", 110.0, 156.0, 10.0) + circle(10.0, 360.0, 156.0)
         + steer("170 190 175 186 172 188 180", 110.0, 156.0, 10.0) + circle(-10.0, 370.0, 156.0)
         + steer("185 350 5 355", 150.0, 140.0, 15.0),
         355.0, 156.0, (4.0, 240.0), (0.4, 250.0), (0.06, 0.01, 150.0, 5.0, 0.3, 0.00),
         (40.0, 45.0, 50.0), ("apparent", "depth", "waves"), 1.08),
    Plan("voyage_06", "coastal leg in a strong tide",
         legs_to("-1100,3200 800,6400 -300,9300 500,11500", 162.0, 10.0),
         110.0, 160.0, (3.0, 60.0), (0.3, 80.0), (0.55, 0.10, 85.0, 2.9, 0.35, 0.0),
         (18.0, 22.0, 26.0, 20.0, 16.0, 24.0, 30.0), ("wind", "depth", "current"), 1.10),
    Plan("voyage_07", "harbour arrival by hand",
         steer("200 215", 220.0, 148.0, 8.0) + steer("225 210 190 175", 150.0, 104.0, 15.0, HELM)
         + steer("160 180 195 170 150 165", 120.0, 76.0, 25.0, HELM),
         200.0, 150.0, (3.0, 120.0), (0.2, 140.0), (0.07, 0.01, 20.0, 5.6, 0.3, 0.00),
         (26.0, 20.0, 14.0, 10.5, 9.0, 8.0, 8.0), ("apparent", "depth"), 1.12),
    Plan("voyage_08", "coastal leg in a fresh beam wind",
         legs_to("-2800,-1000 -5700,-750 -8400,-2200 -11000,-1900", 160.0, 12.0),
         200.0, 158.0, (9.0, 285.0), (1.0, 280.0), (0.07, 0.01, 10.0, 0.2, 0.2, 0.01),
         (35.0, 40.0, 48.0, 50.0), ("wind", "waves", "current"), 1.14),
    Plan("voyage_09", "a shallow fairway with bends",
         steer("60", 150.0, 124.0, 8.0) + steer("75 95 120 100 80", 200.0, 124.0, 10.0)
         + steer("60 35 10 30 55 75", 180.0, 104.0, 15.0, HELM),
         60.0, 124.0, (2.0, 330.0), (0.0, 330.0), (0.09, 0.01, 65.0, 3.6, 0.25, 0.00),
         (7.5, 7.0, 6.8, 7.4, 9.0, 7.2, 7.0), ("wind", "depth"), 1.16),
    Plan("voyage_10", "course changes in waves",
         steer("250", 160.0, 158.0, 8.0) + steer("230 260 290 250 210", 210.0, 158.0, 10.0)
         + steer("180 240 300 250", 210.0, 160.0, 20.0) + steer("235 265 250", 180.0, 146.0, 5.0),
         250.0, 158.0, (5.5, 225.0), (1.3, 235.0), (0.05, 0.01, 130.0, 1.6, 0.2, 0.03),
         (65.0, 70.0, 70.0), ("wind", "waves", "current"), 1.18),
    Plan("voyage_11", "coastal leg, nothing around the ship logged",
         legs_to("2000,-2600 5000,-4300 6300,-7000 9300,-8600", 164.0, 10.0),
         310.0, 162.0, (5.0, 20.0), (0.5, 10.0), (0.10, 0.01, 140.0, 4.8, 0.3, 0.00),
         (28.0, 30.0, 36.0, 42.0, 38.0), (), 1.20),
    Plan("voyage_12", "harbour arrival with a turn before the berth",
         steer("330 345", 240.0, 150.0, 10.0) + steer("0 340 320 350", 150.0, 100.0, 15.0, HELM)
         + circle(25.0, 170.0, 80.0) + steer("165 150 170 185 160", 120.0, 76.0, 20.0, HELM),
         330.0, 150.0, (2.5, 40.0), (0.2, 30.0), (0.07, 0.01, 160.0, 0.9, 0.3, 0.00),
         (22.0, 18.0, 13.0, 10.0, 9.0, 8.5), ("wind", "depth", "current"), 1.22),
)  # fmt: skip

LONGEST = 3600
"""Seconds a voyage may last."""

NOTE = (
    "Generated, not measured: a ship of SUZAKU's dimensions with equations of her own, "
    "see tools/generate_suzaku_voyages.py; {about}."
)

NOISE = {"x": 0.1, "y": 0.1, "psi": np.radians(0.05), "u": 0.006, "v": 0.006, "r": np.radians(0.006)}
"""Standard deviations of sensors: m, m, rad, m/s, m/s, rad/s; positions wander besides."""

WANDER, WANDERS = 0.6, 300.0
"""How far [m] and how fast [s] the error of the position wanders."""


def generate(folder: Path, ids: tuple[str, ...] = ()) -> None:
    """Write voyages to ``folder``, all of them or those of some ids, replacing what is there."""
    for number, plan in enumerate(PLANS, start=1):
        if not ids or plan.id in ids:
            write_trial(voyage(plan, number), folder / f"{plan.id}.parquet", overwrite=True)


def voyage(plan: Plan, seed: int) -> Trial:
    """One voyage as it is logged."""
    rng = np.random.default_rng([seed, 1])
    heard = np.radians(0.12) * rng.standard_normal(LONGEST)
    gusts = rng.standard_normal((LONGEST * PER_SECOND, 2))
    largest, least, axis, phase, varies, residual = plan.tide
    rows = sail(
        np.array(plan.legs, dtype=float),
        np.array([np.radians(plan.heading), plan.rpm / 60.0 * 1.78, plan.rpm / 60.0]),
        np.array([largest, least, np.radians(axis), phase, varies, residual]),
        np.array([plan.wind[0], np.radians(plan.wind[1]), 0.09, plan.waves[0], np.radians(plan.waves[1])]),
        gusts,
        np.linspace(0.0, 12e3, len(plan.depths)),
        np.array(plan.depths),
        plan.fouling,
        heard,
    )
    return logged(plan, rows, rng)


def logged(plan: Plan, rows: np.ndarray, rng: np.random.Generator) -> Trial:
    """What sensors log of a voyage, each value in steps of their resolution."""
    n_rows = len(rows)
    t = np.arange(n_rows, dtype=float)
    x, y, psi, u, v, r, n, delta, air_north, air_east, depth = rows.T
    error = {name: size * rng.standard_normal(n_rows) for name, size in NOISE.items()}
    motion = {
        "x": steps(x + error["x"] + wandering(n_rows, rng), 0.1),
        "y": steps(y + error["y"] + wandering(n_rows, rng), 0.1),
        "psi": angles(psi + error["psi"], 0.05),
        "u": steps(u + error["u"], 0.01),
        "v": steps(v + error["v"], 0.01),
        "r": angles(r + error["r"], 0.005),
    }
    for begins, lasts in zip(rng.integers(300, n_rows - 60, size=2), rng.integers(2, 9, size=2), strict=True):
        for name in ("x", "y", "u", "v"):  # all that the satellites tell
            motion[name][begins : begins + lasts] = np.nan
    measured = {
        "n": steps(60.0 * (n + 0.001 * rng.standard_normal(n_rows)), 0.1) / 60.0,
        "delta": angles(delta + np.radians(0.05) * rng.standard_normal(n_rows), 0.1),
    }
    extra = around(plan, t, motion, (air_north, air_east), depth, rng)
    return Trial(
        id=plan.id,
        ship="suzaku",
        manoeuvre="voyage",
        source="generated",
        t=t,
        x=motion["x"],
        y=motion["y"],
        psi=motion["psi"],
        u=motion["u"],
        v_m=motion["v"],
        r=motion["r"],
        n=measured["n"],
        delta=measured["delta"],
        extra=extra,
        noise={name: float(size) for name, size in NOISE.items()},
        note=NOTE.format(about=plan.about),
    )


def around(
    plan: Plan,
    t: np.ndarray,
    motion: dict[str, np.ndarray],
    air: tuple[np.ndarray, np.ndarray],
    depth: np.ndarray,
    rng: np.random.Generator,
) -> dict[str, np.ndarray]:
    """Columns of what is around the ship: wind by the anemometer, depth by the sounder, the others by a hindcast."""
    found = {}
    higher = (ANEMOMETER / 10.0) ** (1.0 / 7.0)
    north, east = (higher * part + 0.2 * rng.standard_normal(len(t)) for part in air)
    if "wind" in plan.logs:
        found["wind_speed"] = steps(np.hypot(north, east), 0.1)
        found["wind_dir"] = angles(np.mod(np.arctan2(-east, -north), 2.0 * np.pi), 1.0)
    if "apparent" in plan.logs:
        psi = motion["psi"]
        ahead = north * np.cos(psi) + east * np.sin(psi) - filled(motion["u"])
        aside = -north * np.sin(psi) + east * np.cos(psi) - filled(motion["v"])
        found["wind_speed_app"] = steps(np.hypot(ahead, aside), 0.1)
        found["wind_dir_app"] = angles(np.mod(np.arctan2(-aside, -ahead), 2.0 * np.pi), 1.0)
    if "depth" in plan.logs:
        found["depth"] = steps(depth + 0.05 * rng.standard_normal(len(t)), 0.1)
    if "waves" in plan.logs:
        off = 1.0 + 0.12 * rng.standard_normal()
        found["wave_height"] = steps(plan.waves[0] * off * (1.0 + 0.05 * np.sin(t / 1500.0)), 0.01)
        turned = np.radians(plan.waves[1] + 8.0 * rng.standard_normal())
        found["wave_dir"] = angles(turned + 0.05 * np.sin(t / 1900.0), 1.0)
    if "current" in plan.logs:
        largest, least, axis, phase, _, residual = plan.tide
        off, late = 1.0 + 0.1 * rng.standard_normal(), 600.0 * rng.standard_normal()
        main = off * largest * np.cos(TIDE * (t - late) + phase) + residual
        other = off * least * np.sin(TIDE * (t - late) + phase)
        north = main * np.cos(np.radians(axis)) - other * np.sin(np.radians(axis))
        east = main * np.sin(np.radians(axis)) + other * np.cos(np.radians(axis))
        found["current_speed"] = steps(np.hypot(north, east), 0.01)
        found["current_dir"] = angles(np.mod(np.arctan2(east, north), 2.0 * np.pi), 1.0)
    return found


def steps(values: np.ndarray, size: float) -> np.ndarray:
    """Values in whole steps of a decimal size; NaN stays."""
    per = round(1.0 / size)
    return np.asarray(np.round(values * per) / per)


def angles(values: np.ndarray, degrees: float) -> np.ndarray:
    """Angles in whole steps of some degrees, in radians."""
    return np.radians(steps(np.degrees(values), degrees))


def filled(values: np.ndarray) -> np.ndarray:
    """Values with gaps bridged: what an instrument of its own would know."""
    at = np.flatnonzero(np.isfinite(values))
    return np.interp(np.arange(len(values)), at, values[at])


def wandering(n_rows: int, rng: np.random.Generator) -> np.ndarray:
    """(n_rows,) an error that fades within WANDERS."""
    kept = np.exp(-1.0 / WANDERS)
    out = np.empty(n_rows)
    out[0] = WANDER * rng.standard_normal()
    driven = WANDER * np.sqrt(1.0 - kept**2) * rng.standard_normal(n_rows)
    for k in range(1, n_rows):
        out[k] = kept * out[k - 1] + driven[k]
    return out


if __name__ == "__main__":
    generate(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent / "trials" / "voyages")
