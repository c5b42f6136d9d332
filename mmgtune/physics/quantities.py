"""The quantities components exchange.  Every field is a float or an array of lanes, shape (n_lanes,)."""

from collections import namedtuple
from typing import Any, NamedTuple, Protocol

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
    delta: Lanes  # rudder angle, to starboard [rad]


class Forces(Protocol):
    """What every arrangement tells of one instant; each has more of its own."""

    @property
    def flow(self) -> Flow:
        """Motion through the water."""

    @property
    def hull(self) -> Force:
        """Force on the hull."""

    @property
    def total(self) -> Force:
        """Force on the ship."""


class Surroundings(NamedTuple):
    """What was measured around the ship, and since when she has been under way, at one instant."""

    wind_north: Lanes  # velocity of the air over ground, north [m/s]
    wind_east: Lanes  # and east [m/s]
    wind_known: Lanes  # 1 where the wind was measured, 0 where not
    current_north: Lanes  # velocity of the water over ground, north [m/s]
    current_east: Lanes  # and east [m/s]
    current_north_rate: Lanes  # of that velocity over the step that ends here [m/s^2]
    current_east_rate: Lanes
    current_known: Lanes  # 1 where the current was measured, 0 where not
    wave_north: Lanes  # significant height times the unit vector to where waves come from, north [m]
    wave_east: Lanes  # and east [m]
    wave_known: Lanes  # 1 where waves were measured, 0 where not
    depth: Lanes  # of the water [m]
    depth_known: Lanes  # 1 where the depth was measured, 0 where not
    elapsed: Lanes  # time since the beginning of the run [s]


UNKNOWN = Surroundings(*(0.0 for _ in Surroundings._fields))
"""Nothing measured, at the beginning of a run."""

HELD = tuple(name for name in Surroundings._fields if name.endswith(("_known", "_rate")))
"""Surroundings that hold over a step between samples with the value at its end; the others change linearly."""

KNOWN = tuple(name.removesuffix("_known") for name in Surroundings._fields if name.endswith("_known"))
"""What may have been measured around a ship, by name: "wind" for the fields that begin with it."""

HARMONICS = ("X_0", "X_1", "X_3", "X_5", "Y_1", "Y_3", "Y_5", "N_1", "N_2", "N_3")
"""Harmonics of the wind force over the angle of the apparent wind."""

WindCoefficients = namedtuple("WindCoefficients", HARMONICS)  # type: ignore[misc]
WindCoefficients.__doc__ = "Harmonics of the wind force, all [-]."

ABOVE_WATER = ("A_T", "A_L", "A_OD", "C", "C_BR", "H_BR", "H_C")
"""Frontal area, lateral area, lateral area of superstructure and deck cargo [m^2]; centroid of A_L and of the
superstructure, forward of midship [m]; top of the bridge and centroid of A_L, above the waterline [m]."""

AboveWater = namedtuple("AboveWater", (*ABOVE_WATER, *HARMONICS))  # type: ignore[misc]
AboveWater.__doc__ = "The part of a ship above the water, as wind sees it: its geometry, then the harmonics."
