"""What a diagnosis says it would do is what it does."""

from dataclasses import replace

import numpy as np

from mmgtune.diagnose import plan_diagnosis
from mmgtune.diagnose.bench.hypotheses import known_causes
from mmgtune.options import DiagnoseOptions
from mmgtune.profile import with_effects
from mmgtune.trial import load_trials


def lines_of(ship, trials):
    return dict(line.split(maxsplit=1) for line in plan_diagnosis(ship, trials, DiagnoseOptions()).lines)


def test_effects_are_those_looked_for(suzaku):
    """The plan took a wind speed without a direction for measured wind."""
    trials = load_trials("suzaku")
    first = next(iter(trials.trials.values()))
    halves = replace(first, extra={**first.extra, "wind_speed": np.full(first.n_samples, 5.0)})
    trials = replace(trials, trials={first.id: halves}, tune=(first.id,), test=())
    plain, has = suzaku.profile, with_effects(suzaku.profile, {"current": {"north": 0.2}}, "test")
    for ship in (plain, has):
        looked_for = known_causes(ship, [halves], DiagnoseOptions())
        shown = lines_of(ship, trials)
        assert shown["search"].startswith(f"{len(looked_for)} hypotheses")
        assert shown["effects"].split(", ") == list(dict.fromkeys(h.tag for h in looked_for))
    assert ("wind", ("measured",)) not in [(h.tag, h.variant) for h in known_causes(plain, [halves], DiagnoseOptions())]
    assert "current" in lines_of(plain, trials)["effects"]
    assert "current" in lines_of(has, trials)["effects"]  # from what the profile has


def test_what_has_leeway_is_said(suzaku):
    shown = lines_of(suzaku.profile, load_trials("suzaku"))
    assert shown["leeway"].startswith("up to 5 % of their values: hull.X_vv, ")
    assert "particulars.m_y_" in shown["leeway"]
    assert "hull.R_0" not in shown["leeway"]
    lines = plan_diagnosis(suzaku.profile, load_trials("suzaku"), DiagnoseOptions(leeway=0.0)).lines
    assert not any(line.startswith("leeway") for line in lines)
