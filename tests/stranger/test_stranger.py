"""The plant itself: mirror images, tracks that are the integral of velocities, sets that are always the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mmgtune.trial import check_trials, load_trials

from .plant import DEG, ESSO, STEP, SUZAKU, Helm, Hidden, Ship, sail
from .run import GROUPS, score
from .sets import CASES, SHIPS, Case, make, ship_of, write

HELM = Helm(
    heading=0.0, n=1.7, lead=20.0, lasts=200.0, course=0.0, check=0.0, kp=1.0, kd=25.0, every=3.0,
    rounding=0.5 * DEG, late=1.0, band=0.3 * DEG, sag=0.03,
)  # fmt: skip


def turn(ship: Ship, angle: float, hidden: Hidden | None = None, **of: float) -> np.ndarray:
    helm = HELM._replace(n=ship.n, **of)
    return sail(ship, hidden or Hidden(), helm, np.array([angle * DEG]), np.array([1e9]))


@pytest.mark.parametrize("ship", [SUZAKU, ESSO])
@pytest.mark.parametrize("check", [0.0, 10.0])
def test_a_ship_without_sides_turns_to_both_alike(ship: Ship, check: float) -> None:
    even = ship._replace(gp=0.4, gn=0.4)
    around = {
        "side_Y": 0.0, "side_N": 0.0, "memory": 8.0, "stall": 15 * DEG, "play": 1 * DEG, "depth": 2 * ship.d,
        "Yvav": -0.2, "Nrar": -0.02,
    }  # fmt: skip
    to_starboard = Hidden(east=0.3, north=0.1, wind=8.0, gust=0.0, wind_from=1.0, drift=9e3, drift_from=2.0, **around)
    to_port = to_starboard._replace(east=-0.3, wind_from=-1.0, drift_from=-2.0)
    one, other = (turn(even, a, h, check=check * DEG) for a, h in ((20.0, to_starboard), (-20.0, to_port)))
    mirrored = np.array([1, 1, -1, -1, 1, -1, -1, -1, 1])
    # Rounding of the two paths alone differs; a zigzag's switch may fall one step of the plant apart.
    assert np.allclose(one, other * mirrored, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("name", ["current", "wind", "shallow-esso", "eddy", "memory"])
def test_tracks_are_the_integral_of_velocities(name: str) -> None:
    case = CASES[name]
    rows = turn(ship_of(case), 25.0, Hidden(**case.hidden))
    x, y, psi, u, v, r = rows.T[1:7]
    for found, rate in ((x, u * np.cos(psi) - v * np.sin(psi)), (y, u * np.sin(psi) + v * np.cos(psi)), (psi, r)):
        track = np.concatenate([[0.0], np.cumsum(0.5 * STEP * (rate[1:] + rate[:-1]))])
        # the trapezoid's own error: step^2 / 12 times the change of acceleration, some 1e-4 m a minute
        assert np.allclose(found - found[0], track, atol=2e-2)


def test_the_papers_circles() -> None:
    """Steady circles of SUZAKU at 35 deg, worked out for the same coefficients elsewhere: 101 and 74 m wide."""
    for angle, wide in ((35.0, 101.0), (-35.0, -74.0)):
        end = turn(SUZAKU, angle, lasts=700.0, sag=0.0)[-1]
        assert 2.0 * np.hypot(end[4], end[5]) / end[6] == pytest.approx(wide, abs=1.5)


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.hidden])
def test_all_that_is_hidden_does_something(name: str) -> None:
    case = CASES[name]
    hidden = Hidden(**case.hidden)
    there = turn(ship_of(case), 35.0, hidden, check=15 * DEG)
    for field in case.hidden:
        without = turn(ship_of(case), 35.0, hidden._replace(**{field: Hidden._field_defaults[field]}), check=15 * DEG)
        assert np.abs(there - without)[:, 1:7].max() > 1e-3, field


@pytest.mark.parametrize("name", ["nothing-rough", "clocks-off", "stall+current-esso", "fast-clock"])
def test_sets_are_always_the_same(name: str) -> None:
    first, again = make(CASES[name]), make(CASES[name])
    assert list(first) == list(again)
    for one, other in zip(first.values(), again.values(), strict=True):
        assert np.array_equal(one.motion, other.motion, equal_nan=True)
        assert np.array_equal(one.delta, other.delta)


@pytest.mark.daily("shallow", "eddy", "current", "nothing")
@pytest.mark.parametrize("name", [name for name, case in CASES.items() if not case.sensors and not case.rough][::7])
def test_files_are_sound_where_instruments_are(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    trials = load_trials(write(case, tmp_path))
    assert trials.tune
    assert trials.test
    for found in check_trials(trials.trials, SHIPS[case.ship].L).values():
        assert [one.what for one in found if one.severity != "note"] == []


def test_what_the_sets_say_of_themselves() -> None:
    assert {case.group for case in CASES.values()} == set(GROUPS)
    for case in CASES.values():
        assert bool(case.causes) == (case.group not in ("nothing", "unknown"))
        assert bool(case.by_run) == (case.group == "by-run")
        assert (ship_of(case) != SHIPS[case.ship]) == (case.off > 0.0)


def test_scores() -> None:
    one = Case("", "one", {"current": "", "wind": ""})
    assert score(one, "found", {"current", "wind"}, []) == "right"
    assert score(one, "found", {"current"}, []) == "partly"
    assert score(one, "found", {"current"}, [{"wind", "wave-drift"}]) == "grouped"
    assert score(one, "found", {"current", "wind", "flap"}, []) == "wrong"
    assert score(one, "found", {"hull-term"}, []) == "wrong"
    assert score(one, "none", set(), []) == "missed"
    assert score(one, "unexplained", set(), []) == "unexplained"
    off = Case("", "nothing", {}, off=0.05)
    assert score(off, "found", {"hull-term"}, []) == "hull"
    assert score(off, "found", {"wind"}, []) == "alarm"
    assert score(off, "none", set(), []) == "right"
    unknown = Case("", "unknown", {}, akin=("backlash",))
    assert score(unknown, "unexplained", set(), []) == "right"
    assert score(unknown, "found", {"backlash"}, []) == "right"
