"""The committed file a model is compared with: what its metrics were, of which trials, and how they were found."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from .. import limits
from ..backends import Integrator
from ..documents import finite_values, parsed, write_json
from ..errors import OptionError, Problem, among, must_be_a, reason
from ..files import path_of
from ..metrics import METRICS
from ..options import SimulationOptions
from ..resources import looked_for, must_be_name
from .measuring import Values

SCHEMA = 1
KIND = "check-baseline"


@dataclass(frozen=True)
class Recorded:
    """A trial as it was: SHA-256 of its file, and its metrics."""

    sha256: str
    metrics: Values


@dataclass(frozen=True)
class Baseline:
    """What a model did on trials when it was last found good.

    ship          id of the profile
    sha256        of the profile's file
    coefficients  every number of the profile by name, to say which of them changed
    integrator, substeps, backend  as simulated; a comparison uses the same integrator
    made_by       program and version
    tolerances    for each metric, "relative" and "absolute" change for the worse that passes; a key "trial/metric"
                  is for one trial
    trials        by id
    """

    ship: str
    sha256: str
    coefficients: Mapping[str, float]
    integrator: str
    substeps: int
    backend: str
    made_by: str
    tolerances: Mapping[str, Mapping[str, float]]
    trials: Mapping[str, Recorded]

    def __repr__(self) -> str:
        """In a line."""
        return f"Baseline({self.ship}, {len(self.trials)} trials, {len(self.tolerances)} metrics, {self.method})"

    @property
    def method(self) -> Integrator:
        """The integrator it was made with."""
        return Integrator(self.integrator, self.substeps)

    @property
    def metrics(self) -> list[str]:
        """Names of the metrics compared, in the order of METRICS."""
        return [name for name in METRICS if name in self.tolerances]

    def tolerance(self, trial: str, metric: str, value: float) -> float:
        """Change for the worse of a metric of that value that passes, in the metric's unit."""
        of = self.tolerances.get(f"{trial}/{metric}") or self.tolerances[metric]
        return of.get("relative", 0.0) * abs(value) + of.get("absolute", 0.0)

    def to_dict(self) -> dict[str, Any]:
        """For JSON; a metric of a simulation that diverged is null, and so is a coefficient at infinity."""
        return {
            "schema": SCHEMA,
            "kind": KIND,
            "made_by": self.made_by,
            "profile": {"id": self.ship, "sha256": self.sha256, "coefficients": finite_values(self.coefficients)},
            "integrator": self.integrator,
            "substeps": self.substeps,
            "backend": self.backend,
            "tolerances": {name: dict(of) for name, of in self.tolerances.items()},
            "trials": {
                name: {"sha256": trial.sha256, "metrics": finite_values(trial.metrics)}
                for name, trial in self.trials.items()
            },
        }


def write_baseline(baseline: Baseline, path: Path | str, *, overwrite: bool = False) -> None:
    """Write the file.  Raises OutputError where one is there and ``overwrite`` is false, or the system refuses."""
    path = path_of(path)
    must_be_a(baseline, Baseline, "baseline")
    write_json(baseline.to_dict(), path, overwrite)


def read_baseline(path: Path | str) -> Baseline:
    """The baseline in a file.  Raises OptionError with everything that is wrong in it."""
    must_be_name(path, "baseline", OptionError)
    path = Path(path)
    again = "write it anew with update_baseline=True, or take it from the repository"
    try:
        data = parsed(limits.text(path, limits.RECORD_BYTES, OptionError))
    except FileNotFoundError:
        fix = "write one with update_baseline=True, and commit it"
        raise OptionError(Problem("there is no baseline", str(path), looked_for(path), fix)) from None
    except (OSError, ValueError, RecursionError) as error:
        raise OptionError(Problem("the baseline cannot be read", str(path), reason(error), again)) from None
    if not isinstance(data, dict) or data.get("kind") != KIND:
        raise OptionError(Problem("this is not a baseline of a check", str(path), f"it has no kind '{KIND}'", again))
    if data.get("schema") != SCHEMA:
        what = f"the baseline's schema is {data.get('schema')!r}, not {SCHEMA}"
        raise OptionError(Problem(what, str(path), fix="update mmgtune, or write the baseline anew"))
    try:
        baseline = _parsed(data)
    except (ArithmeticError, KeyError, TypeError, ValueError, AttributeError) as error:
        raise OptionError(Problem("the baseline is not complete", str(path), reason(error), again)) from None
    problems = _wrong(baseline, str(path))
    if problems:
        raise OptionError(*problems)
    return baseline


def _parsed(data: dict[str, Any]) -> Baseline:
    profile = data["profile"]
    return Baseline(
        ship=str(profile["id"]),
        sha256=str(profile["sha256"]),
        coefficients=_with_infinity(profile["coefficients"]),
        integrator=str(data["integrator"]),
        substeps=int(data["substeps"]),
        backend=str(data["backend"]),
        made_by=str(data["made_by"]),
        tolerances={name: {key: float(value) for key, value in of.items()} for name, of in data["tolerances"].items()},
        trials={
            name: Recorded(str(of["sha256"]), _with_infinity(of["metrics"])) for name, of in data["trials"].items()
        },
    )


def _with_infinity(values: Mapping[str, float | None]) -> dict[str, float]:
    return {name: math.inf if value is None else float(value) for name, value in values.items()}


def _wrong(baseline: Baseline, where: str) -> list[Problem]:
    problems = []
    for name, of in baseline.tolerances.items():
        trial, _, metric = name.rpartition("/")
        if metric not in METRICS:
            problems.append(Problem(f"unknown metric '{metric}'", where, **among(metric, tuple(METRICS))))
        elif trial and (trial not in baseline.trials or metric not in baseline.tolerances):
            problems.append(Problem(f"tolerance '{name}' is for nothing that is compared", where))
        for key, value in of.items():
            if key not in ("relative", "absolute") or not (math.isfinite(value) and value >= 0.0):
                fix = 'write {"relative": 0.01, "absolute": 0.001}'
                problems.append(Problem(f"tolerance '{name}' has {key} = {value}", where, fix=fix))
    for trial, recorded in baseline.trials.items():
        for metric in recorded.metrics:
            if metric not in baseline.tolerances:
                what = f"metric '{metric}' of trial '{trial}' has no tolerance"
                problems.append(Problem(what, where, fix=f'add "{metric}" to "tolerances", or write the baseline anew'))
    try:
        SimulationOptions(integrator=baseline.integrator, substeps=baseline.substeps, backend=baseline.backend)
    except OptionError as error:
        problems += [replace(problem, where=where) for problem in error.problems]
    if not baseline.trials:
        problems.append(Problem("the baseline names no trial", where))
    return problems
