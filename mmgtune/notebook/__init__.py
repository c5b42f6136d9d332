"""Results in notebooks: tables as HTML and frames, pictures, texts in columns.  See ``displayed``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..displayed import inert
from ..errors import OptionError, Problem
from .kinds import view_of

if TYPE_CHECKING:
    from pandas import DataFrame


def html(of: object) -> str:
    """See ``displayed.Display``."""
    from . import markup

    return markup.html(view_of(of))


def frame(of: object) -> DataFrame:
    """See ``displayed.Display``."""
    import pandas as pd

    view = view_of(of)
    if view.frame is not None:
        return pd.DataFrame(dict(view.frame)).set_index(view.along)
    return pd.DataFrame([dict(row) for row in view.rows])


def summary(of: object) -> str:
    """See ``displayed.Display``."""
    from . import text

    return text.summary(view_of(of))


def sentence(of: object) -> str:
    """See ``displayed.Display``."""
    view = view_of(of)
    return inert(" ".join(view.says) or view.title).replace("\u00a0", " ")


def plots(of: object) -> Sequence[str]:
    """See ``displayed.Display``."""
    view = view_of(of)
    found = ["tracks", "histories"] if view.motions is not None else []
    return [*found, "coefficients"] if view.rooms is not None else found


def plot(of: object, what: str, *which: str | Sequence[str], **how: Any) -> Any:
    """See ``displayed.Display``.  Raises OptionError for a picture that there is not."""
    there = plots(of)
    if what not in there:
        problem = f"there is no picture of {what} of a {type(of).__name__}"
        raise OptionError(Problem(problem, "plot", fix=f"one of: {', '.join(there)}"))
    from . import pictures

    return getattr(pictures, f"draw_{what}")(view_of(of), *which, **how)
