"""The wheel: what travels with it, and that it works from any folder."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.xdist_group("wheel")

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    built = subprocess.run(
        [sys.executable, "-m", "pip", "wheel", "--no-deps", "--quiet", "-w", folder, ROOT],
        capture_output=True,
        text=True,
    )
    if built.returncode:
        pytest.skip(f"no wheel could be built here: {built.stderr.strip().splitlines()[-1]}")
    (path,) = folder.glob("*.whl")
    return path


def test_profiles_and_trials_travel_along(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    for wanted in (
        "ship_profiles/suzaku.toml",
        "ship_profiles/kvlcc2.toml",
        "trials/suzaku/split.toml",
        "trials/suzaku/turn_p35.parquet",
    ):
        assert f"mmgtune/data/{wanted}" in names
    assert any(name.startswith("mmgtune/report/templates/") for name in names)
    assert not any(name.startswith(("tests/", "tools/")) for name in names)


def test_it_runs_from_another_folder(wheel, tmp_path):
    (tmp_path / "lib").mkdir()
    zipfile.ZipFile(wheel).extractall(tmp_path / "lib")
    (tmp_path / "elsewhere").mkdir()
    code = "import mmgtune; print(mmgtune.__file__); from mmgtune.cli import main; main()"
    ended = subprocess.run(
        [sys.executable, "-P", "-c", code, "trials", "check", "suzaku"],
        cwd=tmp_path / "elsewhere",
        env={**os.environ, "PYTHONPATH": str(tmp_path / "lib")},
        capture_output=True,
        text=True,
    )
    assert str(tmp_path / "lib") in ended.stdout
    assert "10 trials can be used" in ended.stdout, ended.stderr
    assert ended.returncode == 0
