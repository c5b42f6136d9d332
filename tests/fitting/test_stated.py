"""Fits to trials of which only indices are known."""

import json
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.errors import OptionError, TrialError
from mmgtune.fitting import FitOptions, LeaveOutOptions, fit, leave_out, make_problem
from mmgtune.fitting.weighing import weigh
from mmgtune.model import Model
from mmgtune.motions import as_trial
from mmgtune.orders import TurningOrder, run_manoeuvre
from mmgtune.profile import load_profile, tuned
from mmgtune.stated_indices import UNREACHED, residuals, simulated
from mmgtune.trial import TrialSet, load_trials, write_trial
from mmgtune.trial.index_trial import IndexTrial, Stated
from mmgtune.units import DEG
from tests.command import run
from tests.fitting.conftest import solve_asked
from tests.fitting.test_prior import scattered

QUICK = FitOptions(method="least-squares", starts=1)
FEW = ("hull.Y_v", "hull.N_v", "hull.N_r")
ORDERS = {
    "turn_35": ("turning", 35.0, None, ("advance", "transfer", "tactical_diameter")),
    "turn_m20": ("turning", -20.0, None, ("advance", "tactical_diameter")),
    "zz_10": ("zigzag", 10.0, 10.0, ("overshoot_1", "overshoot_2")),
    "zz_m20": ("zigzag", -20.0, 20.0, ("overshoot_1", "overshoot_2")),
}


def trial(id, indices, tolerance=0.02, **known):
    manoeuvre, rudder, check, names = ORDERS[id]
    stated = indices or dict.fromkeys(names, 1.0)
    return IndexTrial(
        id=id,
        ship="kvlcc2",
        manoeuvre=manoeuvre,
        rudder=rudder * DEG,
        check=None if check is None else check * DEG,
        astern=None,
        indices={name: Stated(value, tolerance * abs(value)) for name, value in stated.items()},
        sha256=id,
        **known,
    )


def of_ship(model, ids, tolerance=0.02):
    """Trials that state what a ship does herself."""
    trials = [trial(id, {}) for id in ids]
    made = simulated(model, model.matrix(), trials)
    return [
        trial(one.id, dict(zip(one.indices, values[:, 0].tolist(), strict=True)), tolerance)
        for one, values in zip(trials, made, strict=True)
    ]


def data(tune, test=(), series=()):
    both = {one.id: one for one in (*tune, *test)}
    own = {one.id: one for one in series}
    tunes, tests = tuple(one.id for one in tune), tuple(one.id for one in test)
    return TrialSet(own, tuple(own), (), "kvlcc2", stated=both, tune_stated=tunes, test_stated=tests)


def moved(profile, factors):
    """The profile with coefficients times factors, as one before any tuning."""
    values = {name: profile.value(name) * factor for name, factor in factors.items()}
    other = tuned(profile, values, {}, {})
    for name in values:
        kind, symbol = name.split(".")
        section = other.sections[kind]
        now = replace(section.coefficients[symbol], pre_determined=None)
        other.sections[kind] = replace(section, coefficients={**section.coefficients, symbol: now})
    return replace(other, name=profile.name)


@pytest.fixture(scope="module")
def truth():
    return Model(load_profile("kvlcc2"))


@pytest.fixture(scope="module")
def off(truth):
    """KVLCC2 from formulas: three coefficients 10 to 15 % off, each with a scatter of 15 %."""
    other = moved(truth.profile, dict(zip(FEW, (1.12, 0.88, 1.1), strict=True)))
    return scattered(other, 0.15, FEW)


@pytest.fixture(scope="module")
def fitted(truth, off):
    tune, test = of_ship(truth, ["turn_35", "zz_10"]), of_ship(truth, ["turn_m20", "zz_m20"])
    return fit(off, data(tune, test), replace(QUICK, targets=FEW))


def test_held_out_indices_are_recovered(fitted, truth):
    rms = {
        (role, which): np.sqrt(np.mean([one.off(which) ** 2 for one in fitted.stated if one.role == role]))
        for role in ("tune", "test")
        for which in ("before", "after")
    }
    assert rms["tune", "after"] < 0.2 * rms["tune", "before"]
    assert rms["test", "after"] < 0.3 * rms["test", "before"]
    for name in FEW:
        assert abs(fitted.theta[name] / truth.profile.value(name) - 1.0) < 0.1
    assert fitted.beside.weight.s2 == 1.0
    assert fitted.J == 0.0
    assert "5 stated numbers, 3 coefficients" in fitted.identifiability.sentences[0]
    assert all(fitted.identifiability.stderr[name] < 0.15 * abs(truth.profile.value(name)) * 1.2 for name in FEW)
    assert fitted.sentence().startswith("On 4 stated indices not used for tuning")


