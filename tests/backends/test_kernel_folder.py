"""Kernels that are kept: what is broken is made anew, and what others could have written is not run."""

import os
import pickle  # noqa: TID251 - what an attacker would write
import shutil
import stat
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

from mmgtune.backends import kernel_folder
from mmgtune.backends.kernel_folder import KernelFolderWarning, distrusted, wanted_folder
from tests.backends.kernels import LOAD

CODE = (
    LOAD
    + """
with install_recorder("numba:compile") as recorded:
    kernel(x)
assert x.tolist() == [2.0, 2.0, 2.0]
print(len(recorded.buffer) > 0)
"""
)


def compiles(cache, **surroundings):
    """Whether a process that needs a kernel compiles it; None where it fails."""
    env = {**os.environ, "MMGTUNE_CACHE": str(cache), **surroundings}
    ended = subprocess.run([sys.executable, "-c", CODE], env=env, capture_output=True, text=True)
    assert "Traceback" not in ended.stderr, ended.stderr
    return ended.stdout.strip() == "True"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    cache = tmp_path_factory.mktemp("cache")
    assert compiles(cache)
    assert not compiles(cache)
    return cache


@pytest.fixture
def cache(made, tmp_path):
    """A folder with one kernel in it."""
    return Path(shutil.copytree(made, tmp_path / "cache"))


@pytest.mark.long
def test_what_is_broken_is_made_anew(cache):
    def cut(pattern, keep):
        (path,) = (cache / "kernels").rglob(pattern)
        path.write_bytes(path.read_bytes()[:keep])

    for pattern, keep in (("*.nbi", 0), ("*.nbi", 40), ("*.nbc", 0), ("*.nbc", 3000), ("*.sums", 20)):
        cut(pattern, keep)
        assert compiles(cache), pattern
    assert not compiles(cache)
    cut("*.py", 30)
    compiles(cache)
    assert not compiles(cache)


def test_an_index_that_was_planted_is_not_read(cache, tmp_path):
    """It is a pickle, which runs what it says."""

    class Planted:
        def __reduce__(self):
            return Path.touch, (tmp_path / "planted",)

    (index,) = (cache / "kernels").rglob("*.nbi")
    index.unlink()
    index.write_bytes(pickle.dumps(Planted()))
    assert compiles(cache)
    assert not (tmp_path / "planted").exists()


def test_byte_code_that_was_planted_is_not_run(cache, tmp_path):
    import importlib.util
    import marshal

    (text,) = (cache / "kernels").glob("*.py")
    code = compile(f"open({str(tmp_path / 'planted')!r}, 'w'); raise SystemExit(3)", str(text), "exec")
    found = text.stat()
    head = importlib.util.MAGIC_NUMBER + bytes(4)
    head += int(found.st_mtime).to_bytes(4, "little") + found.st_size.to_bytes(4, "little")
    path = Path(importlib.util.cache_from_source(str(text)))
    path.write_bytes(head + marshal.dumps(code))
    compiles(cache)
    assert not (tmp_path / "planted").exists()


def test_kernels_stay_in_their_folder(tmp_path):
    """Wherever functions of others are kept: what lies there is not looked at here."""
    compiles(tmp_path / "own", NUMBA_CACHE_DIR=str(tmp_path / "numba"))
    assert list((tmp_path / "own").rglob("*.nbi"))
    assert not list((tmp_path / "numba").rglob("*.nbi"))


@pytest.fixture
def own(tmp_path, monkeypatch):
    monkeypatch.setenv("MMGTUNE_CACHE", str(tmp_path / "cache"))
    return wanted_folder()


def test_a_new_folder_is_the_users_alone(own):
    with warnings.catch_warnings():
        assert kernel_folder.kernel_folder() == own
    assert stat.S_IMODE(own.stat().st_mode) == 0o700


@pytest.mark.parametrize("mode", [0o770, 0o757])
def test_a_folder_that_others_may_write_to_is_not_used(own, mode):
    own.mkdir(parents=True)
    own.chmod(mode)
    with pytest.warns(KernelFolderWarning, match="others may write"):
        assert kernel_folder.kernel_folder() != own
    with pytest.warns(KernelFolderWarning):
        assert stat.S_IMODE(kernel_folder.kernel_folder().stat().st_mode) == 0o700


def test_a_folder_of_another_user_is_not_used(own, monkeypatch):
    own.mkdir(parents=True)
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    with pytest.warns(KernelFolderWarning, match="belongs to another user"):
        assert kernel_folder.kernel_folder() != own


def test_a_folder_that_can_be_exchanged_is_not_used(own):
    own.mkdir(parents=True, mode=0o700)
    own.parent.chmod(0o777)
    with pytest.warns(KernelFolderWarning, match="all may write to"):
        assert kernel_folder.kernel_folder() != own


def test_files(tmp_path):
    path = tmp_path / "kept.nbi"
    path.write_bytes(b"")
    path.chmod(0o644)
    assert distrusted(path) == ""
    path.chmod(0o664)
    assert "others may write" in distrusted(path)
    (tmp_path / "link").symlink_to(path)
    assert "no plain file" in distrusted(tmp_path / "link")


def test_an_end_of_a_file_is_no_answer_at_a_prompt(monkeypatch):
    """Click takes it for one, says Aborted and ends with 1, which is an answer of check."""
    from mmgtune import profile
    from tests.command import typed

    def cut(_name):
        raise EOFError("Ran out of input")

    monkeypatch.setattr(profile, "load_profile", cut)
    ended = typed("profile", "validate", "suzaku")
    assert ended.code == 3
    assert "Ran out of input" in ended.err
