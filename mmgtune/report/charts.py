"""Zoomable time histories with plotly: one layout and one list of traces for every trial, and each trial's numbers.

Names from files never enter the charts, since plotly reads a little markup; the page shows them as plain text.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..arrays import FloatArray
from .tracks import SHOWN, WORDS, onto
from .wording import CHANNELS, Channel

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = FloatArray
    Motion = Mapping[str, Array]

RESIDUALS = (*SHOWN, "x", "y")
DASHES = {"measured": "solid", "before": "dot", "after": "8px,4px"}
LIMIT = 5000
_BUDGET = 600_000


@dataclass(frozen=True)
class Panel:
    """One chart: a channel as it was measured and simulated, or as measured alone, or simulated minus measured."""

    channel: Channel
    shows: tuple[str, ...]
    residual: bool = False

    @property
    def title(self) -> str:
        """The axis title: what and unit, on two lines."""
        return f"{self.channel.words}{' error' if self.residual else ''}<br>[{self.channel.unit}]"


def panels(inputs: Sequence[Channel]) -> list[Panel]:
    """Motions and the inputs there are, then the residuals."""
    return [
        *(Panel(CHANNELS[name], ("measured", "before", "after")) for name in SHOWN),
        *(Panel(channel, ("measured",)) for channel in inputs),
        *(Panel(CHANNELS[name], ("before", "after"), residual=True) for name in RESIDUALS),
    ]


def histories(
    names: Sequence[str], motions: Mapping[str, Mapping[str, Motion]], inputs: Sequence[Channel]
) -> tuple[dict[str, Any], bool]:
    """What the page's script draws from, and whether any history had to be thinned.

    names    the trials, in the order of the selector
    inputs   what drove the ship, columns of the motions
    """
    shown = panels(inputs)
    plan = [(place, which) for place, panel in enumerate(shown) for which in panel.shows]
    limit = max(600, min(LIMIT, _BUDGET // (len(plan) * max(1, len(names)))))
    trials, thinned = [], False
    for name in names:
        found = motions.get(name, {})
        pieces = [_piece(found, shown[place], which, limit) for place, which in plan]
        thinned = thinned or any(cut for _, cut in pieces)
        trials.append({"name": name, "data": [piece for piece, _ in pieces]})
    payload = {
        "traces": [
            {"role": which, "trace": trace} for (_, which), trace in zip(plan, _traces(plan, shown), strict=True)
        ],
        "wide": _layout(shown, columns=2),
        "narrow": _layout(shown, columns=1),
        "trials": trials,
    }
    return payload, thinned


def _axis(panel: int) -> str:
    return "" if panel == 0 else str(panel + 1)


def _traces(plan: list[tuple[int, str]], shown: Sequence[Panel]) -> list[dict[str, Any]]:
    """The traces without numbers, checked by plotly."""
    import plotly.graph_objects as go

    figure = go.Figure()
    legend: set[str] = set()
    for panel, which in plan:
        words = WORDS[which]
        figure.add_trace(
            go.Scatter(
                mode="lines",
                name=words,
                legendgroup=which,
                showlegend=which not in legend,
                connectgaps=False,
                xaxis=f"x{_axis(panel)}",
                yaxis=f"y{_axis(panel)}",
                line={"dash": DASHES[which], "width": 1.7},
                hovertemplate=f"%{{y}} {shown[panel].channel.unit}",
            )
        )
        legend.add(which)
    traces: list[dict[str, Any]] = figure.to_plotly_json()["data"]
    return traces


def _layout(shown: Sequence[Panel], columns: int) -> dict[str, Any]:
    """The panels in two columns (motions, residuals) or one below the other, checked by plotly."""
    import plotly.graph_objects as go

    left = sum(not panel.residual for panel in shown)
    sides = (left, len(shown) - left) if columns == 2 else (len(shown),)
    rows = max(sides)
    row, gap = 1.0 / rows, (0.022 if columns == 2 else 0.011)
    layout: dict[str, Any] = {
        "height": 150 * rows + 60,
        "margin": {"l": 62, "r": 12, "t": 44, "b": 44},
        "hovermode": "x",
        "dragmode": "zoom" if columns == 2 else False,
        "legend": {"orientation": "h", "x": 0, "y": 1.0, "yanchor": "bottom", "xanchor": "left"},
        "showlegend": True,
        "font": {"size": 12},
        "paper_bgcolor": "rgba(0,0,0,0)",
        "plot_bgcolor": "rgba(0,0,0,0)",
        "template": None,
    }
    for panel, what in enumerate(shown):
        side, place = (1, panel - left) if columns == 2 and what.residual else (0, panel)
        last = place == sides[side] - 1
        span = (0.0, 1.0) if columns == 1 else ((0.0, 0.465) if side == 0 else (0.545, 1.0))
        x_axis: dict[str, Any] = {
            "domain": list(span),
            "anchor": f"y{_axis(panel)}",
            "showticklabels": last,
            "zeroline": False,
            "title": {"text": "time [s]" if last else ""},
            "automargin": False,
        }
        if panel:
            x_axis["matches"] = "x"
        layout[f"xaxis{_axis(panel)}"] = x_axis
        layout[f"yaxis{_axis(panel)}"] = {
            "domain": [max(0.0, 1.0 - (place + 1) * row + gap), 1.0 - place * row - gap],
            "anchor": f"x{_axis(panel)}",
            "zeroline": what.residual,
            "nticks": 5,
            "title": {"text": what.title, "font": {"size": 11}, "standoff": 4},
        }
    checked: dict[str, Any] = go.Figure(layout=layout).to_plotly_json()["layout"]
    checked.pop("template", None)
    return checked


def _piece(found: Mapping[str, Motion], panel: Panel, which: str, limit: int) -> tuple[dict[str, Any], bool]:
    """The numbers of one trace, and whether they were thinned."""
    import numpy as np

    channel = panel.channel
    measured, motion = found.get("measured"), found.get(which)
    if motion is None or (panel.residual and measured is None):
        return {"x": [], "y": []}, False
    if panel.residual:
        assert measured is not None
        t = measured["t"]
        values = residual(motion, measured, channel.name)
    else:
        t, values = motion["t"], motion[channel.name]
        if channel.name == "psi":
            values = unwrapped(values)
            if which != "measured" and measured is not None:
                values = values - _turns(values, unwrapped(measured["psi"]))
    keep = spread(values, limit)
    t, values = t[keep], values[keep] * channel.factor
    body: dict[str, Any] = {"y": _listed(values, channel.decimals)}
    steps = np.diff(t)
    if len(t) > 1 and np.isfinite(steps).all() and np.allclose(steps, steps[0], rtol=1e-6, atol=1e-9):
        body |= {"x0": round(float(t[0]), 3), "dx": round(float(steps[0]), 6)}
    else:
        body["x"] = _listed(t, 3)
    if len(values) == 1:
        body["mode"] = "markers"
    return body, len(keep) < len(motion["t"])


def residual(motion: Motion, measured: Motion, name: str) -> Array:
    """Simulated minus measured [SI], headings unwrapped and counted from the same turn."""
    if name != "psi":
        return onto(motion, name, measured["t"]) - measured[name]
    own = unwrapped(measured["psi"])
    other = onto({"t": motion["t"], "psi": unwrapped(motion["psi"])}, "psi", measured["t"])
    return other - own - _turns(other, own)


def unwrapped(psi: Array) -> Array:
    """A heading without jumps of a full turn, gaps left as they are."""
    import numpy as np

    good = np.isfinite(psi)
    smooth = psi.copy()
    smooth[good] = np.unwrap(psi[good])
    return smooth


def _turns(psi: Array, reference: Array) -> float:
    """The whole turns by which one heading starts off another [rad]."""
    import numpy as np

    size = min(len(psi), len(reference))
    both = np.flatnonzero(np.isfinite(psi[:size]) & np.isfinite(reference[:size]))
    if not len(both):
        return 0.0
    return float(2.0 * math.pi * np.round((psi[both[0]] - reference[both[0]]) / (2.0 * math.pi)))


def spread(values: Array, limit: int) -> npt.NDArray[np.intp]:
    """Indices of at most about ``limit`` samples: the least and the greatest of every stretch, so no peak is lost."""
    import numpy as np

    if len(values) <= limit:
        return np.arange(len(values))
    keep = {0, len(values) - 1}
    for stretch in np.array_split(np.arange(len(values)), limit // 2):
        part = values[stretch]
        if np.isfinite(part).any():
            keep |= {int(stretch[np.nanargmin(part)]), int(stretch[np.nanargmax(part)])}
        else:
            keep.add(int(stretch[0]))
    return np.array(sorted(keep), dtype=np.intp)


def _listed(values: Array, decimals: int) -> list[float | None]:
    """Numbers for JSON, no finer than a sensor is; None in gaps."""
    return [round(value, decimals) + 0.0 if math.isfinite(value) else None for value in values.tolist()]
