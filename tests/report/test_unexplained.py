"""Where an error lives and what is a trace, from the numbers of a diagnosis as its record has them."""

import json

import pytest

from mmgtune.diagnose.causes.contributions import Contribution
from mmgtune.diagnose.evidence.whereabouts import whereabouts
from mmgtune.report.blocks import Picture
from mmgtune.report.figures import svg
from mmgtune.report.pages import unexplained
from tests.diagnose.test_whereabouts import run as force_run


@pytest.fixture(scope="module")
def record():
    """A record as it is read back: forces that follow the heading in runs of two headings and more."""
    forces = [force_run(f"run_<{i}>", "heading", 1, 3.0, i, float(i)) for i in range(4)]
    found = whereabouts(forces, {f"run_<{i}>": 4.0 - i for i in range(4)}, {"current": 0.3, "wind": 0.1}, {})
    return json.loads(json.dumps({"whereabouts": found.to_dict()}))


def pictures(found):
    return {block.id: block for block in found if isinstance(block, Picture)}


def test_the_section_says_and_draws_where_it_lives(record):
    found = unexplained.blocks(record)
    drawn = pictures(found)
    assert list(drawn) == ["where-and-when", "against-what", "force-histories", "removable"]
    said = " ".join(found[0].sentences)
    assert "sway force follows the heading" in said
    assert "heading [deg]" in svg.file(drawn["against-what"].figure)
    runs = svg.file(drawn["where-and-when"].figure)
    assert "run_" in runs
    assert "<0>" not in runs  # names come from files


def test_without_forces_the_runs_and_causes_are_drawn():
    found = whereabouts([], {"a": 3.0, "b": 1.0}, {"wind": 0.1}, {}).to_dict()
    assert list(pictures(unexplained.blocks({"whereabouts": found}))) == ["where-and-when", "removable"]


def test_records_without_it_have_no_section(record):
    assert unexplained.blocks({}) == []
    assert unexplained.blocks({"whereabouts": None}) == []
    assert unexplained.traces({}) == []


def test_a_trace_stands_in_a_fold_with_what_it_would_change():
    brought = Contribution(0.001, 0.0002, {"x": 0.01, "r": 0.03}, {"advance_m": 0.004, "overshoot_1_deg": 0.001})
    data = {"traces": [{"sentence": "The rudder stalled at 33.2°", "contribution": brought.to_dict()}]}
    (fold,) = unexplained.traces(data)
    assert fold.summary == "Traces (1), in no profile"
    (row,) = fold.blocks[0].rows
    assert [cell.text for cell in row] == ["The rudder stalled at 33.2°", "0.02 %", "yaw rate 3 %", "advance 0.4 %"]
    json.dumps(data, allow_nan=False)
