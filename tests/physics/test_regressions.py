"""Formulas from main dimensions, against numbers worked out apart from this program."""

import numpy as np
import pytest

from mmgtune.components import find
from mmgtune.physics.quantities import Flow, PropellerOut, Ship, WakeOut
from mmgtune.physics.regressions import (
    clarke1982,
    fujii1961,
    holtrop,
    inoue1981,
    kijima1990,
    surge_coupling,
    wageningen,
    yoshimura2012,
    zhou1983,
)
from mmgtune.physics.rudder.lift_drag import lift_and_drag
from mmgtune.physics.rudder.slip import SlipRudder, slip_rudder

SUZAKU = (83.0, 13.5, 3.8, 0.737)
LINES = holtrop.Lines(*SUZAKU, C_M=0.985, C_WP=0.83, lcb=0.0, C_st=0.0, D_P=2.8, A_BT=0.0, h_B=0.0, A_T=0.0)
U = 3.086


def digits(found, expected):
    """Equal to the digits written."""
    for name, text in expected.items():
        decimals = len(text.partition(".")[2])
        assert f"{float(getattr(found, name)):.{decimals}f}" == text, name


def test_suzaku_by_inoue_and_zhou():
    digits(
        inoue1981.linear_derivatives(*SUZAKU, 0.0), {"Y_v": "-0.312", "Y_r": "0.072", "N_v": "-0.092", "N_r": "-0.041"}
    )
    digits(
        zhou1983.nonlinear_derivatives(*SUZAKU),
        {"Y_vv": "-0.418", "Y_vr": "-0.284", "Y_rr": "-0.028", "N_rr": "-0.020", "N_vvr": "-0.127", "N_vrr": "-0.054"},
    )


def test_suzaku_by_clarke_in_the_denominators_of_the_mmg_standard_method():
    digits(clarke1982.linear_derivatives(*SUZAKU), {"Y_v": "-0.294", "Y_r": "0.061", "N_v": "-0.088", "N_r": "-0.043"})
    digits(clarke1982.added_masses(*SUZAKU), {"m_y_": "0.185", "J_zz_": "0.0107"})


def test_added_masses_of_suzaku_by_motoras_charts():
    digits(zhou1983.added_masses(*SUZAKU), {"m_x_": "0.0120", "m_y_": "0.1621", "J_zz_": "0.00996"})


def test_suzaku_by_holtrop():
    assert holtrop.wake_1982(LINES, U) == pytest.approx(0.376, abs=5e-4)
    assert holtrop.wake_1984(LINES, U) == pytest.approx(0.398, abs=5e-4)
    assert holtrop.thrust_deduction_1982(LINES) == pytest.approx(0.198, abs=5e-4)
    assert holtrop.thrust_deduction_1984(LINES) == pytest.approx(0.194, abs=5e-4)
    assert holtrop.wetted_surface(LINES) == pytest.approx(1376.0, abs=0.5)
    viscous = holtrop.form_factor(LINES) * holtrop.friction(U, 83.0) + holtrop.correlation(LINES)
    assert viscous * holtrop.wetted_surface(LINES) / (83.0 * 3.8) == pytest.approx(0.0125, abs=5e-5)


def test_holtrops_own_example():
    """The ship of Holtrop & Mennen 1982, section 5, at 25 kn: R_F 869.63 kN, S 7381.45 m^2, C_A 0.000352, t 0.1747,
    w 0.2584; R_W 557.11 kN, by the formulas of 1982, of which those of 1984 differ a little."""
    ship = holtrop.Lines(205.0, 32.0, 10.0, 37500.0 / (205.0 * 320.0), 0.98, 0.75, -0.75, 10.0, 8.0, 20.0, 4.0, 16.0)
    speed = 25.0 * 1852.0 / 3600.0
    assert holtrop.wetted_surface(ship) == pytest.approx(7381.45, abs=0.1)
    friction = holtrop.friction(speed, 205.0) * 0.5 * 1025.0 * speed**2 * holtrop.wetted_surface(ship)
    assert friction == pytest.approx(869.63e3, rel=1e-3)
    assert holtrop.correlation(ship) == pytest.approx(0.000352, abs=1e-6)
    assert holtrop.thrust_deduction_1982(ship) == pytest.approx(0.1747, abs=1e-4)
    assert holtrop.wake_1982(ship, speed) == pytest.approx(0.2584, abs=2e-3)
    assert holtrop.wave_resistance(ship, speed, 1025.0) == pytest.approx(557.11e3, rel=0.02)


