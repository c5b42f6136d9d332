"""Instruments and the log they are written to: noise that lasts, digits that are cut, defects that nobody noted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mmgtune.trial import Trial

from .plant import DEG, MARGIN, STEP


@dataclass(frozen=True)
class Instruments:
    """Usual imperfections, then defects that may be hidden.  s, m, rad; ``*_step`` is the last digit."""

    every: float = 1.0
    jitter: float = 0.0
    position: float = 0.4
    position_lasts: float = 8.0
    position_step: float = 0.05
    velocity: float = 0.02
    velocity_lasts: float = 2.0
    velocity_step: float = 0.01
    heading: float = 0.12 * DEG
    heading_lasts: float = 3.0
    heading_step: float = 0.1 * DEG
    yaw_rate: float = 0.02 * DEG
    yaw_rate_step: float = 0.01 * DEG
    rudder: float = 0.03 * DEG
    rudder_step: float = 0.1 * DEG
    turns: float = 0.2 / 60.0
    turns_step: float = 0.1 / 60.0
    held: float = 0.0  # positions come this seldom [s]; 0: with each line
    gaps: int = 0
    # hidden
    clock: float = 0.0  # inputs are logged so late
    heading_off: float = 0.0
    deviation_B: float = 0.0
    deviation_C: float = 0.0
    yaw_rate_off: float = 0.0
    heading_drift: float = 0.0  # [rad/s]
    log_scale: float = 1.0
    antenna_x: float = 0.0
    antenna_y: float = 0.0
    late: float = 0.0  # of positions
    mean_over: float = 0.0  # velocities are means over the last so many seconds
    fast: float = 1.0  # how fast the clock of the log runs


def _lasting(rng: np.random.Generator, n: int, sd: float, lasts: float, every: float) -> np.ndarray:
    """Noise of the first order of standard deviation ``sd`` and time constant ``lasts`` (n,)."""
    keep = np.exp(-every / lasts) if lasts > 0.0 else 0.0
    drawn = rng.standard_normal(n) * sd
    for i in range(1, n):
        drawn[i] = keep * drawn[i - 1] + np.sqrt(1.0 - keep**2) * drawn[i]
    return drawn


def _cut(values: np.ndarray, step: float) -> np.ndarray:
    return np.round(values / step) * step if step > 0.0 else values


def write_up(rows: np.ndarray, by: Instruments, rng: np.random.Generator, **facts: str) -> Trial:
    """The trial that is logged of what a ship did; ``rows`` as ``plant.sail`` gives them."""
    clock = rows[:, 0]
    n = int((clock[-1] - 1.0) / by.every)
    true = np.arange(n) * by.every
    if by.jitter > 0.0:
        true[1:] += rng.uniform(-by.jitter, by.jitter, n - 1)
    kept = {name: rows[:, i] for i, name in enumerate(("t", "x", "y", "psi", "u", "v", "r", "delta", "n"))}

    def at(series: np.ndarray, when: np.ndarray) -> np.ndarray:
        return np.interp(when, clock, series)

    # a mean of the velocities over ground, north and east, as receivers make it
    c, s = np.cos(kept["psi"]), np.sin(kept["psi"])
    north, east = kept["u"] * c - kept["v"] * s, kept["u"] * s + kept["v"] * c
    r_here = kept["r"]
    # the antenna is where the receiver is
    north -= r_here * (by.antenna_x * s + by.antenna_y * c)
    east += r_here * (by.antenna_x * c - by.antenna_y * s)
    if by.mean_over > 0.0:
        window = max(int(by.mean_over / STEP), 1)
        kernel = np.ones(window) / window
        north, east = (np.convolve(np.pad(one, (window - 1, 0), "edge"), kernel, "valid") for one in (north, east))
    x = kept["x"] + by.antenna_x * c - by.antenna_y * s
    y = kept["y"] + by.antenna_x * s + by.antenna_y * c
    when = true - by.late
    if by.held > 0.0:
        when = np.floor(when / by.held) * by.held
        when = np.maximum(when, -MARGIN)
    psi = at(kept["psi"], true)
    shown = psi + by.heading_off + by.deviation_B * np.sin(psi) + by.deviation_C * np.cos(psi) + by.heading_drift * true
    vn, ve = at(north, true), at(east, true)
    u = (vn * np.cos(shown) + ve * np.sin(shown)) * by.log_scale
    v = ve * np.cos(shown) - vn * np.sin(shown)

    wander = [_lasting(rng, n, by.position, by.position_lasts, by.every) for _ in range(2)]
    if by.held > 0.0:
        last = np.searchsorted(true, np.maximum(when, 0.0) - 1e-9)
        wander = [one[np.minimum(last, n - 1)] for one in wander]
    columns = {
        "x": _cut(at(x, when) - x[0] + wander[0], by.position_step),
        "y": _cut(at(y, when) - y[0] + wander[1], by.position_step),
        "psi": _cut(shown + _lasting(rng, n, by.heading, by.heading_lasts, by.every), by.heading_step),
        "u": _cut(u + _lasting(rng, n, by.velocity, by.velocity_lasts, by.every), by.velocity_step),
        "v_m": _cut(v + _lasting(rng, n, by.velocity, by.velocity_lasts, by.every), by.velocity_step),
        "r": _cut(at(r_here, true) + by.yaw_rate_off + by.yaw_rate * rng.standard_normal(n), by.yaw_rate_step),
        "n": _cut(at(kept["n"], true - by.clock) + by.turns * rng.standard_normal(n), by.turns_step),
        "delta": _cut(at(kept["delta"], true - by.clock) + by.rudder * rng.standard_normal(n), by.rudder_step),
    }
    for _ in range(by.gaps):
        begins, lasts = int(rng.integers(5, n - 30)), int(rng.integers(3, 15))
        for name in ("x", "y", "u", "v_m") if rng.random() < 0.7 else ("psi", "r"):
            columns[name][begins : begins + lasts] = np.nan
    return Trial(t=true * by.fast, source="measured", **columns, **facts)
