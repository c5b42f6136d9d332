"""Models scored on voyages: streamed, cut into windows, each simulated anew from its measured state."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import NoneType
from typing import Any

import numpy as np

from ..arguments import trials_of
from ..arrays import FloatArray
from ..backends import Cases
from ..bands import Pooled
from ..circumstances import acts_on_surroundings, extremes, notes
from ..errors import OptionError, Problem, TrialError, must_be_a
from ..files import kept_in
from ..fitting.journal import journalled, remembered
from ..hooks import Hooks
from ..networks.naming import sha256_of
from ..objective import spread
from ..options import VoyageOptions
from ..options.choice import must_be
from ..predictor import PhysicsPredictor, Predictor, Uncertain, draught_of, of_another_ship, profile_of
from ..provenance import made_by
from ..run_provenance import facts_of_profile
from ..threads import blas_on_one_thread
from ..trial import Cutting, Voyage, VoyageSet, load_voyages, voyage_windows, window_at
from ..trial.voyages.windows import Window, mean_speed, rest_speed
from ..units import DEG
from ..validating import Scorable, bands_of, predictors_of
from .part import Part, noted, recalled
from .result import DrawnWindow, Log, VoyageValidation
from .scores import cases_for, score_windows, windows_of
from .spread import Spread
from .table import Gathered, WindowTable
from .turning import r_max_of

AT_ONCE = 60_000
"""Samples of windows simulated at one time; bounds the memory."""

EACH = 2
"""Windows drawn of each role: best, median, worst."""


BANDED = 200
"""Windows at most on which bands are held against what was measured, evenly among all."""


@dataclass(frozen=True, eq=False)
class _Work:
    """What is done with each voyage.

    slowest  mean speed [m/s] of windows below which the ship is at rest
    before   rows of the voyages before this one, and total: of all; for ``hooks``
    """

    predictors: Mapping[str, Predictor]
    options: VoyageOptions
    hooks: Hooks
    slowest: float
    before: int
    total: int

    @property
    def inputs(self) -> list[str]:
        """All that drives any of the models."""
        return list(dict.fromkeys(name for one in self.predictors.values() for name in one.inputs))


@remembered(lambda work, voyage, number, sha256: [voyage.id, number, sha256, *work.predictors], noted, recalled)
def score_voyage(work: _Work, voyage: Voyage, number: int, sha256: str) -> Part:
    """All windows of a voyage, up to where it is stopped."""
    part = Part()
    options, counted = work.options, part.counted
    found = voyage_windows(voyage, options.window, gap=options.gap, inputs=work.inputs, counted=counted)
    for some in _portions(found):
        if work.hooks.stop():
            part.complete = False
            break
        moving = [one for one in some if mean_speed(one.trial) >= work.slowest]
        part.at_rest += len(some) - len(moving)
        if moving:
            _score(work, moving, number, part)
        work.hooks.on_progress(work.before + counted.rows, work.total, voyage.id)
    return part


def _score(work: _Work, moving: Sequence[Window], number: int, part: Part) -> None:
    windows = windows_of([one.trial for one in moving])
    part.spread.add(windows.motion)
    gathered = part.gathered
    gathered.ids += [one.trial.id for one in moving]
    gathered.about += [(number, one.row, one.trial.n_samples, one.begins, one.trial.duration) for one in moving]
    gathered.features.append(windows.features())
    gathered.counts.append(windows.counts)
    cases: dict[tuple[tuple[str, ...], float | None], Cases] = {}
    for name, predictor in work.predictors.items():
        driven = tuple(predictor.inputs), draught_of(predictor)
        if driven not in cases:
            cases[driven] = cases_for(windows, *driven)
        scores, _ = score_windows(predictor, windows, cases[driven])
        gathered.scores.setdefault(name, []).append(scores)
        if isinstance(predictor, PhysicsPredictor) and acts_on_surroundings(predictor.model):
            here = cases[driven].around.reshape(-1, cases[driven].around.shape[-1])
            met = [part.around[name]] if name in part.around else []
            part.around[name] = extremes(np.concatenate([*met, here]))


@blas_on_one_thread
def validate_voyages(
    profiles: Scorable | Sequence[Scorable] | Mapping[str, Scorable],
    voyages: VoyageSet | str | Path,
    options: VoyageOptions = VoyageOptions(),
    *,
    hooks: Hooks | None = None,
    folder: Path | str | None = None,
    resume: bool = False,
    command: str = "",
) -> VoyageValidation:
    """Score models on the windows of voyages, each window simulated from its first measured state.

    profiles  as for ``validate``
    voyages   logs of hours and days, or the path of a file or a folder; they are never held whole
    hooks     what is told on the way, and what ends it: see ``until_interrupted`` for Ctrl-C
    folder    where each finished voyage is noted at once; None for nowhere
    resume    continue what was stopped in the folder; a predictor without a profile counts as the same by its name

    r_max of cVDM is the ship's: as given, else the first physics model's in its own turn, else of the logs.
    Raises OptionError for no profile, for repeated manoeuvres, for first states to be estimated, and where there is
    nothing to resume or it belongs to another run; OutputError where the folder cannot be written to; TrialError for
    what is wrong with a file, and where no window could be cut.
    """
    folder = kept_in(folder, resume)
    must_be(options, VoyageOptions)
    must_be_a(hooks, (Hooks, NoneType), "hooks")
    began = time.perf_counter()
    if options.manoeuvres:
        why = "a voyage is no turning circle and no zigzag"
        raise OptionError(Problem("manoeuvres of voyages cannot be repeated", "manoeuvres", why, "leave it out"))
    if options.initial != "measured":
        why = "thousands of windows begin at their first samples, and what their noise brings is scored with them"
        fix = "leave it out, or validate on trials cut from the voyages"
        raise OptionError(Problem("first states of voyages are not estimated", "initial", why, fix))
    predictors = predictors_of(profiles, options)
    data = voyages if isinstance(voyages, VoyageSet) else load_voyages(voyages)
    told = Hooks() if hooks is None else hooks
    sigma = spread(list(trials_of(options.sigma_from).trials.values())) if options.sigma_from else None
    slowest = rest_speed(next(iter(predictors.values())).L_pp)
    gathered, spreads = Gathered(), Spread()
    logs: list[Log] = []
    around: dict[str, dict[str, FloatArray]] = {name: {} for name in predictors}
    interrupted = False
    with journalled(folder, _identity(predictors, data, options), told.stop, resume=resume):
        for number, voyage in enumerate(data.voyages):
            interrupted = told.stop()
            if interrupted:
                break
            sha256 = voyage.verify()
            work = _Work(predictors, options, told, slowest, sum(log.voyage.n_rows for log in logs), data.n_rows)
            part = score_voyage(work, voyage, number, sha256)
            gathered.add(part.gathered)
            spreads.join(part.spread)
            for name, rows in part.around.items():
                around[name][voyage.id] = rows
            logs.append(Log(voyage, part.counted, len(part.gathered.ids), part.at_rest, sha256, part.complete))
            interrupted = not part.complete
            if interrupted:
                break
    if not gathered.ids and not interrupted:
        raise TrialError(_nothing(data, logs))
    given = None if options.r_max is None else options.r_max * DEG
    largest = np.concatenate([one["yaw_rate_largest"] for one in gathered.features] or [np.zeros(0)])
    r_max, r_max_from = r_max_of(given, predictors.items(), largest)
    table = gathered.table(r_max) if gathered.ids else None
    scale = sigma or spreads.sigma()
    by = f"{options.sigma_from}" if options.sigma_from else "the windows, positions from the start of each"
    return VoyageValidation(
        predictors=predictors,
        trials=str(data.path),
        logs=tuple(logs),
        table=table,
        r_max=r_max,
        r_max_from=r_max_from,
        sigma=scale,
        sigma_from=by,
        drawn=_drawn(table, data, predictors) if table is not None else (),
        bands=_bands(table, data, predictors, scale) if table is not None and not interrupted else {},
        provenance=_provenance(predictors, data, logs, command),
        options=options,
        shorter=data.shorter,
        n_logs=len(data.voyages),
        notes={
            name: (*of_another_ship(one, data.ship, name), *_notes(one, around[name]))
            for name, one in predictors.items()
        },
        interrupted=interrupted,
        wall_s=time.perf_counter() - began,
    )


def _notes(predictor: Predictor, around: Mapping[str, FloatArray]) -> tuple[str, ...]:
    """What a reader should know of the surroundings of the voyages for one model."""
    return tuple(notes(predictor.model, around, of="voyage")) if isinstance(predictor, PhysicsPredictor) else ()


def _identity(predictors: Mapping[str, Predictor], data: VoyageSet, options: VoyageOptions) -> dict[str, Any]:
    """Everything a run depends on but what is in the voyages, which is noted with each."""
    made = made_by("")
    return {
        "profiles": {name: [one.name, one.method, sha256_of(one)] for name, one in predictors.items()},
        "trials": [one.id for one in data.voyages],
        "options": options.to_dict(),
        "versions": {**made["environment"], "mmgtune": made["mmgtune"]},
    }


def _portions(windows: Iterator[Window]) -> Iterator[list[Window]]:
    """Windows that are scored together."""
    some: list[Window] = []
    longest = 0
    for one in windows:
        longest = max(longest, one.trial.n_samples)
        if some and (len(some) + 1) * longest > AT_ONCE:
            yield some
            some, longest = [], one.trial.n_samples
        some.append(one)
    if some:
        yield some


def _drawn(table: WindowTable, data: VoyageSet, predictors: Mapping[str, Predictor]) -> tuple[DrawnWindow, ...]:
    """The best, the median and the worst windows by cVDM of the first model, read and simulated anew."""
    cVDM = next(iter(table.models.values())).cVDM
    sound = np.flatnonzero(np.isfinite(cVDM))
    order = sound[np.argsort(cVDM[sound], kind="stable")]
    middle = max(0, (len(order) - EACH) // 2)
    places: dict[int, str] = {}
    for role, chosen in (("best", order[:EACH]), ("worst", order[::-1][:EACH]), ("median", order[middle:][:EACH])):
        for place in chosen.tolist():
            places.setdefault(place, role)
    found = []
    for role in ("best", "median", "worst"):
        for place in (one for one, of in places.items() if of == role):
            voyage = data.voyages[int(table.voyage[place])]
            trial = window_at(voyage, int(table.row[place]), int(table.n_samples[place])).trial
            windows = windows_of([trial])
            states = {
                name: score_windows(one, windows, cases_for(windows, one.inputs, draught_of(one)))[1][0]
                for name, one in predictors.items()
            }
            found.append(DrawnWindow(place, role, trial.t, trial.motion, trial.delta, states))
    return tuple(found)


def _bands(
    table: WindowTable, data: VoyageSet, predictors: Mapping[str, Predictor], sigma: Mapping[str, float]
) -> dict[str, Pooled]:
    """Scores of the bands of models that have some, on windows evenly among all."""
    if not any(isinstance(one, Uncertain) or one.n_members > 1 for one in predictors.values()):
        return {}
    chosen = np.unique(np.linspace(0, len(table) - 1, min(BANDED, len(table))).astype(int)).tolist()
    trials = [
        window_at(data.voyages[int(table.voyage[k])], int(table.row[k]), int(table.n_samples[k])).trial for k in chosen
    ]
    found = {name: bands_of(one, trials, sigma) for name, one in predictors.items()}
    return {name: of[None] for name, of in found.items() if of}


def _provenance(
    predictors: Mapping[str, Predictor], data: VoyageSet, logs: Sequence[Log], command: str
) -> dict[str, Any]:
    profiles = {name: profile_of(one) for name, one in predictors.items()}
    return {
        **made_by(command),
        "profiles": {name: facts_of_profile(one) for name, one in profiles.items() if one is not None},
        "trials": {
            "path": str(data.path),
            "ship": data.ship,
            "licence": data.licence,
            "citation": data.citation,
            "sha256": {log.voyage.id: log.sha256 for log in logs},
            "source": {log.voyage.id: log.voyage.source for log in logs},
        },
    }


def _nothing(data: VoyageSet, logs: Sequence[Log]) -> Problem:
    """The problem of voyages without a window."""
    left = {reason: sum(log.counted.left_out[reason] for log in logs) for reason in Cutting().left_out}
    resting = sum(log.at_rest for log in logs)
    why = ", ".join(f"{count} rows {reason}" for reason, count in left.items() if count)
    why = "; ".join(filter(None, (why, f"{resting} windows with the ship at rest" if resting else "")))
    return Problem(
        "no window could be cut out of these voyages",
        str(data.path),
        why,
        "a window needs motion and inputs without a gap longer than gap=S; see the guide on voyages",
    )