def test_indices_and_time_series_say_the_same(fitted, truth, off):
    motion = run_manoeuvre(truth, TurningOrder(35.0 * DEG, 20.0, 200.0 * DEG), id="series", sample=2.0)
    other = run_manoeuvre(truth, TurningOrder(-20.0 * DEG, 20.0, 200.0 * DEG), id="series_m", sample=2.0)
    series = [replace(as_trial(truth.profile, one), sha256=one.id) for one in (motion, other)]
    by_series = fit(off, data((), (), series), replace(QUICK, targets=FEW, prior=False))
    ways = [
        np.array([result.theta[name] - off.value(name) for name in FEW]) / [0.15 * off.value(name) for name in FEW]
        for result in (fitted, by_series)
    ]
    assert ways[0] @ ways[1] / np.linalg.norm(ways[0]) / np.linalg.norm(ways[1]) > 0.8


def test_both_kinds_of_trials_in_one_fit(truth, off):
    motion = run_manoeuvre(truth, TurningOrder(20.0 * DEG, 20.0, 200.0 * DEG), id="series", sample=2.0)
    series = replace(as_trial(truth.profile, motion), sha256="series")
    rng = np.random.default_rng(1)
    noisy = replace(series, x=series.x + rng.standard_normal(len(series.t)))
    both = data(of_ship(truth, ["zz_10"]), (), [noisy])
    problem = make_problem(off, both, replace(QUICK, targets=FEW))
    assert [(term.name, term.known_before) for term in problem.terms] == [("prior", True), ("indices", False)]
    for term in problem.terms:
        assert term.n_rows(problem) == len(term.residuals(problem, np.full((3, 1), 0.5)))
    start = problem.box.to_unit(problem.box.pre)
    weighed, weight = weigh(problem, start)
    assert 0.0 < weight.s2 < 1.0
    rows = weighed.residuals(start[:, None])[0]
    assert len(rows) == problem.n_residuals + 3 + 2
    assert rows @ rows == pytest.approx(weighed.costs(start[:, None])[0])
    assert solve_asked(problem, start[:, None]) != solve_asked(problem.with_weight(0.5), start[:, None])


def test_residuals_are_in_tolerances_and_finite(truth):
    (one,) = of_ship(truth, ["turn_35"])
    exact = residuals(truth, truth.matrix(), [one])
    np.testing.assert_allclose(exact, 0.0, atol=1e-9)
    shifted = trial("turn_35", {name: 1.1 * of.value for name, of in one.indices.items()})
    assert residuals(truth, truth.matrix(), [shifted])[:, 0] == pytest.approx(-0.1 / 1.1 / 0.02)
    dead = truth.matrix()
    dead[truth.rows["rudder.f_alpha"]] = 1e-6
    dead[truth.rows["hull.N_r"]] *= 4.0
    assert (residuals(truth, dead, [one]) == UNREACHED).all()
    lost = truth.matrix()
    lost[truth.rows["hull.R_0"]] = -1e9
    assert np.isfinite(residuals(truth, lost, [one])).all()


def test_the_order_of_files_does_not_matter(truth, tmp_path):
    text = '[[trial]]\nid = "{}"\nmanoeuvre = "turning"\norder = "{} deg"\n[trial.indices]\nadvance = "3 L"\n'
    costs = []
    for k, names in enumerate((("a", "b"), ("b", "a"))):
        folder = tmp_path / str(k)
        folder.mkdir()
        for file, id, angle in zip(names, "ab", (35, -20), strict=True):
            (folder / f"{file}.toml").write_text("schema = 1\n" + text.format(id, angle))
        problem = make_problem(truth.profile, load_trials(folder), replace(QUICK, targets=FEW))
        costs.append(problem.costs(np.full((3, 1), 0.4))[0])
    assert costs[0] == pytest.approx(costs[1], rel=1e-12)


def test_what_a_ship_cannot_be_asked_for(truth):
    hard = replace(trial("turn_35", {}), rudder=45.0 * DEG)
    stop = replace(trial("turn_35", {}), id="stop", manoeuvre="stopping", rudder=0.0, astern=-1.0)
    stop = replace(stop, indices={"track_reach": Stated(3000.0, 100.0)})
    mixed = replace(
        trial("turn_35", {}),
        id="mixed",
        indices={"transfer": Stated(900.0, 10.0), "tactical_diameter": Stated(2.5, 0.1, in_lengths=True)},
    )
    with pytest.raises(OptionError) as error:
        make_problem(truth.profile, data([hard, stop, mixed]), QUICK)
    words = "\n".join(f"{p.what} {p.why}" for p in error.value.problems)
    assert "45 deg of rudder" in words
    assert "no revolutions astern" in words
    assert "transfer is not below tactical_diameter" in words
    with pytest.raises(OptionError, match="CMA-ES is not for trials given as indices"):
        make_problem(truth.profile, data([trial("zz_10", {})]), FitOptions())
    with pytest.raises(TrialError, match="only indices are known"):
        data([trial("turn_35", {})]).series_only("a diagnosis")


