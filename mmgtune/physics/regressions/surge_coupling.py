"""Surge force of drift and yaw together, from the block coefficient: Hasegawa 1980."""

from .formula import Formula

FORMULA = Formula(
    "Hasegawa 1980, J. Kansai Society of Naval Architects 176, from memory", {"C_b": (0.5, 0.85)}, "limits assumed"
)


def surge_coupling(C_b, m_y_):
    """X_vr without m_y' [prime]: m_y' (1.11 C_b - 1.07); C_b [-], m_y_ added mass in sway [prime].

    Floats or (n_lanes,).
    """
    return m_y_ * (1.11 * C_b - 1.07)
