"""Hostile inputs that once failed, and a few new ones of the kinds that take little time."""

from pathlib import Path

import pytest

from tests.fuzz.kinds import kinds
from tests.fuzz.running import campaign, run_folder

CORPUS = Path(__file__).parent / "corpus"
CASES = sorted(path for path in CORPUS.glob("*/*") if path.is_dir())

pytestmark = pytest.mark.slow(5)


@pytest.mark.parametrize("case", CASES, ids=lambda path: f"{path.parent.name}-{path.name}")
def test_past_failures(case, tmp_path):
    there = tmp_path / "case"
    there.mkdir()
    for path in case.iterdir():
        (there / path.name).write_bytes(path.read_bytes())
    outcome = run_folder(kinds()[case.parent.name], there)
    assert not outcome.failed, outcome.said


@pytest.mark.parametrize("name", ["profiles", "options"])
def test_a_few(name):
    found = campaign(kinds()[name], 40, seed=7)
    assert not found.failures, next(iter(found.failures.values())).said
