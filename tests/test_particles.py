"""Particles: drawing, the file, and what is said of a damaged one."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from mmgtune.errors import OptionError, OutputError, ProfileError
from mmgtune.networks import named_ship
from mmgtune.options import PredictOptions
from mmgtune.particles import KEY, Particles, load_particles, save_particles
from mmgtune.predicting import predict
from mmgtune.predictor import Uncertain
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import load_trials, write_trial
from tests.command import run


@pytest.fixture
def particles():
    profile = with_effects(load_profile("suzaku"), {"current": {"north": 0.1}}, "test")
    values = np.random.default_rng(1).normal([[0.017], [0.1]], [[0.001], [0.05]], size=(2, 30))
    return Particles(profile, ("hull.R_0", "effects.current.north"), values, {"trials": ["one"]})


def test_they_are_drawn_once_each_and_the_same_again(particles):
    predictor = particles.predictor(as_logged=True)
    assert isinstance(predictor, Uncertain)
    row = predictor.model.rows["hull.R_0"]
    drawn = predictor.drawn(30, 4).theta[row]
    assert sorted(drawn) == sorted(particles.values[0])
    assert np.array_equal(predictor.drawn(10, 4).theta, predictor.drawn(10, 4).theta)
    assert predictor.drawn(100, 1).n_members == 100
    with pytest.raises(OptionError, match="each step"):
        predictor.drawn(5, 1, "TS1")
    with pytest.raises(OptionError, match="0 particles"):
        predictor.drawn(0, 1)


def test_the_day_of_the_trials_is_not_the_ship(particles):
    assert particles.of_the_day() == ("effects.current.north",)
    alone, logged = (particles.predictor(as_logged=on).drawn(20, 1) for on in (False, True))
    row = alone.model.rows["effects.current.north"]
    assert np.ptp(alone.theta[row]) == 0.0
    assert np.ptp(logged.theta[row]) > 0.0


def test_the_most_probable_day_is_not_the_ship_either(particles):
    """What the trials told of the current is in the profile; orders are foretold in what was there before."""
    from mmgtune.profile import tuned

    name = "effects.current.north"
    likely = replace(particles, profile=tuned(particles.profile, {name: 0.7}, {}, {}))
    ship, logged = likely.predictor(), likely.predictor(as_logged=True)
    row = ship.model.rows[name]
    assert logged.theta[row, 0] == 0.7
    assert ship.theta[row, 0] == particles.profile.value(name)
    assert (ship.drawn(5, 1).theta[row] == particles.profile.value(name)).all()


def test_a_file_gives_back_what_was_written(particles, tmp_path):
    path = save_particles(particles, tmp_path / "particles.parquet")
    found = load_particles(path)
    assert np.array_equal(load_particles(tmp_path).values, found.values)  # the run folder
    assert found.names == particles.names
    assert np.array_equal(found.values, particles.values)
    assert found.facts == particles.facts
    assert found.profile.value("effects.current.north") == 0.1
    with pytest.raises(OutputError):
        save_particles(particles, path)
    assert named_ship(tmp_path).particles.names == named_ship(path).particles.names


def rewritten(path, change):
    """The file with its table changed by a function of table and facts."""
    table = pq.read_table(path)
    facts = json.loads(table.schema.metadata[KEY])
    table, facts = change(table, facts)
    metadata = {KEY: json.dumps(facts).encode()} if facts is not None else {}
    pq.write_table(table.replace_schema_metadata(metadata), path)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda t, f: (t, None), "holds no particles"),
        (lambda t, f: (t, []), "holds no particles"),
        (lambda t, f: (t, {**f, "schema": 99}), "schema 99"),
        (lambda t, f: (t, {**f, "profile": 3}), "damaged"),
        (lambda t, f: (t, {**f, "profile": "nonsense"}), "TOML"),
        (lambda t, f: (t.rename_columns(["hull.R_0", "hull.unheard"]), f), "unheard"),
        (lambda t, f: (t.rename_columns(["hull.R_0", "hull.R_0"]), f), "twice"),
        (lambda t, f: (t.slice(0, 0), f), "finite"),
        (lambda t, f: (t.set_column(0, "hull.R_0", pa.array(["a"] * 30)), f), "finite"),
        (lambda t, f: (t.set_column(0, "hull.R_0", pa.array([np.nan] * 30)), f), "finite"),
        (lambda t, f: (t.set_column(0, "hull.R_0", pa.array([0.01] * 29 + [1e300])), f), "beyond 1e.12"),
    ],
)
def test_a_damaged_file_says_what_is_wrong(particles, tmp_path, change, words):
    path = save_particles(particles, tmp_path / "particles.parquet")
    rewritten(path, change)
    with pytest.raises(ProfileError, match=words) as raised:
        load_particles(path)
    assert all(problem.fix for problem in raised.value.problems)


@pytest.mark.parametrize(
    "change",
    [lambda v: v * np.nan, lambda v: v[:, :0], lambda v: v[:1], lambda v: v * 1e13],
)
def test_what_no_file_could_hold_is_neither_written_nor_predicted_with(particles, tmp_path, change):
    wrong = replace(particles, values=change(particles.values))
    with pytest.raises(OptionError, match=r"particles (that are no finite|of 'effects)"):
        save_particles(wrong, tmp_path / "particles.parquet")
    assert not list(tmp_path.iterdir())
    with pytest.raises(OptionError, match=r"particles (that are no finite|of 'effects)"):
        wrong.predictor()


def test_a_file_that_expands_without_end_is_not_read(particles, tmp_path):
    path = save_particles(replace(particles, values=np.full((2, 3_000_000), 0.01)), tmp_path / "particles.parquet")
    assert path.stat().st_size < 200_000
    with pytest.raises(ProfileError, match="expands far beyond what it can hold"):
        load_particles(path)


def test_reading_and_writing_load_no_pandas(particles, tmp_path):
    save_particles(particles, tmp_path / "particles.parquet")
    asked = (
        "import sys; from pathlib import Path; from mmgtune.particles import load_particles, save_particles;"
        "known = load_particles(Path(sys.argv[1])); save_particles(known, Path(sys.argv[1]), True);"
        "sys.exit('pandas' in sys.modules)"
    )
    subprocess.run([sys.executable, "-c", asked, str(tmp_path / "particles.parquet")], check=True)


@pytest.mark.parametrize("bytes_", [b"", b"PAR1", b"PAR1" + bytes(200) + b"PAR1"])
def test_what_is_no_parquet_says_so(tmp_path, bytes_):
    path = tmp_path / "particles.parquet"
    path.write_bytes(bytes_)
    with pytest.raises(ProfileError, match="cannot be read"):
        load_particles(path)
    found = run("simulate", "-p", "particles.parquet", "--turn", "20", cwd=tmp_path)
    assert found.code == 2
    assert "Traceback" not in found.err


def test_a_fit_leaves_them_beside_its_profile(tmp_path):
    write_trial(load_trials("suzaku").trials["turn_p35"], tmp_path / "one.parquet")
    few = ("--method", "least-squares", "--starts", "1", "--no-report", "--out", "fitted")
    ended = run("fit", "-t", "one.parquet", *few, "--bands", cwd=tmp_path)
    assert ended.code == 0, ended.err
    assert named_ship(tmp_path / "fitted").drawn(7, 1).n_members == 7
    bands = json.loads((tmp_path / "fitted" / "fit.json").read_text())["bands"]
    assert "no revolutions astern" in bands["sentences"][-1]
    assert "turns to starboard alone" in bands["warnings"][0]
    runs = {one["id"]: one for one in bands["predicted"]["runs"]}
    assert [*runs] == ["turn_p35", "turn_m35", "zigzag_p10_10", "zigzag_p20_20"]
    shown, other = (runs[name]["indices"][0]["over_L"] for name in ("turn_p35", "turn_m35"))
    assert other["half_width"] > 2.0 * shown["half_width"] > 0.0  # the side that no trial shows
    text = f"{shown['mean']:.2f} ± {shown['half_width']:.2f} L"
    assert text in ended.out
    assert ended.out.count("turns to starboard alone") == 1
    foretold = predict(tmp_path / "fitted")
    assert foretold.indices()["runs"] == bands["predicted"]["runs"]


@pytest.mark.long
def test_the_command_writes_them_and_others_take_them(tmp_path):
    write_trial(load_trials("suzaku").trials["turn_p35"], tmp_path / "one.parquet")
    ended = run("posterior", "-t", "one.parquet", "--particles", "20", "--out", "bands", "--json", cwd=tmp_path)
    assert ended.code == 0, ended.err
    document = ended.json()
    assert document["particles"] == 20
    assert {one["name"] for one in document["numbers"]} >= {"hull.R_0", "effects.current.north"}
    assert any("nothing could be left out" in one for one in document["sentences"])
    assert run("posterior", "-t", "one.parquet", "--out", "bands", cwd=tmp_path).code == 2
    turned = run("simulate", "-p", "bands", "--turn", "35", "--json", cwd=tmp_path)
    assert turned.code == 0, turned.err
    (row,) = turned.json()["runs"]
    (foretold,) = predict(tmp_path / "bands", options=PredictOptions(turn=("35",))).indices()["runs"]
    assert [*row["bands"].values()] == foretold["indices"]
    band = row["bands"]["advance_m"]
    assert band["low"] < row["indices"]["advance_m"] < band["high"]
    ended = run("simulate", "-p", "bands", "--zigzag", "20/20", cwd=tmp_path)
    assert ended.code == 0, ended.err
    assert re.search(r"1st overshoot +[\d.]+ deg +[\d.]+ ± [\d.]+ deg\n", ended.out)
    assert "band of 90 % of 100 particles" in ended.err
    lengths = run("simulate", "-p", "bands", "--turn", "35", cwd=tmp_path).out
    assert re.search(r" advance +[\d.]+ m +[\d.]+ L +\d+ ± [\d.]+ m, [\d.]+ ± [\d.]+ L\n", lengths)
    steep = run("simulate", "-p", "bands", "--turn", "80", cwd=tmp_path)  # beyond the steering gear
    assert steep.code == 0, steep.err
    assert "±" not in steep.out
    assert "No bands: rudder angle 'delta' is ordered to 80 °" in steep.err
    alone = run("simulate", "--turn", "35", "--json", cwd=tmp_path).json()
    assert "bands" not in alone["runs"][0]


@pytest.mark.long
def test_validate_scores_their_bands_as_compare_does(particles, tmp_path):
    save_particles(particles, tmp_path / "particles.parquet")
    arguments = "particles.parquet", "suzaku", "suzaku", "--restart", "200"
    ended = run("validate", *arguments, "--json", cwd=tmp_path)
    assert ended.code == 0, ended.err
    banded, single = ended.json()["profiles"]
    compared = run("compare", *arguments, "--json", cwd=tmp_path).json()
    windows = compared["models"][0]["windows"]
    assert banded["bands"] == windows[0]["bands"]  # all
    assert banded["by_manoeuvre"]["turning"]["bands"] == windows[1]["bands"]
    assert banded["bands"]["particles"] == 100
    assert 0.0 < banded["bands"]["coverage_90"] < 1.0
    assert "bands" not in single
    assert "bands" not in single["by_manoeuvre"]["turning"]
    shown = run("validate", *arguments[:1], *arguments[2:], cwd=tmp_path).out
    held = f"{100.0 * banded['bands']['coverage_90']:.0f} %"
    (line,) = [line for line in shown.splitlines() if line.startswith("  all ")]
    assert line.split()[-3:-1] == held.split()
    assert "90 % holds" in shown
    assert "90 % holds" not in run("validate", "suzaku", "suzaku", cwd=tmp_path).out
