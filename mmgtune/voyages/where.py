"""Where the error lives: cVDM and its parts by what the ship did and what was around her."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..documents import finite
from .drawing_anew import Draws
from .features import FEATURES, QUANTILES, Feature
from .table import WindowTable

FEWEST_WINDOWS = 20
"""Windows that know a feature below which nothing is said of it."""


@dataclass(frozen=True, eq=False)
class Bin:
    """Windows alike in one feature.

    low, high  ends of the bin in SI, open where infinite
    windows    how many; of these ``diverged``, which are in no mean
    mean, ci95, median  of cVDM [%]; the interval by drawing anew, None with too few groups
    parts      mean of each part of cVDM [%]
    """

    low: float
    high: float
    name: str
    windows: int
    diverged: int
    mean: float
    ci95: tuple[float, float] | None
    median: float
    parts: dict[str, float]

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "low": finite(self.low),
            "high": finite(self.high),
            "name": self.name,
            "windows": self.windows,
            "diverged": self.diverged,
            "cVDM_mean": finite(self.mean),
            "cVDM_ci95": list(self.ci95) if self.ci95 else None,
            "cVDM_median": finite(self.median),
            "parts": {name: finite(value) for name, value in self.parts.items()},
        }


@dataclass(frozen=True, eq=False)
class ByFeature:
    """One model's error by one feature.

    explained  share of the variance of log cVDM between the bins, less what chance alone gives that many bins
    """

    feature: Feature
    bins: tuple[Bin, ...]
    explained: float

    @property
    def worst(self) -> Bin:
        """The bin with the largest mean."""
        return max((one for one in self.bins if np.isfinite(one.mean)), key=lambda one: one.mean)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "feature": self.feature.name,
            "words": self.feature.words,
            "unit": self.feature.unit,
            "explained": finite(self.explained),
            "bins": [one.to_dict() for one in self.bins],
        }


def where_it_lives(table: WindowTable, model: str, draws: Draws) -> tuple[ByFeature, ...]:
    """The error of a model by every feature that the logs know, the one that tells most first."""
    found = [one for feature in FEATURES if (one := _by(table, model, feature, draws)) is not None]
    return tuple(sorted(found, key=lambda one: -one.explained))


def bins_of(feature: Feature, values: FloatArray) -> tuple[FloatArray, tuple[str, ...]]:
    """Edges of the bins of a feature (n_bins + 1,), open at both ends, and their names."""
    if feature.edges:
        inner = np.array(feature.edges)
    else:
        inner = np.unique(np.quantile(values, np.arange(1, QUANTILES) / QUANTILES))
        inner = inner[(inner > values.min()) & (inner <= values.max())]
    edges = np.concatenate([[-np.inf], inner, [np.inf]])
    return edges, feature.names or ("",) * (len(edges) - 1)


def explained(log: FloatArray, which: IntArray) -> float:
    """Share of the variance of values (n,) that lies between their bins (n,), adjusted for the number of bins.

    1 - (1 - eta^2) (n - 1) / (n - n_bins), as for a regression; never below 0.
    """
    total = float(np.sum((log - log.mean()) ** 2))
    bins = np.unique(which)
    if not total > 0.0 or len(bins) < 2 or len(log) <= len(bins):
        return 0.0
    inside = sum(float(np.sum((log[which == k] - log[which == k].mean()) ** 2)) for k in bins)
    return max(0.0, 1.0 - inside / total * (len(log) - 1) / (len(log) - len(bins)))


def _by(table: WindowTable, model: str, feature: Feature, draws: Draws) -> ByFeature | None:
    values, scored = table.features[feature.name], table.models[model]
    known = np.isfinite(values) & ~np.isnan(scored.cVDM)
    sound = known & np.isfinite(scored.cVDM)
    if sound.sum() < FEWEST_WINDOWS or not np.ptp(values[known]) > 0.0:
        return None
    edges, names = bins_of(feature, values[known])
    which = np.digitize(values, edges[1:-1])
    bins = [
        _bin(table, model, known & (which == k), draws, float(edges[k]), float(edges[k + 1]), names[k])
        for k in range(len(edges) - 1)
        if (known & (which == k)).any()
    ]
    positive = sound & (scored.cVDM > 0.0)
    return ByFeature(feature, tuple(bins), explained(np.log(scored.cVDM[positive]), which[positive].astype(np.int64)))


def _bin(table: WindowTable, model: str, some: BoolArray, draws: Draws, low: float, high: float, name: str) -> Bin:
    scored = table.models[model]
    sound = some & np.isfinite(scored.cVDM)
    mean, interval = draws.mean(scored.cVDM, sound)
    return Bin(
        low,
        high,
        name,
        int(some.sum()),
        int((some & ~sound).sum()),
        mean,
        interval,
        float(np.median(scored.cVDM[sound])) if sound.any() else float("nan"),
        {part: float(values[sound].mean()) if sound.any() else float("nan") for part, values in scored.parts.items()},
    )


def most_telling(found: Sequence[ByFeature]) -> ByFeature | None:
    """The feature that explains most; None where none is known."""
    return found[0] if found else None
