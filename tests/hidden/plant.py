"""The plant: SUZAKU sailing ten trials under a helmsman, with hidden effects, as noisy sensors would log it.

Written from the equations of Suyama et al. 2023 (arXiv:2312.04224), their numbers in brackets below, not from the
program's.  Scalars, SI units, angles in radians.  Forces and rigid-body equations hold in velocities through water,
also in a current that changes, since a body afloat is carried along with its water.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import astuple, dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from numba import njit

from .suzaku import PROFILE, Parameters, coefficients, complete

if TYPE_CHECKING:
    from mmgtune.trial import Trial

STEP = 0.1
"""Step of the integration [s]."""

INSTANT = 0.5 * STEP
"""Time constant [s] up to which something follows at once; the integration is stable from 0.36 STEP on."""

SPEED = 3.1
"""Approach speed through water [m/s]."""

RPM_DROP = 0.08
"""Share of the revolutions lost where the ship has lost all of its speed."""

ORDER_AT = 20.0
"""Time of the first rudder order [s]."""

LEGS = 6
"""Rudder orders of a zigzag; it ends where the next would come."""

MAX_ANGLE = np.radians(45.0)
G = 9.81
"""Gravity [m/s^2]."""

AIR = 1.225
"""Density of air [kg/m^3]."""

FLAP = np.radians([0.0, 10.0, 18.0, 25.0, 30.0, 34.5, 38.0, 41.0, 43.5, 45.0])
FLAP_STEP = np.radians(5.0)

TRIALS: tuple[tuple[str, float, float], ...] = (
    ("turn_p10", 10.0, 800.0),
    ("turn_m10", -10.0, 800.0),
    ("turn_p20", 20.0, 600.0),
    ("turn_m20", -20.0, 600.0),
    ("turn_p35", 35.0, 480.0),
    ("turn_m35", -35.0, 480.0),
    ("turn_p40", 40.0, 480.0),
    ("turn_m40", -40.0, 480.0),
    ("zigzag_10", 10.0, 900.0),
    ("zigzag_20", 20.0, 900.0),
)
"""Id, rudder angle [deg] and longest duration [s]."""

NAMES = tuple(name for name, *_ in TRIALS)

TUNING = ("turn_p10", "turn_m20", "turn_p35", "turn_m40", "zigzag_10")
"""Trials that causes are looked for on; the others are held out."""


@dataclass(frozen=True)
class Noise:
    """Standard deviations of the sensors [m, rad, m/s, rad/s, 1/s, rad].

    time_constant  of autocorrelated noise in the six motion channels [s], first order; 0: white
    """

    x: float = 0.4
    y: float = 0.4
    psi: float = float(np.radians(0.17))
    u: float = 0.02
    v: float = 0.02
    r: float = float(np.radians(0.03))
    n: float = 0.002
    delta: float = float(np.radians(0.05))
    time_constant: float = 0.0


WHITE = Noise()
AUTOCORRELATED = Noise(time_constant=30.0)
SILENT = Noise(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@njit(cache=True)
def toward(angle, target, most):
    """``angle`` moved towards ``target``, by ``most`` at the most."""
    return angle + min(max(target - angle, -most), most)


@njit(cache=True)
def driven(gear, order, s, seconds):
    """Where the steering gear is after some seconds."""
    return toward(gear, order, seconds * (s.rate_to_stbd if order > gear else s.rate_to_port))


@njit(cache=True)
def flap_angle(delta, scale):
    """Flap angle [rad] of a blade at delta: odd, linear between points each 5 deg, constant beyond the last."""
    place = abs(delta) / FLAP_STEP
    k = int(min(place, 8.0))
    value = FLAP[9] if place >= 9.0 else FLAP[k] + (place - k) * (FLAP[k + 1] - FLAP[k])
    return scale * (value if delta >= 0.0 else -value)


@njit(cache=True)
def hull(s, t, U, v_, r_):
    """X [N], Y [N], N [N m] of the hull (14-15), with the terms of a hidden hull-term and asymmetry."""
    growth = s.resistance_factor + s.resistance_slope * (U - SPEED) / np.sqrt(G * s.L_pp)
    R_0 = s.R_0 * growth * (1.0 + s.unknown_fouling_growing * t / 600.0)
    if 200.0 <= t < 320.0:
        R_0 *= 1.0 + s.unknown_ice
    X = -R_0 + s.X_vv * v_**2 + s.X_vr * v_ * r_ + s.X_rr * r_**2 + s.X_vvvr * v_**3 * r_ + s.X_vvvv * v_**4
    Y = s.Y_v * v_ + s.Y_r * r_ + s.Y_vvv * v_**3 + s.Y_vvr * v_**2 * r_ + s.Y_vrr * v_ * r_**2 + s.Y_rrr * r_**3
    N = s.N_v * v_ + s.N_r * r_ + s.N_vvv * v_**3 + s.N_vvr * v_**2 * r_ + s.N_vrr * v_ * r_**2 + s.N_rrr * r_**3
    Y += s.Y_vabsv * v_ * abs(v_) + s.Y_rabsr * r_ * abs(r_)
    N += s.N_vabsv * v_ * abs(v_) + s.N_rabsr * r_ * abs(r_) + s.N_rrabsr * r_**2 * abs(r_)
    Y += s.Y_0
    N += s.N_0
    held = 1.0 - s.unknown_hull_stall * np.tanh(max(0.0, abs(v_) - 0.15) / 0.1)
    return s.force * U**2 * X, s.force * U**2 * Y * held, s.moment * U**2 * N * held


@njit(cache=True)
def propeller_and_rudder(s, u, v, r, n, delta):
    """X [N], Y [N], N [N m] of propeller (16-24) and rudder with flap (25-36)."""
    U = max(np.hypot(u, v), 1e-9)
    beta = np.arctan2(-v, u)
    r_ = r * s.L_pp / U
    beta_P = beta - s.l_P_ * r_
    w_P = s.w_P0 * np.exp(s.C_w * beta_P**2)
    w_P *= 1.0 + s.unknown_wake_speed * (1.0 - U / SPEED)
    w_P *= 1.0 + s.unknown_wake_side * np.tanh(beta_P / 0.1)
    u_P = (1.0 - w_P) * u
    tip = 0.7 * np.pi * n * s.D_P
    square = u_P**2 + tip**2
    p = min(max(np.degrees(np.arctan2(u_P, tip)), -10.0), 40.0)
    K_T = s.thrust * (3.31e-6 * p**3 - 3.72e-4 * p**2 - 2.60e-3 * p + 0.167)
    C_PY = -2.83e-5 * p**2 + 6.04e-4 * p - 1.28e-2
    C_PN = -2.48e-4 * p - 1.70e-3 if p < 20.0 else -1.86e-4 * p + 4.03e-3
    disc = 0.5 * s.rho * 0.25 * np.pi * s.D_P**2 * square
    aside = 1.0 + s.unknown_side_force_drift * abs(beta)
    X = disc * (1.0 - s.t_P) * K_T * (1.0 - s.unknown_thrust_yaw * np.tanh(abs(r_)))
    Y = disc * C_PY * s.side_force * aside
    N = disc * s.L_pp * C_PN * s.side_moment * aside
    # (30) with K_T of (16) converted to the conventional one, written for u_P -> 0: 8 K_T/(pi J_P^2) = K_T V_r^2/u_P^2.
    jet = np.sqrt(max(u_P**2 + K_T * square, 0.0))
    u_R = max(s.eps * (u_P + s.D_P / s.H_R * s.kappa * (jet - u_P)), tip * s.u_R0)
    gamma_R = s.gamma_Rp if beta - s.l_R_ * r_ > 0.0 else s.gamma_Rn
    gamma_R *= 1.0 + s.unknown_straightening_yaw * np.tanh(abs(r_))
    v_R = gamma_R * (-v - s.l_R_ * s.L_pp * r)
    alpha_R = delta - np.arctan2(v_R, u_R)
    delta_f = flap_angle(delta, s.flap_scale)
    lift = (s.f_a0 + s.f_a2 * delta_f**2) * np.sin(alpha_R) + s.c_l01 * delta_f + s.c_l03 * delta_f**3
    F_N = 0.5 * s.rho * s.A_R * (u_R**2 + v_R**2) * lift
    if abs(alpha_R) > s.stall_angle:
        F_N *= min(1.0, np.sin(s.stall_angle) / abs(np.sin(alpha_R)))
    X -= (1.0 - s.t_R) * F_N * np.sin(delta)
    Y -= (1.0 + s.a_H) * F_N * np.cos(delta)
    N -= (s.x_R_ + s.a_H * s.x_H_) * s.L_pp * F_N * np.cos(delta)
    return X, Y, N


@njit(cache=True)
def wind_force(s, speed, direction, psi, u_g, v_g):
    """X [N], Y [N], N [N m] of true wind from a direction on a ship with velocity over ground; Fujiwara et al. 1998."""
    ahead = speed * np.cos(direction - psi) + u_g
    aside = speed * np.sin(direction - psi) + v_g
    a = 2.0 * np.pi - np.arctan2(aside, ahead)
    q = 0.5 * AIR * (ahead**2 + aside**2)
    C_X = s.wind_X0 + s.wind_X1 * np.cos(a) + s.wind_X3 * np.cos(3.0 * a) + s.wind_X5 * np.cos(5.0 * a)
    C_Y = s.wind_Y1 * np.sin(a) + s.wind_Y3 * np.sin(3.0 * a) + s.wind_Y5 * np.sin(5.0 * a)
    C_N = s.wind_N1 * np.sin(a) + s.wind_N2 * np.sin(2.0 * a) + s.wind_N3 * np.sin(3.0 * a)
    return q * s.A_T * C_X, q * s.A_L * C_Y, q * s.A_L * s.L_pp * C_N


@njit(cache=True)
def current(s, t, x):
    """Velocity of the water to north and east [m/s]."""
    turning = s.unknown_tide_turning * (t / 300.0 - 1.0)
    rotating = 2.0 * np.pi * t / 900.0
    south = s.unknown_current_south / (1.0 + np.exp(np.minimum(x / (0.25 * s.L_pp), 700.0)))
    north = turning * np.cos(0.8) + s.unknown_current_rotating * np.cos(rotating)
    east = turning * np.sin(0.8) + s.unknown_current_rotating * np.sin(rotating) + south
    return s.current_north + s.current_north_rate * t + north, s.current_east + s.current_east_rate * t + east


@njit(cache=True)
def outside(s, t, y, psi, u_g, v_g):
    """X [N], Y [N], N [N m] of wind, waves, a gust, tugs and a bank; still air is no force, R_0' has it in."""
    X = Y = N = 0.0
    if s.wind_speed != 0.0:
        X, Y, N = wind_force(s, s.wind_speed, s.wind_direction, psi, u_g, v_g)
    if s.unknown_gust != 0.0:
        gust = s.unknown_gust * np.sin(np.pi * t / 300.0) ** 2
        X_1, Y_1, N_1 = wind_force(s, gust, 4.0, psi, u_g, v_g)
        X_0, Y_0, N_0 = wind_force(s, 0.0, 4.0, psi, u_g, v_g)
        X, Y, N = X + X_1 - X_0, Y + Y_1 - Y_0, N + N_1 - N_0
    X -= s.wave_force * np.cos(s.wave_direction - psi)
    Y -= s.wave_force * np.sin(s.wave_direction - psi)
    suction = s.unknown_bank * (u_g / SPEED) ** 2 / (1.0 + np.exp(-(y - 150.0) / 80.0))
    if 60.0 <= t < 180.0:
        Y += s.unknown_tug
        N += 0.4 * s.L_pp * s.unknown_tug
    if t % 60.0 < 20.0:
        Y += s.unknown_thruster_bursts
        N += 0.4 * s.L_pp * s.unknown_thruster_bursts
    X += s.steady_ahead
    Y += s.steady_side
    N += s.steady_moment
    X += suction * np.sin(psi)
    Y += suction * np.cos(psi)
    N -= 0.1 * s.L_pp * suction * np.cos(psi)
    return X, Y, N


