"""``mmgtune doctor`` and ``mmgtune cite``."""

import re
from pathlib import Path

import pytest

import mmgtune
from mmgtune.profile import load_profile
from mmgtune.resources import profile_names
from tests.command import run


def test_a_good_installation(tmp_path):
    ended = run("doctor", "--json", cwd=tmp_path)
    assert ended.code == 0, ended.out
    document = ended.json()
    assert document["ok"]
    names = {one["name"] for one in document["findings"]}
    assert {"mmgtune", "numpy", "cores", "back end compiled", "back ends", "compile cache", "bundled data"} <= names
    shown = run("doctor", cwd=tmp_path)
    assert shown.out.splitlines()[-1] == "all is well"


def test_what_is_wrong_is_said_with_the_fix(tmp_path):
    ended = run("doctor", cwd=tmp_path, env={"MMGTUNE_DATA": str(tmp_path / "nowhere")})
    assert ended.code == 1
    assert "WRONG  measured data" in ended.out
    assert "fix: " in ended.out


@pytest.mark.long
def test_a_back_end_that_fails(tmp_path):
    (tmp_path / "sitecustomize.py").write_text(
        "import mmgtune.backends.compiled as c\n"
        "def broken(*a, **k): raise RuntimeError('no compiler')\n"
        "c.Compiled.run = broken\n",
        encoding="utf-8",
    )
    ended = run("doctor", cwd=tmp_path, env={"PYTHONPATH": str(tmp_path)})
    assert ended.code == 1
    assert "no compiler" in ended.out
    assert "--backend numpy" in ended.out


@pytest.mark.long
def test_no_folder_for_kernels_is_told(tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    ended = run("doctor", cwd=tmp_path, env={"MMGTUNE_CACHE": str(tmp_path / "file")})
    assert "every run compiles anew" in ended.out


READ = re.compile(r'environ(?:\.get\(|\[)"([A-Z_]+)"')
"""A variable of the environment being read."""


def test_only_variables_that_something_reads_are_reported():
    package, tests = Path(mmgtune.__file__).parent, Path(__file__).parents[1]
    doctor = (package / "doctor.py").read_text(encoding="utf-8")
    others = [path for folder in (package, tests) for path in folder.rglob("*.py") if path.name != "doctor.py"]
    read = {name for path in others for name in READ.findall(path.read_text(encoding="utf-8"))}
    told = set(READ.findall(doctor)) | set(re.findall(r"\b(?:MMGTUNE|NUMBA|OMP|OPENBLAS)_[A-Z_]+\b", doctor))
    assert {"MMGTUNE_CACHE", "MMGTUNE_DATA"} <= told
    assert told <= read


@pytest.mark.parametrize("name", profile_names())
def test_every_paper_of_a_profile_is_cited(name, tmp_path):
    document = run("cite", name, "--json", cwd=tmp_path).json()
    told = {paper for row in document["components"] for paper in row["papers"]}
    assert told == set(load_profile(name).cites())
    assert told


def test_licence_and_citation_of_the_measurements_are_told(tmp_path):
    for command in (("cite",), ("profile", "show")):
        document = run(*command, "esso_osaka_3m_tuned", "--json", cwd=tmp_path).json()
        assert document["licence"] == "CC BY-NC 4.0"
        assert "doi 10.1007/s00773-021-00867-1" in document["citation"]
        words = run(*command, "esso_osaka_3m_tuned", cwd=tmp_path).out
        assert "licence of the data it was tuned to: CC BY-NC 4.0" in words
        assert "doi 10.1007/s00773-021-00867-1" in words
        assert "licence" not in run(*command, "suzaku", cwd=tmp_path).out


def test_cite_in_words(tmp_path):
    ended = run("cite", "esso_osaka_3m", cwd=tmp_path)
    assert "Yoshimura, Nakao & Ishibashi 2009" in ended.out
    assert "Wakita et al. 2022" in ended.out
    assert run("cite", "nothing", cwd=tmp_path).code == 2
