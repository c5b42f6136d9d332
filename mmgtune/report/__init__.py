"""Reports of runs: one HTML file, the same as Markdown, and the figures as files."""

from __future__ import annotations

from pathlib import Path

from ..errors import OptionError
from ..resources import must_be_name

__all__ = ["render"]


def render(folder: Path | str, *, pdf: bool = False) -> list[Path]:
    """Write the report of the run in ``folder`` into it: report.html, report.md and figures/*.svg.

    pdf  write figures/*.pdf too, which takes nearly as long again

    Earlier renderings are replaced; the same run gives the same bytes.  Runs that lie in folders inside it and
    that its report leads to, as those of a sweep, get theirs too.  Returns the files written, report.html first.

    Raises OptionError for a folder that is no run folder or cannot be read, OutputError where it cannot be written.
    """
    must_be_name(folder, "run folder", OptionError)
    folder = Path(folder)
    from . import html, load, markdown
    from .output import write
    from .pages.kinds import KINDS

    kind, run = load.find(folder, KINDS)
    with load.whole(folder / kind.file):
        page = kind.build(run)
        rendered = html.render(page), markdown.render(page)
        others = list(kind.inside(run))
    written = write(folder, page, *rendered, pdf)
    for other in others:
        written += render(other, pdf=pdf)
    return written
