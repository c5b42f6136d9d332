"""Which trials of a data set tune and which test: its ``split.toml``."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from .. import limits
from ..errors import Problem, TrialError, among, reason
from ..toml_reading import TomlReader, toml_of

SPLIT = "split.toml"
KEYS = ("ship", "licence", "citation", "tune", "test")


@dataclass(frozen=True)
class Split:
    """What a split says; ids in the order they are written, texts "" where it says nothing."""

    ship: str = ""
    licence: str = ""
    citation: str = ""
    tune: tuple[str, ...] = ()
    test: tuple[str, ...] = ()


def read_split(path: Path, known: Iterable[str] | None) -> tuple[Split, list[Problem]]:
    """The split and everything wrong with it.

    known  ids of the trials there are; None where that is not known because a file cannot be read
    """
    try:
        text = limits.content(path, limits.SPLIT_BYTES, TrialError).decode("utf-8-sig")
        data = toml_of(text, "the split", str(path), TrialError)
    except (OSError, ValueError) as error:
        return Split(), [Problem("the split cannot be read", str(path), reason(error), "it must be UTF-8 text")]
    except TrialError as error:
        return Split(), list(error.problems)
    place = partial(_place, path, text)
    reader = TomlReader(data, text, str(path))
    reader.unknown("", data, KEYS)
    texts = {key: reader.text_of("", data, key) for key in ("ship", "licence", "citation")}
    problems = reader.problems
    sets: dict[str, tuple[str, ...]] = {}
    for key in ("tune", "test"):
        ids = data.get(key, [])
        if not (isinstance(ids, list) and all(isinstance(one, str) for one in ids)):
            fix = f'write {key} = ["id", ...]'
            problems.append(Problem(f"'{key}' is not a list of trial ids", place(key), fix=fix))
            sets[key] = ()
            continue
        sets[key] = tuple(ids)
        problems += wrong_ids(key, ids, known, place)
        if key == "tune" and not ids:
            why = "'tune' is empty" if "tune" in data else "'tune' is missing"
            problems.append(Problem("no trial tunes", place("tune"), why, 'write tune = ["id", ...]'))
    problems += in_both(sets["tune"], sets["test"], place)
    return Split(**texts, tune=sets["tune"], test=sets["test"]), problems


def wrong_ids(key: str, ids: Sequence[str], known: Iterable[str] | None, place: Callable[[str], str]) -> list[Problem]:
    """Ids named more than once in "tune" or "test", and ids of no trial.

    known  ids of the trials there are; None where that is not known
    place  where a word stands
    """
    there = None if known is None else dict.fromkeys(known)
    problems = []
    for name, count in Counter(ids).items():
        if count > 1:
            why = "it would count that many times"
            what = f"trial '{name}' is named {count} times in '{key}'"
            problems.append(Problem(what, place(name), why, "name it once"))
        if there is not None and name not in there:
            what = f"'{key}' names trial '{name}', which is not there"
            problems.append(Problem(what, place(name), **among(name, list(there))))
    return problems


def in_both(tune: Iterable[str], test: Iterable[str], place: Callable[[str], str]) -> list[Problem]:
    """Ids that tune and test.

    place  where a word stands
    """
    why, fix = "a test on what was tuned shows nothing", "name it in one of them"
    return [
        Problem(f"trial '{name}' is both in 'tune' and in 'test'", place(name), why, fix)
        for name in sorted(set(tune) & set(test))
    ]


def _place(path: Path, text: str, word: str) -> str:
    """The file and the first line that has ``word`` in it as a key or between quotes, where one has."""
    pattern = re.compile(rf"^\s*{re.escape(word)}\s*=|[\"']{re.escape(word)}[\"']")
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.lstrip().startswith("#") and pattern.search(line):
            return f"{path}, line {number}"
    return str(path)
