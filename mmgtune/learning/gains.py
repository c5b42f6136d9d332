"""What a network gains on runs it has not seen: by step of the training, by kind of manoeuvre, with intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..drawing_anew import interval_of

Runs = Mapping[str, tuple[str, int]]
"""Kind of manoeuvre of runs, and the samples of each that count."""


@dataclass(frozen=True, eq=False)
class Trained:
    """A training of one part: errors of unseen runs by step, with and without the network."""

    alone: dict[str, float]
    runs: Runs
    curve: list[dict[str, float]]
    events: list[dict[str, Any]]


@dataclass(frozen=True)
class Gain:
    """What the network removes of the error on runs it has not seen, of one kind of manoeuvre.

    share     of L_MSE that is gone
    interval  95 %, by drawing runs anew; None with fewer than three
    """

    manoeuvre: str
    runs: int
    before: float
    after: float
    share: float
    interval: tuple[float, float] | None

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "manoeuvre": self.manoeuvre,
            "runs": self.runs,
            "L_MSE_before": self.before,
            "L_MSE_after": self.after,
            "share_removed": self.share,
            "share_removed_ci95": self.interval,
        }


def ratios(before: Mapping[str, float], after: Mapping[str, float], runs: Runs) -> dict[str, float]:
    """Error after over error before, by kind of manoeuvre: of runs together, each by its samples."""
    found = {}
    for kind in sorted({kind for kind, _ in runs.values()}):
        of = {run: n for run, (own, n) in runs.items() if own == kind}
        found[kind] = sum(n * after[run] for run, n in of.items()) / sum(n * before[run] for run, n in of.items())
    return found


def relative(before: Mapping[str, float], after: Mapping[str, float], runs: Runs) -> float:
    """Mean over kinds of manoeuvre of their ``ratios``, each alike; 1 for no change.

    A kind that is worse counts by its loss once more: what one kind gains another must not pay.
    """
    found = np.array(list(ratios(before, after, runs).values()))
    return float(np.mean(found) + np.sum(np.maximum(found - 1.0, 0.0)))


def curve_of(parts: Sequence[Trained]) -> list[dict[str, float]]:
    """Score by step over the runs of all parts together."""
    alone = {run: value for one in parts for run, value in one.alone.items()}
    runs = {run: of for one in parts for run, of in one.runs.items()}
    found: list[dict[str, float]] = []
    if not all(one.curve for one in parts):  # stopped before all had begun
        return found
    for rows in zip(*(one.curve for one in parts), strict=False):  # as far as all have come
        errors = {run: row[run] for one, row in zip(parts, rows, strict=True) for run in one.runs}
        by_kind = ratios(alone, errors, runs)
        mean_loss = float(np.mean([row["loss"] for row in rows]))
        found.append({"step": rows[0]["step"], "loss": mean_loss, "score": relative(alone, errors, runs), **by_kind})
    return found


def gains_of(parts: Sequence[Trained], step: int, seed: int) -> list[Gain]:
    """The gain by kind of manoeuvre on runs not learned from, after so many updates."""
    rows = [next(row for row in one.curve if row["step"] == step) for one in parts]
    all_runs = [
        (kind, n, one.alone[run], row[run])
        for one, row in zip(parts, rows, strict=True)
        for run, (kind, n) in one.runs.items()
    ]
    found = []
    for kind in sorted({one[0] for one in all_runs}):
        n, before, after = np.array([one[1:] for one in all_runs if one[0] == kind]).T
        old, new = float(n @ before / n.sum()), float(n @ after / n.sum())
        share = partial(_share_gone, n * before, n * after)
        sure = interval_of(share, len(n), [seed, 6]) if len(n) > 2 else None
        found.append(Gain(kind, len(n), old, new, 1.0 - new / old, sure))
    return found


def _share_gone(before: FloatArray, after: FloatArray, drawn: IntArray) -> float:
    """Of errors (n_runs,), over the runs that were drawn."""
    return float(1.0 - after[drawn].sum() / before[drawn].sum())
