"""What is measured around a ship is one field and one source of it."""

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmgtune.physics.quantities import HELD, UNKNOWN, Surroundings
from mmgtune.predictor import cases_from
from mmgtune.trial import windows
from mmgtune.trial.around.current import layer_shares
from mmgtune.trial.around.surroundings import SOURCES, measured_around, surroundings
from tests.trial.made import made

ROOT = Path(__file__).parents[2]

FIELD = ("physics/quantities.py", "    wind_known: Lanes", "    stream_east: Lanes\n    wind_known: Lanes")
SOURCE = (
    "trial/around/surroundings.py",
    "measured_waves(trial),\n",
    """measured_waves(trial),
    ("stream_east",): lambda trial, _: trial.extra.get("stream", 0.0 * trial.t)[:, None],
""",
)

STREAM = """
from dataclasses import replace
from typing import NamedTuple
import numpy as np
from mmgtune.backends import Integrator
from mmgtune.effects import FlowEffect, Parameter
from mmgtune.model import Model
from mmgtune.physics.frame import to_ship
from mmgtune.profile import Coefficient, Section, load_profile
from mmgtune.motions import simulate_trials
from mmgtune.trial import load_trials

class Stream(NamedTuple):
    share: object

def stream(state, around, e):
    return to_ship(state.psi, 0.0 * state.psi, e.share * around.stream_east)

EFFECT = FlowEffect(kind="effects.stream", tag="stream", title="measured stream", params=Stream, function=stream,
                    cites=(), fields={"share": Parameter("share of the measured stream", "-")}, variants=(("share",),))

if __name__ == "__main__":
    import stream as module
    ship = load_profile("suzaku")
    sections = {**ship.sections, "effects.stream": Section(module.EFFECT, {"share": Coefficient(1.0, "-")}, "-")}
    model = Model(replace(ship, sections=sections))
    trial = load_trials("suzaku").trials["turn_p35"]
    flowing = replace(trial, extra={"stream": 0.5 + 0.1 * np.sin(trial.t / 30.0)})
    rk4 = Integrator("rk4")
    a, b = (simulate_trials(model, [flowing], integrator=rk4, backend=name)[0].states for name in ("compiled", "numpy"))
    assert np.allclose(a, b, rtol=1e-9, atol=1e-9), "back ends differ"
    still = simulate_trials(model, [trial], integrator=rk4)[0].states
    drifted = (a - still)[-1, 1]
    assert drifted > 0.3 * trial.duration, drifted
    print("drifts")
"""


def measured_of(found):
    return np.delete(found, Surroundings._fields.index("elapsed"), axis=1)


def test_each_field_has_one_source():
    """In some order, none twice and none left out; nothing measured is 0 throughout, but for the time."""
    assert sorted(name for names in SOURCES for name in names) == sorted(Surroundings._fields)
    assert (measured_of(surroundings(made(), None)) == 0.0).all()
    assert set(UNKNOWN) == {0.0}
    assert {name for name in Surroundings._fields if name.endswith(("known", "rate"))} == set(HELD)


