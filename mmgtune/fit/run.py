"""A fit from beginning to end: search, polish, certificate, identifiability, comparison on every trial."""

from __future__ import annotations

import platform
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..backends import get_backend
from ..model import Model
from ..objective import cases_of, make_objective
from ..profile import ShipProfile
from ..trial import TrialSet
from .box import choose_targets, make_box
from .certificate import certify
from .checkpoint import EVERY, Checkpoint
from .cmaes import Search, search
from .comparison import compare
from .identifiability import analyse
from .least_squares import LeastSquaresResult, solve
from .options import FitOptions
from .problem import FitProblem
from .result import FitResult

FloatArray = npt.NDArray[np.float64]

RIDGE = 1e-8
"""Weight, as a share of J, of the distance to the pre-determined values: chooses among sets that fit equally well."""


@dataclass(frozen=True)
class Hooks:
    """What the caller wants to hear and to say while a fit runs.

    on_phase       called with a few words when a new part of the work begins
    on_generation  called after each generation of CMA-ES
    stop           asked often; True ends the fit with the best so far
    """

    on_phase: Callable[[str], None] = lambda _: None
    on_generation: Callable[[Search], None] = lambda _: None
    stop: Callable[[], bool] = lambda: False


def make_problem(profile: ShipProfile, trials: TrialSet, options: FitOptions, ids: tuple[str, ...] = ()) -> FitProblem:
    """The problem of fitting ``profile`` to the tune trials, or to the trials ``ids``.

    Raises OptionError for targets, box, channels or window that make no sense.
    """
    model = Model(profile)
    targets = choose_targets(model, options.targets, options.fixed)
    objective = make_objective(model.L_pp, options.channels, options.window)
    return FitProblem(
        model=model,
        cases=cases_of([trials.trials[name] for name in ids or trials.tune], objective),
        box=make_box(model, targets, options.a_r),
        backend=get_backend(options.backend),
        integrator=options.make_integrator(),
    )


def fit(
    profile: ShipProfile,
    trials: TrialSet,
    options: FitOptions = FitOptions(),
    *,
    hooks: Hooks = Hooks(),
    checkpoint_folder: Path | None = None,
    resume: bool = False,
    more_starts: tuple[Mapping[str, float], ...] = (),
    command: str = "",
) -> FitResult:
    """Fine-tune the targets of ``profile`` within their box to the tune trials, and look at the test trials.

    checkpoint_folder  where the search saves its state; None for nowhere
    resume             continue the search saved there
    more_starts        coefficient sets to start least squares from besides, such as the optimum of a smaller box
    command            what to call this fit in its provenance
    Raises OptionError for choices that make no sense, OutputError where the checkpoint cannot be written.
    """
    began = time.perf_counter()
    if options.identifiable:
        options = hold_directions(profile, trials, options)
    problem = make_problem(profile, trials, options)
    box = problem.box
    provenance = _provenance(profile, trials, command)
    identity = {
        "profile": profile.sha256,
        "trials": trials.hashes(),
        "tune": list(trials.tune),
        "options": {k: v for k, v in options.to_dict().items() if k not in ("starts",)},
        "versions": provenance["environment"],
    }
    before = box.to_unit(box.pre)
    rng = np.random.default_rng(options.seed)
    J_before = float(problem.costs(before[:, None])[0])
    found: Search | None = None
    starts = [np.clip(before, 0.0, 1.0)]
    if options.method == "cma-es":
        hooks.on_phase("CMA-ES")
        found = _search(problem, options, starts[0], hooks, checkpoint_folder, identity, resume)
        starts.append(found.unit)
    interrupted = hooks.stop()

    hooks.on_phase("least squares")
    starts += [
        np.clip(box.to_unit([values.get(n, box.pre[i]) for i, n in enumerate(box.names)]), 0.0, 1.0) for values in more_starts
    ]
    starts += [rng.uniform(size=len(box)) for _ in range(max(0, options.starts - len(starts)))]
    if interrupted:
        starts = starts[:2]
    ends = solve(problem, np.column_stack(starts), stop=lambda: interrupted or hooks.stop())
    interrupted = interrupted or hooks.stop()
    best = min(ends, key=lambda end: end.J)
    if not interrupted:
        best = _nearest(problem, best, before)
    unit, J = best.unit, best.J
    if found is not None and found.J < J:
        unit, J = found.unit, found.J

    hooks.on_phase("certificate and identifiability")
    restarts = found.restarts if found else []
    certificate = certify(problem, unit, J, J_before, ends, restarts, found.J if found else None)
    held_by_bound = np.isin(box.names, [bound.name for bound in certificate.active])
    identifiability = analyse(problem, unit, held_by_bound)

    objective = make_objective(problem.model.L_pp, options.channels, options.window)
    roles = {name: "tune" if name in trials.tune else "test" if name in trials.test else "other" for name in trials.trials}
    compared = compare(
        problem.model,
        list(trials.trials.values()),
        roles,
        objective,
        {"before": problem.model.matrix(), "after": problem.theta(unit[:, None])},
        problem.backend,
        problem.integrator,
    )
    return FitResult(
        profile=profile,
        options=options,
        box=box,
        unit=unit,
        J=J,
        J_before=J_before,
        compared=tuple(compared),
        restarts=tuple(restarts),
        starts=tuple(ends),
        history=tuple(found.history if found else ()),
        certificate=certificate,
        identifiability=identifiability,
        evaluations=problem.evaluations,
        diverged=found.diverged if found else 0,
        wall_s=time.perf_counter() - began,
        held=tuple(options.fixed),
        scales=objective.scales,
        channels=objective.channels,
        provenance=provenance,
        interrupted=interrupted,
    )