@njit(cache=True)
def solved(s, u, v, r, X, Y, N):
    """Accelerations [m/s^2, m/s^2, rad/s^2] under forces at midship (7)."""
    m, x_G = s.mass, s.x_G
    along = X + (m + s.m_y) * v * r + m * x_G * r**2
    across = Y - (m + s.m_x) * u * r
    turning = N - m * x_G * u * r
    determinant = (m + s.m_y) * s.I_zz - (m * x_G) ** 2
    dv = (s.I_zz * across - m * x_G * turning) / determinant
    dr = ((m + s.m_y) * turning - m * x_G * across) / determinant
    return along / (m + s.m_x), dv, dr


@njit(cache=True)
def accelerations(s, u, v, r, n, delta):
    """Accelerations without anything from outside, in still water, at the effective revolutions and blade angle."""
    U = max(np.hypot(u, v), 1e-9)
    X_H, Y_H, N_H = hull(s, 0.0, U, v / U, r * s.L_pp / U)
    X_R, Y_R, N_R = propeller_and_rudder(s, u, v, r, n, delta)
    return solved(s, u, v, r, X_H + X_R, Y_H + Y_R, N_H + N_R)


@njit(cache=True)
def logged_revolutions(n_0, u, v):
    """Revolutions [1/s] that fall with the speed through water."""
    return n_0 * (1.0 - RPM_DROP * (1.0 - np.hypot(u, v) / SPEED))


