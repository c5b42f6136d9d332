"""Tables that are written of their buffers."""

from __future__ import annotations

import os
import stat
import sys

import numpy as np
import pyarrow.parquet as pq
import pytest

from mmgtune.errors import OutputError
from mmgtune.parquet_tables import write_table

COLUMNS = {
    "number": np.array([1.5, np.nan, -0.0]),
    "strided": np.arange(6.0)[::2],
    "whole": [1, 2, -3],
    "truth": np.array([True, False, True]),
    "text": np.array(["Å", "", "abc"], dtype=object),
    "word": ["a", "bc", "d"],
}


def test_what_is_written_is_read_by_pyarrow_and_pandas_alike(tmp_path):
    write_table(tmp_path / "some.parquet", COLUMNS, metadata={b"key": b"value"})
    table = pq.read_table(tmp_path / "some.parquet", page_checksum_verification=True)
    assert table.schema.metadata[b"key"] == b"value"
    for name, values in COLUMNS.items():
        np.testing.assert_array_equal(table.to_pandas()[name].to_numpy(), values)


@pytest.mark.parametrize("n", [0, 1, 17])
def test_truths_of_any_number(tmp_path, n):
    truths = np.arange(n) % 3 == 0
    write_table(tmp_path / "some.parquet", {"truth": truths, "text": np.full(n, "x", dtype=object)}, 5)
    assert pq.read_table(tmp_path / "some.parquet")["truth"].to_pylist() == truths.tolist()


@pytest.mark.skipif(sys.platform == "win32", reason="there is no mask of permissions")
@pytest.mark.parametrize(("mask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o644)])
def test_files_are_as_private_as_the_user_has_them(tmp_path, mask, mode):
    """Nobody else may ever write to them: compiled kernels are among them."""
    before = os.umask(mask)
    try:
        write_table(tmp_path / "some.parquet", COLUMNS)
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "some.parquet").stat().st_mode) == mode


def test_a_file_that_is_there_stays(tmp_path):
    (tmp_path / "some.parquet").write_text("mine")
    with pytest.raises(OutputError):
        write_table(tmp_path / "some.parquet", COLUMNS, overwrite=False)
    assert (tmp_path / "some.parquet").read_text() == "mine"
