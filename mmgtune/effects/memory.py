"""The flow around the hull takes time to follow the motion."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..physics.quantities import Force, Forces, Lanes
from .effect import LagEffect, Parameter

STIFF = 0.5
"""Time constants below this many steps of the integration fade in linearly, so that the lag stays stable."""


class Memory(NamedTuple):
    """See the parameters below."""

    time_constant: Lanes
    sway: Lanes
    yaw: Lanes
    share: Lanes


def settled(found: Forces, e: Memory) -> tuple[Lanes, Lanes]:
    """Hull side force [N] and moment [N m] of a motion that has lasted."""
    return found.hull.Y, found.hull.N


def memory(found: Forces, behind: tuple[Lanes, Lanes], h: Lanes, e: Memory) -> tuple[Force, tuple[Lanes, Lanes]]:
    """Hull side force and moment as first-order lags of the model's: dY/dt = (Y_H - Y) / T.

    The time constant of each is the one of both and its own together, and a share of the force lags, the rest being
    there at once (assumptions: a lag of first order, as a wake that is washed out).
    -> Force that is added to the model's; dY/dt [N/s], dN/dt [N m/s].
    """
    hull = found.hull
    Y, N = behind
    shortest = np.maximum(STIFF * h, 1e-9)
    T_Y, T_N = e.time_constant + e.sway, e.time_constant + e.yaw
    behind_Y, behind_N = Y - hull.Y, N - hull.N
    more = Force(
        X=0.0 * hull.X,
        Y=e.share * np.minimum(T_Y / shortest, 1.0) * behind_Y,
        N=e.share * np.minimum(T_N / shortest, 1.0) * behind_N,
    )
    return more, (-behind_Y / np.maximum(T_Y, shortest), -behind_N / np.maximum(T_N, shortest))


def _constant(words: str) -> Parameter:
    return Parameter(
        f"time constant of {words}",
        "s",
        low=AT_LEAST_0,
        bounds=lambda ship: (0.0, 1.5 * ship.L / ship.U),
        typical=lambda ship: 0.2 * ship.L / ship.U,
        bounds_source="the time of one and a half ship lengths",
    )


_BOTH = "side force and yaw moment followed the motion with a time constant of {}"
_OWN = {"sway": "side force", "yaw": "yaw moment"}


def _said(v: Mapping[str, str]) -> str:
    own = [(what, v[name]) for name, what in _OWN.items() if name in v]
    if "time_constant" not in v:
        return "The hull's " + " and its ".join(
            f"{what} followed the motion with a time constant of {T}" for what, T in own
        )
    more = [f", its {what} with another {T}" for what, T in own]
    return "The hull's " + _BOTH.format(v["time_constant"]) + "".join(more)


EFFECT = LagEffect(
    kind="effects.memory",
    tag="memory",
    title="memory of the flow around the hull",
    params=Memory,
    function=memory,
    start=settled,
    states=("Y", "N"),
    cites=(),
    fields={
        "time_constant": _constant("the hull's side force and yaw moment"),
        "sway": _constant("the side force alone, beside that of both"),
        "yaw": _constant("the yaw moment alone, beside that of both"),
        "share": Parameter(
            "share of the force that follows so",
            null=1.0,
            low=AT_LEAST_0,
            high=2.0,
            bounds=lambda _: (0.2, 1.3),
            bounds_source="a choice: with less there is hardly a memory",
        ),
    },
    form={"share": 0.3},
    variants=(("time_constant",), ("sway",), ("yaw",)),
    besides=("sway", "yaw"),
    rough=True,
    sentence=_said,
)
