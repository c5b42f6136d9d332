"""Sensors at the end of their range: what they show there is left out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ...phrases import listed
from ...trial import Trial, TrialSet
from ...trial.checks.saturation import end_in_words
from ...trial.checks.sensor_ends import ends_of, without_ends


def within_range(trials: TrialSet, whole: Mapping[str, Trial]) -> tuple[TrialSet, dict[str, float]]:
    """The trials with gaps where a sensor is at the end of its range, and these ends by channel [m/s, rad/s].

    whole  the runs that the trials are of, which together show the ends
    """
    ends = ends_of(whole.values())
    if not ends:
        return trials, {}
    kept = {id: without_ends(trial, ends) for id, trial in trials.trials.items()}
    return replace(trials, trials=kept), {name: end.value for name, end in ends.items()}


def in_words(ended: Mapping[str, float]) -> str:
    """Which sensors end where; "" for none."""
    return listed([end_in_words(name, value) for name, value in ended.items()])