def test_leaving_out_leaves_out_stated_trials(truth, off):
    tune = of_ship(truth, ["turn_35", "turn_m20"], 0.03)
    left = leave_out(off, data(tune), LeaveOutOptions(targets=FEW[:2], starts=1))
    assert left.n_parts == len(left.parts) == 2
    rms = left.stated_rms()
    assert rms["left_out"] < rms["before"]
    assert len(left.to_dict()["stated"]) == 5
    assert left.rows() == []


REPORT = """schema = 1
[[trial]]
id = "turn_35"
ship = "kvlcc2"
manoeuvre = "turning"
order = "35 deg"
[trial.indices]
advance = { value = "3.2 L", tolerance = "0.1 L" }
tactical_diameter = { value = "1020 m", tolerance = "30 m" }
[[trial]]
id = "zz_10"
manoeuvre = "zigzag"
order = "10/10 deg"
[trial.indices]
overshoot_1 = "7.5 deg"
overshoot_2 = "9 deg"
initial_turning_time = "70 s"
"""


def test_a_sea_trial_report_as_a_user_has_it(truth, tmp_path):
    folder = tmp_path / "trials"
    folder.mkdir()
    (folder / "report.toml").write_text(REPORT)
    few = ("--targets", "hull.Y_v,hull.N_v", "--starts", "1")
    flags = ("-p", "kvlcc2", "-t", "trials", *few)
    said = run("fit", *flags, "--dry-run", cwd=tmp_path)
    assert said.code == 2
    assert "add --method least-squares" in said.err
    flags = (*flags, "--method", "least-squares")
    said = run("fit", *flags, "--dry-run", cwd=tmp_path)
    assert said.code == 0, said.err
    assert "stated    turn_35: turning, 35 deg to starboard; advance, tactical_diameter" in said.out
    said = run("fit", *flags, "-o", "run", cwd=tmp_path)
    assert said.code == 0, said.err
    assert "7.5 +- 1.5*" in said.out
    record = json.loads((tmp_path / "run" / "fit.json").read_text())
    assert [row["index"] for row in record["stated"]][:2] == ["advance", "tactical_diameter"]
    assert record["stated"][0]["stated"] == pytest.approx(3.2)
    assert record["beside"]["squares"]["indices"]["after"] < record["beside"]["squares"]["indices"]["before"]
    assert "Stated indices" in (tmp_path / "run" / "report.md").read_text()
    said = run("validate", "kvlcc2", "run/profile.toml", "trials", cwd=tmp_path)
    assert said.code == 0, said.err
    assert said.out.count("tolerances, root mean square over 5 indices") == 2
    rows = run("validate", "kvlcc2", "trials", "--json", cwd=tmp_path).json()["profiles"][0]["stated"]
    assert len(rows) == 5
    check = ("check", "kvlcc2", "trials", "--baseline", "base.json")
    said = run(*check, "--update-baseline", cwd=tmp_path)
    assert said.code == 0, said.err
    said = run(*check, cwd=tmp_path)
    assert said.code == 0, (said.out, said.err)
    recorded = json.loads((tmp_path / "base.json").read_text())["trials"]
    assert set(recorded["zz_10"]["metrics"]) == {"overshoot_1", "overshoot_2"}
    said = run("leave-out", *flags[:4], *few, "-o", "left", cwd=tmp_path)
    assert said.code == 0, said.err
    assert "left out, root mean square" in said.out


def test_stated_trials_lie_beside_time_series(truth, tmp_path):
    motion = run_manoeuvre(truth, TurningOrder(35.0 * DEG, 20.0, 40.0 * DEG), id="series", sample=1.0)
    write_trial(as_trial(truth.profile, motion), tmp_path / "series.parquet")
    (tmp_path / "report.toml").write_text(REPORT)
    both = load_trials(tmp_path)
    assert (both.tune, both.tune_stated) == (("series",), ("turn_35", "zz_10"))
    assert set(both.hashes()) == {"series", "turn_35", "zz_10"}
    assert both.in_windows(20.0).tune_stated == ("turn_35", "zz_10")
