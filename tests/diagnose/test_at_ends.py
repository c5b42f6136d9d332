"""A ship unlike her profile in many ways: much that is re-tuned ends at an end of its range; causes are doubted."""

from types import SimpleNamespace

import pytest

from mmgtune import estimate, read_particulars
from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.diagnose.signatures.at_ends import AtEnds
from mmgtune.fitting.box import SCATTERS
from mmgtune.trial import load_trials
from tests.diagnose.beliefs import belief_with

NAMES = tuple(f"hull.{name}" for name in ("Y_v", "Y_r", "N_v", "N_r", "Y_vvv", "N_vvv", "N_rrr", "X_vv", "X_rr", "R_0"))


@pytest.mark.parametrize(("many", "formulas"), [(3, 3), (4, 4), (4, 1)])
def test_how_many_are_at_an_end_is_said_from_four_tenths_on(many, formulas):
    ends = AtEnds(NAMES[:many], NAMES[:many], len(NAMES), NAMES[:formulas])
    assert ends.unlike == bool(ends.sentence) == (many > 3)
    if ends.sentence:
        assert ends.sentence.startswith(
            "Re-tuned without any cause, 4 of 10 coefficients end at the end of their range"
        )
        assert ("formulas" in ends.sentence) == (formulas == 4)
    assert SCATTERS == 2.0  # as the sentence says


def test_few_of_few_say_nothing():
    assert not AtEnds(NAMES[:2], NAMES[:2], 3).sentence
    assert not AtEnds(NAMES[:2], NAMES[:2], 3).unlike


@pytest.mark.parametrize(("brought", "it"), [(1, "it"), (3, "them")])
def test_causes_beside_which_many_are_at_an_end_are_doubted(brought, it):
    contributions = (("rudder-gain", SimpleNamespace(seen=1.0)),) * brought
    known = {"_told_by_none": False, "_excused_by_gusts": False, "_bent": "", "contributions": contributions}
    doubted = belief_with(**known, ends=AtEnds((), NAMES[:4], len(NAMES)))
    assert doubted.unclear == f"beside {it} 4 of 10 coefficients that are re-tuned end at the end of their range"


@pytest.mark.long
def test_a_ship_unlike_the_formulas_of_her_profile_gets_no_false_cause():
    """Re-tuned, SUZAKU's profile of main dimensions misses her bundled trials; no cause is what that takes."""
    result = diagnose(
        estimate(read_particulars("suzaku")), load_trials("suzaku"), DiagnoseOptions(effects=["rudder-gain"])
    )
    assert result.verdict == "unexplained"
    assert "of 31 coefficients end at the end of their range, two standard deviations of ships" in result.sentence()
    ends = result.to_dict()["unexplained"]["at_ends"]
    assert ends["targets"] == 31
    assert "hull.X_vv" in ends["alone"]
