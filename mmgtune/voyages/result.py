"""What a validation on voyages found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..bands import Pooled
from ..displayed import Plotted
from ..documents import finite
from ..measures import UNITS
from ..options import VoyageOptions
from ..predictor import Predictor, profile_of
from ..trial import Cutting, Voyage
from .drawing_anew import Draws
from .features import FEATURES, MOVED
from .table import ModelTable, WindowTable
from .where import ByFeature, most_telling, where_it_lives

CLASSES = ("optimal", "satisfactory", "sub-optimal")
"""By cVDM, as Mathioudakis et al. call them; a window that diverged is sub-optimal."""

STOPPED = "Stopped before its end: this is of the windows scored by then."
"""What the verdict of a validation begins with that is not of all voyages."""

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
"""Of each measure that are told."""

ALL_MEASURES = tuple(UNITS)


@dataclass(frozen=True, eq=False)
class Log:
    """What became of one voyage.

    counted  rows, of what was read by the time it was stopped
    windows  scored
    at_rest  windows in which the ship hardly moved, left out
    sha256   of the file
    complete whether it was read to its end
    """

    voyage: Voyage
    counted: Cutting
    windows: int
    at_rest: int
    sha256: str
    complete: bool

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "id": self.voyage.id,
            "path": str(self.voyage.path),
            "sha256": self.sha256,
            "manoeuvre": self.voyage.manoeuvre,
            "source": self.voyage.source,
            "run": self.voyage.run,
            "hours": self.voyage.duration / 3600.0,
            "rows": self.voyage.n_rows,
            "rows_read": self.counted.rows,
            "rows_used": self.counted.used,
            "rows_with_gaps": self.counted.gaps,
            "rows_left_out": {str(reason): rows for reason, rows in self.counted.left_out.items()},
            "windows": self.windows,
            "windows_at_rest": self.at_rest,
            "complete": self.complete,
        }


@dataclass(frozen=True, eq=False)
class DrawnWindow:
    """A window to be looked at: its motion as measured and as every model has it.

    place     among the windows of the table
    role      "best", "median" or "worst" by cVDM of the first model
    t         (n_samples,) time [s]
    measured  (n_samples, 6), NaN in gaps
    delta     (n_samples,) rudder angle [rad]
    states    (n_samples, 6) by model
    """

    place: int
    role: str
    t: FloatArray
    measured: FloatArray
    delta: FloatArray
    states: Mapping[str, FloatArray]


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two models on the same windows, by cVDM.

    windows     in which neither diverged
    better      share of all windows in which the second is the better
    difference  mean of cVDM of the second less that of the first [%], with its interval by drawing anew
    """

    first: str
    second: str
    windows: int
    better: float
    difference: float
    ci95: tuple[float, float] | None

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "first": self.first,
            "second": self.second,
            "windows": self.windows,
            "share_second_better": finite(self.better),
            "cVDM_difference": finite(self.difference),
            "cVDM_difference_ci95": list(self.ci95) if self.ci95 else None,
        }


