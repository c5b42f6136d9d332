"""Folders of fleets that something other than the program wrote in: said with the file, never a wrong number."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.command import run as command

from .conftest import TABLE, make_logs


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a table, its logs and the fleet that was run, which is not to be changed."""
    base = tmp_path_factory.mktemp("fleet")
    make_logs(base, ("a1", "a2", "a3"), ("2025-01",))
    (base / "fleet.toml").write_text(TABLE, encoding="utf-8")
    ended = command("fleet", "run", "fleet.toml", "--out", "out", "--workers", "1", "--no-job-reports", cwd=base)
    assert ended.code == 0, ended.err
    return base


@pytest.fixture
def copied(whole: Path, tmp_path: Path) -> Path:
    """The same, to be changed."""
    shutil.copytree(whole, tmp_path / "copied")
    return tmp_path / "copied"


def refused(base: Path, path: Path) -> str:
    """What is said of a file, with a way out."""
    ended = command("fleet", "report", "out", cwd=base)
    assert ended.code == 2, ended.err
    assert str(path.relative_to(base)) in ended.err
    assert "fix: " in ended.err
    return ended.err


def column(name: str, value: Any) -> Callable[[pa.Table], pa.Table]:
    """A change of a row: another value in a column."""

    def change(table: pa.Table) -> pa.Table:
        k = table.column_names.index(name)
        return table.set_column(k, table.schema.field(k), pa.array([value], table.schema.field(k).type))

    return change


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (column("tuned_heading", float("nan")), "not finite"),
        (column("values", [1.0, float("inf"), 2.0]), "not finite"),
        (column("values", [1.0]), "not as many"),
        (column("names", None), "nothing in names"),
        (column("run", "../../elsewhere"), "outside"),
        (column("answer", "splendid"), "none of good, no, failed"),
        (column("key", "0" * 16), "another job"),
        (lambda table: table.slice(0, 0), "0 rows"),
        (lambda table: pa.concat_tables([table, table]), "2 rows"),
        (lambda table: table.drop(["names"]), "nothing in names"),
    ],
)
def test_a_row_that_is_not_what_was_written(change: Any, why: str, copied: Path) -> None:
    path = next(copied.glob("out/results/ship=a2/*/*.parquet"))
    pq.write_table(change(pq.ParquetFile(path).read()), path)
    assert why in refused(copied, path)


def test_what_is_said_to_be_done_about_a_row_helps(copied: Path) -> None:
    path = next(copied.glob("out/results/ship=a2/*/*.parquet"))
    good = path.read_bytes()
    pq.write_table(pq.ParquetFile(path).read().slice(0, 0), path)
    line = ("fleet", "run", "fleet.toml", "--out", "out", "--resume", "--workers", "1", "--no-job-reports")
    ended = command(*line, cwd=copied)
    assert (ended.code, str(path.relative_to(copied)) in ended.err) == (2, True), ended.err
    path.unlink()
    assert command(*line, cwd=copied).code == 0
    assert pq.read_table(path)["values"] == pq.read_table(pa.BufferReader(good))["values"]


@pytest.mark.parametrize("content", [b"", b"\xff\xfe{", b"[]", b"[" * 5000, b'{"names": 3}', None])
def test_what_trials_say_that_is_not_what_was_written(content: bytes | None, copied: Path) -> None:
    path = next(copied.glob("out/runs/a2/*/*/information.json"))
    document = json.loads(path.read_text(encoding="utf-8"))
    document["H"][0].pop()
    path.write_bytes(json.dumps(document).encode() if content is None else content)
    refused(copied, path)


@pytest.mark.parametrize("text", [10_000 * "[", '{"jobs": [{"key": [1]}]}', '{"jobs": [1]}', "[]"])
@pytest.mark.parametrize("name", ["jobs.json", "fleet.json"])
def test_lists_of_another_form(name: str, text: str, copied: Path) -> None:
    path = copied / "out" / name
    path.write_text(text, encoding="utf-8")
    ended = command("fleet", "report", "out", cwd=copied)
    keys = name == "jobs.json" and "key" in text  # keys of jobs that there are no results of
    assert ended.code == (0 if keys else 2), ended.err


def test_a_row_that_cannot_be_read_is_named(copied: Path) -> None:
    path = next(copied.glob("out/results/ship=a2/*/*.parquet"))
    path.write_bytes(path.read_bytes()[:-20])
    said = refused(copied, path)
    assert "remove that file and run the fleet again with --resume: the job is run anew" in said


def test_a_record_that_is_there_is_not_looked_for(copied: Path) -> None:
    (copied / "out" / "fleet.json").write_text("[]", encoding="utf-8")
    said = refused(copied, copied / "out" / "fleet.json")
    assert "why: it holds no table" in said
    assert "remove that file" in said
