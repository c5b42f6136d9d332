"""Gradient of a rudder's normal force: Fujii & Tsuda 1961, as in the MMG standard method."""

from .formula import Formula

FORMULA = Formula(
    "Fujii & Tsuda 1961, J. Society of Naval Architects of Japan 110; as in Yasukawa & Yoshimura 2015", {}
)


def normal_force_gradient(aspect):
    """f_alpha [1/rad] of a rudder of aspect ratio ``aspect`` = span^2 / area [-]: floats or (n_lanes,)."""
    return 6.13 * aspect / (aspect + 2.25)
