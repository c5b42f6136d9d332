"""Sensors at the end of their range: a channel that is noisy, and stands still at its largest or smallest value; a yaw
rate or a speed that goes no further, however fast the heading turns or the ship goes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...arrays import FloatArray
from ...units import DEG
from ..model import Trial
from ..schema import MOTION
from .finding import Finding
from .motion_checks import longest_run
from .sensor_ends import End

CHANNELS = tuple(name for name in MOTION if name not in ("x", "y", "psi"))
"""Those that have a range; positions and headings go on for ever."""

STANDS = 8
"""Samples in a row that show the same extreme value."""

ELSEWHERE = 0.05
"""Share of samples that repeat the one before, elsewhere in the record, up to which few digits are no reason."""

NOISY = -0.3
"""Correlation of neighbouring second differences up to which a channel is noisy: -2/3 for white noise, near 1 for a
smooth one, which may stand still for good."""


_ENDS = {
    "u": ("positions", "goes", "log", "'x', 'y' and 'u'"),
    "r": ("heading", "turns", "gyro", "'psi' and 'r'"),
}


def end_in_words(name: str, value: float) -> str:
    """Where the log of the speed ahead or of the yaw rate ends, in units that people read."""
    if name == "r":
        return f"the yaw rate ends at {value / DEG:.3g} deg/s ({value / DEG * 60.0:.3g} deg/min)"
    return f"the speed log ends at {value:.3g} m/s"


def saturation_findings(trial: Trial, where: str, ends: Mapping[str, End]) -> list[Finding]:
    """That a channel of the motion stands at the end of its range.

    ends  see ``ends_of``; told where a channel does not stand still there
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
    for name, (follows, faster, sensor, columns) in _ENDS.items():
        if name in ends and name not in stand:
            found.append(
                Finding(
                    "warning",
                    end_in_words(name, ends[name].value),
                    f"{where}, columns {columns}",
                    f"it follows the {follows} up to there, and stays there where the ship {faster} faster: the "
                    f"{sensor}, or what logs it, is at the end of its range",
                    f"mark '{name}' beyond as NaN: it counts in no comparison then",
                    "saturated",
                )
            )
    return found


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
