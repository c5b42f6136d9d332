"""What an imported trial is worth: rates, gaps, spikes, and whether its channels tell of one and the same motion."""

from __future__ import annotations

import itertools
import math
from collections.abc import MutableSet, Set
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.integrate import cumulative_trapezoid

from ..arrays import FloatArray, runs_of_true
from ..errors import LogError, Problem
from ..inputs import INPUTS
from ..phrases import counted, figures
from ..physics.frame import to_earth
from ..trial import Trial, check_trial
from ..trial.checks.control_checks import fastest_change, looks_ordered
from ..trial.checks.finding import Finding
from ..trial.kinematics import Reading, position_misfits, turning
from ..units import DEG, KNOT, shown_in
from .conventions import rudder_evidence
from .doubts import doubts, fix_in_map
from .gridding import Grid
from .maps.mapping import LogMap
from .maps.quantities import MEASURED
from .proposing.elsewhere import yaw_rate_elsewhere
from .record import Record

WINDOWS = 16
"""Parts of a record in which units are compared."""


def quality_of(
    trial: Trial, record: Record, grid: Grid, began: float, notes: list[str], log_map: LogMap
) -> dict[str, Any]:
    """The quality of one trial, for people and as JSON; numbers that do not exist are None.

    began  time of the trial's first sample on the log's clock [s]
    """
    columns = trial.columns
    turned = turning(columns)
    misfits = position_misfits(columns, among=(Reading.AS_ASKED, Reading.IN_EARTH_AXES))
    findings = [
        _named(replace(one, fix=fix_in_map(one.fix)), record, log_map)
        for one in (*check_trial(trial, usable=True), *doubts(trial, record, log_map))
    ]
    evidence = rudder_evidence(trial.t, columns)
    return {
        "id": trial.id,
        "log": str(record.path),
        "n_samples": trial.n_samples,
        "step_s": grid.step,
        "duration_s": trial.duration,
        "began_s": began,
        "rates": {
            name: {"median_step_s": one.step, "longest_step_s": _longest(one.t, one.values), "n_samples": len(one.t)}
            for name, one in record.series.items()
        },
        "gaps": [gap for name in MEASURED for gap in _gaps(trial.t, columns[name], name)],
        "spikes": dict(record.spikes),
        "bridged": dict(grid.bridged),
        "yaw": {
            "heading_turns_deg": float(np.ptp(turned.heading)) / DEG,
            "largest_difference_deg": turned.miss / DEG,
            "ratio": turned.ratio if np.std(turned.yaw) > 0.0 else None,
            "correlation": turned.correlation,
            "recovered": _recovered(record),
        },
        "positions": {
            "ship_axes": _or_none(misfits.get(Reading.AS_ASKED)),
            "earth_axes": _or_none(misfits.get(Reading.IN_EARTH_AXES)),
            **_residuals(trial, record, began, log_map),
        },
        "rudder": {
            "agreement": evidence.agreement,
            "gain_standard_errors": evidence.gain,
            "n_samples": evidence.samples,
            "side": {1: "starboard", -1: "port", 0: "in doubt"}[evidence.side],
            "doubt": evidence.doubt,
        },
        "controls": {name: _changes(trial, name) for name in log_map.inputs},
        "notes": notes,
        "findings": [vars(one) for one in findings],
    }


Told = tuple[str, str]
"""Why something is wrong, and the fix."""


