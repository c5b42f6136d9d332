"""How far ships lie about the formulas: one standard deviation of each coefficient.

The sources at hand give no standard errors.  These numbers are of the size of the differences between the formulas and
captive tests of the ships in ``ship_profiles`` (SUZAKU, KVLCC2, Esso Osaka), rounded up; an assumption, and wide where
nonlinear terms of one fit stand in for those of another.
"""

SCATTER: dict[str, tuple[float, float]] = {
    "particulars.m_x_": (0.5, 0.0),
    "particulars.m_y_": (0.12, 0.0),
    "particulars.J_zz_": (0.15, 0.0),
    "hull.R_0": (0.4, 0.0),
    "hull.X_vv": (0.0, 0.04),
    "hull.X_vr": (0.0, 0.04),
    "hull.X_rr": (0.0, 0.015),
    "hull.X_vvvv": (0.0, 0.4),
    "hull.Y_v": (0.15, 0.0),
    "hull.Y_r": (0.0, 0.025),
    "hull.Y_vvv": (0.0, 0.5),
    "hull.Y_vvr": (0.0, 0.5),
    "hull.Y_vrr": (0.0, 0.25),
    "hull.Y_rrr": (0.0, 0.05),
    "hull.Y_vv": (0.4, 0.0),
    "hull.Y_vr": (0.0, 0.2),
    "hull.Y_rr": (0.0, 0.04),
    "hull.N_v": (0.12, 0.0),
    "hull.N_r": (0.2, 0.0),
    "hull.N_vvv": (0.0, 0.08),
    "hull.N_vvr": (0.0, 0.3),
    "hull.N_vrr": (0.0, 0.15),
    "hull.N_rrr": (0.0, 0.012),
    "hull.N_vv": (0.0, 0.03),
    "hull.N_rr": (0.0, 0.015),
    "wake.w_P0": (0.0, 0.08),
    "wake.C_w": (0.5, 0.0),
    "propeller.t_P": (0.0, 0.06),
    "propeller.k_0": (0.08, 0.0),
    "propeller.k_1": (0.08, 0.0),
    "rudder.t_R": (0.0, 0.2),
    "rudder.a_H": (0.0, 0.12),
    "rudder.x_H_": (0.0, 0.1),
    "rudder.eps": (0.0, 0.2),
    "rudder.kappa": (0.0, 0.1),
    "rudder.l_R_": (0.0, 0.15),
    "rudder.gamma_Rp": (0.0, 0.12),
    "rudder.gamma_Rn": (0.0, 0.12),
    "rudder.f_alpha": (0.1, 0.0),
    "rudder.C_Q": (0.0, 0.3),
}
"""One standard deviation by coefficient: a share of its value and a size in its unit, of which the larger counts."""

LEFT_ALONE = ("particulars.m_x_", "particulars.m_y_", "particulars.J_zz_")
"""Coefficients with a scatter that a fit leaves alone unless it is told: trials hardly tell them from others."""


def scatter_of(name: str, value: float) -> float | None:
    """One standard deviation of ships about the formula for a coefficient, in its unit; None where none is known."""
    if name not in SCATTER:
        return None
    share, size = SCATTER[name]
    return float(f"{max(share * abs(value), size):.3g}")
