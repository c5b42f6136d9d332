"""What a check looks at: a ship profile, or a trained model in its place, which has no coefficients and no limits."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import ShipGiven
from ..backends import Integrator
from ..errors import OptionError, Problem
from ..model import Model
from ..networks import named_ship
from ..networks.naming import file_of
from ..predictor import PhysicsPredictor, Predictor, as_predictor
from ..profile.doubts import Doubt


@dataclass(frozen=True, eq=False)
class Subject:
    """A model to check.

    id      of the ship
    sha256  of the profile, or of the file of a trained model
    path    of either, "" where there is none
    model   with its coefficients, None of a trained model and of coefficients that are not those of a profile
    """

    id: str
    L_pp: float
    sha256: str
    path: str
    limits: dict[str, float]
    doubts: tuple[Doubt, ...]
    model: Model | None
    predictor: Predictor

    @property
    def numbers(self) -> dict[str, float]:
        """Coefficients by name."""
        return self.model.numbers() if self.model else {}


def subject_of(given: ShipGiven | Predictor, integrator: Integrator, backend: str) -> Subject:
    """What is given, or stands in that file; ``integrator`` and ``backend`` are those of a profile, or a hybrid.

    Raises ProfileError or NetworkError, and OptionError for a trained model with several networks: which is meant?
    """
    found: Any = named_ship(given, integrator)
    predictor = as_predictor(found, integrator=integrator, backend=backend)
    if predictor.n_members != 1:
        of = "parameter vectors" if isinstance(predictor, PhysicsPredictor) else "networks"
        what = f"'{predictor.name}' has {predictor.n_members} {of}, a check is of one model"
        raise OptionError(Problem(what, str(given)[:200], "", "check a profile, a hybrid or a network of one seed"))
    if isinstance(predictor, PhysicsPredictor):
        profile = predictor.model.profile
        path = str(profile.path or "")
        doubts = tuple(profile.doubts())
        model = Model(profile)
        own = model if np.array_equal(model.matrix(), predictor.theta) else None
        return Subject(profile.id, model.L_pp, profile.sha256, path, profile.limits, doubts, own, predictor)
    file = file_of(given) if isinstance(given, (str, Path)) else None
    digest = hashlib.sha256(file.read_bytes()).hexdigest() if file else ""
    id = str(getattr(predictor, "id", predictor.name))
    return Subject(id, predictor.L_pp, digest, str(file or ""), {}, (), None, predictor)
