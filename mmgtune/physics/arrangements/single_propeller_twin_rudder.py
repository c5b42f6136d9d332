"""One propeller with two rudders behind it that turn each on its own, and a bow thruster: a VecTwin ship."""

from typing import NamedTuple

from ..kinematics import flow
from ..quantities import Flow, Force, Lanes, PropellerOut, RudderOut, WakeOut


class Control(NamedTuple):
    """What the machinery does: Wakita et al., ensemble learning, Table 1."""

    n: Lanes  # propeller revolutions [1/s]
    delta_port: Lanes  # port rudder angle, to starboard [rad]
    delta_stbd: Lanes  # starboard rudder angle, to starboard [rad]
    n_bow: Lanes  # bow thruster revolutions, pushing to starboard [1/s]


class Components(NamedTuple):
    """The functions the arrangement is made of, in the order their results are needed."""

    hull: object
    propulsion: object
    rudder_pair: object
    rudder_port: object
    rudder_stbd: object
    thruster: object


class Coefficients(NamedTuple):
    """The coefficients of the ship and of its components."""

    ship: object
    hull: object
    propulsion: object
    rudder_pair: object
    rudder_port: object
    rudder_stbd: object
    thruster: object


class Breakdown(NamedTuple):
    """Everything the model knows about one instant: forces and the intermediates they come from."""

    flow: Flow
    hull: Force
    wake: WakeOut
    propeller: PropellerOut
    rudder_port: RudderOut
    rudder_stbd: RudderOut
    thruster: Force
    total: Force


def forces(state, control, components, p):
    """All forces on the ship in one instant: Wakita et al., ensemble learning, eq. 35, without wind.

    state State (velocities through the water), control Control, components Components, p Coefficients: floats or
    (n_lanes,) -> Breakdown.
    """
    water = flow(state.u, state.v_m, state.r, p.ship.L_pp)
    hull = components.hull(water, p.ship, p.hull)
    behind = components.propulsion(water, control.n, p.ship, p.propulsion)
    reaction = components.rudder_pair(behind.propeller, p.rudder_pair)
    to_port, to_stbd = control.delta_port, control.delta_stbd
    port = components.rudder_port(water, p.ship, behind, reaction, to_port, to_stbd, p.rudder_pair, p.rudder_port)
    stbd = components.rudder_stbd(water, p.ship, behind, reaction, to_stbd, to_port, p.rudder_pair, p.rudder_stbd)
    thruster = components.thruster(water, control.n_bow, p.ship, p.thruster)
    pushed = behind.propeller.force
    total = Force(
        X=hull.X + pushed.X + port.force.X + stbd.force.X + thruster.X,
        Y=hull.Y + pushed.Y + port.force.Y + stbd.force.Y + thruster.Y,
        N=hull.N + pushed.N + port.force.N + stbd.force.N + thruster.N,
    )
    return Breakdown(water, hull, behind.wake, behind.propeller, port, stbd, thruster, total)
