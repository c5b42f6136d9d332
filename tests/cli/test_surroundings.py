"""What commands say of trials that lack what the model acts on: once, and in JSON."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.profile import load_profile
from mmgtune.trial import load_trials, write_trial
from tests.command import run

SAID = "2 of 3 trials have no measured current: still water there"
HIGH = "waves are up to 4 m high, and STAWAVE-1 holds up to 2.05 m for this ship"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Three turns of which one has a current and high waves, and a profile that acts on both."""
    folder = tmp_path_factory.mktemp("surroundings")
    (folder / "trials").mkdir()
    for name in ("turn_p35", "turn_m35", "turn_p20"):
        trial = load_trials("suzaku").trials[name]
        n = trial.n_samples
        extra = {}
        if name == "turn_p35":
            extra = {"current_speed": 0.3, "current_dir": 1.0, "wave_height": 4.0, "wave_dir": 0.0}
        own = replace(trial, extra={key: np.full(n, value) for key, value in extra.items()})
        write_trial(own, folder / "trials" / f"{name}.parquet")
    text = load_profile("suzaku").text + "\n[effects.current]\nmeasured = 1.0\n\n[effects.waves]\nheight = '0 m'\n"
    (folder / "ship.toml").write_text(text, encoding="utf-8")
    return folder


def test_validate_and_simulate_say_it_once(folder):
    validated = run("validate", "ship.toml", "ship.toml", "trials", "--backend", "numpy", cwd=folder)
    assert validated.code == 0, validated.err
    simulated = run("simulate", "-p", "ship.toml", "--trials", "trials", "--backend", "numpy", cwd=folder)
    assert simulated.code == 0, simulated.err
    for ended in (validated, simulated):
        assert ended.err.count(f"note: {SAID}\n") == 1
        assert ended.err.count(f"note: {HIGH}\n") == 1
    quiet = run("simulate", "-p", "suzaku", "--trials", "trials", "--backend", "numpy", cwd=folder)
    assert "note:" not in quiet.err


def test_json_has_it_as_a_field(folder):
    validated = run("validate", "ship.toml", "trials", "--backend", "numpy", "--json", cwd=folder)
    (row,) = validated.json()["profiles"]
    assert {SAID, HIGH} <= set(row["notes"])
    assert "note:" not in validated.err
    simulated = run("simulate", "-p", "ship.toml", "-t", "trials", "--backend", "numpy", "--json", cwd=folder)
    assert {SAID, HIGH} <= set(simulated.json()["notes"])


@pytest.mark.slow(20)
def test_fit_has_it_among_its_warnings(folder):
    ended = run(
        *("fit", "-p", "ship.toml", "-t", "trials", "--targets", "hull.R_0", "--method", "least-squares"),
        *("--starts", "1", "--no-report", "--out", "run", "--json"),
        cwd=folder,
    )
    assert ended.code == 0, ended.err
    warnings = ended.json()["warnings"]
    assert warnings.count(f"{SAID}.") == 1
    assert sum("STAWAVE-1" in warning for warning in warnings) == 1


def test_trials_check_and_inspect_know_the_columns(folder):
    ended = run("trials", "check", "trials", cwd=folder)
    assert ended.code == 0, ended.out
    inspected = run("trials", "inspect", "trials/turn_p35.parquet", cwd=folder)
    assert "current_dir" in inspected.out
    assert "deg" in inspected.out
