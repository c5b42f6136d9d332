"""The figure of what differs from voyage to voyage, from the numbers of a diagnosis."""

from __future__ import annotations

import json

import numpy as np
import pytest

from mmgtune.diagnose.legs import QUANTITIES, Difference
from mmgtune.report.differences import axis_words, draw_differences

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
    figure = draw_differences(rows)
    north, east, factor = figure.axes
    assert [ax.get_title(loc="left") or ax.get_title() for ax in figure.axes] == [
        "current north [m/s]", "current east [m/s]", "resistance factor over mean [–]",
    ]  # fmt: skip
    for ax, values in ((north, NORTH_EAST[:, 0]), (east, NORTH_EAST[:, 1])):
        (points,) = ax.containers
        told = [k for k in range(9) if k != 2]
        np.testing.assert_array_equal(points[0].get_xdata(), told)
        np.testing.assert_allclose(points[0].get_ydata(), values[told])
        (bars,) = points[2]
        ends = np.array([segment[:, 1] for segment in bars.get_segments()])
        np.testing.assert_allclose(np.diff(ends, axis=1)[:, 0], 2 * 1.96 * 0.02)
    trend = max(factor.lines, key=lambda line: np.ptp(line.get_ydata()) if line.get_linestyle() == "--" else -1.0)
    np.testing.assert_allclose(trend.get_ydata(), 1.0 + 0.03 * (np.arange(9) - 4.0))


def test_one_value_for_all_is_a_line_with_its_interval():
    (north, *_), (plain, *_) = (draw_differences(found(current=pattern)[:1]).axes for pattern in ("one", "each"))
    assert len(north.lines) == len(plain.lines) + 1
    (band,) = set(north.patches) - set(plain.patches)
    low, high = np.sort(band.get_extents().transformed(north.transData.inverted()).get_points()[:, 1])
    assert (low, high) == pytest.approx((0.05 - 1.96 * 0.01, 0.05 + 1.96 * 0.01))
