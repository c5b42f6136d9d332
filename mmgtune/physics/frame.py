"""The earth frame and the ship's axes: the only copy of the rotation between them."""

from .elementary import cos, sin


def to_earth(psi, ahead, starboard):
    """North and east components of a vector given in the ship's axes; psi heading [rad]."""
    cos_psi = cos(psi)
    sin_psi = sin(psi)
    return ahead * cos_psi - starboard * sin_psi, ahead * sin_psi + starboard * cos_psi


def to_ship(psi, north, east):
    """Components ahead and to starboard of a vector given in the earth frame; psi heading [rad]."""
    cos_psi = cos(psi)
    sin_psi = sin(psi)
    return north * cos_psi + east * sin_psi, east * cos_psi - north * sin_psi
