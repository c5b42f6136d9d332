"""Pictures of results on matplotlib axes, in the colours of the reports; names from files are drawn as plain text."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any

import numpy as np

from ..displayed import inert
from ..errors import OptionError, Problem, among, brief, parts_of
from ..inputs import INPUTS
from ..report.figures.svg import FILE_COLORS
from ..report.wording import CHANNELS, OVER_TIME, Channel, input_channel
from ..text_tables import cut
from .view import Line, Room, View
from .words import words

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BEFORE, AFTER, BOX, FLAG, MUTED = (FILE_COLORS[name] for name in ("before", "after", "box", "flag", "muted"))

LINES: Mapping[str, Mapping[str, Any]] = {
    "measured": {"color": FILE_COLORS["ink"], "linewidth": 1.5, "linestyle": "-"},
    "before": {"color": BEFORE, "linewidth": 1.3, "linestyle": (0, (1.2, 1.6))},
    "after": {"color": AFTER, "linewidth": 1.5, "linestyle": (0, (6, 2.2))},
}
"""How the motions of a fit are drawn: colour and dash both differ."""

MOST = 16
"""Trials that are drawn where none is named."""

COLOURS = ("#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#d55e00")
"""Of models, told apart by those who see colours otherwise too (Okabe & Ito)."""

DASHES = ("dashed", "dashdot", (0, (1.2, 1.6)), (0, (7, 2, 1, 2, 1, 2)))


def plain(draw: Callable[..., Any]) -> Callable[..., Any]:
    """A function that draws, in which no name is read as mathematics."""

    @wraps(draw)
    def drawn(*args: Any, **how: Any) -> Any:
        import matplotlib as mpl

        with mpl.rc_context({"text.parse_math": False, "axes.unicode_minus": True}):
            made = draw(*args, **how)
            showing = mpl.is_interactive()
        mpl.interactive(showing)  # a back end loaded by the first picture has set it; the end of the context undid that
        return made

    return drawn


@plain
def draw_tracks(view: View, *trials: str | Sequence[str], ax: Axes | None = None) -> Any:
    """See ``displayed.Plots.tracks``."""
    motions = view.motions() if view.motions else {}
    names = _named(motions, trials) if trials else [*motions][:MOST]
    axes = [ax] * len(names) if ax is not None else _grid(len(names), (3.2, 3.2))
    styles = _styles(motions, names)
    for place, name in zip(axes, names, strict=True):
        for line in motions[name]:
            _track(place, line, styles[line.words])
        place.set_aspect("equal", adjustable="datalim")
        place.set_xlabel("east [m]")
        place.set_ylabel("north [m]")
        if ax is None:
            place.set_title(cut(inert(name), 34), fontsize="medium")
    _legend(axes, styles, own=ax is None)
    if ax is not None or len(axes) == 1:
        return axes[0]
    left = len(motions) - len(names)
    if left and not trials:
        axes[0].figure.suptitle(f"{len(names)} of {len(motions)} trials; name others in tracks(...)", fontsize="small")
    return np.array(axes)


@plain
def draw_histories(view: View, *trials: str | Sequence[str], channels: Sequence[str] = (), ax: Any = None) -> Any:
    """See ``displayed.Plots.histories``."""
    motions = view.motions() if view.motions else {}
    if not motions:
        raise _nothing()
    names = _named(motions, trials) if trials else [*motions][:1]
    if len(names) != 1:
        why = "histories are of one trial, over its own time"
        fix = f"name one: .plot.histories({(names or [*motions])[0]!r})"
        raise OptionError(Problem(f"{len(names)} trials are named", "plot", why, fix))
    (name,) = names
    lines = motions[name]
    shown = [_channel(one, lines) for one in channels or _usual(lines)]
    if ax is None:
        axes = _grid(len(shown), (4.2, 2.0))
        axes[0].figure.suptitle(cut(inert(name), 60), fontsize="medium")
    else:
        axes = list(np.ravel(ax))
        if len(axes) != len(shown):
            problem = f"{len(shown)} channels on {len(axes)} axes"
            raise OptionError(Problem(problem, "ax", fix="name as many channels as there are axes"))
    styles = _styles(motions, [name])
    for place, channel in zip(axes, shown, strict=True):
        for line in lines:
            if channel.name in line.columns and (line.kind == "measured" or not _shared(channel.name, lines)):
                style = {key: value for key, value in styles[line.words].items() if key != "label"}
                place.plot(line.t, channel.factor * line.columns[channel.name], **style)
        place.set_ylabel(channel.title, fontsize="small")
        place.set_xlabel("time [s]", fontsize="small")
        place.grid(visible=True, alpha=0.3)
    _legend(axes, styles, own=ax is None)
    return np.array(axes)


@plain
def draw_coefficients(view: View, *, ax: Axes | None = None) -> Any:
    """See ``displayed.Plots.coefficients``."""
    rooms = view.rooms() if view.rooms else {}
    names = list(dict.fromkeys(room.name for of in rooms.values() for room in of))
    place = ax if ax is not None else _grid(1, (7.0, 0.32 * len(names) + 1.0))[0]
    several = len(rooms) > 1
    for k, (what, of) in enumerate(rooms.items()):
        colour = COLOURS[k % len(COLOURS)] if several else AFTER
        shift = (k - 0.5 * (len(rooms) - 1)) * 0.6 / len(rooms)
        for room in of:
            _room(place, names.index(room.name), shift, room, colour, several)
        if several:
            place.plot([], [], "o", color=colour, label=inert(what))
    place.axvline(0.5, color=BEFORE, linewidth=1.0, linestyle=":")
    place.set_yticks(range(len(names)), [cut(inert(name), 30) for name in names])
    place.set_ylim(len(names) - 0.4, -0.6)
    place.set_xlim(-0.14, 1.14)
    place.set_xticks([0.0, 0.5, 1.0], ["low", "middle", "high"])
    place.set_xlabel(
        "place in the room there was\nlines: 95 %; diamonds: at a bound; hollow: not determined", fontsize="small"
    )
    if several:
        place.legend(fontsize="small", frameon=False, ncols=len(rooms), loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return place


def _room(ax: Axes, row: int, shift: float, room: Room, colour: str, several: bool) -> None:
    """One coefficient."""
    if shift <= 0.0 or not several:
        ax.barh(row, 1.0, height=0.66, color=BOX, zorder=0)
    colour = FLAG if room.at_bound and not several else colour
    if room.reach is not None and np.isfinite(room.reach):
        ends = np.clip([room.position - room.reach, room.position + room.reach], -0.12, 1.12)
        ax.plot(ends, [row + shift] * 2, color=colour, linewidth=1.5)
    face = colour if room.determined else "none"
    marker = "D" if room.at_bound else "o"
    ax.plot([room.position], [row + shift], marker=marker, color=colour, markerfacecolor=face, linestyle="none")
    if not several:
        ax.annotate(words(room.value) or "∞", (1.0, row), xycoords=("axes fraction", "data"), xytext=(5, 0),
                    textcoords="offset points", va="center", fontsize="small")  # fmt: skip


def _named(motions: Mapping[str, Any], trials: Sequence[str | Sequence[str]]) -> list[str]:
    """Ids that are there, given one by one or in lists.  Raises OptionError for one that is not."""
    names: list[Any] = []
    for given in trials:
        parts = parts_of(given)
        names += [given] if parts is None else parts
    unknown = [name for name in names if not isinstance(name, str) or name not in motions]
    if unknown:
        what = f"there is no trial '{unknown[0]}'" if isinstance(unknown[0], str) else f"{brief(unknown[0])} is no id"
        raise OptionError(Problem(what, "plot", **among(unknown[0], [*motions])))
    return names


def _nothing() -> OptionError:
    return OptionError(Problem("there is nothing to draw", "plot", "no trial is a time series"))


def _grid(amount: int, cell: tuple[float, float]) -> list[Any]:
    """Axes in rows of up to four, on a figure that a notebook shows."""
    import matplotlib.pyplot as plt

    if not amount:
        raise _nothing()
    columns = amount if amount <= 3 else 2 if amount == 4 else 3 if amount in (5, 6, 9) else 4
    rows = -(-amount // columns)
    size = (cell[0] * columns, cell[1] * rows + 0.4)
    figure, axes = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
    places: list[Any] = axes.flatten().tolist()
    for unused in places[amount:]:
        figure.delaxes(unused)
    return places[:amount]


def _styles(motions: Mapping[str, Sequence[Line]], names: Sequence[str]) -> dict[str, dict[str, Any]]:
    """How each kind of line is drawn, by its words, in the order they come."""
    found: dict[str, dict[str, Any]] = {}
    for name in names:
        for line in motions[name]:
            if line.words not in found:
                found[line.words] = _style(line, len([one for one in found if one != "measured"]))
    return found


def _style(line: Line, k: int) -> dict[str, Any]:
    if line.kind in LINES:
        style = dict(LINES[line.kind])
    elif line.kind == "member":
        style = {"color": AFTER, "linewidth": 0.8, "alpha": 0.35}
    else:
        style = {"color": COLOURS[k % len(COLOURS)], "linestyle": DASHES[k % len(DASHES)], "linewidth": 1.4}
    return {**style, "label": line.words}


def _track(ax: Axes, line: Line, style: Mapping[str, Any]) -> None:
    """One track, from where it begins."""
    x, y = line.columns["x"], line.columns["y"]
    ax.plot(y, x, **{key: value for key, value in style.items() if key != "label"})
    if line.kind == "measured":
        ax.plot(y[:1], x[:1], marker="+", markersize=9, color=MUTED, linestyle="none")
    ax.grid(visible=True, alpha=0.3)


def _legend(axes: Sequence[Axes], styles: Mapping[str, Mapping[str, Any]], own: bool) -> None:
    """What the lines are, where there is more than one kind: below all axes, or in the first of a figure of others."""
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], **{**style, "alpha": 1.0, "label": _label(name)}) for name, style in styles.items() if name
    ]
    if len(handles) < 2:
        return
    if own:
        figure: Any = axes[0].figure
        figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False, handlelength=2.6)
    else:
        axes[0].legend(handles=handles, fontsize="small", framealpha=0.8, handlelength=2.6)


def _label(name: str) -> str:
    """A name in a legend, where matplotlib leaves out what begins with an underscore."""
    return cut(("\u2009" if name.startswith("_") else "") + inert(name), 28)


def _usual(lines: Sequence[Line]) -> list[str]:
    """Motions, and what drives the ship."""
    inputs = dict.fromkeys(name for line in lines for name in line.columns if name in INPUTS)
    return [*OVER_TIME, *inputs]


def _shared(name: str, lines: Sequence[Line]) -> bool:
    """Whether a channel is an input that the measured line has: models are given the same."""
    return name in INPUTS and any(line.kind == "measured" and name in line.columns for line in lines)


def _channel(name: str, lines: Sequence[Line]) -> Channel:
    """A channel as people read it.  Raises OptionError for one that no line has."""
    known = list(dict.fromkeys(one for line in lines for one in line.columns))
    name = {"v": "v_m"}.get(name, name)
    if name not in known:
        raise OptionError(Problem(f"there is no channel '{name}'", "channels", **among(name, known)))
    if name in CHANNELS:
        return CHANNELS[name]
    return input_channel(name, INPUTS[name].words, INPUTS[name].unit)
