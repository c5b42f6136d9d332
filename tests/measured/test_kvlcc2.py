"""What docs/kvlcc2.md says of the measured runs of MARIN and HSVA, where they are at hand."""

import os
from pathlib import Path

import pytest

from tests.command import run

DATA = Path(os.environ.get("MMGTUNE_DATA", Path(__file__).parents[2].parent / "shared" / "data"))

SETS = {
    "marin": ("kvlcc2-marin", "1 s", "300", {"kvlcc2": 0.079, "kvlcc2_tuned": 0.0100}),
    "hsva": ("kvlcc2-hsva", "0.25 s", "45", {"kvlcc2_l7": 0.749, "kvlcc2_l7_hsva_tuned": 0.134}),
}


@pytest.mark.parametrize("name", SETS)
def test_scores_before_and_after_tuning(name, tmp_path):
    folder, step, window, published = SETS[name]
    logs = sorted((DATA / folder).glob("*.dat"))
    if not logs:
        pytest.skip(f"no measured data at {DATA / folder}; MMGTUNE_DATA names their folder")
    imported = run("trials", "import", *logs, "--preset", f"simman-{name}", "--step", step, "-o", name, cwd=tmp_path)
    assert imported.code == 0, imported.err
    ended = run("validate", *published, name, "--window", window, "--json", cwd=tmp_path)
    assert ended.code == 0, ended.err
    for one in ended.json()["profiles"]:
        assert one["L_MSE"] == pytest.approx(published[one["profile"]], rel=0.01)
