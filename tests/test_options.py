"""Choices as a program gives them: of their kind, and within what a machine can do."""

import inspect
import json
import math
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.diagnose.evidence.leftover import _explained
from mmgtune.errors import OptionError
from mmgtune.options import (
    CheckOptions,
    DiagnoseOptions,
    EnsembleOptions,
    FitOptions,
    HeadingOptions,
    HybridOptions,
    LearnOptions,
    LeaveOutOptions,
    SimulateOptions,
    SweepOptions,
    ValidateOptions,
)
from mmgtune.options.choice import choices
from mmgtune.trial import load_trials


@pytest.mark.parametrize(
    ("of", "given"),
    [
        (FitOptions, {"starts": 2.5}),
        (FitOptions, {"starts": "2"}),
        (FitOptions, {"starts": True}),
        (FitOptions, {"seed": 1.0}),
        (FitOptions, {"substeps": 1.5}),
        (FitOptions, {"substeps": None}),
        (FitOptions, {"a_r": "0.5"}),
        (FitOptions, {"seed": None}),
        (FitOptions, {"identifiable": 1}),
        (FitOptions, {"method": 3}),
        (FitOptions, {"method": ["cma-es"]}),
        (FitOptions, {"targets": "R_0"}),
        (FitOptions, {"targets": (3,)}),
        (FitOptions, {"window": (1.0,)}),
        (FitOptions, {"window": ("a", "b")}),
        (SweepOptions, {"widths": 0.5}),
        (SweepOptions, {"widths": ("0.5",)}),
        (LeaveOutOptions, {"folds": 2.5}),
        (DiagnoseOptions, {"most": 2.5}),
        (DiagnoseOptions, {"effects": "current"}),
        (ValidateOptions, {"restart": "100"}),
        (SimulateOptions, {"turn": (True,)}),
        (SimulateOptions, {"speed": 7}),
        (CheckOptions, {"metrics": ("J", 1)}),
        (FitOptions, {"window": (0.0, 10**400)}),
        (HeadingOptions, {"gain_step": 10**400}),
        (HeadingOptions, {"gain_most": 10**400}),
    ],
)
def test_of_another_kind(of, given):
    (name,) = given
    with pytest.raises(OptionError) as error:
        of(**given)
    assert error.value.problems[0].where == name
    assert "give" in error.value.problems[0].fix


@pytest.mark.parametrize(
    ("of", "given", "meant"),
    [
        (FitOptions, {"window": "0:100"}, "window=(0.0, 100.0)"),
        (SweepOptions, {"widths": "0.2,0.3"}, "widths=(0.2, 0.3)"),
        (SweepOptions, {"widths": "0.2"}, "widths=(0.2,)"),
        (FitOptions, {"targets": "R_0"}, "targets=('R_0',)"),
    ],
)
def test_a_text_for_a_tuple_is_answered_with_one_that_works(of, given, meant):
    with pytest.raises(OptionError) as error:
        of(**given)
    assert error.value.problems[0].fix.endswith(f": {meant}")
    (name,) = given
    of(**{name: eval(meant.partition("=")[2])})


def test_of_a_kind_that_does():
    found = FitOptions(
        starts=np.int64(3), a_r=1, restart=np.float32(100.0), targets=["R_0"], window=[0, math.inf], every=None
    )
    assert found.starts == 3
    assert (type(found.starts), type(found.restart)) == (int, float)
    json.dumps(found.to_dict())
    widths = SweepOptions(widths=[np.float32(0.25), 1]).widths
    assert [type(width) for width in widths] == [float, int]


@pytest.mark.parametrize(
    ("of", "given", "limit"),
    [
        (FitOptions, {"starts": 10**9}, "1000 or less"),
        (FitOptions, {"substeps": 10**9}, "1000 or less"),
        (FitOptions, {"regularise": 1e308, "method": "least-squares"}, "1e+06 or less"),
        (FitOptions, {"restart": 1e-308}, "0.01 or more"),
        (FitOptions, {"every": 1e-308}, "0.01 or more"),
        (FitOptions, {"seed": 10**400}, "or less"),
        (LeaveOutOptions, {"folds": 10**9}, "1000 or less"),
        (DiagnoseOptions, {"restart": 1e-308}, "0.01 or more"),
        (ValidateOptions, {"substeps": 10**400}, "1000 or less"),
    ],
)
def test_work_without_end_is_refused_with_its_limit(of, given, limit):
    with pytest.raises(OptionError) as error:
        of(**given)
    assert limit in error.value.problems[0].fix


def test_windows_too_short_for_slow_errors():
    """Whether one part of the time explains another cannot be said of them; it ended a diagnosis as a bug."""
    trials = list(load_trials("suzaku").in_windows(2.0).trials.values())
    residuals = [np.ones((trial.n_samples, 6)) for trial in trials]
    assert _explained(SimpleNamespace(trials=trials), residuals, ["x", "psi"])[0] == {}


def test_few_updates_need_no_other_option():
    for kind in (LearnOptions, HybridOptions, EnsembleOptions):
        assert kind(steps=5).problems() == []


@pytest.mark.parametrize(
    ("given", "same"),
    [
        ({"turn": 35}, {"turn": ("35",)}),
        ({"turn": [35, -12.5, "0.61 rad"]}, {"turn": ("35", "-12.5", "0.61 rad")}),
        ({"turn": np.float64(35.0), "rpm": 106}, {"turn": ("35",), "rpm": "106"}),
        ({"stop": True, "astern": 60.0}, {"stop": True, "astern": "60"}),
    ],
)
def test_numbers_stand_for_the_texts_that_mean_the_same(given, same):
    assert SimulateOptions(**given) == SimulateOptions(**same)


@pytest.mark.parametrize("given", [20, (20, 20), "20/20"])
def test_a_zigzag_that_is_no_list_of_texts_is_told_what_one_is(given):
    with pytest.raises(OptionError, match="20/20"):
        SimulateOptions(zigzag=given)


def test_options_say_what_they_are_where_one_asks():
    """``help`` and Shift-Tab in a notebook showed ``*given: Any, **named: Any`` and not one meaning."""
    shown = inspect.signature(FitOptions)
    assert shown.parameters["starts"].default == 20
    assert {one.kind for one in shown.parameters.values()} == {inspect.Parameter.KEYWORD_ONLY}
    said = inspect.getdoc(FitOptions)
    assert said.startswith("All choices of a fit")
    for name, one in choices(FitOptions).items():
        assert f"\n{name}: {one.help}" in said
    assert "One of: cma-es, least-squares." in said
