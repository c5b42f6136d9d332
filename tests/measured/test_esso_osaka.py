"""What docs/esso-osaka.md says of the measured runs, where they are at hand: they do not travel with the program."""

import os
from pathlib import Path

import pytest

from tests.command import run

DATA = Path(os.environ.get("MMGTUNE_DATA", Path(__file__).parents[2].parent / "shared" / "data")) / "esso-osaka-frt"

PUBLISHED = {
    "esso_osaka_3m": {"turning": 2.04, "zigzag": 1.98, "random": 0.490, "berthing": 0.199},
    "esso_osaka_3m_tuned": {"turning": 0.098, "zigzag": 0.393, "random": 0.131, "berthing": 0.110},
}


@pytest.mark.long
@pytest.mark.skipif(not DATA.is_dir(), reason=f"no measured data at {DATA}; MMGTUNE_DATA names their folder")
def test_scores_before_and_after_tuning(tmp_path):
    logs = sorted(DATA.glob("*/*.csv"))
    imported = run("trials", "import", *logs, "--preset", "frt-ds-esso", "-o", "esso", cwd=tmp_path)
    assert imported.code == 0, imported.err
    ended = run("validate", *PUBLISHED, "esso", "--restart", "100", "--json", cwd=tmp_path)
    assert ended.code == 0, ended.err
    for one in ended.json()["profiles"]:
        for kind, value in PUBLISHED[one["profile"]].items():
            assert one["by_manoeuvre"][kind]["L_MSE"] == pytest.approx(value, rel=0.01), (one["profile"], kind)
