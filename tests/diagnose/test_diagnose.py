"""Diagnosis on ships with something hidden in them: the answer is in the plant, the program gets the files."""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from mmgtune.backends import Integrator
from mmgtune.diagnose import VERDICTS, DiagnoseOptions, diagnose
from mmgtune.diagnose.bench.noise import NoiseModel, estimate
from mmgtune.diagnose.searching.refit import Refit
from mmgtune.diagnose.signatures.intervals import Estimate
from mmgtune.diagnose.signatures.wording import parameters_in_words
from mmgtune.effects import effects, find_effect
from mmgtune.errors import OptionError
from mmgtune.motions import simulate_trials
from mmgtune.physics.frame import to_earth
from mmgtune.profile import load_profile, parse_profile, with_effects
from mmgtune.trial import load_trials
from tests.command import run
from tests.diagnose.sensors import logged
from tests.hidden.cases import Case, null, pair, single
from tests.hidden.plant import AUTOCORRELATED, simulate, write
from tests.hidden.study import covered, outcome
from tests.hidden.suzaku import PROFILE

ROOT = Path(__file__).parent.parent.parent


def files(case: Case, folder):
    """The files of a case, which is all the program gets to see."""
    write(simulate(case.ship, case.effects, case.seed, case.noise), folder)
    return folder


def said_of(case: Case, folder, **options):
    """The diagnosis of a case."""
    return diagnose(load_profile("suzaku"), load_trials(files(case, folder)), DiagnoseOptions(**options))


LIKE_IT = ("heading-bias", "gyro-bias", "current", "rudder-offset", "antenna")
"""Among them a bias of the heading, or a current, can be taken for another."""


TYPICAL = {"steering-lag": (), "antenna": ("antenna", "position-latency", "speed-scale", *LIKE_IT[:-1])}
"""An actuator among all causes, a sensor among those like it; others are below.  The full study has them all."""


@pytest.mark.parametrize("tag", [pytest.param("steering-lag", marks=pytest.mark.long), "antenna"])
def test_a_typical_effect_is_named(tag, tmp_path):
    case = single(tag, 3, seed=1)
    result = said_of(case, tmp_path, effects=TYPICAL[tag])
    document = result.to_dict()
    json.dumps(document, allow_nan=False)
    assert outcome(case.effects, document) == "right", (result.verdict, document["causes"])
    assert document["gain"]["J_test_after"] < 0.2 * document["gain"]["J_test_before"]
    assert document["gain"]["share_above_noise_removed"] > 0.95
    first = document["causes"][0]
    assert first["p_value"] < 0.01
    assert first["gain_test"] > 0.8
    for name, value in first["parameters"].items():
        low, high = value["ci95"]
        assert low is None or low <= value["value"] <= (np.inf if high is None else high), name


@pytest.mark.long
def test_a_cause_is_named_on_windows_too(tmp_path):
    case = single("current", 3, seed=1)
    trials = load_trials(files(case, tmp_path)).trials.values()
    restart = (max(trial.duration for trial in trials) - 3.0) / 3.0  # a last window of four samples
    result = said_of(case, tmp_path, restart=restart, effects=("current", "rudder-offset", "antenna"))
    assert [(cause.tag, cause.runs) for cause in result.causes] == [("current", None)]  # one for all
    assert len(result.gain.compared) > 10  # windows of the trials held out


@pytest.mark.long
def test_a_small_effect_with_one_side_is_not_taken_for_another(tmp_path):
    case = single("shallow-water", 1, seed=1)  # 200 m: what it changes is unlike what 12 m would
    result = said_of(case, tmp_path, leeway=0.0)
    assert result.to_dict()["candidates"][0]["effect"] == "shallow-water"
    assert "too small to be told: shallow-water or " in " ".join(result.warnings)  # a tenth of what is spoken of
    assert outcome(case.effects, result.to_dict()) == "missed"


QUICK_GEAR = single("steering-lag", 1, seed=2)
"""Orders logged once a second, and a gear so quick that hardly more than the moment in between is its lag."""


@pytest.mark.long
def test_what_the_log_leaves_open_is_not_called_unexplained(tmp_path):
    assert "rate_limit" in QUICK_GEAR.effects["steering-lag"]
    late = {"steering-lag", "clock-offset", "dead-time"}  # what explains it is not asked for
    result = said_of(QUICK_GEAR, tmp_path, leeway=0.0, effects=[one.tag for one in effects() if one.tag not in late])
    assert result.verdict == "none"
    assert result.chi2[1] > 1.1  # more than the noise of the sensors it is


