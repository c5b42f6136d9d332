"""``mmgtune report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import OptionError, Problem
from . import common as c


def command(
    run: Annotated[Path, typer.Argument(help="Run folder: what --out of a command named.")],
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

    if run.is_file():
        what, why = "this is a file, not a run folder", "a report is made of the whole folder, and written into it"
        raise OptionError(Problem(what, str(run), why, f"give the folder: {run.parent}"))
    for path in render(run, pdf=pdf):
        c.show(str(path))