@pytest.mark.long
def test_another_is_one_field_and_one_source(tmp_path):
    """In a copy of the program with these two edits: both back ends give it to an effect, step by step."""
    shutil.copytree(ROOT / "mmgtune", tmp_path / "mmgtune", ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("ship_profiles", "trials"):
        (tmp_path / name).symlink_to(ROOT / name)
    for path, old, new in (FIELD, SOURCE):
        file = tmp_path / "mmgtune" / path
        text = file.read_text(encoding="utf-8")
        assert text.count(old) == 1
        file.write_text(text.replace(old, new), encoding="utf-8")
    (tmp_path / "stream.py").write_text(STREAM, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    ran = subprocess.run(
        [sys.executable, "stream.py"], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.strip() == "drifts"


def test_wind_of_a_trial_is_in_its_surroundings():
    trial = made()
    blown = {"wind_speed": np.full(trial.n_samples, 8.0), "wind_dir": np.full(trial.n_samples, np.pi)}
    found = surroundings(replace(trial, extra=blown), None)
    assert found[:, Surroundings._fields.index("wind_north")] == pytest.approx(8.0)
    assert (found[:, Surroundings._fields.index("wind_known")] == 1.0).all()


def column(found, name):
    return found[:, Surroundings._fields.index(name)]


def test_a_current_sets_towards_and_waves_come_from():
    trial = made()
    n = trial.n_samples
    east = np.full(n, np.pi / 2.0)
    both = {"current_speed": np.full(n, 0.8), "current_dir": east, "wave_height": np.full(n, 1.5), "wave_dir": east}
    found = surroundings(replace(trial, extra=both), None)
    assert column(found, "current_north") == pytest.approx(0.0, abs=1e-15)
    assert column(found, "current_east") == pytest.approx(0.8)
    assert column(found, "wave_east") == pytest.approx(1.5)
    assert measured_around(replace(trial, extra=both)) == {"current", "wave"}
    assert measured_around(trial) == frozenset()


def test_the_rate_of_a_current_is_its_slope_over_the_step_that_ends_there():
    trial = made(samples=50)
    t = trial.t
    tide = {"current_speed": 0.3 + 0.01 * t**2, "current_dir": np.zeros(50)}
    found = surroundings(replace(trial, extra=tide), None)
    assert column(found, "current_north_rate")[1:] == pytest.approx(np.diff(0.01 * t**2))
    assert (column(found, "current_east_rate") == 0.0).all()


def test_time_of_a_window_is_that_of_its_run():
    trial = made(samples=50)
    first, second, *_ = windows(replace(trial, t=trial.t + 3.0), 20.0)
    assert column(surroundings(first, None), "elapsed") == pytest.approx(3.0 + first.t)
    assert column(surroundings(second, None), "elapsed") == pytest.approx(23.0 + second.t)
    again = windows(second, 10.0)[1]
    assert column(surroundings(again, None), "elapsed")[0] == pytest.approx(33.0)


def test_gaps_are_bridged_and_half_a_current_is_none():
    trial = made(samples=50)
    speed = np.where((trial.t > 10.0) & (trial.t < 20.0), np.nan, 0.01 * trial.t)
    holey = replace(trial, extra={"current_speed": speed, "current_dir": np.zeros(50)})
    assert column(surroundings(holey, None), "current_north") == pytest.approx(0.01 * trial.t)
    half = replace(trial, extra={"current_speed": speed})
    assert (measured_of(surroundings(half, None)) == 0.0).all()
    never = replace(trial, extra={"depth": np.full(50, np.nan)})
    assert measured_around(never) == frozenset()
    echo = np.where(trial.t == 7.0, 0.0, 12.0)
    assert (column(surroundings(replace(trial, extra={"depth": echo}), None), "depth") == 12.0).all()


def layered(speeds):
    trial = made(samples=30)
    extra = {}
    for z, speed in speeds.items():
        extra |= {f"current_speed_at_{z}m": np.full(30, speed), f"current_dir_at_{z}m": np.zeros(30)}
    return replace(trial, extra=extra)


@pytest.mark.parametrize(
    ("speeds", "draught", "mean"),
    [
        ({"0": 1.0, "4": 0.0}, 4.0, 0.5),
        ({"0": 1.0, "4": 0.0}, 2.0, 0.75),
        ({"0": 1.0, "4": 0.0}, 8.0, 0.25),
        ({"1": 1.0, "3": 0.0}, 4.0, 0.5),
        ({"10": 0.2, "2": 0.6, "0.5": 0.9}, 0.4, 0.9),
        ({"10": 0.2, "2": 0.6, "0.5": 0.9}, 2.0, (0.5 * 0.9 + 1.5 * 0.75) / 2.0),
        ({"0": 1.0, "4": 0.0}, None, 0.5),
        ({"0": 1.0}, None, 1.0),
        ({"5": 0.7}, 3.0, 0.7),
    ],
)
def test_a_current_in_layers_counts_with_its_mean_over_the_draught(speeds, draught, mean):
    """Linear between layers, held above the first and below the last; to the deepest where nobody knows the draught."""
    found = surroundings(layered(speeds), draught)
    assert column(found, "current_north") == pytest.approx(mean)
    assert (column(found, "current_known") == 1.0).all()


@pytest.mark.parametrize("draught", [0.7, 3.0, 9.0, 40.0])
def test_shares_of_layers_are_those_of_the_integral(draught):
    z, rng = np.array([0.5, 1.0, 2.5, 6.0, 15.0]), np.random.default_rng(3)
    speeds = rng.uniform(-1.0, 1.0, 5)
    shares = layer_shares(z, draught)
    fine = (np.arange(200_000) + 0.5) / 200_000 * draught
    assert shares.sum() == pytest.approx(1.0)
    assert shares @ speeds == pytest.approx(np.interp(fine, z, speeds).mean(), abs=1e-8)


def test_a_current_of_the_whole_draught_counts_before_its_layers():
    one = layered({"0": 1.0, "4": 0.0})
    whole = {"current_speed": np.full(30, 0.3), "current_dir": np.zeros(30)}
    found = surroundings(replace(one, extra={**one.extra, **whole}), 4.0)
    assert column(found, "current_north") == pytest.approx(0.3)


def test_the_draught_of_the_profile_is_what_counts(suzaku):
    """Through the whole way from a trial to the cases of a model."""
    trial = layered({"0": 1.0, "7.6": 0.0})
    cases = cases_from([trial], suzaku.inputs, suzaku.draught)
    assert suzaku.draught == 3.8
    assert cases.around[0, :, Surroundings._fields.index("current_north")] == pytest.approx(0.75)
