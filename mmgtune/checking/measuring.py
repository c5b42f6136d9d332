"""The metrics of trials: how far a model is from each, in the numbers people judge by."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..backends import STATES, Integrator, get_backend
from ..errors import TrialError
from ..manoeuvres import Track, manoeuvre_kind, turning_indices, zigzag_indices
from ..measures import UNITS, Reference, distance_measures, reference_of
from ..metrics import METRICS, RELATIVE
from ..model import Model
from ..objective import cases_of, default_scales, make_objective
from ..simulation import track_if_whole
from ..trial import Trial
from ..units import DEG

Values = dict[str, float]
"""Metrics of one trial by name; inf where the simulation diverged, absent where the trial does not show them."""


def measure(
    model: Model,
    trials: Sequence[Trial],
    names: Sequence[str],
    *,
    theta: FloatArray | None = None,
    integrator: Integrator = Integrator(),
    backend: str = "compiled",
) -> list[dict[str, Values]]:
    """Metrics of each candidate on each trial, simulated from its first measured state with its measured inputs.

    names  of METRICS
    theta  (n_rows, n_candidates) coefficients; those of the profile alone where None
    -> for each candidate, by trial and metric
    """
    theta = model.matrix() if theta is None else theta
    cases = cases_of(trials, make_objective(model.L_pp), model.inputs)
    result = get_backend(backend).run(model, theta, cases, integrator=integrator, keep_states=True)
    assert result.states is not None  # asked for
    found: list[dict[str, Values]] = [{} for _ in range(theta.shape[1])]
    for i, trial in enumerate(trials):
        measured = _Measured(trial, model.L_pp)
        for k, by_trial in enumerate(found):
            states = None if result.diverged[i, k] else result.states[i, k, : trial.n_samples]
            values = {"J": float(result.cost[i, k]), **measured.against(states)}
            by_trial[trial.id] = {name: values[name] for name in names if name in values}
    return found


def floors(L_pp: float) -> dict[str, float]:
    """Absolute change of each metric that never matters, in its unit, for a ship of this length [m]."""
    scales = default_scales(L_pp)
    of = {"": 1.0, "length": L_pp, "speed": scales["u"], "turning": scales["r"] / DEG}
    return {name: metric.floor * of[metric.of] for name, metric in METRICS.items()}


def default_tolerances(names: Sequence[str], L_pp: float) -> dict[str, dict[str, float]]:
    """For each metric: share of its baseline value, and absolute change, it may get worse by."""
    absolute = floors(L_pp)
    return {name: {"relative": RELATIVE, "absolute": float(f"{absolute[name]:.3g}")} for name in names}


class _Measured:
    """A trial, and what is computed of it once for all candidates."""

    def __init__(self, trial: Trial, L_pp: float):
        self.trial = trial
        self.L_pp = L_pp
        self.whole = np.isfinite(trial.motion[1:]).all(axis=1)
        self.reference: Reference | None = None
        with contextlib.suppress(ValueError):  # a ship at rest, or never a complete sample
            self.reference = reference_of(trial.motion)
        self.track = track_if_whole(trial)
        self.kind = manoeuvre_kind(self.track) if self.track else "other"
        self.nominal: tuple[float, float | None] = (0.0, None)
        self.indices: Values = {}
        if self.track and self.kind == "turning":
            self.indices = _turning(self.track, L_pp)
        elif self.track and self.kind == "zigzag":
            zigzag = zigzag_indices(self.track, L_pp)
            self.nominal = zigzag.rudder_angle, zigzag.heading_angle
            self.indices = _overshoots(zigzag.overshoot)

    def against(self, states: FloatArray | None) -> Values:
        """All metrics this trial has but J, of simulated states (n_samples, 6); all infinite where they are None."""
        if states is None:
            states = np.full_like(self.trial.motion, np.inf)
        with np.errstate(all="ignore"):
            values = self._channels(states) | self._distances(states) | self._indices(states)
        return {name: value if math.isfinite(value) else math.inf for name, value in values.items()}

    def _channels(self, states: FloatArray) -> Values:
        difference = (states - self.trial.motion)[1:]
        counts = np.isfinite(self.trial.motion[1:])
        squares = np.where(counts, difference**2, 0.0).sum(axis=0)
        found = {}
        for state, total, n in zip(STATES, squares.tolist(), counts.sum(axis=0).tolist(), strict=True):
            if n:
                name = "rms_v" if state == "v_m" else f"rms_{state}"
                found[name] = math.sqrt(total / n) / (DEG if state in ("psi", "r") else 1.0)
        return found

    def _distances(self, states: FloatArray) -> Values:
        if self.reference is None or not self.whole.any():
            return {}
        if not np.isfinite(states).all():
            return dict.fromkeys(UNITS, math.inf)
        return distance_measures(self.trial.motion, states, self.reference)

    def _indices(self, states: FloatArray) -> Values:
        """Errors of indices; what the simulation does not reach within the trial is as wrong as can be."""
        if not self.indices or self.track is None:
            return {}
        simulated: Values = {}
        if np.isfinite(states).all():
            columns = dict(zip(STATES, states.T, strict=True))
            try:
                track = replace(self.track, **columns)
                simulated = (
                    _turning(track, self.L_pp)
                    if self.kind == "turning"
                    else _overshoots(zigzag_indices(track, self.L_pp, self.nominal).overshoot)
                )
            except TrialError:  # the model turns to no side
                pass
        errors = {}
        for name, value in self.indices.items():
            reached = simulated.get(name, math.inf)
            errors[name] = reached - value if name.startswith("overshoot") else 100.0 * (reached / value - 1.0)
        return errors


def _turning(track: Track, L_pp: float) -> Values:
    indices = turning_indices(track, L_pp)
    found = {"advance": indices.advance, "tactical_diameter": indices.tactical_diameter}
    return {name: value for name, value in found.items() if value}


def _overshoots(overshoot: Sequence[float]) -> Values:
    return {f"overshoot_{k}": value / DEG for k, value in enumerate(overshoot[:2], 1)}


def applicable(found: Mapping[str, Values]) -> list[str]:
    """Metrics that any of the trials shows, in the order of METRICS."""
    return [name for name in METRICS if any(name in values for values in found.values())]
