"""The quantities components exchange.  Every field is a float or an array of lanes, shape (n_lanes,)."""

from typing import Any, NamedTuple

Lanes = Any
"""A float or an array of shape (n_lanes,): the equations do not care which."""


class State(NamedTuple):
    """Pose of midship in the earth frame and velocities in the ship's axes (Suyama et al. 2023, eq. 1-2)."""

    x: Lanes  # north [m]
    y: Lanes  # east [m]
    psi: Lanes  # heading, clockwise from north, unwrapped [rad]
    u: Lanes  # surge velocity [m/s]
    v_m: Lanes  # sway velocity at midship, to starboard [m/s]
    r: Lanes  # yaw rate, to starboard [rad/s]


STATES = State._fields
"""Order of the state in every array; units m, m, rad, m/s, m/s, rad/s."""


class Control(NamedTuple):
    """What the machinery does (eq. 4)."""

    n: Lanes  # propeller revolutions [1/s]
    delta: Lanes  # rudder angle, to starboard [rad]


class Force(NamedTuple):
    """Force and moment about midship in the ship's axes."""

    X: Lanes  # surge force, forward [N]
    Y: Lanes  # sway force, to starboard [N]
    N: Lanes  # yaw moment, to starboard [N m]


class Ship(NamedTuple):
    """Principal particulars and the inertia of ship and entrained water."""

    rho: Lanes  # density of water [kg/m^3]
    L_pp: Lanes  # length between perpendiculars [m]
    B: Lanes  # breadth [m]
    d: Lanes  # draught [m]
    C_b: Lanes  # block coefficient [-]
    x_G: Lanes  # centre of gravity, forward of midship [m]
    k_zz_: Lanes  # radius of gyration about G over L_pp [-]
    m_x_: Lanes  # added mass, surge [prime]
    m_y_: Lanes  # added mass, sway [prime]
    J_zz_: Lanes  # added moment of inertia, yaw [prime]


class Flow(NamedTuple):
    """Motion through the water and its prime values (eq. 14, text below eq. 13)."""

    u: Lanes  # surge velocity through water [m/s]
    v_m: Lanes  # sway velocity through water at midship [m/s]
    r: Lanes  # yaw rate [rad/s]
    U: Lanes  # reference speed of the prime system [m/s]; the ship's speed unless nearly at rest
    beta: Lanes  # drift angle atan2(-v_m, u) [rad]
    v_: Lanes  # v_m / U [-]
    r_: Lanes  # r L_pp / U [-]


class WakeOut(NamedTuple):
    """Inflow to the propeller."""

    w_P: Lanes  # wake fraction [-]
    u_P: Lanes  # longitudinal inflow velocity [m/s]
    beta_P: Lanes  # geometrical inflow angle [rad]


class PropellerOut(NamedTuple):
    """Propeller force and what the rudder needs to know of the slipstream."""

    force: Force
    J: Lanes  # advance ratio u_P / (n D_P) [-]; 0 where the propeller stands still
    K_T: Lanes  # thrust coefficient T / (rho n^2 D_P^4) [-]
    jet: Lanes  # 8 K_T n^2 D_P^2 / pi: gain of inflow velocity squared far behind the disk [m^2/s^2]
    D_P: Lanes  # propeller diameter [m]
    n: Lanes  # propeller revolutions [1/s]


class RudderOut(NamedTuple):
    """Rudder force with the hull's reaction to it."""

    force: Force
    u_R: Lanes  # longitudinal inflow velocity [m/s]
    v_R: Lanes  # lateral inflow velocity [m/s]
    alpha_R: Lanes  # effective inflow angle [rad]
    beta_R: Lanes  # effective drift angle at the rudder [rad]
    F_N: Lanes  # normal force [N]


class Air(NamedTuple):
    """Wind measured on board or nearby, at one instant."""

    north: Lanes  # velocity of the air over ground, north [m/s]
    east: Lanes  # and east [m/s]
    known: Lanes  # 1 where it was measured, 0 where not


class AboveWater(NamedTuple):
    """The part of a ship above the water, as wind sees it."""

    A_T: Lanes  # frontal area [m^2]
    A_L: Lanes  # lateral area [m^2]
    A_OD: Lanes  # lateral area of superstructure and deck cargo [m^2]
    C: Lanes  # centroid of A_L, forward of midship [m]
    C_BR: Lanes  # centroid of the superstructure, forward of midship [m]
    H_BR: Lanes  # top of the bridge above the waterline [m]
    H_C: Lanes  # centroid of A_L above the waterline [m]
    X_0: Lanes  # harmonics of the wind force over the angle of the apparent wind [-]
    X_1: Lanes
    X_3: Lanes
    X_5: Lanes
    Y_1: Lanes
    Y_3: Lanes
    Y_5: Lanes
    N_1: Lanes
    N_2: Lanes
    N_3: Lanes
