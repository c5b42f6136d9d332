"""Folders of voyages: which files there are, told by what they say of themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ...errors import Problem, TrialError
from ..dataset import files_of, find_trials, of_another_ship
from ..raw_logs import LogInstead, instead, logs_instead
from ..split import SPLIT, Split, read_split
from .voyage import Voyage, open_voyage


@dataclass(frozen=True, eq=False)
class VoyageSet:
    """Voyages, in the order of their file names.

    ship     id of the ship, "" where no file says
    licence  of the measurements and how to cite them, from ``split.toml``
    path     folder or file they come from
    """

    voyages: tuple[Voyage, ...]
    ship: str
    path: Path
    licence: str = ""
    citation: str = ""

    def __repr__(self) -> str:
        """In a line."""
        hours = sum(one.duration for one in self.voyages) / 3600.0
        return f"VoyageSet({self.ship or 'ship not stated'}: {len(self.voyages)} voyages, {hours:.1f} h)"

    @property
    def n_rows(self) -> int:
        """Rows of all files."""
        return sum(one.n_rows for one in self.voyages)

    @property
    def shorter(self) -> tuple[str, ...]:
        """Ids of the files that are no voyages by themselves, and are cut as the others are."""
        return tuple(one.id for one in self.voyages if not one.is_voyage)


def holds_voyages(name: str | Path) -> bool:
    """Whether one file at least of a folder, or a file, is a voyage.

    Files that cannot be opened are none: reading them as trials says what is wrong.
    Raises TrialError where there is no such folder or file.
    """
    path = find_trials(name)
    for file in files_of(path):
        try:
            if open_voyage(file).is_voyage:
                return True
        except TrialError:
            continue
    return False


def load_voyages(name: str | Path) -> VoyageSet:
    """A folder of voyages, or one, by path or bundled name; shorter trials among them count as voyages.

    Raises TrialError with everything that is wrong with what the files say of themselves.
    """
    path = find_trials(name)
    voyages: list[Voyage] = []
    problems: list[Problem] = []
    files = files_of(path)
    logs_only = []
    for file in files:
        try:
            found = open_voyage(file)
        except TrialError as error:
            logs_only += [file] if isinstance(error, LogInstead) else []
            problems += error.problems
            continue
        twin = next((one for one in voyages if one.id == found.id), None)
        if twin is not None:
            what = f"two files are of trial '{found.id}'"
            where = f"{twin.path} and {found.path}"
            why = "trials are told apart by their ids"
            problems.append(Problem(what, where, why, "give each its own id, or remove one"))
        voyages.append(found)
    if len(logs_only) == len(files) > 1:
        raise TrialError(instead(path, logs_only))
    said = Split()
    if path.is_dir() and (path / SPLIT).is_file():
        said, wrong = read_split(path / SPLIT, None if problems else [one.id for one in voyages])
        problems += wrong
    problems += of_another_ship(voyages, said.ship, path / SPLIT)
    if not voyages and (logs := logs_instead(path)):
        raise TrialError(logs)
    if not voyages and not problems:
        problems.append(
            Problem(
                "the folder has no voyages", str(path), "it holds no *.parquet", "put such files there, one a voyage"
            )
        )
    if problems:
        raise TrialError(*problems)
    return VoyageSet(tuple(voyages), said.ship or _ship(voyages), path, said.licence, said.citation)


def _ship(voyages: Sequence[Voyage]) -> str:
    return next((one.ship for one in voyages if one.ship), "")
