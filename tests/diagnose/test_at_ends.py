"""A ship unlike her profile in many ways: much that is re-tuned ends at an end of its range; causes are doubted."""

from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune import estimate, read_particulars
from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.diagnose.answering.saying import _at_ends
from mmgtune.diagnose.bench.beliefs import FURTHEST
from mmgtune.diagnose.bench.workbench import Point, make_workbench
from mmgtune.diagnose.causes.cause import Cause
from mmgtune.diagnose.signatures.at_ends import BEYOND, AtEnds
from mmgtune.diagnose.signatures.intervals import Estimate
from mmgtune.effects import find_effect
from mmgtune.trial import load_trials
from tests.diagnose.beliefs import belief_with

NAMES = tuple(f"hull.{name}" for name in ("Y_v", "Y_r", "N_v", "N_r", "Y_vvv", "N_vvv", "N_rrr", "X_vv", "X_rr", "R_0"))


@pytest.mark.parametrize("many", [3, 4])
def test_four_tenths_at_the_end_of_their_range_are_said(many):
    ends = AtEnds(NAMES[:many], NAMES[:many], len(NAMES))
    assert ends.unlike == bool(ends.first) == bool(ends.why("")) == (many > 3)
    assert not AtEnds(NAMES[:2], NAMES[:2], 3).unlike  # few of few
    if many > 3:
        assert ends.first.startswith("This ship may be unlike her profile in many ways, ")
        assert ends.why("") == "Re-tuned without any cause, 4 of 10 coefficients end at the end of their range."


@pytest.mark.parametrize("many", [4, 5])
def test_of_targets_from_formulas_a_few_are_enough(many):
    """Without the causes they are bent by what is wrong: beside them counts."""
    ends = AtEnds(NAMES, NAMES[:many], 30, 25)
    assert ends.unlike == (many > 4)
    if many > 4:
        assert ends.first.startswith("This ship is unlike those that the formulas of her profile are from, ")
        assert ends.why("").startswith(
            "5 of 30 coefficients that are re-tuned end beyond two standard deviations of ships about their formulas. "
        )
        assert ends.why(f"beside it {ends.words}").startswith("What her own tests, ")
    else:
        assert ends.first == ends.why("") == ""
    assert BEYOND == 2.0  # as the sentence says


@pytest.mark.parametrize(
    ("of_logs", "brought", "why"),
    [
        ((False,), 1, "beside it 4 of 10 coefficients that are re-tuned end at the end of their range"),
        ((False, True), 3, "beside them 4 of 10 coefficients that are re-tuned end at the end of their range"),
        ((True,), 1, ""),
        ((False,), 0, ""),
    ],
    ids=["one", "several", "an error of a log, which is told by the log itself", "how a log is read"],
)
def test_causes_beside_which_many_are_at_an_end_are_doubted(of_logs, brought, why):
    causes = tuple(SimpleNamespace(of_logs=one, sized=True, at_ends=False, runs=None, effect=None) for one in of_logs)
    contributions = (("rudder-gain", SimpleNamespace(seen=1.0)),) * brought
    gain = SimpleNamespace(share_removed=0.9)
    left = SimpleNamespace(unknown=0.0, structured=False)
    known = {"_told_by_none": False, "_excused_by_gusts": False, "_bent": "", "contributions": contributions}
    known |= {"causes": causes, "gain": gain, "leftover": left, "_n_terms": 1, "_faint": False}
    ends, told = AtEnds((), NAMES[:4], len(NAMES)), {"explained_share": 0.999, "leaves_open": False}
    assert belief_with(**known, **told, ends=ends).unclear == why
    gain.share_removed = 0.99
    assert belief_with(**known, **told, ends=ends).unclear == why


@pytest.mark.parametrize(
    ("explained", "removed", "leaves_open", "formulas", "stands"),
    [
        (0.999, 0.99, False, 8, True),  # a wind of 9 m/s, in which coefficients from formulas are tuned a little off
        (0.999, 0.99, False, 0, False),
        (0.999, 0.99, True, 8, False),  # waves, excused by what inputs leave open, of a wind whose vane is off
        (0.99, 0.99, False, 8, False),
        (0.999, 0.9, False, 8, False),
    ],
)
def test_what_tells_all_of_the_error_stands_beside_formulas_that_are_off(
    explained, removed, leaves_open, formulas, stands
):
    causes, ends = (SimpleNamespace(of_logs=False),), AtEnds((), NAMES[:4], len(NAMES), formulas)
    gain = SimpleNamespace(share_removed=removed)
    one = belief_with(causes=causes, ends=ends, gain=gain, explained_share=explained, leaves_open=leaves_open)
    assert one._stands_beside_all is stands


