"""What a job can do: each command of one ship, run into a folder, and what of its result a fleet looks at."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import OptionError, Problem
from ..how_far_off import mean, mean_off_heading, mean_off_track, rms_errors
from ..options import CheckOptions, DiagnoseOptions, FitOptions, Options, SweepOptions, ValidateOptions
from ..phrases import counted
from ..run_files import CHECKED, DIAGNOSIS, FIT, INFORMATION, SWEEP, VALIDATION, VOYAGES

if TYPE_CHECKING:
    from ..profile import ShipProfile


@dataclass(frozen=True)
class Task:
    """What a command is run on.

    trials    where they lie on this machine
    baseline  of a check
    label     the job, for provenance
    """

    ship: ShipProfile
    trials: Path
    options: Any
    baseline: Path | None
    label: str


@dataclass(frozen=True)
class Facts:
    """What a fleet looks at of a result.

    answer    "good" or "no": whether nothing was found wrong
    verdict   in a sentence
    off_track, off_heading  root mean square of the model as given [m], [deg], on trials not tuned on if there are any
    tuned_track, tuned_heading  of the tuned one
    causes    what was named, by the effect's tag; sentences say it
    names, values, before, errors  coefficients that were tuned
    generated whether the trials were made, not measured
    """

    answer: str
    verdict: str
    off_track: float | None = None
    off_heading: float | None = None
    tuned_track: float | None = None
    tuned_heading: float | None = None
    causes: Sequence[str] = ()
    sentences: Sequence[str] = ()
    names: Sequence[str] = ()
    values: Sequence[float | None] = ()
    before: Sequence[float | None] = ()
    errors: Sequence[float | None] = field(default=())
    generated: bool = False


@dataclass(frozen=True)
class Command:
    """A command that jobs can be of.

    options  its dataclass
    run      writes a run folder, less its report, and returns the name of its record and the facts
    seconds  about how long it takes on this machine, from and to [s], without doing it where that is known
    """

    options: type[Options]
    run: Callable[[Task, Path], tuple[str, Facts]]
    seconds: Callable[[Task], tuple[float, float] | None]


def _fit(task: Task, folder: Path) -> tuple[str, Facts]:
    from ..files import write_text
    from ..fitting import fit, information_of, write_run
    from ..trial import load_trials

    trials = load_trials(task.trials)
    result = fit(task.ship, trials, task.options, command=task.label)
    document = write_run(result, folder, overwrite=True)
    told = information_of(result, trials)
    if told is not None:
        write_text(folder / INFORMATION, json.dumps(told.to_dict(), allow_nan=False) + "\n")
    return FIT, _of_fit(document, document["verdict"], "no" if document["misses"] else "good")


def _of_fit(document: Mapping[str, Any], verdict: str, answer: str) -> Facts:
    rows = document["coefficients"]
    return Facts(
        answer,
        verdict,
        **_errors(document["trial_results"]),
        names=[row["name"] for row in rows],
        values=[row["value"] for row in rows],
        before=[row["pre_determined"] for row in rows],
        errors=[row["stderr"] for row in rows],
        generated=_generated(document["trials"]["source"]),
    )


def _errors(results: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """How far off before and after, on the trials that were not tuned on, all where there are none."""
    rows = [row for row in results if row["role"] == "test"] or list(results)
    found: dict[str, Any] = {}
    for name, when in (("off", "before"), ("tuned", "after")):
        found[f"{name}_track"] = mean_off_track(rows, when)
        found[f"{name}_heading"] = mean_off_heading(rows, when)
    return found


def _generated(sources: Mapping[str, str]) -> bool:
    return any(source == "generated" for source in sources.values())


def _seconds_of_fit(task: Task) -> tuple[float, float]:
    from ..fitting import plan_fit
    from ..trial import load_trials

    return plan_fit(task.ship, load_trials(task.trials), task.options).seconds


def _sweep(task: Task, folder: Path) -> tuple[str, Facts]:
    from ..fitting import sweep
    from ..fitting.sweeping import folder_name
    from ..trial import load_trials

    result = sweep(task.ship, load_trials(task.trials), task.options, folder=folder, command=task.label)
    found, recommended = result.to_dict(), result.recommended()
    width = recommended["a_r"]
    best = None if width is None else folder / folder_name(width) / FIT
    if best is None or not best.is_file():
        return SWEEP, Facts("good", recommended["sentence"])
    document = json.loads(best.read_text(encoding="utf-8"))
    answer = "no" if found["overfitting"].get("found") else "good"
    return SWEEP, _of_fit(document, recommended["sentence"], answer)


def _seconds_of_sweep(task: Task) -> tuple[float, float]:
    from ..fitting import plan_sweep
    from ..trial import load_trials

    return plan_sweep(task.ship, load_trials(task.trials), task.options).seconds


def _trials_or_voyages(path: Path) -> Any:
    from ..trial import holds_voyages, load_trials, load_voyages

    return load_voyages(path) if holds_voyages(path) else load_trials(path)


def _diagnose(task: Task, folder: Path) -> tuple[str, Facts]:
    from ..diagnose import diagnose, write_diagnosis

    result = diagnose(task.ship, _trials_or_voyages(task.trials), task.options, folder=folder, command=task.label)
    document = write_diagnosis(result, folder, overwrite=True)
    errors = _errors(document["trial_results"])
    return DIAGNOSIS, Facts(
        "good" if result.verdict == "none" else "no",
        document["sentence"],
        **errors,
        causes=[one["effect"] for one in document["causes"]] if result.verdict in ("found", "not-separable") else [],
        sentences=[one["sentence"] for one in document["causes"]],
        generated=_generated(document["trials"]["source"]),
    )


def _seconds_of_diagnosis(task: Task) -> tuple[float, float]:
    from ..diagnose import plan_diagnosis

    return plan_diagnosis(task.ship, _trials_or_voyages(task.trials), task.options).seconds


def _validate(task: Task, folder: Path) -> tuple[str, Facts]:
    from ..recording import write_validation
    from ..trial import holds_voyages, load_trials, load_voyages
    from ..validating import validate

    if holds_voyages(task.trials):
        from ..options import VoyageOptions
        from ..voyages import validate_voyages, write_voyages

        options = VoyageOptions(**task.options.shared_with(ValidateOptions))
        result = validate_voyages([task.ship], load_voyages(task.trials), options, folder=folder, command=task.label)
        written = write_voyages(result, folder, overwrite=True)
        return VOYAGES, Facts("good", written["verdict"])
    data = load_trials(task.trials)
    document = write_validation(validate([task.ship], data, task.options), folder, task.label, overwrite=True)
    (scored,) = document["profiles"]
    errors = [rms_errors(document, row) for row in scored["trials"]]
    track, heading = ([one[k] for one in errors if one[k] is not None] for k in (0, 1))
    lost = sum(one[0] is None for one in errors)
    words = f"J {scored['J']:.4g} over {counted(len(errors), 'trial')}" if scored["J"] is not None else "no finite J"
    return VALIDATION, Facts(
        "no" if lost else "good",
        f"{words}; {lost} diverged" if lost else words,
        off_track=mean(track),
        off_heading=mean(heading),
        generated=_generated(document["sources"]),
    )


def _check(task: Task, folder: Path) -> tuple[str, Facts]:
    from .. import checking
    from ..trial import load_trials

    assert task.baseline is not None  # the table asks for one
    recorded = checking.read_baseline(task.baseline)
    how = {"metrics": task.options.metrics, "backend": task.options.backend}
    names = (task.ship.id, task.trials.name, task.baseline.name)
    integrator = task.options.asked_integrator(recorded.method)
    data = load_trials(task.trials)
    report = checking.check(task.ship, data, recorded, names=names, integrator=integrator, **how)
    checking.write_check(report, folder, task.label, overwrite=True)
    if report.verdict == "not comparable":
        lost = [item.reason for item in report.items if item.status == "not comparable" and item.reason]
        why = "; ".join(dict.fromkeys(lost))
        raise OptionError(Problem("the check could not compare", str(task.baseline), why, "write the baseline anew"))
    answer = "good" if report.verdict == "pass" else "no"
    sources = {name: trial.source for name, trial in data.trials.items()}
    return CHECKED, Facts(answer, report.sentence(), generated=_generated(sources))


COMMANDS: Mapping[str, Command] = {
    "fit": Command(FitOptions, _fit, _seconds_of_fit),
    "sweep": Command(SweepOptions, _sweep, _seconds_of_sweep),
    "diagnose": Command(DiagnoseOptions, _diagnose, _seconds_of_diagnosis),
    "validate": Command(ValidateOptions, _validate, lambda task: None),
    "check": Command(CheckOptions, _check, lambda task: None),
}
"""By the name that a table gives; the last two are quick, and timed by doing one."""
