"""One propeller with one rudder behind it."""

from typing import NamedTuple

from ..kinematics import flow
from ..mmg import rates
from ..quantities import Flow, Force, Lanes, PropellerOut, RudderOut, WakeOut


class Control(NamedTuple):
    """What the machinery does: Suyama et al. 2023, eq. 4."""

    n: Lanes  # propeller revolutions [1/s]
    delta: Lanes  # rudder angle, to starboard [rad]


class Components(NamedTuple):
    """The functions the arrangement is made of, in the order their results are needed."""

    hull: object
    wake: object
    propeller: object
    rudder: object


class Coefficients(NamedTuple):
    """The coefficients of the ship and of its components."""

    ship: object
    hull: object
    wake: object
    propeller: object
    rudder: object


class Breakdown(NamedTuple):
    """Everything the model knows about one instant: forces and the intermediates they come from."""

    flow: Flow
    hull: Force
    wake: WakeOut
    propeller: PropellerOut
    rudder: RudderOut
    total: Force


def forces(state, control, components, p):
    """All forces on the ship in one instant: Suyama et al. 2023, eq. 8.

    state State (velocities through the water), control Control, components Components, p Coefficients: floats or
    (n_lanes,) -> Breakdown.
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


def derivatives(state, control, components, p):
    """Time derivatives of the state: Suyama et al. 2023, eq. 12-13; arguments as for ``forces`` -> State of rates."""
    return rates(state, 0.0, 0.0, forces(state, control, components, p).total, p.ship)
