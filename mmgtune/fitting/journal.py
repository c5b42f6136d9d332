"""The journal of a long run: every finished search in it, so that a run that was stopped can be continued.

A run is a function of profile, trials, options and versions.  What takes its time are solves of least squares and
searches; each is noted in a line of a file as soon as it is done, with what it was asked.  A resumed run begins at the
beginning and takes from the journal what is there, in order; so it comes to the same numbers, bit for bit.  Of pieces
of work done side by side each has an order of its own.  Nothing in the file is executed on loading.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import inspect
import json
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import partial
from itertools import takewhile
from pathlib import Path
from threading import Lock
from typing import Any, Generic, ParamSpec, Protocol, TypeVar

import numpy as np

from ..errors import MmgtuneError, OptionError, OutputError, Problem
from ..files import cannot_write, write_text
from ..run_files import CHECKPOINT, JOURNAL
from ..run_folders import remove_kept
from ..threads import cores, on_threads
from .checkpoint import differing, nothing_to_resume

SCHEMA = 3

AMONG = "among"
"""Key of entries of work that was done side by side with other work."""

P = ParamSpec("P")
R = TypeVar("R")
T = TypeVar("T")


class _InOrder:
    """Work that is remembered in order: it is asked for in the order in which it was noted.

    _noted  entries there are; _next: the first that was not asked for yet
    _among  what marks its entries, None where nothing does
    """

    _noted: list[dict[str, Any]]
    _next: int = 0
    _among: list[int] | None = None

    def remember(self, what: str, asked: str, do: Callable[[], Any], note: Callable[[Any], Any], recall: Any) -> Any:
        """The result of a piece of work: from the journal where it is the next there, else done, and noted.

        what, asked  name of the work, and a hash of what it is to be done with
        note, recall  a result as JSON, and back
        """
        if self._next < len(self._noted):
            entry = self._noted[self._next]
            if (entry["what"], entry["asked"], entry.get(AMONG)) == (what, asked, self._among):
                self._next += 1
                return recall(entry["result"])
            if not self.is_stopped():
                self._forget()  # the run went another way from here; what follows is of no use
        result = do()
        if not self.is_stopped():
            mark = {} if self._among is None else {AMONG: self._among}
            self._note({**mark, "what": what, "asked": asked, "result": note(result)})
            self._next += 1
        return result

    def is_stopped(self) -> bool:
        """Whether the run is being stopped: what it does then is not as it would have been."""
        raise NotImplementedError

    def _forget(self) -> None:
        """Forget what was not asked for yet."""
        raise NotImplementedError

    def _note(self, entry: dict[str, Any]) -> None:
        """Note an entry behind the others."""
        raise NotImplementedError


class Journal(_InOrder):
    """The journal of one run folder.

    identity  everything the run depends on: hashes of profile and trials, options, versions
    stop      whether the run is being stopped: what ends after that is not as it would have been, and is not noted
    """

    def __init__(
        self, folder: Path, identity: dict[str, Any], stop: Callable[[], bool] = lambda: False, name: str = JOURNAL
    ):
        self.path = folder / name
        self.identity = identity
        self.stop = stop
        self._noted = []
        self._times = 0
        self._file: Any = None
        self._one_by_one = Lock()

    def begin(self, resume: bool) -> None:
        """Read the journal that is there, or begin a new one.

        Raises OptionError where there is nothing to resume, or it belongs to another run.
        """
        header = json.dumps({"schema": SCHEMA, "identity": self.identity}, sort_keys=True) + "\n"
        text = header
        if resume:
            lines = self._lines()
            head = _parsed(lines[0]) if lines else None
            if head is None or head.get("schema") != SCHEMA or not isinstance(head.get("identity"), dict):
                why = "it is damaged, or of another version of this program"
                fix = "delete it, or run without resume=True"
                raise OptionError(Problem("the journal cannot be read", str(self.path), why, fix))
            differing(head["identity"], self.identity, self.path)
            entries = [_entry(line) for line in lines[1:]]
            whole = entries.index(None) if None in entries else len(entries)  # up to half a line, or a damaged one
            self._noted = [entry for entry in entries[:whole] if entry is not None]
            text = header + "".join(line + "\n" for line in lines[1 : 1 + whole])
        write_text(self.path, text)

    def _lines(self) -> list[str]:
        if not self.path.is_file():
            if self.path.name == JOURNAL:
                raise nothing_to_resume(self.path.parent, "journal")
            raise nothing_to_resume(self.path.parent, self.path.name, "the run never began, or has ended", results=())
        return self.path.read_text(encoding="utf-8", errors="replace").splitlines()

    def is_stopped(self) -> bool:
        """As ``stop`` has it."""
        return self.stop()

    def _forget(self) -> None:
        self._keep(self._noted[: self._next])

    @contextmanager
    def apart(self, n: int) -> Iterator[list[Strand]]:
        """Journals of n pieces of work done side by side next, within this context."""
        self._times += 1
        first = self._next
        there = self._side_by_side(first)
        if first < len(self._noted) and _times(self._noted[first]) != self._times:
            if not self.stop():
                self._keep(self._noted[:first])
            there = []
        marks = [[self._times, k] for k in range(n)]
        try:
            yield [Strand(self, mark, [entry for entry in there if entry[AMONG] == mark]) for mark in marks]
        finally:
            self._next = first + len(self._side_by_side(first))

    def _side_by_side(self, first: int) -> list[dict[str, Any]]:
        """Entries from that one on of work done side by side at one time."""
        noted = self._noted[first:]
        times = _times(noted[0]) if noted else 0
        return list(takewhile(lambda entry: times and _times(entry) == times, noted))

    def without(self, entries: Sequence[dict[str, Any]]) -> None:
        """Forget entries of a piece of work done side by side with others, and what was noted after all of these."""
        with self._one_by_one:
            gone = {id(entry) for entry in entries}
            first = next(k for k, entry in enumerate(self._noted) if _times(entry) == _times(entries[0]))
            those = self._side_by_side(first)
            self._keep([*self._noted[:first], *(entry for entry in those if id(entry) not in gone)])

    def note(self, entry: dict[str, Any]) -> None:
        """Note an entry of work done side by side."""
        with self._one_by_one:
            self._note(entry)

    def _note(self, entry: dict[str, Any]) -> None:
        self._append(_line(entry))
        self._noted.append(entry)

    def _keep(self, entries: list[dict[str, Any]]) -> None:
        """Forget all other entries."""
        head = self._lines()[:1]
        self.close()
        self._noted = entries
        write_text(self.path, "".join([*(line + "\n" for line in head), *map(_line, entries)]))

    def _append(self, line: str) -> None:
        try:
            if self._file is None:
                self._file = self.path.open("a", encoding="utf-8", newline="\n")
            self._file.write(line)
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as error:
            raise cannot_write(self.path, error) from error

    @property
    def noted(self) -> bool:
        """Whether there is work in it, or beside it, that need not be done again."""
        return bool(self._noted) or any(path.is_file() for path in self._beside)

    def remove(self) -> None:
        """Take the file away, and what is resumed together with it."""
        self.close()
        for path in (self.path, *self._beside):
            with contextlib.suppress(OSError):
                path.unlink()

    @property
    def _beside(self) -> tuple[Path, ...]:
        return (self.path.parent / CHECKPOINT,) if self.path.name == JOURNAL else ()

    def close(self) -> None:
        """Let go of the file."""
        if self._file is not None:
            self._file.close()
            self._file = None


class Strand(_InOrder):
    """The journal of one of several pieces of work that are done side by side.

    journal  of the run
    among    how many times work was done side by side until then, and which of these pieces it is
    noted    entries of it that are there
    """

    def __init__(self, journal: Journal, among: list[int], noted: list[dict[str, Any]]):
        self._journal, self._among, self._noted = journal, among, noted

    def is_stopped(self) -> bool:
        """As the run is."""
        return self._journal.stop()

    def _forget(self) -> None:
        self._journal.without(self._noted[self._next :])
        del self._noted[self._next :]

    def _note(self, entry: dict[str, Any]) -> None:
        self._journal.note(entry)
        self._noted.append(entry)


_ACTIVE: ContextVar[Journal | Strand | None] = ContextVar("journal", default=None)


def side_by_side(pieces: Sequence[Callable[[], T]]) -> list[T]:
    """Results of pieces of work that do not need each other, in their order; done on several cores where there are.

    Each is remembered by itself where a journal is kept.  What is done within one of them is done one by one.
    """
    journal = _ACTIVE.get()
    if isinstance(journal, Strand) or len(pieces) < 2:
        return [piece() for piece in pieces]
    with journal.apart(len(pieces)) if journal else contextlib.nullcontext([None] * len(pieces)) as strands:
        return on_threads([partial(_remembering, own, one) for own, one in zip(strands, pieces, strict=True)], cores())


def _remembering(journal: Strand | None, piece: Callable[[], T]) -> T:
    """The result of a piece of work that is noted there."""
    token = _ACTIVE.set(journal)
    try:
        return piece()
    finally:
        _ACTIVE.reset(token)


@contextmanager
def journalled(
    folder: Path | None, identity: dict[str, Any], stop: Callable[[], bool], *, resume: bool, name: str = JOURNAL
) -> Iterator[None]:
    """What is searched for within this context is noted in the folder; part of a longer run is noted in its journal.

    The journal stays until the result of the run is written: see ``finished``.  Of a run that is refused, or that
    cannot be, none is left.

    name  of its file, for what may share a folder with another run
    Raises OptionError where there is nothing to resume, or it belongs to another run.
    """
    if folder is None or _ACTIVE.get() is not None:
        yield
        return
    journal = Journal(folder, identity, stop, name)
    journal.begin(resume)
    token = _ACTIVE.set(journal)
    try:
        yield
    except MmgtuneError as error:
        if not resume and not (isinstance(error, OutputError) and journal.noted):  # it would end so again
            journal.remove()
        raise
    finally:
        _ACTIVE.reset(token)
        journal.close()


def finished(folder: Path, *names: str) -> None:
    """Delete what a run in this folder would be continued from, or the journals of those names: its result is
    written.  A command does so when its report is written too."""
    remove_kept(folder / name for name in names or (CHECKPOINT, JOURNAL))


class Counts(Protocol):
    """Something that counts evaluations."""

    evaluations: int


@dataclass
class Uncounted:
    """Where nobody looks at how many there were."""

    evaluations: int = 0


class remembered(Generic[R]):
    """Decorator of a function whose results a journal keeps.

    asked         of its arguments, by name and with the defaults: numbers and texts that say what is to be done
    note, recall  a result as JSON, and back
    counter       of the same: what counts evaluations; those of a recalled result count as when they were made
    """

    def __init__(
        self,
        asked: Callable[..., list[Any]],
        note: Callable[[R], Any],
        recall: Callable[[Any], R],
        counter: Callable[..., Counts] | None = None,
    ):
        self.asked, self.note, self.recall, self.counter = asked, note, recall, counter

    def __call__(self, do: Callable[P, R]) -> Callable[P, R]:
        """The function, remembering where a journal is kept."""

        @functools.wraps(do)
        def through(*given: P.args, **named: P.kwargs) -> R:
            journal = _ACTIVE.get()
            if journal is None:
                return do(*given, **named)
            known = arguments(do, *given, **named)
            asked = _hash(self.asked(**known))
            counter = self.counter(**known) if self.counter else Uncounted()
            before = counter.evaluations

            def note(result: R) -> Any:
                return {"evaluations": counter.evaluations - before, "result": self.note(result)}

            def recall(noted: Any) -> R:
                counter.evaluations += noted["evaluations"]
                return self.recall(noted["result"])

            def whole() -> R:
                token = _ACTIVE.set(None)  # what is remembered in the course of it is a part of it
                try:
                    return do(*given, **named)
                finally:
                    _ACTIVE.reset(token)

            result: R = journal.remember(do.__name__, asked, whole, note, recall)
            return result

        return through


def arguments(do: Callable[..., Any], *given: Any, **named: Any) -> dict[str, Any]:
    """Arguments of a call by name, those that were not given as the function has them."""
    bound = inspect.signature(do).bind(*given, **named)
    bound.apply_defaults()
    return bound.arguments


def _hash(parts: list[Any]) -> str:
    found = hashlib.sha256()
    for part in parts:
        found.update(np.ascontiguousarray(part).tobytes() if isinstance(part, np.ndarray) else repr(part).encode())
        found.update(b"\0")
    return found.hexdigest()[:24]


def _line(entry: dict[str, Any]) -> str:
    """A line of the file, with a sum that tells whether it is as it was written."""
    text = json.dumps(entry)
    return f"{_sum(text)} {text}\n"


def _entry(line: str) -> dict[str, Any] | None:
    """The entry of a line; None where it is not as it was written."""
    noted, _, text = line.partition(" ")
    entry = _parsed(text) if noted == _sum(text) else None
    if entry is None or not {"what", "asked", "result"} <= set(entry):
        return None
    among = entry.get(AMONG, [0, 0])
    return entry if isinstance(among, list) and [type(number) for number in among] == [int, int] else None


def _times(entry: dict[str, Any]) -> int:
    """How many times work was done side by side, this included, when an entry of such work was noted; 0 of other."""
    among = entry.get(AMONG)
    return int(among[0]) if among else 0


def _sum(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _parsed(line: str) -> dict[str, Any] | None:
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None