@njit(cache=True)
def blade_angle(s, followed, play):
    """Blade angle [rad] from that of the gear, after its lag: play, gain, zero, stop."""
    angle = min(max(play, followed - s.half_play), followed + s.half_play)
    angle -= min(max(angle, -s.half_pushed), s.half_pushed)
    side = s.gain_stbd if angle > 0.0 else s.gain_port
    side *= 1.0 + (s.gain_curve - s.unknown_indicator_cubic) * (angle / np.radians(35.0)) ** 2
    return min(max(s.rudder_gain * side * angle + s.rudder_offset, -s.rudder_limit), s.rudder_limit)


@njit(cache=True)
def rates(s, t, z, gear, play, n_0, out):
    """Rates of the state z into ``out``.

    z: x, y, psi; u, v (through water), r; hull Y and N remembered; gear angle after its lag; revolutions relative to
    those logged; heel, its rate; u r remembered.
    """
    psi, u, v, r = z[2], z[3], z[4], z[5]
    U = max(np.hypot(u, v), 1e-9)
    north, east = current(s, t, z[0])
    u_g = u + north * np.cos(psi) + east * np.sin(psi)
    v_g = v - north * np.sin(psi) + east * np.cos(psi)
    followed = z[8] if s.steering_lag > INSTANT else gear
    logged = logged_revolutions(n_0, u, v)
    n = s.rpm_scale * (z[9] if s.governor_lag > INSTANT else logged)
    n *= 1.0 - s.engine_droop * min(max(1.0 - u / SPEED * n_0 / n, 0.0), 1.0)
    n *= 1.0 + s.unknown_rpm_hunting * np.sin(2.0 * np.pi * t / 60.0)
    X_H, Y_H, N_H = hull(s, t, U, v / U, r * s.L_pp / U)
    blade = blade_angle(s, followed, play) * (1.0 - s.unknown_rudder_torsion * (U / SPEED) ** 2)
    blade += s.unknown_steering_hunting * np.sin(2.0 * np.pi * t / 15.0)
    X_R, Y_R, N_R = propeller_and_rudder(s, u, v, r, n, blade)
    X_O, Y_O, N_O = outside(s, t, z[1], psi, u_g, v_g)
    Y_O += s.unknown_delayed_sway * s.mass * z[12]
    N_O += s.unknown_roll_yaw * z[10] * s.moment * U**2
    Y_M = z[6] if s.memory_Y > INSTANT else Y_H
    N_M = z[7] if s.memory_N > INSTANT else N_H
    out[0] = u_g * np.cos(psi) - v_g * np.sin(psi)
    out[1] = u_g * np.sin(psi) + v_g * np.cos(psi)
    out[2] = r
    out[3], out[4], out[5] = solved(s, u, v, r, X_H + X_R + X_O, Y_M + Y_R + Y_O, N_M + N_R + N_O)
    out[6] = (Y_H - z[6]) / s.memory_Y if s.memory_Y > INSTANT else 0.0
    out[7] = (N_H - z[7]) / s.memory_N if s.memory_N > INSTANT else 0.0
    out[8] = (gear - z[8]) / s.steering_lag if s.steering_lag > INSTANT else 0.0
    out[9] = (logged - z[9]) / s.governor_lag if s.governor_lag > INSTANT else 0.0
    # Heel: natural frequency 0.6 rad/s, damping 0.15, lever over metacentric height 4, outwards in a turn.
    out[10] = z[11]
    out[11] = 0.36 * (4.0 * u * r / G - z[10]) - 0.18 * z[11]
    out[12] = (u * r - z[12]) / 20.0


