"""Progress on stderr, and Ctrl-C, SIGTERM or SIGHUP: once to finish with the best so far, twice to stop at once."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from shlex import quote
from types import TracebackType
from typing import TYPE_CHECKING, Any

import typer

from ..units import in_time
from . import interrupts
from .output import harmless, say
from .pace import Pace, Work

if TYPE_CHECKING:
    from ..fitting.cmaes import Search
    from ..hooks import Hooks

LINE_EVERY, TIME_EVERY = 5.0, 60.0
"""Seconds between two lines where stderr is no terminal; and where these say no more than the time so far."""

ASKED_EVERY = 0.25
"""Seconds between two looks at the clock by work that asks whether to stop, which it may do very often."""


class Progress:
    """A context in which a long command reports what it does, can be interrupted, and writes its results.

    What it is continued from stays until all is written, the report too: a command that is killed before can go on.

    folder     where the results go, for messages
    kept       what is saved of a command that is stopped
    left       how long the phase of that name and all after it may take, in words; asked again and again
    """

    def __init__(
        self,
        quiet: bool,
        folder: Path,
        *,
        kept: str = "the best so far",
        left: Callable[[str], str] = lambda phase: "",
    ):
        self._left = left
        self.quiet = quiet
        self.folder = folder
        self.kept = kept
        self._signal: int | None = None
        self._saved = ""
        self._whole = True
        self._kept = ExitStack()
        self._done_with: list[Path] = []
        self._phase = ""
        self._began = time.monotonic()
        self._last_line = self._last_asked = 0.0
        self._pace = Pace()
        self._candidates = 0
        self._work: Work | None = None
        self._status: Any = None

    @property
    def stopped(self) -> bool:
        """Whether the user asked to stop."""
        return self._signal is not None

    def hooks(self) -> Hooks:
        """What to hand to the fit."""
        from ..hooks import Hooks

        return Hooks(self._on_phase, self._on_progress, self._on_generation, self._asked)

    def __enter__(self) -> Progress:
        from ..run_folders import kept

        interrupts.handle(self._interrupt)
        self._done_with = self._kept.enter_context(kept())
        if not self.quiet and sys.stderr.isatty():
            from rich.console import Console

            self._status = Console(stderr=True).status("starting")
            self._status.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._status is not None:
            self._status.stop()
            self._status = None
        self._kept.close()
        for path in self._done_with if error is None and self._whole else ():
            path.unlink(missing_ok=True)
        interrupts.handle(interrupts.stop_at_once(self._saved or interrupts.continued(self.folder)))

    def saved(self, interrupted: bool, but: str = "") -> None:
        """Note that the result is written.

        interrupted  whether it is less than was asked for; Ctrl-C may also come when it is complete
        but          the one part of it that is not there yet, or less than was asked for
        """
        self._whole = not but
        if but:
            again = f"--resume --out {quote(str(self.folder))} continues"
            self._saved = f"the results in {self.folder} are complete but for {but}; {again}"
        elif not interrupted:
            self._saved = f"the results in {self.folder} were complete by then"
        else:
            self._saved = f"{self.kept} is in {self.folder}; --resume --out {quote(str(self.folder))} continues"

    def leave(self) -> None:
        """End with the exit code of a command that was stopped, where it was; called when everything is said."""
        if self._signal is None:
            return
        number = signal.Signals(self._signal)
        say(f"{interrupts.NAMES[number]}: {self._saved}")
        raise typer.Exit(interrupts.CODES[number])

    def _interrupt(self, number: int, _frame: Any) -> None:
        if self.stopped:
            if self._status is not None:
                os.write(2, b"\x1b[?25h")  # the cursor, which the status line hides
            last = f"stopped at once; --resume --out {quote(str(self.folder))} continues from the last checkpoint"
            interrupts.leave(number, self._saved or last)
        self._signal = number
        interrupts.tell(f"finishing this step, then saving {self.kept}; press Ctrl-C again to stop at once")

    def _asked(self) -> bool:
        """Whether to stop; who asks that is at work, so what is left of it, or how long it takes, is told anew."""
        now = time.monotonic()
        if self._phase and now - self._last_asked > ASKED_EVERY:
            self._last_asked = now
            if left := self._left(self._phase):
                self._show(f"{self._phase}, {left}")
            elif self._candidates:
                pass  # each generation says more
            elif self._work:
                self._show(f"{self._phase}: {self._work.words(self._so_far())}")
            else:
                self._show(f"{self._phase}, {self._so_far()}", every=TIME_EVERY)
        return self.stopped

    def _so_far(self) -> str:
        """How long the command has been at work, in words."""
        return f"{in_time(time.monotonic() - self._began)} so far"

    def _on_phase(self, words: str) -> None:
        self._phase = words
        self._pace, self._candidates = Pace(), 0
        if self._work and self._work.of_phase:
            self._work = None
        left = self._left(words) or (self._work.words(self._so_far()) if self._work else "")
        self._show(f"{words}, {left}" if left else words, line=True)

    def _on_progress(self, done: int, total: int, noun: str) -> None:
        """So much of the work is done; it is told when a phase begins and when it is asked whether to stop."""
        if self._work is None or self._work.noun != noun:
            self._work = Work(noun)
        self._work.reached(done, total)

    def on_share(self, done: int, total: int, words: str) -> None:
        """A share of the work is done: tell it, with the time that is left where the pace is known."""
        left = self._pace.left(done, total - done) or self._so_far()
        self._show(f"{words}: {100.0 * done / max(total, 1):.0f} %, {left}")

    def _on_generation(self, state: Search) -> None:
        from ..fitting.cmaes import LAMBDAS, USUAL_GENERATIONS

        now = state.history[-1]
        self._candidates += now.population
        usual = USUAL_GENERATIONS[now.restart]
        work = [population * many for population, many in zip(LAMBDAS, USUAL_GENERATIONS, strict=True)]
        rest = now.population * (usual - now.generation) + sum(work[now.restart + 1 :])
        left = self._pace.left(self._candidates, rest)
        if now.generation > usual:  # when it ends nobody knows
            left = f"more than the usual {usual} generations, {self._so_far()}"
        self._show(
            f"{self._phase}: restart {now.restart + 1} of {len(LAMBDAS)} (lambda {now.population}), "
            f"generation {now.generation}, {now.evaluations} evaluations, J {state.J:.6g}, sigma {now.sigma:.1e}, "
            f"lost {state.diverged}, {f'{left} of it' if left.endswith('left') else left or self._so_far()}"
        )

    def _show(self, text: str, line: bool = False, every: float = LINE_EVERY) -> None:
        if self.quiet:
            return
        if self._status is not None:
            from rich.text import Text

            self._status.update(Text(harmless(text)))
        elif line or time.monotonic() - self._last_line > every:
            self._last_line = time.monotonic()
            say(text)