@dataclass(frozen=True, eq=False)
class VoyageValidation(Plotted):
    """Models scored on the windows of voyages.

    predictors  by what they were called
    trials      what the voyages were called
    table       all windows; None where there is none
    r_max, r_max_from  yaw rate that cVDM is relative to [rad/s], and where it comes from
    sigma, sigma_from  what L_MSE divides by [SI], and where it comes from
    drawn       windows to be looked at
    shorter     ids of files that are no voyages by themselves
    notes       on what was around the ship, by model
    bands       of models that have some, how well these hold windows evenly among all
    interrupted  stopped by the user; everything is of the windows scored by then
    """

    written_by = "write_voyages"

    predictors: Mapping[str, Predictor]
    trials: str
    logs: tuple[Log, ...]
    table: WindowTable | None
    r_max: float
    r_max_from: str
    sigma: Mapping[str, float]
    sigma_from: str
    drawn: tuple[DrawnWindow, ...]
    provenance: Mapping[str, Any]
    options: VoyageOptions = field(default_factory=VoyageOptions)
    shorter: tuple[str, ...] = ()
    n_logs: int = 0
    notes: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    bands: Mapping[str, Pooled] = field(default_factory=dict)
    interrupted: bool = False
    wall_s: float = 0.0

    def __repr__(self) -> str:
        """In a line."""
        stopped = ", interrupted" if self.interrupted else ""
        told = ", ".join(f"{name} {self.median(name):.3g}" for name in list(self.predictors)[:4])
        return f"VoyageValidation(on {self.trials[-60:]}: {self.n_windows} windows, median cVDM [%] of {told}{stopped})"

    @property
    def n_windows(self) -> int:
        """Windows scored."""
        return 0 if self.table is None else len(self.table)

    def median(self, model: str) -> float:
        """Median cVDM of a model [%]; NaN without windows."""
        if self.table is None:
            return float("nan")
        return float(np.nanquantile(self.table.models[model].cVDM, 0.5, method="lower"))

    def classes(self, model: str) -> dict[str, int]:
        """Windows of each class."""
        if self.table is None:
            return dict.fromkeys(CLASSES, 0)
        number = classed(self.table.models[model].cVDM, self.options.classes)
        return {name: int((number == k).sum()) for k, name in enumerate(CLASSES)}

    @cached_property
    def where(self) -> dict[str, tuple[ByFeature, ...]]:
        """Where the error lives, by model: features in the order of how much they tell."""
        if self.table is None:
            return {name: () for name in self.predictors}
        return {name: where_it_lives(self.table, name, self._draws) for name in self.predictors}

    @cached_property
    def comparisons(self) -> tuple[Comparison, ...]:
        """Every model against the first."""
        if self.table is None:
            return ()
        first, *others = self.predictors
        return tuple(self._compared(self.table, first, second) for second in others)

    @cached_property
    def drawn_anew(self) -> str:
        """What intervals draw anew: voyages, or hours of them where there are few."""
        return "" if self.table is None else self.table.groups(self._runs)[1]

    @property
    def _runs(self) -> list[str]:
        return [log.voyage.run for log in self.logs]

    @cached_property
    def _draws(self) -> Draws:
        assert self.table is not None
        return Draws(self.table.groups(self._runs)[0])

    def _compared(self, table: WindowTable, first: str, second: str) -> Comparison:
        one, other = table.models[first].cVDM, table.models[second].cVDM
        there = ~(np.isnan(one) | np.isnan(other))
        both = there & np.isfinite(one) & np.isfinite(other)
        gap = np.where(both, np.where(both, other, 0.0) - np.where(both, one, 0.0), 0.0)
        mean, interval = self._draws.mean(gap, both)
        better = float((other[there] < one[there]).mean()) if there.any() else float("nan")
        return Comparison(first, second, int(both.sum()), better, mean, interval)

    def sentence(self) -> str:
        """The answer in a sentence, after one that says so where it is not of all voyages."""
        return f"{STOPPED} {self._verdict()}" if self.interrupted else self._verdict()

    def _verdict(self) -> str:
        if self.table is None:
            return "No window could be scored."
        name = next(iter(self.predictors))
        counts, n = self.classes(name), self.n_windows
        shares = ", ".join(f"{100.0 * counts[key] / n:.0f} % {key}" for key in CLASSES)
        off = _distribution(self.table.models[name], "MED")["median"]
        where = "" if off is None else f"{off:.3g} m off track, "
        said = (
            f"{name}: {where}cVDM {self.median(name):.3g} % (medians of {n} windows of {self.options.window:g} s); "
            f"{shares}."
        )
        most = most_telling(self.where[name])
        if most is not None and most.explained >= 0.01:
            share = f"{100.0 * most.explained:.0f} % of the variance of log cVDM"
            said += f" The {most.feature.words} tells most of it: {share}."
        return said

    def to_dict(self) -> dict[str, Any]:
        """For JSON; numbers that do not exist or are infinite are null."""
        return {
            "schema": 1,
            "kind": "voyages",
            **self.provenance,
            "interrupted": self.interrupted,
            "verdict": self.sentence(),
            "options": self.options.to_dict(),
            "window_s": self.options.window,
            "gap_s": self.options.gap,
            "r_max": {"rad_per_s": finite(self.r_max), "from": self.r_max_from},
            "classes": {
                "names": list(CLASSES),
                "cVDM_limits": list(self.options.classes),
                "rudder_moves_from_rad": MOVED,
            },
            "sigma": {name: finite(value) for name, value in self.sigma.items()},
            "sigma_from": self.sigma_from,
            "integrator": self.options.integrator,
            "substeps": self.options.substeps,
            "drawn_anew": self.drawn_anew,
            "n_windows": self.n_windows,
            "n_logs": self.n_logs,
            "shorter": list(self.shorter),
            "logs": [log.to_dict() for log in self.logs],
            "models": [self._model(name, predictor) for name, predictor in self.predictors.items()],
            "comparisons": [one.to_dict() for one in self.comparisons],
            "drawn": [self._drawn(one) for one in self.drawn],
            "wall_s": self.wall_s,
        }

    def _model(self, name: str, predictor: Predictor) -> dict[str, Any]:
        profile = profile_of(predictor)
        found: dict[str, Any] = {
            "profile": name,
            "id": predictor.name,
            "sha256": profile.sha256 if profile else None,
            "method": predictor.method,
            "L_pp": predictor.L_pp,
            "notes": list(self.notes.get(name, ())),
            "doubts": [one.to_dict() for one in profile.doubts()] if profile else [],
        }
        if self.table is None:
            return found
        scored = self.table.models[name]
        parts = self.table.L_MSE_by_state(name, self.sigma)
        most = most_telling(self.where[name])
        return {
            **found,
            "classes": self.classes(name),
            "diverged": int(scored.diverged.sum()),
            "J": finite(float(scored.J.sum())),
            "L_MSE": finite(sum(parts.values())),
            "L_MSE_by_state": {key: finite(value) for key, value in parts.items()},
            "measures": {measure: _distribution(scored, measure) for measure in ALL_MEASURES},
            "cVDM_parts": {part: finite(_mean(values)) for part, values in scored.parts.items()},
            "tells_most": most.feature.name if most else None,
            "where": [one.to_dict() for one in self.where[name]],
            **({"bands": self.bands[name].to_dict()} if name in self.bands else {}),
        }

    def id_of(self, one: DrawnWindow) -> str:
        """What a window that is to be looked at is called: its voyage, and the second that it begins at."""
        assert self.table is not None  # there are no windows to look at without
        return str(self.table.ids[one.place])

    def _drawn(self, one: DrawnWindow) -> dict[str, Any]:
        assert self.table is not None
        return {
            "window": self.id_of(one),
            "role": one.role,
            "cVDM": {name: finite(float(model.cVDM[one.place])) for name, model in self.table.models.items()},
        }

    def columns(self) -> dict[str, Any]:
        """windows.parquet: a row for each window and model, SI units, cVDM and its parts in percent."""
        table = self.table
        names = list(self.predictors)
        if table is None:
            return {}
        n = len(table)
        ids = np.array([log.voyage.id for log in self.logs], dtype=object)

        def repeated(values: Any) -> Any:
            return np.tile(values, len(names))

        found: dict[str, Any] = {
            "window": repeated(np.array(table.ids, dtype=object)),
            "voyage": repeated(ids[table.voyage]),
            "model": np.repeat(np.array(names, dtype=object), n),
            "row": repeated(table.row),
            "n_samples": repeated(table.n_samples),
            "begins": repeated(table.begins),
            "duration": repeated(table.duration),
        }
        kept = [*(one.name for one in FEATURES), "path", "yaw_rate_largest"]
        found.update({name: repeated(table.features[name]) for name in kept})
        found["rudder_moves"] = repeated(table.features["rudder_range"] >= MOVED)
        models = [table.models[name] for name in names]
        for measure in ALL_MEASURES:
            found[measure] = np.concatenate([one.measures[measure] for one in models])
        for part in models[0].parts:
            found[f"cVDM_{part}"] = np.concatenate([one.parts[part] for one in models])
        found["J"] = np.concatenate([one.J for one in models])
        found["L_MSE"] = np.concatenate([table.L_MSE_each(name, self.sigma) for name in names])
        labels = np.array([*CLASSES, ""], dtype=object)
        found["class"] = np.concatenate([labels[classed(one.cVDM, self.options.classes)] for one in models])
        found["diverged"] = np.concatenate([one.diverged for one in models])
        return found


def classed(cVDM: FloatArray, limits: Sequence[float]) -> Any:
    """(n_windows,) which of CLASSES each window is of; -1 where it has no cVDM."""
    found = np.digitize(np.nan_to_num(cVDM, nan=0.0, posinf=np.inf), limits, right=True)
    return np.where(np.isnan(cVDM), -1, found)


def _distribution(scored: ModelTable, measure: str) -> dict[str, Any]:
    """Mean over windows that did not diverge, and quantiles over all."""
    values = scored.measures[measure]
    there = values[~np.isnan(values)]
    found: dict[str, Any] = {"unit": UNITS[measure], "mean": finite(_mean(values))}
    for share in QUANTILES:
        key = "median" if share == 0.5 else f"q{100.0 * share:02.0f}"
        found[key] = finite(float(np.quantile(there, share, method="lower"))) if len(there) else None
    return found


def _mean(values: FloatArray) -> float:
    some: BoolArray = np.isfinite(values)
    return float(values[some].mean()) if some.any() else float("nan")
