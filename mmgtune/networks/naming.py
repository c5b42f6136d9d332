"""What commands are given as a ship: a profile, particles of one, or the file of a trained network."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

from ..backends import Integrator
from ..given import ship_of
from ..particles import FILE, ParticlePredictor, load_particles
from ..profile import ShipProfile
from ..resources import folder, taken
from .file import SUFFIX, load_network
from .hybrid import Hybrid, HybridPredictor
from .predicting import NetworkPredictor

Other = TypeVar("Other")


def named_ship(
    given: str | Path | Other, integrator: Integrator = Integrator()
) -> ShipProfile | NetworkPredictor | HybridPredictor | ParticlePredictor | Other:
    """The profile, the particles or the network of a path or bundled name; anything else as it is.

    integrator  of particles and of a hybrid; a network alone has its own step
    A run folder with particles is meant by them.  Raises ProfileError or NetworkError.
    """
    if not isinstance(given, (str, Path)):
        return given
    inside = Path(given) / FILE
    if inside.is_file():
        return load_particles(inside).predictor(integrator)
    if str(given).endswith(Path(FILE).suffix):
        return load_particles(given).predictor(integrator)
    bundled = folder("ship_profiles") / f"{given}{SUFFIX}"
    path = taken(given, str(given).endswith(SUFFIX), bundled)
    if path is None:
        return ship_of(given)
    found = load_network(path)
    return HybridPredictor(found, integrator) if isinstance(found, Hybrid) else NetworkPredictor(found)
