"""Where an error lives and what is a trace, from the numbers of a diagnosis as its record has them."""

import json

import pytest
from mmgtune.report.page import Picture

from mmgtune.diagnose.contributions import Contribution
from mmgtune.diagnose.whereabouts import whereabouts
from mmgtune.report import unexplained
from tests.diagnose.test_whereabouts import run as force_run

pytestmark = pytest.mark.slow(3)


@pytest.fixture(scope="module")
def record():
    """A record as it is read back: forces that follow the heading in runs of two headings and more."""
    forces = [force_run(f"run_<{i}>", "heading", 1, 3.0, i, float(i)) for i in range(4)]
    found = whereabouts(forces, {f"run_<{i}>": 4.0 - i for i in range(4)}, {"current": 0.3, "wind": 0.1})
    return json.loads(json.dumps({"whereabouts": found.to_dict()}))


def test_the_section_says_and_draws_where_it_lives(record):
    drawings = {}
    section = unexplained.section(record, drawings)
    assert list(drawings) == ["where-and-when", "against-what", "force-histories", "removable"]
    assert [block.id for block in section.blocks if isinstance(block, Picture)] == list(drawings)
    said = " ".join(section.blocks[0].sentences)
    assert "sway force follows the heading" in said
    texts = drawings["against-what"].svg
    assert "heading [deg]" in texts
    assert "run_" in drawings["where-and-when"].svg
    assert "<0>" not in drawings["where-and-when"].svg  # names come from files


def test_without_forces_the_runs_and_causes_are_drawn():
    found = whereabouts([], {"a": 3.0, "b": 1.0}, {"wind": 0.1}).to_dict()
    drawings = {}
    section = unexplained.section({"whereabouts": found}, drawings)
    assert section is not None
    assert list(drawings) == ["where-and-when", "removable"]


def test_records_without_it_have_no_section(record):
    assert unexplained.section({}, {}) is None
    assert unexplained.section({"whereabouts": None}, {}) is None
    assert unexplained.traces({}) == []


def test_a_trace_stands_in_a_fold_with_what_it_would_change():
    brought = Contribution(0.001, 0.0002, {"x": 0.01, "r": 0.03}, {"advance_m": 0.004, "overshoot_1_deg": 0.001})
    data = {"traces": [{"sentence": "The rudder stalled at 33.2°", "contribution": brought.to_dict()}]}
    (fold,) = unexplained.traces(data)
    assert fold.summary == "Traces (1), in no profile"
    (row,) = fold.blocks[0].rows
    assert [cell.text for cell in row] == ["The rudder stalled at 33.2°", "0.02 %", "yaw rate 3 %", "advance 0.4 %"]
    json.dumps(data, allow_nan=False)
