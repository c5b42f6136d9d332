"""Whether the box of the targets, not something that happened, is what stands in the way of a fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .search import ENOUGH, Found
from .workbench import Workbench

WIDER = 2.0
"""How many times as far from their pre-determined value as the box lets them targets at its end are then let."""

AS_MUCH = 0.5
"""Share of the fall of chi-squared by all that was found from which a wider box that brings it is spoken of."""


def narrow_box(bench: Workbench, found: Found) -> list[str]:
    """Warnings of a diagnosis whose re-tuned model, any cause apart, would fit about as well in a wider box.

    Targets at the end of their box are let go further; nothing is said where that explains little of what was found.
    """
    base = found.base
    at_end = [name for name, z in zip(base.names, base.unit, strict=True) if z <= 0.0 or z >= 1.0]
    explained = base.chi2 - found.final.chi2
    if not at_end or explained < ENOUGH:
        return []
    wide = _let_go(bench, at_end)
    values = bench.sub_box(base.names).from_unit(base.unit[:, None])[:, 0]
    start = np.clip(wide.sub_box(base.names).to_unit(values), 0.0, 1.0)
    other = wide.refit(base.names, start[:, None], base.offsets, integrator=base.integrator)
    gained = base.chi2 - other.chi2
    if gained < AS_MUCH * explained:
        return []
    box = wide.sub_box(base.names)
    ends = dict(zip(base.names, box.from_unit(other.unit[:, None])[:, 0], strict=True))
    moved = [name for k, name in enumerate(base.names) if name in at_end and _beyond(values[k], ends[name], box.pre[k])]
    sizes = ", ".join(f"{name} at {ends[name] / p - 1.0:+.0%}" for name, p in _pre(box.names, box.pre) if name in moved)
    share = f"{min(gained / explained, 1.0):.0%}"
    what = (
        f"with {sizes} of the profile's value, beyond it, the model explains {share} of what the causes do without them"
    )
    way = "if the ship may differ so much, as by fouling, look again with a larger --ar"
    return [f"the box of the targets may be too narrow: {what}; {way}"]


def _beyond(was: float, now: float, pre: float) -> bool:
    """Whether a value left the end of its box by a twentieth of its distance from there to what was pre-determined."""
    return abs(now - pre) > 1.05 * abs(was - pre)


def _pre(names: Sequence[str], values: np.ndarray) -> list[tuple[str, float]]:
    return [(name, float(value)) for name, value in zip(names, values, strict=True) if value != 0.0]


def _let_go(bench: Workbench, names: Sequence[str]) -> Workbench:
    """The workbench with some targets free to go further from their pre-determined values."""
    box = bench.box
    at = [k for k, name in enumerate(box.names) if name in names]
    low, high = box.low.copy(), box.high.copy()
    low[at] = box.pre[at] - WIDER * (box.pre[at] - box.low[at])
    high[at] = box.pre[at] + WIDER * (box.high[at] - box.pre[at])
    return replace(bench, box=replace(box, low=low, high=high))
