"""Particles whose drawing was stopped, and goes on: of generated trials that are bundled."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import count

import numpy as np
import pytest

from mmgtune.errors import OptionError, TrialError
from mmgtune.hooks import Hooks
from mmgtune.options import PosteriorOptions, PredictOptions
from mmgtune.posterior import plan_posterior, posterior, write_posterior
from mmgtune.posterior.local import Windowed
from mmgtune.posterior.room import make_room
from mmgtune.predicting import predict
from mmgtune.profile import load_profile
from mmgtune.resources import folder
from mmgtune.run_files import POSTERIOR_JOURNAL
from mmgtune.simulating import simulate
from mmgtune.trial import load_trials
from mmgtune.validating import validate
from tests.command import run

NARROW = ("wind", "wave-drift", "discrepancy", "loading", "current", "resistance", "flap", "antenna")
OPTIONS = PosteriorOptions(particles=20, without=NARROW)


@pytest.fixture(scope="module")
def trials():
    """One turn to each side."""
    return replace(load_trials(folder("trials") / "suzaku"), tune=("turn_m20", "turn_p35"))


@pytest.fixture
def searched(monkeypatch):
    """Where slopes were worked out."""
    found: list[np.ndarray] = []
    plain = Windowed.linearised
    monkeypatch.setattr(Windowed, "linearised", lambda self, z: found.append(z) or plain(self, z))
    return found


def after(phases: int) -> Hooks:
    """Stops as a phase of that number begins."""
    counted = count()
    reached = [0]

    def on_phase(_: str) -> None:
        reached[0] = next(counted)

    return Hooks(on_phase=on_phase, stop=lambda: reached[0] >= phases)


def foretold(folder):
    return predict(folder, options=PredictOptions(turn=("20",), particles=4))


def test_what_was_stopped_gives_the_best_so_far_and_goes_on_to_the_same(tmp_path, trials, searched):
    said: list[str] = []
    expected = posterior("suzaku", trials, OPTIONS, hooks=Hooks(on_phase=said.append))
    assert sum("without a part" in words for words in said) == 2
    in_all = len(searched)
    for phases in (2, 4):
        tmp_path = tmp_path / str(phases)
        tmp_path.mkdir()
        stopped = posterior("suzaku", trials, OPTIONS, hooks=after(phases), folder=tmp_path)
        assert stopped.interrupted
        assert "Stopped before its end" in " ".join(stopped.warnings)
        assert write_posterior(stopped, tmp_path)["interrupted"]
        assert (tmp_path / POSTERIOR_JOURNAL).is_file()
        (scored,) = validate(tmp_path, trials).profiles
        for notes in (foretold(tmp_path).notes, scored.notes, simulate(tmp_path, trials).notes):
            assert any("stopped before its end" in note for note in notes)

        searched.clear()
        resumed = posterior("suzaku", trials, OPTIONS, folder=tmp_path, resume=True)
        assert len(searched) < in_all - 2  # what was done is not done again
        assert not resumed.interrupted
        assert np.array_equal(resumed.particles.values, expected.particles.values)
        assert resumed.sized.covered == expected.sized.covered
        write_posterior(resumed, tmp_path, overwrite=True)
        assert not any("stopped before its end" in note for note in foretold(tmp_path).notes)
        assert not (tmp_path / POSTERIOR_JOURNAL).exists()


def test_other_choices_do_not_go_on_with_it(tmp_path, trials):
    posterior("suzaku", trials, OPTIONS, hooks=after(1), folder=tmp_path)
    other = PosteriorOptions(particles=30, without=NARROW)
    with pytest.raises(OptionError, match=r"particles \(30, was 20\)"):
        posterior("suzaku", trials, other, folder=tmp_path, resume=True)


def test_the_plan_says_what_would_be_left_out():
    plan = plan_posterior("suzaku", "suzaku", OPTIONS)
    assert f"{len(make_room(load_profile('suzaku'), without=NARROW))} numbers" in str(plan)
    assert "starboard turning" in str(plan)
    assert "5 parts" in str(plan)
    assert plan_posterior("suzaku", "suzaku", replace(OPTIONS, leave_out=False)).seconds[1] < plan.seconds[1]


def test_what_it_would_refuse_has_no_plan(trials):
    with pytest.raises(TrialError, match="no time series to learn from"):
        plan_posterior("suzaku", replace(trials, tune=()), OPTIONS)


@pytest.mark.long
def test_particles_lie_beside_what_is_in_the_folder_and_are_not_replaced_unasked(tmp_path):
    trial = str(folder("trials") / "suzaku" / "turn_p35.parquet")
    few = ("posterior", "-t", trial, "--without", ",".join(NARROW), "--particles", "20", "--quiet", "--out", "here")
    planned = run(*few, "--dry-run", cwd=tmp_path)
    assert planned.code == 0
    assert "particles.parquet, posterior.json" in planned.out
    assert not (tmp_path / "here").exists()
    none = run(*few, "--resume", cwd=tmp_path)
    assert none.code == 2
    assert "nothing to resume" in none.err
    assert not (tmp_path / "here").exists()

    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "fit.json").write_text("{}")
    (tmp_path / "here" / "journal.jsonl").write_text("of a fit")
    assert run(*few, cwd=tmp_path).code == 0
    assert json.loads((tmp_path / "here" / "posterior.json").read_text())["interrupted"] is False
    assert (tmp_path / "here" / "fit.json").read_text() == "{}"
    assert (tmp_path / "here" / "journal.jsonl").read_text() == "of a fit"
    assert not (tmp_path / "here" / POSTERIOR_JOURNAL).exists()
    refused = run(*few, cwd=tmp_path)
    assert refused.code == 2
    assert "the output exists already" in refused.err
    assert run(*few, "--force", cwd=tmp_path).code == 0