@njit(cache=True)
def late_by(values, step, seconds):
    """What stood at a step, counted from 0, that many seconds earlier; values at whole steps, 0 before the first."""
    place = step - seconds / STEP
    if place <= 0.0:
        return 0.0
    k = int(place)
    return values[k] + (place - k) * (values[k + 1] - values[k])


@njit(cache=True)
def voyage(s, n_0, psi_0, angle, zigzag, steps, more):
    """Sail one trial at STEP: rows (x, y, psi, u_g, v_g, r, logged n, logged delta), and how many of them count.

    angle   rudder angle ordered at ORDER_AT, against the deviation of the heading in a zigzag [rad]
    steps   longest duration; more: rows wanted after the end
    """
    rows = np.zeros((steps + more + 1, 8))
    z, trying, rate = np.zeros(13), np.zeros(13), np.zeros((4, 13))
    z[2], z[3] = psi_0, SPEED
    _, z[6], z[7] = hull(s, 0.0, SPEED, 0.0, 0.0)
    z[9] = n_0
    gear = order = 0.0
    play = s.play_begins * s.half_play
    moved = np.zeros(steps + more + 2)  # the gear at every step
    orders = 0
    end = steps
    k = 0
    while True:
        t = k * STEP
        if t > ORDER_AT - 0.5 * STEP and orders == 0:
            order = toward(0.0, angle, MAX_ANGLE)
            orders = 1
        elif zigzag and orders > 0 and order * (z[2] - psi_0) >= order * order and orders <= LEGS:
            order = -order
            orders += 1
            if orders > LEGS:
                order = -order
                end = min(end, k)
        north, east = current(s, t, z[0])
        rows[k, :3] = z[:3]
        rows[k, 3] = z[3] + north * np.cos(z[2]) + east * np.sin(z[2])
        rows[k, 4] = z[4] - north * np.sin(z[2]) + east * np.cos(z[2])
        rows[k, 5] = z[5]
        rows[k, 6] = logged_revolutions(n_0, z[3], z[4])
        rows[k, 7] = order if s.logs_order > 0.0 else gear
        if k >= end + more:
            return rows[: k + 1], end + 1
        middle = driven(gear, order, s, 0.5 * STEP)
        gear = driven(gear, order, s, STEP)
        moved[k + 1] = gear
        if s.dead_time > 0.0:
            first, half, whole = late_by(moved, k, s.dead_time), late_by(moved, k + 0.5, s.dead_time), 0.0
            whole = late_by(moved, k + 1.0, s.dead_time)
        else:
            first, half, whole = moved[k], middle, gear
        rates(s, t, z, first, play, n_0, rate[0])
        trying[:] = z + 0.5 * STEP * rate[0]
        rates(s, t + 0.5 * STEP, trying, half, play, n_0, rate[1])
        trying[:] = z + 0.5 * STEP * rate[1]
        rates(s, t + 0.5 * STEP, trying, half, play, n_0, rate[2])
        trying[:] = z + STEP * rate[2]
        rates(s, t + STEP, trying, whole, play, n_0, rate[3])
        z += STEP / 6.0 * (rate[0] + 2.0 * rate[1] + 2.0 * rate[2] + rate[3])
        followed = z[8] if s.steering_lag > INSTANT else whole
        play = min(max(play, followed - s.half_play), followed + s.half_play)
        k += 1


