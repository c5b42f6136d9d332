"""Trial files: odd columns and values, and bits turned over."""

from __future__ import annotations

import functools
import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.motions import trial_indices
from mmgtune.trial import check_trial, load_trials, windows, write_trial
from mmgtune.trial.describe import describe
from tests.trial.made import made

from ..mutating import mutated_bytes, pick, several
from . import Files, Kind
from .parquet_logs import odd_values, other_type, shorter, written

FACTS = {"schema": 1, "id": "run", "ship": "ketch", "source": "measured", "noise": {"x": 0.4}}


@functools.cache
def whole() -> bytes:
    """A trial as the program writes it: 150 samples of a zigzag."""
    with tempfile.TemporaryDirectory() as folder:
        return write_trial(made("run", zigzag=True, samples=150, seed=1), Path(folder) / "run.parquet").read_bytes()


def columns_of() -> dict[str, Any]:
    """Columns of a trial by their names in the file."""
    return dict(made("run", zigzag=True, samples=150, seed=1).columns)


def make(rng: np.random.Generator) -> Files:
    """A trial with something wrong in its columns or bytes."""
    if rng.random() < 0.5:
        return {"run.parquet": several(rng, whole(), [mutated_bytes])}
    columns = columns_of()
    for name in ("wind_speed", "wind_dir", "n_port", "n_stbd", "delta_port", "depth", "n_bow"):
        if rng.random() < 0.1:
            columns[name] = columns[pick(rng, ("n", "delta", "psi", "u"))]
    columns = several(rng, columns, [odd_values, odd_values, other_type, shorter])
    return {"run.parquet": written(rng, columns, {b"mmgtune": json.dumps(FACTS).encode()})}


def run(folder: Path) -> str:
    """Load, check, describe, cut and write it again, as the commands do."""
    trials = load_trials(folder)
    said = []
    for trial in trials.trials.values():
        findings = check_trial(trial)
        json.dumps([vars(one) for one in findings], allow_nan=False)
        json.dumps({**describe(trial), "indices": trial_indices(trial, 80.0)}, allow_nan=False).encode("utf-8")
        windows(trial, 60.0)
        write_trial(trial, folder / "out" / "again.parquet")
        said.append(f"{len(findings)} findings")
    return ", ".join(said)


KIND = Kind("trials", make, run)
