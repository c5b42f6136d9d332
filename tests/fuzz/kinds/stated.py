"""Files of stated indices: values, tables and bytes that do not belong; read, checked and inspected."""

from __future__ import annotations

import functools
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.trial import load_trials
from tests.command import typed

from ..trees import hostile_toml
from . import Files, Kind

TEXT = """schema = 1

[[trial]]
id = "turn_35"
ship = "kvlcc2"
manoeuvre = "turning"
order = "35 deg to port"
approach_speed = "15.5 kn"
n = "1.778 1/s"
source = "measured"
[trial.indices]
advance = { value = "3.01 L", tolerance = "0.1 L" }
tactical_diameter = { value = "1050 m", tolerance = "30 m" }

[[trial]]
id = "zz_20"
manoeuvre = "zigzag"
order = "20/20 deg"
[trial.indices]
overshoot_1 = { value = "8.5 deg", tolerance = "1 deg" }
overshoot_2 = "12 deg"
"""


@functools.cache
def tree() -> dict[str, Any]:
    """The same, read."""
    return tomllib.loads(TEXT)


def make(rng: np.random.Generator) -> Files:
    """A sea-trial report with something wrong in its values, lines or bytes."""
    return {"report.toml": hostile_toml(rng, TEXT, tree())}


def run(folder: Path) -> str:
    """Check it, show it, and read it as trials."""
    file = folder / "report.toml"
    for arguments in (("trials", "check", file), ("trials", "inspect", file), ("trials", "inspect", folder)):
        ended = typed(*arguments)
        assert ended.code in (0, 1, 2), ended.err
        assert not any(one in ended.out + ended.err for one in "\x1b\x07\r\u202e")
    return f"{len(load_trials(file).stated)} trials"


KIND = Kind("stated", make, run)
