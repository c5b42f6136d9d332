"""A ship with two rudders behind one propeller and a bow thruster, put together from outside the program."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from mmgtune.backends import Integrator, pad
from mmgtune.components import Arrangement, Component, Field
from mmgtune.model import Model
from mmgtune.motions import Motion, as_trial
from mmgtune.physics.kinematics import flow
from mmgtune.physics.quantities import Flow, Force, Lanes, PropellerOut, RudderOut, WakeOut
from mmgtune.profile import Coefficient, Section, load_profile
from mmgtune.trial import write_trial
from tests.runs import states, turn


class Control(NamedTuple):
    n: Lanes
    delta_port: Lanes
    delta_stbd: Lanes
    n_bow: Lanes


class Components(NamedTuple):
    hull: object
    wake: object
    propeller: object
    rudder: object
    thruster: object


class Coefficients(NamedTuple):
    ship: object
    hull: object
    wake: object
    propeller: object
    rudder: object
    thruster: object


class Breakdown(NamedTuple):
    flow: Flow
    hull: Force
    wake: WakeOut
    propeller: PropellerOut
    rudder_port: RudderOut
    rudder_stbd: RudderOut
    thruster: Force
    total: Force


class Thruster(NamedTuple):
    """Side force per revolutions squared [N s^2] and position forward of midship [m]."""

    k: Lanes
    x: Lanes


def thruster_force(n, p):
    """Side force of a thruster in a tunnel; fades not with speed (a test)."""
    Y = p.k * n * abs(n)
    return Force(X=0.0 * Y, Y=Y, N=p.x * Y)


def forces(state, control, components, p):
    """Each rudder as if it stood alone behind the propeller, with half its area (see ``twin``)."""
    water = flow(state.u, state.v_m, state.r, p.ship.L_pp)
    hull = components.hull(water, p.ship, p.hull)
    wake = components.wake(water, p.wake)
    propeller = components.propeller(water, wake, control.n, p.ship, p.propeller)
    port = components.rudder(water, p.ship, wake, propeller, control.delta_port, p.rudder)
    stbd = components.rudder(water, p.ship, wake, propeller, control.delta_stbd, p.rudder)
    thruster = components.thruster(control.n_bow, p.thruster)
    total = Force(
        X=hull.X + propeller.force.X + port.force.X + stbd.force.X,
        Y=hull.Y + propeller.force.Y + port.force.Y + stbd.force.Y + thruster.Y,
        N=hull.N + propeller.force.N + port.force.N + stbd.force.N + thruster.N,
    )
    return Breakdown(water, hull, wake, propeller, port, stbd, thruster, total)


TWIN = Arrangement(
    tag="twin-rudder",
    title="two rudders behind one propeller, and a bow thruster",
    control=Control,
    components=Components,
    coefficients=Coefficients,
    breakdown=Breakdown,
    forces=forces,
)

THRUSTER = Component(
    kind="thruster",
    tag="tunnel",
    title="thruster in a tunnel",
    params=Thruster,
    function=thruster_force,
    cites=(),
    fields={"k": Field("side force per revolutions squared", "N s^2"), "x": Field("position forward of midship", "m")},
)


def twin() -> Model:
    """KVLCC2 with her rudder split into two of half the area, and a thruster."""
    ship = load_profile("kvlcc2")
    rudder = ship.sections["rudder"]
    area = rudder.coefficients["A_R"]
    halved = {**rudder.coefficients, "A_R": replace(area, value=0.5 * ship.value("rudder.A_R"))}
    sections = {
        **ship.sections,
        "rudder": replace(rudder, coefficients=halved),
        "thruster": Section(
            THRUSTER, {"k": Coefficient(2e4, "a test"), "x": Coefficient(0.4 * ship.L_pp, "a test")}, "a test"
        ),
    }
    sections["above_water"] = sections.pop("above_water")  # behind all components, as profiles are written and read
    return Model(replace(ship, sections=sections, arrangement=TWIN))


def with_controls(cases, columns):
    """The first of some cases, driven by other inputs (n_samples,) each."""
    return pad([cases.t[0]], [np.column_stack(columns)], [cases.initial[0]])


def sail(ship, folder):
    """Two generated trials, ``one`` and ``two``: each rudder at an angle of its own, and the thruster turning."""
    for name, side in (("one", 1.0), ("two", -1.0)):
        cases = turn(ship, 0.0, 300.0)
        n = cases.controls[0, :, 0]
        moving = with_controls(cases, [n, 0.3 * side + 0.0 * n, 0.2 * side + 0.0 * n, 2.0 + 0.0 * n])
        found = states(ship, moving, integrator=Integrator("rk4"))[0, 0]
        motion = Motion(name, moving.t[0], found, moving.controls[0], False, ship.inputs)
        write_trial(as_trial(ship.profile, motion), folder / f"{name}.parquet")


def with_value(profile, name, value):
    """A profile with one coefficient changed."""
    section, symbol = name.split(".")
    old = profile.sections[section]
    coefficients = {**old.coefficients, symbol: replace(old.coefficients[symbol], value=value)}
    return replace(profile, sections={**profile.sections, section: replace(old, coefficients=coefficients)})
