"""What every simulator takes and gives: cases, an integrator, a result per case and candidate."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Protocol

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..model import Model
from ..physics.quantities import STATES, Surroundings

SPEED_LIMIT = 1e3
"""Speed [m/s] beyond which a lane counts as diverged, far above any ship and far below overflow."""


@dataclass(frozen=True, eq=False)
class Cases:
    """Runs to simulate, of different length, padded at the end to the longest.

    t          (n_cases, T) time [s]; padding repeats the last
    n_samples  (n_cases,) samples that count
    controls   (n_cases, T, n_inputs) logged inputs, in the order of the model's arrangement
    around     (n_cases, T, n_surroundings) surroundings, in the order of ``Surroundings``
    initial    (n_cases, 6) state at the first sample, as the sensors show it
    target     (n_cases, T, 6) what the motion is compared with; 0 where there is nothing
    weight     (n_cases, T, 6) weight of each squared difference in the cost; 0 where there is nothing, and at the first
               sample, where a simulation begins
    """

    t: FloatArray
    n_samples: IntArray
    controls: FloatArray
    around: FloatArray
    initial: FloatArray
    target: FloatArray
    weight: FloatArray

    def __post_init__(self) -> None:
        """Raises ValueError where the first sample counts, where no simulation can differ, or a weight is no size."""
        if not np.all((self.weight >= 0.0) & (self.weight < np.inf)):
            raise ValueError("weights that are negative, infinite or no numbers")
        if self.weight[:, 0].any():
            raise ValueError("weights at the first sample, which is where simulations begin")

    def __len__(self) -> int:
        return len(self.t)

    @cached_property
    def sha256(self) -> str:
        """Of all of it."""
        found = hashlib.sha256()
        for one in fields(self):
            found.update(np.asarray(getattr(self, one.name)).tobytes())
        return found.hexdigest()

    @property
    def steps(self) -> int:
        """Steps of all cases together."""
        return int(np.sum(self.n_samples - 1))

    @cached_property
    def rows(self) -> IntArray:
        """(n_cases, T, 6) place of each difference that counts among all residuals, -1 where none counts."""
        counts = self.weight > 0.0
        rows = np.full(counts.shape, -1, dtype=np.int64)
        rows[counts] = np.arange(int(counts.sum()))
        return rows

    @cached_property
    def n_residuals(self) -> int:
        """Number of differences that count."""
        return int(self.rows.max(initial=-1)) + 1


def pad(
    times: Sequence[FloatArray],
    controls: Sequence[FloatArray],
    initial: Sequence[FloatArray],
    target: Sequence[FloatArray] | None = None,
    weight: Sequence[FloatArray] | None = None,
    around: Iterable[FloatArray] | None = None,
) -> Cases:
    """Cases out of runs: times (n_i,), controls (n_i, n_inputs), initial (6,), target and weight (n_i, 6), around
    (n_i, n_surroundings); nothing counts where target and weight are None, nothing was measured where around is."""
    n_samples = np.array([len(t) for t in times], dtype=np.int64)
    T = int(n_samples.max(initial=1))

    def padded(columns: Iterable[FloatArray] | None, width: int, *, hold: bool) -> FloatArray:
        """(n_cases, T, width), after the end of a run its last row or 0."""
        whole = np.zeros((len(times), T, width))
        for into, n, values in zip(whole, n_samples, columns or (), strict=columns is not None):
            into[:n] = values
            into[n:] = values[-1] if hold else 0.0
        return whole

    return Cases(
        t=padded([t[:, None] for t in times], 1, hold=True)[:, :, 0],
        n_samples=n_samples,
        controls=padded(controls, controls[0].shape[1] if len(controls) else 0, hold=True),
        around=padded(around, len(Surroundings._fields), hold=True),
        initial=np.array(initial, dtype=float).reshape(-1, len(STATES)),
        target=padded(target if weight is not None else None, len(STATES), hold=False),
        weight=padded(weight if target is not None else None, len(STATES), hold=False),
    )


@dataclass(frozen=True)
class Integrator:
    """A fixed-step method in which each stage needs only the one before.

    name      "rk4", "heun" (half the work, of second order), or "euler" (the paper's)
    substeps  steps between two samples; inputs are interpolated linearly where the method looks between samples
    """

    name: str = "rk4"
    substeps: int = 1

    def __post_init__(self) -> None:
        """Raises ValueError for an unknown name or a count of substeps that is none."""
        if self.name not in ("euler", "heun", "rk4") or self.substeps != int(self.substeps) or self.substeps < 1:
            raise ValueError(f"no integrator '{self.name}' with {self.substeps} substeps")

    @property
    def tableau(self) -> tuple[FloatArray, FloatArray]:
        """Position of each stage within the step, and its share in the result: (n_stages,) each."""
        if self.name == "rk4":
            return np.array([0.0, 0.5, 0.5, 1.0]), np.array([1.0, 2.0, 2.0, 1.0]) / 6.0
        if self.name == "heun":
            return np.array([0.0, 1.0]), np.array([0.5, 0.5])
        return np.array([0.0]), np.array([1.0])


@dataclass(frozen=True, eq=False)
class LaneResult:
    """What came out, per case and candidate.

    cost      (n_cases, n_candidates) sum of weight * (state - target)^2; inf where diverged
    diverged  (n_cases, n_candidates) bool
    states    (n_cases, n_candidates, T, 6) as the sensors show them, of no sample unless asked for; after the end of a
              case the last
    residuals (n_residuals, n_candidates) root of weight * (state - target), no rows unless asked for; by case, sample
              and channel; cost is the sum of their squares
    """

    cost: FloatArray
    diverged: BoolArray
    states: FloatArray
    residuals: FloatArray


def lanes_of(theta: FloatArray, n_cases: int, paired: bool) -> FloatArray:
    """Coefficients of every lane (n_rows, n_cases * n_candidates), candidates of a case side by side."""
    if theta.ndim == 3:
        return theta.reshape(len(theta), -1)
    return theta if paired else np.tile(theta, n_cases)


class Backend(Protocol):
    """A way to evaluate the equations on lanes."""

    name: str

    def run(
        self,
        model: Model,
        theta: FloatArray,
        cases: Cases,
        *,
        initial: FloatArray | None = None,
        integrator: Integrator = Integrator(),
        keep_states: bool = False,
        keep_residuals: bool = False,
        paired: bool = False,
    ) -> LaneResult:
        """Simulate every case with every candidate, or, ``paired``, each with its own.

        theta (n_rows, n_candidates), or (n_rows, n_cases, n_candidates) where candidates differ from case to case;
        initial (n_cases, n_candidates, 6), the cases' own where None.
        Paired, theta is (n_rows, n_cases), a column to a case, and everything else is as with one candidate.
        A lane that diverges has infinite cost; it never raises and never touches other lanes.
        """
        ...


def finish(
    cost: FloatArray,
    fastest2: FloatArray,
    last: FloatArray,
    states: FloatArray | None,
    residuals: FloatArray | None,
) -> LaneResult:
    """The result, with diverged lanes marked; last (n_cases, n_candidates, 6), fastest2 squared speed [m^2/s^2].

    states, residuals  None where they were not asked for
    """
    with np.errstate(invalid="ignore"):
        sound = np.isfinite(last).all(axis=-1) & np.isfinite(cost) & (fastest2 < SPEED_LIMIT**2)
    return LaneResult(
        np.where(sound, cost, np.inf),
        ~sound,
        np.empty((*cost.shape, 0, len(STATES))) if states is None else states,
        np.empty((0, cost.shape[1])) if residuals is None else residuals,
    )
