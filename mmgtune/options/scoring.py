"""What a user can choose where models are scored, not tuned."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .choice import INPUT, again, choice
from .simulation import SimulationOptions
from .tuning import LeaveOutOptions

if TYPE_CHECKING:
    from ..backends import Integrator

FORMATS = ("text", "json", "junit", "github", "markdown")
"""Formats of a check's report, each a module of ``checking.renderers``."""


@dataclass(frozen=True)
class ValidateOptions(SimulationOptions):
    """All choices of a validation."""

    restart: float | None = again(LeaveOutOptions, "restart")
    sigma_from: str | None = choice(
        None, "Trials whose spread L_MSE is counted in. Default: the trials scored.", panel=INPUT
    )
    manoeuvres: bool = again(LeaveOutOptions, "manoeuvres")


@dataclass(frozen=True)
class CheckOptions(SimulationOptions):
    """All choices of a check; with a baseline its integrator is the one to use."""

    metrics: tuple[str, ...] = choice(
        (), "Only these metrics (J, MED, cVDM, rms_psi, advance, ...); repeatable, or with commas.", panel=INPUT
    )
    integrator: str | None = again(SimulationOptions, "integrator", None, but="Default: the baseline's.")  # type: ignore[assignment]
    substeps: int | None = again(SimulationOptions, "substeps", None, but="Default: the baseline's.")  # type: ignore[assignment]

    def asked_integrator(self, recorded: Integrator | None = None) -> Integrator | None:
        """The integrator asked for, what is left open as recorded in a baseline; None where nothing is asked for."""
        from ..backends import Integrator

        if self.integrator is None and self.substeps is None:
            return None
        name = self.integrator or (recorded.name if recorded else SimulationOptions.integrator)
        return Integrator(name, self.substeps or (recorded.substeps if recorded else 1))
