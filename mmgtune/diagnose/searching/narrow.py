"""Whether the box of the targets, not something that happened, is what stands in the way of a fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...fitting.box import A_R
from ..bench.workbench import Workbench
from .refit import ENOUGH
from .search import Found

WIDER = 2.0
"""How many times as far from their pre-determined value as the box lets them targets at its end are then let."""

AS_MUCH = 0.5
"""Share of the fall of chi-squared by all that was found from which a wider box that brings it is spoken of."""

FEW = 3
"""Targets that may be so far off: with more, any model bends to anything, and no ship differs so."""


def narrow_box(bench: Workbench, found: Found) -> list[str]:
    """Warnings of a diagnosis whose re-tuned model, any cause apart, would fit about as well in a wider box.

    Targets at the end of their box are let go further; nothing is said where that explains little of what was found, or
    of what is left where nothing was, or takes many of them.
    """
    base = found.base
    at_end = [name for name, z in zip(base.names, base.unit, strict=True) if z <= 0.0 or z >= 1.0]
    explained = base.chi2 - (found.final.chi2 if found.causes else bench.problem.n_residuals)
    if not at_end or explained < ENOUGH or any(cause.instead for cause in found.causes):
        return []
    wide = _let_go(bench, at_end)
    box = wide.sub_box(base.names)
    values = bench.sub_box(base.names).from_unit(base.unit[:, None])[:, 0]
    gained, other = wide.gained(base, np.clip(box.to_unit(values), 0.0, 1.0), explained)
    ends = box.from_unit(other.unit[:, None])[:, 0]
    gone = [
        f"{name} {abs(ends[k] / box.pre[k] - 1.0):.0%} {'above' if abs(ends[k]) > abs(box.pre[k]) else 'below'}"
        for k, name in enumerate(base.names)
        if name in at_end and box.pre[k] != 0.0 and _beyond(values[k], ends[k], box.pre[k])
    ]
    if not 0 < len(gone) <= FEW or gained < AS_MUCH * explained:
        return []
    share = f"{min(gained / explained, 1.0):.0%}"
    of = "what the causes do" if found.causes else "what it leaves beyond noise"
    what = f"with {', '.join(gone)} the profile's value, outside, the model explains {share} of {of}"
    room = WIDER * (A_R if bench.options.a_r is None else bench.options.a_r)
    way = f"if the ship may differ so much, as by fouling, look again with a_r={room:g}"
    return [f"the box of the targets may be too narrow: {what}; {way}"]


def _beyond(was: float, now: float, pre: float) -> bool:
    """Whether a value left the end of its box by a twentieth of its distance from there to what was pre-determined."""
    return abs(now - pre) > 1.05 * abs(was - pre)


def _let_go(bench: Workbench, names: Sequence[str]) -> Workbench:
    """The workbench with some targets free to go further from their pre-determined values."""
    box = bench.box
    at = [k for k, name in enumerate(box.names) if name in names]
    low, high = box.low.copy(), box.high.copy()
    low[at] = box.pre[at] - WIDER * (box.pre[at] - box.low[at])
    high[at] = box.pre[at] + WIDER * (box.high[at] - box.pre[at])
    return replace(bench, box=replace(box, low=low, high=high))