def test_kijima_and_inoue_have_the_same_linear_terms():
    """Both are k and c of the same charts; Kijima's Y_r counts the added mass in surge apart."""
    m_x = float(zhou1983.added_masses(*SUZAKU).m_x_)
    kijima, inoue = kijima1990.hull_derivatives(*SUZAKU, m_x), inoue1981.linear_derivatives(*SUZAKU, 0.0)
    for name in ("Y_v", "N_v", "N_r"):
        assert getattr(kijima, name) == pytest.approx(getattr(inoue, name), rel=1e-12)
    assert kijima.Y_r == pytest.approx(inoue.Y_r, rel=2e-3)
    assert yoshimura2012.cubic_derivatives(*SUZAKU, 0.93, m_x, 0.16).Y_v == pytest.approx(inoue.Y_v, rel=1e-12)


def test_every_derivative_holds_the_ship_back():
    """Damping: a ship that drifts is pushed back and turned with her bow away, one that turns is slowed."""
    for size in (SUZAKU, (320.0, 58.0, 20.8, 0.81), (140.0, 20.0, 8.0, 0.55)):
        for found in (
            inoue1981.linear_derivatives(*size, 0.0),
            clarke1982.linear_derivatives(*size),
            kijima1990.hull_derivatives(*size, 0.01),
            yoshimura2012.cubic_derivatives(*size, 0.0, 0.01, 0.2),
        ):
            assert found.Y_v < 0.0
            assert found.N_v < 0.0
            assert found.N_r < 0.0
        assert zhou1983.nonlinear_derivatives(*size).Y_vv < 0.0
        assert surge_coupling.surge_coupling(size[3], 0.2) < 0.0


def test_b_series_of_four_blades():
    """B4-55 with P/D 1.0: K_T near 0.44 without advance, no thrust near J 1.1 (chart of the series)."""
    J = np.linspace(0.0, 1.2, 121)
    K_T = wageningen.thrust_coefficient(J, 1.0, 0.55, 4.0)
    assert K_T[0] == pytest.approx(0.44, abs=0.02)
    assert J[np.argmax(K_T < 0.0)] == pytest.approx(1.08, abs=0.05)
    assert (np.diff(K_T) < 0.0).all()
    k, misfit = wageningen.quadratic_through(J[:100], K_T[:100])
    assert misfit < 0.01
    assert k[0] == pytest.approx(K_T[0], abs=0.01)


def test_a_parabola_goes_through_a_parabola():
    J = np.linspace(0.0, 0.8, 9)
    k, misfit = wageningen.quadratic_through(J, 0.3 - 0.2 * J - 0.1 * J * J)
    np.testing.assert_allclose(k, [0.3, -0.2, -0.1], atol=1e-12)
    assert misfit < 1e-12


def test_normal_force_gradient_of_the_tanker():
    """KVLCC2: span 15.8 m, 112.5 m^2; the source has 2.747."""
    assert fujii1961.normal_force_gradient(15.8**2 / 112.5) == pytest.approx(3.04, abs=0.01)
    assert fujii1961.normal_force_gradient(1.539) == pytest.approx(2.490, abs=5e-4)


def test_lift_grows_stalls_and_is_odd():
    alpha = np.radians(np.linspace(-60.0, 60.0, 241))
    C_L, C_D = lift_and_drag(alpha, 1.8, 1.0, 0.01, np.radians(30.0), 0.5)
    np.testing.assert_allclose(C_L, -C_L[::-1], atol=1e-12)
    np.testing.assert_allclose(C_D, C_D[::-1], atol=1e-12)
    before = (alpha > 0.0) & (alpha < np.radians(30.0))
    assert (np.diff(C_L[before]) > 0.0).all()
    assert C_L[np.argmin(abs(alpha - np.radians(42.0)))] < C_L[np.argmin(abs(alpha - np.radians(30.0)))]
    slope = (C_L[121] - C_L[119]) / (alpha[121] - alpha[119])
    assert slope == pytest.approx(2 * np.pi * 1.8 * 2.5 / 3.5**2, rel=1e-2)
    assert (C_D >= 0.01).all()


