"""Networks on their way: cases marched through in a network's own step, and single ships steered."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import Cases
from ..backends.cases import SPEED_LIMIT
from ..errors import TrialError
from ..limits import RUN_STEPS
from ..physics.quantities import HELD, UNKNOWN, Surroundings
from ..predictor import Prediction, Run

WIND = tuple(Surroundings._fields.index(name) for name in ("wind_north", "wind_east"))


def marched(run: Run, cases: Cases, h: float) -> Prediction:
    """A run begun at ``cases.initial``, lane by case, as a prediction; it marches in steps of h [s]."""
    return at_samples(march(run, *driven(cases, h), h), cases, h)


def paired(run: Run, cases: Cases, h: float) -> FloatArray:
    """States (n_cases, T, 6) of a run with a member to each case and one lane; not finite once one diverges."""
    controls, around = driven(cases, h)
    fine = march(run, controls[:, None], around[:, None], h)
    found = at_samples(fine[None, :, 0], cases, h)
    return np.asarray(np.where(found.diverged[:, :, None], np.nan, found.states[:, 0]))


def driven(cases: Cases, h: float) -> tuple[FloatArray, FloatArray]:
    """Inputs (n_cases, n_steps, n_inputs) and surroundings (n_cases, n_steps, n_surroundings) at steps of h [s].

    They are interpolated linearly but for those that are ``HELD``.  Where no wind was measured the air is still.
    Raises TrialError for a time that takes more steps than a run may have.
    """
    span = cases.t - cases.t[:, :1]
    longest = float(span.max(initial=0.0))
    RUN_STEPS.require(longest / h, f"{longest:.6g} s in steps of {h:g} s", TrialError)
    n_steps = max(1, math.ceil(longest / h - 1e-9))
    return (
        _on_grid(span, cases.controls, cases.n_samples, h, n_steps),
        _on_grid(span, cases.around, cases.n_samples, h, n_steps, [name in HELD for name in Surroundings._fields]),
    )


def march(run: Run, controls: FloatArray, around: FloatArray, h: float) -> FloatArray:
    """States (n_members, n_lanes, n_steps + 1, 6) of a run from where it is.

    controls  (n_lanes, n_steps, n_inputs), or (n_members, n_lanes, n_steps, n_inputs); around alike
    """
    n_steps = controls.shape[-2]
    fine = np.empty((*run.states.shape[:2], n_steps + 1, 6))
    fine[:, :, 0] = run.states
    with np.errstate(all="ignore"):
        for k in range(n_steps):
            run.step(controls[..., k, :], around[..., k, :], h)
            fine[:, :, k + 1] = run.states
    return fine


def at_samples(fine: FloatArray, cases: Cases, h: float) -> Prediction:
    """What states (n_members, n_cases, n_steps + 1, 6) at steps of h [s] are at the samples of the cases."""
    n_steps = fine.shape[2] - 1
    place = (cases.t - cases.t[:, :1]) / h
    before = np.minimum(place.astype(np.int64), n_steps - 1)
    share = (place - before)[None, :, :, None]
    rows = np.arange(len(cases))[:, None]
    with np.errstate(all="ignore"):
        states = (1.0 - share) * fine[:, rows, before] + share * fine[:, rows, before + 1]
    states = np.where(share == 0.0, fine[:, rows, before], states)  # 0 times infinite is no number
    counts = np.arange(cases.t.shape[1]) < cases.n_samples[:, None]
    sound = np.isfinite(states).all(axis=-1) & (np.hypot(states[..., 3], states[..., 4]) < SPEED_LIMIT)
    diverged = np.any(~sound & counts, axis=-1)
    return Prediction(np.ascontiguousarray(states.transpose(1, 0, 2, 3)), np.asarray(diverged).T)


class RunStepper:
    """One member under way, steered while it moves, in still air; see ``Stepper``.

    run   of one member and one lane
    step  of the training [s]
    """

    def __init__(self, run: Run, step: float):
        self._run = run
        self._step = step

    def step(self, now: FloatArray, then: FloatArray, h: float) -> FloatArray:
        """See ``Stepper``; the step is cut into equal parts as near as can be to those of the training."""
        parts = max(1, round(h / self._step))
        with np.errstate(all="ignore"):
            for k in range(parts):
                at = now + k / parts * (then - now)
                self._run.step(at[None], np.array([UNKNOWN]), h / parts)
        return np.array(self._run.states[0, 0])


def _on_grid(
    span: FloatArray, values: FloatArray, n_samples: IntArray, h: float, n_steps: int, held: Sequence[bool] = ()
) -> FloatArray:
    """(n_cases, n_steps, ...) values at multiples of h [s] from the start of each case; after its end its last.

    held  columns that keep between samples the value at their end
    """
    grid = h * np.arange(n_steps)
    found = np.empty((len(span), n_steps, values.shape[-1]))
    for into, t, columns, n in zip(found, span, values, n_samples, strict=True):
        after = np.minimum(np.searchsorted(t[:n], grid), n - 1)
        for k, column in enumerate(columns.T):
            into[:, k] = column[after] if k < len(held) and held[k] else np.interp(grid, t[:n], column[:n])
    return found
