"""What data cannot tell apart is a group with the trial that would; what parameters must reach is reached."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.diagnose.answering.separate import Foretold, Suggestion, apart, holds, menu, suggest
from mmgtune.diagnose.bench.hypotheses import Hypothesis
from mmgtune.diagnose.bench.workbench import make_workbench
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.diagnose.searching.refitting import Refitting
from mmgtune.effects import find_effect
from mmgtune.motions import as_trial
from mmgtune.motions import simulate_trials as sailed
from mmgtune.orders import TurningOrder, ZigzagOrder, run_manoeuvre
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import load_trials
from mmgtune.units import DEG, NORMAL_95
from tests.diagnose.sensors import logged
from tests.hidden.cases import Case, null
from tests.hidden.plant import WHITE, simulate, write


def said_of(effects, folder, *asked):
    """The diagnosis of a ship with something hidden in her, which looks for a few effects."""
    case = Case("told-apart", null(4).ship, effects, 4, WHITE)
    write(simulate(case.ship, case.effects, case.seed, case.noise), folder)
    return diagnose(load_profile("suzaku"), load_trials(folder), DiagnoseOptions(effects=asked))


@pytest.mark.long
def test_a_dead_time_and_a_late_clock_are_a_group_and_a_change_of_revolutions_would_tell(tmp_path):
    result = said_of({"dead-time": {"seconds": 3.0}}, tmp_path, "clock-offset", "dead-time", "steering-lag")
    assert result.verdict == "not-separable"
    assert [set(group) for group in result.groups] == [{"clock-offset", "dead-time"}]
    assert result.suggestion is not None
    assert "the revolutions changed on the way" in result.suggestion.manoeuvre
    assert result.suggestion.distance > 10.0


@pytest.mark.daily("by a gear")
@pytest.mark.parametrize(
    ("tag", "hidden", "rivals"),
    [
        ("clock-offset", {"seconds": 60.0}, ("dead-time", "current")),
        ("rpm-scale", {"factor": 2.0}, ("thrust", "resistance", "current")),
    ],
    ids=["late", "by a gear"],
)
def test_what_lies_far_from_where_a_search_begins_is_found(tag, hidden, rivals, tmp_path):
    """A control log a minute late and revolutions logged by half were three causes that nobody could believe."""
    result = said_of({tag: hidden}, tmp_path, tag, *rivals)
    assert result.verdict == "found"
    assert [cause.tag for cause in result.causes] == [tag], result.sentence()
    ((name, truth),) = hidden.items()
    found = result.to_dict()["causes"][0]["parameters"][name]
    assert found["ci95"][0] < truth < found["ci95"][1]


@pytest.mark.long
def test_a_blade_that_begins_at_one_end_of_its_play_is_told(tmp_path):
    """From its middle it was a wind, another one in each run."""
    hidden = {"play": 3.0 * DEG, "begins": -1.0}
    result = said_of({"backlash": hidden}, tmp_path, "backlash", "wind", "rudder-gain")
    assert [cause.tag for cause in result.causes] == ["backlash"], result.sentence()
    found = result.to_dict()["causes"][0]["parameters"]
    assert found["play"]["ci95"][0] < hidden["play"] < found["play"]["ci95"][1]
    assert found["begins"]["value"] == pytest.approx(-1.0, abs=0.3)


def test_a_loose_blade_is_told(tmp_path):
    """An order of 10 deg that turned the blade by 8.5, whichever way, was a wind of each run and a flap."""
    hidden = {"pushed": 3.0 * DEG}
    result = said_of({"backlash": hidden}, tmp_path, "backlash", "flap")
    assert [cause.tag for cause in result.causes] == ["backlash"], result.sentence()
    assert "within which the flow pushes the blade back to amidships" in result.sentence()
    found = result.to_dict()["causes"][0]["parameters"]["pushed"]
    assert found["ci95"][0] < hidden["pushed"] < found["ci95"][1]


@pytest.mark.parametrize(("late", "may_be"), [(10.0, True), (40.0, False)])
def test_a_clock_of_single_runs_is_not_off_by_more_than_gears_take(late, may_be):
    """An engine that followed its telegraph late was a clock of the runs in which it was moved, half a minute late."""
    trials = list(load_trials("suzaku").trials.values())[:3]
    effect = find_effect("clock-offset")
    groups = tuple(f"trial:{trial.id}" for trial in trials)
    apart = Hypothesis(effect, ("seconds",), "trial", groups)
    bench = make_workbench(load_profile("suzaku"), trials, DiagnoseOptions(), apart.bases)
    unit = bench.sub_box(apart.names).to_unit(np.array([late, 0.0, -1.0]))
    end = SimpleNamespace(names=apart.names, unit=unit)
    refitting = Refitting(SimpleNamespace(bench=bench))
    assert refitting._may_be_of_runs(apart, end) == may_be
    alike = SimpleNamespace(names=apart.bases, unit=unit[:1])
    assert refitting._may_be_of_runs(Hypothesis(effect, ("seconds",)), alike)


@pytest.mark.long
def test_a_slope_of_resistance_of_a_quarter_per_metre_per_second_is_within_reach(tmp_path):
    slope = 0.25 * np.sqrt(9.81 * 83.0)
    result = said_of({"resistance": {"slope": slope}}, tmp_path, "resistance", "hull-term")
    assert [cause.tag for cause in result.causes] == ["resistance"]
    found = result.to_dict()["causes"][0]["parameters"]["slope"]
    assert found["ci95"][0] < slope < found["ci95"][1]
    assert result.gain.share_removed > 0.95


@pytest.mark.long
def test_the_quadrantal_deviation_of_a_compass_is_found(tmp_path):
    D = float(np.radians(2.5))
    hidden = {"unknown-deviation-quadrantal": {"magnitude": D}}
    result = said_of(hidden, tmp_path, "compass-deviation", "heading-bias", "current", "log-misalignment")
    assert [cause.tag for cause in result.causes] == ["compass-deviation"]
    found = result.to_dict()["causes"][0]["parameters"]
    assert found["sine_of_twice"]["ci95"][0] < D < found["sine_of_twice"]["ci95"][1]
    for name in ("sine", "cosine", "cosine_of_twice"):
        assert abs(found[name]["value"]) < 0.1 * D, name


@pytest.mark.long
@pytest.mark.parametrize(
    ("hidden", "rivals", "covered"),
    [
        ({"steady-force": {"ahead": -2.5e4}}, ("thrust", "rpm-scale", "resistance", "loading"), {"ahead": -2.5e4}),
        (
            {"position-latency": {"with_velocity": 3.0}},
            ("antenna", "velocity-filter", "clock-offset", "current", "hull-term"),
            {"with_velocity": 3.0},
        ),
    ],
    ids=lambda one: next(iter(one)) if isinstance(one, dict) else "",
)
def test_a_tow_and_a_late_receiver_are_found(hidden, rivals, covered, tmp_path):
    """A chain that drags was less thrust, and a receiver that smooths all it shows in no registry."""
    (tag,) = hidden
    result = said_of(hidden, tmp_path, tag, *rivals)
    assert [cause.tag for cause in result.causes] == [tag], result.sentence()
    assert result.causes[0].runs is None
    found = result.to_dict()["causes"][0]["parameters"]
    assert set(found) == set(covered), result.sentence()
    for name, truth in covered.items():
        low, high = found[name]["ci95"]
        off = abs(truth - 0.5 * (low + high)) / (0.5 * (high - low))
        assert off < 2.58 / NORMAL_95, name  # 99 %
    assert result.gain.share_removed > 0.9


@pytest.mark.long
def test_a_gear_of_a_limited_rate_that_lags_too_is_found_whole():
    """Its rate alone was told: beside a rate the way on from no lag is flat."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(6)
    ordered = []
    four = [*load_trials("suzaku").trials.values()][:4]
    for trial, angle, every in zip(four, (30.0, -20.0, 10.0, -30.0), (900.0, 60.0, 40.0, 80.0), strict=True):
        turned = np.where((trial.t - 10.0) // every % 2 == 0, 1.0, -1.0) * (trial.t >= 10.0)
        ordered.append(replace(trial, delta=turned * angle * DEG))
    ship = with_effects(profile, {"steering-lag": {"time_constant": 5.0, "rate_limit": 2.5 * DEG}}, "made")
    made = [logged(trial, motion, rng) for trial, motion in zip(ordered, sailed(ship, ordered), strict=True)]
    result = diagnose(profile, made, DiagnoseOptions(effects=("steering-lag", "dead-time", "rudder-stall")))
    assert [cause.tag for cause in result.causes] == ["steering-lag"], result.sentence()
    found = result.to_dict()["causes"][0]["parameters"]
    for name, truth in {"time_constant": 5.0, "rate_limit": 2.5 * DEG}.items():
        assert found[name]["ci95"][0] < truth < found[name]["ci95"][1], name


@pytest.mark.long
def test_a_stall_that_leaves_the_force_some_of_its_slope_is_no_gain_of_the_rudder():
    profile = load_profile("suzaku")
    rng = np.random.default_rng(12)
    trials = list(load_trials("suzaku").trials.values())
    ship = with_effects(profile, {"rudder-stall": {"angle": 0.3, "slope": 0.6}}, "made")
    made = [logged(trial, motion, rng) for trial, motion in zip(trials, sailed(ship, trials), strict=True)]
    asked = ("rudder-stall", "rudder-gain", "rudder-offset", "flap", "propeller-walk")
    result = diagnose(profile, made, DiagnoseOptions(effects=asked))
    assert [cause.tag for cause in result.causes] == ["rudder-stall"]
    found = result.to_dict()["causes"][0]["parameters"]["angle"]
    assert found["ci95"][0] < 0.3 < found["ci95"][1]


@pytest.mark.long
@pytest.mark.parametrize("width", [0.0, 10.0])
def test_a_stall_with_a_shoulder_is_one_cause(width):
    """Beside a sharp one stood a gain of the rudder to each side, and a trim of each run."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(12)
    trials = list(load_trials("suzaku").trials.values())
    ship = with_effects(profile, {"rudder-stall": {"angle": 0.33, "slope": -0.4, "width": width * DEG}}, "made")
    made = [logged(trial, motion, rng) for trial, motion in zip(trials, sailed(ship, trials), strict=True)]
    asked = ("rudder-stall", "rudder-gain", "loading", "hull-term")
    result = diagnose(profile, made, DiagnoseOptions(effects=asked))
    assert [cause.tag for cause in result.causes] == ["rudder-stall"], result.sentence()
    found = result.to_dict()["causes"][0]["parameters"]["angle"]
    assert found["ci95"][0] < 0.33 < found["ci95"][1]


@pytest.mark.long
def test_a_gyro_that_settles_is_off_and_drifts():
    """Its error died away within minutes, and no sum of an even one and a drift without end left noise."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(5)
    trials = list(load_trials("suzaku").trials.values())
    made = [logged(trial, motion, rng) for trial, motion in zip(trials, sailed(profile, trials), strict=True)]
    made = [replace(one, psi=one.psi + 3.0 * DEG * np.exp(-one.t / 250.0)) for one in made]
    asked = ("heading-bias", "gyro-drift", "compass-deviation", "heading-filter")
    result = diagnose(profile, made, DiagnoseOptions(effects=asked))
    assert {cause.tag for cause in result.causes} == {"heading-bias", "gyro-drift"}, result.sentence()


@pytest.mark.long
def test_at_one_rpm_a_side_force_of_the_revolutions_and_a_steady_force_are_a_group():
    """Beside a late position log: each is tried in the place of the other from the ship as it was found."""
    profile, rng = load_profile("kvlcc2"), np.random.default_rng(3)
    hidden = {"propeller-walk": {"share": 0.04, "revolutions": 1.0}, "position-latency": {"seconds": 6.0}}
    ship = with_effects(profile, hidden, "made")
    orders = {
        "turn_p35": TurningOrder(35.0 * DEG),
        "turn_m20": TurningOrder(-20.0 * DEG),
        "zigzag_20": ZigzagOrder(20.0 * DEG, 20.0 * DEG),
        "zigzag_m10": ZigzagOrder(-10.0 * DEG, 10.0 * DEG),
    }
    motions = [run_manoeuvre(ship, order, id=name, longest=1200.0, sample=2.0) for name, order in orders.items()]
    made = [logged(as_trial(ship, motion), motion, rng) for motion in motions]
    asked = ("propeller-walk", "steady-force", "position-latency", "antenna", "clock-offset")
    result = diagnose(profile, made, DiagnoseOptions(effects=asked))
    assert {"propeller-walk", "steady-force"} in [set(group) for group in result.groups], result.sentence()
    assert "position-latency" in [cause.tag for cause in result.causes]


@pytest.mark.long
def test_a_gain_that_changes_with_the_angle_is_no_flap_and_no_stall(tmp_path):
    case = Case("curved", null(6).ship, {"rudder-gain": {"factor": 0.96, "curve": -0.12}}, 6, WHITE)
    write(simulate(case.ship, case.effects, case.seed, case.noise), tmp_path)
    asked = ("rudder-gain", "rudder-stall", "rudder-limit", "rudder-offset", "flap")
    result = diagnose(load_profile("suzaku"), load_trials(tmp_path), DiagnoseOptions(effects=asked))
    assert [cause.tag for cause in result.causes] == ["rudder-gain"], result.sentence()
    found = result.to_dict()["causes"][0]["parameters"]
    for name, truth in {"factor": 0.96, "curve": -0.12}.items():
        assert found[name]["ci95"][0] < truth < found[name]["ci95"][1]
    assert "a factor that changed by -0.1" in result.sentence()


def test_one_trial_of_the_menu_changes_its_revolutions():
    ship = load_profile("suzaku")
    (one,) = [one for one in menu(ship.L_pp / ship.approach.speed) if one.engine]
    motion = run_manoeuvre(ship, one.helmsman, n=ship.approach.n, longest=one.longest, step=1.0, engine=one.engine)
    n = motion.controls[:, motion.inputs.index("n")]
    assert n[0] == ship.approach.n
    assert n[-1] == 0.5 * ship.approach.n
    assert np.count_nonzero(np.diff(n)) == 1


def test_no_trial_is_suggested_that_was_sailed():
    """Of the bundled turns of 35 deg that to starboard begins at 111 deg, that to port at -56 deg."""
    ship = load_profile("suzaku")
    trials = list(load_trials("suzaku").trials.values())
    sailed = [one.words for one in menu(ship.L_pp / ship.approach.speed) if holds(trials, one, ship.approach.n)]
    assert sailed == [
        "turning test, rudder 35 deg to starboard, approach heading 90 deg",
        "zigzag 10/10",
        "zigzag 20/20",
    ]
    slower = [replace(trial, n=0.6 * trial.n) for trial in trials]
    assert not any(holds(slower, one, ship.approach.n) for one in menu(ship.L_pp / ship.approach.speed))


@pytest.mark.long
def test_of_terms_alike_on_one_side_that_of_a_hull_of_two_like_sides_is_named(tmp_path):
    case = Case("one-sided", null(4).ship, {"hull-term": {"Y_vabsv": -0.3}}, 4, WHITE)
    write(simulate(case.ship, case.effects, case.seed, case.noise), tmp_path)
    trials = load_trials(tmp_path)
    trials = replace(trials, tune=("turn_p10", "turn_p35", "turn_p20"), test=("turn_m20", "zigzag_20"))
    kept = {name: trials.trials[name] for name in (*trials.tune, *trials.test)}
    options = DiagnoseOptions(
        effects=("hull-term",), leeway=0.0
    )  # three turns tell such a term from no other of a loose hull
    result = diagnose(load_profile("suzaku"), replace(trials, trials=kept), options)
    assert result.verdict in ("found", "not-separable"), result.sentence()
    assert list(result.to_dict()["causes"][0]["parameters"]) == ["Y_vabsv"]


def foretold(states, spread=None):
    """What is foretold of x and y at three samples."""
    sample, channel = np.repeat(np.arange(3), 2), np.tile([0, 1], 3)
    return Foretold(np.array(states, float), channel, sample, np.zeros((6, 1)) if spread is None else np.array(spread))


SIGMA = np.array([0.5, 0.5, 0.01, 0.02, 0.02, 0.001])


def test_what_a_rival_can_take_up_tells_nothing():
    """It counts (d' (1 + A A')^-1 d): all of d where A is across, hardly any of it where A is along and large."""
    rng = np.random.default_rng(2)
    d, A = rng.standard_normal(6), rng.standard_normal((6, 2))
    there, nowhere = foretold(d), np.zeros(6)
    assert apart(there, foretold(nowhere), SIGMA)[0] == pytest.approx(np.linalg.norm(d))
    counted = d @ np.linalg.solve(np.eye(6) + A @ A.T, d)
    assert apart(there, foretold(nowhere, A), SIGMA)[0] == pytest.approx(np.sqrt(counted))
    along = apart(there, foretold(nowhere, 100.0 * d[:, None]), SIGMA)
    assert along[0] < 0.02
    assert along[1] < 0.01
    assert apart(there, foretold(nowhere), SIGMA)[1] == pytest.approx(
        0.5 * max(np.hypot(d[2 * k], d[2 * k + 1]) for k in range(3))
    )


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("far", [1e200, np.inf])
def test_a_motion_that_ran_away_is_infinitely_far_and_no_warning(far):
    straight, away = foretold(np.zeros(6)), foretold([0.0, 0.0, 0.0, 0.0, far, far])
    assert apart(straight, away, SIGMA)[0] == np.inf
    assert apart(straight, foretold(np.zeros(6), np.full((6, 1), np.inf)), SIGMA) == (np.inf, np.inf)


MEASURES = {"rpm-scale": "the revolutions, counted at the shaft", "loading": "the draughts, read from the marks"}


@pytest.mark.parametrize(
    ("manoeuvre", "distance", "measures", "said"),
    [
        ("zigzag 10/10", 40.0, {}, "A trial that would tell: zigzag 10/10."),
        (
            "zigzag 10/10",
            40.0,
            MEASURES,
            (
                "A trial that would tell: zigzag 10/10. So would, without a trial: the revolutions, counted at the "
                "shaft (rpm-scale) or the draughts, read from the marks (loading)."
            ),
        ),
        (
            "zigzag 10/10",
            1.0,
            MEASURES,
            (
                "None of 12 trials that were tried would tell. What would tell: the revolutions, counted at the shaft "
                "(rpm-scale) or the draughts, read from the marks (loading)."
            ),
        ),
        ("zigzag 10/10", 1.0, {}, "None of 12 trials that were tried would tell."),
    ],
)
def test_a_trial_that_would_not_tell_is_not_proposed(manoeuvre, distance, measures, said):
    one = Suggestion(manoeuvre, ("rpm-scale", "loading"), distance, 0.1, 12, measures)
    assert one.sentence() == said
    assert one.to_dict()["trial_tells"] is (distance > 5.0)


@pytest.mark.long
def test_another_draught_and_slower_revolutions_are_told_by_what_is_measured_on_board():
    """Two fits that tell the bundled trials alike: no trial of the menu would tell what re-tuning can take up."""
    profile, trials = load_profile("suzaku"), load_trials("suzaku")
    bench = make_workbench(
        profile,
        list(trials.trials.values()),
        DiagnoseOptions(),
        ["effects.rpm-scale.factor", "effects.loading.draught"],
    )
    base = base_fit(bench)
    rivals = []
    for name in ("effects.rpm-scale.factor", "effects.loading.draught"):
        tag = name.split(".")[1]
        unit = np.append(base.unit, bench.null([name]))
        rivals.append((tag, bench.refit((*base.names, name), unit[:, None], base.offsets)))
    found = suggest(bench, rivals)
    assert found is not None
    assert set(found.measures) == {"rpm-scale", "loading"}
    assert found.tried > 8
    far = [(tag, replace(point, unit=np.append(point.unit[:-1], 0.9))) for tag, point in rivals]
    assert suggest(bench, far).distance > found.distance
