"""Shared fixtures, and what lets several workers share the machine.

Kernels compiled by tests go to a cache of the checkout, for all workers and for the next run.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest

os.environ.setdefault("MMGTUNE_CACHE", str(Path(__file__).parent.parent / ".cache"))
os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", str(Path(os.environ["MMGTUNE_CACHE"]) / "jax"))
os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0.2")
if "PYTEST_XDIST_WORKER" in os.environ:  # a core each, for the commands that a worker starts too
    for name in ("MMGTUNE_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")

from mmgtune.model import Model
from mmgtune.profile import load_profile
from mmgtune.resources import profile_names


@pytest.hookimpl(tryfirst=True)  # before the plugin of the workers reads the groups
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The longest first, so that no worker is left with one at the end; those that share what took long in one worker.

    Markers of a module or of a test say which: ``slow(seconds)`` and ``xdist_group(name)``.
    """

    def seconds(item: pytest.Item) -> float:
        mark = item.get_closest_marker("slow")
        return float(mark.args[0]) if mark else 0.0

    items.sort(key=seconds, reverse=True)


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