def quality_text(quality: dict[str, Any], common: Set[str] = frozenset(), told: MutableSet[Told] | None = None) -> str:
    """The quality of one trial, as lines for people.

    common  notes that are said elsewhere
    told    reasons and fixes that were given before, which are not said again; those given here are added
    """
    given: MutableSet[Told] = set() if told is None else told
    q = quality
    lines = [
        (
            f"{q['id']}: {q['n_samples']} samples, {q['duration_s']:.6g} s from {q['began_s']:.12g} s of the log, "
            f"step {q['step_s']:.6g} s ({q['log']})"
        )
    ]
    by_step: dict[tuple[float, float], list[str]] = {}
    for name, rate in q["rates"].items():
        by_step.setdefault((rate["median_step_s"], rate["longest_step_s"]), []).append(name)
    for (median, longest), names in by_step.items():
        lines.append(f"  rate      every {median:.4g} s, longest {longest:.4g} s: {', '.join(names)}")
    shown = q["gaps"][:6]
    lines += [
        f"  gap       {g['channel']}: {counted(g['n_samples'], 'sample')} from {g['from_s']:.6g} to {g['to_s']:.6g} s"
        for g in shown
    ]
    if len(q["gaps"]) > len(shown):
        lines.append(f"  gap       and {len(q['gaps']) - len(shown)} more")
    if q["spikes"]:
        lines.append("  spikes    " + ", ".join(f"{name}: {count}" for name, count in q["spikes"].items()))
    if q["bridged"]:
        lines.append(
            "  bridged   " + ", ".join(f"{name}: {counted(count, 'sample')}" for name, count in q["bridged"].items())
        )
    yaw, positions, rudder = q["yaw"], q["positions"], q["rudder"]
    lines.append(
        f"  yaw       integral of r and heading differ by up to {yaw['largest_difference_deg']:.3g} deg "
        f"in {yaw['heading_turns_deg']:.4g} deg"
    )
    if positions["ship_axes"] is None:
        lines.append("  positions cannot be compared with velocities: the ship hardly moves")
    else:
        lines.append(
            f"  positions missed by u, v, psi by {figures(100 * positions['ship_axes'])} % of the distance; "
            f"read in earth axes by {figures(100 * positions['earth_axes'])} %"
        )
    if positions["residual_x_m"] is not None and positions["residual_y_m"] is not None:
        said = f"  residual  integrated velocities leave x by {positions['residual_x_m']:.3g} m rms, y by "
        said += f"{positions['residual_y_m']:.3g} m"
        if positions["rounding_x_m"] is not None and positions["rounding_y_m"] is not None:
            said += f"; rounding alone {positions['rounding_x_m']:.3g} and {positions['rounding_y_m']:.3g} m"
        lines.append(said)
    way = {
        "starboard": "the ship turns to the side of it",
        "port": "the ship turns away from it",
        "in doubt": "this run alone does not tell by which side of it the ship turns",
    }[rudder["side"]]
    doubt = f" ({rudder['doubt']})" if rudder["doubt"] else ""
    lines.append(f"  rudder    {way}{doubt}: agreement {rudder['agreement']:+.2f}")
    by_input = []
    for name, changes in q["controls"].items():
        unit = shown_in(INPUTS[name].unit)[0]
        orders = "ORDERS? " if changes["orders"] else ""
        by_input.append(f"{INPUTS[name].words} {orders}up to {changes[f'fastest_{unit}_per_s']:.3g} {unit}/s")
    lines.append("  controls  " + ", ".join(by_input))
    lines += [f"  note      {note}" for note in q["notes"] if note not in common]
    for f in q["findings"]:
        if f["severity"] != "note":
            more = [f["why"], f"fix: {f['fix']}" if f["fix"] else ""] if (f["why"], f["fix"]) not in given else []
            given.add((f["why"], f["fix"]))
            lines.append("; ".join([f"  {f['severity']}   {f['what']}", *filter(None, more)]))
    return "\n".join(lines)


def _recovered(record: Record) -> dict[str, float] | None:
    if record.recovered is None:
        return None
    missed, rounding, wander = record.recovered
    return {"missed_deg": missed / DEG, "rounding_deg": rounding / DEG, "wander_deg": wander / DEG}


def _named(finding: Finding, record: Record, log_map: LogMap) -> Finding:
    """A warning of a yaw rate that is none, with the column that is one where the log has it."""
    elsewhere = yaw_rate_elsewhere(record.path, log_map) if finding.code == "yaw-rate" else None
    if elsewhere is None:
        return finding
    return replace(finding, why=f"{finding.why}; {elsewhere[0]}", fix=elsewhere[1])


