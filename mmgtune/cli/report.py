"""``mmgtune report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from . import common as c


def command(
    run: Annotated[Path, typer.Argument(help="Run folder of a fit, a sweep or a diagnosis.")],
) -> None:
    """Render the report of a run again, without fitting.

    Example:

      mmgtune report runs/today
    """
    from ..report import render

    for path in render(run):
        c.show(str(path))
