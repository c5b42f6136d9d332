"""Effects put into a profile to be tuned, one with a null at infinity among them."""

import json
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.fitting import FitOptions, fit, plan_fit
from mmgtune.fitting.box import choose_targets, make_box
from mmgtune.fitting.extending import settled
from mmgtune.fitting.extending import with_effects as put_in
from mmgtune.model import Model
from mmgtune.profile import load_profile, parse_profile, with_effects
from mmgtune.trial import TrialSet, load_trials
from tests.command import run

RATE = np.radians(2.32)
"""Of the steering gear of the bundled trials [rad/s]."""

SOME = ("wake.*", "rudder.eps", "rudder.kappa", "rudder.l_R_", "rudder.gamma_*")
"""Enough to follow the trials; with all of the rudder, whose coefficients trade, four turns do not tell its rate."""

TIME_CONSTANT = "effects.steering-lag.time_constant"
RATE_LIMIT = "effects.steering-lag.rate_limit"


@pytest.fixture(scope="module")
def ship():
    return with_effects(load_profile("suzaku"), {"steering-lag": {}}, "put in to be tuned")


@pytest.fixture(scope="module")
def ordered():
    """Bundled turns with the rudder logged as it was ordered: over at once."""
    trials = {}
    for name, trial in load_trials("suzaku").trials.items():
        if name in ("turn_p10", "turn_m20", "turn_p35", "turn_m40"):
            angle = np.radians(float(name[-2:])) * (1.0 if "_p" in name else -1.0)
            begins = int(np.argmax(np.abs(trial.delta) > np.radians(0.5))) - 1
            trials[name] = replace(trial, delta=np.where(np.arange(len(trial.t)) >= begins, angle, 0.0))
    return TrialSet(trials, tuple(trials), (), licence="CC BY-NC 4.0", citation="Who Measured 2020")


def test_an_effect_that_is_there_already_is_tuned_too():
    """It was left as it is, without a word."""
    there = with_effects(load_profile("suzaku"), {"current": {"north": 0.2}}, "tuned before")
    profile, options = put_in(there, FitOptions(with_effects=("current", "rpm-scale")))
    assert profile.value("effects.current.north") == 0.2
    assert options.targets[: len(there.targets)] == there.targets
    assert {"effects.current.north", "effects.current.east"} < set(options.targets)
    assert put_in(profile, options) == (profile, options)
    assert put_in(there, FitOptions()) == (there, FitOptions())


def test_a_null_at_infinity_is_a_point_of_the_box(ship):
    box = make_box(Model(ship), ["hull.R_0", RATE_LIMIT], 0.5)
    start = box.to_unit(box.pre)
    assert start[1] == 0.0
    assert box.from_unit(start)[1] == np.inf
    assert box.from_unit(np.array([0.5, 0.5]))[1] == pytest.approx(2.0 / box.high[1])
    assert (box.bound_at(1, 0.0), box.bound_at(1, 1.0), box.bound_at(1, 0.5)) == ("high", "low", None)


@pytest.mark.parametrize(
    "options",
    [
        # A time constant does nearly the same to a single order, so it is held.
        FitOptions(method="least-squares", starts=3, initial="estimated", targets=(*SOME, RATE_LIMIT)),
        pytest.param(
            FitOptions(starts=2, initial="estimated", targets=("wake.w_P0", "rudder.eps", "rudder.l_R_", RATE_LIMIT)),
            marks=pytest.mark.long,
        ),
    ],
    ids=["least-squares", "cma-es"],
)
def test_a_rate_limit_is_found_from_its_null_at_infinity(ship, ordered, options):
    result = fit(ship, ordered, options)
    assert result.theta[RATE_LIMIT] == pytest.approx(RATE, rel=0.3)  # what is held is not quite right
    document = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    row = next(row for row in document["coefficients"] if row["name"] == RATE_LIMIT)
    assert row["pre_determined"] is None
    assert row["high"] is None
    assert row["at_bound"] is None
    assert 0.0 < row["position"] < 1.0
    again = parse_profile(result.tuned_text())
    assert again == result.tuned_profile()
    assert (again.licence, again.citation) == ("CC BY-NC 4.0", "Who Measured 2020")
    assert again.value(RATE_LIMIT) == result.theta[RATE_LIMIT]
    assert again.coefficient(RATE_LIMIT).pre_determined == np.inf


@pytest.mark.long
def test_a_lag_that_is_not_there_stays_at_its_null(tmp_path):
    """The bundled trials log the blade itself, behind its gear."""
    options = ("--method", "least-squares", "--starts", "2", "--out", "run", "--quiet", "--json")
    ended = run("fit", "--with-effects", "steering-lag", *options, cwd=tmp_path)
    assert ended.code == 0, ended.err
    theta = ended.json()["theta"]
    assert theta[RATE_LIMIT] is None or theta[RATE_LIMIT] > RATE
    assert theta[TIME_CONSTANT] < 0.5
    assert "| ∞ |" in (tmp_path / "run" / "report.md").read_text()
    shown = run("profile", "show", "run/profile.toml", "--json", cwd=tmp_path)
    values = {row["name"]: row["value"] for row in shown.json()["coefficients"]}
    assert values[RATE_LIMIT] == theta[RATE_LIMIT]


def test_a_factor_on_what_no_trial_measured_is_held(ship):
    """Nothing would determine it, and the fit would say so of a coefficient that nobody asked for."""
    data = load_trials("suzaku")
    some = replace(data, trials={"turn_p35": data.trials["turn_p35"]}, tune=("turn_p35",), test=())
    name = "effects.current.measured"
    asked = FitOptions(method="least-squares", starts=1, targets=("hull.R_0",), with_effects=("current",))
    result = fit(ship, some, asked)
    assert name not in result.theta
    assert {"effects.current.north", "effects.current.east"} < set(result.theta)
    assert name in result.held
    said = f"{name} is held at 0: no tune trial has measured current."
    assert [one for one in result.warnings if name in one] == [said]
    assert said in str(plan_fit(ship, some, asked))
    assert name not in result.identifiability.undetermined


def test_it_is_tuned_where_a_trial_measured_it_and_where_it_is_asked_for(ship):
    data = load_trials("suzaku")
    name = "effects.current.measured"
    asked = FitOptions(targets=("hull.R_0",), with_effects=("current",))
    trial = data.trials["turn_p35"]
    here = {"current_speed": np.full(trial.n_samples, 0.2), "current_dir": np.zeros(trial.n_samples)}
    with_current = replace(data, trials={**data.trials, "turn_p35": replace(trial, extra=here)})
    assert "turn_p35" in data.tune
    for trials, options in ((with_current, asked), (data, replace(asked, targets=("hull.R_0", name)))):
        profile, found = settled(ship, options, trials)
        assert name in choose_targets(Model(profile), found.targets, found.fixed)
        assert settled(profile, found, trials) == (profile, found)
    profile, found = settled(ship, asked, data)
    assert name not in choose_targets(Model(profile), found.targets, found.fixed)
    assert settled(profile, found, data) == (profile, found)
