"""Results at a prompt and in a notebook: a line, a table, pictures.

A result says by its class that there is more to see of it than a line.  What that is, and how it is drawn, lies in
``notebook``, above all that has results.  ``mmgtune/__init__.py``, where the parts of the program come together, names
it here, and it is imported when something is first looked at.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Protocol

from .errors import OptionError, Problem, all_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from matplotlib.axes import Axes
    from pandas import DataFrame


class Display(Protocol):
    """Who shows results."""

    def html(self, of: object) -> str:
        """A fragment of HTML for a notebook."""
        ...

    def frame(self, of: object) -> DataFrame:
        """The numbers as a table."""
        ...

    def summary(self, of: object) -> str:
        """The result as text in columns; its ``repr`` is the text itself."""
        ...

    def sentence(self, of: object) -> str:
        """What came of it."""
        ...

    def plots(self, of: object) -> Sequence[str]:
        """Which pictures there are of it: "tracks", "histories", "coefficients"."""
        ...

    def plot(self, of: object, what: str, *which: str | Sequence[str], **how: Any) -> Any:
        """One of these pictures."""
        ...


class Brief:
    """A dataclass whose ``repr`` is a line; to be made with ``repr=False``.

    What holds many numbers is told by its size, what has parts by its class.
    """

    def __repr__(self) -> str:
        """In a line."""
        told = (f"{name}={_brief(value)}" for name, value in vars(self).items() if not name.startswith("_"))
        return f"{type(self).__name__}({_cut(', '.join(told))})"


def _brief(value: object) -> str:
    shape = getattr(value, "shape", None)
    if shape:
        return f"array{shape}"
    if isinstance(value, str):
        return repr(_cut(inert(value), 40))
    if isinstance(value, (tuple, list, dict, frozenset)):
        return repr(value) if not value else f"<{len(value)}>"
    return f"{value:.6g}" if isinstance(value, float) else repr(value) if _is_plain(value) else type(value).__name__


def _is_plain(value: object) -> bool:
    return value is None or isinstance(value, (bool, int))


def _cut(text: str, size: int = 160) -> str:
    return text if len(text) <= size else f"{text[:size]}..."


_load: Callable[[], Display] | None = None


def displayed_by(load: Callable[[], Display]) -> None:
    """Say who shows results.

    load  returns it; called when something is first looked at
    """
    global _load
    _load = load


def _display() -> Display:
    if _load is None:
        raise RuntimeError("nobody was named who shows results; import mmgtune as a package")
    return _load()


class Displayed:
    """A result with a table: in a notebook, as text, and as a frame of pandas."""

    def _repr_html_(self) -> str:
        return _display().html(self)

    def to_frame(self) -> DataFrame:
        """The numbers as a pandas ``DataFrame``, units in the names of columns or in one of their own."""
        return _display().frame(self)

    def summary(self) -> str:
        """The result as a text of at most 80 columns."""
        return _display().summary(self)

    def sentence(self) -> str:
        """What came of it, as the headline of its report says; the line it prints as where there is nothing to say."""
        return _display().sentence(self)


class Plotted(Displayed):
    """A result with pictures besides."""

    @property
    def plot(self) -> Plots:
        """Pictures of it, drawn with matplotlib."""
        return Plots(self)


class Plots:
    """Pictures of one result; each method returns matplotlib axes.

    Which there are is said by ``dir`` and by the ``repr``; another raises OptionError.
    """

    def __init__(self, of: Plotted):
        self._of = of

    def __repr__(self) -> str:
        """In a line."""
        return f"Plots(of {type(self._of).__name__}: {', '.join(_display().plots(self._of))})"

    def __dir__(self) -> list[str]:
        return list(_display().plots(self._of))

    def __call__(self, *_: object, **__: object) -> Any:
        """Raises OptionError: there are several pictures, and each has a name."""
        there = " or ".join(f".plot.{name}()" for name in _display().plots(self._of))
        why = "each picture has a name" if there else f"there is no picture of a {type(self._of).__name__}"
        raise OptionError(Problem("no picture is named", "plot", why, f"write {there}" if there else "see summary()"))

    def tracks(self, *trials: str | Sequence[str], ax: Axes | None = None) -> Any:
        """Tracks on the water, north up, measured and simulated.

        trials  ids, one by one or in a list; all (of many the first 16) where none is named
        ax      axes to draw them all into; where None each trial gets its own
        -> the axes, or for several trials without ``ax`` an array of them
        Raises OptionError for an id that is not there.
        """
        return _display().plot(self._of, "tracks", *trials, ax=ax)

    def histories(
        self, trial: str | None = None, channels: str | Sequence[str] = (), *, ax: Axes | Sequence[Axes] | None = None
    ) -> Any:
        """Motions and inputs of one trial over time, measured and simulated.

        trial     its id, the first where None
        channels  one or several, such as "psi", "u", "delta"; where none all motions but the position, and what drives
                  the ship
        ax        axes to draw into, as many as channels; new ones where None
        -> an array of axes, one a channel
        Raises OptionError for what is not there.
        """
        named = () if trial is None else (trial,)
        several = (channels,) if isinstance(channels, str) else all_of(channels, str, "channels")
        return _display().plot(self._of, "histories", *named, channels=several, ax=ax)

    def coefficients(self, *, ax: Axes | None = None) -> Any:
        """The coefficients in the room they had, with what is known of each.

        -> the axes
        """
        return _display().plot(self._of, "coefficients", ax=ax)


_STEERING = "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff\ud800-\udfff]"
"""Control characters but for tab and line feed, marks that turn the direction of writing, half characters."""


def inert(text: str) -> str:
    r"""A text with what could steer a terminal written as ``\u001b``, as JSON does; so it is JSON still if it was."""
    return re.sub(_STEERING, lambda found: f"\\u{ord(found[0]):04x}", text)
