"""What docs/kvlcc2.md says of the measured runs of MARIN and HSVA, where they are at hand."""

import os
from functools import cache
from pathlib import Path

import pytest

from mmgtune.profile import load_profile
from mmgtune.repeating import repeat, summary
from mmgtune.trial import load_trials
from tests.command import run

DATA = Path(os.environ.get("MMGTUNE_DATA", Path(__file__).parents[2].parent / "shared" / "data"))

SETS = {
    "marin": ("kvlcc2-marin", "1 s", "300", {"kvlcc2": 0.079, "kvlcc2_tuned": 0.0100}),
    "hsva": ("kvlcc2-hsva", "0.25 s", "45", {"kvlcc2_l7": 0.749, "kvlcc2_l7_hsva_tuned": 0.134}),
}

MANOEUVRES = {
    "kvlcc2": ("marin", {"advance": 0.011, "tactical_diameter": -0.068, "steady_diameter": -0.130}, (2.2, 5.9)),
    "kvlcc2_tuned": ("marin", {"advance": 0.006, "tactical_diameter": -0.013, "steady_diameter": 0.005}, (1.0, 2.8)),
    "kvlcc2_l7": ("hsva", {}, (2.5, 3.8)),
    "kvlcc2_l7_hsva_tuned": ("hsva", {}, (1.8, 2.3)),
}
"""Runs, errors of the turn as shares of what was measured, and rms errors of the overshoots [deg]."""


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    """Gives the folder an institute's trials are in, imported once as the page says."""

    @cache
    def of(name):
        folder, step, *_ = SETS[name]
        logs = sorted((DATA / folder).glob("*.dat"))
        if not logs:
            pytest.skip(f"no measured data at {DATA / folder}; MMGTUNE_DATA names their folder")
        where = tmp_path_factory.mktemp("kvlcc2")
        ended = run("trials", "import", *logs, "--preset", f"simman-{name}", "--step", step, "-o", name, cwd=where)
        assert ended.code == 0, ended.err
        return where / name

    return of


@pytest.mark.parametrize("name", SETS)
def test_scores_before_and_after_tuning(name, imported):
    *_, window, published = SETS[name]
    folder = imported(name)
    ended = run("validate", *published, folder, "--restart", window, "--json", cwd=folder.parent)
    assert ended.code == 0, ended.err
    for one in ended.json()["profiles"]:
        assert one["L_MSE"] == pytest.approx(published[one["profile"]], rel=0.01)


@pytest.mark.parametrize("profile", MANOEUVRES)
def test_manoeuvres_before_and_after_tuning(profile, imported):
    name, turn, overshoots = MANOEUVRES[profile]
    trials = load_trials(imported(name)).trials.values()
    errors = summary(repeat(load_profile(profile), list(trials)))
    assert {f"{index}_over_L" for index in turn} <= set(errors)
    for index, error in turn.items():
        assert errors[f"{index}_over_L"]["mean"] == pytest.approx(error, abs=0.0006)
    for number, error in enumerate(overshoots, start=1):
        assert errors[f"overshoot_{number}_deg"]["rms"] == pytest.approx(error, abs=0.06)
