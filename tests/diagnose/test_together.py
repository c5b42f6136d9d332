"""Trials kept for testing that an answer misses are looked at with the others."""

from dataclasses import dataclass, field, replace
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.diagnose.causes.contributions import share_lost
from mmgtune.effects.signs import signed
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials
from tests.diagnose.beliefs import belief_with
from tests.hidden.cases import of_runs
from tests.hidden.plant import simulate, write

FEW = ("hull.R_0", "wake.w_P0", "rudder.eps", "rudder.gamma_Rp", "rudder.gamma_Rn")
TUNE, TEST = ("turn_p20", "turn_m20"), ("turn_m10", "turn_p10", "zigzag_20")


@pytest.mark.daily("True-unexplained")
@pytest.mark.parametrize(("keep", "verdict"), [(True, "unexplained"), (False, "found")])
def test_water_that_moves_only_in_trials_kept_for_testing_is_no_nothing(keep, verdict, tmp_path):
    case = of_runs("current", 3, seed=1)
    moved = {name: what for name, what in case.of_trial.items() if name in TEST}
    write(simulate({}, case.effects, case.seed, case.noise, moved), tmp_path)
    trials = load_trials(tmp_path)
    few = replace(trials, trials={name: trials.trials[name] for name in (*TUNE, *TEST)}, tune=TUNE, test=TEST)
    options = DiagnoseOptions(effects=("current", "rudder-offset"), targets=FEW, keep_test=keep)
    result = diagnose(load_profile("suzaku"), few, options)
    assert result.verdict == verdict
    assert [cause.tag for cause in result.causes] == ([] if keep else ["current"])
    assert "trials kept for testing" in result.sentence()
    assert (result.together is None) == keep
    if not keep:  # each run is told by the others; were it not, that would be no answer
        before, _ = result.gain.excess.T
        doubtful = replace(result, gain=replace(result.gain, excess=np.stack([before, 0.7 * before], axis=1)))
        assert doubtful.verdict == "unexplained"
        assert "fitted to all runs but one, it tells that one little better" in doubtful.sentence()
        alone = replace(doubtful, together=None)  # what differs between runs bends to much where it was found
        assert alone.verdict == "unexplained"
        assert "but the model with it leaves 70 % of it on each trial in turn" in alone.sentence()
        none = replace(alone, gain=replace(result.gain, excess=np.stack([before, before], axis=1), unsure=1e9))
        assert none.verdict == "unexplained"  # however little is known of what may have moved
        assert "fitted to all runs but one, it tells that one little better" in none.sentence()


@pytest.mark.parametrize(
    ("share", "most", "by_run", "untold"),
    [
        (0.6, False, False, False),
        (0.4, False, False, True),
        (-2.0, True, False, False),
        (-2.0, True, True, True),
    ],
    ids=["most of it", "little", "all of most runs", "values that bend"],
)
def test_what_all_trials_were_looked_at_for_must_be_told_by_the_others(share, most, by_run, untold):
    gain = SimpleNamespace(share_removed=share, surely_removed=share, tells_most_runs=most, leaves_beside=lambda: True)
    causes = (SimpleNamespace(runs="of each" if by_run else None),)
    found = {"causes": causes, "contributions": (("current", None),), "together": SimpleNamespace(settled=True)}
    assert belief_with(gain=gain, **found)._told_by_none is untold
    read = belief_with(gain=gain, **found | {"contributions": ()})
    assert not read._told_by_none  # a log that holds its values: nothing was fitted


@dataclass(frozen=True)
class Answer:
    """What decides whether all trials are looked at."""

    is_beyond_all: bool
    gain: SimpleNamespace
    wall_s: float = 0.0
    verdict: str = "none"


@pytest.mark.parametrize("beyond", [False, True])
def test_a_sum_that_is_not_believed_is_not_looked_for_in_more_trials(beyond, monkeypatch):
    """A thruster in some runs took four looks at five trials, and four more at all eight."""
    run = import_module("mmgtune.diagnose.run")
    looked_at = []

    def look(profile, trials, *rest):
        looked_at.append(len(trials.test))
        return Answer(beyond, SimpleNamespace(missed=True))

    monkeypatch.setattr(run, "_looked_at", look)
    monkeypatch.setattr(run, "_settled", lambda alone, of_all: of_all)
    diagnose(load_profile("suzaku"), load_trials("suzaku"))
    assert looked_at == ([4] if beyond else [4, 0])


