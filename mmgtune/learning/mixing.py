"""A hybrid and recurrent networks put together, with the share that does best on runs neither has seen."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from .. import limits
from ..arguments import TrialsGiven, trials_of
from ..comparing_models import ModelComparison, compare_models
from ..displayed import Displayed
from ..documents import finite
from ..errors import OptionError, Problem, brief, kind_of, must_be_a, reason
from ..networks import (
    HybridPredictor,
    Mixture,
    MixturePredictor,
    Network,
    NetworkPredictor,
    named_ship,
)
from ..networks.ensemble import EnsemblePredictor
from ..networks.hybrid import Hybrid, silent
from ..objective import spread, varying
from ..options import CompareModelsOptions
from ..options.choice import must_be
from ..options.learning import MixtureOptions
from ..phrases import counted, in_percent
from ..predictor import Predictor
from ..profile import ShipProfile
from ..profile.changing import joined
from ..provenance import made_by
from ..scores import L_MSE, by_manoeuvre, score
from ..trial import Trial, TrialSet
from ..validating import Scorable
from .choosing import pieces_of
from .task import warned

NO_GAIN = "No gain"

NetworkGiven = Network | Predictor | str | Path


@dataclass(frozen=True, eq=False)
class Tried:
    """A share of the networks, and what it does on the runs that choose.

    errors   L_MSE by kind of manoeuvre
    score    mean over kinds of the error over that of the hybrid alone; infinite where a run diverged
    network  which of several networks is alone with a share of 1, counted from 1
    """

    share: float
    errors: dict[str, float]
    score: float
    network: int | None = None

    def to_dict(self) -> dict[str, Any]:
        """For JSON; what diverged is null."""
        errors = {kind: finite(error) for kind, error in self.errors.items()}
        which = {} if self.network is None else {"network": self.network}
        return {"share": self.share, **which, "score": finite(self.score), "L_MSE": errors}


@dataclass(frozen=True, eq=False)
class LearnedMixture(Displayed):
    """The best of the shares that were tried; a hybrid or networks alone where no mixture does better.

    tried    share by share, with 0, the hybrid alone, and 1, each of the networks alone; empty where nothing chose
    seen     runs among those that chose which a part was trained on: their errors flatter it
    network  which of several networks is kept alone, counted from 1; None where none is
    parts    what was put together, as it was given, by what a comparison calls it
    warnings  what to know of it: that the trials are of another ship, where they are
    """

    written_by = "write_learned"

    model: Mixture | Hybrid | Network
    tried: tuple[Tried, ...]
    seen: tuple[str, ...]
    options: MixtureOptions
    provenance: dict[str, Any]
    network: int | None = None
    parts: Mapping[str, Scorable] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def share(self) -> float:
        """Of the networks."""
        return self.model.share if isinstance(self.model, Mixture) else float(isinstance(self.model, Network))

    @property
    def notes(self) -> tuple[str, ...]:
        """What to know of the errors and of what was kept, in sentences."""
        said = []
        if self.seen:
            which = self.seen[0] if len(self.seen) == 1 else f"{self.seen[0]} ..."
            said.append(
                f"A part was trained on {len(self.seen)} of the trials that chose ({which}): errors flatter it."
            )
        if self.tried and self.share in (0.0, 1.0):
            kept = "networks alone are" if self.share else "model of forces alone is"
            if self.network is not None:
                kept = f"networks {self.network} alone are"
            said.append(f"{NO_GAIN}: no mixture does better than one of its parts, and the {kept} kept.")
        return tuple(said)

    def as_ship(self) -> Mixture | Hybrid | Network:
        """What was trained: what the result stands for where a ship is wanted."""
        return self.model

    def __repr__(self) -> str:
        """In a line."""
        return f"LearnedMixture({self.model!r})"

    def sentence(self) -> str:
        """What was put together, and what that is worth on the runs that chose."""
        if not self.tried:
            return f"A share of {self.share:g} for the networks, as given: no trials chose it."
        kept = next(one for one in self.tried if (one.share, one.network) == (self.share, self.network))
        if self.share in (0.0, 1.0):
            return next(note for note in self.notes if note.startswith(NO_GAIN))
        if not math.isfinite(kept.score):
            return f"Every share diverges on a trial that chose; that of {self.share:g} is kept."
        return (
            f"With a share of {self.share:g} for the networks the error L_MSE is {in_percent(kept.score)} of that of "
            f"the model of forces alone, mean over {counted(len(kept.errors), 'kind')} of manoeuvre."
        )

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "schema": 1,
            "share": self.share,
            "network": self.network,
            "tried": [one.to_dict() for one in self.tried],
            "seen": list(self.seen),
            "options": self.options.to_dict(),
            "warnings": list(self.warnings),
            "provenance": self.provenance,
        }


def learn_mixture(
    model: ShipProfile | Hybrid | Predictor | str | Path,
    networks: NetworkGiven | Sequence[NetworkGiven],
    trials: TrialsGiven | None = None,
    options: MixtureOptions = MixtureOptions(),
    *,
    command: str = "",
) -> LearnedMixture:
    """Put a model of forces and recurrent networks together.

    model     profile, or hybrid
    networks  of the same ship, one or several of one step; all members of all of them count alike
    trials    that no part was trained on: those that tune choose the share.  None takes the one share of the options
    Raises OptionError where parts do not fit, or nothing says which of several shares is meant; NetworkError.
    """
    must_be(options, MixtureOptions)
    several = networks if isinstance(networks, (list, tuple)) else [networks]
    limits.NETWORKS.require(len(several), "NETWORK", OptionError)
    hybrid, nets = _hybrid(model), tuple(_network(one) for one in several)
    try:
        mixtures = [Mixture(hybrid, nets, share) for share in options.share]
    except ValueError as error:
        fix = "give models of one ship, and networks that were trained with one step"
        raise OptionError(Problem("the models do not fit together", "MODEL NETWORK", reason(error), fix)) from error
    tried: list[Tried] = []
    seen: tuple[str, ...] = ()
    parts = [hybrid.facts, *(one.facts for one in nets)]
    made = made_by(command)
    facts: dict[str, Any] = {"type": "mixture", **{key: made[key] for key in ("mmgtune", "created", "environment")}}
    facts["trials"] = _trials_of(parts)
    which: int | None = None
    warnings: tuple[str, ...] = ()
    if trials is None:
        if len(mixtures) > 1:
            why = f"{len(mixtures)} shares could be meant"
            raise OptionError(Problem("nothing chooses the share", "share", why, "give trials, or write share=0.35"))
        best: Mixture | Hybrid | Network = mixtures[0]
    else:
        data = trials_of(trials).series_only("a mixture")
        chosen = [data.trials[id] for id in data.tune]
        warnings = warned(hybrid.profile, data)
        learned = {*_tuned_on(hybrid.profile), *(id for of in parts for id in _learned(of))}
        seen = tuple(one.id for one in chosen if {one.id, one.run} & learned)
        candidates: list[_Candidate] = [
            _Candidate(0.0, hybrid, HybridPredictor(hybrid)),
            *(_Candidate(one.share, one, MixturePredictor(one)) for one in mixtures),
            *(_Candidate(1.0, one, NetworkPredictor(one), k + 1 if nets[1:] else None) for k, one in enumerate(nets)),
        ]
        tried = _tried(candidates, data, chosen, options)
        least = min(range(len(tried)), key=lambda k: tried[k].score)
        best, which = candidates[least].model, candidates[least].network
        facts["chosen_by"] = [one.id for one in chosen]
    if isinstance(best, Mixture):
        best = Mixture(hybrid, nets, best.share, facts)
    told = {"hybrid": hybrid.facts, "networks": [one.facts for one in nets]}
    alone = [f"networks {k + 1}" for k in range(len(several))] if several[1:] else ["networks"]
    given = {"model of forces": model, **dict(zip(alone, several, strict=True))}
    return LearnedMixture(best, tuple(tried), seen, options, {**made, "parts": told}, which, given, warnings)


def compare_parts(
    result: LearnedMixture, trials: TrialsGiven, options: CompareModelsOptions | None = None
) -> ModelComparison:
    """The parts of a mixture side by side on trials, and with them the mixture where it is what was kept.

    trials   objects, a path or a bundled name
    options  of the comparison; None takes windows as the share was chosen by
    Raises OptionError as ``compare_models`` does.
    """
    must_be_a(result, LearnedMixture, "result")
    several = dict(result.parts)
    if isinstance(result.model, Mixture):
        several[f"mixture ({result.share:g})"] = result
    if options is None:
        chosen = result.options.restart
        options = CompareModelsOptions() if chosen is None else CompareModelsOptions(restart=chosen)
    return compare_models(several, trials, options)


class _Candidate(NamedTuple):
    """What may be kept; ``network`` as of ``Tried``."""

    share: float
    model: Mixture | Hybrid | Network
    predictor: Predictor
    network: int | None = None


def _tried(
    several: Sequence[_Candidate], data: TrialSet, chosen: Sequence[Trial], options: MixtureOptions
) -> list[Tried]:
    """Each share on the runs that choose, the hybrid first."""
    if not chosen:
        raise OptionError(
            Problem("no trial chooses the share", str(data.path or "trials"), "none of them tunes", "give a split")
        )
    sigma, pieces = varying(spread(chosen), "trials", "give trials that do"), pieces_of(chosen, options.restart)
    found: list[Tried] = []
    for one in several:
        scores = score(one.predictor, pieces, sigma)
        errors = {kind: L_MSE(of) for kind, of in by_manoeuvre(scores).items()}
        alone = found[0].errors if found else errors
        ratios = [errors[kind] / alone[kind] for kind in errors]
        mean = math.fsum(ratios) / len(ratios)
        found.append(Tried(one.share, errors, mean if math.isfinite(mean) else math.inf, one.network))
    return found


def _hybrid(named: Any) -> Hybrid:
    given = named_ship(named)
    if isinstance(given, ShipProfile):
        return silent(given)
    found = given.hybrid if isinstance(given, HybridPredictor) else given
    if not isinstance(found, Hybrid):
        what = f"{_called(named)} is no model of forces"
        raise OptionError(Problem(what, "MODEL", _holds(found), "give a profile or a hybrid"))
    return found


def _network(named: Any) -> Network:
    given = named_ship(named)
    found = given.network if isinstance(given, NetworkPredictor) else given
    if not isinstance(found, Network):
        what = f"{_called(named)} is no recurrent network"
        raise OptionError(Problem(what, "NETWORK", _holds(found), "give a model.safetensors of mmgtune learn rnn"))
    return found


def _called(given: Any) -> str:
    """What somebody calls a part: its file or name, else what kind of object it is."""
    return brief(str(given)).strip("'") if isinstance(given, (str, Path)) else kind_of(given)


def _holds(found: Any) -> str:
    """What a part that does not fit is, where that has a name."""
    kinds: dict[type, str] = {ShipProfile: "a profile", Hybrid: "a hybrid", HybridPredictor: "a hybrid"}
    kinds |= {Network: "a network", EnsemblePredictor: "an ensemble", MixturePredictor: "a mixture"}
    return next((f"it is {words}" for kind, words in kinds.items() if isinstance(found, kind)), "")


def _tuned_on(profile: ShipProfile) -> Sequence[str]:
    """Ids of the runs that a profile was tuned on, as far as it says."""
    found = profile.provenance.get("tuned_on")
    return [str(one) for one in found] if isinstance(found, list) else ()


def _learned(facts: dict[str, Any]) -> Sequence[str]:
    """Ids of the runs that a part was trained on, as far as its file says."""
    trials = facts.get("trials")
    found = trials.get("learned_from") if isinstance(trials, dict) else None
    return found if isinstance(found, list) else ()


def _trials_of(parts: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """What the parts say of their trials, together: licence, citation, sources, and which were learned from."""
    told = [one["trials"] for one in parts if isinstance(one.get("trials"), dict)]
    texts = {key: joined(*(str(one.get(key) or "") for one in told)) for key in ("licence", "citation")}
    sources = sorted({source for one in told for source in one.get("sources") or ()})
    learned = list(dict.fromkeys(id for one in parts for id in _learned(one)))
    return {**texts, "sources": sources, "learned_from": learned}
