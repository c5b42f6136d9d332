"""What commands are given as a ship: a profile, or the file of a trained network."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

from ..backends import Integrator
from ..given import ship_of
from ..profile import ShipProfile
from ..resources import folder, taken
from .file import SUFFIX, load_network
from .hybrid import Hybrid, HybridPredictor
from .predicting import NetworkPredictor

Other = TypeVar("Other")


def named_ship(
    given: str | Path | Other, integrator: Integrator = Integrator()
) -> ShipProfile | NetworkPredictor | HybridPredictor | Other:
    """The profile, or the network, of a path or bundled name; anything else as it is.

    integrator  of a hybrid; a network alone has its own step
    Raises ProfileError or NetworkError.
    """
    if not isinstance(given, (str, Path)):
        return given
    bundled = folder("ship_profiles") / f"{given}{SUFFIX}"
    path = taken(given, str(given).endswith(SUFFIX), bundled)
    if path is None:
        return ship_of(given)
    found = load_network(path)
    return HybridPredictor(found, integrator) if isinstance(found, Hybrid) else NetworkPredictor(found)
