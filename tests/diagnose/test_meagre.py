"""Trials that hold little: the answer has no number that is none, and what cannot be told is left out."""

from __future__ import annotations

import json
from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune import DiagnoseOptions, FitOptions, diagnose, fit, load_trials
from mmgtune.backends import Integrator
from mmgtune.circumstances import another_size
from mmgtune.diagnose.answering.judging import _left_open
from mmgtune.diagnose.folder import write_diagnosis
from mmgtune.errors import OptionError
from mmgtune.motions import simulate_trials
from mmgtune.profile import load_profile
from mmgtune.trial import Trial, check_trials
from mmgtune.trial.checks.control_checks import RUDDER_SIGN
from mmgtune.trial.checks.set_checks import found_in
from mmgtune.units import DEG
from tests.diagnose.sensors import logged

ATTRIBUTES = ("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta")


def short(trial: Trial) -> Trial:
    """The first minute."""
    return replace(trial, **{name: getattr(trial, name)[:60] for name in ATTRIBUTES})


def straight(trial: Trial) -> Trial:
    """Steady speed to the north without a trace of noise."""
    still = {name: np.zeros(trial.n_samples) for name in ("y", "psi", "v_m", "r", "delta")}
    u, n = np.full(trial.n_samples, 3.0), np.full(trial.n_samples, 1.7)
    return replace(trial, **still, x=3.0 * trial.t, u=u, n=n)


@pytest.mark.parametrize(
    "made", [short, pytest.param(straight, marks=pytest.mark.long)], ids=["short", "straight and free of noise"]
)
def test_every_number_of_the_answer_is_one(made):
    trials = load_trials("suzaku")
    few = {name: made(trials.trials[name]) for name in ("turn_p35", "turn_m40")}
    result = diagnose(
        "suzaku", replace(trials, trials=few, tune=tuple(few), test=()), DiagnoseOptions(effects=("current",))
    )
    said = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    assert said["verdict"] in ("none", "found")
    assert "forces_before" not in said["evidence"] or made is not short


def test_a_heading_that_was_not_measured():
    """Residual forces were asked for of runs without one, which ended in an error about windows of 60 s."""
    trials = load_trials("suzaku").trials
    given = [replace(trials[name], derived=("psi",)) for name in ("turn_p35", "turn_m40")]
    result = diagnose("suzaku", given, DiagnoseOptions(effects=("rudder-offset",), targets=("hull.R_0",)))
    json.dumps(result.to_dict(), allow_nan=False)


def test_fewer_samples_than_coefficients():
    """Ended in a ValueError of arrays of different shapes."""
    trial = load_trials("suzaku").trials["turn_p35"]
    few = replace(trial, **{name: getattr(trial, name)[80:83] for name in ATTRIBUTES})
    result = diagnose("suzaku", [few], DiagnoseOptions(effects=("rudder-offset",)))
    json.dumps(result.to_dict(), allow_nan=False)


@pytest.mark.long
def test_a_channel_of_numbers_whose_squares_are_none():
    """A warning of NumPy, and a J that was no number."""
    trial = load_trials("suzaku").trials["turn_p35"]
    tiny = replace(trial, u=np.full(trial.n_samples, 5e-324))
    result = diagnose("suzaku", [tiny], DiagnoseOptions(effects=("rudder-offset",)))
    json.dumps(result.to_dict(), allow_nan=False)
    with pytest.raises(OptionError, match="do not vary in u"):
        fit(
            "suzaku", [replace(tiny, u=tiny.u * (np.arange(trial.n_samples) % 2))], FitOptions(objective="standardised")
        )


def test_a_rudder_of_the_wrong_sign_is_told_first():
    trials = load_trials("suzaku")
    wrong = {name: replace(one, delta=-one.delta) for name, one in trials.trials.items() if name in trials.tune[:3]}
    assert list(found_in(check_trials(wrong), RUDDER_SIGN)) == list(wrong)
    assert not found_in(check_trials(trials.trials), RUDDER_SIGN)
    asked = DiagnoseOptions(effects=("rudder-offset",), targets=("hull.R_0",), leeway=0.0)
    result = diagnose("suzaku", replace(trials, trials=wrong, tune=tuple(wrong), test=()), asked)
    assert result.verdict == "unexplained"
    assert result.sentence().startswith("First put the logs right: in 3 of 3 trials the ship turns away from")
    assert "No cause was looked for" in result.sentence()
    assert (result.candidates, result.record) == ((), None)  # three minutes of search told no more


