"""Trials cut into windows, or divided at rows, each piece simulated anew from a measured state."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from .model import Trial
from .schema import ATTRIBUTES, FEWEST_SAMPLES
from .smoothing import FEWEST


def windows(trial: Trial, length: float, every: float | None = None) -> list[Trial]:
    """Consecutive pieces of a trial, each ``length`` [s] long but for the last, which ends with the trial.

    every  time between samples that count [s], None for all

    A piece begins at the sample the one before it ends at, or at the first after that without a gap; so every sample
    is compared once.  It lasts until a complete sample counts after its first.  A rest with none, or with fewer than
    FEWEST complete samples, belongs to the piece before it.  Ids get the second they begin at, "run_7@100"; ``part_of``
    is the trial's own id.
    """
    whole = np.flatnonzero(np.isfinite(trial.motion).all(axis=1))
    pieces, _ = cuts(trial.t, whole, length, every)
    return [_piece(trial, first, last + 1) for first, last in pieces]


def divided(trial: Trial, rows: Sequence[int]) -> list[Trial]:
    """The pieces of a trial before and after some of its rows, each from its first complete sample; see ``windows``.

    One of fewer than FEWEST_SAMPLES samples is left out.
    """
    whole = np.flatnonzero(np.isfinite(trial.motion).all(axis=1))
    found = []
    for first, end in itertools.pairwise([0, *rows, trial.n_samples]):
        inside = whole[(whole >= first) & (whole < end)]
        if len(inside) and end - inside[0] >= FEWEST_SAMPLES:
            found.append(_piece(trial, int(inside[0]), end))
    return found


def begun_at(trial: Trial, row: int) -> Trial:
    """The trial from its first complete sample at a row or after it on; as it is where that leaves fewer than
    FEWEST_SAMPLES samples."""
    whole = np.flatnonzero(np.isfinite(trial.motion).all(axis=1))
    first = whole[whole >= row]
    if not len(first) or trial.n_samples - first[0] < FEWEST_SAMPLES:
        return trial
    columns = {name: getattr(trial, name)[first[0] :] for name in ATTRIBUTES.values()}
    return replace(trial, extra={name: values[first[0] :] for name, values in trial.extra.items()}, **columns)


def cuts(
    t: FloatArray, whole: IntArray, length: float, every: float | None = None, *, more: bool = False
) -> tuple[list[tuple[int, int]], int]:
    """First and last sample of each piece, as ``windows`` cuts them, and the sample at which what is left begins.

    t      (n_samples,) time [s]
    whole  samples that are complete
    more   whether further samples follow, without ``every``: a piece that these could change is left, to be cut
           together with them
    """
    pieces: list[tuple[int, int]] = []
    times = t[whole]
    at = 0
    while at < len(whole):
        first = int(whole[at])
        compared = _first_compared(t, whole[at:], length, every)
        if pieces and compared is None:
            pieces[-1] = (pieces[-1][0], len(t) - 1)
            break
        until = t[first] + length
        at = max(at + 1, int(np.searchsorted(times, until - 1e-9)))  # shorter than a step, it is one
        at = at if compared is None else max(at, int(np.searchsorted(whole, compared)))
        if len(whole) - at < FEWEST:
            at = len(whole)
        if more and at == len(whole):  # what follows may join it, or begin another
            return pieces, first
        last = int(whole[at]) if at < len(whole) else len(t) - 1
        if last - first + 1 >= FEWEST_SAMPLES:
            pieces.append((first, last))
    return pieces, len(t)


def _first_compared(t: FloatArray, whole: IntArray, length: float, every: float | None) -> int | None:
    """The first of the complete samples ``whole`` that counts in a window beginning at whole[0]; None without."""
    first = int(whole[0])
    for end in (int(np.searchsorted(t, t[first] + length)) + 1, len(t)):  # behind the window only where it holds none
        inside = whole[: np.searchsorted(whole, end)]
        found = inside[counting(t[first:end], every)[inside - first]]
        if found.size:
            return int(found[0])
    return None


def counting(t: FloatArray, every: float | None) -> BoolArray:
    """Which samples of a trial count, (n_samples,): one in ``every`` [s], or all where None, but never the first.

    t  (n_samples,) time [s]
    """
    counts = np.ones(len(t), dtype=bool)
    counts[:1] = False
    if every is not None:
        counts[1:] = np.diff(np.floor((t - t[0]) / every + 1e-6)) >= 1.0
    return counts


def named(id: str, begins: float) -> str:
    """The id of a piece that begins so many seconds after its trial."""
    return f"{id}@{begins:.10g}"


def _piece(trial: Trial, first: int, end: int) -> Trial:
    columns = {name: getattr(trial, name)[first:end] for name in ATTRIBUTES.values()}
    columns["t"] = columns["t"] - columns["t"][0]
    return replace(
        trial,
        id=named(trial.id, float(trial.t[first] - trial.t[0])),
        part_of=trial.part_of or trial.id,
        begins=trial.begins + float(trial.t[first]),
        extra={name: values[first:end] for name, values in trial.extra.items()},
        **columns,
    )
