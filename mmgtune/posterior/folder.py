"""What ``posterior`` leaves behind."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..fitting.journal import finished
from ..particles import save_particles
from ..run_files import PARTICLES, POSTERIOR, POSTERIOR_JOURNAL
from ..writing_results import place_for, write_record
from .run import Posterior

FILES = (PARTICLES, POSTERIOR)


def write_posterior(result: Posterior, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write particles and their document; the latter last, so that its presence means the rest is there.

    Returns the document.  Raises OutputError where a file is there already and ``overwrite`` is false.
    """
    with place_for(result, Posterior, folder, *FILES, overwrite=overwrite) as place:
        save_particles(result.particles, place / PARTICLES, overwrite)
        document = write_record(result.to_dict(), place, POSTERIOR)
        if not result.interrupted:
            finished(place, POSTERIOR_JOURNAL)
        return document