@pytest.mark.long
def test_a_lag_that_the_log_hardly_tells_is_named_among_those_like_it(tmp_path):
    """Chance explains more by a rudder zero, of which the log leaves much open; of a lag it leaves little."""
    result = said_of(QUICK_GEAR, tmp_path, leeway=0.0)
    assert result.verdict == "not-separable"
    assert "steering-lag" in result.groups[0]


def rivalling(gain, cost, inflation=1.0, by="", left=0.0, tag=""):
    """A refit as far as its rivals ask."""
    known = (
        SimpleNamespace(by=by, effect=find_effect(tag)),
        SimpleNamespace(inflation=inflation),
        SimpleNamespace(chi2=left),
    )
    return Refit(*known, gain, cost, 0.0, 1.0, 0.0)


@pytest.mark.parametrize(
    ("gain", "of_rival", "beaten"),
    [(100.0, 60.0, True), (100.0, 97.0, False), (100.0, 82.0, False)],
    ids=["far better", "fewer parameters only", "not enough for its correlated noise"],
)
def test_a_rival_that_fits_as_well_stays_whatever_its_parameters(gain, of_rival, beaten):
    best, rival = (rivalling(g, cost, inflation=4.0) for g, cost in ((gain, 10.0), (of_rival, 40.0)))
    assert best.beats(rival) == beaten


@pytest.mark.parametrize(
    ("of_one", "left", "beaten"),
    [(980.0, 1020.0, False), (980.0, 1500.0, True), (900.0, 1020.0, True)],
    ids=["hardly less explained", "much more left", "less explained"],
)
def test_values_by_run_do_not_beat_one_value_of_another_effect_that_hardly_leaves_more(of_one, left, beaten):
    """A lag that is longer out than home looks like a clock that was late by another time in each run."""
    by_run, one = rivalling(1000.0, 5.0, by="trial", left=1000.0), rivalling(of_one, 5.0, left=left)
    assert by_run.beats(one) == beaten


@pytest.mark.parametrize(
    ("of_rival", "tag", "beaten"),
    [(499_600.0, "wave-drift", False), (499_400.0, "wave-drift", True), (499_600.0, "current", True)],
    ids=["as a formula has it", "less", "exact"],
)
def test_a_wind_does_not_beat_waves_by_its_formula_alone(of_rival, tag, beaten):
    """A drift force by another law was a wind, whose fall of chi-squared was 87 of 481 000 greater."""
    wind, rival = rivalling(500_000.0, 10.0, tag="wind"), rivalling(of_rival, 10.0, tag=tag)
    assert wind.beats(rival) == beaten
    left = [
        rivalling(gain, 10.0, tag=of, left=chi2)
        for gain, of, chi2 in ((5e5, "wind", 1e3), (4.99e5 + 600.0, tag, 2.1e3))
    ]
    assert left[0].beats(left[1])  # what fits to the noise has no formula that is off
    assert rivalling(1000.0, 10.0, tag="wind").beats(rivalling(970.0, 10.0, tag="wave-drift"))


@pytest.mark.long
def test_water_driven_by_measured_wind_is_named(suzaku, tmp_path):
    """Made with the program's own simulator: the plant logs no wind."""
    trials = load_trials(files(null(3), tmp_path))
    driven = with_effects(suzaku.profile, {"wind-drift": {"along": 0.03, "across": -0.01}}, "test")
    rng = np.random.default_rng(1)
    made = {}
    for k, trial in enumerate(trials.trials.values()):
        speed, towards = 8.0 + 2.0 * np.sin(trial.t / 90.0), 0.9 * k + 0.3 * np.cos(trial.t / 150.0)
        blown = replace(trial, extra={"wind_speed": speed, "wind_dir": towards % (2.0 * np.pi)})
        (motion,) = simulate_trials(driven, [blown], integrator=Integrator("rk4"))
        made[trial.id] = logged(blown, motion, rng)
    options = DiagnoseOptions(effects=("wind-drift", "wind", "current", "wave-drift"))
    result = diagnose(suzaku.profile, replace(trials, trials=made), options)
    assert [cause.tag for cause in result.causes] == ["wind-drift"], result.sentence()
    sizes = result.to_dict()["causes"][0]["parameters"]
    assert sizes["along"]["value"] == pytest.approx(0.03, rel=0.1)
    assert sizes["across"]["value"] == pytest.approx(-0.01, rel=0.3)
    assert "of the measured wind" in result.sentence()


