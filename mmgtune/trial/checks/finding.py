"""What a check has to say about a trial."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

from ...phrases import listed

SEVERITIES = ("error", "warning", "note")
"""Worst first."""


class Rescale(str):
    """A fix by arithmetic, of a column in another unit or at another scale, which a map of the log can say instead."""

    column: str

    def __new__(cls, words: str, column: str = "") -> Self:
        made = super().__new__(cls, words)
        made.column = column
        return made


class Reverse(str):
    """A fix by the other sign of a column, which a map of the log can say instead.

    columns  the likeliest, then those that are wrong where that is right
    """

    columns: tuple[str, ...]

    def __new__(cls, column: str, *others: str) -> Self:
        those = f"{'that' if len(others) == 1 else 'those'} of {listed([repr(one) for one in others])}"
        made = super().__new__(cls, f"change the sign of '{column}'; if it is right, {those}")
        made.columns = (column, *others)
        return made


class Shift(str):
    """A fix by a shift in time of what one logger wrote, which a map of the log can say instead.

    late  how much later than it happened it was logged [s]
    """

    late: float

    def __new__(cls, words: str, late: float = 0.0) -> Self:
        made = super().__new__(cls, words)
        made.late = late
        return made


@dataclass(frozen=True)
class Finding:
    """Something about a trial a user should know.

    severity  "error" (cannot be used), "warning" (probably wrong) or "note" (good to know)
    what      what was found, in one sentence without the place
    where     file and column or row
    why       why it matters, or what speaks for it
    fix       what to do about it
    code      which finding it is, where something goes on from it ("gaps", "yaw-rate", ...), else ""
    """

    severity: str
    what: str
    where: str
    why: str = ""
    fix: str = ""
    code: str = ""
