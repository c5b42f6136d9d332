"""Effects no registry holds: a diagnosis must say that something is left, and not give it a wrong name.

Each has one parameter, ``magnitude``, null at 0; how it acts stands here, and in ``plant`` as equation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Unknown:
    """One such effect: how it acts, the magnitude's unit, and magnitudes that are clearly visible but plausible.

    since  the effect of the registry that has come to hold it, "" for none
    """

    acts: str
    unit: str
    magnitudes: tuple[float, ...]
    since: str = ""


def _degrees(*angles: float) -> tuple[float, ...]:
    return tuple(float(np.radians(angle)) for angle in angles)


UNKNOWN: dict[str, Unknown] = {
    "unknown-backlash": Unknown("blade within a play of +-magnitude behind the gear", "rad", _degrees(1.5, 2.5, 3.5)),
    "unknown-gain-sides": Unknown("blade angle times 1 + magnitude to starboard, 1 - to port", "-", (0.12, 0.18, 0.25)),
    "unknown-wake-speed": Unknown("wake fraction times 1 + magnitude (1 - U/U0)", "-", (-0.5, -0.35, 0.35)),
    "unknown-wake-side": Unknown("wake fraction times 1 + magnitude tanh(beta_P / 0.1)", "-", (-0.25, 0.15, 0.25)),
    "unknown-tide-turning": Unknown(
        "current to 046 deg, magnitude (t / 300 s - 1)", "m/s", (0.2, 0.3, 0.45), "current"
    ),
    "unknown-current-rotating": Unknown("current turning clockwise once in 900 s", "m/s", (0.2, 0.3, 0.45)),
    "unknown-current-south": Unknown("current to the east, only south of the start", "m/s", (0.2, 0.3, 0.4)),
    "unknown-gust": Unknown("wind from 230 deg, magnitude sin^2(pi t / 300 s)", "m/s", (9.0, 12.0, 15.0)),
    "unknown-velocity-filter": Unknown("ground velocity logged through a low-pass", "s", (4.0, 7.0, 10.0)),
    "unknown-compass-deviation": Unknown("heading logged + magnitude sin(psi)", "rad", _degrees(2.0, 3.5, 5.0)),
    "unknown-gyro-drift": Unknown("yaw rate logged + magnitude t / 600 s", "rad/s", _degrees(0.1, 0.2, 0.3)),
    "unknown-position-latency": Unknown("positions logged late", "s", (2.0, 3.5, 5.0)),
    "unknown-log-quadratic": Unknown("u logged + magnitude u (1 - u/U0)", "-", (-0.15, 0.12, 0.2)),
    "unknown-bank": Unknown("suction to a bank in the east, growing with y", "N", (6e3, 1.2e4, 2.0e4)),
    "unknown-thrust-yaw": Unknown("thrust times 1 - magnitude tanh|r'|", "-", (0.1, 0.16, 0.24)),
    "unknown-rpm-hunting": Unknown("unlogged factor 1 + magnitude sin(2 pi t / 60 s) on n", "-", (0.1, 0.15, 0.2)),
    "unknown-roll-yaw": Unknown("yaw moment N' = magnitude x heel of the turning ship", "1/rad", (-0.3, 0.2, 0.4)),
    "unknown-side-force-drift": Unknown("propeller side force times 1 + magnitude |beta|", "1/rad", (3.0, 5.0, 8.0)),
    "unknown-lighter": Unknown(
        "draught less by the share magnitude, trial after trial", "-", (0.12, 0.18, 0.25), "loading"
    ),
    "unknown-straightening-yaw": Unknown("gamma_R times 1 + magnitude tanh|r'|", "-", (-0.3, 0.25, 0.4)),
    "unknown-delayed-sway": Unknown("side force magnitude m u r, lagging by 20 s", "-", (0.1, -0.1, 0.18)),
    "unknown-fouling-growing": Unknown("R_0' times 1 + magnitude t / 600 s", "-", (0.4, 0.6, 0.9)),
    "unknown-governor-lag": Unknown("shaft lags behind the log, from 10 % less on", "s", (30.0, 60.0)),
    "unknown-heading-lag": Unknown("heading logged through a low-pass", "s", (2.0, 3.0, 4.5)),
}