@pytest.mark.long
def test_a_limit_that_one_run_reaches_is_found(tmp_path):
    """A refit from 28 deg stepped beyond all angles there are: a gain of the rudder that differed between runs."""
    case = single("rudder-limit", 1, seed=2)
    result = said_of(case, tmp_path)
    assert outcome(case.effects, result.to_dict()) == "right", result.sentence()


WATER = {"speed": 0.4, "towards": 1.2}


@pytest.mark.parametrize(
    ("scale", "turned", "said"),
    [
        (1.0, np.pi, "acts on the ship the other way, with "),
        pytest.param(3600.0 / 1852.0, 0.0, "its measured speed, as of knots taken for m/s", marks=pytest.mark.long),
        pytest.param(1.0, 0.3, "The current is logged 17.1", marks=pytest.mark.long),
    ],
    ids=["the other way", "knots", "turned"],
)
def test_a_log_of_the_water_that_is_off_is_told_where_the_profile_takes_it_for_right(scale, turned, said, tmp_path):
    north, east = (WATER["speed"] * one(WATER["towards"]) for one in (np.cos, np.sin))
    trials = load_trials(files(replace(null(3), effects={"current": {"north": north, "east": east}}), tmp_path))
    logs = {"current_speed": scale * WATER["speed"], "current_dir": WATER["towards"] + turned}
    made = {
        one.id: replace(one, extra={name: np.full(one.n_samples, value) for name, value in logs.items()})
        for one in trials.trials.values()
    }
    ship = with_effects(load_profile("suzaku"), {"current": {"measured": 1.0}}, "as it was logged")
    options = DiagnoseOptions(effects=("current", "wind", "heading-bias", "rudder-offset"))
    result = diagnose(ship, replace(trials, trials=made), options)
    assert [cause.tag for cause in result.causes] == ["current"], result.sentence()
    assert said in result.sentence()


@pytest.mark.parametrize(
    "asked",
    [
        DiagnoseOptions(effects=("wind", "wave-drift"), targets=("hull.R_0", "wake.w_P0", "rudder.eps"), leeway=0.0),
        pytest.param(DiagnoseOptions(effects=("wind", "wave-drift", "current")), marks=pytest.mark.long),
    ],
    ids=["few targets", "all"],
)
def test_a_vane_that_is_off_is_told_where_the_profile_has_no_wind(asked, tmp_path):
    """Turning a wind of nothing does nothing, so its score was none and it was never fitted: waves of each run stood
    for it."""
    speed, towards, off = 14.0, np.radians(120.0), np.radians(25.0)
    blows = {"wind": {"speed": speed, "direction": towards + np.pi}}
    trials = load_trials(files(replace(null(3), effects=blows), tmp_path))
    logs = {"wind_speed": speed, "wind_dir": towards + np.pi + off}
    made = {
        one.id: replace(one, extra={name: np.full(one.n_samples, value) for name, value in logs.items()})
        for one in trials.trials.values()
    }
    result = diagnose("suzaku", replace(trials, trials=made), asked)
    assert [cause.tag for cause in result.causes] == ["wind"], result.sentence()
    turned = result.causes[0].estimates["effects.wind.turned"]
    assert turned.low < off < turned.high


@pytest.mark.long
def test_what_the_profile_has_and_the_ship_has_no_more_is_told(tmp_path):
    ship = with_effects(load_profile("suzaku"), {"rudder-offset": {"angle": np.radians(1.0)}}, "last year's trials")
    trials = load_trials(files(null(3), tmp_path))
    result = diagnose(ship, trials, DiagnoseOptions(effects=("rudder-offset", "current", "hull-asymmetry")))
    assert [cause.tag for cause in result.causes] == ["rudder-offset"], result.sentence()
    assert "; by the profile the rudder stood 1° to starboard" in result.sentence()
    (angle,) = result.to_dict()["causes"][0]["parameters"].values()
    assert angle["ci95"][0] < 0.0 < angle["ci95"][1]


@pytest.mark.parametrize("said", [True, False])
def test_positions_moved_from_an_antenna_by_a_compass_that_is_off(said, tmp_path):
    """Where the trials say that they were, the compass accounts for it: it was another antenna to starboard."""
    off, antenna = np.radians(3.0), (-70.0, 0.0)
    trials = load_trials(files(replace(null(3), effects={"heading-bias": {"angle": off}}), tmp_path))
    made = {}
    for id, one in trials.trials.items():
        places, shown = (np.array(to_earth(psi, *antenna)) for psi in (one.psi - off, one.psi))
        x, y = np.array([one.x, one.y]) + places - shown
        made[id] = replace(one, x=x, y=y, antenna=antenna if said else None)
    asked = DiagnoseOptions(effects=("heading-bias", "antenna", "current"))
    result = diagnose("suzaku", replace(trials, trials=made), asked)
    assert [cause.tag for cause in result.causes] == (["heading-bias"] if said else ["heading-bias", "antenna"])
    (angle,) = (one for one in result.causes[0].estimates.values())
    assert angle.low < off < angle.high


