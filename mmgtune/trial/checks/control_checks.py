"""What is odd about the inputs: sign, speed and unit of rudders, propellers and thrusters; each by its own name."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...inputs import INPUTS, Role
from ...units import DEG
from ..kinematics import turning
from ..model import Trial
from ..schema import MAIN_INPUTS, RUDDERS, directions
from .finding import Finding, Rescale, Reverse
from .motion_checks import spikes_of

BRAKING = 45.0 * DEG
"""Rudder angle [rad] beyond which it is there to brake."""

FASTEST_THRUSTER = 100.0
"""Revolutions [1/s] that no thruster makes, not even a model's."""


FASTEST_GEAR = 8.0 * DEG
"""Rudder rate [rad/s] that no steering gear of a ship reaches; of a model they are quicker as all its times are."""

SLOWEST_MODEL = 3.0
"""Revolutions [1/s] of a ship's shaft that few exceed.  By Froude's law all rates grow with the root of the scale,
those of shafts and gears alike, so that a faster shaft tells a model and how much quicker its gear may be."""

FASTEST_SHAFT = 5.0
"""Revolutions [1/s] that only models' shafts exceed."""

STANDS, STANDS_SECONDS = 4, 6.0
"""Samples that orders stand still for before they change and after, and the longest time [s] between two: an engine
takes longer."""

RUDDER_SIGN = "rudder-sign"
"""Code of the finding that a ship turns away from her rudder."""


def control_findings(trial: Trial, where: str) -> list[Finding]:
    """Findings on inputs and directions of a trial that can be used."""
    found = []
    for name, values in inputs_of(trial).items():
        place = f"{where}, column '{name}'"
        gaps = _gaps(name, values, place)
        # Further inputs may have gaps: what needs them all along says so, and the rest cannot be judged.
        checks = () if gaps else CHECKS[INPUTS[name].role]
        found += [one for one in (gaps, *(check(trial, name, place) for check in checks)) if one]
    return [*found, *_directions(trial, where)]


def inputs_of(trial: Trial) -> dict[str, FloatArray]:
    """The inputs a trial has logged, (n_samples,) by name."""
    columns = trial.columns
    return {name: columns[name] for name in INPUTS if name in columns}


def looks_ordered(trial: Trial, name: str) -> bool:
    """Whether an input without gaps moves as orders do, and as no steering gear or engine."""
    check = {"rudder": _rudder_speed, "propeller": _shaft_speed}.get(INPUTS[name].role)
    return check is not None and check(trial, name, "") is not None


def _gaps(name: str, values: FloatArray, where: str) -> Finding | None:
    missing = ~np.isfinite(values)
    if name in MAIN_INPUTS or not missing.any():
        return None
    return Finding(
        "warning",
        f"'{name}' is no number in {missing.sum()} rows",
        f"{where}, row {int(np.flatnonzero(missing)[0])}",
        f"a model driven by the {INPUTS[name].words} needs it at every sample",
        "fill short gaps by interpolation, or cut the trial there",
    )


def _rudder_sign(trial: Trial, name: str, where: str) -> Finding | None:
    """A ship going ahead turns towards its rudder; only an overshoot goes the other way, and that one slows down.

    Nothing where yaw rate and heading contradict each other: one of these is wrong."""
    delta = trial.columns[name]
    if turning(trial.columns).opposed:
        return None
    over = (np.abs(delta) > 3.0 * DEG) & np.isfinite(trial.r) & (trial.u > 0.0) & (trial.n > 0.0) & steered(trial)
    if over.sum() < 20:
        return None
    side = np.sign(delta)
    towards = float(np.mean(side[over] * trial.r[over])) / max(float(np.mean(np.abs(trial.r[over]))), 1e-300)
    both = over[1:] & over[:-1]
    quickens = float(np.sum((side[1:] * np.diff(trial.r))[both]))
    if towards > -0.3 or (towards > -0.8 and quickens >= 0.0):
        return None
    return Finding(
        "warning",
        "the ship turns away from its rudder",
        where,
        f"a positive angle must turn the ship to starboard; agreement of sides {towards:.2f}, expected near 1",
        Reverse(name, "r", "psi", "v", "y"),
        RUDDER_SIGN,
    )


def steered(trial: Trial) -> BoolArray:
    """Samples at which no rudder is as far over as only those do that brake: turned outward, a pair steers little."""
    return np.asarray(np.max(np.abs(rudders_of(trial)), axis=0) < BRAKING)


def rudders_of(trial: Trial) -> FloatArray:
    """(n_rudders, n_samples) angles of all rudders that are logged, of several their mean too [rad]."""
    return np.array([trial.columns[name] for name in RUDDERS if name in trial.columns])


