"""Command lines: flags at random with values that do not belong, on inputs that are small."""

from __future__ import annotations

import contextlib
import functools
import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import typer

from mmgtune.cli import app
from tests.command import typed

from ..mutating import odd_number, odd_text, pick
from ..small import trials
from . import Files, Kind

LONG = ("fit", "sweep", "diagnose", "leave-out", "posterior")
WORDS = (
    "0.5", "1", "2", "3", "100", "0.2,0.3", "R_0", "R_0,w_P0", "hull.Y_*", "*", "hull.R_0,hull.R_0", "x,y,psi",
    "u:2", "0:20", ":", "5:", "30:10", "nan:nan", "cma-es", "least-squares", "huber", "standardised", "estimated",
    "euler", "rk4", "numpy", "current", "wind-drift", "rudder-offset", "steering-lag", "J,MED", "github", "junit",
    "markdown", "json", "x:-1", "20/20", "-10/10", "35", "-35", "35 deg", "12 kn", "1.7 1/s", "found", "suzaku",
    "kvlcc2", "trials", "esso_osaka_3m", "out.json", ",", "--", "-", "-1", "=", "a=b",
)  # fmt: skip
SUBSTEPS = ("0", "1", "2", "-1", "1001", "1e3", "nan", "9" * 400, "", "2.5")


@functools.cache
def commands() -> dict[tuple[str, ...], list[tuple[str, bool]]]:
    """Flags of each command, each with whether it takes a value."""
    found: dict[tuple[str, ...], list[tuple[str, bool]]] = {}

    def look(command: Any, name: tuple[str, ...]) -> None:
        if hasattr(command, "commands"):
            for key, one in command.commands.items():
                look(one, (*name, key))
        elif name != ("doctor",):
            options = [one for one in command.params if one.param_type_name == "option"]
            found[name] = [(flag, not one.is_flag) for one in options for flag in one.opts]

    look(typer.main.get_command(app), ())
    return found


def _value(rng: np.random.Generator) -> str:
    how = rng.random()
    if how < 0.5:
        return pick(rng, WORDS)
    return odd_number(rng) if how < 0.8 else odd_text(rng)


def make(rng: np.random.Generator) -> Files:
    """A command with some of its flags."""
    trials()  # made outside the limits of a case
    name = pick(rng, list(commands()))
    line = list(name)
    flags = commands()[name]
    if name[0] in ("validate", "check"):
        line += [pick(rng, ("suzaku", "suzaku", "kvlcc2", _value(rng))), pick(rng, ("trials", "trials", _value(rng)))]
    elif name[0] not in (*LONG, "simulate"):
        line += [_value(rng) for _ in range(int(rng.integers(0, 3)))]
    else:
        line += ["--trials", "trials"]
    for _ in range(int(rng.integers(0, 6)) if flags else 0):
        flag, takes = pick(rng, flags)
        if flag in ("--trials", "-t"):
            continue
        line.append(flag)
        if takes:
            line.append(pick(rng, SUBSTEPS) if flag == "--substeps" else _value(rng))
    if ("--dry-run", False) in flags and "--dry-run" not in line:  # what takes long, and what writes
        line += ["--dry-run"]
    if any(flag == "--backend" for flag, _ in flags) and "--backend" not in line:
        line += ["--backend", "numpy"]
    return {"line.json": json.dumps(line).encode()}


def run(folder: Path) -> str:
    """Type it in a folder with small trials; the exit code says that it was understood or refused."""
    out = folder / "out" / "in" / "here"
    (out / "trials").mkdir(parents=True)
    for name, content in trials().items():
        (out / "trials" / name).write_bytes(content)
    line = json.loads((folder / "line.json").read_text())
    before = os.getcwd()
    with contextlib.chdir(out):
        ended = typed(*line)
    assert os.getcwd() == before
    assert ended.code in (0, 1, 2), ended.err
    if ended.code == 1:
        assert line[0] in ("check", "trials"), ended.err
    if ended.code == 0 and "--json" in line and line[0] not in LONG:
        json.loads(ended.out)
    return f"exit {ended.code}"


KIND = Kind("options", make, run)
