"""The speed log shows a speed where there is none."""

from collections.abc import Mapping
from typing import NamedTuple

from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect
from .signs import signed


class LogZero(NamedTuple):
    """See the parameters below."""

    ahead: Lanes
    abeam: Lanes


def log_zero(state: State, e: LogZero) -> State:
    """Surge and sway velocity shown = velocity + ahead and abeam [m/s]; positions do not come from the log."""
    return State(x=state.x, y=state.y, psi=state.psi, u=state.u + e.ahead, v_m=state.v_m + e.abeam, r=state.r)


def log_zero_inverse(logged: State, e: LogZero) -> State:
    """Velocities from those shown."""
    u, v_m = logged.u - e.ahead, logged.v_m - e.abeam
    return State(x=logged.x, y=logged.y, psi=logged.psi, u=u, v_m=v_m, r=logged.r)


def _velocity(which: str) -> Parameter:
    return Parameter(
        f"{which} velocity shown less that of the ship",
        "m/s",
        low=-5.0,
        high=5.0,
        bounds=lambda ship: (-0.3 * ship.U, 0.3 * ship.U),
        typical=lambda ship: 0.02 * ship.U,
        bounds_source="three tenths of the approach speed",
    )


def _sentence(v: Mapping[str, str]) -> str:
    said = []
    if "ahead" in v:
        said.append(f"{signed(v['ahead'], 'too much', 'too little')} ahead, however fast she was")
    if "abeam" in v:
        said.append(f"a drift of {signed(v['abeam'], 'to starboard', 'to port')} where there was none")
    return "The speed log showed " + ", and ".join(said)


EFFECT = SensorEffect(
    kind="effects.log-zero",
    tag="log-zero",
    title="zero error of the speed log",
    told_by="what the speed log shows alongside",
    params=LogZero,
    function=log_zero,
    inverse=log_zero_inverse,
    cites=(),
    fields={"ahead": _velocity("surge"), "abeam": _velocity("sway")},
    variants=(("ahead",), ("abeam",)),
    sentence=_sentence,
)