def sail(
    ship: Mapping[str, float],
    effects: Parameters,
    seed: int,
    names: Collection[str] = NAMES,
    of_trial: Mapping[str, Parameters] = MappingProxyType({}),
) -> dict[str, np.ndarray]:
    """What perfect sensors log of the trials of those names, by id: rows (t, x, y, psi, u, v, r, n, delta) each second.

    Revolutions and heading of a trial are drawn from ``seed`` alone, the same whatever the effects.

    of_trial  effects of single trials, beside those of all or instead of them
    """
    of_all = effects
    logs = {}
    for k, (name, degrees, longest) in enumerate(TRIALS):
        if name not in names:
            continue
        effects = {**of_all, **of_trial.get(name, {})}
        e = complete(effects)
        lighter = {**e["loading"]}
        lighter["draught"] *= 1.0 - e["unknown-lighter"]["magnitude"] * k / (len(TRIALS) - 1)
        s = coefficients(ship, {**effects, "loading": lighter})
        draw = np.random.default_rng([seed, k, 0])
        n_0 = draw.uniform(100.0, 106.0) / 60.0
        psi_0 = draw.uniform(-np.pi, np.pi)
        late = e["clock-offset"]["seconds"]
        more = int(np.ceil(max(-late, 0.0) / STEP))
        zigzag = name.startswith("zigzag")
        rows, count = voyage(s, n_0, psi_0, np.radians(degrees), zigzag, round(longest / STEP), more)
        logs[name] = sensed(rows, count, e)
    return logs


