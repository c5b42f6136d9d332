"""Records that hold what records do not hold: refused with a place, nothing written, never a traceback."""

import json

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from mmgtune.errors import OptionError
from mmgtune.report import render

from . import fake_run


@pytest.mark.parametrize(
    "changes",
    [
        {"coefficients": [3]},
        {"coefficients": "x"},
        {"trial_results": None},
        {"inputs": [[]]},
    ],
    ids=lambda changes: next(iter(changes)),
)
def test_a_damaged_fit(tmp_path, changes):
    data, history, motions = fake_run.edited(**changes)
    folder = fake_run.write_fit(tmp_path / "run", data, history, motions)
    there = sorted(folder.iterdir())
    with pytest.raises(OptionError) as error:
        render(folder)
    assert error.value.problems[0].where.endswith("fit.json") or "inputs" in changes
    assert sorted(folder.iterdir()) == there


def test_motions_of_words(tmp_path):
    data, history, motions = fake_run.edited()
    folder = fake_run.write_fit(tmp_path / "run", data, history, motions.assign(x="far"))
    with pytest.raises(OptionError, match="no report can be made"):
        render(folder)


def test_a_damaged_sweep(tmp_path):
    folder = fake_run.make_sweep(tmp_path / "run")
    data = json.loads((folder / "sweep.json").read_text())
    for wrong in ({"recommended": "0.5"}, {"runs": [1]}):
        (folder / "sweep.json").write_text(json.dumps({**data, **wrong}))
        with pytest.raises(OptionError, match="no report can be made"):
            render(folder)


def test_half_a_character(tmp_path):
    """JSON can name halves of characters, and no file of a report can hold one; whole ones may be written so."""
    folder = fake_run.make_sweep(tmp_path / "run")
    text = (folder / "sweep.json").read_text()
    data = json.loads(text)
    (folder / "sweep.json").write_text(json.dumps({**data, "command": "mmgtune sweep -p \U0001f6a2"}))
    render(folder)
    (folder / "sweep.json").write_text(json.dumps({**data, "command": "mmgtune sweep -p \ud83d"}))
    with pytest.raises(OptionError, match="cannot be read"):
        render(folder)


def test_motions_that_expand_without_end(tmp_path):
    data, history, motions = fake_run.edited()
    folder = fake_run.write_fit(tmp_path / "run", data, history, motions)
    pq.write_table(pa.table({"x": np.zeros(3_000_000)}), folder / "motions.parquet")
    with pytest.raises(OptionError, match="expands far beyond what it can hold"):
        render(folder)
