"""A clock that runs fast, seen as scales of two sensors."""

import re
from dataclasses import replace

import pytest

from mmgtune import DiagnoseOptions, diagnose
from mmgtune.diagnose.answering.one_clock import clock_rate
from mmgtune.diagnose.causes.cause import Cause
from mmgtune.diagnose.signatures.intervals import Estimate
from mmgtune.effects import find_effect
from mmgtune.trial import TrialSet
from tests.hidden.plant import TUNING, WHITE, simulate


def scale(tag, name, value, stderr):
    effect = find_effect(tag)
    size = Estimate(name, value, value - 2.0 * stderr, value + 2.0 * stderr, stderr)
    return Cause(tag, effect, {f"{effect.kind}.{name}": size}, 0.0, None)


@pytest.mark.parametrize(
    ("log", "gyro", "rate"),
    [
        ((1.015, 0.0007), (1.0145, 0.0015), "1.5 % fast"),
        ((0.98, 0.001), (0.98, 0.001), "2 % slow"),
        ((1.015, 0.0007), (1.030, 0.0015), ""),
        ((1.015, 0.0007), (0.985, 0.0015), ""),
        ((1.002, 0.001), (1.002, 0.001), ""),
    ],
)
def test_scales_that_are_off_alike_may_be_a_clock(log, gyro, rate):
    causes = [scale("gyro-scale", "factor", *gyro), scale("speed-scale", "both", *log)]
    said = clock_rate(causes)
    assert (rate in said) if rate else not said
    assert not clock_rate(causes[:1])
    assert not clock_rate([causes[0], scale("speed-scale", "factor", *log)])  # of one speed alone


@pytest.mark.long
def test_a_clock_that_runs_fast_is_told():
    trials = [replace(one, t=1.02 * one.t) for one in simulate({}, {}, 3, WHITE) if one.id in TUNING]
    answer = diagnose("suzaku", TrialSet(trials, [one.id for one in trials], []), DiagnoseOptions())
    assert {cause.tag for cause in answer.causes} == {"speed-scale", "gyro-scale"}
    (rate,) = re.findall(r"a clock of the logger that runs ([0-9.]+) % fast would do the same", answer.sentence())
    assert float(rate) == pytest.approx(2.0, abs=0.3)
