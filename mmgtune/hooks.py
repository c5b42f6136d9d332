"""What a caller hears of long work, and how it is stopped before its end without losing what is known by then."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Hooks:
    """What the caller wants to hear and to say while work goes on.

    on_phase       called with a few words when a new part of the work begins
    on_progress    called with what is done, what there is in all, and where the work stands in words: updates of a
                   training, rows of voyages
    on_generation  called after each generation of CMA-ES with the search
    stop           asked often; True ends the work with the best so far
    """

    on_phase: Callable[[str], None] = lambda _: None
    on_progress: Callable[[int, int, str], None] = lambda *_: None
    on_generation: Callable[[Any], None] = lambda _: None
    stop: Callable[[], bool] = lambda: False


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
