"""What commands are given as a ship: a profile, particles of one, or the file of a trained network."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TypeVar, cast

from ..arguments import Found, ship_of
from ..backends import Integrator
from ..errors import ProfileError
from ..particles import ParticlePredictor, Particles, load_particles
from ..predictor import PhysicsPredictor, Predictor
from ..profile import ShipProfile
from ..resources import folder, in_run, must_be_name, taken
from ..run_files import MODEL, PARTICLES
from .ensemble import Ensemble, EnsemblePredictor
from .file import SUFFIX, Trained, content_of, load_network
from .hybrid import Hybrid, HybridPredictor
from .mixture import Mixture, MixturePredictor
from .model import Network
from .predicting import NetworkPredictor

Other = TypeVar("Other")
TrainedPredictor = NetworkPredictor | HybridPredictor | EnsemblePredictor | MixturePredictor


def named_ship(
    given: str | Path | Other, integrator: Integrator = Integrator()
) -> ShipProfile | TrainedPredictor | ParticlePredictor | Other:
    """The profile, the particles or the network of a path or bundled name, or those that a result has found.

    integrator  of particles and of a hybrid; networks alone have a step of their own
    Anything else is returned as it is.  A run folder is meant by its particles or trained model, else by its profile.
    Raises ProfileError or NetworkError.
    """
    if not isinstance(given, (str, Path)):
        found = given.as_ship() if isinstance(given, Found) else given
        if isinstance(found, Particles):
            return found.predictor(integrator)
        if isinstance(found, (Network, Hybrid, Ensemble, Mixture)):
            return predictor_of(found, integrator)
        return cast(Other, found)
    path = file_of(given)
    if path is None:
        return ship_of(given)
    if path.suffix == Path(PARTICLES).suffix:
        return load_particles(path).predictor(integrator)
    return predictor_of(load_network(path), integrator)


def file_of(given: str | Path) -> Path | None:
    """The file of particles or of a trained model of that path or bundled name; None where no such is meant."""
    must_be_name(given, "ship", ProfileError)
    inside = in_run(given, PARTICLES) or in_run(given, MODEL)
    if inside is not None:
        return inside
    if str(given).endswith(Path(PARTICLES).suffix):
        return Path(given)
    bundled = folder("ship_profiles") / f"{given}{SUFFIX}"
    return taken(given, str(given).endswith(SUFFIX), bundled)


def sha256_of(predictor: Predictor) -> str:
    """What tells the coefficients or weights of a predictor from others of its name; "" of one of somebody's own."""
    match predictor:
        case ParticlePredictor(particles=Particles() as particles):
            content = predictor.model.profile.sha256.encode() + particles.values.tobytes()
        case PhysicsPredictor():
            content = predictor.model.profile.sha256.encode() + predictor.theta.tobytes()
        case NetworkPredictor():
            content = content_of(predictor.network)
        case HybridPredictor():
            content = content_of(predictor.hybrid)
        case EnsemblePredictor():
            content = content_of(predictor.ensemble)
        case MixturePredictor():
            content = content_of(predictor.mixture)
        case _:
            return ""
    return hashlib.sha256(content).hexdigest()


def predictor_of(model: Trained, integrator: Integrator = Integrator()) -> TrainedPredictor:
    """What was trained as a predictor; ``integrator`` of a hybrid."""
    if isinstance(model, Hybrid):
        return HybridPredictor(model, integrator)
    if isinstance(model, Mixture):
        return MixturePredictor(model)
    return EnsemblePredictor(model) if isinstance(model, Ensemble) else NetworkPredictor(model)
