"""What a user can choose where models are scored, not tuned."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..errors import Problem
from .choice import INPUT, again, choice
from .particles import ParticleOptions
from .simulation import SimulationOptions
from .tuning import LeaveOutOptions, TuningOptions

if TYPE_CHECKING:
    from ..backends import Integrator

VOYAGES = "Voyages"
"""Panel of the help."""

FORMATS = ("text", "json", "junit", "github", "markdown")
"""Formats of a check's report, each a module of ``checking.renderers``."""


def _metrics() -> tuple[str, ...]:
    from ..metrics import METRICS

    return tuple(METRICS)


@dataclass(frozen=True)
class ValidateOptions(SimulationOptions):
    """All choices of a validation."""

    restart: float | None = again(LeaveOutOptions, "restart")
    sigma_from: str | None = choice(
        None, "Trials whose spread L_MSE is counted in. Default: the trials scored.", panel=INPUT
    )
    manoeuvres: bool = again(LeaveOutOptions, "manoeuvres")
    initial: str = again(TuningOptions, "initial", but="Indices of --manoeuvres begin as they were measured.")


@dataclass(frozen=True)
class CompareModelsOptions(SimulationOptions, ParticleOptions):
    """All choices of ``compare``."""

    restart: float = again(LeaveOutOptions, "restart", 100.0)
    sigma_from: str | None = again(ValidateOptions, "sigma_from")
    only: tuple[str, ...] = choice(
        (), "Only trials of these kinds of manoeuvre, ids, runs, or roles: tune, test, other.", panel=INPUT
    )


WINDOW = 120.0
"""Seconds of the windows that voyages are cut into (Mathioudakis et al.: 2-minute trajectories)."""


@dataclass(frozen=True)
class VoyageOptions(ValidateOptions):
    """All choices of a validation on voyages: those of any, and what only windows of voyages have."""

    r_max: float | None = choice(
        None,
        "Largest yaw rate of the ship, which cVDM is relative to. Default: that of the first model.",
        unit="deg/s",
        above=0.0,
        panel=VOYAGES,
    )
    classes: tuple[float, ...] = choice(
        (1.3, 4.1),
        "Voyages: cVDM in percent up to which a window is optimal, and satisfactory.",
        above=0.0,
        panel=VOYAGES,
    )
    gap: float = choice(
        10.0, "Voyages: longest gap that a window may hold; longer ones end it.", unit="s", above=0.0, panel=VOYAGES
    )

    @property
    def window(self) -> float:
        """Length of the windows [s]."""
        return WINDOW if self.restart is None else self.restart

    def problems(self) -> list[Problem]:
        """Two limits in order; manoeuvres are repeated on trials only."""
        found = super().problems()
        if len(self.classes) != 2 or not self.classes[0] < self.classes[1]:
            shown = ",".join(f"{limit:g}" for limit in self.classes)
            fix = "write classes=1.3,4.1"
            found.append(
                Problem(
                    f"classes {shown} are not two limits in order",
                    "classes",
                    "between them lies the middle of three classes, the larger limit behind",
                    fix,
                )
            )
        return found


@dataclass(frozen=True)
class CheckOptions(SimulationOptions):
    """All choices of a check; with a baseline its integrator is the one to use."""

    metrics: tuple[str, ...] = choice(
        (), "Only these metrics; repeatable, or with commas.", panel=INPUT, names=_metrics
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
