"""The run folder of a diagnosis: each file whole or not there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..documents import write_json
from ..errors import must_be_a
from ..files import all_or_none, path_of, refuse_existing, write_text
from ..fitting.folder import motions_table
from ..fitting.journal import finished
from ..parquet_tables import write_table
from ..run_folders import MOTIONS
from .calm import calm_profile
from .result import Diagnosis

RESULT = "diagnosis.json"
CALM = "calm.toml"


@all_or_none()
def write_diagnosis(result: Diagnosis, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write the extended profile, the held-out motions and, last, the result.  Returns its document.

    Where a cause is of the day, such as a current, ``calm.toml`` is the profile without it, for predictions.

    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    folder = path_of(folder)
    must_be_a(result, Diagnosis, "result")
    refuse_existing([folder / RESULT, folder / MOTIONS], overwrite)
    extended = result.extended_profile()
    write_text(folder / "profile.toml", extended.text)
    calm = calm_profile(extended)
    if calm is not None:
        write_text(folder / CALM, calm.text)
    else:
        (folder / CALM).unlink(missing_ok=True)
    inputs = [one.name for one in result.profile.arrangement.inputs]
    write_table(folder / MOTIONS, motions_table(result.gain.compared, inputs))
    document = {**result.to_dict(), "out": str(folder)}
    write_json(document, folder / RESULT)
    if not result.interrupted:
        finished(folder)
    return document
