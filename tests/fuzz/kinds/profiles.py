"""Ship profiles: values, tables and bytes that do not belong; read, shown, written and simulated."""

from __future__ import annotations

import functools
import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.backends import get_backend, pad
from mmgtune.model import Model
from mmgtune.profile import load_profile
from mmgtune.profile.reading import parse_profile
from mmgtune.resources import folder, profile_names
from tests.command import typed

from ..trees import hostile_toml
from . import Files, Kind

MORE = """
[effects.current]
speed = "0.5 m/s"
direction = "30 deg"

[actuators.delta]
low = "-35 deg"
high = "35 deg"
rate = "3 deg/s"

[limits]
rms_psi = "5 deg"
"""
"""What bundled profiles leave out."""


@functools.cache
def texts() -> tuple[str, ...]:
    """The bundled profiles, and one of them with more in it."""
    found = [(folder("ship_profiles") / f"{name}.toml").read_text(encoding="utf-8") for name in profile_names()]
    plain = next(text for text in found if "[effects." not in text)
    return (*found, plain + MORE)


@functools.cache
def trees() -> tuple[dict[str, Any], ...]:
    """The same, read."""
    return tuple(map(tomllib.loads, texts()))


def make(rng: np.random.Generator) -> Files:
    """A profile with something wrong in its values, lines or bytes."""
    number = int(rng.integers(len(texts())))
    return {"ship.toml": hostile_toml(rng, texts()[number], trees()[number])}


def run(folder: Path) -> str:
    """Read it, show it, write it and sail her for 20 steps."""
    file = folder / "ship.toml"
    for arguments in (("profile", "show", file), ("profile", "show", file, "--json"), ("cite", file)):
        ended = typed(*arguments)
        assert ended.code in (0, 2), ended.err
        assert not any(one in ended.out + ended.err for one in "\x1b\x07\r\u202e")
        assert not any(line.lstrip().startswith("::") for line in (ended.out + ended.err).splitlines())
        if ended.code == 0 and "--json" in arguments:
            json.loads(ended.out)
    ship = load_profile(file)
    assert parse_profile(ship.text).names() == ship.names()
    model = Model(ship)
    t = np.arange(21.0)
    controls = np.column_stack(
        [np.full(21, 1.0 if one.role == "propeller" else 0.2) for one in ship.arrangement.inputs]
    )
    cases = pad([t], [controls], [np.array([0.0, 0.0, 0.0, 5.0, 0.0, 0.0])])
    found = get_backend("numpy").run(model, model.matrix(), cases, keep_states=True)
    return "diverged" if found.diverged.any() else "sailed"


KIND = Kind("profiles", make, run)
