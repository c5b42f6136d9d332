"""What a user can choose about a fit, and about commands that fit many times."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import Problem
from .choice import OUTPUT, again, choice, effects
from .posterior import PosteriorOptions
from .simulation import SimulationOptions

OBJECTIVES = ("paper", "standardised")
LOSSES = ("squares", "huber")
CHANNELS = ("x", "y", "psi", "u", "v", "r")
METHODS = ("cma-es", "least-squares")
INITIAL = ("measured", "estimated")
SHORTEST = 0.01
"""Least time between samples that count, and of windows [s]."""
NARROWEST = 0.001
"""Least half width of the box: in one much narrower there are no numbers to search among."""


@dataclass(frozen=True)
class TuningOptions(SimulationOptions):
    """What every command that fits can be told: fit, sweep and leave-out."""

    targets: tuple[str, ...] = choice(
        (), 'Coefficients to tune: names or patterns as "hull.Y_*". Default: the profile\'s list.'
    )
    fixed: tuple[str, ...] = choice((), "Coefficients to leave out of the targets; names or patterns.", flag="--fix")
    with_effects: tuple[str, ...] = choice(
        (), "Effects to put into the profile and tune besides, such as wind-drift; they begin at none.", names=effects
    )
    identifiable: bool = choice(False, "Hold one coefficient of every direction that no trial can tell.")
    channels: tuple[str, ...] = choice(
        (),
        "Motion channels that count: x, y, psi, u, v, r; in a fit with weights as u:2. Default: x,y,psi in a fit.",
        names=lambda: CHANNELS,
    )
    window: tuple[float, float] | None = choice(None, "Only samples between FIRST:LAST seconds count.")
    objective: str = choice(
        "paper",
        "paper: position and heading over L_pp and pi/4; standardised: all states over their spread (L_MSE).",
        values=OBJECTIVES,
    )
    restart: float | None = choice(
        None, "Cut trials into windows this long (s), each begun anew from a measured state.", unit="s", least=SHORTEST
    )
    every: float | None = choice(None, "Compare samples this far apart (s); default all.", unit="s", least=SHORTEST)
    loss: str = choice("squares", "squares, or huber: outliers count by size; with least-squares.", values=LOSSES)
    regularise: float = choice(
        0.0,
        "Cost of moving one coefficient to the edge of its box, as a share of J before; with least-squares.",
        least=0,
        most=1e6,
    )
    prior: bool = choice(
        True,
        "Do not count how far coefficients move from what formulas that say their scatter, or sisters, give.",
        flag="--no-prior",
    )
    initial: str = choice(
        "measured",
        "Start trials from the measured first sample, or estimated within its noise.",
        values=INITIAL,
        called="kind of initial state",
    )
    starts: int = choice(
        20, "Starts of the least-squares solve: the values before, the rest at random.", least=1, most=1000
    )
    seed: int = again(PosteriorOptions, "seed")


@dataclass(frozen=True)
class SearchOptions(TuningOptions):
    """What a global search can be told besides."""

    method: str = choice("cma-es", "cma-es (then least squares) or least-squares alone.", values=METHODS)

    def problems(self) -> list[Problem]:
        """What makes no sense, alone or with the method."""
        found = super().problems()
        if self.method == "cma-es" and (self.regularise > 0.0 or self.loss != "squares"):
            found.append(
                Problem(
                    "regularisation and other losses belong to least squares",
                    "method",
                    "CMA-ES searches the plain sum of squares of the paper",
                    "add method=least-squares",
                )
            )
        return found


@dataclass(frozen=True)
class FitOptions(SearchOptions):
    """All choices of a fit, each with the paper's value or a working default."""

    a_r: float | None = choice(
        None,
        f"Half width of the box, as a share of each pre-determined value, from {NARROWEST:g}. "
        "Default: 0.5, and two scatters of its formula for a coefficient that says one.",
        flag="--ar",
        least=NARROWEST,
        most=5,
    )
    sisters: Path | None = choice(
        None,
        "Prior of sister ships: the folder of a fleet whose table names their class, or the file of a class.",
        flag="--prior",
    )

    def problems(self) -> list[Problem]:
        """What makes no sense; sisters are a prior."""
        found = super().problems()
        if self.sisters is not None and not self.prior:
            found.append(
                Problem(
                    "a prior of sister ships, and none",
                    "sisters",
                    "prior=False turns every prior off, that of the sisters too",
                    "leave prior=False out",
                )
            )
        return found

    def posterior_options(self) -> PosteriorOptions:
        """The choices of particles of the same ship and trials."""
        return PosteriorOptions(seed=self.seed, backend=self.backend)


@dataclass(frozen=True)
class SweepOptions(SearchOptions):
    """All choices of a sweep: those of a fit, at several widths of the box."""

    widths: tuple[float, ...] = choice(
        (0.2, 0.3, 0.4, 0.5, 0.6),
        f"Half widths of the box, comma-separated, each from {NARROWEST:g}.",
        flag="--ar",
        least=NARROWEST,
        most=5,
    )

    def problems(self) -> list[Problem]:
        """What makes no sense, no width and one given twice among it."""
        found = super().problems()
        if not self.widths or len(set(self.widths)) < len(self.widths):
            what = "a half width is given twice" if self.widths else "no half width to sweep over"
            why = "each width is a fit of its own, in a folder named after it"
            found.append(Problem(what, "widths", why, "write widths=0.2,0.3,0.4,0.5,0.6"))
        return found

    def at(self, a_r: float) -> FitOptions:
        """The choices of the fit at one half width."""
        return FitOptions(a_r=a_r, **self.shared_with(FitOptions))


@dataclass(frozen=True)
class LeaveOutOptions(TuningOptions):
    """All choices of leaving runs out: those of a fit by least squares, and how runs are dealt out."""

    a_r: float | None = again(FitOptions, "a_r")
    folds: int = choice(0, "Parts the runs are dealt out to; 0: each run alone.", least=0, most=1000)
    starts: int = again(TuningOptions, "starts", 4)
    manoeuvres: bool = choice(
        False,
        "Also repeat measured turning circles and zigzags with the model's own helmsman: advance, overshoots, ...",
        panel=OUTPUT,
    )

    def fit_options(self, **changed: Any) -> FitOptions:
        """The choices of each of its fits."""
        return FitOptions(**{**self.shared_with(FitOptions), "method": "least-squares", **changed})
