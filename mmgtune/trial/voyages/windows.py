"""Voyages cut into windows while they are read."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...errors import Problem, TrialError
from ...inputs import INPUTS
from ...physics.constants import GRAVITY
from ..model import Trial, fields_of
from ..pieces import cuts, named
from ..schema import MAIN_INPUTS, MOTION
from ..unusable import in_degrees
from .voyage import Block, Voyage

LEAST = 0.5
"""Share of the length that a window must last; a distance measure grows with time, and short ones flatter."""

AT_REST = 0.02
"""Froude number U / sqrt(g L_pp) below which the ship is at rest: relative distances say nothing there."""


class Unused(StrEnum):
    """Why rows are in no window, as records of voyages name it."""

    UNKNOWN_INPUTS = "unknown inputs"
    INCOMPLETE_MOTION = "incomplete motion"
    TOO_SHORT = "too short"


class Window(NamedTuple):
    """A window: the trial, the row of the file it begins at, and the time there [s]."""

    trial: Trial
    row: int
    begins: float


@dataclass
class Cutting:
    """What became of the rows of a voyage, counted while it is cut.

    rows      read so far
    windows   cut so far
    used      rows in windows
    gaps      of these, rows with incomplete motion, which do not count in any comparison
    left_out  rows in no window, by reason
    shared    whether the next row is also the last of the window before it
    """

    rows: int = 0
    windows: int = 0
    used: int = 0
    gaps: int = 0
    left_out: dict[Unused, int] = field(default_factory=lambda: dict.fromkeys(Unused, 0))
    shared: bool = False


def voyage_windows(
    voyage: Voyage, length: float, *, gap: float, inputs: Sequence[str] = MAIN_INPUTS, counted: Cutting | None = None
) -> Iterator[Window]:
    """The windows of a voyage in order, each ``length`` [s] long, cut as ``windows`` cuts a trial.

    gap      longest time [s] between two samples of complete motion within a window
    inputs   what drives the models: columns that must be known in every sample of a window
    counted  filled with what became of the rows

    The voyage falls into stretches, wherever a longer gap is or an input is not known; each is cut by itself, from its
    first complete sample.  A window that lasts less than LEAST of its length, at the end of a stretch, is left out.
    Row groups of the file and blocks that are read make no difference.

    Raises TrialError as ``Voyage.blocks`` does, where the voyage lacks an input, and where headings are in degrees.
    """
    told = Cutting() if counted is None else counted
    rest: Block | None = None
    needed = tuple(dict.fromkeys([*MAIN_INPUTS, *inputs]))
    lacking = [name for name in needed if name not in voyage.columns]
    if lacking:
        raise TrialError(*(_without(voyage, name) for name in lacking))
    for block in voyage.blocks():
        told.rows += len(block.columns["t"])
        whole = block if rest is None else _joined(rest, block)
        ended = block.row + len(block.columns["t"]) == voyage.n_rows
        windows, rest = _cut(voyage, whole, length, gap, needed, told, more=not ended)
        yield from windows


def rest_speed(L_pp: float) -> float:
    """Mean speed [m/s] of a window below which a ship of this length [m] is at rest."""
    return AT_REST * float(np.sqrt(GRAVITY * L_pp))


def mean_speed(trial: Trial) -> float:
    """Over the samples that have one [m/s]."""
    return float(np.nanmean(np.hypot(trial.u, trial.v_m)))


def window_at(voyage: Voyage, row: int, n_samples: int) -> Window:
    """The window of ``n_samples`` that begins at a row, read anew."""
    parts: list[Block] = []
    for block in voyage.blocks(row):
        parts.append(block)
        if block.row + len(block.columns["t"]) >= row + n_samples:
            break
    whole = parts[0]
    for part in parts[1:]:
        whole = _joined(whole, part)
    return _window(voyage, whole, row - whole.row, row - whole.row + n_samples - 1)


def _cut(
    voyage: Voyage, block: Block, length: float, gap: float, inputs: tuple[str, ...], told: Cutting, *, more: bool
) -> tuple[list[Window], Block | None]:
    """Windows that nothing after the block can change, and the rows that are to be cut together with what follows."""
    t = block.columns["t"]
    known = _finite(block, inputs)
    complete = known & _finite(block, tuple(MOTION))
    good = np.flatnonzero(complete)
    windows: list[Window] = []
    covered = np.zeros(len(t), dtype=bool)
    covered[0] = told.shared
    end = len(t)
    for k, stretch in enumerate(stretches := _stretches(t, good, known, gap)):
        _sound_headings(voyage, block, stretch)
        first, last = int(stretch[0]), int(stretch[-1])
        # What follows may belong to the last of them, unless it is over already.
        lasting = bool(known[last:].all() and t[-1] - t[last] <= gap)
        open_ended = more and lasting and k + 1 == len(stretches)
        pieces, left = cuts(t[first : last + 1], stretch - first, length, more=open_ended)
        if open_ended:
            end = first + left
        for start, stop in pieces:
            if t[first + stop] - t[first + start] >= LEAST * length:
                windows.append(_window(voyage, block, first + start, first + stop))
                covered[first + start : first + stop + 1] = True
    told.shared = end < len(t) and bool(covered[end])
    told.windows += len(windows)
    _count(told, covered[:end], known[:end], complete[:end])
    if end == len(t):
        return windows, None
    return windows, Block(block.row + end, {name: values[end:].copy() for name, values in block.columns.items()})


def _stretches(t: FloatArray, good: IntArray, known: BoolArray, gap: float) -> list[IntArray]:
    """Samples of complete motion that belong together: no gap between them, and inputs known throughout."""
    if not len(good):
        return []
    unknown = np.concatenate([[0], np.cumsum(~known)])
    apart = (np.diff(t[good]) > gap) | (np.diff(unknown[good]) > 0)
    return list(np.split(good, np.flatnonzero(apart) + 1))


def _count(told: Cutting, covered: BoolArray, known: BoolArray, complete: BoolArray) -> None:
    told.used += int(covered.sum())
    told.gaps += int((covered & ~complete).sum())
    left = ~covered
    told.left_out[Unused.UNKNOWN_INPUTS] += int((left & ~known).sum())
    told.left_out[Unused.INCOMPLETE_MOTION] += int((left & known & ~complete).sum())
    told.left_out[Unused.TOO_SHORT] += int((left & complete).sum())


def _window(voyage: Voyage, block: Block, first: int, last: int) -> Window:
    """Rows of a block as a trial."""
    columns = {name: values[first : last + 1] for name, values in block.columns.items()}
    begins = float(columns["t"][0])
    trial = Trial(
        id=named(voyage.id, begins - voyage.begins),
        ship=voyage.ship,
        manoeuvre=voyage.manoeuvre,
        source=voyage.source,
        path=voyage.path,
        part_of=voyage.id,
        begins=begins - voyage.begins,
        cut_from=voyage.cut_from,
        antenna=voyage.antenna,
        **fields_of({**columns, "t": columns["t"] - begins}),
    )
    return Window(trial, block.row + first, begins)


def _without(voyage: Voyage, name: str) -> Problem:
    return Problem(
        f"voyage '{voyage.id}' does not say '{name}'",
        str(voyage.path),
        f"the model is driven by it: {INPUTS[name].words} [{INPUTS[name].unit}]",
        "log it, or take a profile whose arrangement does without",
    )


def _finite(block: Block, names: tuple[str, ...]) -> BoolArray:
    """(n_rows,) whether all of these columns have a value."""
    return np.asarray(np.logical_and.reduce([np.isfinite(block.columns[name]) for name in names]))


def _joined(one: Block, other: Block) -> Block:
    return Block(one.row, {name: np.concatenate([one.columns[name], other.columns[name]]) for name in one.columns})


def _sound_headings(voyage: Voyage, block: Block, stretch: IntArray) -> None:
    """Raises TrialError where headings of a stretch are in degrees."""
    first, last = int(stretch[0]), int(stretch[-1])
    part = {name: block.columns[name][first : last + 1] for name in ("t", *MOTION)}
    with np.errstate(all="ignore"):
        problems = in_degrees(part, str(voyage.path))
    if problems:
        raise TrialError(*problems)