@pytest.mark.parametrize("by_noise", [False, True])
def test_positions_stretched_along_one_axis_are_told_first(by_noise, monkeypatch, tmp_path):
    """Longitudes without the cosine of latitude were "nothing is wrong", as noise that wanders by 13 m."""
    trials, profile, rng = load_trials("suzaku"), load_profile("suzaku"), np.random.default_rng(3)
    ids = trials.tune[:3]
    sailed = [trials.trials[id] for id in ids]
    motions = simulate_trials(profile, sailed, integrator=Integrator("rk4"))
    made = {id: logged(trial, motion, rng) for id, trial, motion in zip(ids, sailed, motions, strict=True)}
    if by_noise:  # what is left is thought to be noise, whatever the logs say
        module = import_module("mmgtune.diagnose.run")
        monkeypatch.setattr(module, "_contradicted", lambda _, __, signs=(): "" if signs else "Logs differ.")
    else:
        made = {id: replace(one, y=1.2 * one.y) for id, one in made.items()}
    asked = DiagnoseOptions(effects=("rudder-offset",), targets=("hull.R_0",), leeway=0.0)
    result = diagnose(profile, replace(trials, trials=made, tune=ids, test=()), asked)
    assert (result.verdict, result.instead) == ("unexplained", None)
    first = "First put the logs right: in 3 of 3 trials u, v and heading do not integrate to the positions, whatever"
    assert result.sentence().startswith("Logs differ." if by_noise else first)
    assert ("if 'y' is divided by 1.2. Something is wrong" in result.sentence()) != by_noise
    assert ("Logs differ. What the re-tuned model leaves is taken for noise" in result.sentence()) == by_noise
    document = write_diagnosis(result, tmp_path / "run")
    assert document["headline"].startswith("Logs differ." if by_noise else "First put the logs right: in 3")


def test_a_run_astern_that_the_model_does_not_have_is_told_first():
    """A sum of wind, current and resistance was the headline, and the crash stop a note below."""
    trials = load_trials("suzaku").trials
    crash = replace(trials["turn_p35"], n=np.where(trials["turn_p35"].t > 60.0, -1.0, trials["turn_p35"].n))
    asked = DiagnoseOptions(effects=("rudder-offset",), targets=("hull.R_0",), leeway=0.0)
    said = diagnose("suzaku", [crash, trials["turn_m10"]], asked).sentence()
    assert said.startswith("The propeller turns astern in turn_p35, and the propeller 'four-quadrant' of 'suzaku' has")
    assert "Leave that out, and diagnose what else was sailed. Something is wrong" in said
    assert "Leave that out" not in diagnose("suzaku", [crash], asked).sentence()  # there is nothing else


@pytest.mark.daily("0.04")
@pytest.mark.parametrize(("off", "verdict"), [(0.0, "none"), (0.04, "unexplained")])
def test_a_ship_that_swings_in_waves_is_told_first(off, verdict):
    """Nothing that is known explains it, and nothing has to, where nothing else is left; off: a slow error [m/s]."""
    trials, profile, rng = load_trials("suzaku"), load_profile("suzaku"), np.random.default_rng(3)
    ids = trials.tune[:3]
    sailed = [trials.trials[id] for id in ids]
    motions = simulate_trials(profile, sailed, integrator=Integrator("rk4"))
    swung = {}
    for id, trial, motion in zip(ids, sailed, motions, strict=True):
        one = logged(trial, motion, rng)
        phase = 2.0 * np.pi * one.t / 7.0
        swung[id] = replace(
            one,
            psi=one.psi + 0.7 * DEG * np.sin(phase),
            r=one.r + 0.7 * DEG * 2.0 * np.pi / 7.0 * np.cos(phase),
            v_m=one.v_m + 0.1 * np.cos(phase) + off * np.sin(phase / 17.0),
        )
    asked = DiagnoseOptions(effects=("rudder-offset",), targets=("hull.R_0",))
    result = diagnose(profile, replace(trials, trials=swung, tune=ids, test=()), asked)
    assert result.verdict == verdict
    assert ("nothing else is wrong" in result.sentence()) == (verdict == "none")
    assert result.sentence().startswith("In 3 of 3 trials the ship swings from beginning to end with a period of 7 s")
    assert "as in waves" in result.to_dict()["headline"]


@pytest.mark.parametrize(("left_open", "minutes", "restart", "told"), [
    (9.0, 30.0, None, True), (0.5, 30.0, None, False), (9.0, 2.0, None, False), (9.0, 30.0, 120.0, False),
])  # fmt: skip
def test_windows_are_advised_where_inputs_leave_much_open_in_long_runs(left_open, minutes, restart, told):
    bench = SimpleNamespace(trials=[SimpleNamespace(duration=60.0 * minutes)])
    notes = _left_open(bench, SimpleNamespace(left_open=left_open), DiagnoseOptions(restart=restart))
    assert [note.endswith("restart=120") for note in notes] == [True] * told


def test_a_profile_of_a_ship_of_another_size_is_told_first():
    """A minute of search, and "something is wrong that this program cannot name"."""
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "zigzag_10")]
    asked = DiagnoseOptions(effects=("rudder-offset",), targets=("hull.X_vr",), leeway=0.0)
    result = diagnose("esso_osaka_3m", trials, asked)
    assert result.sentence().startswith("First see which ship these trials are of: the ship makes 1.8")
    assert "by the approach of 'esso_osaka_3m'" in result.sentence()
    assert (result.verdict, result.candidates) == ("unexplained", ())


@pytest.mark.parametrize("gear", [0.25, 0.6, 1.0, 2.8])
def test_a_gear_between_shaft_and_counter_makes_no_other_ship(gear):
    profile = load_profile("suzaku")
    trials = [replace(one, n=one.n / gear) for one in load_trials("suzaku").trials.values()]
    assert another_size(profile, trials) == []
