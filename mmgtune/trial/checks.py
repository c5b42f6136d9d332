"""Whether a trial can be used, and what is odd about it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import Problem
from .model import FloatArray, Trial
from .schema import LARGEST_RUDDER, MOTION

DEG = np.pi / 180.0


@dataclass(frozen=True)
class Finding:
    """Something about a trial a user should know; ``severity`` is "warning" or "note"."""

    severity: str
    what: str
    where: str
    why: str = ""
    fix: str = ""


def unusable(trial: Trial) -> list[Problem]:
    """Everything that forbids simulating a trial; empty where nothing does."""
    where = str(trial.path or trial.id)
    if trial.n_samples < 2:
        return [
            Problem(
                f"the trial has {trial.n_samples} samples",
                where,
                "a motion needs two or more",
                "write the whole record",
            )
        ]
    problems: list[Problem] = []
    t = trial.t
    if not np.isfinite(t).all():
        problems.append(
            Problem("time is not a number", f"{where}, row {_first(~np.isfinite(t))}", fix="drop rows without a time")
        )
    elif (np.diff(t) <= 0.0).any():
        row = _first(np.diff(t) <= 0.0) + 1
        problems.append(
            Problem(
                "time does not increase",
                f"{where}, row {row} (t = {t[row]:g} s after {t[row - 1]:g} s)",
                "each step of the simulation goes from one sample to the next",
                "sort the rows and drop repeated ones",
            )
        )
    for name, values in (("n", trial.n), ("delta", trial.delta)):
        if not np.isfinite(values).all():
            problems.append(
                Problem(
                    f"input '{name}' has {int((~np.isfinite(values)).sum())} samples that are no number",
                    f"{where}, row {_first(~np.isfinite(values))}",
                    "the simulation is driven by it at every sample",
                    "fill short gaps by interpolation, or cut the trial there",
                )
            )
    for name, values in motion(trial).items():
        if np.isinf(values).any():
            problems.append(
                Problem(f"'{name}' is infinite", f"{where}, row {_first(np.isinf(values))}", fix="mark gaps as NaN")
            )
        elif np.isnan(values).all():
            problems.append(Problem(f"'{name}' has no values", where, fix="measure it, or derive it from the others"))
        elif np.isnan(values[0]):
            problems.append(
                Problem(
                    f"'{name}' has no value in the first sample",
                    where,
                    "the simulation starts from it",
                    "cut the trial to its first complete row",
                )
            )
    problems += _units(trial, where)
    return problems


def _units(trial: Trial, where: str) -> list[Problem]:
    """Degrees or revolutions per minute where radians or revolutions per second belong."""
    problems: list[Problem] = []
    if np.nanmax(np.abs(trial.delta), initial=0.0) > LARGEST_RUDDER:
        problems.append(
            Problem(
                f"rudder angle up to {np.nanmax(np.abs(trial.delta)):.3g} rad",
                f"{where}, column 'delta'",
                f"a rudder beyond {LARGEST_RUDDER} rad is not physical; the column is probably in degrees",
                "multiply it by pi/180",
            )
        )
    if not np.isfinite(trial.t).all() or (np.diff(trial.t) <= 0.0).any():
        return problems
    turned = np.nansum(np.abs(_rate(trial.t, trial.psi)) * np.diff(trial.t))
    yawed = np.nansum(np.abs(_middle(trial.r)) * np.diff(trial.t))
    # Noise of a gyro adds to either sum; only a turn well above it can tell the unit.
    if max(turned, yawed) > 0.5 * np.sqrt(trial.n_samples):
        ratio = turned / max(yawed, 1e-12)
        for column, factor in (("psi", ratio), ("r", 1.0 / max(ratio, 1e-12))):
            if 30.0 < factor < 110.0:
                problems.append(
                    Problem(
                        f"'{column}' is {factor:.3g} times what the other of heading and yaw rate says",
                        f"{where}, columns 'psi' and 'r'",
                        f"it is probably in degrees ({1 / DEG:.1f} in a radian)",
                        f"multiply '{column}' by pi/180",
                    )
                )
    return problems


def check_trial(trial: Trial) -> list[Finding]:
    """What is odd about a trial that can be used, worst first."""
    where = str(trial.path or trial.id)
    found: list[Finding] = []
    dt = np.diff(trial.t)
    for name, values in motion(trial).items():
        missing = np.isnan(values)
        if missing.any():
            longest = max(len(part) for part in "".join("1" if m else " " for m in missing).split())
            found.append(
                Finding(
                    "warning",
                    f"'{name}' has gaps: {int(missing.sum())} samples, the longest {longest}",
                    where,
                    "they do not count in J",
                )
            )
    jumps = np.abs(np.diff(trial.psi)) > 5.0
    if jumps.any():
        found.append(
            Finding(
                "warning",
                "the heading jumps by a full turn",
                f"{where}, row {_first(jumps) + 1}",
                "it must be unwrapped",
                "apply numpy.unwrap to 'psi'",
            )
        )
    found += _kinematics(trial, where) + _inputs(trial, where)
    if dt.max() > 1.01 * dt.min():
        found.append(Finding("note", f"the time step varies between {dt.min():g} and {dt.max():g} s", where))
    if trial.source == "generated":
        found.append(Finding("note", "generated, not measured", where))
    elif not trial.source:
        found.append(
            Finding(
                "note", "the file does not say whether it was measured", where, fix="write the metadata key 'source'"
            )
        )
    order = {"warning": 0, "note": 1}
    return sorted(found, key=lambda finding: order[finding.severity])


def _kinematics(trial: Trial, where: str) -> list[Finding]:
    """Yaw rate against heading, and velocities against positions, read once as ship axes and once as earth axes."""
    found: list[Finding] = []
    dt = np.diff(trial.t)
    turned, yawed = np.nancumsum(_rate(trial.t, trial.psi) * dt), np.nancumsum(_middle(trial.r) * dt)
    span = max(np.ptp(turned), np.ptp(yawed))
    if span > 0.5 and np.abs(turned - yawed).max() > 0.1 * span:
        found.append(
            Finding(
                "warning",
                "the yaw rate does not integrate to the heading",
                where,
                f"they differ by up to {np.abs(turned - yawed).max() / DEG:.1f} deg",
                "check sign, scale and bias of 'r'",
            )
        )
    psi, u, v = _middle(trial.psi), _middle(trial.u), _middle(trial.v_m)
    moved = np.column_stack([np.diff(trial.x), np.diff(trial.y)])
    ship = np.column_stack([u * np.cos(psi) - v * np.sin(psi), u * np.sin(psi) + v * np.cos(psi)]) * dt[:, None]
    earth = np.column_stack([u, v]) * dt[:, None]
    path = np.nansum(np.hypot(*ship.T))
    error = {
        name: np.abs(np.nancumsum(moved - steps, axis=0)).max() for name, steps in (("ship", ship), ("earth", earth))
    }
    if path > 0.0 and error["ship"] > 0.1 * path + 5.0:
        fits = (
            "they fit if read in earth axes"
            if error["earth"] < 0.05 * path + 5.0
            else "nor do they fit read in earth axes"
        )
        found.append(
            Finding(
                "warning",
                "u, v and heading do not integrate to the positions",
                where,
                f"off by up to {error['ship']:.1f} m over {path:.0f} m; {fits}",
                "check axes, units and the point they are measured at",
            )
        )
    return found


def _inputs(trial: Trial, where: str) -> list[Finding]:
    """Sign of the rudder, speed of the controls, and revolutions in the wrong unit."""
    found: list[Finding] = []
    over = np.abs(trial.delta) > 3.0 * DEG
    if over.sum() > 20:
        r, side = trial.r[over], np.sign(trial.delta[over])
        agreement = float(np.nanmean(side * r)) / max(float(np.nanmean(np.abs(r))), 1e-12)
        if agreement < -0.3:
            found.append(
                Finding(
                    "warning",
                    "the ship turns away from its rudder",
                    f"{where}, column 'delta'",
                    "a positive angle must turn the ship to starboard",
                    "change the sign of 'delta'",
                )
            )
    rate = np.abs(np.diff(trial.delta)) / np.diff(trial.t)
    if rate.max() > 15.0 * DEG and np.abs(np.diff(trial.delta)).max() > 5.0 * DEG:
        found.append(
            Finding(
                "warning",
                f"the rudder moves at up to {rate.max() / DEG:.0f} deg/s",
                f"{where}, column 'delta'",
                "these may be orders, not positions",
                "use the measured rudder angle where there is one",
            )
        )
    if np.nanmax(np.abs(trial.n)) > 30.0:
        found.append(
            Finding(
                "warning",
                f"{np.nanmax(np.abs(trial.n)):.0f} revolutions per second",
                f"{where}, column 'n'",
                "probably per minute",
                "divide 'n' by 60",
            )
        )
    return found


def motion(trial: Trial) -> dict[str, FloatArray]:
    """Motion channels by their name in the file."""
    return dict(zip(MOTION, trial.motion.T, strict=True))


def _first(condition: object) -> int:
    return int(np.flatnonzero(np.asarray(condition))[0])


def _rate(t: FloatArray, values: FloatArray) -> FloatArray:
    return np.diff(values) / np.diff(t)


def _middle(values: FloatArray) -> FloatArray:
    return 0.5 * (values[1:] + values[:-1])
