"""Fits over several widths of the box: how far may the coefficients be moved before the fit stops carrying over?"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from ..displayed import Plotted
from ..documents import finite_values
from ..errors import must_be_a
from ..files import kept_in
from ..hooks import Hooks
from ..options import SweepOptions
from ..options.choice import must_be
from ..profile import ShipProfile
from ..run_files import SWEEP
from ..run_provenance import identity_of, make_provenance
from ..trial import TrialSet
from ..writing_results import place_for, write_record
from .box import A_R
from .comparison import TrialComparison, compare, counted_trials, mean_off, off_document, off_in_words
from .extending import settled
from .folder import write_run
from .journal import finished, journalled
from .least_squares import fit_offsets, solve
from .leaving_out import leaving_out
from .optimum import edge_ridge
from .result import FitResult, Warned
from .robust import weigh_down
from .run import fit
from .setting import in_pieces, make_problem, make_setting


@dataclass(frozen=True, eq=False)
class SweepResult(Plotted):
    """Fits by rising a_r; of one that was stopped those finished, and the best so far of the one it was at.

    leave_one_out  J over trials left out one at a time, per a_r; None where there are test trials to judge by
    left_out       these trials against what was fitted without them, per a_r
    """

    written_by = "write_sweep"

    runs: tuple[FitResult, ...]
    leave_one_out: tuple[float, ...] | None
    wall_s: float
    interrupted: bool = False
    left_out: tuple[tuple[TrialComparison, ...], ...] = ()

    def __repr__(self) -> str:
        """In a line."""
        stopped = ", interrupted" if self.interrupted else ""
        return f"SweepResult({self.runs[0].profile.id}, a_r {', '.join(f'{a_r:g}' for a_r in self.widths)}{stopped})"

    @property
    def widths(self) -> list[float]:
        """The half widths a_r."""
        return [run.options.a_r or A_R for run in self.runs]  # a sweep gives it

    def judged(self) -> list[float]:
        """J on trials not used, per a_r: of the test set, or left out one at a time."""
        if self.leave_one_out is not None:
            return list(self.leave_one_out)
        return [np.inf if (J := run.J_of("test", "after")) is None else J for run in self.runs]

    def compared(self, i: int, role: str) -> list[TrialComparison]:
        """The trials of a role, "tune", "test" or "left-out", with the fit of one a_r."""
        if role == "left-out":
            return list(self.left_out[i]) if self.left_out else []
        return [one for one in self.runs[i].compared if one.role == role]

    def held_out(self, i: int) -> list[TrialComparison]:
        """The trials that the fit of one a_r is judged by."""
        return self.compared(i, "test" if self.leave_one_out is None else "left-out")

    @property
    def best(self) -> int:
        """Which run has the least J on trials not used."""
        return int(np.argmin(self.judged()))

    def recommended(self) -> dict[str, Any]:
        """The a_r with the least J on trials not used; none where the sweep was stopped."""
        if self.interrupted:
            done = sum(not run.interrupted for run in self.runs)
            words = f"The sweep was stopped after {done} of its widths; no a_r is recommended before all are done."
            return {"a_r": None, "by": None, "sentence": words}
        judged, best = self.judged(), self.best
        a_r = self.widths[best]
        by = "leave-one-trial-out" if self.leave_one_out is not None else "test set"
        if not np.isfinite(judged[best]):
            return {
                "a_r": None,
                "by": by,
                "sentence": "No a_r can be recommended: every simulation of the judging trials diverged.",
            }
        edge = (
            " It is the widest tried; a wider box may do better." if best == len(judged) - 1 and len(judged) > 1 else ""
        )
        return {
            "a_r": a_r,
            "by": by,
            "sentence": f"{self._off(best)}{edge}",
        }

    def _off(self, i: int) -> str:
        """What the fit of the recommended a_r is worth on trials held out: metres and degrees first, J after."""
        held, run = self.held_out(i), self.runs[i]
        after, before = (off_in_words(held, which) if held else {} for which in ("after", "before"))
        J = f"J is least with this width ({run.method}: {self.judged()[i]:.4g})"
        if not after:
            return f"Use a_r = {self.widths[i]:g}: on trials not used for tuning {J}."
        trials = counted_trials(held)
        each = "each trial" if any(one.trial.part_of for one in held) else "each"
        where = f"{trials} not used for tuning" if self.leave_one_out is None else f"{trials}, {each} left out in turn"
        sizes = " and ".join(f"{size} off {of}" for of, size in after.items())
        instead = f" instead of {' and '.join(before.values())}" if list(before) == list(after) else ""
        return (
            f"On {where}, {run.profile.name} tuned with a_r = {self.widths[i]:g} is {sizes}{instead} "
            f"(root mean square); {J}."
        )

    def sentence(self) -> str:
        """Which width is recommended and what it is worth, and whether wider boxes over-fit."""
        return f"{self.recommended()['sentence']} {self.overfitting()['sentence']}"

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader must know first: of the best fit, or of the last where the sweep was stopped."""
        return tuple(one.words for one in self.warned())

    def warned(self) -> list[Warned]:
        """What a reader must know first, each with its code."""
        return self.runs[-1 if self.interrupted else self.best].warned()

    def overfitting(self) -> dict[str, Any]:
        """Whether trials not used get worse while J falls on those tuned to; not said of a sweep that was stopped.

        They do where J rises on them and their tracks come no closer: J alone may rise where the metres improve.
        """
        if self.interrupted:
            return {"found": None, "sentence": "Whether a wider box over-fits is not known before all widths are done."}
        judged, best = self.judged(), self.best
        rises = [
            i
            for i in range(best + 1, len(judged))
            if judged[i] > judged[best] * 1.01 and self.runs[i].J < self.runs[best].J
        ]
        worse = [i for i in rises if not self._closer(i)]
        if rises and not worse:
            i = max(rises, key=lambda k: judged[k])
            return {
                "found": False,
                "sentence": (
                    f"No clear over-fitting: at a_r = {self.widths[i]:g} J rises to {judged[i]:.4g} on trials not "
                    f"used, from {judged[best]:.4g}, but their tracks come closer: {self._further_off(i)}."
                ),
            }
        if not worse:
            return {
                "found": False,
                "sentence": "No over-fitting: a wider box nowhere costs accuracy on trials not used.",
            }
        i = max(worse, key=lambda k: judged[k])
        further = self._further_off(i)
        return {
            "found": True,
            "sentence": (
                f"Over-fitting from a_r = {self.widths[worse[0]]:g}: at a_r = {self.widths[i]:g} "
                f"{f'{further}; ' if further else ''}J falls to {self.runs[i].J:.4g} on the tune trials "
                f"but rises to {judged[i]:.4g} on trials not used, from {judged[best]:.4g}."
            ),
        }

    def _closer(self, i: int) -> bool:
        """Whether the tracks of trials held out are closer at an a_r than at the recommended one, as mean."""
        there, best = (mean_off(held, "after") if (held := self.held_out(k)) else {} for k in (i, self.best))
        return list(there) == list(best) and "track" in there and there["track"] < best["track"]

    def _further_off(self, i: int) -> str:
        """How far off trials held out are at an a_r, and at the recommended one."""
        there, best = (off_in_words(held, "after") if (held := self.held_out(k)) else {} for k in (i, self.best))
        if not there or list(there) != list(best):
            return ""
        sizes = " and ".join(f"{size} off {of}" for of, size in there.items())
        return f"trials not used are {sizes}, with a_r = {self.widths[self.best]:g} {' and '.join(best.values())}"

    def to_dict(self) -> dict[str, Any]:
        """The document of ``sweep.json``, schema 1 (docs/formats.md)."""
        first = self.runs[0]
        loo = self.leave_one_out
        return {
            "schema": 1,
            "kind": "sweep",
            **first.provenance,
            "interrupted": self.interrupted,
            "a_r": self.widths,
            "integrator": first.method,
            "J_tune_before": first.J_of("tune", "before"),
            "J_test_before": first.J_of("test", "before"),
            "runs": [
                {
                    "a_r": run.options.a_r,
                    "out": folder_name(a_r),
                    "J_tune": run.J_of("tune", "after"),
                    "J_test": run.J_of("test", "after"),
                    "off": {
                        role: off_document(of)
                        for role in ("tune", "test", "left-out")
                        if (of := self.compared(i, role))
                    },
                    "J_tune_cmaes": run.certificate.J_cmaes,
                    "agreement": run.certificate.agreement(),
                    "theta": finite_values(run.theta),
                    "coefficients": run.coefficients(),
                    "at_bound": run.at_bound,
                    "undetermined": list(run.identifiability.undetermined),
                    "evaluations": run.evaluations,
                    "wall_s": run.wall_s,
                }
                for i, (a_r, run) in enumerate(zip(self.widths, self.runs, strict=True))
            ],
            "recommended": self.recommended(),
            "leave_one_out": None
            if loo is None
            else [{"a_r": a, "J": J} for a, J in zip(self.widths, loo, strict=True)],
            "overfitting": self.overfitting(),
            "warnings": list(self.warnings),
            "warning_codes": [one.code for one in self.warned()],
            "doubts": [one.to_dict() for one in first.profile.doubts()],
            "citations": first.profile.cites(),
            "wall_s": self.wall_s,
        }


