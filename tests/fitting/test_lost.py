"""Profiles of which no simulation stays within bounds on the trials: a clear error, whatever is asked."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.errors import ProfileError
from mmgtune.fitting import FitOptions, fit
from mmgtune.options import PosteriorOptions
from mmgtune.posterior import posterior
from mmgtune.profile import parse_profile
from mmgtune.trial import load_trials
from tests.command import ROOT

TARGETS = ("wake.w_P0",)
QUICK = FitOptions(targets=TARGETS, method="least-squares", starts=1)


@pytest.fixture(scope="module")
def wild():
    """SUZAKU's profile with a coefficient that lost its decimal point."""
    text = (ROOT / "ship_profiles" / "suzaku.toml").read_text(encoding="utf-8")
    return parse_profile(re.sub(r"(?m)^X_vvvv.*$", "X_vvvv = 500.0", text), Path("wild.toml"))


@pytest.mark.parametrize(
    "options",
    [
        QUICK,
        replace(QUICK, initial="estimated"),
        replace(QUICK, loss="huber"),
        FitOptions(targets=TARGETS, starts=2),
    ],
    ids=["least squares", "initial states estimated", "huber", "CMA-ES"],
)
def test_a_fit_of_a_ship_that_runs_away_says_where(wild, options, tmp_path):
    with pytest.raises(
        ProfileError, match="runs away on turn_m20, turn_p35, turn_m40, wherever the targets are"
    ) as error:
        fit(wild, "suzaku", options, folder=tmp_path)
    assert not list(tmp_path.iterdir())
    (problem,) = error.value.problems
    assert "sign or a power of ten" in problem.why
    assert "mmgtune validate" in problem.fix


@pytest.mark.parametrize(
    ("column", "factor", "said"),
    [("n", 60.0, "divide 'n' by 60"), ("t", 1000.0, "divide 't' by 1000")],
)
def test_what_is_odd_in_the_trials_is_said_too(column, factor, said):
    """The profile is good: revolutions are per minute, or times in milliseconds."""
    trials = load_trials("suzaku")
    few = {name: replace(trials.trials[name], **{column: factor * getattr(trials.trials[name], column)})
           for name in ("turn_p35", "turn_m40")}  # fmt: skip
    with pytest.raises(ProfileError, match="runs away on turn_p35, turn_m40") as error:
        fit("suzaku", replace(trials, trials=few, tune=tuple(few), test=()), QUICK)
    first, *odd = error.value.problems
    assert first.why.startswith("the trials may be wrong")
    fixes = [one.fix for one in odd]
    assert said in fixes
    assert len(set(fixes)) == len(fixes) <= 3


def test_so_does_the_question_what_trials_tell(wild):
    with pytest.raises(ProfileError, match="with the values of the profile"):
        fit(wild, "suzaku", replace(QUICK, identifiable=True))


def test_so_does_a_diagnosis(wild):
    with pytest.raises(ProfileError, match=r"runs away on .* and 1 more"):
        diagnose(wild, "suzaku", DiagnoseOptions(targets=TARGETS))


def test_so_do_particles(wild, tmp_path):
    turn = replace(load_trials("suzaku"), tune=("turn_p35",))
    with pytest.raises(ProfileError, match="with any coefficients that are likely"):
        posterior(wild, turn, PosteriorOptions(particles=20), folder=tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.long
def test_a_diagnosis_of_trials_that_can_be_simulated_stands_beside_others_that_cannot(wild):
    trials = load_trials("suzaku")
    chosen = {name: trials.trials[name] for name in ("turn_p10", "zigzag_10", "turn_p35")}
    some = replace(trials, trials=chosen, tune=("turn_p10", "zigzag_10"), test=("turn_p35",))
    result = diagnose(wild, some, DiagnoseOptions(targets=TARGETS, effects=("rudder-offset",)))
    assert result.verdict == "unexplained"
    assert result.together is None
