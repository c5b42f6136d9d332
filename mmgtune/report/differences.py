"""What differs from voyage to voyage, drawn: a point with its interval for each voyage, in their order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .drawing import AFTER, BEFORE, MUTED, new_figure
from .wording import clean, number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

NORMAL = 1.96
"""Half width of a 95 % interval, in standard errors."""

NAMED = 16
"""Voyages that are named under the axis; of more every so many."""

LONGEST = 14
"""Letters of a name that are written under the axis."""


def draw_differences(found: Sequence[Mapping[str, Any]]) -> Figure:
    """A panel for each parameter of each quantity, as ``Difference.to_dict`` has them; one at least."""
    panels = [(one, name) for one in found for name in one["by_voyage"][0] if name != "voyage"]
    figure = new_figure(7.6, 1.75 * len(panels) + 0.9)
    grid = figure.subplots(len(panels), 1, squeeze=False, sharex=len({_names(one) for one in found}) == 1)
    for (one, name), ax in zip(panels, grid[:, 0], strict=True):
        _draw(ax, one, name)
    _legend(figure, found)
    return figure


def axis_words(one: Mapping[str, Any], name: str) -> str:
    """What a panel shows, with its unit."""
    unit = "–" if one["unit"] in ("-", "prime") else clean(one["unit"])
    relative = " over mean" if one["relative_to_mean"] else ""
    return f"{clean(one['quantity'])} {clean(name)}{relative} [{unit}]"


def _names(one: Mapping[str, Any]) -> tuple[str, ...]:
    return tuple(str(row["voyage"]) for row in one["by_voyage"])


def _draw(ax: Axes, one: Mapping[str, Any], name: str) -> None:
    rows = one["by_voyage"]
    values = np.array([_number(row[name]["value"]) for row in rows])
    errors = np.array([_number(row[name]["stderr"]) for row in rows])
    known = np.isfinite(values) & np.isfinite(errors)
    at = np.arange(len(rows))
    common, slope = one.get("for_all"), one.get("trend_per_voyage")
    if one["pattern"] == "trend" and slope:
        middle = float(np.mean((values - slope[name]["value"] * at)[known])) if known.any() else np.nan
        ax.plot(at, middle + slope[name]["value"] * at, color=BEFORE, linewidth=1.3, linestyle=(0, (6, 2.2)))
    elif one["pattern"] == "one" and common:
        value, error = _number(common[name]["value"]), _number(common[name]["stderr"])
        ax.axhline(value, color=BEFORE, linewidth=1.3, linestyle=(0, (6, 2.2)))
        if np.isfinite(error):
            ax.axhspan(value - NORMAL * error, value + NORMAL * error, color=BEFORE, alpha=0.15, linewidth=0.0)
    ax.axhline(1.0 if one["relative_to_mean"] else 0.0, color=MUTED, linewidth=0.8)
    style: dict[str, Any] = {"color": AFTER, "fmt": "o", "markersize": 4.0, "capsize": 3.0, "elinewidth": 1.2}
    ax.errorbar(at[known], values[known], NORMAL * errors[known], **style)
    every = max(1, -(-len(rows) // NAMED))
    ax.set_xticks(at[::every], [clean(row["voyage"])[-LONGEST:] for row in rows[::every]])
    if len(rows) > 6 or max(len(str(row["voyage"])) for row in rows) > 8:
        ax.tick_params(axis="x", labelrotation=35.0)
        for label in ax.get_xticklabels():
            label.set_horizontalalignment("right")
    ax.set_xlim(-0.6, len(rows) - 0.4)
    ax.set_title(axis_words(one, name))


def _legend(figure: Figure, found: Sequence[Mapping[str, Any]]) -> None:
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], color=AFTER, marker="o", linestyle="-", label="of each voyage, with its 95 % interval")]
    if {one["pattern"] for one in found} & {"one", "trend"}:
        words = "the value or trend that is believed"
        handles.append(Line2D([], [], color=BEFORE, linewidth=1.3, linestyle=(0, (6, 2.2)), label=words))
    figure.legend(handles=handles, loc="outside upper left", ncols=2, handlelength=3.0)


def _number(value: Any) -> float:
    found = number(value)
    return float("nan") if found is None else found
