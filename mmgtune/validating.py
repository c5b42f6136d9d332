"""Models scored on trials and compared: what ``mmgtune validate`` does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import Any

from .arguments import ShipGiven, TrialsGiven, trials_of
from .arrays import FloatArray
from .bands import Pooled, pooled, pooled_by
from .displayed import Plotted, inert
from .errors import OptionError, Problem, among, brief
from .first_states import J_of_noise, estimated, in_words
from .model import Model
from .networks import named_ship
from .objective import make_objective, spread, varying
from .options import ParticleOptions, SimulationOptions, ValidateOptions
from .options.choice import must_be
from .predictor import Predictor, as_predictor, noted, particles_of, profile_of, words_of
from .profile.doubts import Doubt
from .repeating import Repeated, document, repetitions
from .scores import L_MSE, TrialScore, score, summary, window_scores
from .stated_indices import IndexComparison, compare_stated, physics_of, possible
from .trial import Trial, TrialSet, oddities

Scorable = ShipGiven | Model | Predictor
"""What can be scored: a profile, its path or bundled name, a model, or any predictor."""


@dataclass(frozen=True, eq=False)
class Scored:
    """One predictor: what it was called, its scores by trial or window, its manoeuvres repeated where asked for, and
    what it makes of indices that are stated, notes on what was around the ship, and of several particles how well their
    bands hold what was measured, by kind of manoeuvre ("" where trials do not say) and under None all together.

    offsets  (n_pieces, 6) of the first measured states where these are estimated, else None
    """

    name: str
    predictor: Predictor
    scores: tuple[TrialScore, ...]
    repeated: tuple[Repeated, ...] = ()
    stated: tuple[IndexComparison, ...] = ()
    notes: tuple[str, ...] = ()
    bands: Mapping[str | None, Pooled] = field(default_factory=dict)
    offsets: FloatArray | None = None

    def __repr__(self) -> str:
        """In a line."""
        return f"Scored({inert(self.name)}, {len(self.scores)} runs, L_MSE {L_MSE(self.scores):.4g})"

    @property
    def doubts(self) -> tuple[Doubt, ...]:
        """Which numbers of its profile may be wrong."""
        profile = profile_of(self.predictor)
        return tuple(profile.doubts()) if profile else ()

    def to_dict(self) -> dict[str, Any]:
        """Scores over everything, by kind of manoeuvre and by run, for JSON; what diverged is null."""
        profile = profile_of(self.predictor)
        found = summary(self.scores) if self.scores else {}
        if self.bands:
            found["bands"] = self.bands[None].to_dict()
            for kind, row in found["by_manoeuvre"].items():
                row["bands"] = self.bands[kind].to_dict()
        return {
            "profile": self.name,
            "id": self.predictor.name,
            "sha256": profile.sha256 if profile else None,
            "method": self.predictor.method,
            **found,
            **({"stated": [one.to_dict(self.predictor.L_pp) for one in self.stated]} if self.stated else {}),
            "notes": list(self.notes),
            "doubts": [one.to_dict() for one in self.doubts],
        }


@dataclass(frozen=True, eq=False)
class Validation(Plotted):
    """Predictors scored on the same trials.

    trials, sigma_from  what the trials, and those whose spread is counted in, were called
    sigma   what L_MSE divides differences of each state by [SI]
    pieces  the trials, or windows of them, that were scored; whole: the trials
    oddities  what is odd about the trials, in sentences
    """

    written_by = "write_validation"

    profiles: tuple[Scored, ...]
    trials: str
    sigma: Mapping[str, float]
    sigma_from: str
    options: ValidateOptions = field(default_factory=ValidateOptions)
    pieces: tuple[Trial, ...] = ()
    oddities: tuple[str, ...] = ()
    whole: tuple[Trial, ...] = ()

    def __repr__(self) -> str:
        """In a line."""
        named = ", ".join(f"{one.name} {L_MSE(one.scores):.4g}" for one in self.profiles[:4])
        more = f" and {len(self.profiles) - 4} more" if len(self.profiles) > 4 else ""
        return inert(f"Validation(on {self.trials[-60:]}, L_MSE of {named}{more})")

    @property
    def notes(self) -> tuple[str, ...]:
        """What a reader must know: what is odd about the trials, and what is to be said of each model, each once."""
        return tuple(dict.fromkeys([*self.oddities, *(note for one in self.profiles for note in one.notes)]))

    def __getitem__(self, name: str) -> Scored:
        """What was scored under that name.  Raises OptionError where there is none."""
        found = [one for one in self.profiles if one.name == name]
        if not found:
            known = [one.name for one in self.profiles]
            raise OptionError(Problem(f"no model {brief(name)} was scored", "validation", **among(name, known)))
        return found[0]

    @property
    def method(self) -> str:
        """How profiles were simulated, to be named beside J."""
        return words_of(self.options.make_integrator())

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
            "initial": self.options.initial,
            "sigma": dict(self.sigma),
            "sigma_from": self.sigma_from,
            "integrator": self.options.integrator,
            "substeps": self.options.substeps,
            "options": self.options.to_dict(),
            "profiles": rows,
            "warnings": list(self.oddities),
        }


def validate(
    profiles: Scorable | Sequence[Scorable] | Mapping[str, Scorable],
    trials: TrialsGiven,
    options: ValidateOptions = ValidateOptions(),
) -> Validation:
    """Score predictors on trials, each trial or window of it simulated from its first measured state, or from the one
    within the noise of that from which the predictor follows best.

    profiles  one or several: profiles, models, predictors, paths or bundled names; a mapping gives each a name, of
              others the second of the same name is called "name (2)"
    trials    a data set, a path or a bundled name
    Integrator and back end of the options are for profiles; a predictor has its own ways.
    Raises OptionError for no profile, and for trials in which a state does not vary.
    """
    must_be(options, ValidateOptions)
    several = predictors_of(profiles, options)
    data = trials_of(trials)
    called = str(trials) if isinstance(trials, (str, Path)) else str(data.path or "trials")
    sigma = sigma_of(data, options.sigma_from, called)
    whole = list(data.trials.values())
    pieces = list((data.in_windows(options.restart) if options.restart else data).trials.values())
    odd = oddities(data.trials, next(iter(several.values())).L_pp)
    scored = []
    for name, predictor in several.items():
        repeated = tuple(repetitions(predictor, whole)) if options.manoeuvres else ()
        notes = noted(predictor, whole, data.ship, name)
        offsets = None
        if pieces and options.initial == "estimated":
            offsets = estimated(predictor, pieces, make_objective(predictor.L_pp))
        scores = tuple(score(predictor, pieces, sigma, offsets=offsets)) if pieces else ()
        if offsets is None:
            notes += _of_noise(predictor, pieces, scores)
        stated = _stated(predictor, data, options.backend)
        bands = bands_of(predictor, pieces, sigma, offsets) if pieces else {}
        scored.append(Scored(name, predictor, scores, repeated, stated, tuple(notes), bands, offsets))
    spread_of = options.sigma_from or called
    return Validation(tuple(scored), called, sigma, spread_of, options, tuple(pieces), tuple(odd), tuple(whole))


def _of_noise(predictor: Predictor, pieces: Sequence[Trial], scores: Sequence[TrialScore]) -> list[str]:
    """A note where the noise of first samples alone would bring a model to much of its J; none of other predictors."""
    if not (pieces and profile_of(predictor)):
        return []
    of_noise = float(J_of_noise(predictor, pieces, make_objective(predictor.L_pp)).sum())
    words = in_words(sum(one.J for one in scores), of_noise, "on these trials")
    return [f"{words}; initial=estimated takes that out"] if words else []


def sigma_of(data: TrialSet, sigma_from: str | None, called: str) -> dict[str, float]:
    """Spread of each state in trials, or in those of ``sigma_from`` [SI]; nothing where there are none.

    called  what the trials were called
    Raises OptionError where a state does not vary.
    """
    measured = list((trials_of(sigma_from) if sigma_from else data).trials.values())
    if not measured:
        return {}
    where = "sigma_from" if sigma_from else called
    return varying(spread(measured), where, "name trials that do with sigma_from=TRIALS")


def predictors_of(
    profiles: Scorable | Sequence[Scorable] | Mapping[str, Scorable], options: SimulationOptions
) -> dict[str, Predictor]:
    """What is to be scored, by what it is called; see ``validate``.  Raises OptionError where there is nothing."""
    if isinstance(profiles, Mapping):
        several = list(profiles.items())
    else:
        given = list(profiles) if isinstance(profiles, Sequence) and not isinstance(profiles, str) else [profiles]
        several = list(zip(_told_apart([_called(one) for one in given]), given, strict=True))
    if not several:
        raise OptionError(Problem("there is no profile to score", "profiles", fix="name one or more"))
    return {
        name: as_predictor(
            named_ship(one, options.make_integrator()),
            integrator=options.make_integrator(),
            backend=options.backend,
        )
        for name, one in several
    }


def bands_of(
    predictor: Predictor, pieces: Sequence[Trial], sigma: Mapping[str, float], offsets: FloatArray | None = None
) -> dict[str | None, Pooled]:
    """Scores of the bands of a predictor that draws particles, or has several members; of others nothing.

    offsets  (n_pieces, 6) of the first measured states, or None

    By kind of manoeuvre, and under None all together.
    """
    how = ParticleOptions()
    particles = particles_of(predictor, how.particles, how.seed)
    if particles.n_members < 2:
        return {}
    found = window_scores(particles, pieces, offsets)
    whole: dict[str | None, Pooled] = {None: pooled(found, sigma)}
    return whole | dict(pooled_by(lambda one: one.manoeuvre, found, sigma))


def _stated(predictor: Predictor, data: TrialSet, backend: str) -> tuple[IndexComparison, ...]:
    """What a model makes of the indices that are stated; of a predictor with several members its first."""
    trials = list(data.stated.values())
    if not trials:
        return ()
    ship = physics_of(predictor)
    possible(ship.model.profile, trials)
    roles = {one.id: data.role(one.id) for one in trials}
    return tuple(compare_stated(ship.model, {"simulated": ship.theta[:, 0]}, trials, roles, backend))


def _called(given: Scorable) -> str:
    """What to call something scored that was given without a name."""
    if isinstance(given, (str, Path)):
        return str(given)
    ship = named_ship(given)
    return ship.profile.id if isinstance(ship, Model) else getattr(ship, "id", "") or getattr(ship, "name", "?")


def _told_apart(names: Sequence[str]) -> list[str]:
    """The same names, with (2), (3) behind those that stand there already: a ship and what was tuned share an id."""
    found: list[str] = []
    for name in names:
        again = (f"{name} ({k})" for k in count(2))
        found.append(name if name not in found else next(one for one in again if one not in found))
    return found