def hold_directions(profile: ShipProfile, trials: TrialSet, options: FitOptions) -> FitOptions:
    """The same options with one coefficient fixed for every direction no trial can tell, found before searching."""
    problem = make_problem(profile, trials, options)
    free = np.zeros(len(problem.box), dtype=bool)
    directions = analyse(problem, problem.box.to_unit(problem.box.pre), free).null_directions
    held = tuple(next(iter(direction.weights)) for direction in directions)
    return FitOptions(**{**options.__dict__, "fixed": (*options.fixed, *held), "identifiable": False})


def _search(
    problem: FitProblem,
    options: FitOptions,
    start: FloatArray,
    hooks: Hooks,
    folder: Path | None,
    identity: dict[str, Any],
    resume: bool,
) -> Search:
    """CMA-ES with checkpoints: every few generations, and when it ends for whatever reason."""
    checkpoint = Checkpoint(folder, identity) if folder else None
    recorded = checkpoint.load() if checkpoint and resume else None

    def on_generation(state: Search) -> None:
        if checkpoint and len(state.costs) % EVERY == 0:
            checkpoint.save(state.costs)
        hooks.on_generation(state)

    found = search(problem, options.seed, start, recorded=recorded, on_generation=on_generation, stop=hooks.stop)
    if checkpoint:
        if found.finished:
            checkpoint.remove()
        else:
            checkpoint.save(found.costs)
    return found


def _nearest(problem: FitProblem, best: LeastSquaresResult, before: FloatArray) -> LeastSquaresResult:
    """Of all sets that fit as well as ``best``, the one nearest to the pre-determined values."""
    moved = solve(problem, best.unit[:, None], ridge=RIDGE * best.J, anchor=before)[0]
    return moved if moved.J <= best.J * (1.0 + 1e-7) else best


def _provenance(profile: ShipProfile, trials: TrialSet, command: str) -> dict[str, Any]:
    versions = {"python": platform.python_version()}
    for package in ("numpy", "scipy", "numba", "cma"):
        try:
            versions[package] = version(package)
        except PackageNotFoundError:  # pragma: no cover - all are dependencies
            versions[package] = "unknown"
    return {
        "mmgtune": _own_version(),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": command,
        "profile": {
            "id": profile.id,
            "name": profile.name,
            "path": str(profile.path) if profile.path else "",
            "sha256": profile.sha256,
            "source": profile.source,
        },
        "trials": {
            "path": str(trials.path) if trials.path else "",
            "ship": trials.ship,
            "tune": list(trials.tune),
            "test": list(trials.test),
            "sha256": trials.hashes(),
            "source": {name: trial.source for name, trial in trials.trials.items()},
        },
        "environment": versions,
    }


def _own_version() -> str:
    try:
        return version("mmgtune")
    except PackageNotFoundError:
        return "unknown"