SLIP = SlipRudder(
    6.0, 3.4, -0.5, 0.2, 0.2, -0.5, 0.95, 0.57, 0.8, 1.065, 0.935, -1.0, 0.4, 0.4, 1.0, 0.01, 0.6, 0.5
)  # fmt: skip
SHIP = Ship(1025.0, 83.0, 13.5, 3.8, 0.737, 0.9, 0.25, 0.01, 0.16, 0.01)


def rudder(u, n, delta, w_P=0.35, v=0.0, r=0.0, p=SLIP):
    flow = Flow(u, v, r, np.hypot(u, v), np.arctan2(-v, u), 0.0, r * 83.0 / np.hypot(u, v))
    u_P = (1.0 - w_P) * u
    return slip_rudder(flow, SHIP, WakeOut(w_P, u_P, 0.0), PropellerOut(None, 0.0, 0.0, 0.0, 2.8, n), delta, p)


def test_inflow_of_the_slip_rudder_is_kijimas_formula():
    """Written as the source has it, with the slip and a division by (1 - s)^2."""
    u, n, w_P = 3.0, 1.8, 0.35
    for delta, C in ((0.3, 0.935), (-0.3, 1.065)):
        s = 1.0 - (1.0 - w_P) * u / (n * 0.8 * 2.8)
        w_R = 1.0 - 0.95 * (1.0 - w_P)
        K = 0.57 * (1.0 - w_P) / (1.0 - w_R)
        g = 2.8 / 3.4 * K * (2.0 - (2.0 - K) * s) * s / (1.0 - s) ** 2
        expected = (1.0 - w_R) * u * np.sqrt(1.0 + C * g)
        assert rudder(u, n, delta).u_R == pytest.approx(expected, rel=1e-12)


def test_the_slip_rudder_is_regular_without_way_on_and_without_thrust():
    bollard = rudder(1e-9, 1.8, 0.3)
    assert bollard.u_R > 1.0
    assert bollard.F_N > 0.0
    assert rudder(3.0, 0.0, 0.3).u_R == pytest.approx(0.95 * 0.65 * 3.0)
    assert rudder(3.0, -1.0, 0.3).u_R == pytest.approx(0.95 * 0.65 * 3.0)
    assert np.isfinite(rudder(-2.0, 1.0, 0.3).F_N)
    assert rudder(-2.0, 0.0, 0.3).u_R < 0.0


def test_the_slipstream_turns_the_ship_more_to_port():
    assert abs(rudder(3.0, 1.8, -0.3).force.N) > abs(rudder(3.0, 1.8, 0.3).force.N)
    assert rudder(3.0, 1.8, 0.3).force.N > 0.0


def test_derivatives_hull_by_hand():
    """v' = -0.1 and r' = 0.3 put into eq. 2 of Mathioudakis et al."""
    part = find("hull", "derivatives")
    numbers = dict(
        R_0=0.012, X_vr=-0.04, Y_v=-0.3, Y_r=0.07, Y_vv=-0.4, Y_vr=-0.28, Y_rr=-0.03, Y_vvr=0.1, Y_vrr=-0.2,
        N_v=-0.09, N_r=-0.04, N_vv=0.01, N_rr=-0.02, N_vvr=-0.13, N_vrr=-0.05,
    )  # fmt: skip
    flow = Flow(3.0 * np.sqrt(0.99), -0.3, 0.3 * 3.0 / 83.0, 3.0, 0.1, -0.1, 0.3)
    force = part.function(flow, SHIP, part.params(**numbers))
    q = 0.5 * 1025.0 * 83.0 * 3.8 * 9.0
    assert pytest.approx(q * (-0.012 - 0.04 * -0.03), rel=1e-12) == force.X
    Y = -0.3 * -0.1 + 0.07 * 0.3 - 0.4 * -0.01 - 0.28 * -0.03 - 0.03 * 0.09 + 0.1 * 0.003 - 0.2 * -0.009
    assert pytest.approx(q * Y, rel=1e-12) == force.Y
    N = -0.09 * -0.1 - 0.04 * 0.3 + 0.01 * -0.01 - 0.02 * 0.09 - 0.13 * 0.003 - 0.05 * -0.009
    assert pytest.approx(q * 83.0 * N, rel=1e-12) == force.N
