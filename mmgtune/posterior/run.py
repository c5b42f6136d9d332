"""Particles of a physical model from the trials of her ship."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, list_of, ship_of, trials_of
from ..arrays import FloatArray
from ..backends import get_backend
from ..components import split_name
from ..displayed import Plotted
from ..errors import Problem, ProfileError, TrialError, must_be_a
from ..files import kept_in
from ..fitting.journal import journalled
from ..fitting.lost import runs_away
from ..hooks import Hooks
from ..options import PosteriorOptions
from ..options.choice import must_be
from ..particles import SO_FAR, Particles
from ..phrases import capital, counted
from ..profile import ShipProfile, tuned
from ..run_files import POSTERIOR_JOURNAL
from ..run_provenance import identity_of, make_provenance
from ..threads import blas_on_one_thread
from ..trial import Trial, another_ship
from ..trial.by_hand import ship_of_all
from .local import Mode, Windowed, find_mode, make_windowed, particles_about
from .room import Room, make_room, tags_of
from .sizing import Shown, Sized, own_variance, shown_by, size

EXPECTED = 4.0
"""Squares of residuals of particles over what a linear model has, up to which bands of generated ships held."""


@dataclass(frozen=True, eq=False)
class Posterior(Plotted):
    """What trials leave open of a ship.

    sized       how much the trials are believed
    shown       what orders the trials hold
    learnt      number of combinations of numbers that the trials determine
    nonlinear   median over particles of the squares of residuals above those of the mode, over what it is if the
                distribution is Gaussian
    interrupted whether it was stopped before its end
    trials_ship id of the ship whose trials they are, "" where they do not say
    """

    written_by = "write_posterior"

    room: Room
    particles: Particles
    sized: Sized
    learnt: float
    nonlinear: float
    converged: bool
    shown: Shown
    provenance: Mapping[str, Any]
    interrupted: bool = False
    trials_ship: str = ""

    def __repr__(self) -> str:
        """In a line."""
        size = f"{len(self.particles)} particles of {len(self.room)} numbers"
        return f"Posterior({self.particles.profile.id}: {size}{', interrupted' if self.interrupted else ''})"

    def as_ship(self) -> Particles:
        """The particles: what the result stands for where a ship is wanted."""
        return self.particles

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader must know before trusting the bands."""
        one_sided = self.shown.one_sided()
        found = [f"{capital(words)}." for words in another_ship(self.trials_ship, self.particles.profile.id)]
        found += [one_sided] if one_sided else []
        if self.interrupted:
            found.append(f"Stopped before its end: {SO_FAR}.")
        elif not self.converged:
            found.append("The most probable coefficients were not found to the end; bands are about the best so far.")
        if self.nonlinear > EXPECTED:
            found.append(
                f"Particles miss the trials {self.nonlinear:.1f} times as far as a Gaussian distribution would have it;"
                " bands near the trials are wider than they need be."
            )
        return tuple(found)

    def sentences(self) -> list[str]:
        """What the bands are made of, in words."""
        return [
            f"Room for {len(self.room)} numbers: coefficients, and {', '.join(tags_of(self.room))}.",
            f"The trials determine {self.learnt:.0f} combinations of them; the rest is as open as before.",
            self.sized.sentence(),
            self.shown.sentence(),
        ]

    def sentence(self) -> str:
        """What the trials say of the ship, and how much they are believed."""
        return " ".join(self.sentences())

    def to_dict(self) -> dict[str, Any]:
        """The document of ``posterior.json``."""
        profile, names = self.particles.profile, self.room.names
        spread = np.quantile(self.particles.values, [0.05, 0.5, 0.95], axis=1)
        prior = self.room.deviation
        numbers = [
            {
                "name": name,
                "unit": profile.sections[split_name(name)[0]].component.fields[split_name(name)[1]].unit,
                "low": float(spread[0, k]),
                "median": float(spread[1, k]),
                "high": float(spread[2, k]),
                "prior_deviation": float(prior[k]),
            }
            for k, name in enumerate(names)
        ]
        return {
            "schema": 1,
            "kind": "posterior",
            **self.provenance,
            "particles": len(self.particles),
            "misfit": self.sized.misfit,
            "temper": self.sized.temper,
            "left_out": {
                "groups": list(self.sized.groups),
                "factor": self.sized.factor,
                "covered": list(self.sized.covered),
            },
            "learnt": self.learnt,
            "nonlinear": self.nonlinear,
            "converged": self.converged,
            "interrupted": self.interrupted,
            "sentences": self.sentences(),
            "warnings": list(self.warnings),
            "numbers": numbers,
        }