def sensed(rows: np.ndarray, count: int, e: Mapping[str, Mapping[str, float]]) -> np.ndarray:
    """Rows of ``voyage``, the first ``count`` of them, as sensors with their faults log them, each second.

    Positions, and velocities where they are its own, are first moved to the antenna, then delayed or filtered, then
    turned into the axes of the logged heading; the errors of the speed come last.
    """
    t = STEP * np.arange(len(rows))
    x, y, psi, u, v, r, n, delta = rows.T
    lever_x, lever_y = e["antenna"]["x"], e["antenna"]["y"]
    far_x, far_y = lever_x + e["antenna"]["x_alone"], lever_y + e["antenna"]["y_alone"]
    x, y = x + far_x * np.cos(psi) - far_y * np.sin(psi), y + far_x * np.sin(psi) + far_y * np.cos(psi)
    u, v = u - r * lever_y, v + r * lever_x
    receiver = e["position-latency"]
    latency = receiver["seconds"] + receiver["with_velocity"]
    x, y = _late(t, x, latency), _late(t, y, latency)
    north, east = u * np.cos(psi) - v * np.sin(psi), u * np.sin(psi) + v * np.cos(psi)
    north, east = _late(t, north, receiver["with_velocity"]), _late(t, east, receiver["with_velocity"])
    step = e["unknown-position-step"]["magnitude"] * np.sqrt(0.5) * (t >= 150.0)
    x, y = x + step, (1.0 + e["unknown-easting-scale"]["magnitude"]) * y + step
    smooth, compass = e["velocity-filter"], e["compass-deviation"]
    north, east = _low_pass(north, smooth["over_ground"]), _low_pass(east, smooth["over_ground"])
    north, east = north - e["water-log"]["north"], east - e["water-log"]["east"]
    heading = _low_pass(psi, e["heading-filter"]["time_constant"]) + e["heading-bias"]["angle"]
    heading = heading + compass["sine"] * np.sin(psi) + compass["cosine"] * np.cos(psi) + e["gyro-drift"]["heading"] * t
    heading = heading + e["unknown-deviation-quadrantal"]["magnitude"] * np.sin(2.0 * psi)
    u, v = north * np.cos(heading) + east * np.sin(heading), east * np.cos(heading) - north * np.sin(heading)
    u, v = _low_pass(u, smooth["along_axes"] + smooth["ahead"]), _low_pass(v, smooth["along_axes"])
    heading = heading + _low_pass(psi, e["heading-filter"]["alone"]) - psi + e["heading-bias"]["alone"]
    heading = heading + compass["sine_alone"] * np.sin(psi) + compass["cosine_alone"] * np.cos(psi)
    heading = heading + e["gyro-drift"]["heading_alone"] * t
    mounted, scale, zero = np.exp(-1j * e["log-misalignment"]["angle"]), e["speed-scale"], e["log-zero"]
    velocity = (u + 1j * v) * mounted
    u, v = velocity.real, velocity.imag
    growing = scale["grows"] * (u - SPEED) + e["unknown-log-quadratic"]["magnitude"] * (1.0 - u / SPEED)
    u, v = scale["factor"] * scale["both"] * u * (1.0 + growing), scale["both"] * v
    u, v = u + zero["ahead"], v + zero["abeam"] + e["unknown-sway-bias"]["magnitude"]
    r = _low_pass(r, smooth["yaw_rate"])
    r = r * (1.0 - e["unknown-gyro-compressed"]["magnitude"] * abs(r) * PROFILE["particulars.L_pp"] / SPEED)
    curved = 1.0 + e["gyro-scale"]["curve"] * abs(r) * PROFILE["particulars.L_pp"] / SPEED
    r = e["gyro-scale"]["factor"] * curved * r + e["gyro-bias"]["rate"] + e["gyro-drift"]["yaw_rate"] * t
    late = e["clock-offset"]["seconds"] + e["unknown-clock-drift"]["magnitude"] * t / 600.0
    n, delta = np.interp(t - late, t, n), np.interp(t - late, t, delta)
    held = round(e["unknown-controls-held"]["magnitude"] / STEP)
    if held:
        last = np.arange(len(t)) // held * held
        n, delta = n[last], delta[last]
    return np.column_stack([t, x, y, heading, u, v, r, n, delta])[: count : round(1.0 / STEP)]


