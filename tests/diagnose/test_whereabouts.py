"""Where an error lives: residual forces made by hand, which follow what they are told to."""

import json
import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import ttest_1samp

from mmgtune.diagnose.evidence import ResidualForces
from mmgtune.diagnose.evidence.forces import time_since_order
from mmgtune.diagnose.evidence.leftover import Leftover, by_chance, offsets_of
from mmgtune.diagnose.evidence.whereabouts import PHASES, REPEAT, TELLS, Whereabouts, phases_of, whereabouts
from mmgtune.trial import load_trials
from mmgtune.units import DEG

L, U = 83.0, 3.0


def run(name, follow=None, k=1, size=0.0, seed=0, heading=0.0):
    """A trial of 900 s with rudder to and fro, and residual forces: noise of 1 N, and ``follow`` in axis k."""
    t = np.arange(900.0)
    delta = np.where(t < 100.0, 0.0, 20.0 * DEG * np.sign(np.sin((t - 100.0) / 60.0) + 1e-9))
    r = 0.3 * DEG * np.concatenate([np.zeros(100), np.sin((t[100:] - 120.0) / 60.0)])
    trial = load_trials("suzaku").trials["turn_p35"]
    own = dict.fromkeys(("x", "y", "psi", "u", "v_m"), np.zeros(900))
    trial = replace(trial, id=name, t=t, r=r, delta=delta, n=np.full(900, 1.7), extra={}, **own)
    psi = heading + np.cumsum(r)
    rng = np.random.default_rng(seed)
    force = rng.standard_normal((900, 3))
    values = {"heading": np.cos(psi), "speed": np.sin(t / 300.0), "rudder": delta / (20.0 * DEG)}
    if follow:
        force[:, k] += size * values[follow]
    found = ResidualForces(
        id=name,
        sample=np.arange(900),
        force=force,
        noise=np.ones((900, 3)),
        unit=np.full((900, 3), 1e4),
        time=t,
        heading=psi,
        drift=0.02 * rng.standard_normal(900),
        yaw_rate=r * L / U,
        rudder=delta,
        ordered=time_since_order(t, delta),
        speed=U + 0.3 * np.sin(t / 300.0),
        tau=3.0,
        L_pp=L,
    )
    return found, trial


def test_a_force_that_follows_the_heading_is_found_with_its_axis():
    headings = np.linspace(0.0, 5.0, 6)
    forces = [run(f"run_{i}", "heading", 1, 3.0, i, heading) for i, heading in enumerate(headings)]
    found = whereabouts(forces, {"run_0": 30.0, "run_1": 10.0, "run_2": -3.0}, {"current": 0.3}, {})
    axis, quantity, share = found.strongest
    assert (axis, quantity) == ("Y", "heading")
    assert share > 0.8
    assert found.suggestion == TELLS["heading"]
    assert list(found.runs) == ["run_0", "run_1", "run_2"]
    assert found.runs["run_0"] == pytest.approx(0.75)
    assert found.axes["Y"] == pytest.approx(
        np.mean(np.concatenate([9.0 * np.cos(f.heading) ** 2 for f, _ in forces])), rel=0.1
    )
    assert abs(found.axes["X"]) < 0.1
    curve = found.curves["Y"]
    assert curve["quantity"] == "heading"
    assert 1e4 * np.array(curve["mean"]) == pytest.approx(3.0 * np.cos(curve["at"]), abs=0.7)
    said = " ".join(found.sentences())
    assert "75 % of the error is in 1 of 3 runs: run_0" in said
    assert "sway force follows the heading" in said
    assert "current would remove the largest share of the error, 30 %" in said
    json.dumps(found.to_dict(), allow_nan=False)


def test_noise_follows_nothing_and_is_to_be_repeated():
    found = whereabouts([run(f"run_{i}", seed=i) for i in range(4)], {"run_0": -1.0}, {}, {})
    assert found.strongest is None
    assert found.runs == {}
    assert found.suggestion == REPEAT
    assert all(abs(value) < 0.1 for value in found.axes.values())


