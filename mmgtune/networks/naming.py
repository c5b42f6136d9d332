"""What commands are given as a ship: a profile, or the file of a trained network."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

from ..backends import Integrator
from ..given import ship_of
from ..profile import ShipProfile
from ..resources import folder, taken
from .ensemble import Ensemble, EnsemblePredictor
from .file import SUFFIX, Trained, load_network
from .hybrid import Hybrid, HybridPredictor
from .mixture import Mixture, MixturePredictor
from .predicting import NetworkPredictor

Other = TypeVar("Other")
TrainedPredictor = NetworkPredictor | HybridPredictor | EnsemblePredictor | MixturePredictor


def named_ship(
    given: str | Path | Other, integrator: Integrator = Integrator()
) -> ShipProfile | TrainedPredictor | Other:
    """The profile, or the network, of a path or bundled name; anything else as it is.

    integrator  of a hybrid; networks alone have a step of their own
    Raises ProfileError or NetworkError.
    """
    if not isinstance(given, (str, Path)):
        return given
    bundled = folder("ship_profiles") / f"{given}{SUFFIX}"
    path = taken(given, str(given).endswith(SUFFIX), bundled)
    if path is None:
        return ship_of(given)
    return predictor_of(load_network(path), integrator)


def predictor_of(model: Trained, integrator: Integrator = Integrator()) -> TrainedPredictor:
    """What was trained as a predictor; ``integrator`` of a hybrid."""
    if isinstance(model, Hybrid):
        return HybridPredictor(model, integrator)
    if isinstance(model, Mixture):
        return MixturePredictor(model)
    return EnsemblePredictor(model) if isinstance(model, Ensemble) else NetworkPredictor(model)
