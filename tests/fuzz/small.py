"""Trials so short that a case with them takes a moment."""

from __future__ import annotations

import functools
import tempfile
from dataclasses import replace
from pathlib import Path

from mmgtune.trial import Trial, load_trials, write_trial
from mmgtune.trial.schema import ATTRIBUTES

SAMPLES = 40


def short(trial: Trial, samples: int = SAMPLES) -> Trial:
    """The beginning of a trial."""
    return replace(trial, extra={}, **{name: getattr(trial, name)[:samples] for name in ATTRIBUTES.values()})


@functools.cache
def trials() -> dict[str, bytes]:
    """Files of a data set: three trials to tune to and one to test on."""
    found = load_trials("suzaku")
    names = [*found.tune[:3], *found.test[:1]]
    with tempfile.TemporaryDirectory() as folder:
        files = {}
        for name in names:
            path = write_trial(short(found.trials[name]), Path(folder) / f"{name}.parquet")
            files[path.name] = path.read_bytes()
    quoted = [f'"{name}"' for name in names]
    files["split.toml"] = f"tune = [{', '.join(quoted[:3])}]\ntest = [{quoted[3]}]\n".encode()
    return files
