"""Data sets: a folder of trial files and which of them tune and which test."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from numbers import Integral
from pathlib import Path
from typing import Any, Self

from ..displayed import Plotted, inert
from ..errors import Problem, TrialError, all_of, among, brief, closest, kind_of
from ..phrases import counted
from ..resources import folder, looked_for, must_be_name, profile_names, taken, trial_set_names
from .by_hand import Given, roles_of, ship_of_all, trials_by_id
from .index_trial import IndexTrial, has_index_trials, read_index_trials
from .model import Trial
from .parquet import id_in, read_trial
from .pieces import divided, windows
from .raw_logs import LogInstead, instead, logs_instead
from .split import SPLIT, Split, read_split
from .voyages.voyage import Voyage


@dataclass(frozen=True, eq=False, init=False)
class TrialSet(Plotted):
    """Trials by id, in the order of their file names.  One may be made by hand: ``TrialSet([a, b], ["a"], ["b"])``.

    trials      by id; a list of them will do, in which those of stated indices may stand too
    tune, test  ids of ``trials``, in the order of the split; without a split all trials tune, and of a set made by hand
                all that do not test where ``tune`` is left out
    stated      trials of which only indices are known, by id; tune_stated, test_stated their ids likewise; those that
                are named in tune and test are put there
    ship        id of the ship, "" where neither split nor files say; where it is not given the one that trials name
    licence     of the measurements and how to cite them, "" where the split does not say: profiles tuned to them
                carry both
    path        folder or file they come from

    Raises OptionError for what is no trial or no list of ids.  Raises TrialError for two trials of one id, one under
    the id of another, ids of no trial, ids that are named twice, ids that both tune and test, and trials of several
    ships where ``ship`` does not say of which all are.
    """

    trials: dict[str, Trial]
    tune: tuple[str, ...]
    test: tuple[str, ...]
    ship: str
    path: Path | None
    licence: str
    citation: str
    stated: dict[str, IndexTrial]
    tune_stated: tuple[str, ...]
    test_stated: tuple[str, ...]

    def __init__(
        self,
        trials: Given,
        tune: Iterable[str] | None = None,
        test: Iterable[str] = (),
        ship: str = "",
        path: Path | None = None,
        licence: str = "",
        citation: str = "",
        stated: Given = (),
        tune_stated: Iterable[str] = (),
        test_stated: Iterable[str] = (),
    ) -> None:
        series, indices = trials_by_id(trials, stated)
        test, test_stated = all_of(test, str, "test"), all_of(test_stated, str, "test_stated")
        if tune is None:
            tune_stated = all_of(tune_stated, str, "tune_stated")
            elsewhere = {*test, *test_stated, *tune_stated}
            tune = [name for name in (*series, *indices) if name not in elsewhere]
        ids = {"tune": tune, "test": test, "tune_stated": tune_stated, "test_stated": test_stated}
        roles = roles_of(ids, [*series, *indices])
        ship = ship or ship_of_all([*series.values(), *indices.values()])
        found: dict[str, Any] = {"trials": series, "stated": indices, "ship": ship}
        found |= {"path": path, "licence": licence, "citation": citation}
        for role, named in roles.items():
            found[role] = tuple(name for name in named if name in series)
            found[f"{role}_stated"] = tuple(name for name in named if name in indices)
        for name, value in found.items():
            object.__setattr__(self, name, value)  # it is frozen

    def __repr__(self) -> str:
        """In a line."""
        tune, test = len(self.tune) + len(self.tune_stated), len(self.test) + len(self.test_stated)
        roles = f"{counted(len(self.trials) + len(self.stated), 'trial')}, {tune} tune, {test} test"
        return f"TrialSet({inert(self.ship) or 'ship not stated'}: {roles})"

    def __len__(self) -> int:
        return len(self.trials) + len(self.stated)

    def __iter__(self) -> Iterator[Trial | IndexTrial]:
        """The trials: time series, then those of which indices are stated."""
        return iter((*self.trials.values(), *self.stated.values()))

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and (name in self.trials or name in self.stated)

    def __getitem__(self, name: str) -> Trial | IndexTrial:
        """The trial of that id.  Raises TrialError where there is none."""
        found = (self.trials.get(name) or self.stated.get(name)) if isinstance(name, str) else None
        if found is None:
            known = [*self.trials, *self.stated]
            said = among(name, known)
            if not isinstance(name, str):
                such = f"['{known[0]}']" if known else "[ID]"
                why = f"a trial is had by its id, and {kind_of(name)} is none"
                listed = f", or list(TRIALS)[{brief(name)}]" if isinstance(name, Integral) else ""
                said = {"why": why, "fix": f"write {such} for the trial of that id{listed}"}
            raise TrialError(Problem(f"no trial {brief(name)}", str(self.path or ""), **said))
        return found

    @property
    def others(self) -> tuple[str, ...]:
        """Ids of the trials that neither tune nor test."""
        return tuple(name for name in (*self.trials, *self.stated) if self.role(name) == "other")

    def role(self, name: str) -> str:
        """What the trial of that id is for: "tune", "test" or "other"."""
        if name in self.tune or name in self.tune_stated:
            return "tune"
        return "test" if name in self.test or name in self.test_stated else "other"

    def series_only(self, what: str) -> Self:
        """The set, all of it time series.  Raises TrialError where there are others: ``what`` has no use for them."""
        if not self.stated:
            return self
        raise TrialError(
            Problem(
                f"{what} needs time series",
                str(self.path or ""),
                f"of these trials only indices are known: {', '.join(self.stated)}",
                "take the files of stated indices out of the folder, or give one without them",
            )
        )

    def in_windows(self, length: float, every: float | None = None) -> TrialSet:
        """The set with every trial cut into windows of ``length`` [s]; each has the role of its trial.

        every  time between samples that count [s], None for all: each window has one at least, if its trial has
        """
        return self._in_pieces({name: windows(trial, length, every) for name, trial in self.trials.items()})

    def divided(self, rows: Mapping[str, Sequence[int]]) -> TrialSet:
        """The same set with some trials divided at rows, by id; each piece has the role of its trial."""
        return self._in_pieces(
            {name: divided(trial, rows[name]) if name in rows else [trial] for name, trial in self.trials.items()}
        )

    def _in_pieces(self, pieces: Mapping[str, Sequence[Trial]]) -> TrialSet:
        """The same set with pieces in the place of each trial, each in the role of its trial."""

        def ids(names: tuple[str, ...]) -> tuple[str, ...]:
            return tuple(piece.id for name in names for piece in pieces[name])

        cut = {piece.id: piece for of_one in pieces.values() for piece in of_one}
        return replace(self, trials=cut, tune=ids(self.tune), test=ids(self.test))

    def hashes(self) -> dict[str, str]:
        """SHA-256 of each trial's file, by id."""
        series = {name: trial.sha256 for name, trial in self.trials.items()}
        return series | {name: trial.sha256 for name, trial in self.stated.items()}


