"""Full astern stopping: how far and how long until the ship is dead in the water.

IMO MSC.137(76), section 4.2.6: track reach is the distance along the path described by the midship point, measured from
the position at which an order for full astern is given to that at which the ship stops.  Head reach, the part of it
along the original course, and lateral deviation follow MSC/Circ.1053 as recalled; they were not checked against it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from ..errors import Problem, TrialError
from ..physics.frame import to_ship
from .track import Track, approach_speed, first_crossing, integral, value_at, with_units


@dataclass(frozen=True, kw_only=True)
class StoppingIndices:
    """A stop in numbers; None where the record ends before the ship has stopped."""

    L_pp: Annotated[float, "m"]
    execute_time: Annotated[float, "s"]  # of the order, on the record's clock
    approach_speed: Annotated[float, "m/s"]  # mean over the last ship length before the order
    track_reach: Annotated[float | None, "m"]  # along the path, from the order until stopped
    head_reach: Annotated[float | None, "m"]  # along the heading at the order
    lateral_deviation: Annotated[float | None, "m"]  # across it, positive to starboard
    stopping_time: Annotated[float | None, "s"]

    def to_dict(self) -> dict[str, Any]:
        """The fields by names with their unit, e.g. track_reach_m, track_reach_over_L."""
        return with_units(self, self.L_pp)


def stopping_indices(track: Track, L_pp: float, order: float) -> StoppingIndices:
    """Indices of a stop, from the time of the order [s] on; the ship has stopped once she makes no way ahead.

    L_pp  length between perpendiculars [m]
    Raises TrialError where the record has no sample before the order or ends with it.
    """
    e = int(np.searchsorted(track.t, order + 1e-9)) - 1
    if not 0 <= e < len(track.t) - 1:
        raise TrialError(Problem("the order lies outside the record", "t", f"it is given at {order:g} s"))
    end = first_crossing(-track.u, 0.0, e, len(track.t) - 1)
    along, across = to_ship(track.psi[e], track.x - track.x[e], track.y - track.y[e])
    return StoppingIndices(
        L_pp=L_pp,
        execute_time=float(track.t[e]),
        approach_speed=approach_speed(track, e, L_pp),
        track_reach=None if end is None else integral(track.t, track.speed, e, end),
        head_reach=None if end is None else value_at(along, end),
        lateral_deviation=None if end is None else value_at(across, end),
        stopping_time=None if end is None else value_at(track.t, end) - float(track.t[e]),
    )
