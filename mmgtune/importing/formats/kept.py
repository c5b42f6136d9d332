"""Logs that hold many runs, opened once for all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any, TypeVar

Made = TypeVar("Made")


class _Kept:
    """What was made of the log that was opened last, by its path and what it was opened as."""

    def __init__(self) -> None:
        self.of: dict[tuple[Path, str], Any] = {}
        self.closing = ExitStack()

    def leave(self) -> None:
        self.of = {}
        self.closing.close()


_KEPT: ContextVar[_Kept | None] = ContextVar("kept", default=None)


@contextmanager
def opened_once() -> Iterator[None]:
    """A log that is opened within this context, or the function that it decorates, stays open until another one is."""
    if _KEPT.get() is not None:
        yield
        return
    kept = _Kept()
    token = _KEPT.set(kept)
    try:
        yield
    finally:
        _KEPT.reset(token)
        kept.leave()


@contextmanager
def opened(path: Path, form: str, made: Callable[[], Made], close: Callable[[Made], Any]) -> Iterator[Made]:
    """What is made of a log, closed in the end; within ``opened_once`` what was made of it before, and left open.

    form  what it is opened as: one log may be opened as several
    """
    kept = _KEPT.get()
    if kept is None:
        alone = made()
        try:
            yield alone
        finally:
            close(alone)
        return
    if (path, form) not in kept.of:
        if any(other != path for other, _ in kept.of):
            kept.leave()
        kept.of[path, form] = made()
        kept.closing.callback(close, kept.of[path, form])
    yield kept.of[path, form]
