"""Pipes where files belong: nothing waits for a writer that never comes."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest

from mmgtune.errors import ProfileError
from mmgtune.limits import PROFILE_BYTES, content
from tests.command import start

NAMES = ("t.parquet", "log.csv", "map.toml", "net.safetensors", "orders.csv", "base.json", "fleet.toml")


def refused(line: tuple[str, ...], folder: Path) -> str:
    """What a command says that ends with exit code 2, and does not wait for anybody at the other end."""
    process = start(*line, cwd=folder)
    try:
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 2, said
    return said


@pytest.mark.daily("line0", "line5")
@pytest.mark.parametrize(
    "line",
    [
        ("trials", "check", "t.parquet"),
        ("validate", "suzaku", "t.parquet"),
        ("fit", "--trials", ".", "--dry-run"),
        ("trials", "import", "log.csv", "--preset", "nmea-0183", "-o", "out"),
        ("trials", "import", "plain.csv", "--map", "map.toml", "-o", "out"),
        ("trials", "map", "log.csv"),
        ("predict", "net.safetensors", "--turn", "20"),
        ("predict", "t.parquet", "--turn", "20"),
        ("predict", "suzaku", "orders.csv"),
        ("check", "suzaku", "suzaku", "-b", "base.json"),
        ("fleet", "run", "fleet.toml", "--dry-run"),
    ],
)
def test_a_pipe_that_nobody_writes_into(line: tuple[str, ...], tmp_path: Path) -> None:
    for name in NAMES:
        os.mkfifo(tmp_path / name)
    (tmp_path / "plain.csv").write_text("t,x\n0,1\n")
    said = refused(line, tmp_path)
    assert "it is a pipe" in said
    assert "fix: " in said


def test_what_is_written_into_a_pipe_is_read(tmp_path: Path) -> None:
    path = tmp_path / "pipe"
    os.mkfifo(path)
    opened, late = threading.Event(), threading.Event()

    def write() -> None:
        with path.open("wb") as file:
            opened.set()
            late.wait(5.0)
            file.write(b"x" * 500_000)

    kept = os.open(path, os.O_RDONLY | os.O_NONBLOCK)  # the writer can open it
    writer = threading.Thread(target=write)
    writer.start()
    assert opened.wait(30.0)  # else nobody writes, which is refused
    threading.Timer(0.5, late.set).start()
    try:
        assert content(path, PROFILE_BYTES, ProfileError) == b"x" * 500_000
    finally:
        late.set()
        os.close(kept)
        writer.join()


@pytest.mark.parametrize(
    ("line", "name"),
    [
        (("predict", "suzaku", "--turn", "20", "-o", "out", "--force"), "out/report.html"),
        (("profile", "new", "new.toml", "--from", "suzaku", "--force"), "new.toml"),
        (("check", "suzaku", "suzaku", "-b", "base.json", "--junit", "j.xml"), "j.xml"),
    ],
)
def test_nothing_is_written_in_the_place_of_a_pipe(line: tuple[str, ...], name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.parent.mkdir(exist_ok=True)
    (path.parent / "predict.json").write_text("{}")
    os.mkfifo(path)
    said = refused(line, tmp_path)
    assert f"error: the output is not a file ({name})" in said
    assert path.is_fifo()
