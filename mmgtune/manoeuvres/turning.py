"""Turning circle: advance, tactical diameter, steady turn and pull-out.

Distances as defined in IMO MSC.137(76), section 4: of the midship point, along and across the heading at the
order, from the position at the order.  Transfer, the largest distances and the residual rate follow common
practice as recalled; they were not checked against a source.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from ..arrays import FloatArray
from ..errors import Problem, TrialError
from ..physics.frame import to_ship
from ..units import DEG
from .track import (
    Direction,
    Execute,
    Track,
    approach_speed,
    find_execute,
    first_crossing,
    heading_at,
    integral,
    value_at,
    with_units,
)

HALF_TURN, FULL_TURN = 180.0 * DEG, 360.0 * DEG

Metres = Annotated[float | None, "m"]
Seconds = Annotated[float | None, "s"]
Speed = Annotated[float | None, "m/s"]
Angle = Annotated[float | None, "rad"]
Rate = Annotated[float | None, "rad/s"]


@dataclass(frozen=True, kw_only=True)
class TurningIndices:
    """A turning circle in numbers, the same for a turn to port; None where the record does not reach it.

    Steady values are means over the end of the turn before a pull-out: over its last full turn, or over what a
    record of 360 to 540 deg holds after 180 deg.
    """

    direction: Direction  # side turned to
    L_pp: Annotated[float, "m"]  # length between perpendiculars
    execute_time: Annotated[float, "s"]  # of the rudder order, on the record's clock
    execute_at_start: bool  # the record begins with the rudder over: times and distances count from its first sample
    rudder_angle: Annotated[float, "rad"]  # median angle held, positive
    approach_speed: Annotated[float, "m/s"]  # mean over the last ship length before the order
    advance: Metres  # along the heading at the order, at 90 deg change of heading
    transfer: Metres  # across, positive to the side of the turn, at 90 deg
    tactical_diameter: Metres  # across at 180 deg
    max_advance: Metres  # largest distance along, in the first turn
    max_transfer: Metres  # largest distance across, in the first turn
    time_90: Seconds  # from the order to 90 deg change of heading
    time_180: Seconds
    time_270: Seconds
    time_360: Seconds
    speed_ratio_90: float | None  # speed at 90 deg over approach speed [-]; None from rest
    speed_ratio_180: float | None
    speed_ratio_360: float | None
    initial_turning_distance: Metres  # travelled from the order to 10 deg change of heading
    steady_heading_change: Angle  # what the steady values are means over
    steady_speed: Speed
    steady_yaw_rate: Rate  # change of heading over time, positive
    steady_diameter: Metres  # 2 U / |r| of the two
    steady_drift_angle: Angle  # arctan(-v_m / u), positive with the bow turned into the circle
    residual_rate: Rate  # over the last quarter of a pull-out of two ship lengths' time or more, positive as the turn
    drift_north: Speed  # uniform drift over ground, from points one full turn apart
    drift_east: Speed
    drift_pairs: int  # number of such pairs, 0 where the turn ends before 540 deg
    drift_subtracted: bool  # all other numbers are of the motion less that drift

    def to_dict(self) -> dict[str, Any]:
        """The fields by names with their unit, e.g. advance_m, advance_over_L, rudder_angle_deg."""
        return with_units(self, self.L_pp)


def turning_indices(track: Track, L_pp: float, *, subtract_drift: bool = False) -> TurningIndices:
    """Indices of a turning circle, measured or simulated.

    track           the record
    L_pp            length between perpendiculars [m]
    subtract_drift  take the estimated uniform drift out first; by default it is reported only

    Raises TrialError where no rudder order is found, or no drift to subtract can be estimated.
    """
    order = find_execute(track)
    drift = _uniform_drift(track, order, L_pp)
    if subtract_drift:
        if drift is None:
            raise TrialError(
                Problem("drift cannot be subtracted", "psi", "it takes 540 deg change of heading with the rudder held")
            )
        track = _through_water(track, order, drift)
    e, t, speed = order.index, track.t, track.speed
    phi = _turned(track, order, L_pp)
    along, across = _from_order(track, order, L_pp)
    approach = approach_speed(track, e, L_pp)
    at = {deg: first_crossing(phi, deg * DEG, e, order.end) for deg in (10, 90, 180, 270, 360)}

    def reached(values: FloatArray, deg: int) -> float | None:
        return None if (position := at[deg]) is None else value_at(values, position)

    def speed_ratio(deg: int) -> float | None:
        return None if approach == 0.0 or (U := reached(speed, deg)) is None else U / approach

    return TurningIndices(
        direction=order.direction,
        L_pp=L_pp,
        execute_time=float(t[e]),
        execute_at_start=order.at_start,
        rudder_angle=order.angle,
        approach_speed=approach,
        advance=reached(along, 90),
        transfer=reached(across, 90),
        tactical_diameter=reached(across, 180),
        max_advance=_largest(along, at[90], at[360], order.end),
        max_transfer=_largest(across, at[180], at[360], order.end),
        time_90=reached(t - t[e], 90),
        time_180=reached(t - t[e], 180),
        time_270=reached(t - t[e], 270),
        time_360=reached(t - t[e], 360),
        speed_ratio_90=speed_ratio(90),
        speed_ratio_180=speed_ratio(180),
        speed_ratio_360=speed_ratio(360),
        initial_turning_distance=None if at[10] is None else integral(t, speed, e, at[10]),
        **_steady(track, order, phi),
        residual_rate=_residual_rate(track, order, L_pp),
        drift_north=None if drift is None else drift[0],
        drift_east=None if drift is None else drift[1],
        drift_pairs=0 if drift is None else drift[2],
        drift_subtracted=subtract_drift,
    )


def _turned(track: Track, order: Execute, L_pp: float) -> FloatArray:
    """Change of heading since the order (n_samples,), positive to the side of the turn [rad]."""
    return np.asarray(order.side * (track.psi - heading_at(track, order.index, L_pp)))


def _from_order(track: Track, order: Execute, L_pp: float) -> tuple[FloatArray, FloatArray]:
    """Distances (n_samples,) from the position at the order, along its heading and across to the turn's side [m]."""
    psi_0 = heading_at(track, order.index, L_pp)
    x, y = track.x - track.x[order.index], track.y - track.y[order.index]
    along, across = to_ship(psi_0, x, y)
    return along, order.side * across


