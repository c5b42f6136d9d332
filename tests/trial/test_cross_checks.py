"""Channels against each other: factors, signs and columns that were never measured; and nothing said of good ones."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmgtune import DiagnoseOptions, FitOptions, LeaveOutOptions, diagnose, fit, leave_out, validate
from mmgtune.importing import import_logs, load_map
from mmgtune.profile import load_profile
from mmgtune.trial import Trial, check_trial, check_trials, load_trials, oddities
from mmgtune.trial.checks.set_checks import odd_in_words
from mmgtune.trial.kinematics import FITS, Reading, position_misfits

from .made import DEG, made, said

DATA = Path(os.environ.get("MMGTUNE_DATA", Path(__file__).parents[2].parent / "shared" / "data"))
L_PP = 83.0
SUZAKU = load_trials("suzaku").trials


def warnings_of(trial: Trial, L_pp: float | None = L_PP) -> list[str]:
    return [f"{f.what}: {f.why}; {f.fix}" for f in check_trial(trial, L_pp) if f.severity == "warning"]


def warnings_of_set(trials: dict[str, Trial]) -> list[str]:
    found = check_trials(trials)
    return [f"{name}: {f.what}" for name, findings in found.items() for f in findings if f.severity == "warning"]


@pytest.mark.daily("turn_p20")
@pytest.mark.parametrize("name", SUZAKU)
@pytest.mark.parametrize(("channels", "factor"), [("n", 1.944), ("n", 1 / 1.944), ("n", 10.0), ("uv_m", 0.514)])
def test_one_of_a_set_in_another_unit(name: str, channels: str, factor: float) -> None:
    parts = {"n": ("n",), "uv_m": ("u", "v_m")}[channels]
    wrong = replace(SUZAKU[name], **{part: factor * getattr(SUZAKU[name], part) for part in parts})
    found = [one for one in warnings_of_set(SUZAKU | {name: wrong}) if "on her approach the ship makes" in one]
    assert [one.split(":")[0] for one in found] == [name]


def test_sets_that_agree_or_cannot_tell() -> None:
    assert warnings_of_set(SUZAKU) == []
    first, second = list(SUZAKU)[:2]
    wrong = replace(SUZAKU[first], n=1.944 * SUZAKU[first].n)
    assert warnings_of_set({first: wrong, second: SUZAKU[second]}) == []
    half = {
        name: replace(SUZAKU[name], n=1.944 * SUZAKU[name].n) if k % 2 else SUZAKU[name]
        for k, name in enumerate(SUZAKU)
    }
    assert warnings_of_set(half) == []


def test_one_run_that_is_there_twice() -> None:
    run, other = made(seed=1), made("turn_p21", angle=21.0 * DEG, seed=2)
    smooth = np.convolve(run.r, np.ones(5) / 5.0, "same")
    copies = {
        "filtered": replace(run, id="filtered", r=smooth, u=run.u + 0.01),
        "moved": replace(run, id="moved", x=run.x + 100.0),
        "cut": replace(run, id="cut", **{name: getattr(run, name)[40:] for name in (*"tx", "y", "psi", *"urn")},
                       v_m=run.v_m[40:], delta=run.delta[40:]),
    }  # fmt: skip
    for name, copy in copies.items():
        (said,) = warnings_of_set({run.id: run, other.id: other, name: copy})
        assert said.startswith(f"{name}: its ")
        assert said.endswith(f"are those of '{run.id}'")
    again = made("again", seed=3)  # the same orders, measured again
    assert warnings_of_set({run.id: run, again.id: again}) == []
    still = {name: made(name, angle=0.0, speed=0.0, n=0.0) for name in ("a", "b")}
    assert not [one for one in warnings_of_set(still) if "are those of" in one]


@pytest.mark.parametrize("name", SUZAKU)
@pytest.mark.parametrize("factor", [10.0, 60.0, 1.944, 0.1])
@pytest.mark.parametrize("axis", ["x", "y"])
def test_positions_of_one_axis(name: str, axis: str, factor: float) -> None:
    trial = SUZAKU[name]
    warnings = warnings_of(replace(trial, **{axis: factor * getattr(trial, axis)}))
    assert len(warnings) >= 1
    if factor > 10.0:
        found = [re.match(rf"'{axis}' goes ([\d.]+) times as far as", one) for one in warnings]
        assert any(one and float(one[1]) == pytest.approx(factor, rel=0.02) for one in found) or any(
            "do not integrate to the positions" in one for one in warnings
        )


def test_positions_that_wander_do_not_contradict_velocities() -> None:
    """White noise of a receiver says little of how long one has to look: its errors fade over 20 s."""
    trial = SUZAKU["turn_p35"]
    rng = np.random.default_rng(2)
    wander = np.zeros((2, trial.n_samples))
    dt = float(np.diff(trial.t)[0])
    for k in range(1, trial.n_samples):
        wander[:, k] = np.exp(-dt / 20.0) * wander[:, k - 1] + 4.0 * np.sqrt(2.0 * dt / 20.0) * rng.standard_normal(2)
    off = replace(trial, x=trial.x + wander[0], y=trial.y + wander[1])
    assert position_misfits(off.columns)[Reading.AS_ASKED] > FITS
    assert warnings_of(off) == []
    assert any("do not integrate to the positions" in one for one in warnings_of(replace(off, u=1.3 * off.u)))


def test_a_factor_that_noise_hides_from_the_whole_is_found_by_axis() -> None:
    trial = made(zigzag=True, seed=1)
    (warning,) = warnings_of(replace(trial, x=60.0 * trial.x))
    assert "'x' goes 60 times as far as 'u', 'v' and 'psi' say" in warning
    assert "divide 'x' by 60" in warning


def change_n(change: Callable[[np.ndarray], np.ndarray]) -> Callable[[Trial], Trial]:
    return lambda trial: replace(trial, n=change(np.array(trial.n)))


@pytest.mark.parametrize("name", [name for name in SUZAKU if "40" not in name])
@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (change_n(lambda n: 0.0 * n), "the propeller stands all the time, and the ship keeps her way"),
        (change_n(lambda n: -n), "the propeller turns astern, and the ship keeps going ahead"),
        (change_n(lambda n: 10.0 * n), "of her length: too little"),
        (change_n(lambda n: 0.1 * n), "of her length: too much"),
    ],
)
def test_revolutions(name: str, change: Callable[[Trial], Trial], expected: str) -> None:
    (warning,) = warnings_of(change(SUZAKU[name]))
    assert expected in warning


def test_revolutions_without_a_length() -> None:
    trial = made(zigzag=True, seed=1)
    assert "the propeller stands" in said(replace(trial, n=0.0 * trial.n))
    assert "turns astern" in said(replace(trial, n=-trial.n))


def test_a_ship_that_runs_out_has_a_propeller_that_stands() -> None:
    t = np.arange(600.0)
    u = 3.0 / (1.0 + 0.1 * 3.0 * t / L_PP)
    zero = np.zeros(600)
    x = np.concatenate([[0.0], np.cumsum(0.5 * (u[1:] + u[:-1]))])
    trial = Trial("a", "", "", "measured", t=t, x=x, y=zero, psi=zero, u=u, v_m=zero, r=zero, n=zero, delta=zero)
    assert not warnings_of(trial)
    assert not warnings_of(trial, None)
    assert not warnings_of(replace(trial, n=zero - 1.0))


@pytest.mark.parametrize("seed", [None, 1])
@pytest.mark.parametrize("angle", [0.0, 5.0 * DEG, -0.4 * DEG])
def test_a_rudder_that_stands_while_the_ship_is_steered(seed: int | None, angle: float) -> None:
    trial = made(zigzag=True, seed=seed)
    (warning,) = warnings_of(replace(trial, delta=np.full(trial.n_samples, angle)))
    assert f"the rudder stands at {angle / DEG:.3g} deg all the time, and the ship is steered" in warning
    assert "deg/s to starboard and" in warning
    # A ship may turn for ever with her rudder over.
    turn = made(seed=seed)
    assert not warnings_of(replace(turn, delta=np.full(turn.n_samples, 20.0 * DEG)))
    assert "'delta' was not measured" in said(replace(turn, delta=0.0 * turn.delta))
    # A propeller that was put astern swings a ship that nobody steers; nothing swings her to both sides.
    for one, steered in ((turn, False), (trial, True)):
        half = np.arange(one.n_samples) > one.n_samples // 2
        stopping = replace(one, delta=0.0 * one.delta, n=np.where(half, -0.5 * one.n, one.n))
        assert ("the ship is steered" in "\n".join(warnings_of(stopping))) is steered


def test_a_rudder_far_over() -> None:
    trial = made(angle=35.0 * DEG)
    assert not warnings_of(trial)
    (warning,) = warnings_of(replace(trial, delta=1.944 * trial.delta))
    assert "the rudder is over by 68 deg" in warning


def test_speed_against_length() -> None:
    trial = made()
    scaled = replace(trial, **{name: 12.0 * getattr(trial, name) for name in ("x", "y", "u", "v_m")}, n=12.0 * trial.n)
    assert "a Froude number of" in "\n".join(warnings_of(scaled))
    assert not warnings_of(trial)


@pytest.mark.daily("kvlcc2")
@pytest.mark.parametrize(
    ("folder", "preset", "ship", "step"),
    [
        ("esso-osaka-frt", "frt-ds-esso", "esso_osaka_3m", None),
        ("kvlcc2-marin", "simman-marin", "kvlcc2", 1.0),
        ("kvlcc2-hsva", "simman-hsva", "kvlcc2_l7", None),
    ],
)
def test_nothing_is_said_of_what_was_measured(folder: str, preset: str, ship: str, step: float | None) -> None:
    logs = sorted([*(DATA / folder).glob("**/*.csv"), *(DATA / folder).glob("*.dat")])
    if not logs:
        pytest.skip(f"no measured data at {DATA / folder}; MMGTUNE_DATA names their folder")
    L_pp = load_profile(ship).L_pp
    # Real logs have gaps and spikes, and what is logged as the rudder of this model are orders.  In two runs the
    # position stands for a second or two and then jumps to where the ship is.  In one the heading turns 0.93 times as
    # far as the yaw rate says for 40 s, and 1.01 times from then on.
    known = (" gaps: ", "spikes", "rudder moves at up to", "the position jumps once, by", "the factor of 'r' changes")
    trials = import_logs(logs, load_map(preset, preset=True), ".", step, dry_run=True).trials
    assert not any("on her approach" in one for one in warnings_of_set({trial.id: trial for trial in trials}))
    for trial in trials:
        for length in (L_pp, None):
            odd = [one for one in warnings_of(trial, length) if not any(word in one for word in known)]
            assert not odd, (trial.id, odd)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("by", "lasting"), [(20.0, 40), (20.0, 400), (8.0, 15)])
def test_positions_that_jump(seed: int, by: float, lasting: int) -> None:
    rng = np.random.default_rng(seed)
    trial = made(zigzag=bool(seed % 2), seed=seed)
    begin, towards = int(rng.integers(60, 400)), rng.uniform(0.0, 2.0 * np.pi)
    away = ((trial.t >= begin) & (trial.t < begin + lasting)).astype(float)
    jumped = replace(trial, x=trial.x + by * np.cos(towards) * away, y=trial.y + by * np.sin(towards) * away)
    (warning,) = [one for one in warnings_of(jumped) if "position jumps" in one]
    back = begin + lasting < 480
    assert warning.startswith("the position jumps 2 times, by up to" if back else "the position jumps once, by")
    size = float(re.search(r"([\d.]+) m:", warning).group(1))
    assert size == pytest.approx(by, abs=2.5)
    (finding,) = [f for f in check_trial(jumped, L_PP) if "position jumps" in f.what]
    row = int(finding.where.split()[-1])
    assert min(abs(row - begin), abs(row - begin - lasting)) <= 1


@pytest.mark.parametrize("seed", range(6))
def test_another_antenna_is_told_beside_the_noise_of_its_receiver(seed: int) -> None:
    """A jump by fourteen times the noise of each position."""
    rng = np.random.default_rng(seed)
    trial = made(zigzag=bool(seed % 2), seed=seed)
    noise = rng.standard_normal((2, trial.n_samples))
    still = replace(trial, x=trial.x + noise[0], y=trial.y + noise[1])
    assert not [one for one in warnings_of(still) if "position jumps" in one]
    later = 14.0 * (trial.t >= 250.0)
    jumped = replace(still, x=still.x + later * np.cos(trial.psi), y=still.y + later * np.sin(trial.psi))
    assert [one for one in warnings_of(jumped) if "position jumps once, by" in one]


@pytest.mark.parametrize("seed", range(6))
def test_positions_that_only_seem_to_jump(seed: int) -> None:
    """Spikes, a receiver once in five seconds, velocities through water, an antenna at the bow, gaps."""
    trial = made(zigzag=bool(seed % 2), seed=seed)
    spiked = trial.x.copy()
    spiked[200] += 60.0
    held = 5 * (np.arange(trial.n_samples) // 5)
    psi = trial.psi
    gap = np.where((trial.t > 200) & (trial.t < 230), np.nan, trial.x)
    unknown = np.where(np.isin(trial.t, (100, 250, 251, 252)), np.nan, trial.u)
    long = np.where((trial.t > 150) & (trial.t < 260), np.nan, trial.u)
    outlier = trial.y + 12.0 * (trial.t == 300)
    burst = trial.x + np.select([trial.t == 300, trial.t == 301, trial.t == 302], [13.0, 14.0, 12.0])
    for other in (
        replace(trial, x=spiked),
        replace(trial, x=trial.x[held], y=trial.y[held]),
        replace(trial, x=trial.x + 0.7 * trial.t, y=trial.y - 0.5 * trial.t),
        replace(trial, x=trial.x + 40.0 * np.cos(psi), y=trial.y + 40.0 * np.sin(psi)),
        replace(trial, x=gap),
        replace(trial, u=unknown, v_m=unknown - trial.u + trial.v_m),
        replace(trial, u=long),
        replace(trial, y=outlier),
        replace(trial, x=burst, y=trial.y - burst + trial.x),
        replace(trial, u=trial.u[0] + 0.0 * trial.u),
    ):
        assert not [one for one in warnings_of(other) if "position jumps" in one]


@pytest.mark.long
def test_results_say_what_is_odd_about_their_trials() -> None:
    assert oddities(SUZAKU, L_PP) == []
    gap = replace(SUZAKU["turn_p35"], y=np.where(SUZAKU["turn_p35"].t > 400.0, np.nan, SUZAKU["turn_p35"].y))
    assert oddities(SUZAKU | {"turn_p35": gap}, L_PP) == []
    wrong = {name: replace(trial, r=-trial.r) for name, trial in list(SUZAKU.items())[:4]}
    (sentence,) = oddities(SUZAKU | wrong, L_PP)
    assert sentence.startswith(
        "Something is odd in 4 of 10 trials: the yaw rate does not integrate to the heading (turn_"
    )
    assert ", and 3 more alike). 'mmgtune trials check' says more." in sentence
    several = {"a": "turns 3.5 times", "b": "no rudder", "c": "turns 12 times", "d": "stands", "e": "drifts"}
    assert odd_in_words(several) == "turns 3.5 times (a, and 1 more alike); no rudder (b); stands (d); and 1 more"
    jumped = replace(SUZAKU["turn_m20"], x=SUZAKU["turn_m20"].x + 25.0 * (SUZAKU["turn_m20"].t > 300.0))
    trials = replace(load_trials("suzaku"), trials=SUZAKU | {"turn_m20": jumped})
    said = "Something is odd in 1 of 10 trials: the position jumps once, by 2"
    result = fit("suzaku", trials, FitOptions(method="least-squares", starts=1, fixed=("hull.*", "rudder.*")))
    assert [one for one in result.to_dict()["warnings"] if one.startswith(said)]
    assert validate("suzaku", trials).to_dict()["warnings"][0].startswith(said)
    names = ("turn_m20", "zigzag_10")
    two = replace(trials, trials={name: trials[name] for name in names}, tune=names, test=())
    diagnosis = diagnose("suzaku", two, DiagnoseOptions(effects=("gyro-bias",), targets=("hull.R_0",), leeway=0.02))
    assert diagnosis.to_dict()["warnings"][0].startswith(said.replace("10", "2"))
    without = leave_out("suzaku", trials, LeaveOutOptions(folds=2, starts=1, targets=("hull.R_0",)))
    assert without.to_dict()["warnings"][0].startswith(said.replace("10", "4"))  # those left out in turn


def test_revolutions_before_a_gear_are_told_of_every_trial() -> None:
    """Of a turn that takes her way off, and of one without an approach, nothing was said."""
    geared = {name: replace(one, n=4.4 * one.n) for name, one in SUZAKU.items()}
    name, other = "zigzag_10", geared["zigzag_10"]
    rudder = np.array(other.delta)
    rudder[:20] = 10.0 * DEG  # no approach
    geared[name] = replace(other, delta=rudder)
    said_ = {key: [one.what for one in found if "of her length: too little" in one.what]
             for key, found in check_trials(geared, L_PP).items()}  # fmt: skip
    assert all(len(one) == 1 for one in said_.values())
    assert "as in the other trials" in said_[name][0]
    assert not any("of her length" in one.what for found in check_trials(SUZAKU, L_PP).values() for one in found)
