"""Shared fixtures; kernels compiled by tests go to a cache of the checkout, so that a second run is quick."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

os.environ.setdefault("MMGTUNE_CACHE", str(Path(__file__).parent.parent / ".cache"))

from mmgtune.model import Model
from mmgtune.profile import load_profile
from mmgtune.resources import profile_names


@pytest.fixture(params=profile_names())
def any_model(request: pytest.FixtureRequest) -> Model:
    """The model of each bundled profile in turn."""
    return Model(load_profile(request.param))


@pytest.fixture(scope="session")
def suzaku() -> Model:
    """SUZAKU with its pre-determined coefficients."""
    return Model(load_profile("suzaku"))


@pytest.fixture(scope="session")
def esso_osaka() -> Model:
    """The 3 m Esso Osaka with captive-test coefficients."""
    return Model(load_profile("esso_osaka_3m"))
