"""What a user can choose about a fit."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from ..backends import BACKENDS, Integrator
from ..errors import OptionError, Problem, closest

OBJECTIVES = ("paper", "standardised")
LOSSES = ("squares", "huber")
METHODS = ("cma-es", "least-squares")
INITIAL = ("measured", "estimated")
INTEGRATORS = ("rk4", "euler")
DEFAULT_STARTS = 20


@dataclass(frozen=True)
class FitOptions:
    """All choices, each with the paper's value or a working default.

    a_r         half width of the box as a share of each pre-determined value
    seed        of every random number; 1 or more
    method      "cma-es": the global search of the paper, then least squares; or "least-squares" alone
    targets     names or patterns of coefficients; empty for the profile's own list
    fixed       names or patterns to leave out of the targets
    channels    what J compares, "x", "y:2", ...; empty for position and heading
    window      first and last time that count [s]
    objective   "paper": differences over L_pp and pi/4; "standardised": over the spread of each state in the tune
                trials, all six states (Wakita et al. 2022)
    restart     length of the windows [s] trials are cut into, each begun anew from a measured state; None for none
    every       time between samples that count [s]; None for all
    loss        "squares", or "huber", which lets outliers count by their size instead of its square
    regularise  what moving one coefficient to the edge of its box costs, as a share of J before; 0 for nothing
    initial     "measured": trials start from their first sample as in the paper; "estimated": from what fits best
                within the noise of that sample
    starts      least-squares starts: the pre-determined values, the rest at random
    identifiable  hold one coefficient of every direction that no trial can tell, so that the rest is unique
    """

    a_r: float = 0.5
    seed: int = 1
    method: str = "cma-es"
    targets: tuple[str, ...] = ()
    fixed: tuple[str, ...] = ()
    channels: tuple[str, ...] = ()
    window: tuple[float, float] | None = None
    objective: str = "paper"
    restart: float | None = None
    every: float | None = None
    loss: str = "squares"
    regularise: float = 0.0
    initial: str = "measured"
    integrator: str = "rk4"
    substeps: int = 1
    backend: str = "compiled"
    starts: int = DEFAULT_STARTS
    identifiable: bool = False

    def __post_init__(self) -> None:
        """Raises OptionError with everything that makes no sense."""
        problems = [
            Problem(f"unknown {what} '{value}'", option, fix=closest(value, known))
            for what, value, option, known in (
                ("method", self.method, "--method", METHODS),
                ("kind of initial state", self.initial, "--initial", INITIAL),
                ("integrator", self.integrator, "--integrator", INTEGRATORS),
                ("back end", self.backend, "--backend", BACKENDS),
                ("objective", self.objective, "--objective", OBJECTIVES),
                ("loss", self.loss, "--loss", LOSSES),
            )
            if value not in known
        ]
        for value, option in ((self.seed, "--seed"), (self.starts, "--starts"), (self.substeps, "--substeps")):
            if value < 1:
                problems.append(Problem(f"{option[2:]} is {value}", option, fix="give a whole number of 1 or more"))
        for length, option in ((self.restart, "--restart"), (self.every, "--every")):
            if length is not None and not length > 0.0:
                problems.append(Problem(f"{option[2:]} is {length:g} s", option, fix="give a time in seconds above 0"))
        if not self.regularise >= 0.0:
            problems.append(
                Problem(f"regularise is {self.regularise:g}", "--regularise", fix="give a share of J such as 0.001")
            )
        if self.method == "cma-es" and (self.regularise > 0.0 or self.loss != "squares"):
            problems.append(
                Problem(
                    "regularisation and other losses belong to least squares",
                    "--method",
                    "CMA-ES searches the plain sum of squares of the paper",
                    "add --method least-squares",
                )
            )
        if problems:
            raise OptionError(*problems)

    def make_integrator(self) -> Integrator:
        """The integrator chosen."""
        return Integrator(self.integrator, self.substeps)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(self).items()}
