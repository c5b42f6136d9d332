"""The record of a check, for its report; a baseline is a file of another name, which nothing but an update writes."""

from __future__ import annotations

from pathlib import Path

from ..documents import write_json
from ..provenance import made_by
from .result import CheckReport

RESULT = "checked.json"


def write_check(report: CheckReport, folder: Path, command: str = "") -> None:
    """Write the record into a folder that is there, in place of an older one.  Raises OutputError where it cannot."""
    write_json({**report.to_dict(), **made_by(command), "out": str(folder)}, folder / RESULT)
