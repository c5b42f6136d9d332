"""``pytest --mmgtune check.toml`` in a project of a user."""

import os
import subprocess
import sys

import pytest

from mmgtune.checking import write_baseline

CHECK = '[[check]]\nprofile = "ship.toml"\ntrials = "trials"\nbaseline = "check.json"\n'


@pytest.fixture
def project(folder, baseline):
    write_baseline(baseline, folder / "check.json")
    (folder / "check.toml").write_text(CHECK, encoding="utf-8")
    (folder / "test_own.py").write_text("def test_own(): pass\n", encoding="utf-8")
    return folder


def pytest_in(folder, *arguments):
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *arguments],
        cwd=folder,
        env={**os.environ, "PYTEST_ADDOPTS": ""},
        capture_output=True,
        text=True,
    )


def test_an_item_per_trial_and_metric(project, baseline):
    n = sum(len(trial.metrics) for trial in baseline.trials.values())
    ended = pytest_in(project, "--mmgtune", "check.toml", "-v", "test_own.py")
    assert ended.returncode == 0, ended.stdout
    assert f"{n + 1} passed" in ended.stdout
    assert "check.toml::ship-trials::turn_p35[tactical_diameter] PASSED" in ended.stdout


def test_without_the_option_nothing_is_loaded(project):
    ended = pytest_in(project, "-q")
    assert "1 passed" in ended.stdout
    code = "import sys, mmgtune.pytest_plugin; assert not {'numpy', 'numba'} & set(sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_a_regression_fails_with_its_cause_and_no_traceback(project):
    path = project / "ship.toml"
    path.write_text(path.read_text(encoding="utf-8").replace("N_r = -0.057", "N_r = -0.055"), encoding="utf-8")
    ended = pytest_in(project, "--mmgtune=check.toml", "-k", "turn_p35 and J")
    assert ended.returncode == 1
    assert "1 failed" in ended.stdout
    assert "changed: hull.N_r: -0.057 -> -0.055" in ended.stdout
    assert "Traceback" not in ended.stdout
    assert "pytest_plugin.py" not in ended.stdout


@pytest.mark.long
def test_a_trial_that_is_gone_fails(project):
    next((project / "trials").glob("zigzag_20*")).unlink()
    ended = pytest_in(project, "--mmgtune", "check.toml")
    assert ended.returncode == 1
    assert "the baseline has it, the trials do not" in ended.stdout


@pytest.mark.daily("not valid TOML", "no [[check", "is missing")
@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("[[check", "not valid TOML"),
        ("a = 1", "no [[check]]"),
        ('[[check]]\nprofile = "ship.toml"', "'trials' is missing"),
        (CHECK + 'base = "x"', "unknown key 'base'"),
        (CHECK + "backend = 3", "'backend' is 3, not text"),
        (CHECK.replace('"ship.toml"', "3"), "'profile' is 3, not text"),
        pytest.param(CHECK.replace('"ship.toml"', "0x" + 5000 * "f"), "digits, not text", id="number of many digits"),
        (CHECK.replace('"ship.toml"', '"a\\u0000b"'), "no such ship profile"),
        (CHECK + 'metrics = "rms_psi"', "'metrics' is 'rms_psi', not a list of names"),
        (CHECK.replace("ship.toml", "nowhere.toml"), "no such ship profile"),
        (CHECK.replace("check.json", "none.json"), "there is no baseline"),
    ],
)
def test_wrong_files(project, content, said):
    (project / "check.toml").write_text(content, encoding="utf-8")
    ended = pytest_in(project, "--mmgtune", "check.toml")
    assert ended.returncode == 2
    assert said in ended.stdout
    assert "Traceback" not in ended.stdout


def test_no_file(project):
    ended = pytest_in(project, "--mmgtune", "none.toml")
    assert ended.returncode == 4
    assert "there is no file none.toml" in ended.stderr
