"""``mmgtune doctor`` and ``mmgtune cite``."""

import pytest

from mmgtune.profile import load_profile
from mmgtune.resources import profile_names
from tests.command import run

pytestmark = pytest.mark.slow(1)


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


def test_no_folder_for_kernels_is_told(tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    ended = run("doctor", cwd=tmp_path, env={"MMGTUNE_CACHE": str(tmp_path / "file")})
    assert "every run compiles anew" in ended.out


@pytest.mark.parametrize("name", profile_names())
def test_every_paper_of_a_profile_is_cited(name, tmp_path):
    document = run("cite", name, "--json", cwd=tmp_path).json()
    told = {paper for row in document["components"] for paper in row["papers"]}
    assert told == set(load_profile(name).cites())
    assert told


def test_cite_in_words(tmp_path):
    ended = run("cite", "esso_osaka_3m", cwd=tmp_path)
    assert "Yoshimura, Nakao & Ishibashi 2009" in ended.out
    assert "Wakita et al. 2022" in ended.out
    assert run("cite", "nothing", cwd=tmp_path).code == 2
