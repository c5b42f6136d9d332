"""Models of any kind on the same trials, by kind of manoeuvre: what ``mmgtune compare`` does.

The table of Wakita et al. 2022 (Table 9): L_MSE of each model, mean and deviation over its networks, in both
conventions of restarting: begun anew in every window, and once in each whole run.  And how well the bands of each hold
what was measured: distances from the particles, CRPS, coverage, width.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar, cast

from .arguments import TrialsGiven, trials_of
from .bands import Pooled, WindowScore, pooled
from .displayed import Brief, Plotted
from .errors import OptionError, Problem, closest
from .inputs import INPUTS
from .options import CompareModelsOptions
from .options.choice import must_be
from .predictor import Predictor, Sampling, Uncertain, of_another_ship, particles_of, profile_of
from .provenance import made_by
from .recording import MOST, write_motions
from .run_files import MODEL_COMPARISON, MOTIONS
from .scores import L_MSE, TrialScore, by_manoeuvre, by_member, by_run, off_by, score, window_scores
from .trial import Trial, TrialSet
from .validating import Scorable, predictors_of, sigma_of
from .writing_results import place_for, write_record

ONE_BY_ONE = "berthing"
"""Kind of manoeuvre of which each run has a column too: no two are alike."""

ALL = "all"
CONVENTIONS = ("windows", "whole")


OfTrial = TypeVar("OfTrial", TrialScore, WindowScore)


@dataclass(frozen=True)
class Column:
    """Runs that are scored together.

    kind  of manoeuvre, "" where trials do not say, None for all
    run   the one run, None for all of the kind
    """

    kind: str | None
    run: str | None = None

    @property
    def name(self) -> str:
        """What to call it."""
        if self.kind is None:
            return ALL
        return self.run or self.kind or "not stated"

    def of(self, scores: Sequence[OfTrial]) -> list[OfTrial]:
        """Those scores that belong to it."""
        return [
            one
            for one in scores
            if (self.kind is None or one.manoeuvre == self.kind) and (self.run is None or one.run == self.run)
        ]


@dataclass(frozen=True)
class Cell:
    """L_MSE of one model on one column.

    members  of each member over all samples of the column, infinite where it diverged in any window or run
    """

    members: tuple[float, ...]

    @property
    def diverged(self) -> int:
        """Members that diverged."""
        return sum(not math.isfinite(one) for one in self.members)

    @property
    def mean(self) -> float | None:
        """Mean over the members, None where one diverged: the rest alone would flatter the model."""
        return None if self.diverged else math.fsum(self.members) / len(self.members)

    @property
    def deviation(self) -> float | None:
        """Standard deviation over the members, None for one alone or where one diverged."""
        if self.mean is None or len(self.members) < 2:
            return None
        mean = self.mean
        return math.sqrt(math.fsum((one - mean) ** 2 for one in self.members) / (len(self.members) - 1))

    def to_dict(self, first: Cell) -> dict[str, Any]:
        """For JSON; ``first`` is what the ratio is to."""
        ratio = self.mean / first.mean if self.mean is not None and first.mean else None
        return {
            "mean": self.mean,
            "deviation": self.deviation,
            "ratio": ratio,
            "diverged": self.diverged,
            "members": [one if math.isfinite(one) else None for one in self.members],
        }


@dataclass(frozen=True, eq=False, repr=False)
class Compared(Brief):
    """One model: what it was called, and its scores by convention, of all members, and of its bands.

    particles  what the bands are of: drawn where the model can draw them, else its members
    """

    name: str
    predictor: Predictor
    particles: Predictor
    scores: Mapping[str, tuple[TrialScore, ...]]
    windows: Mapping[str, tuple[WindowScore, ...]]

    def cell(self, convention: str, column: Column) -> Cell:
        """Its L_MSE on a column."""
        return Cell(tuple(L_MSE(of) for of in by_member(column.of(self.scores[convention]))))

    def bands(self, convention: str, column: Column, sigma: Mapping[str, float]) -> Pooled:
        """How well its bands hold what was measured."""
        return pooled(column.of(self.windows[convention]), sigma)


@dataclass(frozen=True, eq=False)
class ModelComparison(Plotted):
    """Models on the same trials.

    sigma   what L_MSE divides differences of each state by [SI]
    """

    written_by = "write_model_comparison"

    models: tuple[Compared, ...]
    data: TrialSet
    trials: str
    sigma: Mapping[str, float]
    options: CompareModelsOptions
    wall_s: float = 0.0

    def __repr__(self) -> str:
        """In a line."""
        return f"ModelComparison({', '.join(one.name for one in self.models[:4])} on {self.trials[-60:]})"

    @property
    def notes(self) -> tuple[str, ...]:
        """Where the trials are of another ship than a model, that they are; each note once."""
        of = (of_another_ship(one.predictor, self.data.ship, one.name) for one in self.models)
        return tuple(dict.fromkeys(note for notes in of for note in notes))

    @cached_property
    def columns(self) -> tuple[Column, ...]:
        """All runs, each kind of manoeuvre, and after berthing each of its runs."""
        found = [Column(None)]
        for kind, of in by_manoeuvre(self.models[0].scores["whole"]).items():
            found.append(Column(kind))
            runs = list(by_run(of))
            if kind == ONE_BY_ONE and len(runs) > 1:
                found += [Column(kind, run) for run in runs]
        return tuple(found)

    def best(self, convention: str, column: Column) -> str | None:
        """The model of least mean; None where all diverged."""
        means = {one.name: one.cell(convention, column).mean for one in self.models}
        sound = {name: mean for name, mean in means.items() if mean is not None}
        return min(sound, key=lambda name: sound[name]) if sound else None

    @cached_property
    def bands(self) -> dict[str, dict[str, tuple[Pooled, ...]]]:
        """Scores of bands by model and convention, of each column."""
        return {
            one.name: {
                convention: tuple(one.bands(convention, column, self.sigma) for column in self.columns)
                for convention in CONVENTIONS
            }
            for one in self.models
        }

    def surest(self, convention: str, k: int) -> str | None:
        """The model of least CRPS on a column, which weighs its error and its band; None where none has one."""
        scores = {name: of[convention][k] for name, of in self.bands.items()}
        sound = {name: one.CRPS for name, one in scores.items() if one.CRPS is not None and not one.lost}
        return min(sound, key=lambda name: sound[name]) if sound else None

    def to_dict(self, command: str = "") -> dict[str, Any]:
        """For JSON; what diverged is null."""
        first = self.models[0]
        return {
            "schema": 1,
            "kind": "model-comparison",
            "trials": {
                "name": self.trials,
                "ship": self.data.ship,
                "sources": sorted({trial.source for trial in self.data.trials.values()}),
                "licence": self.data.licence,
                "citation": self.data.citation,
                "sha256": self.data.hashes(),
            },
            "window_s": self.options.restart,
            "sigma": dict(self.sigma),
            "sigma_from": self.options.sigma_from or self.trials,
            "options": self.options.to_dict(),
            "columns": [self._described(k, column) for k, column in enumerate(self.columns)],
            "models": [
                {
                    "name": one.name,
                    "id": one.predictor.name,
                    "method": one.predictor.method,
                    "members": one.predictor.n_members,
                    "particles": one.particles.n_members,
                    "sha256": profile.sha256 if (profile := profile_of(one.predictor)) else None,
                    **{
                        convention: [
                            {
                                **one.cell(convention, column).to_dict(first.cell(convention, column)),
                                **_off(column.of(one.scores[convention]), self.sigma),
                                "bands": self.bands[one.name][convention][k].to_dict(),
                            }
                            for k, column in enumerate(self.columns)
                        ]
                        for convention in CONVENTIONS
                    },
                }
                for one in self.models
            ],
            "notes": list(self.notes),
            "provenance": made_by(command),
            "wall_s": self.wall_s,
        }

    def _described(self, k: int, column: Column) -> dict[str, Any]:
        """A column, how much is in it, and the best models of each convention."""
        windows = column.of(self.models[0].scores["windows"])
        return {
            "name": column.name,
            "kind": column.kind,
            "run": column.run,
            "runs": len(by_run(windows)),
            "windows": len({one.id for one in windows}),
            "best": {convention: self.best(convention, column) for convention in CONVENTIONS},
            "best_CRPS": {convention: self.surest(convention, k) for convention in CONVENTIONS},
        }


def _off(scores: Sequence[TrialScore], sigma: Mapping[str, float]) -> dict[str, float | None]:
    """How far off in metres and degrees, over all members; None where one diverged."""
    return {name: value if math.isfinite(value) else None for name, value in off_by(scores, sigma).items()}


def compare_models(
    models: Scorable | Sequence[Scorable] | Mapping[str, Scorable],
    trials: TrialsGiven,
    options: CompareModelsOptions = CompareModelsOptions(),
) -> ModelComparison:
    """Score models on trials, begun anew in every window of ``restart`` [s], and once in each whole trial.

    models  as for ``validate``; ratios are to the first
    Raises OptionError as ``validate`` does, and where nothing is left of the trials; TrialError where some are no time
    series, or lack what drives a model.
    """
    must_be(options, CompareModelsOptions)
    began = time.perf_counter()
    several = predictors_of(models, options)
    data = _only(trials_of(trials).series_only("a comparison of models"), options.only)
    called = str(trials) if isinstance(trials, (str, Path)) else str(data.path or "trials")
    sigma = sigma_of(data, options.sigma_from, called)
    pieces: dict[str, list[Trial]] = {
        "windows": list(data.in_windows(options.restart).trials.values()),
        "whole": list(data.trials.values()),
    }
    found = []
    for name, predictor in several.items():
        # Who cannot sample otherwise than by members is compared as it is.
        way = cast(Sampling, options.sampling if isinstance(predictor, Uncertain) else "TS-infinity")
        particles = particles_of(predictor, options.particles, options.seed, way)
        scores = {key: tuple(score(predictor, of, sigma)) for key, of in pieces.items()}
        windows = {key: tuple(window_scores(particles, of)) for key, of in pieces.items()}
        found.append(Compared(name, predictor, particles, scores, windows))
    return ModelComparison(tuple(found), data, called, sigma, options, time.perf_counter() - began)


def _only(data: TrialSet, only: Sequence[str]) -> TrialSet:
    """The trials of these kinds of manoeuvre, ids, runs or roles.  Raises OptionError for a word that names none."""
    words = {id: {trial.manoeuvre, id, trial.run, data.role(id)} for id, trial in data.trials.items()}
    known = sorted({word for of in words.values() for word in of if word})
    unknown = [word for word in only if word not in known]
    if unknown:
        why = "kinds of manoeuvre, ids, runs and the roles tune, test and other count"
        raise OptionError(Problem(f"no trial is of '{unknown[0]}'", "only", why, closest(unknown[0], known)))
    if not data.trials:
        raise OptionError(Problem("there is no trial to compare on", str(data.path or "trials"), fix="give some"))
    kept = {id for id, of in words.items() if not only or of & {*only}}
    return replace(
        data,
        trials={id: trial for id, trial in data.trials.items() if id in kept},
        tune=tuple(id for id in data.tune if id in kept),
        test=tuple(id for id in data.test if id in kept),
    )


def write_model_comparison(
    result: ModelComparison,
    folder: Path | str,
    command: str = "",
    notes: Sequence[str] = (),
    *,
    overwrite: bool = False,
) -> dict[str, Any]:
    """Write the record into a run folder, and the motions of whole trials.  Returns it.

    notes  what a reader of the errors must know besides

    Raises OutputError where one is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, ModelComparison, folder, MODEL_COMPARISON, MOTIONS, overwrite=overwrite) as place:
        pieces = list(result.data.trials.values())[:MOST]
        names = write_motions({one.name: one.predictor for one in result.models}, pieces, place)
        document = {
            **result.to_dict(command),
            "notes": [*result.notes, *notes],
            "L_pp": result.models[0].predictor.L_pp,
            "inputs": [INPUTS[name].to_dict() for name in names],
        }
        return write_record(document, place, MODEL_COMPARISON)
