"""Sensors at the end of their range: a channel that is noisy, and stands still at its largest or smallest value; a yaw
rate that goes no further, however fast the heading turns."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...units import DEG
from ..model import Trial
from ..schema import MOTION
from .finding import Finding
from .motion_checks import longest_run

CHANNELS = tuple(name for name in MOTION if name not in ("x", "y", "psi"))
"""Those that have a range; positions and headings go on for ever."""

STANDS = 8
"""Samples in a row that show the same extreme value."""

ELSEWHERE = 0.05
"""Share of samples that repeat the one before, elsewhere in the record, up to which few digits are no reason."""

NOISY = -0.3
"""Correlation of neighbouring second differences up to which a channel is noisy: -2/3 for white noise, near 1 for a
smooth one, which may stand still for good."""

STRETCHES, SHORTEST = 60, 5
"""Stretches that a record is cut into to hold its yaw rate against its heading, and samples that one has at least."""

BEYOND, SO_MANY = 1.1, 4
"""How many times as fast as its log the ship turns where that has ended, and stretches in which she does."""

BETTER = 0.35
"""Error of a yaw rate with an end, as a share of that of one with another scale, up to which it has an end."""


def saturation_findings(trial: Trial, where: str, end: float | None) -> list[Finding]:
    """That a channel of the motion stands at the end of its range.

    end  of the yaw rate, see ``yaw_rate_end``; told where that does not stand still there
    """
    found, stand = [], set()
    for name in CHANNELS:
        for word, values in (("largest", trial.columns[name]), ("smallest", -trial.columns[name])):
            if n := _at_the_end(values):
                stand.add(name)
                value = float(np.nanmax(values)) * (1.0 if word == "largest" else -1.0)
                found.append(
                    Finding(
                        "warning",
                        f"'{name}' stands still at its {word} value, {value:.4g}",
                        f"{where}, column '{name}'",
                        f"it is noisy elsewhere, and shows the same number {n} samples in a row: the sensor, or what "
                        "logs it, may be at the end of its range",
                        "mark these samples as NaN: they count in no comparison then",
                        "saturated",
                    )
                )
    if end is not None and "r" not in stand:
        found.append(
            Finding(
                "warning",
                f"the yaw rate ends at {end / DEG:.3g} deg/s ({end / DEG * 60.0:.3g} deg/min)",
                f"{where}, columns 'psi' and 'r'",
                "it follows the heading up to there, and stays there where the ship turns faster: the gyro, or what "
                "logs it, is at the end of its range",
                "mark the yaw rate beyond as NaN: it counts in no comparison then",
                "saturated",
            )
        )
    return found


def yaw_rate_end(trial: Trial) -> float | None:
    """Yaw rate [rad/s] beyond which that of the log does not go, though the heading turns faster, noise of the sensor
    or not; None for none."""
    n = max(SHORTEST, trial.n_samples // STRETCHES)
    first = np.arange(0, trial.n_samples - n, n)
    lasts = trial.t[first + n] - trial.t[first]
    turned = (trial.psi[first + n] - trial.psi[first]) / lasts
    steps = 0.5 * (trial.r[1:] + trial.r[:-1]) * np.diff(trial.t)
    logged = np.array([steps[k : k + n].sum() for k in first]) / lasts
    known = np.isfinite(turned) & np.isfinite(logged)
    turned, logged = turned[known], logged[known]
    if len(turned) < 2 * SO_MANY or not np.any(turned) or not np.any(logged):
        return None
    scale = float(turned @ logged) / float(turned @ turned)
    ends = np.linspace(0.5, 1.05, 56) * np.abs(logged).max()
    left = np.sum((logged - np.clip(turned, -ends[:, None], ends[:, None])) ** 2, axis=1)
    end = float(ends[int(np.argmin(left))])
    scaled = float(np.sum((logged - scale * turned) ** 2))
    ended = np.sum(np.abs(turned) > BEYOND * end) >= SO_MANY and float(left.min()) < BETTER**2 * scaled
    return end if ended else None


def _at_the_end(values: FloatArray) -> int:
    """Longest run of the largest value of a noisy channel (n_samples,); 0 where it is short, or the channel is not."""
    known = values[np.isfinite(values)]
    if len(known) < 4 * STANDS:
        return 0
    top = known == known.max()
    begins, ends = longest_run(top)
    longest = ends - begins
    if longest < STANDS:
        return 0
    away = ~top[1:] & ~top[:-1]
    repeats = np.diff(known) == 0.0
    if away.sum() < 2 * STANDS or np.mean(repeats[away]) > ELSEWHERE:
        return 0
    bends = np.diff(known, n=2)
    free = ~top[2:] & ~top[1:-1] & ~top[:-2]
    both = free[1:] & free[:-1]
    one, next_one = bends[:-1][both], bends[1:][both]
    power = float(np.sqrt(np.sum(one**2) * np.sum(next_one**2)))
    return longest if len(one) > STANDS and power > 0.0 and float(one @ next_one) < NOISY * power else 0
