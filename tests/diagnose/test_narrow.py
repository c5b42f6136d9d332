"""A ship further from her profile than the box of the targets lets them go."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.diagnose import DiagnoseOptions
from mmgtune.diagnose.bench.workbench import make_workbench
from mmgtune.diagnose.searching import narrow
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.diagnose.searching.narrow import narrow_box
from mmgtune.diagnose.searching.search import Found
from mmgtune.motions import simulate_trials
from mmgtune.profile import tuned
from mmgtune.trial import load_trials
from tests.diagnose.sensors import logged


@pytest.mark.daily("inside")
@pytest.mark.parametrize(("times", "said"), [(1.8, True), (1.3, False)], ids=["beyond the box", "inside"])
def test_a_resistance_beyond_the_box_is_said(suzaku, monkeypatch, times, said):
    profile = suzaku.profile
    fouled = tuned(profile, {"hull.R_0": times * profile.value("hull.R_0")}, {}, {}, "made")
    rng = np.random.default_rng(1)
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "turn_m20", "zigzag_20")]
    made = []
    for trial, motion in zip(trials, simulate_trials(fouled, trials, integrator=Integrator("rk4")), strict=True):
        made.append(logged(trial, motion, rng))
    bench = make_workbench(profile, made, DiagnoseOptions())
    base = base_fit(bench)
    explained = replace(base, chi2=min(base.chi2, float(bench.problem.n_residuals)) - 30.0)  # as causes would
    warnings = narrow_box(bench, Found(base, explained))
    assert len(warnings) == said
    if said:
        assert "hull.R_0 8" in warnings[0]
        assert "% above the profile's value" in warnings[0]
        assert warnings[0].endswith("look again with a_r=1")
        monkeypatch.setattr(narrow, "FEW", 0)
        assert narrow_box(bench, Found(base, explained)) == []  # where it takes more of them than a ship may have
    assert narrow_box(bench, Found(base, base)) == []
