"""What a caller hears of long work, and how it is stopped before its end without losing what is known by then."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields
from typing import Any, Self

from .errors import OptionError, Problem, brief, kind_of

EVALUATIONS = "evaluations"
"""What progress of least squares is counted in: what there is in all may be exceeded."""

_TAKES = {
    "on_phase": " words: print(words)",
    "on_progress": " done, of, words: print(done, of)",
    "on_generation": " search: None",
    "stop": ": False",
}
"""What each function of hooks takes, and a body."""


class Phase(str):
    """Words for a new part of the work; ``look`` counts the looks for causes in a diagnosis, 0 in any other part."""

    look: int

    def __new__(cls, words: str, look: int = 0) -> Self:
        made = super().__new__(cls, words)
        made.look = look
        return made


@dataclass(frozen=True, repr=False)
class Hooks:
    """What the caller wants to hear and to say while work goes on.

    on_phase       called with a few words when a new part of the work begins
    on_progress    called with what is done, what there is in all, and where the work stands in words: updates of a
                   training, rows of voyages, "parts" that are left out in turn, and "evaluations" of least squares,
                   of as many as are seldom exceeded
    on_generation  called after each generation of CMA-ES with the search
    stop           asked often; True ends the work with the best so far
    """

    on_phase: Callable[[str], None] = lambda _: None
    on_progress: Callable[[int, int, str], None] = lambda *_: None
    on_generation: Callable[[Any], None] = lambda _: None
    stop: Callable[[], bool] = lambda: False

    def __repr__(self) -> str:
        """The functions given, by name: help shows this as a default, which is to be the same in every run."""
        given = [one.name for one in fields(self) if getattr(self, one.name) is not one.default]
        return f"{type(self).__name__}({', '.join(f'{name}={_name_of(getattr(self, name))}' for name in given)})"

    def __post_init__(self) -> None:
        """Raises OptionError for what cannot be called."""
        for one in fields(self):
            given = getattr(self, one.name)
            if not callable(given):
                fix = f"give a function: Hooks({one.name}=lambda{_TAKES[one.name]})"
                raise OptionError(
                    Problem(f"{one.name} is {brief(given)}", one.name, "it is called while work goes on", fix)
                )


def _name_of(function: Callable[..., Any]) -> str:
    return getattr(function, "__qualname__", None) or f"<{kind_of(function)}>"


@contextmanager
def until_interrupted() -> Iterator[Hooks]:
    """Hooks that end work with the best so far once Ctrl-C, or the stop button of a notebook, is pressed.

    A second time it raises KeyboardInterrupt, as without.  In other threads than the main one, which hear of no signal,
    nothing stops.

        with mmgtune.until_interrupted() as hooks:
            result = mmgtune.fit("suzaku", "suzaku", hooks=hooks)
        result.interrupted
    """
    pressed: list[int] = []
    if threading.current_thread() is not threading.main_thread():
        yield Hooks()
        return

    def press(number: int, _frame: Any) -> None:
        if pressed:
            raise KeyboardInterrupt
        pressed.append(number)

    before = signal.signal(signal.SIGINT, press)
    try:
        yield Hooks(stop=lambda: bool(pressed))
    finally:
        signal.signal(signal.SIGINT, before)