@pytest.mark.parametrize(
    ("whole", "windows", "left_open", "told"),
    [
        ("unexplained", "found", 3.0, "windows"),
        ("unexplained", "unexplained", 3.0, "whole"),
        ("not-separable", "found", 3.0, "windows"),  # fewer rivals
        ("unexplained", "found", 1.0, "whole"),  # not looked at
        ("found", "found", 3.0, "whole"),
        ("none", "found", 3.0, "whole"),
    ],
)
def test_windows_are_looked_at_where_whole_runs_leave_much_open(whole, windows, left_open, told, monkeypatch):
    """A wind stood for a current and a zero of the rudder, as what that did between samples excused the rest."""

    @dataclass(frozen=True)
    class Seen:
        verdict: str
        of: str
        leftover: SimpleNamespace
        gain: SimpleNamespace
        is_beyond_all: bool = False
        interrupted: bool = False
        warnings: tuple[str, ...] = ()
        wall_s: float = 0.0

        @property
        def names_causes(self):
            return self.verdict in ("found", "not-separable")

        @property
        def groups(self):
            return (("wind", "current"),) if self.verdict == "not-separable" else ()

    def look(profile, trials, checked, choice, options, *rest):
        verdict, of = (whole, "whole") if options.restart is None else (windows, "windows")
        return Seen(verdict, of, SimpleNamespace(left_open=left_open), SimpleNamespace(missed=False))

    monkeypatch.setattr(import_module("mmgtune.diagnose.run"), "_looked_at", look)
    result = diagnose(load_profile("suzaku"), load_trials("suzaku"))
    assert result.of == told
    assert bool(result.warnings) == (told == "windows")


@pytest.mark.parametrize(
    ("windows", "duration", "looked_at"),
    [
        ("found", 2600.0, ["windows"]),
        ("interrupted", 2600.0, ["windows"]),
        ("none", 2600.0, ["windows", "whole"]),
        ("unexplained", 2600.0, ["windows", "whole"]),
        ("found", 600.0, ["whole"]),
    ],
)
def test_one_long_run_is_looked_at_in_windows_first(windows, duration, looked_at, monkeypatch):
    """A current and a zero of the rudder in a log of 43 minutes were "something is wrong that this program does not
    know", after 207 s."""
    one = load_trials("suzaku").trials["turn_p35"]
    t = np.linspace(0.0, duration, one.n_samples)
    seen = []

    def look(profile, trials, checked, choice, options, *rest):
        seen.append("whole" if options.restart is None else "windows")
        verdict = "none" if options.restart is None else windows
        return Verdict(verdict, options.restart, interrupted=verdict == "interrupted")

    monkeypatch.setattr(import_module("mmgtune.diagnose.run"), "_looked_at", look)
    result = diagnose(load_profile("suzaku"), [replace(one, t=t)])
    assert seen == looked_at
    assert (result.restart is None) == (seen[-1] == "whole")
    assert bool(result.warnings) == (seen == ["windows"])


@dataclass(frozen=True)
class Verdict:
    """What is asked of an answer before others are looked for."""

    verdict: str
    restart: float | None
    interrupted: bool = False
    gain: SimpleNamespace = field(default_factory=lambda: SimpleNamespace(missed=False))
    is_beyond_all: bool = False
    warnings: tuple[str, ...] = ()
    wall_s: float = 0.0

    @property
    def names_causes(self):
        return self.verdict in ("found", "not-separable")


def test_without_a_cause_motion_may_run_away():
    assert share_lost(100.0, float("inf"), 10.0) == 1.0
    assert share_lost(100.0, 55.0, 10.0) == pytest.approx(0.5)
    assert share_lost(100.0, 10.0, 100.0) == 1.0


def test_signs_are_said():
    assert signed("-2.1 ± 0.3 m", "forward", "aft") == "2.1 ± 0.3 m aft"
    assert signed("2.1 m", "forward", "aft") == "2.1 m forward"
