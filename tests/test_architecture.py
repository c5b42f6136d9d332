"""What pyproject.toml says of layers and libraries holds, and the gates that watch it notice what breaks it."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tomllib
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parent.parent
LINT = "import sys; from importlinter.cli import lint_imports_command; sys.exit(lint_imports_command())"


def lint(folder: Path) -> tuple[int, str]:
    """Exit code and words of import-linter in a folder."""
    ended = subprocess.run(
        [sys.executable, "-P", "-c", LINT, "--no-logo", "--no-cache"],
        cwd=folder,
        capture_output=True,
        text=True,
        env={"COLUMNS": "200", "PYTHONDONTWRITEBYTECODE": "1"},
    )
    return ended.returncode, ended.stdout + ended.stderr


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """The package and its contracts, free to be spoilt."""
    shutil.copytree(ROOT / "mmgtune", tmp_path / "mmgtune", ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "tools").mkdir()
    for name in ("pyproject.toml", "tools/contracts.py"):
        shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def test_the_contracts_are_kept():
    code, said = lint(ROOT)
    assert code == 0, said


@pytest.mark.daily("mmgtune.model is", "import numpy", "astrology", "bench")
@pytest.mark.parametrize(
    ("module", "line", "wanted"),
    [
        ("physics/mmg.py", "import scipy.linalg", "mmgtune.physics.mmg imports scipy (l.1)"),
        ("effects/wind.py", "import pandas as pd", "mmgtune.effects.wind imports pandas (l.1)"),
        ("errors.py", "import numpy", "mmgtune.errors imports numpy (l.1)"),
        ("fitting/run.py", "from torch import nn", "mmgtune.fitting.run imports torch (l.1)"),
        ("report/load.py", "def late():\n    import typer", "mmgtune.report.load imports typer (l.2)"),
        (
            "diagnose/bench/runs.py",
            "from ..searching import search",
            "mmgtune.diagnose.bench is not allowed to import mmgtune.diagnose.searching",
        ),
        ("model.py", "from .fitting import box", "mmgtune.model is not allowed to import mmgtune.fitting"),
        ("physics/wind.py", "from .. import errors", "mmgtune.physics is not allowed to import mmgtune.errors"),
        ("fitting/box.py", "from mmgtune import load_profile", "mmgtune.fitting.box -> mmgtune (l.1)"),
        ("astrology.py", "", "mmgtune.astrology"),
    ],
)
def test_a_breach_is_noticed(copy, module, line, wanted):
    path = copy / "mmgtune" / module
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    path.write_text(f"{line}\n{text.replace('from __future__ import annotations', '')}", encoding="utf-8")
    code, said = lint(copy)
    assert code == 1, said
    assert wanted in said


def test_a_permission_that_nothing_uses_is_noticed(copy):
    path = copy / "pyproject.toml"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace('physics = ["numpy"]', 'physics = ["numpy", "sympy"]'), encoding="utf-8")
    code, said = lint(copy)
    assert code == 1, said
    assert "'physics' is allowed sympy, which nothing in it imports" in said


def test_constraints_are_complete_and_allowed():
    """Every distribution that the program, its tests and its documents need is pinned, to a release in its range."""
    pinned = {
        canonicalize_name(one.name): one
        for one in map(
            Requirement,
            (line for line in (ROOT / "constraints.txt").read_text("utf-8").splitlines() if not line.startswith("#")),
        )
    }
    for name, one in pinned.items():
        assert [exact.operator for exact in one.specifier] == ["=="], name
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    open_ends = [
        Requirement(line)
        for line in (
            *project["dependencies"],
            *(one for extra in ("dev", "docs", "learn", "cluster") for one in extras[extra]),
        )
    ]
    done: set[str] = set()
    while open_ends:
        wanted = open_ends.pop()
        name = canonicalize_name(wanted.name)
        if name == "mmgtune":
            continue
        assert name in pinned, f"{wanted} is not pinned: make constraints"
        (exact,) = pinned[name].specifier
        assert wanted.specifier.contains(exact.version), f"{pinned[name]} is not {wanted}: make constraints"
        if str(wanted) not in done:
            done.add(str(wanted))
            with suppress(PackageNotFoundError):  # an extra that is not installed here
                open_ends += needed(name, wanted.extras)
    if sys.version_info[:2] != (3, 11) or sys.platform != "linux":
        return  # other releases of Python need a little less
    stale = set(pinned) - {canonicalize_name(Requirement(one).name) for one in done}
    assert not stale, "nothing needs these any more: make constraints"


def needed(name: str, extras: set[str]) -> list[Requirement]:
    """What an installed distribution needs here."""
    wanted = map(Requirement, requires(name) or ())
    asked = [{"extra": extra} for extra in ("", *extras)]
    return [one for one in wanted if one.marker is None or any(map(one.marker.evaluate, asked))]