def load_trials(name: str | Path) -> TrialSet:
    """A folder of trial files and files of stated indices, one file, or a bundled data set by name.

    Without ``split.toml`` every trial tunes.  Raises TrialError with everything wrong in any of the files.
    """
    path = find_trials(name)
    if path.is_file() and (log := logs_instead(path)):
        raise TrialError(log)
    files = files_of(path)
    stated, wrong_there = _stated(path)
    if not files and not stated and not wrong_there:
        if logs := logs_instead(path):
            raise TrialError(logs)
        fix = "put *.parquet files there, one a trial, or a *.toml file of stated indices"
        raise TrialError(
            Problem("the folder has no trial files", str(path), "it has neither *.parquet nor stated indices", fix)
        )
    trials: dict[str, Trial] = {}
    problems = list(wrong_there)
    ids: list[str | None] = []
    logs_only = []
    for file in files:
        try:
            trial = read_trial(file)
        except TrialError as error:
            logs_only += [file] if isinstance(error, LogInstead) else []
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
    if len(logs_only) == len(files) > 1:
        raise TrialError(instead(path, logs_only))
    known: dict[str, IndexTrial] = {}
    for one in stated:
        ids.append(one.id)
        if one.id in trials or one.id in known:
            why = "trials are told apart by their ids"
            problems.append(Problem(f"two trials are called '{one.id}'", str(one.path), why, "give each its own id"))
        known.setdefault(one.id, one)
    if wrong_there:
        ids.append(None)
    said = Split(tune=(*trials, *known))
    split = path / SPLIT
    if path.is_dir() and split.is_file():
        said, wrong = read_split(split, None if None in ids else [one for one in ids if one is not None])
        problems += wrong
    problems += of_another_ship([*trials.values(), *known.values()], said.ship, split)
    if problems:
        raise TrialError(*problems)
    return TrialSet(trials, said.tune, said.test, said.ship, path, said.licence, said.citation, known)


def _stated(path: Path) -> tuple[list[IndexTrial], list[Problem]]:
    """Trials of which only indices are known, in a folder or a file, and everything wrong with them."""
    if path.is_dir():
        files = sorted(one for one in path.glob("*.toml") if one.name != SPLIT and not one.name.startswith("."))
    else:
        files = [path] if path.suffix == ".toml" else []
    found: list[IndexTrial] = []
    problems: list[Problem] = []
    for file in files:
        try:
            if path.is_dir() and not has_index_trials(file):
                continue  # a profile or a map that lies there
        except TrialError as error:
            problems += error.problems
            continue
        trials, wrong = read_index_trials(file)
        found += trials
        problems += wrong
    return found, problems


def files_of(path: Path) -> list[Path]:
    """The Parquet files of a folder, by name, or the file itself unless it is a TOML file."""
    if path.is_dir():
        return sorted(file for file in path.glob("*.parquet") if not file.name.startswith("."))
    return [] if path.suffix == ".toml" else [path]


def find_trials(name: str | Path) -> Path:
    """The folder or file of a data set given by path or bundled name; TrialError if there is none."""
    must_be_name(name, "data set", TrialError)
    if found := taken(name, Path(name).exists(), folder("trials") / str(name)):
        return found
    names = trial_set_names()
    fix = f"give a folder or a Parquet file, or a bundled name; {closest(str(name), names) if names else 'none here'}"
    why = looked_for(name, "data set")
    if str(name) in profile_names():
        why = "that is a ship profile; trials are given last"
    raise TrialError(Problem("no such trials", str(name), why, fix))


def of_another_ship(trials: Sequence[Trial | Voyage | IndexTrial], ship: str, split: Path) -> list[Problem]:
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
