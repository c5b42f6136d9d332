"""Zigzag: overshoots, times and distances.

IMO MSC.137(76) and MSC/Circ.1053: after a steady approach the rudder is put over (first execute); when the heading has
changed by the check angle from the original course, the rudder is reversed (second execute); and so on.  The first,
second ... overshoot angle is the additional heading deviation after the second, third ... execute.  Helmsmen reverse
late, so there are two readings of "additional", and both are given: beyond the check heading, original course plus or
minus the check angle (``overshoot``, what publications print and the criteria are applied to), and beyond the heading
at which the rudder was reversed indeed (``overshoot_from_execute``).

Initial turning time as in ITTC 7.5-04-02-01.  Time to check yaw, reach and period are as recalled from the latter and
were not checked against it.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np

from ..arrays import FloatArray
from ..units import DEG
from .track import (
    Direction,
    Execute,
    Track,
    approach_speed,
    find_execute,
    find_executes,
    first_crossing,
    heading_at,
    integral,
    noise_level,
    original_course,
    turn_rate_at,
    value_at,
    with_units,
)

USUAL_ANGLES = (1.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0)
"""Angles zigzags are named by [deg]; what was measured near one is taken for it."""

REACTION = 0.1
"""Time in which a rudder is reversed once the ship is at its check heading, at most [time the ship takes for its own
length]: HSVA's model needs 0.06, MARIN's 0.05; a choice of this program."""


@dataclass(frozen=True, kw_only=True)
class ZigzagIndices:
    """A zigzag in numbers, headings counted from the original course; tuples hold what the record reaches, first first.

    A zigzag "35/5" has a rudder angle of 35 deg and a check angle of 5 deg.
    """

    direction: Direction  # side of the first order
    L_pp: Annotated[float, "m"]  # length between perpendiculars
    execute_at_start: bool  # the record begins with the rudder over: times and distances count from its first sample
    approach_speed: Annotated[float, "m/s"]  # mean over the last ship length before the first order
    rudder_angle: Annotated[float, "rad"]  # nominal rudder angle
    heading_angle: Annotated[float | None, "rad"]  # check angle; None with no counter-order and none given
    rudder_held: Annotated[float, "rad"]  # median of the angles held
    execute_time: Annotated[tuple[float, ...], "s"]  # of each order, on the record's clock
    execute_heading: Annotated[tuple[float, ...], "rad"]  # at each counter-order, positive to the side turned to before
    overshoot: Annotated[tuple[float, ...], "rad"]  # peak beyond the check heading, as publications give it
    overshoot_from_execute: Annotated[tuple[float, ...], "rad"]  # peak beyond the heading at the counter-order
    time_to_check_yaw: Annotated[tuple[float, ...], "s"]  # from each counter-order to the peak
    initial_turning_time: Annotated[float | None, "s"]  # from the first order to the check heading
    initial_turning_distance: Annotated[float | None, "m"]  # travelled in that time
    reach: Annotated[float | None, "s"]  # from the first order until back on the original course after the second
    period: Annotated[float | None, "s"]  # from the first order until there after the third: a complete cycle

    @property
    def order(self) -> str:
        """The zigzag's name, rudder angle over check angle [deg]: "35/5", or "20/?" with no check angle known."""
        check = "?" if self.heading_angle is None else f"{self.heading_angle / DEG:.3g}"
        return f"{self.rudder_angle / DEG:.3g}/{check}"

    def to_dict(self) -> dict[str, Any]:
        """The order, and fields by names with their unit: overshoot_1_deg, overshoot_from_execute_1_deg, reach_s ..."""
        return {"order": self.order, **with_units(self, self.L_pp)}


def zigzag_indices(track: Track, L_pp: float, nominal: tuple[float, float | None] | None = None) -> ZigzagIndices:
    """Indices of a zigzag, measured or simulated.

    track    the record
    L_pp     length between perpendiculars [m]
    nominal  rudder and check angle of the zigzag [rad], the latter None where it is not known; without ``nominal`` each
             is the usual angle near the median of what was done, see ``usual_angle``

    Raises TrialError where no rudder order is found.
    """
    first, t = find_execute(track), track.t
    orders = [first]
    for order in find_executes(track)[1:]:
        if order.side != -orders[-1].side:
            break
        orders.append(order)
    course = original_course(track, first.index, L_pp)
    heading = first.side * (track.psi - course)
    sides = [(-1.0) ** k for k in range(len(orders) - 1)]
    counter = [
        side * first.side * (heading_at(track, order.index, L_pp) - course)
        for side, order in zip(sides, orders[1:], strict=True)
    ]
    held = float(np.median([order.angle for order in orders]))
    if nominal is None:
        nominal = usual_angle(held), _check_angle(track, orders[1:], counter, L_pp)
    rudder_angle, heading_angle = nominal
    ends = [order.index for order in orders[2:]] + [orders[-1].end] * (len(orders) > 1)
    peaks = []
    for side, order, end in zip(sides, orders[1:], ends, strict=True):
        if (peak := heading_peak(t, side * heading, order.index, end, open_end=order is orders[-1])) is None:
            break
        peaks.append(peak)
    target = np.inf if heading_angle is None else heading_angle
    turned = first_crossing(heading, target, first.index, ends[0] if counter else first.end)
    back = [
        first_crossing(-side * heading, 0.0, order.index, end)
        for side, order, end in zip(sides, orders[1:], ends, strict=True)
    ]
    begun = float(t[first.index])
    times = [None if position is None else value_at(t, position) - begun for position in back]
    return ZigzagIndices(
        direction=first.direction,
        L_pp=L_pp,
        execute_at_start=first.at_start,
        approach_speed=approach_speed(track, first.index, L_pp),
        rudder_angle=rudder_angle,
        heading_angle=heading_angle,
        rudder_held=held,
        execute_time=tuple(float(t[order.index]) for order in orders),
        execute_heading=tuple(counter),
        overshoot=tuple(top - heading_angle for _, top in peaks) if heading_angle is not None else (),
        overshoot_from_execute=tuple(top - at for (_, top), at in zip(peaks, counter, strict=False)),
        time_to_check_yaw=tuple(when - float(t[o.index]) for (when, _), o in zip(peaks, orders[1:], strict=False)),
        initial_turning_time=None if turned is None else value_at(t, turned) - begun,
        initial_turning_distance=None if turned is None else integral(t, track.speed, first.index, turned),
        reach=times[0] if times else None,
        period=times[1] if len(times) > 1 else None,
    )