def _rudder_speed(trial: Trial, name: str, where: str) -> Finding | None:
    """Orders jump in one sample.  Steering gears follow the size of a ship as its yaw rate and its shaft do."""
    step, rate = fastest_change(trial, name)
    yaw = np.abs(trial.r[np.isfinite(trial.r)])
    quick = FASTEST_GEAR * max(1.0, float(np.percentile(np.abs(trial.n), 99.0)) / SLOWEST_MODEL)
    if step < 4.9 * DEG or rate < quick or rate < 8.0 * np.percentile(yaw, 95.0):
        return None
    return Finding(
        "warning",
        f"the rudder moves at up to {rate / DEG:.3g} deg/s, {step / DEG:.3g} deg from one sample to the next",
        where,
        "no steering gear does; these may be orders, not positions",
        "use the measured rudder angle where there is one",
    )


def _shaft_speed(trial: Trial, name: str, where: str) -> Finding | None:
    """Only for shafts as slow as those of ships: a model's motor can do anything."""
    n = trial.columns[name]
    step, rate = fastest_change(trial, name)
    largest = float(np.percentile(np.abs(n), 99.0))
    if largest > FASTEST_SHAFT:
        return None
    jump = jump_between_holds(trial.t, n)
    if jump > 0.1 * largest:
        why = "they stand still before and after, as orders do and no measured revolutions"
    elif step < 0.25 * largest or rate < 0.3:
        return None
    else:
        jump, why = step, "no ship's engine does; these may be orders, not measured revolutions"
    return Finding(
        "warning",
        f"the revolutions change by {60.0 * jump:.3g} rpm from one sample to the next",
        where,
        why,
        "use the measured revolutions where there are any",
    )


def _per_minute(trial: Trial, name: str, where: str) -> Finding | None:
    n, u = np.median(np.abs(trial.columns[name])), np.nanmedian(np.abs(trial.u))
    if n <= 30.0 or u > 0.2 * n:
        return None
    return Finding(
        "warning",
        f"{n:.4g} revolutions per second at {u:.3g} m/s",
        where,
        f"the ship makes only {u / n:.2g} m with each; these are probably per minute",
        Rescale(f"divide '{name}' by 60", name),
    )


def _thruster_per_minute(trial: Trial, name: str, where: str) -> Finding | None:
    n = float(np.abs(trial.columns[name]).max())
    if n <= FASTEST_THRUSTER:
        return None
    why = "no thruster turns as fast; these are probably per minute"
    fix = Rescale(f"divide '{name}' by 60", name)
    return Finding("warning", f"up to {n:.4g} revolutions per second", where, why, fix)


CHECKS: dict[Role, tuple[Callable[[Trial, str, str], Finding | None], ...]] = {
    "rudder": (_rudder_sign, _rudder_speed),
    "propeller": (_shaft_speed, _per_minute),
    "thruster": (_thruster_per_minute,),
}
"""What is looked at in every input of a role."""


def _directions(trial: Trial, where: str) -> list[Finding]:
    found = []
    for name in directions(trial.extra):
        values = trial.extra[name]
        largest = np.abs(values[np.isfinite(values)]).max(initial=0.0)
        if largest > 4.0 * np.pi:
            found.append(
                Finding(
                    "warning",
                    f"'{name}' is up to {largest:.3g} rad",
                    f"{where}, column '{name}'",
                    "a direction beyond two full turns is probably in degrees",
                    Rescale("multiply it by pi/180", name),
                )
            )
    return found


def jump_between_holds(t: FloatArray, values: FloatArray) -> float:
    """Largest change between neighbouring samples before and after which some stand still; 0 without any."""
    steps = np.abs(np.diff(values))
    still = steps <= 1e-6 * float(np.max(np.abs(values), initial=0.0))
    held = np.concatenate([[0], np.cumsum(still)])
    n = STANDS - 1
    k = np.arange(n, len(steps) - n)
    jumps = (held[k] - held[k - n] == n) & (held[k + n + 1] - held[k + 1] == n) & (np.diff(t)[k] < STANDS_SECONDS)
    return float(np.max(steps[k][jumps], initial=0.0))


def fastest_change(trial: Trial, name: str) -> tuple[float, float]:
    """Largest change of an input between neighbouring samples, and its rate per second; spikes do not count."""
    t, values = trial.t, trial.columns[name]
    kept = np.ones(len(values), dtype=bool)
    kept[spikes_of(trial, name)] = False
    steps = np.abs(np.diff(values[kept]))
    k = int(np.argmax(steps))
    return float(steps[k]), float(steps[k] / np.diff(t[kept])[k])
