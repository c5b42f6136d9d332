"""What a check says of a model that is as good, better, worse, or not to be compared."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.checking import check, read_baseline, record_baseline, write_baseline
from mmgtune.checking.baseline import Recorded
from mmgtune.checking.measuring import measure
from mmgtune.checking.sensitivity import pairs, sensitivity
from mmgtune.errors import OptionError
from mmgtune.fitting import FitOptions, fit
from mmgtune.measures import distance_measures, reference_of
from mmgtune.metrics import METRICS
from mmgtune.model import Model
from mmgtune.motions import simulate_trials
from mmgtune.networks import save_network
from mmgtune.profile import parse_profile, with_effects
from mmgtune.trial import TrialSet, load_trials
from tests.networks.made import network


def test_metrics_are_those_of_the_fit_and_of_the_measures(ship, data):
    """J is the fit's, the distances are the paper's functions, the root mean squares are done by hand."""
    found = measure(Model(ship), list(data.trials.values()), list(METRICS))[0]
    fitted = fit(ship, data, FitOptions(method="least-squares", starts=1))
    J = {one.trial.id: one.J["before"] for one in fitted.compared}
    for trial, motion in zip(data.trials.values(), simulate_trials(ship, list(data.trials.values())), strict=True):
        values = found[trial.id]
        assert values["J"] == pytest.approx(J[trial.id], rel=1e-9)
        for name, value in distance_measures(trial.motion, motion.states, reference_of(trial.motion)).items():
            assert values[name] == pytest.approx(value, rel=1e-9), name
        difference = (motion.states - trial.motion)[1:]
        assert values["rms_y"] == pytest.approx(np.sqrt(np.mean(difference[:, 1] ** 2)))
        assert values["rms_psi"] == pytest.approx(np.degrees(np.sqrt(np.mean(difference[:, 2] ** 2))))
        assert values["rms_v"] == pytest.approx(np.sqrt(np.mean(difference[:, 4] ** 2)))


def test_a_model_has_no_error_on_its_own_trials(ship, data):
    own = [
        replace(trial, **{name: motion.channel(name) for name in ("x", "y", "psi", "u", "v_m", "r")})
        for trial, motion in zip(data.trials.values(), simulate_trials(ship, list(data.trials.values())), strict=True)
    ]
    (found,) = measure(Model(ship), own, list(METRICS))
    assert {"advance", "tactical_diameter"} <= set(found["turn_p35"])
    assert {"overshoot_1", "overshoot_2"} <= set(found["zigzag_20"])
    assert max(abs(value) for values in found.values() for value in values.values()) < 1e-9


def test_the_same_model_passes(ship, data, baseline):
    report = check(ship, data, baseline)
    assert report.verdict == "pass"
    assert {item.status for item in report.items} == {"ok"}
    assert report.changed == ()
    assert report.n_compared == len(report.items) > 40


def test_a_regression_is_named_with_what_it_is_owed_to(worse):
    assert worse.verdict == "regressed"
    worst = worse.by_status["regressed"][0]
    assert abs(worst.now) > worst.allowed > abs(worst.baseline)
    first, second = worse.changed
    assert (first.name, first.baseline, first.now) == ("hull.N_r", -0.057, -0.055)
    assert first.share > 0.5 > abs(second.share)
    lines = Path(worse.profile_file).read_text(encoding="utf-8").splitlines()
    assert lines[first.line - 1].startswith("N_r = -0.057")
    assert "hull.N_r" in str(first)


def test_an_effect_that_has_faded_away_goes_into_a_baseline(ship, data, tmp_path):
    """Some effects are none at infinity, a number that JSON does not have."""
    faded = with_effects(ship, {"rudder-stall": {}}, "test")
    there = with_effects(ship, {"rudder-stall": {"angle": 0.3}}, "test")
    assert np.isinf(faded.value("effects.rudder-stall.angle"))
    path = tmp_path / "baseline.json"
    write_baseline(record_baseline(faded, data), path)
    baseline = read_baseline(path)
    same = check(faded, data, baseline)
    assert (same.verdict, same.changed) == ("pass", ())
    (changed,) = check(there, data, baseline).changed
    assert str(changed).startswith("effects.rudder-stall.angle: inf -> 0.3")
    assert "%" not in str(changed).partition(",")[0]
    assert changed.to_dict()["baseline"] is None
    assert "effects.rudder-stall.angle" not in pairs(sensitivity(faded, data, baseline, 0.02))


def test_an_improvement_fails_nothing(ship, data, baseline, changed):
    tuned = fit(ship, data, FitOptions(method="least-squares", starts=1))
    report = check(parse_profile(tuned.tuned_text()), data, baseline)
    assert len(report.by_status["improved"]) > 30
    regressed = {item.metric for item in report.by_status["regressed"]}
    assert "J" not in regressed
    # Back again is a regression, and is owed to several coefficients.
    back = check(ship, data, record_baseline(parse_profile(tuned.tuned_text()), data))
    assert back.verdict == "regressed"
    assert len(back.changed) > 5


def test_tolerances(ship, data, baseline, changed):
    slightly = changed(N_r=-0.0569)
    tight = {name: {"relative": 0.0, "absolute": 0.0} for name in baseline.tolerances}
    loose = {name: {"relative": 1.0} for name in baseline.tolerances}
    assert check(slightly, data, replace(baseline, tolerances=tight)).verdict == "regressed"
    assert check(slightly, data, replace(baseline, tolerances=loose)).verdict == "pass"
    of_one = {**loose, "turn_p35/J": {"relative": 0.0}}
    (only,) = check(slightly, data, replace(baseline, tolerances=of_one)).by_status["regressed"]
    assert (only.trial, only.metric) == ("turn_p35", "J")


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_errors_of_indices_count_by_their_size(ship, data, baseline, sign):
    """An advance 3 % too long that was 4 % too short is better."""
    turn = baseline.trials["turn_p35"]
    now = turn.metrics["advance"]
    shifted = replace(turn, metrics={**turn.metrics, "advance": sign * (abs(now) + 1.0)})
    report = check(ship, data, replace(baseline, trials={**baseline.trials, "turn_p35": shifted}))
    (better,) = report.by_status["improved"]
    assert (better.trial, better.metric) == ("turn_p35", "advance")


def test_changed_added_and_missing_trials_cannot_be_compared(ship, data, baseline):
    turn, zigzag = baseline.trials["turn_p35"], baseline.trials["zigzag_20"]
    then = {"turn_p35": replace(turn, sha256="0" * 64), "zigzag_20": zigzag, "gone": turn}
    report = check(ship, data, replace(baseline, trials=then))
    assert report.verdict == "not comparable"
    told = {item.trial: item.reason for item in report.by_status["not comparable"]}
    assert set(told) == {"turn_p35", "turn_m20", "gone"}
    assert "changed" in told["turn_p35"]
    assert not any(item.metric for item in report.items if item.trial == "turn_p35")


def test_a_regression_outweighs_what_cannot_be_compared(data, baseline, changed):
    then = {**baseline.trials, "turn_p35": replace(baseline.trials["turn_p35"], sha256="0" * 64)}
    assert check(changed(N_r=-0.05), data, replace(baseline, trials=then)).verdict == "regressed"


def test_a_metric_lost_or_new(ship, data, baseline):
    turn = baseline.trials["turn_p35"]
    lost = Recorded(turn.sha256, {**turn.metrics, "overshoot_1": 1.0})
    report = check(ship, data, replace(baseline, trials={**baseline.trials, "turn_p35": lost}))
    (odd,) = report.by_status["not comparable"]
    assert (odd.metric, odd.now) == ("overshoot_1", None)
    less = Recorded(turn.sha256, {name: v for name, v in turn.metrics.items() if name != "J"})
    (odd,) = check(ship, data, replace(baseline, trials={**baseline.trials, "turn_p35": less})).by_status[
        "not comparable"
    ]
    assert (odd.metric, odd.baseline) == ("J", None)


def test_a_channel_that_was_never_measured(ship, data):
    trial = data.trials["turn_p35"]
    r = np.full(trial.n_samples, np.nan)
    r[0] = trial.r[0]
    silent = replace(data, trials={"turn_p35": replace(trial, r=r)}, tune=("turn_p35",))
    before = record_baseline(ship, silent)
    assert "rms_r" not in before.trials["turn_p35"].metrics
    both = replace(before, tolerances={**before.tolerances, "rms_r": {"relative": 0.01}})
    (item,) = check(ship, silent, both).by_status["not shown"]
    assert item.reason == "the trial has no measured r"
    assert check(ship, silent, both).verdict == "pass"


def test_divergence(ship, data, baseline, changed):
    wild = changed(N_rrr=8.0)
    report = check(wild, data, baseline)
    assert report.verdict == "regressed"
    assert math.isinf(report.by_status["regressed"][0].now)
    recorded = record_baseline(wild, data)
    assert check(wild, data, recorded).verdict == "pass"
    assert check(ship, data, recorded).by_status["improved"]


def test_limits_of_the_profile(ship, data, baseline):
    limited = parse_profile(ship.text + '\n[limits]\nsource = "owner"\nJ = 1000\ntactical_diameter = "50 %"\n')
    assert limited.limits == {"J": 1000.0, "tactical_diameter": 50.0}
    report = check(limited, data)
    assert report.verdict == "regressed"
    assert {item.metric for item in report.items} == {"J", "tactical_diameter"}
    assert all("limit of 1000" in item.reason for item in report.by_status["regressed"])
    with_both = check(limited, data, baseline)
    assert {item.metric for item in with_both.by_status["regressed"]} == {"J"}
    assert with_both.n_compared > 40


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        ("rms_psi = 5", "no unit"),
        ('rms_psi = "5 kn"', "unit 'kn'"),
        ("nonsense = 5", "nonsense"),
        ('advance = "-1 %"', "impossible"),
    ],
)
def test_wrong_limits(ship, limits, said):
    with pytest.raises(Exception, match=said):
        parse_profile(f"{ship.text}\n[limits]\n{limits}\n")


def test_nothing_to_compare_with(ship, data, baseline):
    with pytest.raises(OptionError, match="nothing to compare"):
        check(ship, data)
    with pytest.raises(OptionError, match="of ship 'other'"):
        check(ship, data, replace(baseline, ship="other"))
    with pytest.raises(OptionError, match="made with rk4"):
        check(ship, data, baseline, integrator=Integrator("euler"))
    with pytest.raises(OptionError, match="unknown metric"):
        check(ship, data, baseline, metrics=("JJ",))


def test_back_ends_agree_far_below_any_tolerance(ship, data, baseline):
    report = check(ship, data, baseline, backend="numpy")
    assert report.verdict == "pass"
    assert max(abs(item.now - item.baseline) for item in report.items) < 1e-6
    assert any("back end" in note for note in report.notes)


def test_the_file_reads_back(baseline, tmp_path):
    write_baseline(baseline, tmp_path / "check.json")
    assert read_baseline(tmp_path / "check.json") == baseline


def test_an_updated_baseline_keeps_what_people_wrote_into_it(ship, data, baseline):
    own = {**baseline.tolerances, "J": {"relative": 0.2}, "turn_p35/J": {"absolute": 3.0}, "gone/J": {"absolute": 1.0}}
    again = record_baseline(ship, data, before=replace(baseline, tolerances=own))
    assert again.tolerances["J"] == {"relative": 0.2}
    assert again.tolerances["turn_p35/J"] == {"absolute": 3.0}
    assert "gone/J" not in again.tolerances
    fewer = record_baseline(ship, data, ("J", "advance"), before=baseline)
    assert fewer.metrics == ["J", "advance"]


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda text: text[:200], "cannot be read"),
        (lambda text: "[]", "not a baseline"),
        (lambda text: text.replace("check-baseline", "fit"), "not a baseline"),
        (lambda text: text.replace('"schema": 1', '"schema": 9'), "schema is 9"),
        (lambda text: text.replace('"integrator"', '"integrater"'), "not complete"),
        (lambda text: text.replace('"sha256"', '"sha"'), "not complete"),
        (lambda text: text.replace('"integrator": "rk4"', '"integrator": "../.."'), "unknown integrator"),
        (lambda text: text.replace('"substeps": 1', '"substeps": -1'), "substeps is -1"),
        (lambda text: text.replace('"substeps": 1', '"substeps": 1e999'), "not complete"),
        (lambda text: text.replace('"backend": "compiled"', '"backend": "cuda"'), "unknown back end"),
        (lambda text: text.replace('"relative": 0.01', '"relative": -1'), "relative = -1"),
        (lambda text: text.replace('"relative": 0.01', '"relatif": 1'), "relatif"),
        (lambda text: text.replace('"cVDM"', '"cvdm"'), "unknown metric"),
        (lambda text: json.dumps({**json.loads(text), "trials": {}}), "no trial"),
        (lambda text: json.dumps({**json.loads(text), "tolerances": {}}), "no tolerance"),
        (lambda text: json.dumps({**json.loads(text), "trials": [1]}), "not complete"),
        (lambda text: text.replace('"relative": 0.01', '"relative": "much"'), "not complete"),
    ],
)
def test_spoilt_baselines(baseline, tmp_path, spoil, said):
    path = tmp_path / "check.json"
    write_baseline(baseline, path)
    path.write_text(spoil(path.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(OptionError, match=said) as caught:
        read_baseline(path)
    assert "check.json" in str(caught.value)


def test_sensitivity_agrees_with_checks_one_by_one(ship, data, baseline, changed):
    rows = {(row.name, row.change): row for row in sensitivity(ship, data, baseline, 0.02)}
    for change, factor in (("+", 1.02), ("-", 0.98)):
        for symbol in ("N_r", "Y_v", "X_vv"):
            value = factor * ship.value(f"hull.{symbol}")
            report = check(changed(**{symbol: repr(value)}), data, baseline)
            row = rows[f"hull.{symbol}", change]
            assert row.regressed == len(report.by_status["regressed"]), (symbol, change)
            assert row.improved == len(report.by_status["improved"])
    by_name = pairs(list(rows.values()))
    assert any(row.noticed for row in by_name["hull.N_r"])
    assert not any(row.noticed for row in by_name["above_water.A_T"])  # there is no wind
    assert not any(row.noticed for row in by_name["particulars.rho"])  # ship and forces grow alike
    assert "propeller.phi_switch" in by_name
    with pytest.raises(OptionError, match="of itself"):
        sensitivity(ship, data, baseline, 2.0)


def test_the_committed_baseline_is_what_the_program_does(ship):
    """A wrong sign that fits the bundled trials better would pass the check; nothing may change at all here."""
    from mmgtune.resources import folder

    baseline = read_baseline(folder("trials") / "suzaku" / "check.json")
    report = check(ship, load_trials("suzaku"), baseline)
    for item in report.items:
        assert item.now == pytest.approx(item.baseline, rel=1e-6, abs=1e-9), (item.trial, item.metric)
    assert report.n_compared == len(report.items)


def test_a_trained_model_stands_where_a_profile_does(tmp_path):
    """Its baseline holds no coefficients; the same file passes, other weights do not, several networks are refused."""
    trial = load_trials("suzaku").trials["turn_p35"]
    data = TrialSet({trial.id: trial}, (trial.id,), (), ship="suzaku")
    one = replace(network(step=1.0, size=0.05), ship="suzaku", L_pp=83.0)
    path = save_network(one, tmp_path / "model.safetensors")
    baseline = record_baseline(path, data)
    assert not baseline.coefficients
    assert len(baseline.sha256) == 64
    same = check(path, data, baseline)
    assert same.verdict == "pass"
    assert same.sha256 == baseline.sha256
    other = save_network(
        replace(one, weights=one.weights._replace(W_3=3.0 * one.weights.W_3)), tmp_path / "b.safetensors"
    )
    assert check(other, data, baseline).verdict == "regressed"
    several = save_network(replace(network(members=2), ship="suzaku"), tmp_path / "several.safetensors")
    with pytest.raises(OptionError, match="2 networks"):
        check(several, data, baseline)
    with pytest.raises(OptionError, match="nothing to compare with"):
        check(path, data)