@pytest.mark.parametrize(("formulas", "brought"), [(8, 2), (8, 1), (0, 2)])
def test_a_term_that_a_hull_from_formulas_lacks_is_believed_alone(formulas, brought):
    """Of a hull of another form "the rudder stood 0.9 deg to starboard (true: 1.5), and moved by 0.64 times"."""
    effects = (find_effect("hull-term"), find_effect("rudder-offset"))[:brought]
    causes = tuple(SimpleNamespace(of_logs=False, sized=True, at_ends=False, runs=None, effect=one) for one in effects)
    known = {"_told_by_none": False, "_excused_by_gusts": False, "_bent": "", "_n_terms": 1, "_faint": False}
    known |= {"causes": causes, "contributions": tuple((one.tag, SimpleNamespace(seen=1.0)) for one in effects)}
    known |= {"gain": SimpleNamespace(share_removed=0.9), "leftover": SimpleNamespace(unknown=0.0, structured=False)}
    unclear = belief_with(**known, ends=AtEnds((), (), 10, formulas)).unclear
    assert ("hull that is from formulas" in unclear) == (formulas > 0 and brought > 1)


def test_targets_from_formulas_are_held_by_what_these_expect():
    """Two runs tell few of thirty coefficients: the others were 53 times the noise off on the run left out."""
    ship, trials = estimate(read_particulars("suzaku")), list(load_trials("suzaku").trials.values())[:2]
    bench = make_workbench(ship, trials, DiagnoseOptions())
    (k,) = (k for k, name in enumerate(bench.targets) if name == "hull.X_vv")
    known, box = bench.believed.formulas["hull.X_vv"], bench.sub_box(bench.targets)
    assert known * box.width[k] == pytest.approx(ship.coefficient("hull.X_vv").scatter)
    assert box.width[k] == pytest.approx(2.0 * FURTHEST * ship.coefficient("hull.X_vv").scatter)
    there = bench.null(bench.targets)
    there[k] += 3.0 * known
    (far,) = AtEnds.of(
        bench, *[Point(bench.targets, there, np.zeros((2, 6)), 1.0, bench.problem.integrator)] * 2
    ).beside
    assert far == "hull.X_vv"
    rows, centre = bench.beliefs(bench.targets, {})
    assert np.sum((rows @ (there - centre)) ** 2) == pytest.approx(9.0)
    loose = bench.believed.leeway["particulars.m_x_"] * bench.sub_box(["particulars.m_x_"]).width[0]
    assert loose == pytest.approx(ship.coefficient("particulars.m_x_").scatter)
    assert not make_workbench(ship, trials, DiagnoseOptions(a_r=0.5)).believed.formulas


@pytest.mark.long
def test_a_ship_unlike_the_formulas_of_her_profile_gets_no_false_cause():
    """Re-tuned, SUZAKU's profile of main dimensions misses her bundled trials; no cause is what that takes."""
    ship, options = estimate(read_particulars("suzaku")), DiagnoseOptions(effects=["rudder-gain"])
    result = diagnose(ship, load_trials("suzaku"), options)
    assert result.verdict == "unexplained"
    document = result.to_dict()
    assert document["headline"].startswith("This ship is unlike those that the formulas of her profile are from, ")
    assert "of 31 coefficients that are re-tuned end beyond two standard deviations of ships" in result.sentence()
    assert document["unexplained"]["at_ends"]["targets"] == 31
    assert "31 targets from formulas" in [one["name"] for one in document["assumptions"]]


@pytest.mark.parametrize("has", [{"N_rrr": -0.008}, {}])
def test_a_term_that_the_profile_has_is_not_lacking(has):
    term = Estimate("effects.hull-term.N_rrr", -0.0033, -0.0039, -0.0027, 0.0003)
    said = Cause("hull-term", find_effect("hull-term"), {term.name: term}, 0.0, None, has=has).sentence
    if has:
        assert (
            said == "The coefficient of the term N_rrr of the hull is off by -0.00330 ± 0.00060: the profile has -0.008"
        )
    else:
        assert said.startswith("The hull force lacks a term N_rrr of -0.0033")


@pytest.mark.parametrize(("value", "told"), [(0.5, True), (0.6, False)])
def test_a_size_at_the_end_of_what_was_looked_for_says_so(value, told):
    """A rudder logged in per cent of 35 deg and read in degrees moved by 0.5 times its angle, and by 0.35 in truth."""
    gain = Estimate("effects.rudder-gain.factor", value, 0.5, value + 0.014, 0.007, at_end=told)
    cause = Cause("rudder-gain", find_effect("rudder-gain"), {gain.name: gain}, 0.0, None)
    words = _at_ends(SimpleNamespace(causes=(cause,)))
    assert ("rudder-gain is at the end of what was looked for" in words) == told
