"""How trials are simulated, wherever that is done."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .choice import Options, choice

if TYPE_CHECKING:
    from ..backends import Integrator

INTEGRATORS = ("euler", "rk4")
BACKENDS = ("compiled", "numpy", "jax")


@dataclass(frozen=True)
class SimulationOptions(Options):
    """How trials are simulated."""

    integrator: str = choice("rk4", "Method of integration: rk4, or euler as the paper does.", values=INTEGRATORS)
    substeps: int = choice(1, "Integration steps between two samples.", least=1, most=1000)
    backend: str = choice(
        "compiled", "compiled, numpy, or jax, which is to be installed.", values=BACKENDS, called="back end"
    )

    def make_integrator(self) -> Integrator:
        """The integrator chosen."""
        from ..backends import Integrator

        return Integrator(self.integrator, self.substeps)
