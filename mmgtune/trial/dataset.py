"""Data sets: a folder of trial files and which of them tune and which test."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import Problem, TrialError, closest
from ..resources import folder, trial_set_names
from .model import Trial
from .parquet import id_in, read_trial
from .pieces import windows
from .split import SPLIT, Split, read_split
from .voyage import Voyage


@dataclass(frozen=True, eq=False)
class TrialSet:
    """Trials by id, in the order of their file names.

    tune, test  ids, in the order of the split; without a split all trials tune
    ship        id of the ship, "" where neither split nor files say
    licence     of the measurements and how to cite them, "" where the split does not say: profiles tuned to them
                carry both
    path        folder or file they come from
    """

    trials: dict[str, Trial]
    tune: tuple[str, ...]
    test: tuple[str, ...]
    ship: str = ""
    path: Path | None = None
    licence: str = ""
    citation: str = ""

    def __repr__(self) -> str:
        """In a line."""
        roles = f"{len(self.trials)} trials, {len(self.tune)} tune, {len(self.test)} test"
        return f"TrialSet({self.ship or 'ship not stated'}: {roles})"

    @property
    def others(self) -> tuple[str, ...]:
        """Ids of the trials that neither tune nor test."""
        return tuple(name for name in self.trials if name not in self.tune and name not in self.test)

    def role(self, name: str) -> str:
        """What the trial of that id is for: "tune", "test" or "other"."""
        return "tune" if name in self.tune else "test" if name in self.test else "other"

    def in_windows(self, length: float, every: float | None = None) -> TrialSet:
        """The same set with every trial cut into windows of ``length`` [s]; each has the role of its trial.

        every  time between samples that count [s], None for all: each window has one at least, if its trial has
        """
        pieces = {name: windows(trial, length, every) for name, trial in self.trials.items()}

        def ids(names: tuple[str, ...]) -> tuple[str, ...]:
            return tuple(piece.id for name in names for piece in pieces[name])

        cut = {piece.id: piece for of_one in pieces.values() for piece in of_one}
        return replace(self, trials=cut, tune=ids(self.tune), test=ids(self.test))

    def hashes(self) -> dict[str, str]:
        """SHA-256 of each trial's file, by id."""
        return {name: trial.sha256 for name, trial in self.trials.items()}


def load_trials(name: str | Path) -> TrialSet:
    """A folder of trial files, one file, or a bundled data set by name.

    Without ``split.toml`` every trial tunes.  Raises TrialError with everything wrong in any of the files.
    """
    path = find_trials(name)
    files = files_of(path)
    trials: dict[str, Trial] = {}
    problems: list[Problem] = []
    ids: list[str | None] = []
    for file in files:
        try:
            trial = read_trial(file)
        except TrialError as error:
            problems += error.problems
            ids.append(id_in(file))
            continue
        ids.append(trial.id)
        if trial.id in trials:
            what = f"two files are of trial '{trial.id}'"
            why = "trials are told apart by their ids"
            where = f"{trials[trial.id].path} and {file}"
            problems.append(Problem(what, where, why, "give each its own id, or remove one"))
        trials.setdefault(trial.id, trial)
    said = Split(tune=tuple(trials))
    split = path / SPLIT
    if path.is_dir() and split.is_file():
        said, wrong = read_split(split, None if None in ids else [one for one in ids if one is not None])
        problems += wrong
    problems += of_another_ship(list(trials.values()), said.ship, split)
    if problems:
        raise TrialError(*problems)
    ships = [trial.ship for trial in trials.values() if trial.ship]
    ship = said.ship or (ships[0] if ships else "")
    return TrialSet(trials, said.tune, said.test, ship, path, said.licence, said.citation)


def files_of(path: Path) -> list[Path]:
    """The trial files of a folder, by name, or the file itself.  Raises TrialError where a folder has none."""
    files = [path]
    if path.is_dir():
        files = sorted(file for file in path.glob("*.parquet") if not file.name.startswith("."))
    if not files:
        fix = "put *.parquet files there, one a trial"
        raise TrialError(Problem("the folder has no trial files", str(path), fix=fix))
    return files


def find_trials(name: str | Path) -> Path:
    """The folder or file of a data set given by path or bundled name; TrialError if there is none."""
    path = Path(name)
    if path.exists():
        return path
    bundled = folder("trials") / str(name)
    if path.name == str(name) and bundled.is_dir():
        return bundled
    names = trial_set_names()
    fix = f"give a folder or a Parquet file, or a bundled name; {closest(str(name), names) if names else 'none here'}"
    raise TrialError(Problem("no such trials", str(name), fix=fix))


def of_another_ship(trials: Sequence[Trial | Voyage], ship: str, split: Path) -> list[Problem]:
    """Trials of another ship than the split's, or of several ships where it names none."""
    ships = Counter(trial.ship for trial in trials if trial.ship)
    if not ships:
        return []
    asked = ship or ships.most_common(1)[0][0]
    says = f"{split} says" if ship else f"{ships[asked]} of {len(trials)} trials say"
    return [
        Problem(
            f"trial '{trial.id}' is of ship '{trial.ship}', not '{asked}'",
            str(trial.path),
            f"{says} '{asked}', and a data set is of one ship",
            "move it to a folder of its own, or correct 'ship' where it is wrong",
        )
        for trial in trials
        if trial.ship and trial.ship != asked
    ]
