"""Damaged and hostile trial files: told from good ones, refused within limits, and never taken for data."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from mmgtune.errors import TrialError
from mmgtune.resources import folder
from mmgtune.trial import check_trial, load_trials, read_trial, write_trial

from .made import made, problems_of, said, with_value, write_raw


@pytest.fixture
def written(tmp_path: Path) -> Path:
    return write_trial(made(samples=120, seed=1, noise={"x": 0.4}), tmp_path / "turn_p20.parquet")


def test_no_bit_turned_over_changes_a_trial(written: Path) -> None:
    whole = written.read_bytes()
    good = read_trial(written)
    rng = np.random.default_rng(5)
    refused = 0
    for at, bit in zip(rng.integers(len(whole), size=400), rng.integers(8, size=400), strict=True):
        content = bytearray(whole)
        content[at] ^= 1 << bit
        written.write_bytes(content)
        try:
            found = read_trial(written)
        except TrialError:
            refused += 1
            continue
        assert list(found.columns) == list(good.columns)
        for name, values in found.columns.items():
            assert values.tobytes() == good.columns[name].tobytes(), (name, at, bit)
        for name in ("id", "ship", "manoeuvre", "source", "noise", "note"):
            assert getattr(found, name) == getattr(good, name), (name, at, bit)
    assert refused > 200


def test_pages_have_checksums(written: Path) -> None:
    content = bytearray(written.read_bytes())
    at = pq.ParquetFile(io.BytesIO(content)).metadata.row_group(0).column(3)
    content[at.data_page_offset + at.total_compressed_size // 2] ^= 1
    written.write_bytes(content)
    (problem,) = problems_of(written)
    assert "the Parquet file is damaged" in problem


def test_a_file_changed_under_its_digest_is_refused(written: Path, tmp_path: Path) -> None:
    table = pq.read_table(written)
    raw = dict(table.schema.metadata)
    assert read_trial(written).sealed
    for other in (
        table.set_column(4, "u", pa.array(np.full(120, 2.0))),
        table.replace_schema_metadata({**raw, b"mmgtune": raw[b"mmgtune"].replace(b"0.4", b"0.5")}),
        table.slice(0, 119),
    ):
        pq.write_table(other, written)
        (problem,) = problems_of(written)
        assert "the trial is not what was written" in problem
        assert "remove that key of the metadata" in problem
    del raw[b"mmgtune.sha256"]
    pq.write_table(table.replace_schema_metadata(raw), written)
    trial = read_trial(written)
    assert not trial.sealed
    assert "the file holds no digest of its data" in said(trial, "note")
    assert "digest" not in said(read_trial(write_trial(trial, tmp_path / "again.parquet")), "note")


def test_bundled_trials_hold_digests() -> None:
    assert all(trial.sealed for trial in load_trials("suzaku").trials.values())
    assert len(list((folder("trials") / "suzaku").glob("*.parquet"))) == 10


@pytest.mark.parametrize(
    ("name", "value"), [("u", 1e300), ("x", -1e12), ("r", 1e5), ("psi", 1e9), ("n", 1e9), ("depth", 1e30)]
)
@pytest.mark.parametrize("row", [0, 1, 250, 499])
def test_numbers_that_nothing_about_a_ship_is(tmp_path: Path, name: str, value: float, row: int) -> None:
    trial = replace(made(), extra={"depth": np.full(500, 30.0)})
    values = np.array(trial.columns[name])
    values[row] = value
    columns = {**trial.columns, name: values}
    (problem,) = problems_of(write_raw(tmp_path / "a.parquet", columns))
    assert f"'{name}' is up to {abs(value):.3g}" in problem
    assert f"column '{name}', row {row}" in problem
    assert "damaged" in problem


def test_expansion_is_refused_and_told_from_damage(tmp_path: Path) -> None:
    path = tmp_path / "bomb.parquet"
    zeros = pa.array(np.zeros(3_000_000))
    chunks = pa.chunked_array([zeros] * 10)
    pq.write_table(pa.table({"t": chunks, "x": chunks}), path, compression="zstd", row_group_size=30_000_000)
    (problem,) = problems_of(path)
    assert "expands far beyond what it can hold" in problem
    assert "the limit for a file of this size is" in problem
    rng = np.random.default_rng(1)
    pq.write_table(pa.table({"t": rng.random(2_000_001)}), path, use_dictionary=False)
    (problem,) = problems_of(path)
    assert "a trial of 2000001 samples: too many" in problem
    assert "the limit is 2000000" in problem


def test_columns_that_nothing_uses_are_not_read(tmp_path: Path) -> None:
    trial = made()
    # 3.2 GB, if each row had its own.
    long = pa.DictionaryArray.from_arrays(np.zeros(500, dtype=np.int32), pa.array(["x" * 6_400_000]))
    path = write_raw(tmp_path / "a.parquet", {**trial.columns, "log": long})
    assert read_trial(path).ignored == ("log",)


@pytest.mark.parametrize(
    ("facts", "expected"),
    [
        (b'{"id": ' + b"9" * 400 + b"}", "'id' is a number of 400 digits, not text"),
        (b'{"schema": ' + b"9" * 400 + b"}", "schema is a number of 400 digits, not 1"),
        (b'{"noise": {"x": ' + b"9" * 400 + b"}}", "noise of 'x' is a number of 400 digits, not a standard deviation"),
        (b'{"noise": {"x": NaN}}', "noise of 'x' is nan"),
        (b'{"note": ' + b"[" * 5000 + b"]" * 5000 + b"}", "the metadata is not a JSON object"),
        (b'{"note": ' + b"[" * 20 + b"]" * 20 + b"}", "'note' is [[[[...]]]], not text"),
        (b'{"note": ' + b"9" * 5000 + b"}", "the metadata is not a JSON object"),
        (b'{"id": "\\ud800"}', "not text"),
        (b'{"id": "' + b"x" * 500 + b'"}', "an id of 500 characters: too many"),
        (b'{"' + b"k" * 5000 + b'": 1}', "unknown key"),
        (b'{"note": "' + b"x" * (1 << 20) + b'"}', "metadata of 1048588 bytes: too many"),
    ],
)
def test_odd_facts(tmp_path: Path, facts: bytes, expected: str) -> None:
    problems = problems_of(write_raw(tmp_path / "a.parquet", made().columns, facts))
    assert len(problems) == 1
    assert expected in problems[0]
    assert len(problems[0]) < 2000


def test_a_mark_of_byte_order_is_no_error(tmp_path: Path) -> None:
    write_raw(tmp_path / "a.parquet", made().columns, b'\xef\xbb\xbf{"id": "a", "source": "measured"}')
    (tmp_path / "split.toml").write_bytes(b'\xef\xbb\xbftune = ["a"]\n')
    assert load_trials(tmp_path).tune == ("a",)


def test_steps_that_no_ship_makes() -> None:
    # The first and the last rows cannot be told for spikes.
    for row in (0, 1, 498, 499):
        warnings = said(with_value(made(), "u", row, 40.0))
        assert "'u' changes by" in warnings
        assert "no ship makes more than 5" in warnings
    assert "'r' changes by 4" in said(with_value(made(), "r", slice(300, None), 4.5))
    assert not check_trial(replace(made(seed=1), path=None))
