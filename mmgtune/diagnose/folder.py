"""The run folder of a diagnosis: each file whole or not there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..files import write_text
from ..fitting.folder import motions_table
from ..fitting.journal import finished
from ..parquet_tables import write_table
from ..run_files import CALM, DIAGNOSIS, MOTIONS, PROFILE
from ..writing_results import place_for, write_record
from .calm import calm_profile
from .result import Diagnosis


def write_diagnosis(result: Diagnosis, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write the extended profile, the held-out motions and, last, the result.  Returns its document.

    Where a cause is of the day, such as a current, ``calm.toml`` is the profile without it, for predictions.

    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, Diagnosis, folder, DIAGNOSIS, MOTIONS, overwrite=overwrite) as place:
        extended = result.extended_profile()
        write_text(place / PROFILE, extended.text)
        calm = calm_profile(extended)
        if calm is not None:
            write_text(place / CALM, calm.text)
        else:
            (place / CALM).unlink(missing_ok=True)
        inputs = [one.name for one in result.profile.arrangement.inputs]
        write_table(place / MOTIONS, motions_table(result.gain.compared, inputs))
        document = write_record(result.to_dict(), place, DIAGNOSIS)
        if not result.interrupted:
            finished(place)
        return document
