"""A prediction: particles through manoeuvres, the bands they make, and how well these hold what was measured."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..backends import STATES
from ..bands import IndexBand, Pooled, WindowScore, covariances, fan, index_band, pooled, widest
from ..displayed import Plotted, inert
from ..errors import OptionError, Problem, among, brief
from ..manoeuvres.named import BY_KEY
from ..options import PredictOptions
from ..phrases import counted
from ..predictor import Predictor
from ..profile import ShipProfile
from ..provenance import made_by
from ..trial import Trial
from ..units import DEG
from .asked import Approach, profile_behind
from .reading import Values

END = {
    "x": ("north", "m", 1.0),
    "y": ("east", "m", 1.0),
    "psi": ("heading", "deg", 1.0 / DEG),
    "u": ("speed", "m/s", 1.0),
}
"""States that a run ends with: words, the unit people read, the factor to it."""

MARKS = 60
"""Places along a track at which the region of positions is told."""


@dataclass(frozen=True, eq=False)
class Foretold:
    """One manoeuvre by all particles.

    words     what was ordered
    t         (n_samples,) [s]
    states    (n_particles, n_samples, 6) x, y [m], psi [rad], u, v_m [m/s], r [rad/s]
    diverged  (n_particles,) those that left the world of ships; their states mean nothing
    indices   of each particle, see ``reading``
    trial     that drove it, None where orders did; measured: its indices by the same keys
    approach  what it begins from, None where that is not known
    scores    of its windows
    """

    id: str
    manoeuvre: str
    words: str
    t: FloatArray
    states: FloatArray
    diverged: BoolArray
    indices: Values
    trial: Trial | None = None
    measured: Mapping[str, float] = field(default_factory=dict)
    scores: tuple[WindowScore, ...] = ()
    approach: Approach | None = None

    def __repr__(self) -> str:
        """In a line."""
        return f"Foretold({inert(self.id)}: {len(self.states)} particles, {self.t[-1]:g} s)"

    @cached_property
    def sound(self) -> FloatArray:
        """(n_sound, n_samples, 6) states of the particles that did not diverge."""
        return self.states[~self.diverged] if self.diverged.any() else self.states

    def band(self, variable: str, level: float) -> Mapping[str, FloatArray]:
        """mean, low, q25, median, q75, high (n_samples,) each of one of the states, in SI; nothing where all diverged.

        level  share that lies between low and high
        """
        if not len(self.sound):
            return {}
        return fan(self.sound[:, :, STATES.index(variable)], level)

    def index(self, key: str, level: float) -> IndexBand:
        """The band on an index, in the unit of its key."""
        return index_band(self.indices[key], level, endless=BY_KEY[key].endless)

    def end(self, level: float) -> list[dict[str, Any]]:
        """Bands on where the ship is at the last sample, from where she began; those that diverged count as unknown."""
        last = np.where(self.diverged[:, None], np.nan, self.states[:, -1])
        found = []
        for name, (words, unit, factor) in END.items():
            band = index_band(factor * last[:, STATES.index(name)], level, endless=False)
            found.append({"words": words, "unit": unit, **band.to_dict()})
        return found

    def marks(self) -> Iterator[dict[str, Any]]:
        """Mean position, its covariance and the heading at some times."""
        if not len(self.sound):
            return
        at = np.unique(np.linspace(0, len(self.t) - 1, min(MARKS, len(self.t))).round().astype(int))
        mean, covariance = covariances(self.sound[:, at, :3])
        for k, sample in enumerate(at):
            yield {
                "t": float(self.t[sample]),
                "x": float(mean[k, 0]),
                "y": float(mean[k, 1]),
                "psi": float(mean[k, 2]),
                "xx": float(covariance[k, 0, 0]),
                "xy": float(covariance[k, 0, 1]),
                "yy": float(covariance[k, 1, 1]),
            }


@dataclass(frozen=True, eq=False)
class Predicted(Plotted):
    """What a model foretells.

    name       what the model was called
    predictor  particles: its members
    drawn      whether they were drawn for this, by seed and sampling; else they are the members the model has
    sigma      spread of each state in the trials [SI], empty without trials
    notes      what to know, in sentences
    """

    written_by = "write_prediction"

    name: str
    predictor: Predictor
    runs: tuple[Foretold, ...]
    options: PredictOptions
    drawn: bool
    sigma: Mapping[str, float]
    notes: tuple[str, ...] = ()
    wall_s: float = 0.0

    def __repr__(self) -> str:
        """In a line."""
        shown = ", ".join(one.id for one in self.runs[:4]) + (" ..." if len(self.runs) > 4 else "")
        return inert(f"Predicted({self.name[-60:]}, {counted(self.predictor.n_members, 'particle')}: {shown})")

    def __getitem__(self, id: str) -> Foretold:
        """The run of that id.  Raises OptionError where there is none."""
        found = [one for one in self.runs if one.id == id]
        if not found:
            raise OptionError(Problem(f"no run {brief(id)}", "predicted", **among(id, [one.id for one in self.runs])))
        return found[0]

    @property
    def level(self) -> float:
        """Share that bands hold."""
        return self.options.level / 100.0

    @property
    def has_band(self) -> bool:
        """Whether there is more than one particle."""
        return self.predictor.n_members > 1

    @property
    def ship(self) -> ShipProfile | None:
        """The profile whose model it moves by, None of a network alone."""
        return profile_behind(self.predictor)

    @cached_property
    def score(self) -> Pooled | None:
        """Of all windows together; None without trials."""
        every = [one for run in self.runs for one in run.scores]
        return pooled(every, self.sigma) if every else None

    def to_dict(self, command: str = "") -> dict[str, Any]:
        """For JSON."""
        ship = self.ship
        return {
            "schema": 1,
            "kind": "predict",
            "model": {
                "name": self.name,
                "id": self.predictor.name,
                "method": self.predictor.method,
                "L_pp": self.predictor.L_pp,
                "sha256": ship.sha256 if ship else None,
            },
            "particles": self.predictor.n_members,
            "drawn": self.drawn,
            "has_band": self.has_band,
            "level": self.options.level,
            "widest": 100.0 * widest(self.predictor.n_members),
            "runs": [self._described(run) for run in self.runs],
            "scores": self.score.to_dict() if self.score else None,
            "sigma": dict(self.sigma),
            "notes": list(self.notes),
            "doubts": [one.to_dict() for one in ship.doubts()] if ship else [],
            "options": self.options.to_dict(),
            "provenance": made_by(command),
            "wall_s": self.wall_s,
        }

    def indices(self) -> dict[str, Any]:
        """The bands on indices alone, for JSON: what records of other commands hold of a prediction."""
        return {
            "level": self.options.level,
            "particles": self.predictor.n_members,
            "runs": [self._indexed(run) for run in self.runs],
        }

    def _indexed(self, run: Foretold) -> dict[str, Any]:
        return {
            "id": run.id,
            "manoeuvre": run.manoeuvre,
            "order": run.words,
            "approach": run.approach.to_dict() if run.approach else None,
            "duration_s": float(run.t[-1] - run.t[0]),
            "diverged": int(run.diverged.sum()),
            "indices": [self._index(run, key) for key in run.indices],
        }

    def _described(self, run: Foretold) -> dict[str, Any]:
        trial = run.trial
        return {
            **self._indexed(run),
            "end": run.end(self.level),
            "trial": {"source": trial.source, "sha256": trial.sha256} if trial else None,
            "windows": len(run.scores),
            "scores": pooled(run.scores, self.sigma).to_dict() if run.scores else None,
            "marks": list(run.marks()),
        }

    def _index(self, run: Foretold, key: str) -> dict[str, Any]:
        known, band = BY_KEY[key], run.index(key, self.level)
        measured = run.measured.get(key)
        L = self.predictor.L_pp
        lengths = None
        if known.unit == "m":
            lengths = {**band.times(1.0 / L).to_dict(), "measured": None if measured is None else measured / L}
        return {
            "index": key,
            "words": known.words,
            "unit": known.unit,
            **band.to_dict(),
            "measured": measured,
            "over_L": lengths,
        }