@blas_on_one_thread
def posterior(
    profile: ShipGiven,
    trials: TrialsGiven,
    options: PosteriorOptions = PosteriorOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | str | None = None,
    resume: bool = False,
    command: str = "",
) -> Posterior:
    """Particles of a ship from the tune trials of a set, or from all of a list.

    profile, trials  objects, paths or bundled names; where coefficients are tuned, the room is about what they were
    hooks    what is told on the way, and what ends it: see ``until_interrupted`` for Ctrl-C
    folder   where each finished search is noted at once; None for nowhere, as for a list of trials
    resume   continue what was stopped in the folder
    command  what to call this in the provenance
    Raises TrialError where there is no time series to learn from, OptionError for choices that make no sense,
    ProfileError where no likely ship can be simulated on the trials.
    """
    must_be(options, PosteriorOptions)
    must_be_a(hooks, Hooks, "hooks")
    ship = ship_of(profile)
    if isinstance(trials, Sequence) and not isinstance(trials, str):
        chosen = list_of(trials)
        facts = {"trials": [trial.id for trial in chosen]}
        return _drawn(ship, chosen, options, hooks, facts, ship_of_all(chosen))
    data = trials_of(trials)
    provenance = make_provenance(ship, data, command)
    identity = identity_of(ship, data, options, provenance)
    kept = kept_in(folder, resume)
    with journalled(kept, identity, hooks.stop, resume=resume, name=POSTERIOR_JOURNAL):
        return _drawn(ship, [data.trials[name] for name in data.tune], options, hooks, provenance, data.ship)


def _drawn(
    ship: ShipProfile,
    chosen: Sequence[Trial],
    options: PosteriorOptions,
    hooks: Hooks,
    provenance: Mapping[str, Any],
    trials_ship: str,
) -> Posterior:
    """Particles from trials of a ship of some id."""
    require_some(chosen)
    room = make_room(ship, size=options.room, without=options.without)
    backend = get_backend(options.backend)
    integrator = options.make_integrator()

    def remake(some: Sequence[Trial]) -> Windowed:
        return make_windowed(room, some, backend, integrator)

    windowed = remake(chosen)
    hooks.on_phase(f"looking for the most probable ship in a room of {counted(len(room), 'number')}")
    mode = find_mode(windowed, 1.0, stop=hooks.stop)
    if not np.isfinite(mode.residual).all():
        raise _lost(ship, chosen)
    if options.leave_out:
        sized = size(windowed, mode, remake, options.seed, hooks)
    else:
        sized = Sized(mode.misfit, own_variance(windowed, mode))
    hooks.on_phase(f"drawing {counted(options.particles, 'particle')}")
    mode = find_mode(windowed, sized.temper, mode.z, hooks.stop)
    z, nonlinear = sound(windowed, mode, sized.temper, options.particles, options.seed)
    if not z.shape[1]:
        raise _lost(ship, chosen)
    said = {"made_by": "mmgtune posterior", "trials": [trial.id for trial in chosen], "temper": sized.temper}
    interrupted = sized.stopped or (hooks.stop() and not mode.converged)
    facts = {"seed": options.seed, "room": options.room, "noise": windowed.sigma.tolist(), "interrupted": interrupted}
    best = dict(zip(room.names, room.values(mode.z[:, None])[:, 0].tolist(), strict=True))
    likely = tuned(room.profile, best, {}, said, suffix="most probable")
    return Posterior(
        room=room,
        particles=Particles(likely, room.names, room.values(z), {**said, **facts}),
        sized=sized,
        learnt=mode.learnt(sized.temper),
        nonlinear=nonlinear,
        converged=mode.converged,
        shown=shown_by(chosen, ship.L_pp),
        provenance=provenance,
        interrupted=interrupted,
        trials_ship=trials_ship,
    )


def require_some(chosen: Sequence[Trial]) -> None:
    """Raises TrialError where there is no time series to learn from."""
    if not chosen:
        raise TrialError(Problem("no time series to learn from", "trials", fix="give trial files, and tune to them"))


def _lost(ship: ShipProfile, trials: Sequence[Trial]) -> ProfileError:
    return runs_away(ship, trials, "with any coefficients that are likely")


def sound(data: Windowed, mode: Mode, temper: float, n: int, seed: int) -> tuple[FloatArray, float]:
    """n particles (n_names, n) whose runs stay within the world of ships on the trials' windows, and ``nonlinear``.

    Fewer where some do not.
    """
    z = particles_about(data, mode, temper, n, seed)
    squares = np.sum(data.residuals(z) ** 2, axis=0)
    kept = np.flatnonzero(np.isfinite(squares))
    above = np.median(squares[kept]) - np.sum(mode.residual**2) if len(kept) else np.inf
    return z[:, kept], float(above / temper / max(mode.learnt(temper), 1e-9))