def folder_name(a_r: float) -> str:
    """Sub-folder of one run of a sweep; no two half widths share one."""
    short = f"{a_r:g}"
    return f"ar_{short if float(short) == a_r else repr(a_r)}"


def sweep(
    profile: ShipGiven,
    trials: TrialsGiven,
    options: SweepOptions = SweepOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | str | None = None,
    resume: bool = False,
    command: str = "",
) -> SweepResult:
    """Fit at every half width; each fit also starts from the optimum of the narrower boxes, so J never rises with a_r.

    profile, trials  objects, paths or bundled names
    hooks   what is told on the way, and what ends it: see ``until_interrupted`` for Ctrl-C
    folder  where each finished fit is written at once, in a sub-folder of its own; None for nowhere
    resume  continue the sweep in the folder that was stopped: what is finished there is read back
    Raises OptionError for choices that make no sense, OutputError where the folder cannot be written to.
    """
    folder = kept_in(folder, resume)
    must_be(options, SweepOptions)
    must_be_a(hooks, Hooks, "hooks")
    profile, trials = ship_of(profile), trials_of(trials)
    profile, options = settled(profile, options, trials)
    identity = identity_of(profile, trials, options, make_provenance(profile, trials, command))
    with journalled(folder, identity, hooks.stop, resume=resume):
        swept = _sweep(profile, trials, options, hooks, folder, resume, command)
    if folder is not None:
        _write_table(swept, folder)
    return swept


