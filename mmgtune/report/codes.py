"""What the codes of trials stand for, said once a page: turn_p35 is a turning circle, 35° of rudder to starboard."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from .wording import clean, listing, number, shown

MOST = 24
"""Trials of a kind that are named."""

_NEAR = 0.25
"""Degrees within which a measured angle is taken for the round one that was ordered."""


def legend(orders: Mapping[str, Mapping[str, Any]]) -> tuple[tuple[str, str], ...]:
    """For below a table: kinds of manoeuvres with their side, and the trials that are of each; nothing of others.

    orders  trial -> what was ordered, by the names of indices: ``rudder_angle_deg``, ``heading_angle_deg`` of a
            zigzag, None where it is not known, ``direction``
    """
    groups: dict[str, list[str]] = {}
    for id, order in orders.items():
        rudder, heading, side = number(order.get("rudder_angle_deg")), order.get("heading_angle_deg"), _side(order)
        if rudder is None or not side:
            continue
        if "heading_angle_deg" not in order:
            groups.setdefault(f"turning circles, rudder to {side}", []).append(f"{clean(id)} ({_angle(rudder)}°)")
        else:
            check = number(heading)
            angles = f"{_angle(rudder)}°" if check is None else f"{_angle(rudder)}/{_angle(check)}"
            groups.setdefault(f"zigzags, rudder first to {side}", []).append(f"{clean(id)} ({angles})")
    return tuple((kind, listing(names, MOST)) for kind, names in groups.items())


def of_rows(rows: Iterable[Mapping[str, Any]]) -> tuple[tuple[str, str], ...]:
    """Kinds of manoeuvres, each with its trials, of rows of trials; rows of older versions have only their measured
    indices, none where there is a gap."""
    measured = {str(row["id"]): row.get("order") or (row.get("indices") or {}).get("measured") or {} for row in rows}
    return legend(measured)


def sentences(orders: Mapping[str, Mapping[str, Any]]) -> tuple[str, ...]:
    """Kinds of manoeuvres, each with its trials, as sentences where there is no table to stand below."""
    return tuple(f"{kind[:1].upper()}{kind[1:]}: {names}." for kind, names in legend(orders))


def _side(order: Mapping[str, Any]) -> str:
    side = order.get("direction")
    return str(side) if side in ("port", "starboard") else ""


def _angle(degrees: float) -> str:
    nearest = round(abs(degrees))
    return str(nearest) if abs(abs(degrees) - nearest) <= _NEAR else shown(abs(degrees), 3)
