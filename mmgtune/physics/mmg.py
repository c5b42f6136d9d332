"""The MMG model: components put together into accelerations and a force breakdown."""

from typing import NamedTuple

from .kinematics import flow, pose_rate
from .quantities import Flow, Force, PropellerOut, RudderOut, State, WakeOut
from .rigid_body import accelerations


class Breakdown(NamedTuple):
    """Everything the model knows about one instant: forces and the intermediates they come from."""

    flow: Flow
    hull: Force
    wake: WakeOut
    propeller: PropellerOut
    rudder: RudderOut
    total: Force


class Components(NamedTuple):
    """The four functions a model is made of, in the order their results are needed."""

    hull: object
    wake: object
    propeller: object
    rudder: object


class Coefficients(NamedTuple):
    """The coefficients of the ship and of its four components."""

    ship: object
    hull: object
    wake: object
    propeller: object
    rudder: object


def forces(state, control, components, p):
    """All forces on the ship in one instant: Suyama et al. 2023, eq. 8.

    state State, control Control, components Components, p Coefficients: floats or (n_lanes,) -> Breakdown.
    """
    water = flow(state.u, state.v_m, state.r, p.ship.L_pp)
    hull = components.hull(water, p.ship, p.hull)
    wake = components.wake(water, p.wake)
    propeller = components.propeller(water, wake, control.n, p.ship, p.propeller)
    rudder = components.rudder(water, p.ship, wake, propeller, control.delta, p.rudder)
    total = Force(
        X=hull.X + propeller.force.X + rudder.force.X,
        Y=hull.Y + propeller.force.Y + rudder.force.Y,
        N=hull.N + propeller.force.N + rudder.force.N,
    )
    return Breakdown(flow=water, hull=hull, wake=wake, propeller=propeller, rudder=rudder, total=total)


def through_water(state, u_c, v_c):
    """The state with velocities through water that itself moves by u_c, v_c [m/s] in the ship's axes -> State."""
    return State(x=state.x, y=state.y, psi=state.psi, u=state.u - u_c, v_m=state.v_m - v_c, r=state.r)


def rates(state, u_c, v_c, total, ship):
    """Time derivatives of the state under a force: Suyama et al. 2023, eq. 5-7 -> State of rates.

    state State (velocities over ground), total Force, ship Ship; u_c, v_c [m/s] velocity of the water in the ship's
    axes.  For water that moves uniformly and steadily the equations of motion hold in velocities through water, and
    its velocity in the ship's axes changes only by her turning.
    """
    x_dot, y_dot, psi_dot = pose_rate(state.psi, state.u, state.v_m, state.r)
    u_dot, v_m_dot, r_dot = accelerations(state.u - u_c, state.v_m - v_c, state.r, total.X, total.Y, total.N, ship)
    return State(x=x_dot, y=y_dot, psi=psi_dot, u=u_dot + state.r * v_c, v_m=v_m_dot - state.r * u_c, r=r_dot)


def derivatives(state, control, components, p):
    """Time derivatives of the state: Suyama et al. 2023, eq. 12-13; arguments as for ``forces`` -> State of rates."""
    return rates(state, 0.0, 0.0, forces(state, control, components, p).total, p.ship)