def _late(t: np.ndarray, values: np.ndarray, seconds: float) -> np.ndarray:
    """The values of ``seconds`` ago; before the start they ran on as they do at it."""
    before = values[0] + (values[1] - values[0]) / (t[1] - t[0]) * (t - seconds)
    return np.where(t < seconds, before, np.interp(t - seconds, t, values))


def _low_pass(values: np.ndarray, time_constant: float) -> np.ndarray:
    """First-order lag of values at STEP, settled at the first."""
    if time_constant <= 0.0:
        return values
    share = np.exp(-STEP / time_constant)
    over_step = np.concatenate([values[:1], 0.5 * (values[1:] + values[:-1])])  # so that a ramp is trailed by it
    return _recursion(over_step, share, 1.0 - share, values[0])


@njit(cache=True)
def _recursion(values, share, gain, first):
    """y_k = share y_(k-1) + gain value_k, beginning at ``first``."""
    out = np.empty_like(values)
    out[0] = first
    for k in range(1, len(values)):
        out[k] = share * out[k - 1] + gain * values[k]
    return out


def noisy(rows: np.ndarray, noise: Noise, rng: np.random.Generator) -> np.ndarray:
    """The logged rows with the sensors' noise in them; samples are 1 s apart."""
    errors = rng.standard_normal((len(rows), 8))
    if noise.time_constant > 0.0:
        share = np.exp(-1.0 / noise.time_constant)
        for k in range(6):
            errors[:, k] = _recursion(errors[:, k].copy(), share, np.sqrt(1.0 - share**2), errors[0, k])
    return rows + np.column_stack([np.zeros(len(rows)), errors * np.array(astuple(noise)[:8])])


def simulate(
    ship: Mapping[str, float],
    effects: Parameters,
    seed: int,
    noise: Noise = WHITE,
    of_trial: Mapping[str, Parameters] = MappingProxyType({}),
) -> list[Trial]:
    """The ten trials of a ship with hidden effects.

    ship     coefficients overriding the profile's, as {"hull.R_0": 0.02}
    effects  parameters by tag, as {"current": {"north": 0.2, "east": 0.0}}; parameters left out stay null
    seed     of headings, revolutions and noise
    of_trial effects of single trials, by id, beside those of all or instead of them
    """
    from mmgtune.trial import Trial

    trials = []
    for k, (name, rows) in enumerate(sail(ship, effects, seed, of_trial=of_trial).items()):
        t, x, y, psi, u, v, r, n, delta = noisy(rows, noise, np.random.default_rng([seed, k, 1])).T.copy()
        trials.append(
            Trial(
                id=name,
                ship="suzaku",
                manoeuvre="zigzag" if name.startswith("zigzag") else "turning",
                source="generated",
                t=t,
                x=x,
                y=y,
                psi=psi,
                u=u,
                v_m=v,
                r=r,
                n=n,
                delta=delta,
                extra={},
                noise={channel: getattr(noise, channel) for channel in ("x", "y", "psi", "u", "v", "r")},
                note="",
                path=None,
                sha256="",
            )
        )
    return trials


def write(trials: list[Trial], folder: Path, tuning: Collection[str] = TUNING) -> None:
    """Write the trials and their split to ``folder``, replacing what is there."""
    from mmgtune.files import write_text
    from mmgtune.trial import write_trial

    for trial in trials:
        write_trial(trial, folder / f"{trial.id}.parquet", overwrite=True)
    roles = {role: [one.id for one in trials if (one.id in tuning) == (role == "tune")] for role in ("tune", "test")}
    lists = "".join(f"{role} = {json.dumps(names)}\n" for role, names in roles.items())
    write_text(folder / "split.toml", f'ship = "suzaku"\n{lists}')