def test_half_a_wind_is_none():
    """A wind speed without its direction drives nothing: it leaves the constant wind to be looked for."""
    trials = load_trials("suzaku")
    name, trial = next(iter(trials.trials.items()))
    blown = replace(trial, extra={"wind_speed": np.full(trial.n_samples, 8.0)})
    one = replace(trials, trials={name: blown}, tune=(name,), test=())
    result = diagnose(load_profile("suzaku"), one, DiagnoseOptions(effects=("wind",)))
    assert [known.parameters for known in result.detectability] == [("speed", "direction")]


def test_what_shows_of_a_cause_and_which_others_are_like_it():
    """Of a current how it carries a ship along shows in no trial before it is known to grow."""
    trials = load_trials("suzaku")
    one = replace(trials, tune=trials.tune[:1], test=())
    result = diagnose("suzaku", one, DiagnoseOptions(effects=("current", "wave-drift", "speed-scale", "log-zero")))
    told = [known.parameters for known in result.detectability if known.effect == "current"]
    assert sorted(told) == [("north", "east"), ("north", "east", "north_rate", "east_rate")]
    for known in result.detectability:
        others = [tag for tag, _ in known.twins]
        assert len(set(others)) == len(others)


@pytest.mark.parametrize("noise", ["white", pytest.param("autocorrelated", marks=pytest.mark.long)])
def test_nothing_hidden_nothing_found(noise, tmp_path):
    case = null(5) if noise == "white" else null(5, AUTOCORRELATED)
    result = said_of(case, tmp_path)
    assert result.verdict == "none"
    assert result.to_dict()["causes"] == []
    assert result.to_dict()["suggested_trial"] is None


@pytest.mark.long
def test_two_effects_are_both_found(tmp_path):
    case = pair(1)
    document = said_of(case, tmp_path).to_dict()
    assert outcome(case.effects, document) in ("right", "grouped")


@pytest.mark.long
def test_a_resistance_beyond_the_box_of_its_target_is_a_cause(tmp_path):
    case = null(1)
    fouled = {**case.ship, "hull.R_0": 2.2 * PROFILE["hull.R_0"]}  # the box ends at 1.5 times
    write(simulate(fouled, {}, case.seed, case.noise), tmp_path)
    options = DiagnoseOptions(effects=("resistance", "wave-drift", "rpm-scale"))
    result = diagnose(load_profile("suzaku"), load_trials(tmp_path), options)
    assert (result.verdict, [cause.tag for cause in result.causes]) == ("found", ["resistance"]), result.sentence()
    factor = result.to_dict()["causes"][0]["parameters"]["factor"]["value"]
    assert factor == pytest.approx(2.2, rel=0.02)
    # one of the two moved, and it is the one the sentence names
    extended = parse_profile(result.extended_profile().text)
    assert extended.value("hull.R_0") == PROFILE["hull.R_0"]
    assert extended.value("effects.resistance.factor") == pytest.approx(2.2, rel=0.02)


@pytest.mark.long
def test_a_cause_that_would_be_believed_alone_is_named_though_a_hull_unlike_the_profile_s_adds_terms(tmp_path):
    case = single("rudder-offset", 3, seed=1)
    rng = np.random.default_rng(1)
    derivatives = [name for name in load_profile("suzaku").sections["hull"].coefficients if name[0] in "YN"]
    hull = {f"hull.{name}": PROFILE[f"hull.{name}"] * rng.uniform(0.93, 1.07) for name in derivatives}
    write(simulate({**case.ship, **hull}, case.effects, case.seed, case.noise), tmp_path)
    options = DiagnoseOptions(effects=("rudder-offset", "hull-term"), leeway=0.0)
    result = diagnose(load_profile("suzaku"), load_trials(tmp_path), options)
    assert (result.verdict, [cause.tag for cause in result.causes]) == ("found", ["rudder-offset"])
    assert result.doubted.effects[0] == "rudder-offset"
    assert len(result.doubted.effects) > 3
    assert "the rest has no name" in result.sentence()
    angle = result.to_dict()["causes"][0]["parameters"]["angle"]["value"]
    assert angle == pytest.approx(case.effects["rudder-offset"]["angle"], abs=0.002)


