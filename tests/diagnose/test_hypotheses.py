"""Which causes a diagnosis looks for: those that act on what trials have measured, or what stands in for it."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.diagnose.hypotheses import known_causes
from mmgtune.options import DiagnoseOptions
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import load_trials

MEASURED = {
    "wind": ("wind_speed", "wind_dir"),
    "current": ("current_speed", "current_dir"),
    "waves": ("wave_height", "wave_dir"),
    "shallow-water": ("depth",),
}


@pytest.fixture(scope="module")
def trials():
    return list(load_trials("suzaku").trials.values())[:2]


def variants(trials, tag, profile="suzaku"):
    found = known_causes(load_profile(profile), trials, DiagnoseOptions())
    return [one.variant for one in found if one.tag == tag]


@pytest.mark.parametrize("tag", MEASURED)
def test_measured_in_any_trial_is_what_is_looked_for(trials, tag):
    n = trials[0].n_samples
    seen = replace(trials[0], extra={name: np.full(n, 6.0) for name in MEASURED[tag]})
    assert variants([seen, trials[1]], tag) == [("measured",)]
    others = [other for other in MEASURED if other != tag]
    assert all(("measured",) not in variants([seen, trials[1]], other) for other in others)


def test_without_columns_the_constants_are(trials):
    assert variants(trials, "wind") == [("speed", "direction")]
    assert variants(trials, "current") == [("north", "east"), ("north", "east", "north_rate", "east_rate")]
    assert variants(trials, "shallow-water") == [("depth",)]
    assert variants(trials, "waves") == []


def test_what_the_profile_has_already_is_not_looked_for(trials):
    n = trials[0].n_samples
    seen = replace(trials[0], extra={name: np.full(n, 0.5) for name in MEASURED["current"]})
    own = with_effects(load_profile("suzaku"), {"current": {"measured": 1.0}}, "a test")
    assert "current" not in {one.tag for one in known_causes(own, [seen], DiagnoseOptions())}
