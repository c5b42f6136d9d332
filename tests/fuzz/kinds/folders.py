"""Run folders, baselines and what a stopped run left: records that do not hold what they should."""

from __future__ import annotations

import contextlib
import functools
import json
import shutil
import tempfile
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

from tests.command import typed

from ..mutating import mutated_bytes, pick, several
from ..small import trials
from ..trees import as_json, mutated
from . import Files, Kind

FEW = ("--trials", "trials", "--targets", "R_0,w_P0", "--quiet", "--no-report")
RUNS = {
    "fit": ("fit", *FEW, "--method", "least-squares", "--starts", "1"),
    "sweep": ("sweep", *FEW, "--method", "least-squares", "--starts", "1", "--ar", "0.2,0.3"),
    "diagnose": ("diagnose", *FEW, "--effects", "speed-scale"),
    "leave-out": ("leave-out", "--trials", "trials", "--targets", "R_0", "--quiet", "--starts", "1"),
}
IN_FOLDER = "%"
"""Between the names of a folder and of a file in it: files of a case lie side by side."""


def _lay(files: Files, folder: Path) -> None:
    for name, content in files.items():
        path = folder / name.replace(IN_FOLDER, "/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def _collected(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)).replace("/", IN_FOLDER): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@functools.cache
def whole() -> dict[str, dict[str, bytes]]:
    """Folders that runs leave, finished and stopped, and a baseline; times in them taken out."""
    found = {}
    with tempfile.TemporaryDirectory() as name, contextlib.chdir(name):
        _lay({f"trials/{name}": content for name, content in trials().items()}, Path(name))
        for kind, line in RUNS.items():
            assert typed(*line, "--out", kind).code == 0
            found[kind] = {key: _timeless(content) for key, content in _collected(Path(kind)).items()}
            found[f"{kind} stopped"] = _stopped(line)
        assert typed("check", "suzaku", "trials", "-b", "check.json", "--update-baseline").code == 0
        found["check"] = {"check.json": Path("check.json").read_bytes()}
    return found


WRITERS = ("fitting.folder", "fitting.leaving_out", "fitting.sweeping", "diagnose.folder")
"""Modules that clear away, once a result is written, what its run would be continued from."""


def _stopped(line: tuple[str, ...]) -> dict[str, bytes]:
    """The folder of a run in which nothing is finished but what its journal holds."""
    with contextlib.ExitStack() as patched:
        for name in WRITERS:
            patched.enter_context(mock.patch(f"mmgtune.{name}.finished"))
        assert typed(*line, "--out", "stopped").code == 0
    kept = {name: content for name, content in _collected(Path("stopped")).items() if name.endswith(("jsonl", "npz"))}
    assert kept
    shutil.rmtree("stopped")
    return kept


def _timeless(content: bytes) -> bytes:
    try:
        document = json.loads(content)
    except ValueError:
        return content
    _fix(document)
    return as_json(document)


def _fix(document: Any) -> None:
    if isinstance(document, dict):
        for key, value in document.items():
            if key in ("created", "wall_s"):
                document[key] = "2026-01-01T00:00:00+00:00" if key == "created" else 1.0
            else:
                _fix(value)
    elif isinstance(document, list):
        for one in document:
            _fix(one)


def _lines(tree: Any) -> bytes:
    """A journal of sums and entries, whatever was made of them."""
    rows = [one if isinstance(one, list) else [one] for one in (tree if isinstance(tree, list) else [tree])]
    text = (" ".join(part if isinstance(part, str) else json.dumps(part) for part in row).strip() for row in rows)
    return "".join(f"{line}\n" for line in text).encode(errors="surrogateescape")


def make(rng: np.random.Generator) -> Files:
    """A folder with something wrong in one of its files, or with one missing."""
    kind = pick(rng, list(whole()))
    files = dict(whole()[kind])
    name = pick(rng, list(files)) if rng.random() < 0.3 else pick(rng, [one for one in files if "json" in one])
    content = files[name]
    how = rng.random()
    if how < 0.1:
        del files[name]
    elif how < 0.7 and name.endswith(".json"):
        files[name] = as_json(several(rng, json.loads(content), [mutated]))
    elif how < 0.7 and name.endswith(".jsonl"):
        # What lines say is changed and their sums are not, as on a bad disk.
        head, *entries = content.decode().splitlines()
        tree = [["", json.loads(head)], *([line[:16], json.loads(line[17:])] for line in entries)]
        files[name] = _lines(several(rng, tree, [mutated]))
    else:
        files[name] = several(rng, content, [mutated_bytes])
    return {**files, "what": kind.encode()}


def run(folder: Path) -> str:
    """Report on it, check against it, or go on with it."""
    files = {path.name: path.read_bytes() for path in folder.iterdir()}
    kind = files.pop("what").decode()
    out = folder / "out"
    _lay({f"run/{name}": content for name, content in files.items()}, out)
    _lay({f"trials/{name}": content for name, content in trials().items()}, out)
    with contextlib.chdir(out):
        if kind == "check":
            line: tuple[str, ...] = ("check", "suzaku", "trials", "-b", "run/check.json")
        elif kind.endswith("stopped"):
            line = (*RUNS[kind.split()[0]], "--out", "run", "--resume")
        else:
            line = ("report", "run")
        ended = typed(*line)
    assert ended.code in (0, 2) or (ended.code == 1 and kind == "check"), ended.err
    return f"{kind}: exit {ended.code}"


KIND = Kind("folders", make, run, seconds=20.0)