@pytest.fixture(scope="module")
def drifted(tmp_path_factory):
    """A case of a current, its folder and its diagnosis among causes like it."""
    case = single("current", 3, seed=2)
    folder = tmp_path_factory.mktemp("drifted")
    return case, folder, said_of(case, folder, effects=LIKE_IT)


@pytest.mark.long
def test_the_extended_profile_is_a_profile_like_any_other(drifted):
    case, folder, result = drifted
    assert outcome(case.effects, result.to_dict()) == "right"
    extended = parse_profile(result.extended_profile().text)
    truth = case.effects["current"]
    for name in ("north", "east"):
        coefficient = extended.coefficient(f"effects.current.{name}")
        assert coefficient.value == pytest.approx(truth[name], abs=0.01)
        assert coefficient.stderr > 0.0
    again = diagnose(extended, load_trials(folder), DiagnoseOptions(effects=LIKE_IT))
    assert again.verdict == "none", [cause.tag for cause in again.causes]
    doubted = replace(result, interrupted=True)
    profile = parse_profile(doubted.extended_profile().text)
    assert "effects.current" not in profile.sections
    assert profile.value("wake.w_P0") == pytest.approx(result.retuned["wake.w_P0"])
    assert profile.value("wake.w_P0") != pytest.approx(extended.value("wake.w_P0"))
    assert profile.provenance["not_believed"] == ["current"]


@pytest.mark.long
def test_names_order_and_metadata_of_the_files_do_not_matter(drifted, tmp_path):
    _, folder, told = drifted
    names = {path.stem: f"log_{k:02d}" for k, path in enumerate(sorted(folder.glob("*.parquet"))[::-1])}
    for old, new in names.items():
        table = pq.ParquetFile(folder / f"{old}.parquet", pre_buffer=False).read(use_threads=False)
        pq.write_table(pa.Table.from_arrays(table.columns, names=table.column_names), tmp_path / f"{new}.parquet")
    split = load_trials(folder)
    lists = {role: json.dumps([names[name] for name in getattr(split, role)]) for role in ("tune", "test")}
    (tmp_path / "split.toml").write_text("".join(f"{role} = {text}\n" for role, text in lists.items()))
    untold = diagnose(load_profile("suzaku"), load_trials(tmp_path), DiagnoseOptions(effects=LIKE_IT))
    a, b = told.to_dict(), untold.to_dict()
    assert a["verdict"] == b["verdict"] == "found"
    assert a["causes"] == b["causes"]
    assert a["theta"] == b["theta"]


@pytest.mark.long
def test_a_coarse_integration_step_is_a_cause(tmp_path):
    case = null(3)
    result = said_of(case, tmp_path, integrator="euler", effects=LIKE_IT)
    assert [cause.tag for cause in result.causes] == ["integration-step"]
    assert "integration step" in result.sentence()


def test_without_test_trials_each_trial_is_left_out_in_turn(tmp_path):
    case = single("gyro-bias", 3, seed=1)
    files(case, tmp_path)
    trials = load_trials(tmp_path)
    kept = {name: trials.trials[name] for name in ("turn_p10", "turn_m20", "zigzag_20")}
    v_m = kept["zigzag_20"].v_m.copy()
    v_m[100:160] = np.nan  # nothing to take a mean of, for a minute
    kept["zigzag_20"] = replace(kept["zigzag_20"], v_m=v_m)
    alone = replace(trials, trials=kept, tune=tuple(kept), test=())
    result = diagnose(load_profile("suzaku"), alone, DiagnoseOptions(effects=LIKE_IT))
    assert result.gain.held_out == "each"
    assert len(result.gain.compared) == 3
    assert [cause.tag for cause in result.causes] == ["gyro-bias"]
    assert covered(case.effects, result.to_dict()) == [True]


def test_a_window_of_few_samples_has_its_share_in_the_noise():
    class Cases:
        rows = np.full((2, 500, 6), -1)

        def __len__(self):
            return 2

    Cases.rows[0] = np.arange(3000).reshape(500, 6)
    Cases.rows[1, :3] = np.arange(3000, 3018).reshape(3, 6)
    model = estimate(Cases(), 2.0 * np.random.default_rng(2).standard_normal(3018))
    assert all(noise.white == pytest.approx(4.0, rel=0.3) for noise in model.channels.values())


