"""The run folder of a training: the model, what is said of it, and checkpoints until it is complete."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..networks import save_network
from ..run_files import CHECKPOINTS, ENSEMBLE, HYBRID, LEARNING, MIXTURE, MODEL
from ..run_folders import remove_kept
from ..writing_results import place_for, write_record
from .ensemble_run import LearnedEnsemble
from .hybrid_run import LearnedHybrid
from .mixing import LearnedMixture
from .run import Learned


def write_learned(
    result: Learned | LearnedHybrid | LearnedEnsemble | LearnedMixture, folder: Path | str, *, overwrite: bool = False
) -> dict[str, Any]:
    """Write a run folder, the record last; checkpoints stay where the training was stopped.  Returns the record.

    Raises OutputError where a record is there already and ``overwrite`` is false, or the system refuses to write.
    """
    kinds = (Learned, LearnedHybrid, LearnedEnsemble, LearnedMixture)
    name = next((file for kind, file in NAMES.items() if isinstance(result, kind)), LEARNING)
    with place_for(result, kinds, folder, name, MODEL, overwrite=overwrite) as place:
        save_network(result.as_ship(), place / MODEL, overwrite=True)
        record = write_record(result.to_dict(), place, name)
        if not isinstance(result, LearnedMixture) and not result.interrupted:
            remove_kept(place.glob(CHECKPOINTS))
        return record


NAMES: dict[type, str] = {LearnedHybrid: HYBRID, LearnedEnsemble: ENSEMBLE, LearnedMixture: MIXTURE}
"""Records of what was learned, of others ``LEARNING``."""
