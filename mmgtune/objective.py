"""What a fit makes small: J, the sum of squared scaled differences between simulated and measured motion.

Gaps have one rule everywhere, here and in ``evaluation``: each sample of each channel after the first counts where it
was measured, whatever the other channels did.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from .arrays import FloatArray
from .backends import STATES, Cases
from .errors import OptionError, Problem, among
from .physics.constants import GRAVITY
from .predictor import cases_from
from .trial import Trial
from .trial.pieces import counting
from .trial.schema import ATTRIBUTES, FILE_CHANNELS

PAPER_CHANNELS = ("x", "y", "psi")
"""Position and heading: the channels of Suyama et al. 2023, eq. 39-40."""

SAME = 1e-12
"""Share of a state within which it does not vary: what is left is the rounding of whoever wrote it."""

LEAST = 1e-100
"""Size [SI] up to which a state stays at 0: squares of such numbers are 0."""

DIVIDES = "L_MSE divides by the spread of each state"
"""Why each state of trials has to vary."""


def default_scales(L_pp: float) -> dict[str, float]:
    """What differences are divided by: L_pp [m], L_pp [m], pi/4 [rad] as in Suyama et al. 2023, eq. 40.

    The paper prints Q = diag(L_pp, L_pp, 0.25 pi) but its values of J are only possible when residuals are divided
    by these.  For velocities, which the paper leaves out: a tenth of sqrt(g L_pp) [m/s], and 0.1 of that over L_pp.
    """
    speed = 0.1 * float(np.sqrt(GRAVITY * L_pp))
    return {"x": L_pp, "y": L_pp, "psi": 0.25 * np.pi, "u": speed, "v_m": speed, "r": speed / L_pp}


@dataclass(frozen=True)
class Objective:
    """J = sum over trials, samples after the first and channels of weight * ((simulated - measured) / scale)^2.

    scales   what each channel is divided by, in its SI unit
    weights  channels that count, and how much (1 unless told)
    window   first and last time [s] that count, None for the whole trial
    every    time between samples that count [s], None for all: neighbours of a densely sampled trial say the same
    """

    scales: Mapping[str, float]
    weights: Mapping[str, float] = field(default_factory=lambda: dict.fromkeys(PAPER_CHANNELS, 1.0))
    window: tuple[float, float] | None = None
    every: float | None = None

    @property
    def channels(self) -> tuple[str, ...]:
        """Channels that count, in the order of the state."""
        return tuple(name for name in STATES if self.weights.get(name, 0.0) > 0.0)

    def weight(self, trial: Trial) -> FloatArray:
        """(n_samples, 6) weight of each squared difference: 0 outside the window, in gaps and at the first sample."""
        count = self.channels
        per_channel = np.array(
            [self.weights[name] / self.scales[name] ** 2 if name in count else 0.0 for name in STATES]
        )
        weight = np.where(np.isnan(trial.motion), 0.0, per_channel)
        weight[0] = 0.0
        if self.window is not None:
            outside = (trial.t < self.window[0]) | (trial.t > self.window[1])
            weight[outside] = 0.0
        if self.every is not None:
            weight[~counting(trial.t, self.every)] = 0.0
        return weight


def spread(trials: Sequence[Trial]) -> dict[str, float]:
    """Standard deviation of each state over all samples of the trials [SI]; the heading wrapped to one turn.

    What the standardised error of Wakita et al. 2022, eq. 26, divides differences by.  NaN of a state that does not
    vary or was never measured: the rounding of a mean is no spread.
    """
    motion = np.concatenate([trial.motion for trial in trials])
    motion[:, 2] = np.arctan2(np.sin(motion[:, 2]), np.cos(motion[:, 2]))
    sigma = np.full(len(STATES), np.nan)
    for k in np.flatnonzero(~np.isnan(motion).all(axis=0)):
        least, most = np.nanmin(motion[:, k]), np.nanmax(motion[:, k])
        if most - least > max(LEAST, SAME * max(abs(least), abs(most))):
            sigma[k] = np.nanstd(motion[:, k : k + 1], axis=0)[0]
    return dict(zip(STATES, sigma.tolist(), strict=True))


def varying(
    sigma: Mapping[str, float], where: str, fix: str, channels: Sequence[str] = STATES, why: str = DIVIDES
) -> dict[str, float]:
    """The spread of trials as it is.  Raises OptionError where one of these channels has none."""
    still = [name for name in channels if not sigma[name] > 0.0]
    if still:
        raise OptionError(Problem(f"these trials do not vary in {', '.join(still)}", where, why, fix))
    return dict(sigma)


def make_objective(
    L_pp: float,
    channels: Sequence[str] | None = None,
    window: tuple[float, float] | None = None,
    *,
    scales: Mapping[str, float] | None = None,
    every: float | None = None,
) -> Objective:
    """The paper's objective, or one over other channels: "x", "y", ... or "u:2" for a weight of 2.

    scales  other than the paper's, as ``spread`` gives them; all six channels count then unless ``channels`` says
            otherwise
    every   time between samples that count [s]
    Raises OptionError for an unknown channel, a weight that is not positive, a channel that counts and has no spread,
    or an empty window.
    """
    weights: dict[str, float] = {}
    for entry in channels or (PAPER_CHANNELS if scales is None else STATES):
        name, _, written = entry.partition(":")
        if name not in (*FILE_CHANNELS, *STATES):
            raise OptionError(Problem(f"unknown channel '{name}'", "channels", **among(name, FILE_CHANNELS)))
        name = ATTRIBUTES.get(name, name)
        try:
            weights[name] = float(written) if written else 1.0
        except ValueError:
            weights[name] = -1.0
        if not (np.isfinite(weights[name]) and weights[name] > 0.0):
            raise OptionError(
                Problem(
                    f"weight '{written}' of channel '{name}' is not a positive number",
                    "channels",
                    "after the colon stands how much a channel counts beside the others",
                    f"write {name}:1",
                )
            )
    if window is not None and not window[0] < window[1]:
        raise OptionError(
            Problem(
                f"the time window {window[0]:g}..{window[1]:g} s is empty",
                "window",
                "its end is not after its beginning, so no sample would count",
                "write window=FIRST:LAST in seconds",
            )
        )
    usual = default_scales(L_pp)
    if scales is not None:
        why = "the standardised objective divides by the spread of each channel"
        varying(scales, "objective", "leave them out of channels, or choose objective=paper", tuple(weights), why)
        usual |= {name: scale for name, scale in scales.items() if scale > 0.0}
    return Objective(scales=usual, weights=weights, window=window, every=every)


def cases_of(trials: Sequence[Trial], objective: Objective, inputs: Sequence[str], draught: float | None) -> Cases:
    """Trials as cases to simulate: driven by the measured inputs from the first measured state.

    inputs   what drives the ship, see ``Model.inputs``
    draught  of the ship [m], see ``surroundings``; None where nobody knows it
    Raises TrialError for a trial without one of them, OptionError where the window or gaps leave a trial without a
    sample to compare.
    """
    weight = weights_of(trials, objective)
    target = [np.nan_to_num(trial.motion, nan=0.0) for trial in trials]
    return cases_from(trials, inputs, draught, target=target, weight=weight)


def weights_of(trials: Sequence[Trial], objective: Objective) -> list[FloatArray]:
    """Weight of each squared difference of trials, (n_samples, 6) each.

    Raises OptionError where the window, gaps or samples far apart leave a trial without a sample to compare.
    """
    weight = [objective.weight(trial) for trial in trials]
    for trial, values in zip(trials, weight, strict=True):
        if not values.any():
            raise OptionError(_nothing_counts(trial, objective))
    return weight


def _nothing_counts(trial: Trial, objective: Objective) -> Problem:
    """The problem of a trial without a sample to compare."""
    where = "window" if objective.window else str(trial.path or trial.id)
    fix = "choose a window inside the trial, or leave the trial out of the split"
    if objective.every is not None and replace(objective, every=None).weight(trial).any():
        where, fix = "every", f"choose a time below {trial.t[-1] - trial.t[0]:g} s, or leave the trial out of the split"
    why = f"it lasts from {trial.t[0]:g} to {trial.t[-1]:g} s and needs two samples or more that count"
    which = (
        f"trial '{trial.whole}'" if not trial.part_of else f"the window of trial '{trial.whole}' at {trial.begins:g} s"
    )
    return Problem(f"{which} has no sample to compare with", where, why, fix)