def test_parts_of_a_run_are_told():
    found, trial = run("run")
    names = np.array(list(PHASES))[phases_of(found, trial)]
    assert set(names[:100]) == {"before"}
    entry = names == "entry"
    assert entry.any()
    assert np.all(found.ordered[entry] * found.speed[entry] / L <= 3.0)
    checking = names == "checking"
    assert np.all(found.rudder[checking] * trial.r[checking] < 0.0)
    assert checking.any()
    long_after = (found.ordered * found.speed / L > 3.0) & ~checking
    assert set(names[long_after]) == {"steady"}


def test_without_a_trial_long_enough_for_forces_the_runs_are_told():
    found = whereabouts([], {"a": 4.0, "b": 1.0}, {"wind": 0.1}, {}, {"b": "spikes"})
    assert found.odd == {}  # most of the error is elsewhere
    odd = whereabouts([], {"a": 4.0, "b": 1.0}, {"wind": 0.001}, {}, {"a": "'v' is to port"})
    assert odd.suggestion == "the same without what is odd: 'v' is to port (a)"
    assert not any("wind" in one for one in odd.sentences())  # it would remove nothing
    assert found.runs == {"a": 0.8, "b": 0.2}
    assert found.strongest is None
    assert "80 % of the error is in 1 of 2 runs: a." in found.sentences()
    json.dumps(found.to_dict(), allow_nan=False)


def test_a_measured_wind_is_among_what_forces_may_follow():
    forces = []
    for i in range(6):
        found, trial = run(f"run_{i}", seed=i, heading=float(i))
        towards = 0.9 * i + trial.t / 200.0
        wind = {"wind_speed": np.full(900, 8.0), "wind_dir": np.mod(towards, 2.0 * np.pi)}
        found.force[:, 2] += 3.0 * np.sin(towards - found.heading)
        forces.append((found, replace(trial, extra=wind)))
    axis, quantity, share = whereabouts(forces, {}, {}, {}).strongest
    assert (axis, quantity) == ("N", "wind_angle")
    assert share > 0.8


@pytest.mark.parametrize(
    ("shares", "followed"),
    [
        ({"drift": 0.34, "east": 0.36}, "drift"),
        ({"drift": 0.2, "east": 0.36}, "east"),
        ({"drift": 0.01, "time": 0.05}, "time"),
        ({"drift": 0.5, "yaw_rate": 0.6}, "yaw_rate"),
        ({"heading": 0.02, "east": 0.11}, "east"),
    ],
)
def test_the_place_is_blamed_last(shares, followed):
    found = Whereabouts({}, {}, {}, {"Y": 10.0}, {"Y": shares}, {}, (), {}, {})
    best = found.strongest
    assert (best[1] if best else "time") == followed


def test_what_does_nearly_as_well_is_named_beside():
    phases = {"entry": {"N": 10.0}}
    found = Whereabouts({}, phases, {}, {"N": 10.0}, {"N": {"drift": 0.34, "east": 0.36, "speed": 0.1}}, {}, (), {}, {})
    assert (
        "drift angle, which alone predicts 34 % of it; nearly as well do: position east 36 %." in found.sentences()[1]
    )


@pytest.mark.parametrize(
    ("by_run", "found"),
    [
        ((0.09, 0.07, 0.08, 0.085, 0.078), True),
        ((0.09, -0.07, 0.08, 0.085, 0.078), False),
        ((0.14, 0.02, 0.08, 0.085, 0.078), False),
        ((0.09, 0.07), False),
        ((0.002,) * 5, False),
    ],
    ids=["alike", "to both sides", "of other size", "in too few runs", "within the noise"],
)
def test_an_offset_of_a_log_is_one_number_in_every_run(by_run, found):
    rng = np.random.default_rng(1)
    sigma = np.array([0.4, 0.4, 0.003, 0.02, 0.02, 0.0005])
    residuals = [sigma * rng.standard_normal((400, 6)) for _ in by_run]
    for values, offset in zip(residuals, by_run, strict=True):
        values[:, 4] -= offset
        values[:, 0] += np.linspace(0.0, 9.0, 400)  # a track that bends away is no offset
        values[50:60] = np.nan
    offsets = offsets_of(residuals, sigma)
    assert list(offsets) == (["v_m"] if found else [])
    if found:
        assert offsets["v_m"] == pytest.approx(np.mean(by_run), abs=0.003)
        said = whereabouts([], {}, {}, offsets).sentences()
        assert "sway velocity is off by +0.0" in said[0]
        assert said[-1] == "What would tell: the sway velocity from a second sensor in the same runs."


