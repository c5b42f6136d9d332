"""What a tuning is worth on runs it has not seen: runs left out in turn, or in folds, and scored."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from ..arrays import FloatArray
from ..bands import Pooled
from ..circumstances import notes_on
from ..displayed import Plotted
from ..documents import finite, finite_values
from ..errors import OptionError, Problem, must_be_a
from ..evaluation import TrialRecord
from ..files import kept_in
from ..hooks import Hooks
from ..inputs import INPUTS
from ..model import Model
from ..objective import spread
from ..options import FitOptions, LeaveOutOptions
from ..options.choice import must_be
from ..parquet_tables import write_table
from ..phrases import capital
from ..predictor import as_predictor, words_of
from ..profile import ShipProfile
from ..profile.doubts import Doubt, in_words
from ..repeating import Repeated, document, repetitions
from ..run_files import LEFT_OUT, MOTIONS
from ..run_provenance import identity_of, make_provenance
from ..scores import L_MSE, TrialScore, by_manoeuvre, improvement, off_by, score_of
from ..stated_indices import IndexComparison, compare_stated
from ..threads import blas_on_one_thread
from ..trial import Coverage, Trial, TrialSet, another_ship, oddities
from ..writing_results import place_for, write_record
from .amounts import telling
from .comparison import ComparedTrials, TrialComparison, records_at
from .extending import held_words, settled, tune_trials
from .folder import motions_table
from .journal import finished, journalled
from .least_squares import solve
from .one_sided import coverage_notes
from .optimum import edge_ridge, random_starts
from .problem import FitProblem
from .robust import weigh_down
from .run import fixed_where_undetermined
from .setting import in_pieces, make_problem
from .weighing import Weight, weigh

LEAST_FALL = 1e-4
"""Fall of J, as a share, that counts as none: scores of runs left out do not show it."""


def leaving_out(trials: TrialSet, folds: int = 0) -> Iterator[tuple[tuple[str, ...], tuple[str, ...]]]:
    """Ids of the tune trials left out and of the others, in turn; windows of a run go together.

    folds  number of parts the runs are dealt out to; 0 for a part of its own for each run

    Raises OptionError where all of them are one part: nothing would be left to fit to.
    """
    run_of = {name: trials.trials[name].run for name in trials.tune} | {name: name for name in trials.tune_stated}
    runs = list(dict.fromkeys(run_of.values()))
    n_parts = min(folds or len(runs), len(runs))
    if n_parts < 2:
        why = "what is scored would be what was fitted to"
        if len(runs) > 1:
            raise OptionError(
                Problem("all runs are one part", "folds", why, "write folds=2 or more, or 0 for each run")
            )
        what = f"only {', '.join(runs) or 'no run'} to tune to, and leaving it out leaves none"
        raise OptionError(Problem(what, "trials", why, "give two runs or more, or fit and validate on another run"))
    for k in range(n_parts):
        part = set(runs[k::n_parts])
        out = tuple(name for name in run_of if run_of[name] in part)
        yield out, tuple(name for name in run_of if name not in out)


@dataclass(frozen=True, eq=False)
class BandsLeftOut:
    """Bands against runs that their particles have not seen.

    by_kind  all together under "", and each kind of manoeuvre; empty where no part was finished
    by_run   each run
    parts    number of parts whose bands were drawn
    """

    by_kind: Mapping[str, Pooled]
    by_run: Mapping[str, Pooled]
    parts: int

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "parts": self.parts,
            "by_manoeuvre": {kind or "all": of.to_dict() for kind, of in self.by_kind.items()},
            "by_run": {run: of.to_dict() for run, of in self.by_run.items()},
        }


@dataclass(frozen=True, eq=False)
class LeftOut(Plotted):
    """Every tune trial scored by coefficients that were fitted without its run.

    thetas   values by name in profile units, fitted without each part of the runs
    parts    ids of the runs of each part
    before, after  scores of all tune trials with the profile's values, and with those fitted without them
    repeated_before, repeated_after  their manoeuvres repeated likewise, where asked for
    stated   stated indices with the profile's values ("before") and with those fitted without them ("left_out")
    n_parts  how many there are to be
    interrupted  stopped by the user; scores are of the parts finished by then
    weight   of what is known beforehand, found with all runs; None where J is all
    warnings what a reader must know first; doubts: which of the profile's numbers may be wrong
    bands    of each part from the other runs, where asked for: ``posterior.leave_out_with_bands``
    compared each tune trial with the profile's values ("before") and with those fitted without it ("after");
             ``compared.to_frame()`` has a row a trial
    inputs   names of what drives the ship
    """

    written_by = "write_left_out"

    thetas: tuple[dict[str, float], ...]
    parts: tuple[tuple[str, ...], ...]
    before: tuple[TrialScore, ...]
    after: tuple[TrialScore, ...]
    options: LeaveOutOptions
    sigma: dict[str, float]
    provenance: dict[str, Any]
    wall_s: float
    n_parts: int
    interrupted: bool = False
    weight: Weight | None = None
    repeated_before: tuple[Repeated, ...] = ()
    repeated_after: tuple[Repeated, ...] = ()
    stated: tuple[IndexComparison, ...] = ()
    L_pp: float = 1.0
    warnings: tuple[str, ...] = ()
    doubts: tuple[Doubt, ...] = ()
    bands: BandsLeftOut | None = None
    compared: ComparedTrials = field(default_factory=ComparedTrials)
    inputs: tuple[str, ...] = ()

    @property
    def method(self) -> str:
        """How trials were simulated, to be named beside J."""
        return words_of(self.options.make_integrator())

    def __repr__(self) -> str:
        """In a line."""
        stopped = ", interrupted" if self.interrupted else ""
        scores = "" if not self.before else f", L_MSE {L_MSE(self.before):.4g} -> {L_MSE(self.after):.4g}"
        return (
            f"LeftOut({self.provenance['profile']['id']}, {len(self.parts)} of {self.n_parts} parts{scores}{stopped})"
        )

    def rows(self) -> list[dict[str, Any]]:
        """L_MSE and J before and after over all, then by kind of manoeuvre, with the share removed and its interval.

        Empty where no part was finished, or none is of time series.
        """
        if not self.before:
            return []
        groups = {"": (self.before, self.after)}
        after = by_manoeuvre(self.after)
        groups |= {kind: (tuple(of), tuple(after[kind])) for kind, of in by_manoeuvre(self.before).items() if kind}
        return [_row(kind, old, new, self.sigma) for kind, (old, new) in groups.items()]

    def stated_rms(self) -> dict[str, float]:
        """Root mean square of what stated indices are off by, in tolerances, before and left out."""
        return {
            which: float(np.sqrt(np.mean([one.off(which) ** 2 for one in self.stated])))
            for which in ("before", "left_out")
        }

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        found = {
            "schema": 1,
            "kind": "leave-out",
            **self.provenance,
            "interrupted": self.interrupted,
            "n_parts": self.n_parts,
            "warnings": list(self.warnings),
            "doubts": [one.to_dict() for one in self.doubts],
            "options": self.options.to_dict(),
            "sigma": finite_values(self.sigma),
            "integrator": self.method,
            "scores": self.rows(),
            "parts": [
                {"left_out": list(runs), "theta": finite_values(theta)}
                for runs, theta in zip(self.parts, self.thetas, strict=True)
            ],
            "L_pp": self.L_pp,
            "inputs": [INPUTS[name].to_dict() for name in self.inputs],
            "trial_results": [one.to_dict() for one in self.compared],
            "wall_s": self.wall_s,
        }
        if self.stated:
            found["stated"] = [one.to_dict(self.L_pp) for one in self.stated]
            found["stated_rms"] = {which: finite(value) for which, value in self.stated_rms().items()}
        if self.weight:
            found["weight"] = self.weight.to_dict()
        if self.bands:
            found["bands"] = self.bands.to_dict()
        if self.options.manoeuvres:
            found["manoeuvres"] = {
                "before": document(self.repeated_before),
                "left_out": document(self.repeated_after),
            }
        return found


def _row(
    kind: str, before: Sequence[TrialScore], after: Sequence[TrialScore], sigma: Mapping[str, float]
) -> dict[str, Any]:
    share, interval = improvement(before, after)
    return {
        "manoeuvre": kind or "all",
        "runs": len({one.run for one in before}),
        "L_MSE_before": finite(L_MSE(before)),
        "L_MSE_after": finite(L_MSE(after)),
        "J_before": finite(sum(one.J for one in before)),
        "J_after": finite(sum(one.J for one in after)),
        **{f"{name}_before": finite(value) for name, value in off_by(before, sigma).items()},
        **{f"{name}_after": finite(value) for name, value in off_by(after, sigma).items()},
        "share_removed": finite(share),
        "share_removed_ci95": list(interval) if interval and np.isfinite(interval).all() else None,
    }


@blas_on_one_thread
def leave_out(
    profile: ShipGiven,
    trials: TrialsGiven,
    options: LeaveOutOptions = LeaveOutOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | str | None = None,
    resume: bool = False,
    command: str = "",
) -> LeftOut:
    """Fit by least squares without each part of the runs in turn, and score the runs left out.

    profile, trials  objects, paths or bundled names
    hooks   what is told on the way, and what ends it: see ``until_interrupted`` for Ctrl-C
    folder  where each finished fit is noted at once; None for nowhere
    resume  continue what was stopped in the folder

    Every fit starts from the fit to all runs; that one takes the starts of the options.
    Raises OptionError for choices that make no sense, OutputError where the folder cannot be written to.
    """
    folder = kept_in(folder, resume)
    must_be(options, LeaveOutOptions)
    must_be_a(hooks, Hooks, "hooks")
    profile, trials = ship_of(profile), trials_of(trials)
    profile, options = settled(profile, options, trials)
    provenance = make_provenance(profile, trials, command)
    identity = identity_of(profile, trials, options, provenance)
    with journalled(folder, identity, hooks.stop, resume=resume):
        return _leave_out(profile, trials, options, hooks, provenance)


def write_left_out(result: LeftOut, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write the result, and the motions of the trials left out.  Returns its document.

    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, LeftOut, folder, LEFT_OUT, MOTIONS, overwrite=overwrite) as place:
        write_table(place / MOTIONS, motions_table(result.compared, result.inputs))
        document = write_record(result.to_dict(), place, LEFT_OUT)
        if not result.interrupted:
            finished(place)
        return document


def _leave_out(
    profile: ShipProfile, whole: TrialSet, asked: LeaveOutOptions, hooks: Hooks, provenance: dict[str, Any]
) -> LeftOut:
    began = time.perf_counter()
    fit = _ToAllRuns.of(profile, whole, asked, hooks)
    trials, model = fit.trials, fit.problem.model
    dealt = list(leaving_out(trials, asked.folds))
    parts = []
    for k, (out, others) in enumerate(dealt):
        hooks.on_progress(k, len(dealt), "parts")
        part = None if hooks.stop() else fit.without(out, others, hooks)
        if part is None:
            break
        parts.append(part)
    left = {name: record for part in parts for name, record in part.records.items()}
    repeated = {name: manoeuvre for part in parts for name, manoeuvre in part.repeated.items()}
    stated = [index for part in parts for index in part.stated]
    chosen = [trials.trials[name] for name in trials.tune]
    sigma = spread(chosen) if chosen else {}
    seen = [trial for trial in chosen if trial.id in left]
    given = fit.simulated(seen, fit.before)
    return LeftOut(
        tuple(part.values for part in parts),
        tuple(part.runs for part in parts),
        tuple(score_of(given[trial.id], sigma) for trial in seen),
        tuple(score_of(left[trial.id], sigma) for trial in seen),
        asked,
        sigma,
        provenance,
        time.perf_counter() - began,
        len(dealt),
        len(parts) < len(dealt),
        fit.weight,
        tuple(repetitions(as_predictor(model), _named(whole, seen))) if asked.manoeuvres else (),
        tuple(repeated[name] for name in dict.fromkeys(trial.whole for trial in seen) if name in repeated),
        tuple(index for name in trials.tune_stated for index in stated if index.trial == name),
        model.L_pp,
        tuple(_warnings(model, fit.problem.box.names, whole, asked)),
        tuple(profile.doubts()),
        compared=ComparedTrials(
            TrialComparison(trial, "left-out", {"before": given[trial.id], "after": left[trial.id]}) for trial in seen
        ),
        inputs=tuple(one.name for one in profile.arrangement.inputs),
    )


@dataclass(frozen=True, eq=False)
class _Part:
    """A part of the runs, by coefficients fitted without it.

    values    by name, in profile units
    records   its trials simulated; repeated: their manoeuvres, where asked for
    stated    its stated indices with the profile's values ("before") and with these ("left_out")
    """

    runs: tuple[str, ...]
    values: dict[str, float]
    records: Mapping[str, TrialRecord]
    repeated: Mapping[str, Repeated]
    stated: Sequence[IndexComparison]


@dataclass(frozen=True, eq=False)
class _ToAllRuns:
    """The fit to all runs, from which each fit without some of them starts.

    whole   trials as given; trials: in the pieces they are fitted in
    before  (n_targets,) the profile's values in the unit cube; best: (n_targets,) where the fit ended, with J there
    ridge   of those that fit equally well the nearest to the profile's are preferred by so much
    weight  of what is known beforehand; None where J is all
    """

    profile: ShipProfile
    whole: TrialSet
    trials: TrialSet
    asked: LeaveOutOptions
    options: FitOptions
    problem: FitProblem
    before: FloatArray
    best: FloatArray
    J: float
    ridge: float
    weight: Weight | None

    @classmethod
    def of(cls, profile: ShipProfile, whole: TrialSet, asked: LeaveOutOptions, hooks: Hooks) -> _ToAllRuns:
        """Fit by least squares from the starts of the options."""
        options = asked.fit_options()
        trials = in_pieces(whole, options)
        if options.identifiable:
            options = fixed_where_undetermined(profile, trials, options)
        problem = make_problem(profile, trials, options)
        before = np.clip(problem.box.to_unit(problem.box.pre), 0.0, 1.0)
        problem, weight = weigh(problem, before, hooks.stop)
        hooks.on_phase("fitting all runs")
        ridge = edge_ridge(problem, options, before)
        starts = random_starts(problem, options, before, ())
        tolerance = LEAST_FALL * float(problem.costs(before[:, None])[0])
        stop = telling([problem], starts.shape[1], hooks)
        ends = solve(problem, starts, ridge=ridge, anchor=before, stop=stop, tolerance=tolerance)
        best = min(ends, key=lambda end: end.J)
        return cls(profile, whole, trials, asked, options, problem, before, best.unit, best.J, ridge, weight)

    def simulated(self, series: Sequence[Trial], unit: FloatArray) -> dict[str, TrialRecord]:
        """Trials by id, with coefficients at a point of the unit cube (n_targets,); where initial states are estimated,
        each from that which fits it best."""
        if not series:
            return {}
        problem = make_problem(self.profile, self.trials, self.options, [one.id for one in series])
        return {one.trial.id: one for one in records_at(problem, series, unit)}

    def without(self, out: Sequence[str], others: Sequence[str], hooks: Hooks) -> _Part | None:
        """Fit to the other runs and score those left out; None where it was stopped before its end."""
        box, model, trials = self.problem.box, self.problem.model, self.trials
        series = [trials.trials[name] for name in out if name in trials.trials]
        indices = [trials.stated[name] for name in out if name in trials.stated]
        runs = tuple(dict.fromkeys([*(one.run for one in series), *(one.run for one in indices)]))
        hooks.on_phase(f"leaving out {', '.join(runs)}")
        problem = make_problem(self.profile, trials, self.options, others).with_weight(self.problem.weight)
        how: dict[str, Any] = {"ridge": self.ridge, "anchor": self.before, "stop": hooks.stop}
        ends = solve(problem, self.best[:, None], tolerance=LEAST_FALL * self.J, **how)
        fitted = min(ends, key=lambda end: end.J + self.ridge * float(np.sum((end.unit - self.before) ** 2)))
        if self.options.loss == "huber" and not hooks.stop():
            problem, fitted = weigh_down(problem, fitted, self.ridge, self.before)
        if hooks.stop():
            return None
        values = dict(zip(box.names, box.from_unit(fitted.unit).tolist(), strict=True))
        theta = problem.theta(fitted.unit[:, None])
        records = self.simulated(series, fitted.unit)
        both = {"before": model.matrix()[:, 0], "left_out": theta[:, 0]}
        stated = compare_stated(model, both, indices, dict.fromkeys(out, "tune"), self.options.backend)
        repeated = {}
        if self.asked.manoeuvres:
            hooks.on_phase(f"repeating {', '.join(runs)}")
            again = repetitions(as_predictor(model, theta=theta), _named(self.whole, series))
            repeated = {one.id: one for one in again}
        return _Part(runs, values, records, repeated, stated)


def _warnings(model: Model, targets: Sequence[str], trials: TrialSet, options: LeaveOutOptions) -> list[str]:
    """What a reader must know before trusting the numbers."""
    tuned = tune_trials(trials)
    runs = {trial.run: [one for one in tuned if one.run == trial.run] for trial in tuned}
    beyond = [
        f"Left out, {run} goes where the others do not, {words}."
        for run, own in (runs.items() if len(runs) > 1 else ())
        for words in Coverage.of([one for one in tuned if one.run != run], model.L_pp).unvisited_by(
            Coverage.of(own, model.L_pp)
        )
    ]
    around = notes_on(model, tuned, free=targets)
    return [
        *(f"{capital(words)}." for words in another_ship(trials.ship, model.profile.id)),
        *oddities({trial.id: trial for trial in tuned}, model.L_pp),
        *(f"{words}." for words in in_words(model.profile.doubts())),
        *(f"{capital(note)}." for note in around),
        *coverage_notes(model, targets, Coverage.of(tuned, model.L_pp)),
        *beyond,
        *held_words(model.profile, options, tuned),
    ]


def _named(whole: TrialSet, pieces: Sequence[Trial]) -> list[Trial]:
    """The whole trials that pieces are of."""
    return [whole.trials[name] for name in dict.fromkeys(piece.whole for piece in pieces)]
