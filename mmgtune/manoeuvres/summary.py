"""The indices of a record by whatever manoeuvre it shows, and the IMO criteria that apply to it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ..errors import OptionError, Problem, brief, kind_of
from ..limits import as_float, is_real
from ..units import DEG
from .criteria import Criterion, check_turning, check_zigzag
from .track import Track
from .turning import turning_indices
from .zigzag import manoeuvre_kind, zigzag_indices


def indices_of(track: Track, L_pp: float, measured: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Indices with units in their names; empty where the record shows neither a turn nor a zigzag.

    L_pp      length between perpendiculars [m]
    measured  indices of the run that the record is a simulation of: a zigzag keeps the rudder and check angle of that
              one, because a helmsman who follows another heading does not reverse at the check heading
    Raises OptionError for what is no record or no length above 0.
    """
    _require_kinds(track, L_pp)
    kind = manoeuvre_kind(track)
    if kind == "turning":
        return turning_indices(track, L_pp).to_dict()
    if kind == "zigzag":
        return zigzag_indices(track, L_pp, _angles(measured or {})).to_dict()
    return {}


def _require_kinds(track: object, L_pp: object) -> None:
    if not isinstance(track, Track):
        why = "indices are read from the record of one manoeuvre"
        fix = "give a Track: track_of(TRIAL), simulate(SHIP, TRIAL)[0].track(), or Track(t=..., x=..., ...)"
        raise OptionError(Problem(f"{kind_of(track)} is no track", brief(track), why, fix))
    _require_number("L_pp", L_pp)


_NUMBERS = {
    "L_pp": (
        "length",
        "m",
        "the length between perpendiculars",
        "profile.L_pp",
        "indices are told in lengths of the ship",
    ),
    "V": ("speed", "m/s", "the test speed", "profile.approach.speed", "criteria depend on the test speed"),
}
"""What each is, its unit, the same in full, where a profile has it, and what it is for."""


def _require_number(name: str, value: object, above_0: bool = True) -> None:
    of, unit, whole, where, why = _NUMBERS[name]
    if not is_real(value):
        why, fix = f"it is {whole} in {unit}", f"give a number; a profile has it as {where}"
        raise OptionError(Problem(f"{kind_of(value)} is no {of}", name, why, fix))
    if above_0 and not 0.0 < as_float(value) < math.inf:  # at a test speed of 0 no criterion is judged
        what, fix = f"the {of} is {as_float(value):g} {unit}", f"give {whole} in {unit}, above 0"
        raise OptionError(Problem(what, name, why, fix))


def _angles(indices: Mapping[str, Any]) -> tuple[float, float] | None:
    """Rudder and check angle [rad] of a zigzag's indices; None of another manoeuvre's, or where one is not known."""
    rudder, check = indices.get("rudder_angle_deg"), indices.get("heading_angle_deg")
    return None if rudder is None or check is None else (rudder * DEG, check * DEG)


def criteria_of(
    track: Track, L_pp: float, V: float, measured: Mapping[str, Any] | None = None
) -> tuple[Criterion, ...]:
    """Criteria of IMO MSC.137(76) for the manoeuvre shown; L_pp [m], V test speed [m/s].

    measured  as in ``indices_of``
    Raises OptionError for what is no record, a length not above 0, and a speed below 0.
    """
    _require_kinds(track, L_pp)
    _require_number("V", V, V != 0.0)
    kind = manoeuvre_kind(track)
    if kind == "turning":
        return check_turning(turning_indices(track, L_pp), L_pp, V)
    if kind == "zigzag":
        return check_zigzag(zigzag_indices(track, L_pp, _angles(measured or {})), L_pp, V)
    return ()
