"""Files of particulars: values, tables and bytes that do not belong; made into profiles of both forms."""

from __future__ import annotations

import functools
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.errors import MmgtuneError
from mmgtune.estimating import estimate, read_particulars
from mmgtune.options import EstimateOptions
from mmgtune.profile.reading import parse_profile
from mmgtune.resources import particulars

from ..trees import hostile_toml
from . import Files, Kind

SETS = (
    EstimateOptions(),
    EstimateOptions(form="fam"),
    EstimateOptions(form="fam", derivatives="kijima", added_mass="clarke", holtrop="1982"),
    EstimateOptions(form="fam", derivatives="clarke"),
)


@functools.cache
def texts() -> tuple[str, ...]:
    """The bundled files."""
    return tuple(path.read_text(encoding="utf-8") for path in sorted(particulars().glob("*.toml")))


@functools.cache
def trees() -> tuple[dict[str, Any], ...]:
    """The same, read."""
    return tuple(map(tomllib.loads, texts()))


def make(rng: np.random.Generator) -> Files:
    """Particulars with something wrong in their values, lines or bytes."""
    number = int(rng.integers(len(texts())))
    return {"ship.toml": hostile_toml(rng, texts()[number], trees()[number])}


def run(folder: Path) -> str:
    """Read them and make profiles by every set of formulas; what is made must be a profile."""
    ship = read_particulars(folder / "ship.toml")
    made = 0
    for options in SETS:
        try:
            profile = estimate(ship, options)
        except MmgtuneError:
            continue
        assert parse_profile(profile.text) == profile
        made += 1
    return f"{made} profiles"


KIND = Kind("particulars", make, run)