def _largest(distance: FloatArray, begin: float | None, end: float | None, last: int) -> float | None:
    """Largest distance between two crossings, None if it is still growing at the end."""
    if begin is None:
        return None
    stop = last if end is None else int(end)
    top = int(begin) + int(np.argmax(distance[int(begin) : stop + 1]))
    return float(distance[top]) if top < stop else None


def _uniform_drift(track: Track, order: Execute, L_pp: float) -> tuple[float, float, int] | None:
    """Drift north and east [m/s] and number of pairs: mean displacement over a full turn by its time.

    MSC/Circ.1053, section 3.4.2.5, from 180 deg change of heading on; here a pair every 5 deg.
    """
    phi = np.maximum.accumulate(_turned(track, order, L_pp)[order.index : order.end + 1])
    first = np.arange(HALF_TURN, phi[-1] - FULL_TURN + 1e-9, 5.0 * DEG)
    if first.size == 0:
        return None
    rising = np.r_[True, np.diff(phi) > 0.0]
    samples = [channel[order.index : order.end + 1][rising] for channel in (track.t, track.x, track.y)]
    t, x, y = (np.interp(first + FULL_TURN, phi[rising], c) - np.interp(first, phi[rising], c) for c in samples)
    return float(np.mean(x / t)), float(np.mean(y / t)), int(first.size)


def _through_water(track: Track, order: Execute, drift: tuple[float, float, int]) -> Track:
    """The record less a uniform drift, unchanged in position at the order."""
    north, east, _ = drift
    since = track.t - track.t[order.index]
    ahead, abeam = to_ship(track.psi, north, east)
    x, y = track.x - north * since, track.y - east * since
    return replace(track, x=x, y=y, u=track.u - ahead, v_m=track.v_m - abeam)


def _steady(track: Track, order: Execute, phi: FloatArray) -> dict[str, Any]:
    """Means over the end of the turn, weighted by time; see TurningIndices."""
    names = ("heading_change", "speed", "yaw_rate", "diameter", "drift_angle")
    total = float(np.max(phi[order.index : order.end + 1]))
    end = first_crossing(phi, total, order.index, order.end)
    begin = first_crossing(phi, max(HALF_TURN, total - FULL_TURN), order.index, order.end)
    if total <= FULL_TURN or begin is None or end is None:
        return {f"steady_{name}": None for name in names}
    duration = value_at(track.t, end) - value_at(track.t, begin)
    change = value_at(phi, end) - value_at(phi, begin)
    U = integral(track.t, track.speed, begin, end) / duration
    r = change / duration
    beta = integral(track.t, order.side * np.arctan2(-track.v_m, track.u), begin, end) / duration
    return {f"steady_{name}": value for name, value in zip(names, (change, U, r, 2.0 * U / r, beta), strict=True)}


def _residual_rate(track: Track, order: Execute, L_pp: float) -> float | None:
    """Yaw rate left at the end of a pull-out [rad/s]; see TurningIndices."""
    t, after = track.t, np.abs(track.delta[order.end + 1 :])
    back = np.flatnonzero(after <= 3.0 * DEG)
    if back.size == 0:
        return None
    begin = order.end + 1 + int(back[0])
    if t[-1] - t[begin] < 2.0 * L_pp / max(float(track.speed[begin]), 1e-6) or np.median(after[back[0] :]) > 3.0 * DEG:
        return None
    part = slice(max(int(np.searchsorted(t, t[-1] - 0.25 * (t[-1] - t[begin]))), 0), None)
    return float(order.side * np.polyfit(t[part] - t[-1], track.psi[part], 1)[0])
