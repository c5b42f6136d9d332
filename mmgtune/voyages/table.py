"""Everything known of the windows of all voyages: one row each, in the order they were cut."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..measures import cvdm_parts
from .scores import SIX, Scores

HOUR = 3600.0
FEW_RUNS = 6
"""Runs below which hours are drawn anew in place of runs: too few runs say nothing of their spread."""
MOST_GROUPS = 2000
"""Groups that are drawn anew at most; beyond, each is several hours long."""


@dataclass(frozen=True, eq=False)
class ModelTable:
    """One model on all windows, (n_windows,) and more each; see ``Scores``.

    parts  of cVDM [%], by part; cVDM is their sum
    """

    diverged: BoolArray
    measures: dict[str, FloatArray]
    mean: FloatArray
    squares: FloatArray
    J: FloatArray
    parts: dict[str, FloatArray]

    @property
    def cVDM(self) -> FloatArray:
        """[%]; infinite where it diverged."""
        return self.measures["cVDM"]


@dataclass(frozen=True, eq=False)
class WindowTable:
    """All windows and the models on them.

    ids      of windows, "name@seconds"
    voyage   (n_windows,) which of the voyages each is of
    row      first row in its file
    n_samples, begins, duration  of each; begins [s] in its file's time
    features by name, see ``features.FEATURES``; also "path" [m] and "yaw_rate_largest" [rad/s]
    counts   (n_windows, 6) samples of each state that count
    models   by name
    """

    ids: tuple[str, ...]
    voyage: IntArray
    row: IntArray
    n_samples: IntArray
    begins: FloatArray
    duration: FloatArray
    features: dict[str, FloatArray]
    counts: FloatArray
    models: dict[str, ModelTable]

    def __len__(self) -> int:
        return len(self.ids)

    def groups(self, runs: Sequence[str]) -> tuple[IntArray, str]:
        """Which windows are drawn anew together, (n_windows,), and what they are: "voyages" or "hours".

        runs  of each voyage: what was sailed in one go
        Windows that follow each other are alike, so never a window alone is drawn.
        """
        names = list(dict.fromkeys(runs[k] for k in np.unique(self.voyage)))
        number = np.array([names.index(run) if run in names else -1 for run in runs], dtype=np.int64)
        if len(names) >= FEW_RUNS:
            return number[self.voyage], "voyages"
        hours = 1.0
        total = float(self.duration.sum()) / HOUR
        while total / hours > MOST_GROUPS:
            hours *= 2.0
        keys = np.stack([self.voyage, np.floor(self.begins / (hours * HOUR)).astype(np.int64)], axis=1)
        _, found = np.unique(keys, axis=0, return_inverse=True)
        return np.asarray(found, dtype=np.int64).reshape(-1), "hours" if hours == 1.0 else f"stretches of {hours:g} h"

    def L_MSE(self, model: str, sigma: Mapping[str, float]) -> float:
        """The standardised error over all windows; NaN where a state has no spread."""
        return sum(self.L_MSE_by_state(model, sigma).values())

    def L_MSE_by_state(self, model: str, sigma: Mapping[str, float]) -> dict[str, float]:
        """Its parts: the mean over all samples of each state that was measured."""
        squares, counts = self.models[model].squares.sum(axis=0), self.counts.sum(axis=0)
        return {
            name: float(squares[k] / counts[k] / value**2) if value > 0.0 else np.nan
            for k, (name, value) in enumerate(sigma.items())
            if counts[k] > 0
        }

    def L_MSE_each(self, model: str, sigma: Mapping[str, float]) -> FloatArray:
        """(n_windows,) the standardised error of each window by itself."""
        scale = np.array([value**2 if value > 0.0 else np.nan for value in sigma.values()])
        with np.errstate(invalid="ignore", divide="ignore"):
            share = self.models[model].squares / self.counts / scale
        found: FloatArray = np.where(self.counts > 0, share, 0.0).sum(axis=1)
        return found


@dataclass(eq=False)
class Gathered:
    """Windows as they come, portion by portion."""

    ids: list[str] = field(default_factory=list)
    about: list[tuple[int, int, int, float, float]] = field(default_factory=list)
    features: list[dict[str, FloatArray]] = field(default_factory=list)
    counts: list[FloatArray] = field(default_factory=list)
    scores: dict[str, list[Scores]] = field(default_factory=dict)

    def add(self, more: Gathered) -> None:
        """Windows of another voyage behind these."""
        self.ids += more.ids
        self.about += more.about
        self.features += more.features
        self.counts += more.counts
        for name, scores in more.scores.items():
            self.scores.setdefault(name, []).extend(scores)

    def table(self, r_max: float) -> WindowTable:
        """What came, with cVDM relative to ``r_max`` [rad/s]."""
        features = {name: np.concatenate([one[name] for one in self.features]) for name in self.features[0]}
        voyage, row, n_samples, begins, duration = (np.array(column) for column in zip(*self.about, strict=True))

        def model(of: Sequence[Scores]) -> ModelTable:
            mean = np.concatenate([one.mean for one in of])
            parts = cvdm_parts(mean, features["path"], features["speed"], r_max)
            measures = {name: np.concatenate([one.measures[name] for one in of]) for name in SIX}
            return ModelTable(
                np.concatenate([one.diverged for one in of]),
                {**measures, "cVDM": np.sum(list(parts.values()), axis=0)},
                mean,
                np.concatenate([one.squares for one in of]),
                np.concatenate([one.J for one in of]),
                parts,
            )

        return WindowTable(
            tuple(self.ids),
            voyage.astype(np.int64),
            row.astype(np.int64),
            n_samples.astype(np.int64),
            begins.astype(float),
            duration.astype(float),
            features=features,
            counts=np.concatenate(self.counts),
            models={name: model(of) for name, of in self.scores.items()},
        )
