"""Reports of a fit, a sweep or a diagnosis: one HTML file, the same as Markdown, and the figures as files."""

from __future__ import annotations

from pathlib import Path

__all__ = ["render"]


def render(folder: Path) -> list[Path]:
    """Write the report of the run in ``folder`` into it: report.html, report.md and figures/*.svg and *.pdf.

    Earlier renderings are replaced; the same run gives the same bytes.  A sweep's runs that lie in folders inside
    it get their reports too, since the sweep's report leads to them.  Returns the files written, report.html first.

    Raises OptionError for a folder that is no run folder or cannot be read, OutputError where it cannot be written.
    """
    from . import diagnosis_page, fit_page, html, load, markdown, misfit, sweep_page
    from .output import write

    record = load.load(folder)
    if isinstance(record, load.RunRecord):
        page = fit_page.build(record)
        return write(folder, page, html.render(page), markdown.render(page))
    if isinstance(record, load.DiagnosisRecord):
        page = diagnosis_page.build(record)
        return write(folder, page, html.render(page), markdown.render(page))
    page = sweep_page.build(record)
    written = write(folder, page, html.render(page), markdown.render(page))
    for run in record.runs:
        name = misfit.run_folder(run)
        if name is not None and (folder / name / "fit.json").is_file():
            written += render(folder / name)
    return written
