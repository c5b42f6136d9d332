"""A rudder that was logged by another clock than the motion is told, by how much, and nothing else is taken for it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.resources import folder
from mmgtune.trial import Trial, check_trial, load_trials
from mmgtune.trial.checks.control_clock import shift_of
from mmgtune.units import DEG

from .made import made

TRIALS = load_trials("suzaku").trials


def logged_by(late: float, trial: Trial) -> Trial:
    """A trial whose rudder and revolutions were logged so much later [s] than they acted."""
    then = trial.t - late
    return replace(trial, delta=np.interp(then, trial.t, trial.delta), n=np.interp(then, trial.t, trial.n))


@pytest.mark.parametrize("late", [-60.0, -40.0, 30.0, 60.0])
@pytest.mark.parametrize("name", ["zigzag_10", "zigzag_20"])
def test_a_clock_that_is_off(name: str, late: float) -> None:
    found = shift_of(logged_by(late, TRIALS[name]))
    assert found is not None
    assert -found[0] == pytest.approx(late, abs=8.0)


def test_what_it_says() -> None:
    (said,) = [one for one in check_trial(logged_by(-60.0, TRIALS["zigzag_20"])) if "logged of her rudder" in one.what]
    assert said.severity == "warning"
    assert said.what.startswith("the ship turns about 6")
    assert "s after what is logged of her rudder" in said.what
    assert "shift 'delta' and all logged with it by about +6" in said.fix
    (said,) = [one for one in check_trial(logged_by(60.0, TRIALS["zigzag_20"])) if "logged of her rudder" in one.what]
    assert "s before what is logged of her rudder" in said.what


def test_a_turn_that_begins_before_its_rudder() -> None:
    found = shift_of(logged_by(60.0, TRIALS["turn_p35"]))
    assert found is not None
    assert found[0] == pytest.approx(-60.0, abs=8.0)


@pytest.mark.parametrize("ship", ["suzaku", "voyages"])
def test_none_of_those_that_travel_along(ship: str) -> None:
    assert not [id for id, trial in load_trials(folder("trials") / ship).trials.items() if shift_of(trial)]


@pytest.mark.parametrize("lag", [8.0, 20.0, 60.0])
@pytest.mark.parametrize("late", [-3.0, 0.0, 3.0])
def test_what_a_steering_gear_may_take_is_none(lag: float, late: float) -> None:
    assert shift_of(logged_by(late, made(zigzag=True, lag=lag, seed=1))) is None


def test_a_rudder_of_the_other_sign_is_no_clock() -> None:
    trial = TRIALS["zigzag_20"]
    assert shift_of(replace(trial, delta=-trial.delta)) is None


def test_what_cannot_tell() -> None:
    trial = logged_by(60.0, TRIALS["zigzag_20"])
    missing = np.where(np.arange(trial.n_samples) % 2 == 0, trial.r, np.nan)
    for blind in (replace(trial, r=missing), replace(trial, delta=0.05 * trial.delta), replace(trial, r=0.0 * trial.r)):
        assert shift_of(blind) is None


def test_a_ship_that_backs_down_is_not_steered_by_her_rudder() -> None:
    """A crash stop of a model was "12 s after what is logged of her rudder"."""
    late = logged_by(-60.0, TRIALS["zigzag_20"])
    assert shift_of(late) is not None
    astern = np.arange(late.n_samples) > 0.8 * late.n_samples
    assert shift_of(replace(late, n=np.where(astern, -late.n, late.n))) is None


def test_a_pair_of_rudders_turned_outward_brakes() -> None:
    """A model that crabbed with her rudders out made "0.0103 m with each turn of the propeller: too little"."""
    straight = made(angle=0.0, samples=300)
    n = np.full(straight.n_samples, straight.u.mean() / (0.001 * 80.0))
    brakes = np.full(straight.n_samples, 75.0 * DEG)
    said = [one.what for one in check_trial(replace(straight, n=n), 80.0)]
    assert any("with each turn of the propeller" in one for one in said)
    out = {"delta_port": -brakes, "delta_stbd": brakes}
    crabbing = replace(straight, n=n, extra=out)
    assert not any("with each turn of the propeller" in one.what for one in check_trial(crabbing, 80.0))
