"""Zoomable time histories with plotly: one layout and one list of traces for every trial, and each trial's numbers.

Names from files never enter the charts, since plotly reads a little markup; the page shows them as plain text.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..arrays import FloatArray
from .tracks import WORDS, onto
from .wording import CHANNELS, Channel

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = FloatArray
    Motion = Mapping[str, Array]

LEFT = ("psi", "u", "v_m", "r", "delta", "n")
RIGHT = ("psi", "u", "v_m", "r", "x", "y")
INPUTS = ("delta", "n")
DASHES = {"measured": "solid", "before": "dot", "after": "8px,4px"}
LIMIT = 5000
_BUDGET = 600_000


def histories(names: Sequence[str], motions: Mapping[str, Mapping[str, Motion]]) -> tuple[dict[str, Any], bool]:
    """What the page's script draws from, and whether any history had to be thinned.

    names    the trials, in the order of the selector
    """
    plan = _plan()
    limit = max(600, min(LIMIT, _BUDGET // (len(plan) * max(1, len(names)))))
    trials, thinned = [], False
    for name in names:
        found = motions.get(name, {})
        pieces = [_piece(found, *panel, limit) for panel in plan]
        thinned = thinned or any(cut for _, cut in pieces)
        trials.append({"name": name, "data": [piece for piece, _ in pieces]})
    payload = {
        "traces": [{"role": which, "trace": trace} for (_, which, _), trace in zip(plan, _traces(plan), strict=True)],
        "wide": _layout(columns=2),
        "narrow": _layout(columns=1),
        "trials": trials,
    }
    return payload, thinned


def _plan() -> list[tuple[int, str, Channel]]:
    """(panel, which motion, channel) of every trace; panels 0-5 are the motions, 6-11 the residuals."""
    plan = []
    for panel, name in enumerate(LEFT):
        for which in ("measured",) if name in INPUTS else ("measured", "before", "after"):
            plan.append((panel, which, CHANNELS[name]))
    for panel, name in enumerate(RIGHT, start=len(LEFT)):
        plan.extend((panel, which, CHANNELS[name]) for which in ("before", "after"))
    return plan


def _axis(panel: int) -> str:
    return "" if panel == 0 else str(panel + 1)


def _traces(plan: list[tuple[int, str, Channel]]) -> list[dict[str, Any]]:
    """The traces without numbers, checked by plotly."""
    import plotly.graph_objects as go

    figure = go.Figure()
    legend: set[str] = set()
    for panel, which, channel in plan:
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
                hovertemplate=f"%{{y}} {channel.unit}",
            )
        )
        legend.add(which)
    traces: list[dict[str, Any]] = figure.to_plotly_json()["data"]
    return traces


def _layout(columns: int) -> dict[str, Any]:
    """The panels in two columns (motions, residuals) or one below the other, checked by plotly."""
    import plotly.graph_objects as go

    panels = len(LEFT) + len(RIGHT)
    rows = panels // columns
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
    for panel in range(panels):
        side, place = divmod(panel, rows) if columns == 2 else (0, panel)
        last = place == rows - 1
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
            "zeroline": panel >= len(LEFT),
            "nticks": 5,
            "title": {"text": _words(panel), "font": {"size": 11}, "standoff": 4},
        }
    checked: dict[str, Any] = go.Figure(layout=layout).to_plotly_json()["layout"]
    checked.pop("template", None)
    return checked


def _words(panel: int) -> str:
    """The axis title: what and unit, on two lines."""
    residual = panel >= len(LEFT)
    channel = CHANNELS[RIGHT[panel - len(LEFT)] if residual else LEFT[panel]]
    return f"{channel.words}{' error' if residual else ''}<br>[{channel.unit}]"


def _piece(
    found: Mapping[str, Motion], panel: int, which: str, channel: Channel, limit: int
) -> tuple[dict[str, Any], bool]:
    """The numbers of one trace, and whether they were thinned."""
    import numpy as np

    measured, motion = found.get("measured"), found.get(which)
    if motion is None or (panel >= len(LEFT) and measured is None):
        return {"x": [], "y": []}, False
    if panel >= len(LEFT):
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
