"""Ships put together from components."""

from __future__ import annotations

from ..physics.arrangements import single_propeller_single_rudder, single_propeller_twin_rudder
from .component import Arrangement
from .sources import KANG, SUYAMA, WAKITA

SINGLE_PROPELLER_SINGLE_RUDDER = Arrangement(
    tag="single-propeller-single-rudder",
    title="one propeller with one rudder behind it",
    control=single_propeller_single_rudder.Control,
    components=single_propeller_single_rudder.Components,
    coefficients=single_propeller_single_rudder.Coefficients,
    breakdown=single_propeller_single_rudder.Breakdown,
    forces=single_propeller_single_rudder.forces,
    cites=(SUYAMA,),
)

SINGLE_PROPELLER_TWIN_RUDDER = Arrangement(
    tag="single-propeller-twin-rudder",
    title="one propeller with two rudders behind it, and a bow thruster",
    control=single_propeller_twin_rudder.Control,
    components=single_propeller_twin_rudder.Components,
    coefficients=single_propeller_twin_rudder.Coefficients,
    breakdown=single_propeller_twin_rudder.Breakdown,
    forces=single_propeller_twin_rudder.forces,
    cites=(KANG, WAKITA),
)

ARRANGEMENTS = (SINGLE_PROPELLER_SINGLE_RUDDER, SINGLE_PROPELLER_TWIN_RUDDER)
"""Every arrangement there is; a profile that names none has the first."""