def write_sweep(result: SweepResult, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write a sweep, and each of its fits into a folder of its own inside: ``ar_0.3``.  Returns the document.

    A sweep that was given a folder has written itself there already.
    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, SweepResult, folder, SWEEP, overwrite=overwrite) as place:
        for a_r, run in zip(result.widths, result.runs, strict=True):
            write_run(run, place / folder_name(a_r), overwrite=overwrite)
        return _write_table(result, place)


def _write_table(result: SweepResult, place: Path) -> dict[str, Any]:
    """Write the document of a sweep whose fits are written.  Returns it."""
    document = write_record(result.to_dict(), place, SWEEP)
    if not result.interrupted:
        finished(place)
    return document


def _sweep(
    profile: ShipProfile,
    trials: TrialSet,
    options: SweepOptions,
    hooks: Hooks,
    folder: Path | None,
    resume: bool,
    command: str,
) -> SweepResult:
    began = time.perf_counter()
    whole, trials = trials, in_pieces(trials, options)
    for a_r in options.widths:  # every width must be possible before the first is worked on
        make_problem(profile, trials, options.at(a_r))
    runs: list[FitResult] = []
    for a_r in sorted(options.widths):
        own = None if folder is None else folder / folder_name(a_r)
        result = fit(
            profile,
            whole,  # each fit cuts them itself, and says of whole trials what is odd about them
            options.at(a_r),
            hooks=_named(hooks, a_r),
            more_starts=tuple(run.theta for run in runs[-1:]),
            folder=own,
            resume=resume,
            command=command,
        )
        runs.append(result)
        if own is not None:
            write_run(result, own, overwrite=True)
        if hooks.stop():
            break
    left_out: list[tuple[float, tuple[TrialComparison, ...]]] = []
    if not trials.test and len({trials.trials[name].run for name in trials.tune}) > 1 and not hooks.stop():
        hooks.on_phase("leaving out one trial at a time")
        left_out = [_leave_one_out(profile, trials, run, hooks) for run in runs]
    stopped = hooks.stop()
    return SweepResult(
        tuple(runs),
        tuple(J for J, _ in left_out) if left_out and not stopped else None,
        time.perf_counter() - began,
        interrupted=stopped,
        left_out=() if stopped else tuple(of for _, of in left_out),
    )


def _named(hooks: Hooks, a_r: float) -> Hooks:
    """The hooks, with the half width in front of every phase."""
    return replace(hooks, on_phase=lambda words: hooks.on_phase(f"a_r = {a_r:g}, {words}"))


def _leave_one_out(
    profile: ShipProfile, trials: TrialSet, run: FitResult, hooks: Hooks
) -> tuple[float, tuple[TrialComparison, ...]]:
    """J summed over the tune trials, each simulated with coefficients fitted to the others as the run was to all, and
    those of them that are time series.

    NaN where stopped.
    """
    total, compared = 0.0, list[TrialComparison]()
    start, before = run.unit[:, None], run.box.to_unit(run.box.pre)
    setting = make_setting(profile, trials, run.options)
    whole = setting.problem()
    ridge = edge_ridge(whole.with_weight(run.beside.weight.s2) if run.beside else whole, run.options, before)
    dealt = list(leaving_out(trials))
    for k, (left_out, others) in enumerate(dealt):
        hooks.on_progress(k, len(dealt), "trials")
        if hooks.stop():
            return float("nan"), ()
        part = setting.problem(others)
        part = part.with_weight(run.beside.weight.s2) if run.beside else part
        fitted = solve(part, start, ridge=ridge, anchor=before, stop=hooks.stop)[0]
        if run.options.loss == "huber" and not hooks.stop():
            _, fitted = weigh_down(part, fitted, ridge, before)
        alone = setting.problem(left_out)
        offsets = None if alone.sigma is None else fit_offsets(alone, fitted.unit)[:, None]
        total += float(alone.misfit(fitted.unit[:, None], offsets)[0])
        series = [trials.trials[name] for name in left_out if name in trials.trials]
        if len(series) == len(left_out):
            roles = dict.fromkeys(left_out, "left-out")
            compared += compare(alone, series, setting.objective, roles, before, fitted.unit)
    return total, tuple(compared)
