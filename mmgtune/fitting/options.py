"""What a user can choose about a fit."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from ..backends import BACKENDS, Integrator
from ..errors import OptionError, Problem, closest

METHODS = ("cma-es", "least-squares")
INITIAL = ("measured", "estimated")
INTEGRATORS = ("euler", "rk4")
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
    initial: str = "measured"
    integrator: str = "euler"
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
            )
            if value not in known
        ]
        for value, option in ((self.seed, "--seed"), (self.starts, "--starts"), (self.substeps, "--substeps")):
            if value < 1:
                problems.append(Problem(f"{option[2:]} is {value}", option, fix="give a whole number of 1 or more"))
        if problems:
            raise OptionError(*problems)

    def make_integrator(self) -> Integrator:
        """The integrator chosen."""
        return Integrator(self.integrator, self.substeps)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(self).items()}
