"""Suyama et al. 2023, arXiv:2312.04224: the model of SUZAKU."""

import numpy as np
import pytest

from mmgtune.backends import Integrator
from tests import runs
from tests.runs import turn


def states(model, cases, theta=None):
    """As the paper simulates: Euler at the trial's own step."""
    return runs.states(model, cases, theta, integrator=Integrator("euler"))


def widths(model, theta=None):
    """Largest distance to the side [m] of the +35 and -35 deg turns of Fig. 3."""
    return [
        np.abs(
            states(model, turn(model, side * 35.0, initial=[0, 0, 0, 3.086, 0, 0], n=106 / 60), theta)[0, 0, :, 1]
        ).max()
        for side in (1, -1)
    ]


def test_figure_3_starboard_circle_is_the_larger(suzaku):
    starboard, port = widths(suzaku)
    assert starboard > 1.1 * port


def test_swapping_the_flow_straightening_reverses_figure_3(suzaku):
    swapped = suzaku.matrix(["rudder.gamma_Rp", "rudder.gamma_Rn"], [[0.172], [0.483]])
    starboard, port = widths(suzaku, swapped)
    assert port > 1.05 * starboard


@pytest.mark.parametrize(("degrees", "advance", "transfer", "diameter"), [(35, 187, 64, 152), (-35, 169, 55, 127)])
def test_turn_with_the_shipped_flap_table(suzaku, degrees, advance, transfer, diameter):
    """Independent run of the same equations with the same readings: advance, transfer, tactical diameter [m]."""
    x, y, psi = states(suzaku, turn(suzaku, degrees, initial=[0, 0, 0, 3.086, 0, 0], n=106 / 60))[0, 0, :, :3].T
    turned = np.degrees(np.abs(psi))
    assert np.interp(90.0, turned, x) == pytest.approx(advance, abs=1.0)
    assert np.interp(90.0, turned, np.abs(y)) == pytest.approx(transfer, abs=1.0)
    assert np.interp(180.0, turned, np.abs(y)) == pytest.approx(diameter, abs=1.0)


def test_self_propulsion_speed(suzaku):
    """Thrust and resistance balance at 3.593 m/s at 106 rpm with eq. 16 read as a four-quadrant coefficient.

    Balance of surge forces alone: the rudder amidships and straight course of the comparison.
    """
    names = ["propeller.C_PY0", "propeller.C_PY1", "propeller.C_PY2", "propeller.C_PN0_low", "propeller.C_PN1_low"]
    straight = suzaku.matrix(names, np.zeros((5, 1)))
    run = states(suzaku, turn(suzaku, 0.0, 3000.0, n=106 / 60), straight)
    assert run[0, 0, -1, 3] == pytest.approx(3.593, abs=0.005)


def test_literal_reading_of_equation_30_turns_wider(suzaku):
    literal = suzaku.matrix(["propeller.slipstream_kt"], [[1.0]])
    assert widths(suzaku, literal)[0] > 1.2 * widths(suzaku)[0]


@pytest.mark.parametrize("c", [0.93, 1.07, 1.2])
def test_exact_symmetry_of_the_rudder(suzaku, c):
    """eps and both gammas times c, (1-t_R), (1+a_H) and (x_R + a_H x_H) divided by c^2: the same motion."""
    value = suzaku.profile.value
    a_H = (1 + value("rudder.a_H")) / c**2 - 1
    lever = (value("rudder.x_R_") + value("rudder.a_H") * value("rudder.x_H_")) / c**2
    changed = {
        "rudder.eps": c * value("rudder.eps"),
        "rudder.gamma_Rp": c * value("rudder.gamma_Rp"),
        "rudder.gamma_Rn": c * value("rudder.gamma_Rn"),
        "rudder.t_R": 1 - (1 - value("rudder.t_R")) / c**2,
        "rudder.a_H": a_H,
        "rudder.x_H_": (lever - value("rudder.x_R_")) / a_H,
    }
    other = suzaku.matrix(list(changed), np.array([list(changed.values())]).T)
    for degrees in (10, -20, 35, -40):
        cases = turn(suzaku, degrees)
        same = states(suzaku, cases)[0, 0]
        np.testing.assert_allclose(states(suzaku, cases, other)[0, 0], same, atol=1e-9)
