"""Trials with a known difference between plant and model."""

from __future__ import annotations

import numpy as np
import pytest

from mmgtune.model import Model
from mmgtune.profile import load_profile
from mmgtune.trial import Trial
from tests.diagnose.evidence.made import make_trials

WIND = 12e3
"""Size of a force fixed in the earth frame [N]: half the ship's resistance."""


@pytest.fixture(scope="package")
def plain(suzaku: Model) -> list[Trial]:
    """The ship as the model has her, with noise."""
    return make_trials(suzaku)


@pytest.fixture(scope="package")
def blown(suzaku: Model) -> list[Trial]:
    """The same with a constant force towards 1 rad."""
    return make_trials(
        suzaku,
        beside=lambda state: (WIND * np.cos(1.0 - state.psi), WIND * np.sin(1.0 - state.psi), np.zeros_like(state.psi)),
    )


@pytest.fixture(scope="package")
def damped() -> Model:
    """The model with a fifth more yaw damping than the ship."""
    model = Model(load_profile("suzaku"))
    model.base = model.base.copy()
    model.base[model.rows["hull.N_r"]] *= 1.2
    return model
