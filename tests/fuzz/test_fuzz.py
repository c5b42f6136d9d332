"""A few cases of every kind, the same each time, and all that once failed."""

from __future__ import annotations

from pathlib import Path

import pytest

from .kinds import kinds
from .running import campaign, files_of, run_folder

CORPUS = Path(__file__).parent / "corpus"
KINDS = kinds()
SECONDS = 7.0
"""For all kinds together."""


@pytest.mark.parametrize("name", KINDS)
def test_hostile_inputs(name: str) -> None:
    found = campaign(KINDS[name], 60, seed=20, seconds=SECONDS / len(KINDS))
    assert not found.failures, {number: outcome.said[-500:] for number, outcome in found.failures.items()}
    assert found.ends.total() > 0


@pytest.mark.parametrize("case", sorted(CORPUS.glob("*/*")), ids=lambda case: f"{case.parent.name}-{case.name}")
def test_what_once_failed(case: Path, tmp_path: Path) -> None:
    for file in case.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    outcome = run_folder(KINDS[case.parent.name], tmp_path)
    assert not outcome.failed, outcome.said


@pytest.mark.long
def test_cases_can_be_made_again() -> None:
    for kind in KINDS.values():
        assert dict(files_of(kind, 1, 7)) == dict(files_of(kind, 1, 7)), kind.name