@pytest.mark.parametrize(
    ("channels", "alone"),
    [
        ({"x": -0.03, "psi": 0.04, "u": 11.3, "v_m": 0.02}, "u"),
        ({"x": 1.2, "psi": 0.04, "u": 11.3, "v_m": 0.02}, ""),
        ({"x": 11.3, "psi": 0.04, "u": 0.0, "v_m": 0.02}, "position"),
        ({"x": 0.0, "psi": 0.04, "u": 0.02, "v_m": 0.02}, ""),
        ({"x": 0.06, "y": 0.3, "psi": 80.8, "u": 0.04, "v_m": 0.49, "r": -0.01}, "psi"),
        ({"x": 10.1, "y": 12.0, "psi": -0.04, "u": -0.07, "v_m": 0.0, "r": 0.06}, "position"),
        ({"x": 9.4, "y": 21.5, "psi": -0.01, "u": 0.17, "v_m": 0.02, "r": 0.0}, ""),
        ({"x": 0.20, "y": 0.12, "psi": 0.01, "u": 0.02, "v_m": 0.04, "r": 0.02}, "position"),
        ({"x": 5.2, "y": 10.3, "psi": 5.1, "u": 0.9, "v_m": 0.5, "r": 0.5}, ""),
        ({"x": 0.06, "y": 0.04, "psi": 0.04, "u": 0.04, "v_m": 0.04, "r": 0.04}, ""),
        ({"x": 0.056, "y": -0.03, "psi": -0.016, "u": 0.011, "v_m": -0.05, "r": 0.007}, ""),
    ],
    ids=[
        "a log",
        "positions too",
        "positions",
        "nothing",
        "course over ground as the heading of one run",
        "positions that were filtered",
        "a bent propeller, in two runs of five",
        "an antenna that heels",
        "a propeller that ventilates",
        "hardly anything anywhere",
        "a form a little off, in the best log first",
    ],
)
def test_what_is_left_in_one_log_alone_is_of_its_sensor_and_of_no_force(channels, alone):
    left = Leftover(sum(channels.values()), channels, {}, {}, {}, {})
    assert left.alone == alone
    forces = [run(f"run_{i}", "rudder", 1, 3.0, seed=i) for i in range(4)]
    found = replace(whereabouts(forces, {"run_0": 30.0, "run_1": 10.0}, {"wind": 0.3}, {}), channel=left.alone)
    said = " ".join(found.sentences())
    words = {"u": "the log of the surge velocity", "psi": "the log of the heading", "position": "the positions"}
    assert (f"in {words.get(alone)} alone" in said) == bool(alone)
    assert ("By inverse dynamics" in said) != bool(alone)
    assert ("surge velocity from a second sensor" in said) == (alone == "u")
    assert ("positions of a second receiver" in said) == (alone == "position")
    assert "wind would remove the largest share" in said
    assert found.to_dict()["channel"] == (alone or None)


@pytest.mark.parametrize("values", [[0.4, 0.5, 0.45], [0.1, -0.3, 0.2, 0.05], [1.0, 1.0]])
def test_the_chance_of_a_mean_is_that_of_student_s_test(values):
    with np.errstate(divide="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # SciPy speaks of values that are all the same
        expected = ttest_1samp(values, 0.0).pvalue
    assert by_chance(np.array(values)) == pytest.approx(expected)
