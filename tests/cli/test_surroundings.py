"""What commands say of trials that lack what the model acts on: once, and in JSON."""

import json
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.circumstances import extremes, notes
from mmgtune.model import Model
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import load_trials, surroundings, write_trial
from tests.command import run
from tools.generate_voyage import make_voyage

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
    validated = run("validate", "ship.toml", "ship.toml", "trials", cwd=folder)
    assert validated.code == 0, validated.err
    simulated = run("simulate", "-p", "ship.toml", "--trials", "trials", cwd=folder)
    assert simulated.code == 0, simulated.err
    for ended in (validated, simulated):
        assert ended.err.count(f"note: {SAID}\n") == 1
        assert ended.err.count(f"note: {HIGH}\n") == 1
    quiet = run("simulate", "-p", "suzaku", "--trials", "trials", cwd=folder)
    assert "note:" not in quiet.err


@pytest.mark.long
def test_json_has_it_as_a_field(folder):
    validated = run("validate", "ship.toml", "trials", "--backend", "numpy", "--json", cwd=folder)
    (row,) = validated.json()["profiles"]
    assert {SAID, HIGH} <= set(row["notes"])
    assert "note:" not in validated.err
    simulated = run("simulate", "-p", "ship.toml", "-t", "trials", "--backend", "numpy", "--json", cwd=folder)
    assert {SAID, HIGH} <= set(simulated.json()["notes"])


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


@pytest.fixture(scope="module")
def voyages(folder):
    """Two logs of an hour, one of them with a current and waves that get too high."""
    hour = make_voyage(Model(load_profile("suzaku")), 1.1)
    n = hour.n_samples
    high = np.where(hour.t > 3000.0, 4.0, 0.3)
    extra = {"current_speed": np.full(n, 0.3), "current_dir": np.ones(n), "wave_height": high, "wave_dir": np.zeros(n)}
    write_trial(replace(hour, id="a"), folder / "voyages" / "a.parquet")
    write_trial(replace(hour, id="b", extra=extra), folder / "voyages" / "b.parquet")
    return folder / "voyages"


def test_validate_on_voyages_says_it_once_for_each_model(folder, voyages):
    arguments = ("validate", "ship.toml", "suzaku", voyages, "--restart", "300", "--out", "on")
    ended = run(*arguments, cwd=folder)
    assert ended.code == 0, ended.err
    said = "1 of 2 voyages has no measured current: still water there"
    assert ended.err.count(f"note: ship.toml: {said}\n") == 1
    assert ended.err.count(f"note: ship.toml: {HIGH}\n") == 1
    assert "suzaku:" not in ended.err
    acting, other = json.loads((folder / "on" / "voyages.json").read_text())["models"]
    assert acting["notes"] == [said, "1 of 2 voyages has no measured waves: no waves there", HIGH]
    assert other["notes"] == []
    assert f"ship.toml: {said}." in (folder / "on" / "report.html").read_text()


def test_extremes_of_surroundings_say_the_same(suzaku):
    """A few samples of each trial are as good as all of them."""
    rng = np.random.default_rng(3)
    acting = {tag: {"measured": 1.0} for tag in ("wind", "current", "waves", "shallow-water")}
    model = Model(with_effects(suzaku.profile, acting, "as measured"))
    trial = load_trials("suzaku").trials["turn_p35"]
    around = {}
    for k in range(6):
        extra = {
            "wave_height": rng.uniform(0.0, 4.0, trial.n_samples),
            "wave_dir": rng.uniform(-3.0, 3.0, trial.n_samples),
            "depth": rng.uniform(5.0, 60.0, trial.n_samples),
            "wind_speed": rng.uniform(0.0, 9.0, trial.n_samples),
            "wind_dir": rng.uniform(-3.0, 3.0, trial.n_samples),
        }
        kept = {name: values for name, values in extra.items() if rng.random() < 0.7}
        around[f"{k}"] = surroundings(replace(trial, extra=kept), model.draught)
    few = {name: extremes(rows) for name, rows in around.items()}
    assert max(map(len, few.values())) < 25
    assert len(notes(model, around)) > 3
    assert notes(model, few) == notes(model, around)
