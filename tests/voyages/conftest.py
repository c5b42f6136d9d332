"""Voyages made by the model itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from mmgtune.model import Model
from mmgtune.trial import Trial, write_trial
from mmgtune.trial.schema import METADATA_KEY
from tools.generate_voyage import make_voyage


@pytest.fixture(scope="session")
def voyage(suzaku: Model) -> Trial:
    """Two hours at 1 Hz with the noise of sensors, in memory."""
    return make_voyage(suzaku, 2.0)


@pytest.fixture(scope="session")
def voyage_file(voyage: Trial, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same as a file."""
    return write_trial(voyage, tmp_path_factory.mktemp("voyages") / "voyage.parquet")


def rows(trial: Trial, keep: slice | np.ndarray) -> Trial:
    """Some rows of a trial."""
    columns = {name: getattr(trial, name)[keep] for name in ("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta")}
    return replace(trial, extra={name: values[keep] for name, values in trial.extra.items()}, **columns)


def with_nan(trial: Trial, name: str, where: slice) -> Trial:
    """A copy with a gap in one column."""
    values = np.array(getattr(trial, name))
    values[where] = np.nan
    return replace(trial, **{name: values})


def write_foreign(trial: Trial, path: Path, group: int, facts: bytes = b'{"manoeuvre": "voyage"}') -> Path:
    """The same numbers as another program writes them, in row groups of any size."""
    path.parent.mkdir(exist_ok=True)
    table = pa.table({name: pa.array(values) for name, values in trial.columns.items()})
    pq.write_table(table.replace_schema_metadata({METADATA_KEY: facts}), path, row_group_size=group)
    return path
