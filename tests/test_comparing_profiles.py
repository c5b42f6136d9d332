"""Two profiles side by side."""

import functools

import pytest

from mmgtune import ValidateOptions, compare_profiles, load_profile, load_trials, validate, write_comparison
from mmgtune.profile import tuned, with_effects
from mmgtune.report import render

pytestmark = pytest.mark.xdist_group("compared")

known = functools.cache(compare_profiles)
"""Of bundled names, once for all tests."""


@pytest.fixture(scope="module", autouse=True)
def _compiled() -> None:
    """Manoeuvres of a model that was never run are stepped, which takes ten times as long."""
    validate(["suzaku", "suzaku_fam"], load_trials("suzaku"), ValidateOptions())


def test_a_profile_against_itself_differs_in_nothing():
    found = compare_profiles("kvlcc2", "kvlcc2")
    assert found.profiles == ("kvlcc2 (1)", "kvlcc2 (2)")
    assert all(row["a"] == row["b"] for row in found.data["coefficients"])
    assert all(row["a"] == row["b"] for row in found.data["manoeuvres"]["indices"])
    assert found.data["forces"]["over_drift"]["a"] == found.data["forces"]["over_drift"]["b"]


def test_forces_are_those_of_the_equations():
    """Y_v and N_r of KVLCC2 are the slopes at the origin."""
    found = compare_profiles("kvlcc2", "suzaku").data["forces"]
    drift, yaw = found["over_drift"], found["over_yaw_rate"]
    middle = len(drift["beta_deg"]) // 2
    step = drift["beta_deg"][middle + 1] * 3.14159265 / 180.0
    assert (drift["a"]["Y"][middle + 1] - drift["a"]["Y"][middle - 1]) / (2 * step) == pytest.approx(0.315, abs=2e-3)
    middle = len(yaw["r_prime"]) // 2
    slope = (yaw["a"]["N"][middle + 1] - yaw["a"]["N"][middle - 1]) / (2 * yaw["r_prime"][middle + 1])
    assert slope == pytest.approx(-0.049, abs=1e-3)


def test_distance_counts_in_scatters_of_the_formula(tmp_path):
    fam = load_profile("suzaku_fam")
    scatter = fam.coefficient("hull.N_v").scatter
    other = tuned(fam, {"hull.N_v": fam.value("hull.N_v") - 2.0 * scatter}, {}, {})
    found = compare_profiles(fam, other)
    (row,) = [row for row in found.data["coefficients"] if row["a"] != row["b"]]
    assert row["name"] == "hull.N_v"
    assert (row["a"] - row["b"]) / row["scatter"] == pytest.approx(2.0)
    write_comparison(found, tmp_path)
    text = (render(tmp_path)[1]).read_text()
    (line,) = [line for line in text.splitlines() if line.startswith(r"| hull.N\_v ")]
    assert line.endswith("| 2.0 |")


def test_the_page_names_both_and_says_which_turns_wider(tmp_path):
    write_comparison(known("suzaku", "suzaku_fam"), tmp_path)
    html, markdown = (path.read_text() for path in render(tmp_path)[:2])
    assert "suzaku_fam turns 1.3 L_pp wider than suzaku" in html
    assert "wider to starboard" in markdown


def test_the_order_of_the_profiles_loses_no_distance():
    """The scatter of a formula is there whichever of the two knows it."""
    fam = load_profile("suzaku_fam")
    names = {name for name in fam.names() if fam.coefficient(name).scatter is not None}
    for a, b in (("suzaku_fam", "suzaku"), ("suzaku", "suzaku_fam")):
        rows = {row["name"]: row["scatter"] for row in known(a, b).data["coefficients"]}
        assert {name for name, scatter in rows.items() if scatter is not None} == names


def test_what_effects_are_set_otherwise_is_a_difference():
    """Manoeuvres in a current differed from those without, and "0 coefficients" did."""
    still = load_profile("suzaku")
    carried = with_effects(still, {"current": {"north": 1.0}}, "a test")
    rows = [row for row in compare_profiles(still, carried).data["coefficients"] if row["a"] != row["b"]]
    assert [(row["name"], row["a"], row["b"]) for row in rows] == [("effects.current.north", None, 1.0)]
    assert not any("effects" in row["name"] for row in compare_profiles(carried, carried).data["coefficients"])