def test_noise_with_a_memory_is_told_from_white_noise_and_whitened():
    rng = np.random.default_rng(1)

    class Cases:
        rows = np.arange(6 * 4000).reshape(2, 2000, 6)

        def __len__(self):
            return 2

    n = 2000
    values = np.empty((2, n, 6))
    for case in range(2):
        for k in range(6):
            slow = np.zeros(n)
            drive = rng.standard_normal(n)
            for i in range(1, n):
                slow[i] = 0.95 * slow[i - 1] + np.sqrt(1 - 0.95**2) * drive[i]
            values[case, :, k] = rng.standard_normal(n) + (slow if k < 3 else 0.0)
    flat = values.reshape(-1)
    model = estimate(Cases(), flat)
    assert isinstance(model, NoiseModel)
    for name, noise in model.channels.items():
        if name in ("x", "y", "psi"):
            assert noise.phi == pytest.approx(0.95, abs=0.03)
            assert noise.fading == pytest.approx(1.0, abs=0.35)
        else:
            assert noise.fading == 0.0
    white = model.apply(flat)
    by_channel = white.reshape(2, n, 6)
    for k in range(6):
        x = by_channel[0, :, k]
        assert x.var() == pytest.approx(1.0, abs=0.15)
        assert abs(np.corrcoef(x[1:], x[:-1])[0, 1]) < 0.08
    assert np.allclose(model.restore(white), flat, atol=1e-8)


def test_a_rate_that_is_not_there_has_no_direction():
    ends = {"north": (-0.115, 0.001), "east": (0.096, 0.001), "north_rate": (-7e-7, 2e-6), "east_rate": (-1e-6, 2e-6)}
    known = {
        f"effects.current.{name}": Estimate(f"effects.current.{name}", value, value - half, value + half, half / 1.96)
        for name, (value, half) in ends.items()
    }
    effect = find_effect("current")
    words = effect.sentence(parameters_in_words(effect, known))
    assert "setting towards 140°, which hardly changed during a run: by 0.0007" in words
    grown = {**known, "effects.current.east_rate": replace(known["effects.current.east_rate"], value=1e-4, low=9.8e-5)}
    assert "gained" in effect.sentence(parameters_in_words(effect, grown))


def test_options_that_make_no_sense_are_said():
    with pytest.raises(OptionError, match="unknown effect 'curent'"):
        DiagnoseOptions(effects=("curent",))
    with pytest.raises(OptionError, match="most is 0"):
        DiagnoseOptions(most=0)
    with pytest.raises(OptionError, match="unknown integrator"):
        DiagnoseOptions(integrator="eulr")


def test_the_command_writes_a_folder_and_tells_ci(tmp_path):
    files(single("speed-scale", 3, seed=1), tmp_path / "trials")
    few = ("--effects", "speed-scale,current,resistance,rpm-scale")
    said = run(
        "diagnose", "-t", "trials", *few, "--out", "run", "--json", "--quiet", "--fail-on", "found", cwd=tmp_path
    )
    assert said.code == 1, said.err
    document = said.json()
    assert document["verdict"] == "found"
    assert document["verdict"] in VERDICTS
    assert [cause["effect"] for cause in document["causes"]] == ["speed-scale"]
    for name in ("diagnosis.json", "profile.toml", "motions.parquet", "report.html", "report.md"):
        assert (tmp_path / "run" / name).is_file()
    formats = (ROOT / "docs" / "formats.md").read_text(encoding="utf-8")
    assert [key for key in document if f"`{key}`" not in formats] == []
    page = (tmp_path / "run" / "report.html").read_text()
    assert "speed log" in page
    extended = run("simulate", "-p", "run/profile.toml", "--trials", "trials", "--json", cwd=tmp_path)
    assert extended.code == 0, extended.err
    wrong = run("diagnose", "--fail-on", "fnd", cwd=tmp_path)
    assert wrong.code == 2
    assert "unknown verdict" in wrong.err
    taken = run("diagnose", "-t", "trials", "--out", "run", cwd=tmp_path)
    assert taken.code == 2


@pytest.mark.long
@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_very_shallow_water_is_told(seed, tmp_path):
    """1.7 draughts were another draught on two ships and nothing at all on a third."""
    result = said_of(single("shallow-water", 4, seed), tmp_path)
    assert [one.tag for one in result.causes] == ["shallow-water"]
    depth = result.causes[0].estimates["effects.shallow-water.depth"]
    assert depth.low - 0.1 < 6.5 < depth.high
