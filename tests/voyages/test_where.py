"""Where the error lives: errors that were planted are found where they were planted."""

import numpy as np
import pytest

from mmgtune.units import DEG
from mmgtune.voyages.drawing_anew import Draws
from mmgtune.voyages.features import FEATURES, MOVED
from mmgtune.voyages.result import CLASSES, classed
from mmgtune.voyages.table import ModelTable, WindowTable
from mmgtune.voyages.where import bins_of, explained, where_it_lives


def table_of(cVDM, runs=1, **features):
    """A table with planted errors; what is not named is drawn by chance."""
    n = len(cVDM)
    rng = np.random.default_rng(0)
    known = {one.name: rng.random(n) for one in FEATURES} | {"path": np.ones(n), "yaw_rate_largest": np.ones(n)}
    parts = {name: 0.2 * cVDM for name in ("position", "heading", "surge", "sway", "yaw")}
    model = ModelTable(np.isinf(cVDM), {"cVDM": cVDM}, np.zeros((n, 6)), np.zeros((n, 6)), np.zeros(n), parts)
    voyage = np.arange(n) * runs // n
    begins = 120.0 * np.arange(n)
    return WindowTable(
        tuple(map(str, range(n))), voyage, np.arange(n), np.full(n, 121), begins, np.full(n, 120.0), known | features,
        np.ones((n, 6)), {"m": model},
    )  # fmt: skip


def draws_of(table, runs=1):
    return Draws(table.groups([str(k) for k in range(runs)])[0])


@pytest.fixture(scope="module")
def near_ten():
    """Four times the error in windows with 8 to 12 deg of rudder, and nowhere else."""
    rng = np.random.default_rng(5)
    rudder = rng.uniform(0.0, 35.0, 2000) * DEG
    cVDM = np.exp(rng.normal(0.0, 0.3, 2000)) * np.where(np.abs(rudder / DEG - 10.0) < 3.0, 4.0, 1.0)
    return table_of(cVDM, rudder=rudder, rudder_largest=np.zeros(2000), rudder_range=np.zeros(2000))


def test_planted_near_ten_degrees_of_rudder(near_ten):
    found = where_it_lives(near_ten, "m", draws_of(near_ten))
    first = found[0]
    assert first.feature.name == "rudder"
    assert (first.worst.low / DEG, first.worst.high / DEG) == pytest.approx((7.0, 13.0))
    assert first.explained > 0.7
    others = [one for one in first.bins if one is not first.worst]
    assert all(first.worst.ci95[0] > 3.0 * one.mean for one in others)
    assert all(one.explained < 0.02 for one in found[1:])
    assert sum(first.worst.parts.values()) == pytest.approx(first.worst.mean)


def test_planted_while_the_rudder_moves():
    rng = np.random.default_rng(6)
    moved = rng.random(600) < 0.3
    ranges = np.where(moved, 10.0 * DEG, 0.5 * MOVED)
    table = table_of(np.exp(rng.normal(0.0, 0.3, 600)) * np.where(moved, 2.0, 1.0), rudder_range=ranges)
    first = where_it_lives(table, "m", draws_of(table))[0]
    assert first.feature.name == "rudder_range"
    assert [(one.name, one.windows) for one in first.bins] == [("steady", (~moved).sum()), ("moving", moved.sum())]


def test_nothing_planted_is_nothing_found():
    """The share explained is adjusted for the number of bins: by chance it is about 0."""
    rng = np.random.default_rng(7)
    shares = [
        one.explained
        for seed in range(20)
        for table in [table_of(np.exp(np.random.default_rng(seed).normal(size=200)), speed=rng.random(200))]
        for one in where_it_lives(table, "m", draws_of(table))
    ]
    assert np.mean(shares) < 0.02


def test_explained_by_hand():
    values, which = np.array([0.0, 2.0, 10.0, 12.0]), np.array([0, 0, 1, 1])
    assert explained(values, which) == pytest.approx(1.0 - (4.0 / 104.0) * 3.0 / 2.0)
    assert explained(values, np.zeros(4, dtype=int)) == 0.0
    assert explained(np.ones(4), which) == 0.0


def test_windows_that_diverged_are_counted_apart(near_ten):
    cVDM = np.array(near_ten.models["m"].cVDM)
    cVDM[:50] = np.inf
    cVDM[50:60] = np.nan
    table = table_of(cVDM, rudder=near_ten.features["rudder"])
    found = {one.feature.name: one for one in where_it_lives(table, "m", draws_of(table))}["rudder"]
    assert sum(one.windows for one in found.bins) == 1990
    assert sum(one.diverged for one in found.bins) == 50
    assert all(np.isfinite(one.mean) for one in found.bins)


def test_bins_of_as_many_windows():
    speed = next(one for one in FEATURES if one.name == "speed")
    edges, _ = bins_of(speed, np.arange(100.0))
    assert np.histogram(np.arange(100.0), edges[1:-1])[0].sum() == 60
    assert len(edges) == 6
    edges, _ = bins_of(speed, np.array([1.0] * 90 + [2.0] * 10))
    assert len(edges) >= 2


def test_what_is_drawn_anew():
    table = table_of(np.ones(240), runs=8)
    groups, words = table.groups([str(k) for k in range(8)])
    assert (len(np.unique(groups)), words) == (8, "voyages")
    groups, words = table.groups(["a", "a", *map(str, range(6))])
    assert (len(np.unique(groups)), words) == (7, "voyages")
    groups, words = table_of(np.ones(240)).groups(["a"])
    assert (len(np.unique(groups)), words) == (8, "hours")


def test_an_interval_covers_what_groups_share():
    """Windows of a group are alike: the interval is that of the groups, not that of so many windows."""
    rng = np.random.default_rng(2)
    shared = np.repeat(rng.normal(size=40), 30)
    values = shared + 0.1 * rng.normal(size=1200)
    mean, interval = Draws(np.repeat(np.arange(40), 30)).mean(values, np.ones(1200, dtype=bool))
    expected = 1.96 * np.std(shared) / np.sqrt(40)
    assert mean == pytest.approx(values.mean())
    assert (interval[1] - interval[0]) / 2.0 == pytest.approx(expected, rel=0.2)
    assert Draws(np.zeros(10, dtype=np.int64)).mean(values[:10], np.ones(10, dtype=bool))[1] is None
    assert np.isnan(Draws(np.zeros(10, dtype=np.int64)).mean(values[:10], np.zeros(10, dtype=bool))[0])


def test_classes_of_the_papers_examples():
    """Table 2 of Mathioudakis et al.: two windows of each class; limits midway between them, and any others."""
    table = np.array([0.8, 0.9, 1.7, 2.3, 5.9, 8.7, np.inf, np.nan])
    names = [CLASSES[k] if k >= 0 else "" for k in classed(table, (1.3, 4.1))]
    assert names == ["optimal"] * 2 + ["satisfactory"] * 2 + ["sub-optimal"] * 3 + [""]
    assert classed(np.array([1.3, 1.31]), (1.3, 4.1)).tolist() == [0, 1]
    assert classed(table[:6], (2.0, 8.0)).tolist() == [0, 0, 0, 1, 1, 2]