def same_units_throughout(t: FloatArray, columns: dict[str, FloatArray], where: str) -> None:
    """Raise LogError where a unit changes within a record: heading against yaw rate, velocities against positions."""
    edges = np.linspace(0, len(t) - 1, WINDOWS + 1).astype(np.intp)
    ratios: dict[str, list[tuple[float, float]]] = {"turn": [], "way": []}
    for first, last in itertools.pairwise(edges):
        part = slice(int(first), int(last) + 1)
        dt = np.diff(t[part])
        if len(dt) < 4:
            return
        if {"psi", "r"} <= set(columns):
            turned = float(np.nansum(np.abs(np.diff(columns["psi"][part]))))
            yawed = float(np.nansum(np.abs(columns["r"][part][1:]) * dt))
            if min(turned, yawed) > 0.0 and max(turned, yawed) > 0.05:
                ratios["turn"].append((float(t[first]), yawed / turned))
        if {"u", "v", "x", "y"} <= set(columns):
            run = float(np.hypot(*(columns[name][part][-1] - columns[name][part][0] for name in ("x", "y"))))
            logged = float(np.nansum(np.hypot(columns["u"][part], columns["v"][part])[1:] * dt))
            if math.isfinite(run) and run > 0.0 and logged > 0.0:
                ratios["way"].append((float(t[first]), logged / run))
    for name, factor, what in (
        ("turn", 1.0 / DEG, "the unit of heading or yaw rate changes within the log"),
        ("way", 1.0 / KNOT, "the unit of velocities or positions changes within the log"),
    ):
        right = [at for at, ratio in ratios[name] if abs(ratio - 1.0) < 0.1]
        for other in (factor, 1.0 / factor):
            wrong = [at for at, ratio in ratios[name] if abs(ratio / other - 1.0) < 0.1]
            if len(right) >= 2 and len(wrong) >= 2 and len(right) + len(wrong) > 0.7 * len(ratios[name]):
                why = f"they agree at {right[0]:.6g} s and differ by a factor of {other:.4g} at {wrong[0]:.6g} s"
                fix = "write the log in one unit, or cut it with [cut] where the unit changes"
                raise LogError(Problem(what, where, why, fix))


def _residuals(trial: Trial, record: Record, began: float, log_map: LogMap) -> dict[str, float | None]:
    """Rms distance of integrated velocities from the positions as printed, less its mean, and that of rounding [m].

    Where positions are moved from an antenna, from those of the trial, and without that of rounding.
    """
    psi, u, v = trial.psi, trial.u, trial.v_m
    known = np.isfinite(psi) & np.isfinite(u) & np.isfinite(v)
    names = ("residual_x_m", "residual_y_m", "rounding_x_m", "rounding_y_m")
    found: dict[str, float | None] = dict.fromkeys(names)
    # An integral goes on over single spikes, not over holes.
    if known.mean() < 0.99:
        return found
    psi, u, v = (np.interp(trial.t, trial.t[known], values[known]) for values in (psi, u, v))
    ways = to_earth(psi, u, v)
    for name, way in zip(("x", "y"), ways, strict=True):
        run = cumulative_trapezoid(way, trial.t, initial=0.0)
        series = record.series[name]
        if series.printed is None or series.coarse is None or log_map.antenna is not None:
            miss = trial.columns[name] - run
        else:
            inside = (series.t >= began - 1e-9) & (series.t <= began + trial.t[-1] + 1e-9) & np.isfinite(series.printed)
            miss = series.printed[inside] - np.interp(series.t[inside] - began, trial.t, run)
            found[f"rounding_{name}_m"] = _or_none(float(np.sqrt(np.mean(series.coarse[inside] ** 2) / 12.0)))
        found[f"residual_{name}_m"] = _or_none(float(np.nanstd(miss)))
    return found


def _changes(trial: Trial, name: str) -> dict[str, Any]:
    """How fast an input changes, in units people read, and whether only orders do so."""
    step, rate = fastest_change(trial, name)
    unit, factor = shown_in(INPUTS[name].unit)
    return {
        f"fastest_{unit}_per_s": rate * factor,
        f"largest_step_{unit}": step * factor,
        "orders": looks_ordered(trial, name),
    }


def _gaps(t: FloatArray, values: FloatArray, name: str) -> list[dict[str, Any]]:
    return [
        {"channel": name, "from_s": float(t[a]), "to_s": float(t[b - 1]), "n_samples": b - a}
        for a, b in runs_of_true(np.isnan(values))
    ]


def _longest(t: FloatArray, values: FloatArray) -> float:
    times = t[np.isfinite(values)]
    return float(np.diff(times).max()) if len(times) > 1 else 0.0


def _or_none(value: float | None) -> float | None:
    return None if value is None or not math.isfinite(value) else float(value)
