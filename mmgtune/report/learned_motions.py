"""Motions of what was trained, as its record holds them, to move about in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import motion_block
from .blocks import Motions, Picture
from .common import picture
from .figures import motions
from .figures.plot import LOOKS, Axis, Figure, Line, Look, Panel, model_look
from .wording import clean, number, shown

if TYPE_CHECKING:
    from ..arrays import FloatArray

STATES = {"x": "north_m", "y": "east_m", "psi": "psi_rad", "u": "u_m_s", "v_m": "v_m_s", "r": "r_rad_s"}
"""Column of the record by state."""

FEW = 4
"""Members that are drawn each for itself; more as their mean and the range of all."""


def block(data: Mapping[str, Any], words: str, names: Sequence[str] = ()) -> Motions | Picture:
    """One manoeuvre of each kind: measured, and as the members make it.

    data   the record of a training
    names  of the members; where there are none, networks by number
    A record of older versions holds tracks alone: of these there is a picture.
    """
    drawn: Sequence[Mapping[str, Any]] = data["drawn"]
    members = max(len(one["members"]) for one in drawn)
    each = list(names) or ([f"network {k + 1}" for k in range(members)] if members > 1 else ["network"])
    looks = [model_look(k) for k in range(max(members, len(each)))]
    if len(names) == 2:
        looks = [LOOKS["before"], LOOKS["after"]]
    if any("t_s" not in one for one in drawn):
        return picture(_tracks(drawn, looks), "Tracks", words)
    many = members > FEW
    runs = [motions.Run("measured", "measured", LOOKS["measured"], True)]
    if many:
        runs.append(motions.Run("mean", f"mean of {members}", Look("after", 1.9)))
    else:
        runs += [motions.Run(str(k), said, look) for k, (said, look) in enumerate(zip(each, looks, strict=False))]
    found = [_manoeuvre(one, many) for one in drawn]
    caption = f"{words} Bands reach from the least to the greatest of all." if many else words
    said = "Tracks as measured and as predicted."
    return motion_block.of_manoeuvres(found, runs, (), caption, said=said, L_pp=number(data.get("L_pp")))


def _manoeuvre(one: Mapping[str, Any], many: bool) -> motions.Manoeuvre:
    t = np.array(one["t_s"], dtype=float)
    own = {"measured": {"t": t, **_columns(one["measured"])}}
    bands: dict[str, dict[str, tuple[FloatArray, FloatArray]]] = {}
    members = [_columns(member) for member in one["members"]]
    if many and members:
        all_of = {name: np.array([member[name] for member in members]) for name in STATES}
        all_of["psi"] = np.unwrap(all_of["psi"], axis=1)
        own["mean"] = {"t": t, **{name: values.mean(axis=0) for name, values in all_of.items()}}
        bands["mean"] = {name: (values.min(axis=0), values.max(axis=0)) for name, values in all_of.items()}
    elif not many:
        own |= {str(k): {"t": t, **member} for k, member in enumerate(members)}
    size = number(one["L_MSE"])
    note = (
        f"window of {clean(one['id'])}: L_MSE {shown(size, 2)}" if size is not None else f"window of {clean(one['id'])}"
    )
    return motions.Manoeuvre(clean(one["manoeuvre"]) or clean(one["id"]), own, bands, (), note)


def _columns(motion: Mapping[str, Sequence[float | None]]) -> dict[str, FloatArray]:
    """By state, (n,), NaN in gaps."""
    return {name: np.array(motion[column], dtype=float) for name, column in STATES.items()}


def _tracks(drawn: Sequence[Mapping[str, Any]], looks: Sequence[Look]) -> Figure:
    """Tracks alone, a kind of manoeuvre to each panel."""
    panels = []
    for one in drawn:
        marks = [
            Line(track["east_m"], track["north_m"], look) for track, look in zip(one["members"], looks, strict=False)
        ]
        marks.append(Line(one["measured"]["east_m"], one["measured"]["north_m"], LOOKS["measured"]))
        title = clean(one["manoeuvre"]) or clean(one["id"])
        panels.append(Panel(tuple(marks), Axis("east [m]"), Axis("north [m]"), title, 0.95, equal=True))
    return Figure("tracks", "Tracks as measured and as predicted", tuple(panels))
