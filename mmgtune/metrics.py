"""What a model is judged by on a trial: names, units and how much each may change unnoticed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

RELATIVE = 0.01
"""Share of its own size a metric may get worse by; simulations repeat exactly, so this is no allowance for noise."""


@dataclass(frozen=True)
class Metric:
    """One number about one trial; the nearer to zero, the better.

    unit      what it is given in; "mixed" adds metres, radians and their rates as they are
    words     what people call it
    floor     absolute change that never matters [unit], times ``of`` where that is named
    of        "" or a scale of the ship: "length" L_pp [m], "speed" 0.1 sqrt(g L_pp) [m/s], "turning" speed over L_pp
              [deg/s]
    """

    unit: str
    words: str
    floor: float
    of: Literal["", "length", "speed", "turning"] = ""


METRICS: Mapping[str, Metric] = {
    "J": Metric("-", "J", 1e-4),
    "MMD": Metric("m", "mean Manhattan distance", 1e-4, "length"),
    "MED": Metric("m", "mean Euclidean distance", 1e-4, "length"),
    "ASD": Metric("mixed", "absolute state distance", 1e-4, "length"),
    "MSD": Metric("mixed", "mean state distance", 1e-4, "length"),
    "PMD": Metric("%", "percentage Manhattan distance", 0.01),
    "PED": Metric("%", "percentage Euclidean distance", 0.01),
    "cVDM": Metric("%", "cVDM", 0.01),
    "rms_x": Metric("m", "error of x, rms", 1e-4, "length"),
    "rms_y": Metric("m", "error of y, rms", 1e-4, "length"),
    "rms_psi": Metric("deg", "error of heading, rms", 0.01),
    "rms_u": Metric("m/s", "error of surge, rms", 1e-4, "speed"),
    "rms_v": Metric("m/s", "error of sway, rms", 1e-4, "speed"),
    "rms_r": Metric("deg/s", "error of yaw rate, rms", 1e-4, "turning"),
    "advance": Metric("%", "error of advance", 0.1),
    "tactical_diameter": Metric("%", "error of tactical diameter", 0.1),
    "overshoot_1": Metric("deg", "error of 1st overshoot", 0.05),
    "overshoot_2": Metric("deg", "error of 2nd overshoot", 0.05),
}
"""Sums over samples (J: Suyama et al. 2023, eq. 39-40; MMD to cVDM: Mathioudakis et al., eq. 10-16), root mean squares
of the channels, and errors of manoeuvring indices, simulated less measured, with the measured inputs."""
