"""The record of a check, for its report; a baseline is a file of another name, which nothing but an update writes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..provenance import made_by
from ..run_files import CHECKED
from ..writing_results import place_for, write_record
from .result import CheckReport


def write_check(
    result: CheckReport, folder: Path | str, command: str = "", *, overwrite: bool = False
) -> dict[str, Any]:
    """Write the record into a run folder.  Returns it.

    Raises OutputError where one is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, CheckReport, folder, CHECKED, overwrite=overwrite) as place:
        return write_record({**result.to_dict(), **made_by(command)}, place, CHECKED)
