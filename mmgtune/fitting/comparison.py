"""Every trial against the model before and after tuning: J, errors by channel, manoeuvring indices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends import STATES
from ..manoeuvres.summary import indices_of
from ..simulation import Motion, trial_indices
from ..trial import Trial
from .least_squares import fit_offsets
from .problem import FitProblem


@dataclass(frozen=True, eq=False)
class TrialComparison:
    """One trial; ``role`` is "tune", "test" or "other"."""

    trial: Trial
    role: str
    J: dict[str, float]  # "before", "after"
    motions: dict[str, Motion]
    rms: dict[str, dict[str, float]]  # channel -> before, after [SI]
    indices: dict[str, dict[str, Any]]  # "measured", "before", "after"

    def __repr__(self) -> str:
        """In a line."""
        return f"TrialComparison({self.trial.id}, {self.role}: J {self.J['before']:.4g} -> {self.J['after']:.4g})"

    def to_dict(self) -> dict[str, Any]:
        """For JSON; a J that is not finite becomes null."""
        return {
            "id": self.trial.id,
            "role": self.role,
            "manoeuvre": self.trial.manoeuvre,
            "source": self.trial.source,
            "n_samples": self.trial.n_samples,
            "J_before": finite(self.J["before"]),
            "J_after": finite(self.J["after"]),
            "status_before": "diverged" if self.motions["before"].diverged else "ok",
            "status_after": "diverged" if self.motions["after"].diverged else "ok",
            "rms": {
                channel: {which: finite(value) for which, value in errors.items()}
                for channel, errors in self.rms.items()
            },
            "indices": self.indices,
        }


def compare(
    problem: FitProblem, trials: Sequence[Trial], roles: Mapping[str, str], before: FloatArray, after: FloatArray
) -> list[TrialComparison]:
    """Simulate every trial with the coefficients at two positions (n_targets,) of the unit cube.

    problem  over all of ``trials``, in their order; where it estimates initial states, each trial gets its own
    """
    unit = np.column_stack([before, after])
    offsets = None
    if problem.sigma is not None:
        offsets = np.stack([fit_offsets(problem, before), fit_offsets(problem, after)], axis=1)
    result = problem.backend.run(
        problem.model,
        problem.theta(unit),
        problem.cases,
        initial=problem.initial(2, offsets),
        integrator=problem.integrator,
        keep_states=True,
    )
    assert result.states is not None  # asked for
    compared = []
    for i, trial in enumerate(trials):
        motions: dict[str, Motion] = {}
        rms: dict[str, dict[str, float]] = {channel: {} for channel in STATES}
        for k, which in enumerate(("before", "after")):
            states = result.states[i, k, : trial.n_samples]
            controls = np.column_stack([trial.n, trial.delta])
            motions[which] = Motion(trial.id, trial.t, states, controls, bool(result.diverged[i, k]))
            with np.errstate(all="ignore"):
                error = np.sqrt(np.nanmean((states - trial.motion) ** 2, axis=0))
            for channel, value in zip(STATES, error, strict=True):
                rms[channel][which] = float(value) if not result.diverged[i, k] else float("nan")
        L_pp = problem.model.L_pp
        indices = {"measured": trial_indices(trial, L_pp)}
        for which, motion in motions.items():
            indices[which] = {} if motion.diverged else indices_of(motion.track(), L_pp)
        J = {"before": float(result.cost[i, 0]), "after": float(result.cost[i, 1])}
        compared.append(TrialComparison(trial, roles[trial.id], J, motions, rms, indices))
    return compared


def total(compared: Sequence[TrialComparison], role: str, which: str) -> float | None:
    """J over the trials of one role, None where there are none."""
    values = [c.J[which] for c in compared if c.role == role]
    return float(sum(values)) if values else None


def finite(value: float | None) -> float | None:
    """The number, or None where JSON has no word for it."""
    return value if value is not None and np.isfinite(value) else None
