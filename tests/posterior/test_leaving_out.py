"""Bands of runs left out come from the other runs alone, and a stopped run goes on to the same numbers."""

import json
import sys

import pytest

from mmgtune.cli.leave_out import summary
from mmgtune.fitting import Hooks
from mmgtune.options import LeaveOutOptions, PosteriorOptions
from mmgtune.posterior import leave_out_with_bands, posterior
from mmgtune.posterior.leaving_out import _noted, _recalled, foretold
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials
from tests.command import run

OPTIONS = LeaveOutOptions(a_r=0.5, starts=1, folds=2, targets=("hull.Y_v", "hull.N_v", "hull.N_r"))

pytestmark = pytest.mark.xdist_group("bands left out")


@pytest.fixture(scope="module")
def whole():
    return leave_out_with_bands("suzaku", "suzaku", OPTIONS)


@pytest.mark.long
def test_every_run_is_held_against_bands_that_have_not_seen_it(whole, monkeypatch):
    trials = load_trials("suzaku")
    assert set(whole.bands.by_run) == set(trials.tune)
    assert whole.bands.by_kind[""].windows == len(trials.tune)
    assert 0.5 < whole.bands.by_kind[""].covers(0.9) <= 1.0
    seen = []
    monkeypatch.setattr(
        sys.modules[leave_out_with_bands.__module__],
        "posterior",
        lambda profile, some, options: seen.append({one.id for one in some}) or posterior(profile, some[:1], options),
    )
    again = leave_out_with_bands("suzaku", "suzaku", OPTIONS)
    for others, part in zip(seen, again.parts, strict=True):
        assert others
        assert not others & set(part)
        assert others | set(part) == set(trials.tune)


@pytest.mark.long
def test_stopped_and_resumed_is_the_same(whole, tmp_path):
    said = []
    stopped = leave_out_with_bands(
        "suzaku",
        "suzaku",
        OPTIONS,
        hooks=Hooks(on_phase=said.append, stop=lambda: sum("bands" in one for one in said) > 0),
        folder=tmp_path,
    )
    assert stopped.interrupted
    assert stopped.bands.parts == 1 < len(whole.parts)
    parts = len(whole.parts)
    assert f"Stopped after the bands of 1 of {parts} parts; bands are of those alone." in summary(stopped, "run")
    made = []
    again = leave_out_with_bands(
        "suzaku", "suzaku", OPTIONS, hooks=Hooks(on_phase=made.append), folder=tmp_path, resume=True
    )
    assert again.bands.to_dict() == whole.bands.to_dict()
    assert not again.interrupted


def test_what_is_recalled_is_what_was_noted():
    trials = load_trials("suzaku")
    one, other = (trials.trials[name] for name in trials.tune[:2])
    scores = foretold(load_profile("suzaku"), [one], [other], PosteriorOptions(particles=20, leave_out=False))
    assert repr(_recalled(json.loads(json.dumps(_noted(scores))))) == repr(scores)


@pytest.mark.long
def test_the_command_prints_and_writes_them(tmp_path):
    ended = run(
        "leave-out", "--folds", "2", "--starts", "1", "--targets", "hull.N_v", "--bands", "--out", "out", cwd=tmp_path
    )
    assert ended.code == 0, ended.err
    assert "bands from the other runs" in ended.out
    document = json.loads((tmp_path / "out" / "leave_out.json").read_text())
    assert document["bands"]["parts"] == 2
    assert 0.0 < document["bands"]["by_manoeuvre"]["all"]["coverage_90"] <= 1.0
