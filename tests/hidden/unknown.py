"""Effects no registry holds: a diagnosis must say that something is left, and not give it a wrong name.

Each has one parameter, ``magnitude``, null at 0; how it acts stands here, and in ``plant`` as equation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

JUMP = "jump"
"""What a diagnosis says of positions that jump, beside its causes."""


@dataclass(frozen=True)
class Unknown:
    """One such effect: how it acts, the magnitude's unit, and magnitudes that are clearly visible but plausible.

    since  the cause that has come to be known for it, "" for none; JUMP where it is told without a cause
    """

    acts: str
    unit: str
    magnitudes: tuple[float, ...]
    since: str = ""


def _degrees(*angles: float) -> tuple[float, ...]:
    return tuple(float(np.radians(angle)) for angle in angles)


UNKNOWN: dict[str, Unknown] = {
    "unknown-wake-speed": Unknown("wake fraction times 1 + magnitude (1 - U/U0)", "-", (-0.5, -0.35, 0.35)),
    "unknown-wake-side": Unknown("wake fraction times 1 + magnitude tanh(beta_P / 0.1)", "-", (-0.25, 0.15, 0.25)),
    "unknown-tide-turning": Unknown(
        "current to 046 deg, magnitude (t / 300 s - 1)", "m/s", (0.2, 0.3, 0.45), "current"
    ),
    "unknown-current-rotating": Unknown("current turning clockwise once in 900 s", "m/s", (0.2, 0.3, 0.45), "current"),
    "unknown-current-south": Unknown("current to the east, only south of the start", "m/s", (0.2, 0.3, 0.4), "current"),
    "unknown-gust": Unknown("wind from 230 deg, magnitude sin^2(pi t / 300 s)", "m/s", (9.0, 12.0, 15.0)),
    "unknown-log-quadratic": Unknown("u logged + magnitude u (1 - u/U0)", "-", (-0.15, 0.12, 0.2), "speed-scale"),
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
    "unknown-steering-hunting": Unknown("blade + magnitude sin(2 pi t / 15 s), not logged", "rad", _degrees(2, 3, 4)),
    "unknown-rudder-torsion": Unknown("blade angle times 1 - magnitude (U/U0)^2", "-", (0.12, 0.18, 0.25)),
    "unknown-indicator-cubic": Unknown(
        "blade angle times 1 - magnitude (delta / 35 deg)^2", "-", (-0.15, 0.15, 0.25), "rudder-gain"
    ),
    "unknown-inertia-yaw": Unknown("moment of inertia in yaw times 1 + magnitude", "-", (-0.35, 0.35, 0.5)),
    "unknown-hull-stall": Unknown(
        "hull Y and N less by magnitude tanh((|v'| - 0.15)/0.1) beyond", "-", (-0.2, 0.15, 0.25)
    ),
    "unknown-tug": Unknown("a tug at the bow pushes to starboard from 60 s to 180 s", "N", (6e3, -1e4, 1.5e4)),
    "unknown-deviation-quadrantal": Unknown(
        "heading logged + magnitude sin(2 psi)", "rad", _degrees(1.5, 2.5, 4.0), "compass-deviation"
    ),
    "unknown-easting-scale": Unknown("y logged times 1 + magnitude", "-", (-0.04, 0.03, 0.05)),
    "unknown-position-step": Unknown(
        "positions logged + magnitude to the north-east from 150 s on", "m", (5.0, 8.0, 12.0), JUMP
    ),
    "unknown-sway-bias": Unknown("v logged + magnitude", "m/s", (-0.12, 0.08, 0.15), "log-zero"),
    "unknown-clock-drift": Unknown("control log late by magnitude t / 600 s", "s", (-8.0, 6.0, 10.0)),
    "unknown-controls-held": Unknown(
        "controls logged every magnitude seconds and held between", "s", (6.0, 8.0, 12.0), "inputs-held"
    ),
    "unknown-thruster-bursts": Unknown(
        "a bow thruster pushes to starboard for 20 s of each minute", "N", (6e3, -8e3, 1.2e4)
    ),
    "unknown-ice": Unknown("R_0' times 1 + magnitude from 200 s to 320 s", "-", (0.6, 1.0, 1.5)),
    "unknown-gyro-compressed": Unknown(
        "r logged times 1 - magnitude |r| L_pp / U0", "-", (0.1, 0.15, 0.25), "gyro-scale"
    ),
}
