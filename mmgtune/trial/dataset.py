"""Data sets: a folder of trial files and which of them tune and which test."""

from __future__ import annotations

import tomllib
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import Problem, TrialError, closest
from ..resources import folder, trial_set_names
from .model import Trial
from .parquet import read_trial

SPLIT = "split.toml"


@dataclass(frozen=True, eq=False)
class TrialSet:
    """Trials by id, in the order of their file names; ``tune`` and ``test`` are ids, the rest is in neither."""

    trials: dict[str, Trial]
    tune: tuple[str, ...]
    test: tuple[str, ...]
    ship: str = ""
    path: Path | None = None

    def hashes(self) -> dict[str, str]:
        """SHA-256 of each trial's file."""
        return {name: trial.sha256 for name, trial in self.trials.items()}


def load_trials(name: str | Path) -> TrialSet:
    """A folder of trial files, one file, or a bundled data set by name.

    Without ``split.toml`` every trial tunes.  Raises TrialError with everything wrong in any of the files.
    """
    path = Path(name)
    if not path.exists():
        bundled = folder("trials") / str(name)
        if path.name != str(name) or not bundled.is_dir():
            raise TrialError(
                Problem(
                    "no such trials",
                    str(name),
                    fix=f"give a folder or a Parquet file, or a bundled name: {', '.join(trial_set_names())}",
                )
            )
        path = bundled
    files = [path] if path.is_file() else sorted(path.glob("*.parquet"))
    if not files:
        raise TrialError(Problem("the folder has no trial files", str(path), fix="put *.parquet files there"))
    trials: dict[str, Trial] = {}
    problems: list[Problem] = []
    for file in files:
        try:
            trial = read_trial(file)
        except TrialError as error:
            problems += error.problems
            continue
        if trial.id in trials:
            problems.append(
                Problem(
                    f"two files are of trial '{trial.id}'",
                    f"{trials[trial.id].path} and {file}",
                    fix="give each its own id, or remove one",
                )
            )
        trials[trial.id] = trial
    split = path / SPLIT
    tune: tuple[str, ...] = tuple(trials)
    test: tuple[str, ...] = ()
    ship = ""
    if path.is_dir() and split.is_file():
        tune, test, ship, wrong = _split(split, trials, complete=not problems)
        problems += wrong
    if problems:
        raise TrialError(*problems)
    ships = Counter(trial.ship for trial in trials.values() if trial.ship)
    return TrialSet(trials, tune, test, ship or (ships.most_common(1)[0][0] if ships else ""), path)


def _split(
    path: Path, trials: dict[str, Trial], complete: bool
) -> tuple[tuple[str, ...], tuple[str, ...], str, list[Problem]]:
    """Tune and test ids, ship, problems; ids are only looked up where all files could be read."""
    try:
        data: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        return (), (), "", [Problem("the split cannot be read", str(path), str(error), "correct the line named")]
    problems = [
        Problem(f"unknown key '{key}'", str(path), fix=closest(key, ("ship", "tune", "test")))
        for key in data
        if key not in ("ship", "tune", "test")
    ]
    sets: dict[str, tuple[str, ...]] = {}
    for key in ("tune", "test"):
        ids = data.get(key, [])
        if not (isinstance(ids, list) and all(isinstance(one, str) for one in ids)):
            problems.append(Problem(f"'{key}' is not a list of trial ids", str(path), fix=f'write {key} = ["id", ...]'))
            ids = []
        sets[key] = tuple(ids)
        for name, count in Counter(ids).items():
            if count > 1:
                problems.append(
                    Problem(f"trial '{name}' is named {count} times in '{key}'", str(path), fix="name it once")
                )
            if complete and name not in trials:
                problems.append(
                    Problem(
                        f"'{key}' names trial '{name}', which is not in the folder",
                        str(path),
                        fix=closest(name, list(trials)),
                    )
                )
    for name in sorted(set(sets["tune"]) & set(sets["test"])):
        problems.append(
            Problem(
                f"trial '{name}' is in both sets", str(path), "a trial that tunes cannot test", "name it in one of them"
            )
        )
    if not sets["tune"]:
        problems.append(Problem("no trial tunes", str(path), "'tune' is empty or missing", 'write tune = ["id", ...]'))
    ship = data.get("ship", "")
    for trial in trials.values():
        if ship and trial.ship and trial.ship != ship:
            problems.append(Problem(f"trial '{trial.id}' is of ship '{trial.ship}', the split of '{ship}'", str(path)))
    return sets["tune"], sets["test"], str(ship), problems
