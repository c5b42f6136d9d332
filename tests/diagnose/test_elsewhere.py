"""Values of held-out runs: where fits of them begin, and which end counts for which run."""

from types import SimpleNamespace

import numpy as np

from mmgtune.diagnose.held_out import elsewhere

NAMES = [f"effects.wind.{name}@trial:{run}" for run in ("a", "b") for name in ("speed", "direction")]


def test_fits_begin_at_the_mean_and_beside_it_in_every_direction():
    begun = elsewhere._around(NAMES)
    assert begun.shape == (4, 5)
    assert not begun[:, 0].any()
    assert {tuple(column) for column in begun[:2, 1:].T} == {(s, d) for s in (-1.5, 1.5) for d in (-1.5, 1.5)}
    np.testing.assert_array_equal(begun[:2], begun[2:])  # all runs at once, of which none changes another


def test_starts_grow_with_the_parameters_and_no_faster():
    names = [f"effects.current.{name}@trial:a" for name in ("north", "east", "north_rate", "east_rate", "one")]
    begun = elsewhere._around(names)
    assert begun.shape == (5, 1 + 4 + 4 + 2)
    moved = {tuple(np.flatnonzero(column)) for column in begun.T}
    assert moved == {(), (0, 1), (2, 3), (4,)}


def test_each_run_has_the_end_that_is_best_for_it(monkeypatch):
    costs = {0.1: [9.0, 1.0], 0.2: [2.0, 5.0], 0.3: [np.nan, 3.0]}  # of runs a and b
    monkeypatch.setattr(elsewhere, "squares_by_case", lambda problem, unit, offsets, whiten: np.array(costs[unit[0]]))
    problem = SimpleNamespace(prior=np.zeros((2, 6)), groups=[{"trial:a"}, {"trial:b"}])
    ends = [SimpleNamespace(unit=np.full(4, one), offsets=np.zeros((2, 6))) for one in costs]
    beliefs = np.zeros((4, 4)), np.zeros(4)
    found = elsewhere._best_of_each(problem, NAMES, ends, lambda values: values, beliefs)
    np.testing.assert_array_equal(found, [0.2, 0.2, 0.1, 0.1])
