"""Models scored on trials and compared: what ``mmgtune validate`` does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .errors import OptionError, Problem
from .given import ShipGiven, TrialsGiven, ship_of, trials_of
from .model import Model
from .objective import spread
from .options import ValidateOptions
from .profile import ShipProfile
from .repeating import Repeated, document, repeat
from .validation import L_MSE, TrialScore, by_manoeuvre, by_run, by_trial, score


@dataclass(frozen=True, eq=False)
class Scored:
    """One profile: what it was called, its scores by trial or window, and its manoeuvres repeated where asked for."""

    name: str
    ship: ShipProfile
    scores: tuple[TrialScore, ...]
    repeated: tuple[Repeated, ...] = ()

    def __repr__(self) -> str:
        """In a line."""
        return f"Scored({self.name}, {len(self.scores)} runs, L_MSE {L_MSE(self.scores):.4g})"

    def to_dict(self) -> dict[str, Any]:
        """Scores over everything, by kind of manoeuvre and by run, for JSON; what diverged is null."""
        return {
            "profile": self.name,
            "id": self.ship.id,
            "sha256": self.ship.sha256,
            **_row(self.scores),
            "by_manoeuvre": {
                kind: {"runs": len(by_run(of)), **_row(of)} for kind, of in by_manoeuvre(self.scores).items()
            },
            "trials": [
                {"id": id, "manoeuvre": of[0].manoeuvre, "windows": len(of), **_row(of)}
                for id, of in by_trial(self.scores).items()
            ],
        }


@dataclass(frozen=True, eq=False)
class Validation:
    """Profiles scored on the same trials.

    trials, sigma_from  what the trials, and those whose spread is counted in, were called
    sigma   what L_MSE divides differences of each state by [SI]
    """

    profiles: tuple[Scored, ...]
    trials: str
    sigma: Mapping[str, float]
    sigma_from: str
    options: ValidateOptions = field(default_factory=ValidateOptions)

    def __repr__(self) -> str:
        """In a line."""
        named = ", ".join(f"{one.name} {L_MSE(one.scores):.4g}" for one in self.profiles[:4])
        more = f" and {len(self.profiles) - 4} more" if len(self.profiles) > 4 else ""
        return f"Validation(on {self.trials[-60:]}, L_MSE of {named}{more})"

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        rows = [one.to_dict() for one in self.profiles]
        if self.options.manoeuvres:
            for row, one in zip(rows, self.profiles, strict=True):
                row["manoeuvres"] = document(one.repeated)
        return {
            "schema": 1,
            "kind": "validate",
            "trials": self.trials,
            "window_s": self.options.restart,
            "sigma": dict(self.sigma),
            "sigma_from": self.sigma_from,
            "integrator": self.options.integrator,
            "options": self.options.to_dict(),
            "profiles": rows,
        }


def validate(
    profiles: ShipGiven | Sequence[ShipGiven], trials: TrialsGiven, options: ValidateOptions = ValidateOptions()
) -> Validation:
    """Score profiles on trials, each trial or window of it simulated from its first measured state.

    profiles, trials  objects, paths or bundled names; one profile or several
    Raises OptionError for no profile, and for trials in which a state does not vary.
    """
    several = [profiles] if isinstance(profiles, (ShipProfile, str, Path)) else list(profiles)
    if not several:
        raise OptionError(Problem("there is no profile to score", "profiles", fix="name one or more"))
    ships = [ship_of(given) for given in several]
    names = [_called(given, ship.id) for given, ship in zip(several, ships, strict=True)]
    data = trials_of(trials)
    called = _called(trials, str(data.path or "trials"))
    sigma = spread(list((trials_of(options.sigma_from) if options.sigma_from else data).trials.values()))
    still = [name for name, value in sigma.items() if not value > 0.0]
    if still:
        raise OptionError(
            Problem(
                f"these trials do not vary in {', '.join(still)}",
                "sigma_from" if options.sigma_from else called,
                "L_MSE divides by the spread of each state",
                "name trials that do with sigma_from=TRIALS",
            )
        )
    whole = list(data.trials.values())
    pieces = list((data.in_windows(options.restart) if options.restart else data).trials.values())
    scored = []
    for name, ship in zip(names, ships, strict=True):
        scores = score(Model(ship), pieces, sigma, integrator=options.make_integrator(), backend=options.backend)
        scored.append(Scored(name, ship, tuple(scores), tuple(repeat(ship, whole)) if options.manoeuvres else ()))
    return Validation(tuple(scored), called, sigma, options.sigma_from or called, options)


def _called(given: object, otherwise: str) -> str:
    return str(given) if isinstance(given, (str, Path)) else otherwise


def _row(of: Sequence[TrialScore]) -> dict[str, Any]:
    n = sum(one.n_samples for one in of)
    per_state = {state: _finite(sum(one.squares[state] for one in of) / n) for state in of[0].squares} if n else {}
    return {
        "J": _finite(sum(one.J for one in of)),
        "L_MSE": _finite(L_MSE(of)),
        "L_MSE_by_state": per_state,
        "n_samples": n,
    }


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None
