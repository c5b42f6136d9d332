"""Records with known indices: analytic circles and zigzags."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mmgtune.manoeuvres import Track

DEG = np.pi / 180.0
L = 100.0
U = 5.0
R = 250.0
"""Speed [m/s] and radius [m] of the circle: 0.02 rad/s."""

T_ORDER = 60.0
RUDDER_RATE = 2.3 * DEG


def integrated(t, rate_of, beta_of, drift=(0.0, 0.0), psi_0=0.0):
    """Heading and position of a ship at speed U, summed up on a grid 20 times finer than t."""
    fine = np.interp(np.arange(20 * (t.size - 1) + 1) / 20.0, np.arange(t.size), t)
    middle, step = 0.5 * (fine[1:] + fine[:-1]), np.diff(fine)
    turned = rate_of(middle) * step
    psi = psi_0 + np.r_[0.0, np.cumsum(turned)]
    course = psi[:-1] + 0.5 * turned - beta_of(middle)
    x = np.r_[0.0, np.cumsum((U * np.cos(course) + drift[0]) * step)]
    y = np.r_[0.0, np.cumsum((U * np.sin(course) + drift[1]) * step)]
    return psi[::20], x[::20], y[::20]


def ramp(t, begin, before, after, rate=RUDDER_RATE):
    """Rudder that leaves ``before`` at ``begin`` and moves to ``after``; ``before`` may be a channel."""
    moved = np.clip(rate * (t - begin), 0.0, None)
    gap = after - before
    return before + np.sign(gap) * np.minimum(moved, np.abs(gap))


def circle(
    side=1,
    beta=0.0,
    end=700.0,
    t=None,
    keeping=0.0,
    drift=(0.0, 0.0),
    psi_0=0.0,
    angle=35.0 * DEG,
    pull_out=None,
    residual=0.0,
    rate=RUDDER_RATE,
):
    """Straight to T_ORDER, then a circle of radius R at drift angle beta; ``pull_out`` [s] ends it.

    keeping  amplitude of a course-keeping rudder before the order [rad]
    """
    t = np.arange(0.0, end + 0.25, 0.5) if t is None else t
    over = U / R

    def rate_of(time):
        r = np.where(time >= T_ORDER, over, 0.0)
        if pull_out is not None:
            out = residual + (over - residual) * np.exp(-(time - pull_out) / 30.0)
            r = np.where(time >= pull_out, out, r)
        return side * r

    def beta_of(time):
        return side * np.where(time >= T_ORDER, beta, 0.0)

    psi, x, y = integrated(t, rate_of, beta_of, drift, psi_0)
    before = np.where(t <= T_ORDER, keeping * np.sin(2.0 * np.pi * (t - T_ORDER) / 25.0), 0.0)
    delta = ramp(t, T_ORDER, before, side * angle, rate)
    if pull_out is not None:
        delta = np.where(t > pull_out, ramp(t, pull_out, side * angle, 0.0), delta)
    b = beta_of(t)
    u = U * np.cos(b) + drift[0] * np.cos(psi) + drift[1] * np.sin(psi)
    v_m = -U * np.sin(b) - drift[0] * np.sin(psi) + drift[1] * np.cos(psi)
    return Track(t=t, x=x, y=y, psi=psi, u=u, v_m=v_m, delta=delta)


OMEGA = 2.0 * np.pi / 300.0
AMPLITUDES = (17.0 * DEG, 26.0 * DEG, 21.0 * DEG, 15.0 * DEG)
"""Heading peaks of the zigzag, one for each half wave."""


def zigzag(side=1, rudder=10.0 * DEG, actual=10.4 * DEG, t=None, end=640.0, psi_0=0.0, keeping=0.0):
    """Half sines of heading of known height; the rudder is ordered back at the heading ``actual``."""
    t = np.arange(0.0, end, 0.5) if t is None else t
    phase = np.clip(OMEGA * (t - T_ORDER), 0.0, None)
    half = np.floor(phase / np.pi).astype(int)
    psi = psi_0 + side * np.asarray(AMPLITUDES)[np.clip(half, 0, 3)] * np.sin(phase)
    delta = np.where(t <= T_ORDER, keeping * np.sin(2.0 * np.pi * (t - T_ORDER) / 25.0), 0.0)
    delta = ramp(t, T_ORDER, delta, side * rudder)
    for k, time in enumerate(order_times(actual)):
        delta = np.where(t > time, ramp(t, time, side * (-1) ** k * rudder, -side * (-1) ** k * rudder), delta)
    zero = np.zeros_like(t)
    course = np.r_[0.0, np.cumsum(np.diff(t) * U * np.cos(0.5 * (psi[1:] + psi[:-1])))]
    across = np.r_[0.0, np.cumsum(np.diff(t) * U * np.sin(0.5 * (psi[1:] + psi[:-1])))]
    return Track(t=t, x=course, y=across, psi=psi, u=zero + U, v_m=zero, delta=delta)


def order_times(actual):
    """Times of the counter-orders [s]."""
    return [T_ORDER + (k * np.pi + np.arcsin(actual / a)) / OMEGA for k, a in enumerate(AMPLITUDES)]


def uneven(end, seed=1):
    """Time stamps 0.2 to 0.8 s apart, the order among them."""
    steps = np.random.default_rng(seed).uniform(0.2, 0.8, int(end / 0.5))
    return np.unique(np.r_[np.cumsum(steps), T_ORDER])


def noisy(track, seed=0, psi=0.0, delta=0.0):
    """The record with normal noise on heading and rudder [rad]."""
    rng = np.random.default_rng(seed)
    return replace(
        track,
        psi=track.psi + psi * rng.standard_normal(track.t.size),
        delta=track.delta + delta * rng.standard_normal(track.t.size),
    )


def cut(track, begin=0.0, end=np.inf):
    """The part of a record between two times [s]."""
    keep = (track.t >= begin) & (track.t <= end)
    names = ("t", "x", "y", "psi", "u", "v_m", "delta")
    return Track(**{name: getattr(track, name)[keep] for name in names})
