"""``mmgtune report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from . import common as c


def command(
    run: Annotated[Path, typer.Argument(help="Run folder of a fit, a sweep, a diagnosis, or of voyages.")],
    pdf: Annotated[
        bool, typer.Option("--pdf", help="Write the figures as PDF files too, as papers want them.")
    ] = False,
) -> None:
    """Render the report of a run again, without fitting.

    Example:

      mmgtune report runs/today

      mmgtune report runs/today --pdf
    """
    from ..report import render

    for path in render(run, pdf=pdf):
        c.show(str(path))