def manoeuvre_kind(track: Track) -> Literal["turning", "zigzag", "other"]:
    """Which standard manoeuvre a record without a label holds, from rudder and heading alone.

    turning: one held angle turns the ship by 60 deg or more.  zigzag: the rudder is held at both sides in turn and
    the heading stays within 120 deg of the approach.  Both: the rudder is held for 60 % of the time at least.
    """
    executes = find_executes(track)
    if not executes:
        return "other"
    first, last = executes[0], executes[-1]
    held = sum(track.t[item.end] - track.t[item.start] for item in executes)
    if held < 0.6 * (track.t[last.end] - track.t[first.index]):
        return "other"
    heading = track.psi[first.index : last.end + 1] - track.psi[first.index]
    sides = [item.side for item in executes]
    if len(executes) > 1 and all(a == -b for a, b in pairwise(sides)):
        return "zigzag" if np.max(np.abs(heading)) <= 120.0 * DEG else "other"
    return "turning" if len(executes) == 1 and first.side * heading[-1] >= 60.0 * DEG else "other"


def usual_angle(measured: float, late: float = 0.0) -> float:
    """The usual angle near the measured one, else the nearest whole degree [rad].

    Near is within 1 deg or 7 % of it; the measured angle may also exceed it by ``late`` [rad].
    """
    degrees = measured / DEG

    def near(angle: float) -> bool:
        margin = max(1.0, 0.07 * angle)
        return -margin <= degrees - angle <= max(margin, late / DEG)

    found = min(filter(near, USUAL_ANGLES), key=lambda angle: abs(angle - degrees), default=float(round(degrees)))
    return found * DEG


def _check_angle(track: Track, counter_orders: list[Execute], counter: list[float], L_pp: float) -> float | None:
    """The usual check angle of headings ``counter`` [rad] at the counter-orders; None without any.

    Both sides count alike, so that an original course that was not quite met drops out.  The rudder is reversed late,
    at the ship's own rate of turn and by a sample at least.
    """
    by_side = [float(np.median(part)) for part in (counter[::2], counter[1::2]) if part]
    if not by_side:
        return None
    rates = [abs(turn_rate_at(track, order.index, L_pp)) for order in counter_orders]
    reaction = REACTION * L_pp / max(approach_speed(track, counter_orders[0].index, L_pp), 1e-6)
    delay = max(reaction, float(np.median(np.diff(track.t))))
    return usual_angle(float(np.mean(by_side)), late=delay * float(np.median(rates)))


def heading_peak(
    t: FloatArray, heading: FloatArray, begin: int, end: int, *, open_end: bool
) -> tuple[float, float] | None:
    """Time [s] and height [rad] of the heading's peak in samples begin..end.

    A parabola through the samples within five standard deviations of the noise below the highest one, three at
    least.  With ``open_end`` None unless the heading has come down from it again, by more than the noise.
    """
    depth = 5.0 * noise_level(t, heading)
    part = heading[begin : end + 1]
    top = int(np.argmax(part))
    if top == part.size - 1 or (open_end and part[-1] >= part[top] - depth):
        return None
    if top == 0:
        return float(t[begin]), float(part[0])
    below = part < part[top] - depth
    left = top - int(np.argmax(below[top::-1])) if below[:top].any() else 0
    right = top + int(np.argmax(below[top:])) if below[top:].any() else part.size - 1
    near = slice(begin + left, begin + right + 1)
    scale = max(float(t[near][-1] - t[near][0]), 1e-12)
    a, b, c = np.polyfit((t[near] - t[begin + top]) / scale, heading[near] - part[top], 2)
    if a >= 0.0:
        return float(t[begin + top]), float(part[top])
    return float(t[begin + top] - 0.5 * scale * b / a), float(part[top] + c - 0.25 * b * b / a)
