"""A small set of generated trials, and the model that made them changed here and there."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from mmgtune.checking import Baseline, CheckReport, check, record_baseline
from mmgtune.profile import ShipProfile, load_profile, parse_profile
from mmgtune.trial import TrialSet, load_trials


@pytest.fixture(scope="session")
def ship() -> ShipProfile:
    """The bundled profile."""
    return load_profile("suzaku")


@pytest.fixture(scope="session")
def data() -> TrialSet:
    """Three bundled trials: two turns and a zigzag."""
    whole = load_trials("suzaku")
    chosen = {name: whole.trials[name] for name in ("turn_p35", "turn_m20", "zigzag_20")}
    return replace(whole, trials=chosen, tune=tuple(chosen), test=())


@pytest.fixture(scope="session")
def baseline(ship: ShipProfile, data: TrialSet) -> Baseline:
    """What the bundled profile does on them."""
    return record_baseline(ship, data)


@pytest.fixture(scope="session")
def changed(ship: ShipProfile) -> Callable[..., ShipProfile]:
    """The profile with some coefficients written anew."""

    def change(**values: float | str) -> ShipProfile:
        text = ship.text
        for name, value in values.items():
            text, n = re.subn(rf"(?m)^{name} = .*$", f"{name} = {value}", text)
            assert n == 1, name
        return parse_profile(text, ship.path)

    return change


@pytest.fixture(scope="session")
def worse(changed: Callable[..., ShipProfile], data: TrialSet, baseline: Baseline) -> CheckReport:
    """A report of a model that turns worse."""
    return check(changed(N_r=-0.055, Y_v=-0.33), data, baseline, names=("ship.toml", "trials", "check.json"))


@pytest.fixture
def folder(tmp_path: Path, ship: ShipProfile, data: TrialSet) -> Path:
    """A repository with a profile and trials."""
    (tmp_path / "ship.toml").write_text(ship.text, encoding="utf-8")
    (tmp_path / "trials").mkdir()
    for trial in data.trials.values():
        assert trial.path is not None
        (tmp_path / "trials" / trial.path.name).write_bytes(trial.path.read_bytes())
    return tmp_path
