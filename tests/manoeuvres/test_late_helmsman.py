"""Zigzags as they are measured: the rudder is reversed late, the course was kept by rudder, and sensors have noise."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from mmgtune.manoeuvres import criteria_of, indices_of, zigzag_indices
from mmgtune.model import Model
from mmgtune.motions import as_trial, track_of
from mmgtune.orders import ZigzagOrder, run_manoeuvre
from mmgtune.profile import load_profile
from mmgtune.repeating import repeat

from .made import DEG

ORDERED_AT = 30.0
"""Time of the first order [s]."""


@dataclass
class LateHelmsman:
    """Keeps course 0 by rudder, restlessly; sails a zigzag and reverses ``delay`` [s] after the check heading."""

    rudder: float
    check: float
    delay: float
    legs: int = 4
    _side: float = 1.0
    _given: int = 1
    _passed: float | None = None
    _seen: tuple[float, float] = (-0.1, 0.0)

    def order(self, t: float, heading: float) -> float:
        rate, self._seen = (heading - self._seen[1]) / max(t - self._seen[0], 1e-3), (t, heading)
        if t < ORDERED_AT:
            return float(np.clip(-1.5 * heading - 5.0 * rate + 4.0 * DEG * np.sin(0.45 * t), -8.0 * DEG, 8.0 * DEG))
        if self._passed is None and heading * self._side >= self.check:
            self._passed = t
        if self._passed is not None and t >= self._passed + self.delay:
            self._side, self._passed, self._given = -self._side, None, self._given + 1
        return self._side * self.rudder

    def finished(self, heading: float) -> bool:
        return self._given > self.legs


@pytest.fixture(scope="module")
def ship():
    """KVLCC2 at HSVA's scale."""
    return Model(load_profile("kvlcc2_l7"))


@pytest.fixture(scope="module")
def sailed(ship):
    """Trials of zigzags (rudder, check angle) [deg], with noise, and their true peaks off the course kept [rad]."""
    found = {}
    for pair in ((35, 5), (10, 10)):
        helmsman = LateHelmsman(pair[0] * DEG, pair[1] * DEG, delay=0.5)
        motion = run_manoeuvre(ship, helmsman, id="zigzag", sample=0.1, longest=200.0)
        rng = np.random.default_rng(5)
        trial = as_trial(ship.profile, motion)
        psi = trial.psi + 0.1 * DEG * rng.standard_normal(trial.n_samples)
        heading = motion.channel("psi")[motion.t > ORDERED_AT + 2.0]
        halves = np.split(heading, np.flatnonzero(np.diff(np.sign(heading))) + 1)
        peaks = [float(np.max(np.abs(half))) for half in halves]
        found[pair] = replace(trial, psi=psi), [peak for peak in peaks if peak > pair[1] * DEG]
    return found


@pytest.mark.parametrize("pair", [(35, 5), (10, 10)])
def test_overshoots_count_from_the_course_kept_and_the_check_angle(ship, sailed, pair):
    trial, peaks = sailed[pair]
    indices = zigzag_indices(track_of(trial), ship.L_pp)
    assert indices.order == f"{pair[0]}/{pair[1]}"
    over = np.array(peaks) - pair[1] * DEG
    # At the moment of the first order the heading is 0.7 deg off the course kept, over the last ship length 0.3 deg.
    assert indices.overshoot == pytest.approx(list(over[: len(indices.overshoot)]), abs=0.4 * DEG)
    assert len(indices.overshoot) >= 2
    late = np.array(indices.execute_heading[: len(indices.overshoot)]) - pair[1] * DEG
    assert np.all(late > 0.3 * DEG)
    assert np.array(indices.overshoot) - np.array(indices.overshoot_from_execute) == pytest.approx(late)


def test_a_late_zigzag_is_repeated_as_it_was_ordered(ship, sailed):
    (one,) = repeat(ship, [sailed[35, 5][0]])
    assert one.order == "35/5 to starboard first"
    assert one.simulated["heading_angle_deg"] == pytest.approx(5.0)


def test_a_simulation_is_read_with_the_check_angle_of_the_run_it_simulates(ship):
    """A model that follows another heading has no check angle of its own: the helmsman looked at the ship's."""
    sailed = run_manoeuvre(ship, ZigzagOrder(20.0 * DEG, 20.0 * DEG), sample=0.5).track()
    other = replace(sailed, psi=0.8 * sailed.psi)
    measured = indices_of(sailed, ship.L_pp)
    assert measured["order"] == "20/20"
    assert indices_of(other, ship.L_pp)["order"] != "20/20"
    as_measured = indices_of(other, ship.L_pp, measured)
    assert as_measured["order"] == "20/20"
    peak = np.max(np.abs(other.psi[sailed.t < 60.0])) / DEG
    assert as_measured["overshoot_1_deg"] == pytest.approx(peak - 20.0, abs=0.1)


def test_a_zigzag_without_counter_order_has_a_name(ship):
    motion = run_manoeuvre(ship, ZigzagOrder(20.0 * DEG, 20.0 * DEG, legs=1), sample=0.5, longest=30.0)
    indices = zigzag_indices(motion.track(), ship.L_pp)
    assert indices.order == "20/?"
    assert criteria_of(motion.track(), ship.L_pp, 1.18) == ()
