"""What is odd about the inputs: sign, speed and unit of rudder and revolutions."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..units import DEG
from .finding import Finding
from .model import Trial
from .motion_checks import spikes
from .schema import DIRECTIONS


def control_findings(trial: Trial, where: str) -> list[Finding]:
    """Findings on propeller, rudder and directions of a trial that can be used."""
    return [
        *_rudder_sign(trial, f"{where}, column 'delta'"),
        *_rudder_speed(trial, f"{where}, column 'delta'"),
        *_shaft_speed(trial, f"{where}, column 'n'"),
        *_per_minute(trial, f"{where}, column 'n'"),
        *_directions(trial, where),
    ]


def _rudder_sign(trial: Trial, where: str) -> list[Finding]:
    """A ship going ahead turns towards its rudder; only an overshoot goes the other way, and that one slows down."""
    over = (np.abs(trial.delta) > 3.0 * DEG) & np.isfinite(trial.r) & (trial.u > 0.0) & (trial.n > 0.0)
    if over.sum() < 20:
        return []
    side = np.sign(trial.delta)
    towards = float(np.mean(side[over] * trial.r[over])) / max(float(np.mean(np.abs(trial.r[over]))), 1e-300)
    both = over[1:] & over[:-1]
    quickens = float(np.sum((side[1:] * np.diff(trial.r))[both]))
    if towards > -0.3 or (towards > -0.8 and quickens >= 0.0):
        return []
    return [
        Finding(
            "warning",
            "the ship turns away from its rudder",
            where,
            f"a positive angle must turn the ship to starboard; agreement of sides {towards:.2f}, expected near 1",
            "change the sign of 'delta'; if it is right, those of 'r', 'psi', 'v' and 'y'",
        )
    ]


def _rudder_speed(trial: Trial, where: str) -> list[Finding]:
    """Orders jump in one sample.  Steering gears follow the size of a ship as its yaw rate does, so that tells them."""
    step, rate = fastest_change(trial.t, trial.delta)
    yaw = np.abs(trial.r[np.isfinite(trial.r)])
    if step < 4.9 * DEG or rate < 8.0 * DEG or rate < 8.0 * np.percentile(yaw, 95.0):
        return []
    return [
        Finding(
            "warning",
            f"the rudder moves at up to {rate / DEG:.3g} deg/s, {step / DEG:.3g} deg from one sample to the next",
            where,
            "no steering gear does; these may be orders, not positions",
            "use the measured rudder angle where there is one",
        )
    ]


def _shaft_speed(trial: Trial, where: str) -> list[Finding]:
    """Only for shafts as slow as those of ships: a model's motor can do anything."""
    step, rate = fastest_change(trial.t, trial.n)
    largest = float(np.percentile(np.abs(trial.n), 99.0))
    if largest > 5.0 or step < 0.25 * largest or rate < 0.3:
        return []
    return [
        Finding(
            "warning",
            f"the revolutions change by {60.0 * step:.3g} rpm from one sample to the next",
            where,
            "no ship's engine does; these may be orders, not measured revolutions",
            "use the measured revolutions where there are any",
        )
    ]


def _per_minute(trial: Trial, where: str) -> list[Finding]:
    n, u = np.median(np.abs(trial.n)), np.nanmedian(np.abs(trial.u))
    if n <= 30.0 or u > 0.2 * n:
        return []
    return [
        Finding(
            "warning",
            f"{n:.4g} revolutions per second at {u:.3g} m/s",
            where,
            f"the ship makes only {u / n:.2g} m with each; these are probably per minute",
            "divide 'n' by 60",
        )
    ]


def _directions(trial: Trial, where: str) -> list[Finding]:
    found = []
    for name in DIRECTIONS:
        values = trial.extra.get(name, np.zeros(1))
        largest = np.abs(values[np.isfinite(values)]).max(initial=0.0)
        if largest > 4.0 * np.pi:
            found.append(
                Finding(
                    "warning",
                    f"'{name}' is up to {largest:.3g} rad",
                    f"{where}, column '{name}'",
                    "a direction beyond two full turns is probably in degrees",
                    "multiply it by pi/180",
                )
            )
    return found


def fastest_change(t: FloatArray, values: FloatArray) -> tuple[float, float]:
    """Largest change between neighbouring samples, and its rate per second; spikes do not count."""
    kept = np.ones(len(values), dtype=bool)
    kept[spikes(values, share=0.2)] = False
    steps = np.abs(np.diff(values[kept]))
    k = int(np.argmax(steps))
    return float(steps[k]), float(steps[k] / np.diff(t[kept])[k])
