"""A predictor held against trials: one record per trial and member, which everything that judges a model reads.

Gaps have one rule: each sample of each channel after the first counts where it was measured, whatever the other
channels did.  J, the squares behind L_MSE, and the root mean squares all follow it.  The seven distance measures mix
the channels of a sample and need complete ones; indices need a record that ``motions.track_of`` can bridge the gaps of.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import NoneType
from typing import Any

import numpy as np

from .arguments import ShipGiven, TrialsGiven, some_of
from .arrays import FloatArray
from .backends import STATES, Integrator
from .displayed import Plotted, inert
from .errors import TrialError, must_be_a
from .manoeuvres import Track, manoeuvre_kind, turning_indices, zigzag_indices
from .manoeuvres.summary import indices_of
from .measures import UNITS, Reference, distance_measures, reference_of
from .model import Model
from .motions import Motion, motions, order_of, ordered_angles, sized, track_if_whole, trial_indices
from .networks import named_ship
from .objective import Objective, make_objective, weights_of
from .predictor import Predictor, as_predictor
from .trial import Trial


@dataclass(frozen=True, eq=False)
class Measured:
    """A trial, and what is computed of it once for all members.

    L_pp    [m]
    weight  (n_samples, 6) of each squared residual in J
    """

    trial: Trial
    L_pp: float
    weight: FloatArray

    def __repr__(self) -> str:
        """In a line."""
        return f"Measured({self.trial!r}, L_pp {self.L_pp:g})"

    @cached_property
    def motion(self) -> FloatArray:
        """(n_samples, 6) as measured, NaN in gaps."""
        return self.trial.motion

    @cached_property
    def counted(self) -> FloatArray:
        """(n_samples, 6) 1 where a sample of a channel counts, else 0: measured, and not the first."""
        counts = np.isfinite(self.motion).astype(float)
        counts[0] = 0.0
        return counts

    @cached_property
    def reference(self) -> Reference | None:
        """What cVDM is relative to; None for a ship at rest, or one that has no two complete samples."""
        with contextlib.suppress(TrialError):
            return reference_of(self.motion)
        return None

    @cached_property
    def track(self) -> Track | None:
        """The record indices are computed from; None where there is none, see ``track_if_whole``."""
        return track_if_whole(self.trial)

    @cached_property
    def kind(self) -> str:
        """Which manoeuvre it shows: "turning", "zigzag" or "other"."""
        return manoeuvre_kind(self.track) if self.track else "other"

    @cached_property
    def indices(self) -> dict[str, Any]:
        """Manoeuvring indices by names with their unit; empty where there are none."""
        return trial_indices(self.trial, self.L_pp)

    @property
    def order(self) -> dict[str, Any]:
        """What a turn or a zigzag ordered, by names of indices, also over a gap; empty of other manoeuvres."""
        return order_of(self.trial, self.L_pp)

    @cached_property
    def nominal(self) -> tuple[float, float | None] | None:
        """Rudder and heading angle [rad] a zigzag is named by; None for another manoeuvre."""
        if self.track is None or self.kind != "zigzag":
            return None
        zigzag = zigzag_indices(self.track, self.L_pp, ordered_angles(self.trial))
        return zigzag.rudder_angle, zigzag.heading_angle

    def indices_of(self, simulated: Track) -> dict[str, Any]:
        """Indices of a simulation, read as the manoeuvre that was measured; empty where it does not show that one."""
        try:
            if self.kind == "turning":
                return turning_indices(simulated, self.L_pp).to_dict()
            if self.kind == "zigzag":
                return zigzag_indices(simulated, self.L_pp, self.nominal).to_dict()
            return indices_of(simulated, self.L_pp)
        except TrialError:  # the model turns to no side
            return {}


@dataclass(frozen=True, eq=False)
class TrialRecord(Plotted):
    """One member on one trial, or on one window of it.  What costs time is computed when it is first asked for.

    measured   the trial
    motion     what the member made of it
    method     how it was simulated, to be named beside J
    """

    measured: Measured
    motion: Motion
    method: str

    def __repr__(self) -> str:
        """In a line."""
        member = f", member {self.member}" if self.member else ""
        result = "diverged" if self.diverged else f"J {self.J:.4g}"
        return f"TrialRecord({inert(self.trial.id)}{member}: {result})"

    @property
    def trial(self) -> Trial:
        """The trial."""
        return self.measured.trial

    @property
    def member(self) -> int:
        """Of the predictor, from 0."""
        return self.motion.member

    @property
    def states(self) -> FloatArray:
        """(n_samples, 6) as simulated."""
        return self.motion.states

    @property
    def diverged(self) -> bool:
        """Whether the simulation left the world of ships."""
        return self.motion.diverged

    @cached_property
    def residuals(self) -> FloatArray:
        """(n_samples, 6) simulated less measured in SI units; NaN in gaps, inf throughout where it diverged."""
        measured = self.measured.motion
        if self.diverged:
            return np.where(np.isnan(measured), np.nan, np.inf)
        return np.asarray(self.states - measured)

    @property
    def squares(self) -> dict[str, float]:
        """Sum of squared residuals that count, by state, in SI units."""
        return dict(zip(STATES, self._sums(self.measured.counted).tolist(), strict=True))

    @property
    def counts(self) -> dict[str, int]:
        """Number of samples that count, by state."""
        return dict(zip(STATES, self.measured.counted.sum(axis=0).astype(int).tolist(), strict=True))

    @cached_property
    def J(self) -> float:
        """Sum of squared residuals, each with the weight of its objective; inf where it diverged."""
        return float(self._sums(self.measured.weight).sum())

    @cached_property
    def rms(self) -> dict[str, float]:
        """Root mean square of the residuals by state, in SI units; states never measured are left out."""
        counts = self.counts
        return {name: float(np.sqrt(total / counts[name])) for name, total in self.squares.items() if counts[name]}

    @cached_property
    def measures(self) -> dict[str, float]:
        """The seven distance measures; empty where they do not exist, infinite where it diverged."""
        if self.measured.reference is None:
            return {}
        if self.diverged or not np.isfinite(self.states).all():
            return dict.fromkeys(UNITS, np.inf)
        return distance_measures(self.measured.motion, self.states, self.measured.reference)

    @cached_property
    def indices(self) -> dict[str, Any]:
        """Manoeuvring indices as simulated; empty where there are none, and where it diverged."""
        if self.diverged or not np.isfinite(self.states).all():
            return {}
        return self.measured.indices_of(self.motion.track())

    @cached_property
    def _counted(self) -> FloatArray:
        """(n_samples, 6) residuals where they count, 0 where they do not and may be anything."""
        return np.where(self.measured.counted > 0.0, self.residuals, 0.0)

    def _sums(self, weight: FloatArray) -> FloatArray:
        """(6,) sums of weighted squares; no weight may stand where nothing counts."""
        counted = self._counted
        if self.diverged:  # infinite, and a weight of 0 leaves it out
            counted = np.where(weight > 0.0, counted, 0.0)
        with np.errstate(over="ignore"):
            return np.asarray(np.einsum("ij,ij,ij->j", weight, counted, counted))


def evaluate(
    ship: ShipGiven | Model | Predictor,
    trials: TrialsGiven,
    objective: Objective | None = None,
    *,
    theta: FloatArray | None = None,
    integrator: Integrator = Integrator(),
    backend: str = "compiled",
    offsets: FloatArray | None = None,
) -> tuple[TrialRecord, ...]:
    """Every member on every trial, with its measured inputs from its first measured state.

    ship, trials  objects, paths or bundled names; ``ship`` may be any predictor, ``trials`` a list of trials
    objective  what J counts, the paper's where None
    theta      (n_rows, n_members) coefficients of a profile or model, its own where None
    offsets    (n_trials, 6) added to the first measured states, where these are estimated
    -> trial by trial, and of each all members

    Gaps: each sample of each channel after the first counts where it was measured.
    Raises TrialError where there are no trials, OptionError where window or gaps leave a trial without a sample to
    compare; never for a run that diverges.
    """
    predictor = as_predictor(named_ship(ship, integrator), theta=theta, integrator=integrator, backend=backend)
    must_be_a(objective, (Objective, NoneType), "objective")
    return tuple(records(predictor, some_of(trials), objective, offsets=offsets))


def records(
    predictor: Predictor,
    trials: Sequence[Trial],
    objective: Objective | None = None,
    *,
    offsets: FloatArray | None = None,
) -> Iterator[TrialRecord]:
    """As ``evaluate``, one record after the other: who keeps numbers only never holds the states of all trials."""
    if offsets is not None:
        offsets = sized(offsets, "offsets", (len(trials), len(STATES)), "each trial has its own first state")
    chosen = make_objective(predictor.L_pp) if objective is None else objective
    about: Measured | None = None
    for k, motion in enumerate(motions(predictor, trials, offsets)):
        if about is None or motion.member == 0:
            trial = trials[k // predictor.n_members]
            about = Measured(trial, predictor.L_pp, weights_of([trial], chosen)[0])
        yield TrialRecord(about, motion, predictor.method)
