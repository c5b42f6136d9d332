"""Fits over several widths of the box: how far may the coefficients be moved before the fit stops carrying over?"""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import OptionError, Problem
from ..files import write_text
from ..profile import ShipProfile
from ..trial import TrialSet
from .comparison import finite_values
from .folder import write_run
from .least_squares import fit_offsets, solve
from .leaving_out import leaving_out
from .options import FitOptions
from .result import FitResult
from .run import Hooks, fit, in_pieces, make_problem

RESULT = "sweep.json"


@dataclass(frozen=True, eq=False)
class SweepResult:
    """Fits by rising a_r.

    leave_one_out  J over trials left out one at a time, per a_r; None where there are test trials to judge by
    """

    runs: tuple[FitResult, ...]
    leave_one_out: tuple[float, ...] | None
    wall_s: float
    interrupted: bool = False

    @property
    def widths(self) -> list[float]:
        """The half widths a_r."""
        return [run.options.a_r for run in self.runs]

    def judged(self) -> list[float]:
        """J on trials not used, per a_r: of the test set, or left out one at a time."""
        if self.leave_one_out is not None:
            return list(self.leave_one_out)
        return [np.inf if (J := run.J_of("test", "after")) is None else J for run in self.runs]

    @property
    def best(self) -> int:
        """Which run has the least J on trials not used."""
        return int(np.argmin(self.judged()))

    def recommended(self) -> dict[str, Any]:
        """The a_r with the least J on trials not used."""
        judged, best = self.judged(), self.best
        a_r = self.widths[best]
        by = "leave-one-trial-out" if self.leave_one_out is not None else "test set"
        if not np.isfinite(judged[best]):
            return {
                "a_r": None,
                "by": by,
                "sentence": "No a_r can be recommended: every simulation of the judging trials diverged.",
            }
        how = "trials left out one at a time" if self.leave_one_out is not None else "the test trials"
        edge = (
            " It is the widest tried; a wider box may do better." if best == len(judged) - 1 and len(judged) > 1 else ""
        )
        return {
            "a_r": a_r,
            "by": by,
            "sentence": f"Use a_r = {a_r:g}: it has the least J on {how} ({judged[best]:.4g}).{edge}",
        }

    def overfitting(self) -> dict[str, Any]:
        """Whether J rises on trials not used while it falls on those tuned to."""
        judged, best = self.judged(), self.best
        worse = [
            i
            for i in range(best + 1, len(judged))
            if judged[i] > judged[best] * 1.01 and self.runs[i].J < self.runs[best].J
        ]
        if not worse:
            return {
                "found": False,
                "sentence": "No over-fitting: a wider box nowhere costs accuracy on trials not used.",
            }
        i = max(worse, key=lambda k: judged[k])
        return {
            "found": True,
            "sentence": (
                f"Over-fitting from a_r = {self.widths[worse[0]]:g}: "
                f"at a_r = {self.widths[i]:g} J falls to {self.runs[i].J:.4g} "
                f"on the tune trials but rises to {judged[i]:.4g} on trials not used, from {judged[best]:.4g}."
            ),
        }

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
                    "out": folder_name(run.options.a_r),
                    "J_tune": run.J_of("tune", "after"),
                    "J_test": run.J_of("test", "after"),
                    "J_tune_cmaes": run.certificate.J_cmaes,
                    "agreement": run.certificate.agreement(),
                    "theta": finite_values(run.theta),
                    "coefficients": run.coefficients(),
                    "at_bound": run.at_bound,
                    "undetermined": list(run.identifiability.undetermined),
                    "evaluations": run.evaluations,
                    "wall_s": run.wall_s,
                }
                for run in self.runs
            ],
            "recommended": self.recommended(),
            "leave_one_out": None
            if loo is None
            else [{"a_r": a, "J": J} for a, J in zip(self.widths, loo, strict=True)],
            "overfitting": self.overfitting(),
            "warnings": self.runs[self.best].warnings(),
            "citations": first.profile.cites(),
            "wall_s": self.wall_s,
        }


def folder_name(a_r: float) -> str:
    """Sub-folder of one run of a sweep."""
    return f"ar_{a_r:g}"


def sweep(
    profile: ShipProfile,
    trials: TrialSet,
    widths: Sequence[float],
    options: FitOptions = FitOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | None = None,
    command: str = "",
) -> SweepResult:
    """Fit at every half width; each fit also starts from the optimum of the narrower boxes, so J never rises with a_r.

    folder  where each finished fit is written at once, in a sub-folder of its own; None for nowhere
    Raises OptionError for no width, or one given twice.
    """
    began = time.perf_counter()
    trials = in_pieces(trials, options)
    if not widths or len(set(widths)) < len(widths):
        what = "a half width is given twice" if widths else "no half width to sweep over"
        raise OptionError(Problem(what, "--ar", fix="write --ar 0.2,0.3,0.4,0.5,0.6"))
    for a_r in widths:  # every width must be possible before the first is worked on
        make_problem(profile, trials, replace(options, a_r=a_r))
    runs: list[FitResult] = []
    for a_r in sorted(widths):
        result = fit(
            profile,
            trials,
            replace(options, a_r=a_r),
            hooks=_named(hooks, a_r),
            more_starts=tuple(run.theta for run in runs[-1:]),
            command=command,
        )
        runs.append(result)
        if folder is not None:
            write_run(result, folder / folder_name(a_r))
        if hooks.stop():
            break
    left_out = None
    if not trials.test and len({trials.trials[name].run for name in trials.tune}) > 1 and not hooks.stop():
        hooks.on_phase("leaving out one trial at a time")
        left_out = tuple(_leave_one_out(profile, trials, run) for run in runs)
    swept = SweepResult(tuple(runs), left_out, time.perf_counter() - began, interrupted=hooks.stop())
    if folder is not None:
        write_text(
            folder / RESULT,
            json.dumps({**swept.to_dict(), "out": str(folder)}, indent=1, allow_nan=False, ensure_ascii=False) + "\n",
        )
    return swept


def _named(hooks: Hooks, a_r: float) -> Hooks:
    """The same hooks, with the half width in front of every phase."""
    return replace(hooks, on_phase=lambda words: hooks.on_phase(f"a_r = {a_r:g}, {words}"))


def _leave_one_out(profile: ShipProfile, trials: TrialSet, run: FitResult) -> float:
    """J summed over the tune trials, each simulated with coefficients fitted to the others."""
    total = 0.0
    start = run.unit[:, None]
    for left_out, others in leaving_out(trials):
        fitted = min(solve(make_problem(profile, trials, run.options, others), start), key=lambda end: end.J)
        alone = make_problem(profile, trials, run.options, left_out)
        offsets = None if alone.sigma is None else fit_offsets(alone, fitted.unit)[:, None]
        total += float(alone.costs(fitted.unit[:, None], offsets)[0])
    return total
