"""An effect that does nothing at a typical size is looked at where it does something."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.diagnose.bench.workbench import make_workbench
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.diagnose.signatures.linear import Steps, linearise
from mmgtune.effects import find_effect
from mmgtune.motions import simulate_trials
from mmgtune.profile import load_profile, scale_of, with_effects
from mmgtune.trial import load_trials
from tests.diagnose.sensors import logged

RATE = "effects.steering-lag.rate_limit"


def steered_at(rate, trial):
    """A trial whose rudder moves at no more than a rate [rad/s]."""
    moved = [trial.delta[0]]
    for to, h in zip(trial.delta[1:], np.diff(trial.t), strict=True):
        moved.append(moved[-1] + np.clip(to - moved[-1], -rate * h, rate * h))
    return replace(trial, delta=np.array(moved))


@pytest.fixture(scope="module")
def slowly_steered():
    """Trials whose log has the rudder at the rate of its pumps, and whose blade moves at less than half of that."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(7)
    trials = [steered_at(np.radians(2.0), load_trials("suzaku").trials[name]) for name in ("turn_p35", "zigzag_20")]
    slow = with_effects(profile, {"steering-lag": {"rate_limit": np.radians(1.1)}}, "made")
    return [logged(*pair, rng) for pair in zip(trials, simulate_trials(slow, trials), strict=True)]


@pytest.mark.parametrize(
    ("at", "size", "acts_from", "reach", "step"),
    [
        (0.0, 0.1, 0.05, 1.0, 0.1),  # at a typical size
        (0.0, 0.1, 0.15, 2.0, 0.2),
        (0.0, 0.1, 0.25, 4.0, 0.4),
        (1.0, 0.1, 0.25, 4.0, 0.4),
        (1.0, 0.3, 0.7, 4.0, 1.0),  # as far as the bound
        (0.0, 0.1, 0.5, 4.0, 0.4),  # nowhere
    ],
)
def test_steps_reach_as_far_as_something_is_done(at, size, acts_from, reach, step):
    here, asked = np.array([0.5, at, 0.5]), []

    def simulated(places):
        asked.append(places.shape[1])
        gone = np.abs(places[1] - at)
        return np.array([places[0], np.where(gone > acts_from, 3.0 * gone, 0.0), 2.0 * places[2]])

    within = np.array([False, True, True])
    steps = Steps.about(here, 1, np.array([size, 0.2]), np.array([1.0 - 2.0 * at, 0.0]), within)
    runs = steps.reaching(here, simulated(steps.columns(here)), simulated)
    assert steps.reach.tolist() == [reach, 1.0]
    assert max(steps.plus[1], steps.minus[1]) == pytest.approx(step)
    assert asked[1:] == [1] * (0 if reach == 1.0 else 1 if reach == 2.0 else 2)  # nothing else is simulated again
    slopes = steps.slopes(steps.without_lost(runs))
    assert abs(slopes[1, 1]) == pytest.approx(3.0 if acts_from < step else 0.0)
    assert (slopes[0, 0], slopes[2, 2]) == pytest.approx((1.0, 2.0))


def test_a_limit_that_cuts_nothing_off_the_log_at_a_typical_size_is_looked_at_further_on(slowly_steered):
    profile = load_profile("suzaku")
    bench = make_workbench(profile, slowly_steered, DiagnoseOptions(targets=("hull.R_0",), leeway=0.0), [RATE])
    assert 1.0 / bench.parameter(RATE).typical(scale_of(profile)) > np.radians(2.0)
    point = base_fit(bench)
    linear = linearise(bench, point, [RATE])
    assert linear.reach == {RATE: 2.0}
    assert np.linalg.norm(linear.columns([RATE])) > 10.0


def test_a_rudder_slower_than_a_log_that_moves_at_its_rate_is_found(slowly_steered):
    effects = ("steering-lag", "dead-time", "clock-offset", "rudder-gain")
    result = diagnose("suzaku", slowly_steered, DiagnoseOptions(effects=effects))
    assert (result.verdict, [cause.tag for cause in result.causes]) == ("found", ["steering-lag"]), result.sentence()
    (cause,) = result.causes
    assert cause.estimates[RATE].value == pytest.approx(np.radians(1.1), rel=0.03)
    (told,) = [one for one in result.detectability if one.parameters == ("rate_limit",)]
    assert told.limit["rate_limit"] < np.radians(2.0)  # a larger one cuts nothing off


@pytest.mark.parametrize(("length", "speed", "slowest"), [(30.0, 6.0, 60.0), (83.0, 3.1, 4.0 * 83.0 / 3.1)])
def test_a_slow_gear_is_in_reach_of_any_ship(length, speed, slowest):
    """Of a tug it ended at 2.2 deg/s, and her blade at 2.0 was no cause."""
    scale = scale_of(load_profile("suzaku"))._replace(L=length, U=speed)
    for name in ("rate_limit", "to_starboard", "to_port"):
        assert find_effect("steering-lag").parameters[name].bounds(scale) == (0.0, pytest.approx(slowest))
