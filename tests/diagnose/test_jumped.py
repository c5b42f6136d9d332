"""A position that jumps is a fault of its receiver: the run is taken in parts there, and nothing else is blamed."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.diagnose import diagnose, write_diagnosis
from mmgtune.diagnose.answering.jumped import beginnings_in_words, from_the_track_on, in_parts, in_words
from mmgtune.options import DiagnoseOptions
from mmgtune.profile import load_profile
from mmgtune.report import render
from mmgtune.trial import Trial, TrialSet, check_trial, load_trials
from mmgtune.trial.checks.position_jumps import first_positions_off, position_jumps
from mmgtune.trial.pieces import begun_at
from tests.hidden.plant import simulate, write
from tests.trial.made import made

OPTIONS = DiagnoseOptions(effects=("gyro-drift", "heading-bias", "current", "rudder-gain"))


def with_jump(trials: TrialSet, id: str, *jumps: tuple[int, float]) -> TrialSet:
    """The trials, in one of which the position jumps northwards at rows by so many metres."""
    trial = trials.trials[id]
    x = np.array(trial.x)
    for row, metres in jumps:
        x[row:] += metres
    return replace(trials, trials={**trials.trials, id: replace(trial, x=x)})


@pytest.fixture(scope="module")
def sailed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("jumped")
    write(simulate({}, {}, seed=4), folder)
    return load_trials(folder)


def test_a_run_is_divided_where_its_position_jumps(sailed):
    id = "zigzag_20"
    whole = sailed.trials[id]
    row = whole.n_samples // 2
    divided, told = in_parts(with_jump(sailed, id, (row, 16.0)))
    first, second = [one for one in divided.trials.values() if one.run == id]
    assert told == {id: pytest.approx(16.0, abs=1.0)}  # beside the noise
    assert abs(first.n_samples - row) <= 1
    assert first.n_samples + second.n_samples == whole.n_samples
    assert second.begins == pytest.approx(whole.t[first.n_samples])
    before, after = (sailed.tune, divided.tune) if id in sailed.tune else (sailed.test, divided.test)
    assert [one for one in after if one not in before] == [first.id, second.id]
    assert in_parts(sailed) == (sailed, {})
    for rows in ([row], [1], range(1, whole.n_samples, 2)):  # of pieces too short for a trial none is left
        pieces = sailed.divided({id: rows})
        assert sorted([*pieces.tune, *pieces.test]) == sorted(pieces.trials)


@pytest.mark.parametrize(("n_samples", "seen"), [(65, True), (32, True), (29, False)])
def test_a_jump_is_seen_in_a_run_of_a_minute(sailed, n_samples, seen):
    """Nothing was looked at below 72 samples a second: three jumps by 9 m were "noise that fades slowly"."""
    whole = with_jump(sailed, "turn_p20", (n_samples // 2, 16.0)).trials["turn_p20"]
    rows = slice(n_samples)
    columns = {name: getattr(whole, name)[rows] for name in ("x", "y", "psi", "u", "v_m", "r", "n", "delta")}
    short = Trial(whole.id, whole.ship, whole.manoeuvre, whole.source, whole.t[rows], **columns)
    assert [row for row, _ in position_jumps(short)] == ([n_samples // 2] if seen else [])


def test_a_receiver_that_jumps_all_the_time_is_left(sailed):
    id = "turn_p20"
    rows = range(60, sailed.trials[id].n_samples - 60, 60)
    shaken = with_jump(sailed, id, *((row, 20.0 * (-1.0) ** k) for k, row in enumerate(rows)))
    assert in_parts(shaken) == (shaken, {})


def standing_first(trials: TrialSet, seconds: float) -> TrialSet:
    """The trials logged by a receiver that is late, and stands where each log begins."""

    def late(one):
        x, y = (np.interp(one.t - seconds, one.t, of) for of in (one.x, one.y))
        return replace(one, x=x, y=y)

    return replace(trials, trials={id: late(one) for id, one in trials.trials.items()})


@pytest.mark.parametrize(("seconds", "rows"), [(1.5, 2), (2.6, 3)])
def test_first_positions_that_stand_still_are_left_out(sailed, seconds, rows):
    late = standing_first(sailed, seconds)
    kept, off = from_the_track_on(late)
    assert set(off) == set(late.trials)
    for id, one in kept.trials.items():
        whole = late.trials[id]
        assert off[id] == pytest.approx(seconds * whole.u[0], abs=1.0)
        left_out = whole.n_samples - one.n_samples
        assert rows <= left_out <= 4
        assert np.array_equal(one.x, whole.x[left_out:])
        assert (one.id, one.part_of, one.t[0]) == (id, "", whole.t[left_out])
        assert any("off the track by" in found.what for found in check_trial(whole))
    assert from_the_track_on(sailed) == (sailed, {})
    assert in_parts(late) == (late, {})
    assert not any("off the track" in found.what for one in sailed.trials.values() for found in check_trial(one))


@pytest.mark.parametrize("step", [1e-3, 0.02, 20.0])
def test_first_positions_of_logs_of_any_step(step):
    """Of a record that is shorter than the beginning that is looked at, a part of it is."""
    one = made(samples=700, dt=step, seed=1)
    assert not any("off the track" in found.what for found in check_trial(one))
    x = one.x.copy()
    x[0] += 1e3
    assert first_positions_off(replace(one, x=x)) == (1, pytest.approx(1e3, rel=0.1))


def test_of_what_would_be_no_trial_then_nothing_is_left_out(sailed):
    one = sailed.trials["turn_p20"]
    assert begun_at(one, one.n_samples - 1) is one


@pytest.mark.parametrize(
    ("off", "said"),
    [
        ({}, ""),
        ({"a": 12.0}, "the first positions are off the track by 12 m in 1 of 8 runs"),
        ({"a": 12.0, "b": 11.02}, "the first positions are off the track by 11 to 12 m in 2 of 8 runs"),
    ],
)
def test_first_positions_in_words(off, said):
    assert beginnings_in_words(off, 8) == said


@pytest.mark.long
def test_a_late_receiver_that_stands_first_is_late(sailed):
    options = DiagnoseOptions(effects=("position-latency", "speed-scale", "log-zero", "antenna", "clock-offset"))
    result = diagnose(load_profile("suzaku"), standing_first(sailed, 1.5), options)
    assert [cause.tag for cause in result.causes] == ["position-latency"]
    assert result.verdict == "found"
    (cause,) = result.to_dict()["causes"]
    assert cause["parameters"]["seconds"]["value"] == pytest.approx(1.5, abs=0.1)
    assert any("runs begin after these" in one for one in result.warnings)


@pytest.mark.long
def test_nothing_else_is_blamed_for_it(sailed, tmp_path):
    id = sailed.tune[-1]
    result = diagnose(load_profile("suzaku"), with_jump(sailed, id, (sailed.trials[id].n_samples // 2, 16.0)), OPTIONS)
    assert (result.verdict, result.causes) == ("none", ())
    assert result.sentence().startswith(f"The position jumps in {id} by 1")
    assert any("taken in parts there" in one for one in result.warnings)
    write_diagnosis(result, tmp_path / "run")
    assert "a position that jumps" in render(tmp_path / "run")[0].read_text()


@pytest.mark.parametrize(
    ("jumped", "said"),
    [
        ({}, ""),
        ({"a": 11.72, "b": 3.0}, "the position jumps in a by 11.7 m and b by 3 m"),
        ({"a": 11.7, "b": 12.6, "c": 11.7, "d": 12.0}, "the position jumps in 4 runs, by 11.7 to 12.6 m"),
        (dict.fromkeys("abcd", 2.0), "the position jumps in 4 runs, by 2 m"),
    ],
)
def test_many_runs_that_jump_are_one_phrase(jumped, said):
    assert in_words(jumped) == said
