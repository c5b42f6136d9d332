"""A sensor at the end of its range is named, and what it shows there misleads nobody."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.diagnose import diagnose, write_diagnosis
from mmgtune.diagnose.answering import saying
from mmgtune.diagnose.answering.ended import in_words, within_range
from mmgtune.options import DiagnoseOptions
from mmgtune.profile import load_profile
from mmgtune.report import render
from mmgtune.trial import TrialSet, load_trials
from mmgtune.units import DEG
from tests.hidden.plant import simulate, write

OPTIONS = DiagnoseOptions(effects=("speed-scale", "log-zero", "velocity-filter", "current", "resistance"))


@pytest.fixture(scope="module")
def sailed(tmp_path_factory) -> TrialSet:
    """Trials whose speed log shows 2.6 m/s at most, with noise about that."""
    folder = tmp_path_factory.mktemp("ended")
    write(simulate({}, {}, seed=5), folder)
    trials, rng = load_trials(folder), np.random.default_rng(1)
    noise = {id: 0.02 * rng.standard_normal(one.n_samples) for id, one in trials.trials.items()}
    kept = {id: replace(one, u=np.minimum(one.u, 2.6) + noise[id]) for id, one in trials.trials.items()}
    return replace(trials, trials=kept)


def test_what_is_shown_at_the_end_counts_nothing(sailed):
    kept, ended = within_range(sailed, sailed.trials)
    assert ended == {"u": pytest.approx(2.6, abs=0.02)}
    for id, trial in kept.trials.items():
        assert not np.any(trial.u[1:] > 2.58), id
        assert trial.u[0] > 3.0  # as the positions tell, where the log shows 2.6
    plain = load_trials("suzaku")
    assert within_range(plain, plain.trials) == (plain, {})


@pytest.mark.long
def test_no_cause_is_made_of_it(sailed, tmp_path):
    result = diagnose(load_profile("suzaku"), sailed, OPTIONS)
    assert (result.verdict, result.causes) == ("none", ())
    assert result.sentence().startswith("The speed log ends at 2.6 m/s. Apart from that: ")
    assert any("what it shows there is left out" in one for one in result.warnings)
    write_diagnosis(result, tmp_path / "run")
    assert "a sensor at the end of its range" in render(tmp_path / "run")[0].read_text()


@pytest.mark.parametrize(
    ("ended", "said"),
    [
        ({}, ""),
        ({"u": 2.604}, "the speed log ends at 2.6 m/s"),
        (
            {"u": 2.6, "r": 0.5 * DEG},
            "the speed log ends at 2.6 m/s and the yaw rate ends at 0.5 deg/s (30 deg/min)",
        ),
    ],
)
def test_ends_in_words(ended, said):
    assert in_words(ended) == said


def test_it_is_said_before_what_cannot_be_named(monkeypatch):
    monkeypatch.setattr(saying, "_of_the_unknown", lambda answer: saying.Said("Something is wrong.", "Why."))
    answer = SimpleNamespace(
        between=(),
        together=None,
        verdict="unexplained",
        contradicted="",
        jumped={"a": 12.0},
        ended={"u": 2.6},
        causes=(),
        wrong_logs={},
        ends=None,
        options=DiagnoseOptions(),
    )
    first, why, *_ = saying.said(answer)
    assert first == (
        "The position jumps in a by 12 m; the speed log ends at 2.6 m/s. Apart from that: Something is wrong."
    )
    assert why == "Why."
