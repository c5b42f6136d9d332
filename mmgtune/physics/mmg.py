"""Equations of motion of the MMG model, whatever the ship is made of: Suyama et al. 2023, eq. 5-7."""

from .kinematics import pose_rate
from .quantities import State
from .rigid_body import accelerations


def through_water(state, u_c, v_c):
    """The state with velocities through water that itself moves by u_c, v_c [m/s] in the ship's axes -> State."""
    return State(x=state.x, y=state.y, psi=state.psi, u=state.u - u_c, v_m=state.v_m - v_c, r=state.r)


def rates(state, u_c, v_c, total, ship):
    """Time derivatives of the state under a force: Suyama et al. 2023, eq. 5-7 -> State of rates.

    state State (velocities over ground), total Force, ship Ship; u_c, v_c [m/s] velocity of the water in the ship's
    axes.  For water that moves uniformly and steadily the equations of motion hold in velocities through water, and
    its velocity in the ship's axes changes only by her turning; ``carried`` adds what water does that is not steady.
    """
    x_dot, y_dot, psi_dot = pose_rate(state.psi, state.u, state.v_m, state.r)
    u_dot, v_m_dot, r_dot = accelerations(state.u - u_c, state.v_m - v_c, state.r, total.X, total.Y, total.N, ship)
    return State(x=x_dot, y=y_dot, psi=psi_dot, u=u_dot + state.r * v_c, v_m=v_m_dot - state.r * u_c, r=r_dot)


def carried(rate, u_c_dot, v_c_dot):
    """Rates of the state in water that gains velocity over ground: u_c_dot, v_c_dot [m/s^2] in the ship's axes.

    rate State of rates as if the water were steady -> the same with the water's own acceleration.  In uniform water
    the equations of motion hold in velocities through it at any acceleration: the pressure gradient that speeds the
    water up acts on the ship as on the water she displaces, whose mass is hers.
    """
    return State(x=rate.x, y=rate.y, psi=rate.psi, u=rate.u + u_c_dot, v_m=rate.v_m + v_c_dot, r=rate.r)
