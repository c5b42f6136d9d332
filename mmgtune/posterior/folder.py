"""What ``posterior`` leaves behind."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..documents import write_json
from ..errors import must_be_a
from ..files import all_or_none, path_of
from ..fitting.journal import finished
from ..particles import FILE, save_particles
from .run import JOURNAL, Posterior

RESULT = "posterior.json"
FILES = (FILE, RESULT)


@all_or_none()
def write_posterior(result: Posterior, folder: Path | str, overwrite: bool = False) -> dict[str, Any]:
    """Write particles and their document; the latter last, so that its presence means the rest is there.

    Returns the document.  Raises OutputError where a file is there already and ``overwrite`` is false.
    """
    folder = path_of(folder)
    must_be_a(result, Posterior, "result")
    save_particles(result.particles, folder / FILE, overwrite)
    document = {**result.to_dict(), "out": str(folder)}
    write_json(document, folder / RESULT, overwrite)
    if not result.interrupted:
        finished(folder, JOURNAL)
    return document
