"""The part of a record a map keeps, and a pull-out as a trial of its own."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..errors import LogError, Problem, TrialError
from ..inputs import INPUTS
from ..manoeuvres import Track, find_execute, manoeuvre_kind
from ..manoeuvres.track import noise_level
from ..units import DEG
from .gridding import FEWEST
from .maps.mapping import LogMap
from .maps.quantities import MEASURED

STANDING = 0.01
"""Share of its largest revolutions up to which a shaft stands."""
MIDSHIPS = 0.5 * DEG
"""Rudder angle [rad] up to which a rudder is at zero."""


def kept(t: FloatArray, columns: dict[str, FloatArray], log_map: LogMap, where: str) -> tuple[slice, list[str]]:
    """The part of a stretch that a map keeps, and what was dropped, in sentences.

    t        (n_samples,) [s]
    columns  x, y, psi, u, v and inputs, (n_samples,); inputs without gaps

    Raises LogError where the map asks for an order and the record has none.
    """
    cut = log_map.cut
    since = t - t[0]
    first, last = 0.0, float(since[-1])
    said = []
    if cut.to:
        ordered = np.flatnonzero(~standing({name: columns[name] for name in log_map.inputs}))
        if not len(ordered):
            what = "the record cannot be cut after the last order: propeller and rudder stand at zero throughout"
            fix = f"check the columns of {', '.join(log_map.inputs)}, or leave out [cut] to"
            raise LogError(Problem(what, where, fix=fix))
        if last > since[ordered[-1]]:
            idle = last - float(since[ordered[-1]])
            said.append(f"the last {idle:.4g} s were dropped: propeller and rudder stand at zero there")
        last = float(since[ordered[-1]])
    if cut.begin == "first-order":
        ordered = np.flatnonzero(~standing({name: columns[name] for name in log_map.inputs}))
        if not len(ordered):
            what = "the record cannot be cut at the first order: propeller and rudder stand at zero throughout"
            fix = f"check the columns of {', '.join(log_map.inputs)}, or leave out [cut] from"
            raise LogError(Problem(what, where, fix=fix))
        first = max(0.0, float(since[ordered[0]]) - cut.lead)
        if first > 0.0:
            said.append(f"the first {first:.4g} s were dropped: propeller and rudder stand at zero there")
    elif cut.begin:
        try:
            execute = find_execute(_track(t, columns))
        except TrialError as error:
            why = "; ".join(problem.what for problem in error.problems)
            fix = "give [cut] start and end instead"
            raise LogError(Problem("the record cannot be cut at the first rudder order", where, why, fix)) from error
        first = max(0.0, float(since[execute.index]) - cut.lead)
    if cut.start is not None:
        first = max(first, cut.start)
    if cut.end is not None:
        last = min(last, cut.end if cut.end > 0.0 else float(since[-1]) + cut.end)
        if cut.end < 0.0:
            said.append(f"the last {-cut.end:g} s of the log were dropped, as the map says")
    low, high = np.searchsorted(since, [first - 1e-9, last + 1e-9])
    return slice(int(low), int(high)), said


def pull_out(t: FloatArray, columns: dict[str, FloatArray]) -> int | None:
    """First sample of the pull-out that follows a turning circle: the last one with the rudder over.

    None where the record holds no turning circle, or the rudder is not brought back for the rest of it.

    t        (n_samples,) [s]
    columns  x, y, psi, u, v, r, delta, (n_samples,)
    """
    track = _track(t, columns)
    if manoeuvre_kind(track) != "turning":
        return None
    order = find_execute(track)
    size = np.abs(track.delta)
    if len(size) - order.end < FEWEST or np.median(size[order.end + 1 :]) >= 0.25 * order.angle:
        return None
    # The order's last samples are within its tolerance, but on the way back already.
    level = float(np.median(size[(order.start + 3 * order.end) // 4 : order.end + 1]))
    still = size[order.start : order.end + 1] >= level - max(MIDSHIPS, 4.0 * noise_level(t, track.delta))
    last = order.start + int(np.flatnonzero(still)[-1])
    # A trial begins with a complete sample.
    complete = np.flatnonzero(np.all([np.isfinite(columns[name][last:]) for name in MEASURED], axis=0))
    first = last + int(complete[0]) if len(complete) else len(size)
    return first if first >= FEWEST and len(size) - first >= FEWEST else None


def standing(inputs: dict[str, FloatArray]) -> np.ndarray:
    """(n_samples,) whether nothing drives the ship: no shaft turns, and every rudder is midships."""
    size = {name: np.abs(values) for name, values in inputs.items()}
    limit = {name: MIDSHIPS if INPUTS[name].unit == "rad" else STANDING * size[name].max() for name in inputs}
    return np.asarray(np.all([size[name] <= limit[name] for name in inputs], axis=0))


def _track(t: FloatArray, columns: dict[str, FloatArray]) -> Track:
    filled = {name: _filled(t, columns[name]) for name in ("x", "y", "psi", "u", "v", "delta")}
    return Track(t=t, v_m=filled.pop("v"), **filled)


def _filled(t: FloatArray, values: FloatArray) -> FloatArray:
    known = np.isfinite(values)
    return np.interp(t, t[known], values[known])
