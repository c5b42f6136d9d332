"""A log that holds its inputs between updates is named as what it is, and not as a clock or a gear that is late."""

import pytest

from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials
from tests.hidden.cases import null
from tests.hidden.plant import simulate, write

LATE = ("clock-offset", "dead-time", "steering-lag")


@pytest.mark.long
@pytest.mark.parametrize(
    "besides",
    [{}, {"clock-offset": {"seconds": 4.0}}],
    ids=["alone", "and a late clock"],
)
def test_inputs_logged_now_and_then_are_named(besides, tmp_path):
    case = null(4)
    hidden = {"unknown-controls-held": {"magnitude": 6.0}, **besides}
    write(simulate(case.ship, hidden, case.seed, case.noise), tmp_path)
    result = diagnose(load_profile("suzaku"), load_trials(tmp_path), DiagnoseOptions(effects=LATE))
    assert [cause.tag for cause in result.causes] == ["inputs-held", *besides]
    assert "rudder angle every 6 s" in result.sentence()
    assert result.verdict == "found"
    assert result.chi2[0] > 1.1
    assert result.chi2[1] < 1.1
    for tag, own in besides.items():
        sizes = next(one for one in result.to_dict()["causes"] if one["effect"] == tag)["parameters"]
        assert sizes["seconds"]["value"] == pytest.approx(own["seconds"], abs=0.5)
