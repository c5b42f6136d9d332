"""Channels that do not count are not judged by what is left of them."""

import numpy as np
import pytest

from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.motions import simulate_trials
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import load_trials
from tests.diagnose.sensors import logged


@pytest.mark.parametrize(("channels", "verdict"), [(("x", "y", "psi"), "none"), ((), "unexplained")])
def test_a_gyro_that_is_off_is_nothing_where_the_yaw_rate_does_not_count(channels, verdict):
    """Of positions and headings alone: "no known cause accounts for it", of a yaw rate that was not to count."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(5)
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "turn_m20", "zigzag_10")]
    off = with_effects(profile, {"gyro-bias": {"rate": np.radians(0.1)}}, "made")
    made = [logged(*pair, rng) for pair in zip(trials, simulate_trials(off, trials), strict=True)]
    asked = DiagnoseOptions(channels=channels, effects=("current",), targets=("hull.R_0",), leeway=0.0)
    result = diagnose("suzaku", made, asked)
    assert result.verdict == verdict, result.sentence()
    assert [*result.to_dict()["unexplained"]["by_channel"]] == list(channels or ("x", "y", "psi", "u", "v_m", "r"))
