"""What each trial of a set holds, ranges and indices: what ``mmgtune trials inspect`` does."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from .arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from .displayed import Displayed, inert
from .errors import OptionError, Problem
from .motions import trial_indices
from .phrases import counted
from .resources import profile_names
from .trial import TrialSet, another_ship
from .trial.describe import describe


@dataclass(frozen=True, eq=False)
class Inspected(Displayed):
    """Trials, and the length of their ship that indices are counted in.

    L_pp   [m]
    notes  where the trials are of another ship than the profile, in words that go on behind a colon
    """

    trials: TrialSet
    L_pp: float
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """In a line."""
        ids = [*self.trials.trials, *self.trials.stated]
        more = f" and {len(ids) - 4} more" if len(ids) > 4 else ""
        return inert(f"Inspected({counted(len(ids), 'trial')}: {', '.join(ids[:4])}{more})")

    @cached_property
    def rows(self) -> tuple[dict[str, Any], ...]:
        """Facts of each trial that is a time series, ``ranges`` by column, ``role``, and ``indices`` as far as they are
        read; angles in degrees, propellers in 1/min."""
        return tuple(
            {**describe(trial), "role": self.trials.role(name), "indices": trial_indices(trial, self.L_pp)}
            for name, trial in self.trials.trials.items()
        )

    @cached_property
    def stated(self) -> tuple[dict[str, Any], ...]:
        """The same of each trial of which indices are stated."""
        return tuple({**one.describe(), "role": self.trials.role(one.id)} for one in self.trials.stated.values())

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        stated = {"stated": list(self.stated)} if self.stated else {}
        return {"schema": 1, "kind": "trials-inspect", "L_pp_m": self.L_pp, "trials": list(self.rows), **stated}


def inspect_trials(trials: TrialsGiven, profile: ShipGiven | None = None) -> Inspected:
    """What each trial holds, and its manoeuvring indices.

    trials   objects, a path or a bundled name
    profile  of the ship, for her length: an object, a path or a bundled name; None for the bundled one the trials name
    Raises TrialError, ProfileError, and OptionError for trials that name no bundled ship where there is no profile.
    """
    data = trials_of(trials)
    if profile is None and data.ship not in profile_names():
        what = f"the trials are of '{data.ship}'" if data.ship else "the trials do not say which ship they are of"
        why, fix = "indices are counted in ship lengths", "name the ship's profile by profile=NAME"
        where = str(data.path or "trials")
        raise OptionError(Problem(what + ", which is no bundled profile" * bool(data.ship), where, why, fix))
    ship = ship_of(data.ship if profile is None else profile)
    return Inspected(data, ship.L_pp, tuple(another_ship(data.ship, ship.id)))
