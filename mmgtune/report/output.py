"""Writing a report's files."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from ..files import atomic, write_text
from ..run_files import FIGURES, REPORT_HTML, REPORT_MARKDOWN
from .figures import svg

if TYPE_CHECKING:
    from .blocks import Page


def write(folder: Path, page: Page, html: str, markdown: str, pdf: bool) -> list[Path]:
    """Write the report and its figures, and remove figures that an earlier rendering left and this one has not.

    pdf  figures as PDF files too; those that are there are written anew in any case
    """
    drawn_before = _figures(folder / REPORT_MARKDOWN)
    written = [write_text(folder / REPORT_HTML, html), write_text(folder / REPORT_MARKDOWN, markdown)]
    figures = page.figures()
    for name, figure in figures.items():
        written.append(write_text(folder / FIGURES / f"{name}.svg", svg.file(figure)))
        path = folder / FIGURES / f"{name}.pdf"
        if pdf or path.exists():
            from .figures.pdf import render

            with atomic(path) as part:
                part.write_bytes(render(figure))
            written.append(path)
    for name in drawn_before - set(figures):
        for suffix in (".svg", ".pdf"):
            (folder / FIGURES / f"{name}{suffix}").unlink(missing_ok=True)
    return written


def _figures(report: Path) -> set[str]:
    """Names of the figures that a report.md shows; none where there is no such file."""
    text = report.read_text(encoding="utf-8", errors="replace") if report.is_file() else ""
    return set(re.findall(r"^!\[.*\]\(figures/(\w+)\.svg\)$", text, re.MULTILINE))
