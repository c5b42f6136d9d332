"""What a user can choose about a diagnosis."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from ..backends import STATES
from ..effects import effect_tags
from ..errors import OptionError, Problem, closest
from ..fitting import FitOptions

CHANNELS = STATES
"""All of the motion is looked at: velocities tell sensors from forces."""


@dataclass(frozen=True)
class DiagnoseOptions:
    """All choices with working defaults.

    a_r         half width of the box of each target as a share of its pre-determined value
    targets     names or patterns of the coefficients that may be re-tuned; empty for the profile's own list
    fixed       names or patterns to leave out of the targets
    effects     tags of the effects to look for; empty for all that apply
    channels    motion channels that count
    integrator  "rk4" or "euler" at the trial's own step; a wrong one is itself a candidate cause
    substeps    steps between two samples
    backend     "compiled" or "numpy"
    seed        of the starts and of the simulated critical values
    restart     length of the windows [s] trials are cut into, each begun anew from a measured state; None for none
    most        largest number of causes looked for
    level       largest probability of a false alarm over the whole search
    """

    a_r: float = 0.5
    targets: tuple[str, ...] = ()
    fixed: tuple[str, ...] = ()
    effects: tuple[str, ...] = ()
    channels: tuple[str, ...] = ()
    integrator: str = "rk4"
    substeps: int = 1
    backend: str = "compiled"
    seed: int = 1
    restart: float | None = None
    most: int = 4
    level: float = 0.01

    def __post_init__(self) -> None:
        """Raises OptionError with everything that makes no sense."""
        known = effect_tags()
        problems = [
            Problem(f"unknown effect '{tag}'", "--effects", fix=closest(tag, known))
            for tag in self.effects
            if tag not in known
        ]
        if not 1 <= self.most <= 8:
            problems.append(Problem(f"at most {self.most} causes", "--most", fix="give a number from 1 to 8"))
        if not 0.0 < self.level < 0.5:
            problems.append(Problem(f"level is {self.level:g}", "--level", fix="give a probability such as 0.01"))
        if problems:
            raise OptionError(*problems)
        self.fit_options()

    def fit_options(self) -> FitOptions:
        """The same choices as a fit knows them."""
        return FitOptions(
            a_r=self.a_r,
            seed=self.seed,
            method="least-squares",
            targets=self.targets,
            fixed=self.fixed,
            initial="estimated",
            integrator=self.integrator,
            substeps=self.substeps,
            backend=self.backend,
            restart=self.restart,
        )

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(self).items()}
