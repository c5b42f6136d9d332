"""Simulators: the equations of ``physics`` evaluated on lanes of candidates and cases."""

from __future__ import annotations

from functools import lru_cache

from ..errors import OptionError, Problem, among, brief
from ..model import Model
from ..physics.quantities import STATES
from .cases import Backend, Cases, Integrator, LaneResult, pad
from .compiled import Compiled
from .kernel.text import WIDTH
from .numpy_lanes import LaneModel, NumpyLanes

BACKENDS = ("compiled", "numpy", "jax")

__all__ = [
    "BACKENDS",
    "STATES",
    "WIDTH",
    "Backend",
    "Cases",
    "Integrator",
    "LaneModel",
    "LaneResult",
    "get_backend",
    "get_ready_backend",
    "pad",
]


def get_backend(name: str = "compiled") -> Backend:
    """The back end of that name.  Raises OptionError for an unknown one, and where JAX is missing."""
    if not isinstance(name, str) or name not in BACKENDS:
        raise OptionError(Problem(f"unknown back end {brief(name)}", "backend", **among(name, BACKENDS)))
    return _made(name)


@lru_cache(maxsize=len(BACKENDS))
def _made(name: str) -> Backend:
    if name == "compiled":
        return Compiled()
    if name == "numpy":
        return NumpyLanes()
    from .differentiable import JaxLanes

    return JaxLanes()


def get_ready_backend(model: Model) -> Backend | None:
    """The compiled back end where it can run a model at once; None where it would have to be compiled first."""
    compiled = get_backend("compiled")
    return compiled if isinstance(compiled, Compiled) and compiled.is_ready(model) else None
