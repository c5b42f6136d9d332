"""Ctrl-C: whenever it comes, exit code 130 and one line that says what is saved."""

from __future__ import annotations

from typing import Any


class Stopped(BaseException):
    """Stopped at once by the user; the line to say.  No ``except Exception`` on the way swallows it."""


def stop_at_once(_signal: int, _frame: Any) -> None:
    """What Ctrl-C does where there is nothing to finish."""
    raise Stopped("nothing was left half-written")
