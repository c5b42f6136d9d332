"""What a user can choose about a diagnosis."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import Problem, closest
from .choice import again, choice, effects, unknown_effects
from .scoring import VOYAGES, WINDOW
from .simulation import SimulationOptions
from .tuning import CHANNELS, FitOptions


@dataclass(frozen=True)
class DiagnoseOptions(SimulationOptions):
    """All choices of a diagnosis with working defaults.  A wrong integrator is itself a candidate cause."""

    a_r: float | None = again(FitOptions, "a_r", but="A diagnosis looks within five, weighed by what one expects.")
    targets: tuple[str, ...] = again(FitOptions, "targets")
    fixed: tuple[str, ...] = again(FitOptions, "fixed")
    effects: tuple[str, ...] = choice(
        (), "Effects to look for, comma-separated. Default: all that apply.", names=effects
    )
    channels: tuple[str, ...] = again(FitOptions, "channels", but="All in a diagnosis.")
    restart: float | None = again(FitOptions, "restart")
    leeway: float = choice(
        0.05,
        "How well coefficients of the hull, and of how its wake changes, that are not targets are known, as a share of "
        "their values: the standard deviation they are let go by, and a fifth to four tenths of it those of the forces "
        "of propeller and rudder. 0 holds them, as for voyages.",
        least=0.0,
        most=0.5,
    )
    most: int = choice(4, "Largest number of causes looked for.", least=1, most=8)
    level: float = choice(0.01, "Largest probability of a false alarm over the search.", above=0, below=0.5)
    keep_test: bool = choice(
        False,
        "Never look at trials kept for testing. Else they are looked at with the others where what these show does not "
        "tell them.",
    )
    seed: int = again(FitOptions, "seed")
    windows: int = choice(
        72, "Voyages: largest number of windows looked at, as many from each.", least=4, most=1000, panel=VOYAGES
    )

    @property
    def voyage_window(self) -> float:
        """Length of the windows of voyages [s]."""
        return WINDOW if self.restart is None else self.restart

    def problems(self) -> list[Problem]:
        """What makes no sense, effects and channels that do not exist among it."""
        found = super().problems()
        found += unknown_effects("effects", self.effects)
        for name in self.channels:
            if name not in (*CHANNELS, "v_m"):
                why = "every channel counts by its own noise" if ":" in name else ""
                fix = "leave the weight out" if why else closest(name, CHANNELS)
                found.append(Problem(f"unknown channel '{name}'", "channels", why, fix))
        return found

    def fit_options(self) -> FitOptions:
        """The choices that a fit knows too, as its options."""
        shared = {name: value for name, value in self.shared_with(FitOptions).items() if name != "channels"}
        return FitOptions(**shared, method="least-squares", initial="estimated")
