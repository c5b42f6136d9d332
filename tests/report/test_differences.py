"""The figure of what differs from voyage to voyage, from the numbers of a diagnosis."""

from __future__ import annotations

import json

import numpy as np
import pytest

from mmgtune.diagnose.voyages.difference import QUANTITIES, Difference
from mmgtune.report.figures.differences import axis_words, differences
from mmgtune.report.figures.plot import Bar, Dots, Line

CURRENT, RESISTANCE = QUANTITIES
VOYAGES = tuple(f"voyage_{k:02d}" for k in range(1, 10))
NORTH_EAST = np.column_stack([np.linspace(-0.3, 0.3, 9), np.full(9, 0.1)])


def found(**pattern):
    """Two quantities of nine voyages; the windows of the third say nothing of the current."""
    stderr = np.full((9, 2), 0.02)
    stderr[2] = np.nan
    current = Difference(
        CURRENT, pattern.get("current", "each"), {}, "m/s", VOYAGES, NORTH_EAST, stderr,
        ((0.05, 0.01), (0.1, 0.01)), (), False, 0.8,
    )  # fmt: skip
    values = 1.0 + 0.03 * (np.arange(9.0)[:, None] - 4.0)
    resistance = Difference(
        RESISTANCE, pattern.get("resistance", "trend"), {}, "-", VOYAGES, values, np.full((9, 1), 0.01), None,
        ((0.03, 0.002),), True, 0.6,
    )  # fmt: skip
    return [json.loads(json.dumps(one.to_dict(), allow_nan=False)) for one in (current, resistance)]


def test_a_panel_for_each_parameter_with_its_unit():
    rows = found()
    assert axis_words(rows[0], "north") == "current north [m/s]"
    assert axis_words(rows[1], "factor") == "resistance factor over mean [–]"
    north, east, factor = differences(rows).panels
    assert [panel.title for panel in (north, east, factor)] == [
        "current north [m/s]", "current east [m/s]", "resistance factor over mean [–]",
    ]  # fmt: skip
    for panel, values in ((north, NORTH_EAST[:, 0]), (east, NORTH_EAST[:, 1])):
        (points,) = (mark for mark in panel.marks if isinstance(mark, Dots))
        told = [k for k in range(9) if k != 2]
        np.testing.assert_array_equal(points.x, told)
        np.testing.assert_allclose(points.y, values[told])
        bars = np.array([mark.y for mark in panel.marks if isinstance(mark, Line)])
        np.testing.assert_allclose(np.diff(bars, axis=1)[:, 0], 2 * 1.96 * 0.02)
    (trend,) = (mark for mark in factor.marks if isinstance(mark, Line) and mark.look.dash)
    np.testing.assert_allclose(trend.y, 1.0 + 0.03 * (np.arange(9) - 4.0))


def test_one_value_for_all_is_a_line_with_its_interval():
    (north, *_), (plain, *_) = (differences(found(current=pattern)[:1]).panels for pattern in ("one", "each"))
    assert len(north.marks) == len(plain.marks) + 2
    (band,) = (mark for mark in north.marks if isinstance(mark, Bar))
    assert band.y == pytest.approx((0.05 - 1.96 * 0.01, 0.05 + 1.96 * 0.01))
