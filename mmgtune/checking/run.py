"""A profile checked against trials: better, as good as, or worse than its baseline and its limits."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from types import NoneType

from ..arguments import ShipGiven, TrialsGiven, trials_of
from ..backends import Integrator
from ..errors import OptionError, Problem, all_of, among, brief, kind_of, must_be_a
from ..metrics import METRICS
from ..motions import orders_of
from ..predictor import PhysicsPredictor, Predictor
from ..profile.doubts import in_words
from ..trial import TrialSet, another_ship
from .baseline import Baseline, Recorded, read_baseline, write_baseline
from .blame import changed_coefficients
from .measuring import Values, applicable, default_tolerances, measure, measure_stated
from .result import CheckReport, Item, Status
from .subject import Subject, subject_of

BaselineGiven = Baseline | str | Path | None


def record_baseline(
    profile: ShipGiven | Predictor,
    trials: TrialsGiven,
    metrics: Sequence[str] = (),
    *,
    before: Baseline | None = None,
    integrator: Integrator = Integrator(),
    backend: str = "compiled",
) -> Baseline:
    """The baseline of a profile on trials as they are now.

    profile, trials  objects, paths or bundled names
    metrics  of METRICS; where empty those of ``before``, or all that any trial shows
    before   the baseline this one takes the place of: its tolerances stay
    Raises OptionError for an unknown metric.
    """
    must_be_a(before, (Baseline, NoneType), "before")
    must_be_a(integrator, Integrator, "integrator")
    ship, trials = subject_of(profile, integrator, backend), trials_of(trials)
    names = _known(metrics) or (before.metrics if before else list(METRICS))
    found = _measured(ship, trials, names, backend)
    hashes = trials.hashes()
    shown = names if before and not metrics else applicable(found)
    tolerances = {name: dict(of) for name, of in default_tolerances(shown, ship.L_pp).items()}
    if before:
        for name, of in before.tolerances.items():
            trial, _, metric = name.rpartition("/")
            if metric in tolerances and (not trial or trial in found):
                tolerances[name] = dict(of)
    return Baseline(
        ship=ship.id,
        sha256=ship.sha256,
        coefficients=ship.numbers,
        integrator=integrator.name,
        substeps=integrator.substeps,
        backend=backend,
        made_by=made_by(),
        tolerances=tolerances,
        trials={name: Recorded(hashes[name], values) for name, values in found.items()},
    )


def check(
    profile: ShipGiven | Predictor,
    trials: TrialsGiven,
    baseline: BaselineGiven = None,
    *,
    names: tuple[str, str, str | None] | None = None,
    metrics: Sequence[str] = (),
    integrator: Integrator | None = None,
    backend: str = "compiled",
) -> CheckReport:
    """Compare a profile with its baseline, and with the limits it sets itself; or a trained model with its baseline.

    profile, trials, baseline  objects, paths or bundled names
    names       what the user called them, for messages
    metrics     of METRICS; where empty those of the baseline, or those with a limit
    integrator  the baseline's where None
    Raises OptionError where there is nothing to compare with, the baseline is of another ship or of another
    integrator, or a metric is unknown.
    """
    began = time.perf_counter()
    must_be_a(integrator, (Integrator, NoneType), "integrator")
    names = called(profile, trials, baseline) if names is None else _three(names)
    baseline = baseline_of(baseline)
    chosen = _integrator(baseline, integrator, names[2] or "baseline")
    ship, trials = subject_of(profile, chosen, backend), trials_of(trials)
    if baseline is None and not ship.limits:
        raise OptionError(
            Problem(
                "there is nothing to compare with",
                names[0] or ship.id,
                "neither a baseline nor limits were given",
                "name a baseline with baseline=FILE, or put [limits] into the profile",
            )
        )
    if baseline is not None and baseline.ship != ship.id:
        raise OptionError(
            Problem(
                f"the baseline is of ship '{baseline.ship}', the profile of '{ship.id}'",
                names[2] or "baseline",
                fix="name the baseline of this ship, or write one with update_baseline=True",
            )
        )
    wanted = _known(metrics) or (baseline.metrics if baseline else [])
    wanted = [name for name in METRICS if name in wanted or (name in ship.limits and not metrics)]
    found = _measured(ship, trials, wanted, backend)
    hashes = trials.hashes()
    items: list[Item] = []
    for name, values in found.items():
        items += compared(name, values, hashes[name], wanted, ship.limits, baseline)
    gone = [name for name in baseline.trials if name not in found] if baseline else []
    items += [
        Item(name, "", None, None, None, "not comparable", "the baseline has it, the trials do not") for name in gone
    ]
    same = [
        trial
        for name, trial in trials.trials.items()
        if baseline and name in baseline.trials and baseline.trials[name].sha256 == trial.sha256
    ]
    return CheckReport(
        profile=names[0] or ship.id,
        trials=names[1] or str(trials.path or "trials"),
        baseline=names[2],
        profile_file=ship.path,
        sha256=ship.sha256,
        items=tuple(items),
        changed=changed_coefficients(ship.model, same, baseline, chosen, backend) if baseline and ship.model else (),
        notes=(*another_ship(trials.ship, ship.id), *_notes(baseline, backend), *in_words(ship.doubts)),
        problems=(),
        made_by=made_by(),
        integrator=chosen.name,
        substeps=chosen.substeps,
        backend=backend,
        wall_s=time.perf_counter() - began,
        doubts=ship.doubts,
        orders=orders_of(list(trials.trials.values()), ship.L_pp),
    )


def update_baseline(
    profile: ShipGiven | Predictor,
    trials: TrialsGiven,
    path: str | Path,
    *,
    names: tuple[str, str, str | None] | None = None,
    metrics: Sequence[str] = (),
    integrator: Integrator | None = None,
    backend: str = "compiled",
) -> CheckReport | None:
    """Write the baseline anew; tolerances in one that is there stay.

    names       what the user called profile, trials and baseline, for messages
    integrator  that of the baseline there, or the default, where None
    Returns the comparison with the one before; None where there was none, or none of that integrator.
    Raises OptionError for a file that is there and no baseline, or an unknown metric.
    """
    names = names or called(profile, trials, path)
    trials = trials_of(trials)
    file = Path(path)
    before = read_baseline(file) if file.exists() else None
    recorded = before.method if before else None
    report = None
    if before is not None and integrator in (None, recorded):
        integrator = recorded
        report = check(profile, trials, before, names=names, integrator=integrator, backend=backend)
    chosen = integrator or Integrator()
    now = record_baseline(profile, trials, metrics, before=before, integrator=chosen, backend=backend)
    write_baseline(now, file, overwrite=True)
    return report


def _measured(ship: Subject, trials: TrialSet, names: Sequence[str], backend: str) -> dict[str, Values]:
    """Metrics by trial, of time series and of stated indices.

    Raises OptionError for stated indices of a trained model: it has no approach and no steering gear.
    """
    (found,) = measure(ship.predictor, list(trials.trials.values()), names)
    stated = list(trials.stated.values())
    physics = ship.predictor if isinstance(ship.predictor, PhysicsPredictor) else None
    if stated and physics is None:
        what = f"{len(stated)} trials state indices alone, and '{ship.predictor.name}' is no profile"
        why = "a trained model knows neither approach nor steering gear"
        raise OptionError(Problem(what, stated[0].id, why, "give trials that are time series"))
    return found | (measure_stated(physics, stated, names, backend) if physics else {})


def called(profile: object, trials: object, baseline: object) -> tuple[str, str, str | None]:
    """What the user called profile, trials and baseline, where these are names or paths."""
    first, second, third = (str(one) if isinstance(one, (str, Path)) else "" for one in (profile, trials, baseline))
    return first, second, third or None


def baseline_of(given: BaselineGiven) -> Baseline | None:
    """A baseline, or the one in that file.  Raises OptionError with everything wrong in it, and for what is none."""
    if given is None or isinstance(given, Baseline):
        return given
    if isinstance(given, (str, Path)):
        return read_baseline(Path(given))
    fix = "give the path of one, read_baseline(FILE), or record_baseline(SHIP, TRIALS)"
    raise OptionError(Problem(f"{kind_of(given)} is no baseline", brief(given), "a baseline is compared with", fix))


def could_not_run(names: tuple[str, str, str | None], problems: tuple[Problem, ...]) -> CheckReport:
    """The report of a check that never came to compare anything."""
    return CheckReport(
        names[0], names[1], names[2], "", "", (), (), (), problems, made_by(), "", 0, "", 0.0
    )  # fmt: skip


def made_by() -> str:
    """Program and version."""
    return f"mmgtune {version('mmgtune')}"


def _three(names: tuple[str, str, str | None]) -> tuple[str, str, str | None]:
    """What the user called profile, trials and baseline.  Raises OptionError for anything else."""
    if isinstance(names, tuple) and len(names) == 3 and all(isinstance(one, (str, NoneType)) for one in names):
        return names
    why = "messages call profile, trials and baseline by them"
    raise OptionError(Problem(f"names is {brief(names)}", "names", why, "give three, or leave them out"))


def _known(metrics: Sequence[str]) -> list[str]:
    metrics = all_of(metrics, str, "metrics")
    for name in metrics:
        if name not in METRICS:
            raise OptionError(Problem(f"unknown metric '{name}'", "metrics", **among(name, tuple(METRICS))))
    return [name for name in METRICS if name in metrics]


def _integrator(baseline: Baseline | None, asked: Integrator | None, where: str) -> Integrator:
    if baseline is None:
        return asked or Integrator()
    recorded = baseline.method
    if asked is not None and asked != recorded:
        raise OptionError(
            Problem(
                f"the baseline was made with {recorded.name}, {recorded.substeps} substeps, not {asked.name},"
                f" {asked.substeps}",
                where,
                "its numbers cannot be compared with those of another integration",
                "leave integrator and substeps out, or write the baseline anew with update_baseline=True",
            )
        )
    return recorded


def compared(
    trial: str,
    values: Values,
    sha256: str,
    wanted: Sequence[str],
    limits: dict[str, float],
    baseline: Baseline | None,
) -> list[Item]:
    """Items of one trial: one per metric, one in all where its file is not the baseline's."""
    recorded = baseline.trials.get(trial) if baseline else None
    reason = ""
    if baseline and recorded is None:
        reason = "the trials have it, the baseline does not"
    elif recorded and recorded.sha256 != sha256:
        reason = "its file changed since the baseline"
    items = [Item(trial, "", None, None, None, "not comparable", reason)] if reason else []
    for name in wanted:
        then = recorded.metrics.get(name) if recorded and not reason else None
        now = values.get(name)
        limit = limits.get(name)
        if now is None:
            if then is not None:
                why = "the trial does not show it any more"
                items.append(Item(trial, name, then, None, None, "not comparable", why))
            elif name.startswith("rms_"):
                channel = name.removeprefix("rms_")
                items.append(Item(trial, name, None, None, None, "not shown", f"the trial has no measured {channel}"))
            # That a turning circle has no overshoot goes without saying.
        elif then is not None or limit is not None:
            tolerance = baseline.tolerance(trial, name, then) if baseline and then is not None else 0.0
            items.append(_judged(trial, name, then, now, tolerance, limit))
        elif baseline and not reason and name in baseline.metrics:
            items.append(Item(trial, name, None, now, None, "not comparable", "the baseline has no value of it"))
    return items


def _judged(trial: str, name: str, then: float | None, now: float, tolerance: float, limit: float | None) -> Item:
    """A metric against its old value and its limit; either may be missing, not both."""
    if limit is not None and abs(now) > limit:
        return Item(trial, name, then, now, limit, "regressed", f"above the profile's limit of {limit:g}")
    if then is None:
        return Item(trial, name, None, now, limit, "ok")
    allowed = abs(then) + tolerance
    if math.isinf(then):
        return Item(trial, name, then, now, None, "ok" if math.isinf(now) else "improved")
    reason = "the simulation diverges or does not get there" if math.isinf(now) else ""
    status: Status = "ok"
    if abs(now) > allowed:
        status = "regressed"
    elif abs(now) < abs(then) - tolerance:
        status = "improved"
    return Item(trial, name, then, now, allowed, status, reason)


def _notes(baseline: Baseline | None, backend: str) -> tuple[str, ...]:
    if baseline is None:
        return ()
    notes = []
    if baseline.made_by != made_by():
        notes.append(f"the baseline was made by {baseline.made_by}, this is {made_by()}")
    if baseline.backend != backend:
        notes.append(f"the baseline was made with the {baseline.backend} back end; the two agree to rounding")
    return tuple(notes)
