"""Which hypotheses are refitted where much is left: what is foretold of their starts, and what is given up."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.diagnose import DiagnoseOptions
from mmgtune.diagnose.bench import workbench
from mmgtune.diagnose.bench.hypotheses import Hypothesis, known_causes
from mmgtune.diagnose.bench.workbench import Point, make_workbench
from mmgtune.diagnose.searching import refitter as refitter_module
from mmgtune.diagnose.searching import refitting
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.diagnose.searching.look import _as_given as as_given
from mmgtune.diagnose.searching.refitter import HARDLY_MORE, HOPELESS, Known, Refitter
from mmgtune.diagnose.searching.refitting import Refitting
from mmgtune.diagnose.searching.shortlist import REFITTED, Shortlist
from mmgtune.diagnose.signatures.linear import linearise
from mmgtune.diagnose.signatures.screening import Score, scores
from mmgtune.effects import find_effect
from mmgtune.fitting.box import base_of
from mmgtune.fitting.least_squares import LeastSquaresResult
from mmgtune.motions import simulate_trials
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import load_trials
from tests.diagnose.sensors import logged

CURRENT = {"north": 0.08, "east": -0.06}
"""Steady [m/s]."""

NAMES = tuple(f"effects.current.{name}" for name in CURRENT)


def first_look(hidden, effects):
    """A first look at a ship with something hidden, coefficients as in the profile."""
    profile = load_profile("suzaku")
    rng = np.random.default_rng(7)
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "turn_m20", "zigzag_20")]
    ship = with_effects(profile, hidden, "made") if hidden else profile
    made = [logged(trial, motion, rng) for trial, motion in zip(trials, simulate_trials(ship, trials), strict=True)]
    options = DiagnoseOptions(effects=effects)
    known = [one for one in known_causes(profile, made, options) if not one.refines]
    bench = make_workbench(profile, made, options, [name for one in known for name in one.names])
    point = base_fit(bench)
    linear = linearise(bench, point, [name for one in known for name in one.names])
    return Refitter(bench, point, linear, Known()), {s.hypothesis.names: s for s in scores(linear, known)}


@pytest.fixture(scope="module")
def look():
    """A look at a ship in a current."""
    return first_look({"current": CURRENT}, ("current", "heading-bias", "flap", "steering-lag"))


def test_what_a_start_leaves_is_foretold_without_a_refit(look):
    refitter, by_names = look
    bench, point = refitter.bench, refitter.point
    null, there = bench.null(NAMES), bench.sub_box(NAMES).to_unit(list(CURRENT.values()))
    starts = np.array([[*point.unit, *(null + share * (there - null))] for share in (0.0, 0.5, 1.0, -1.0)]).T
    left = Shortlist(refitter)._foretelling(point, by_names.values()).left(by_names[NAMES].hypothesis, starts)
    assert (left < 0.05 * point.chi2).all()
    end = bench.refit((*point.names, *NAMES), starts[:, 2:3], point.offsets, max_iterations=10)
    assert end.chi2 < 1.1 * bench.problem.n_residuals  # the targets had gone far astray
    other = by_names["effects.flap.factor",]
    starts = refitter.starts(point, other, ())
    left = Shortlist(refitter)._foretelling(point, [other]).left(other.hypothesis, starts)
    assert 0.5 * point.chi2 < left[0] <= point.chi2


def test_what_is_foretold_is_that_of_each_alone(look):
    refitter, by_names = look
    together = Shortlist(refitter)._foretelling(refitter.point, by_names.values())
    for score in by_names.values():
        starts = refitter.starts(refitter.point, score, (1.0, 0.5))
        alone = Shortlist(refitter)._foretelling(refitter.point, [score])
        of_all, of_one = (one.left(score.hypothesis, starts) for one in (together, alone))
        assert len(of_all) == starts.shape[1]
        np.testing.assert_allclose(of_all, of_one, rtol=1e-9)


def test_a_step_that_is_tried_leads_where_it_says_and_nowhere_worse(look):
    refitter, by_names = look
    point, score = refitter.point, by_names[NAMES]
    foretelling = Shortlist(refitter)._foretelling(point, [score])
    starts = refitter.starts(point, score, (1.0, 0.5))
    where, left = foretelling.tried(score.hypothesis, starts)
    assert where.shape == starts.shape
    np.testing.assert_array_equal(where[: -len(NAMES)], starts[: -len(NAMES)])  # what else is free follows linearly
    np.testing.assert_array_equal(where, np.clip(where, 0.0, 1.0))
    (there,) = refitter.bench.refits((*point.names, *NAMES), where[:, :1], point.offsets, max_iterations=4)
    assert there.chi2 < 1.1 * left[0] < 0.1 * point.chi2
    _, again = foretelling.tried(score.hypothesis, where)
    assert (again <= left).all()


@pytest.mark.parametrize("beside", [True, False])
def test_beside_a_cause_what_chance_brings_least_of_is_refitted_however_little_it_explains(beside):
    """A gyro that showed 4 % too much stood behind a dozen that the rudder of a slow gear explains a hundred times, and
    was not looked at."""

    def score(name, promised, inflation):
        effect = SimpleNamespace(one_of_many=False, form=())
        return Score(SimpleNamespace(effect=effect, by="", names=(name,)), promised, np.ones(1), 1.0, 0.9, inflation)

    order = [score(f"gear-{k}", 1000.0 - 10.0 * k, 20.0) for k in range(14)] + [score("gyro", 200.0, 1.5)]
    bench = SimpleNamespace(null=lambda names: np.full(len(names), 0.5), price=9.0)
    point = SimpleNamespace(names=("hull.R_0", "effects.steering-lag.rate_limit")[: 1 + beside])
    refitter = SimpleNamespace(strong=False, given=None, bench=bench, n_new=lambda one: 1, point=point)
    names = [one.hypothesis.names for one in Shortlist(refitter).for_all_runs(order, quick=False)]
    assert (("gyro",) in names) == beside
    assert len(names) == len(set(names)) == REFITTED + beside


@pytest.mark.parametrize(("strong", "quick", "n"), [(True, False, 5), (False, False, 2), (True, True, 1)])
def test_where_much_was_left_values_of_runs_are_refitted_whatever_their_order(strong, quick, n):
    """The zero of a rudder in one run stood third, behind a wind and waves of that run, and was not looked at."""

    def score(name, promised, by="trial"):
        effect = SimpleNamespace(one_of_many=False, form=())
        return Score(SimpleNamespace(effect=effect, by=by, names=(name,)), promised, np.ones(1), 1.0, 0.9, 1.0, 0.5)

    by_run = [score(name, 500.0 - 10.0 * k) for k, name in enumerate(("wind", "waves", "zero", "gain", "draught"))]
    order = [*by_run, score("gain", 300.0, ""), score("thrust", 290.0)]
    bench = SimpleNamespace(price=9.0, problem=SimpleNamespace(n_residuals=1000))
    refitter = SimpleNamespace(strong=strong, bench=bench, n_new=lambda one: 2, point=SimpleNamespace(chi2=3000.0))
    assert Shortlist(refitter).of_runs(order, [SimpleNamespace(chi2=1050.0)], quick=quick) == by_run[:n]


def test_where_much_was_left_those_whose_scores_are_nearly_the_best_are_refitted_too():
    """A rudder zero that differed from run to run stood seventh, at 0.89 of the best score: it was told as waves."""

    def score(name, promised):
        effect = SimpleNamespace(one_of_many=False, form=())
        return Score(
            SimpleNamespace(effect=effect, by="trial", names=(name,)), promised, np.ones(1), 1.0, 0.9, 1.0, 0.5
        )

    order = [
        score(f"cause-{k}", promised) for k, promised in enumerate((1200, 1170, 1140, 1140, 1130, 1080, 1061, 1000))
    ]
    bench = SimpleNamespace(price=9.0, problem=SimpleNamespace(n_residuals=1000))
    refitter = SimpleNamespace(strong=True, bench=bench, n_new=lambda one: 2, point=SimpleNamespace(chi2=3000.0))
    shortlist, fitted = Shortlist(refitter), [SimpleNamespace(chi2=2000.0)]
    assert shortlist.of_runs(order, fitted, quick=False) == order[:7]
    assert shortlist.of_runs(order, fitted, quick=True) == order[:1]


@pytest.mark.parametrize(("chi2", "again"), [(500.0, True), (105.0, False), (90.0, False)])
def test_a_form_that_ended_worse_than_one_with_fewer_parameters_begins_again_there(chi2, again, monkeypatch):
    """Turning a wind of nothing does nothing: both together came to a hundredth of what its size alone did."""
    monkeypatch.setattr(refitting, "typical", lambda bench, name: 0.1)
    effect, none = find_effect("wind"), np.zeros((1, 6))
    both, fewer = Hypothesis(effect, ("measured", "turned")), Hypothesis(effect, ("measured",))

    def point(names, unit, chi2):
        return Point(names, np.array(unit), none, chi2, Integrator())

    began, better = [], point(both.names, [0.8, 0.7], 10.0)
    refitter = SimpleNamespace(
        bench=SimpleNamespace(null=lambda names: np.full(len(names), 0.5)),
        point=point((), [], 1000.0),
        known=SimpleNamespace(ends={}),
        steps=lambda point, score, starts, steps, names: began.append((names, starts)) or [better],
    )
    end, there = point(both.names, [0.5, 0.5], chi2), point(fewer.names, [0.8], 100.0)
    score = SimpleNamespace(hypothesis=both)
    found = Refitting(refitter)._beside_fewer(score, end, [(SimpleNamespace(hypothesis=fewer), there), (score, end)])
    assert found is (better if again else end)
    assert refitter.known.ends == ({both.names: better} if again else {})
    for names, starts in began:
        assert names == end.names  # with its forms, which are free first
        np.testing.assert_allclose(starts, [[0.8, 0.8], [0.6, 0.4]])


WIND, WAVES = (
    ("effects.wind.speed", "effects.wind.direction"),
    ("effects.wave-drift.force", "effects.wave-drift.direction"),
)


def test_a_wind_begins_again_where_the_force_of_waves_ended():
    """A wind of 8 m/s was told as waves that left a sixth more than noise: no way led to it from a ship far off."""
    refitter, by_names = first_look({"wind": {"speed": 12.0, "direction": 0.8}}, ("wind", "wave-drift"))
    wind, waves, point = by_names[WIND], by_names[WAVES], refitter.point
    assert refitter.strong
    there = refitter.on(waves, refitter.rough(waves), 10)
    null = refitter.bench.null(WIND)
    nowhere = refitter.bench.refit(
        (*point.names, *WIND), np.append(point.unit, null)[:, None], point.offsets, max_iterations=0
    )
    (_, end), (_, same) = Refitting(refitter)._from_their_kin([(wind, nowhere), (waves, there)])
    assert nowhere.chi2 > 10.0 * there.chi2
    assert end.chi2 < there.chi2
    assert refitter.bench.values(end)[WIND[0]] == pytest.approx(12.0, rel=0.15)  # its formula has leeway
    assert same is there or same.chi2 < there.chi2
    assert refitter.known.ends[WIND] is end


@pytest.mark.parametrize("left", [900.0, 1100.0], ids=["alike", "not alike"])
def test_one_value_for_all_begins_again_at_the_mean_of_those_of_each_run(left, monkeypatch):
    """One wave drift for all ended at twice what values of each run left, though these were alike."""
    waves, none, starts = find_effect("wave-drift"), np.zeros((1, 6)), []
    one, each = (
        Hypothesis(waves, ("force", "direction")),
        Hypothesis(waves, ("force", "direction"), "trial", ("a", "b")),
    )

    def point(names, unit, chi2):
        return Point(names, np.array(unit), none, chi2, Integrator())

    def steps(of, score, own, iterations, names):
        starts.append((names, own))
        return [point(names, unit, left if iterations == 0 else 40.0) for unit in own.T]

    monkeypatch.setattr(refitting, "replace", lambda of, **_: of)
    refitter = SimpleNamespace(point=None, known=SimpleNamespace(ends={}), go_on=lambda: None, steps=steps)
    of_all = point(("hull.R_0", *one.names), [0.1, 0.5, 0.5], 1000.0)
    of_runs = point(("hull.R_0", *each.names), [0.3, 0.8, 0.6, 0.7, 0.4], 50.0)
    fitted = [(SimpleNamespace(hypothesis=of), end) for of, end in ((one, of_all), (each, of_runs))]
    (_, end), (_, kept) = Refitting(refitter)._from_their_kin(fitted)
    assert kept is of_runs
    if left > of_all.chi2:
        assert end is of_all
        return
    assert end.chi2 == 40.0
    assert {names for names, _ in starts} == {of_all.names}
    of_each = dict(zip(each.names, of_runs.unit[1:], strict=True))
    means = [np.mean([z for name, z in of_each.items() if base_of(name) == base]) for base in one.names]
    np.testing.assert_allclose(end.unit, [0.3, *means])
    assert len(starts) == 2  # what is done twice leads nowhere else


def test_where_leeway_is_given_back_a_form_stays_and_far_sizes_are_tried(monkeypatch):
    """Water of 1.7 draughts was found with the hull held, and lost with its form as leeway was given back; on other
    ships it went back to deep water already there.  It was told as another draught, or nothing was wrong."""
    water = find_effect("shallow-water")
    depth, form = "effects.shallow-water.depth", "effects.shallow-water.Y_v"
    names, begun, null = ("hull.R_0", "hull.Y_v"), [], {depth: 0.0}
    end = Point((form, "hull.R_0", depth), np.array([0.3, 0.4, 0.6]), np.ones((1, 6)), 50.0, Integrator())
    monkeypatch.setattr(refitter_module, "replace", lambda of, **what: SimpleNamespace(**{**vars(of), **what}))
    refitter = SimpleNamespace(
        bench=SimpleNamespace(
            believed=SimpleNamespace(forms={form: 0.1}), null=lambda of: np.array([null.get(name, 0.5) for name in of])
        ),
        point=Point(names, np.array([0.9, 0.8]), np.zeros((1, 6)), 90.0, Integrator()),
        before=Point(names[:1], np.array([0.7]), np.zeros((1, 6)), 900.0, Integrator()),
        known=Known(least=1.0),
        starts=lambda point, score, sizes: np.full((3, 1), 0.7),
        steps=lambda point, score, starts, steps, free=(): begun.append((point.offsets[0, 0], starts, free)) or [end],
    )
    refitter._from_far = lambda score, names: Refitter._from_far(refitter, score, names)
    score = SimpleNamespace(hypothesis=Hypothesis(water, ("depth",)))
    assert Refitter._released(refitter, score, end) == [end, end, end]
    (offset, on, free), (other, by_score, of_point), (_, far, again) = begun
    assert (offset, other, of_point) == (1.0, 0.0, ())
    assert free == again == (form, *names, depth)
    np.testing.assert_allclose(on[:, 0], [0.3, 0.4, 0.5, 0.6])  # the hull at the profile's, which had no leeway
    np.testing.assert_allclose(by_score, 0.7)
    np.testing.assert_allclose(far.T, [[0.5, 0.7, 0.5, 1.0 / 3.0], [0.5, 0.7, 0.5, 2.0 / 3.0]])


@pytest.mark.long
def test_beside_one_that_leaves_noise_others_are_given_up(look):
    refitter, by_names = look
    known, n = refitter.known, refitter.bench.problem.n_residuals
    assert refitter.strong
    assert refitter.hopeless == np.inf
    best = Refitting(refitter).best(list(by_names.values()), quick=False)
    assert best[0].hypothesis.names == NAMES
    assert known.least <= best[0].point.chi2 < 1.1 * n
    assert refitter.hopeless == n + HOPELESS * max(known.least - n, HARDLY_MORE * n)
    other = next(refit for refit in best if refit.hypothesis.tag == "heading-bias")
    assert refitter.hopeless < other.point.chi2 <= refitter.point.chi2
    known.outdate()
    assert refitter.hopeless == np.inf


@pytest.mark.parametrize("chi2", [np.nan, np.inf, 1e30])
def test_a_refit_that_runs_away_ends_where_it_began_and_explains_nothing(look, chi2):
    """A chi-squared that is no number ended a diagnosis with a report of a bug."""
    refitter, by_names = look
    score, point = by_names[NAMES], refitter.point
    lost = refitter.starts(point, score, ())[:, 0] * (np.nan if np.isnan(chi2) else 1.0)
    end = replace(point, names=(*point.names, *NAMES), unit=lost, chi2=chi2)
    refit = Refitting(refitter)._judged(score, end, None, 1)
    assert (refit.gain, refit.point.chi2) == (0.0, point.chi2)
    assert refit.point.unit[-2:].tolist() == refitter.bench.null(NAMES).tolist()
    assert np.isfinite(refit.point.unit).all()
    assert refit.evidence < 0.0


@pytest.mark.parametrize("lost", [{"J": np.nan}, {"J": np.inf}, {"J": np.inf, "promised": np.inf}])
def test_refits_have_an_order_whatever_ran_away(look, monkeypatch, lost):
    refitter, _ = look
    bench, point = refitter.bench, refitter.point

    def solved(problem, starts, **_):
        there = LeastSquaresResult(starts[:, 0], problem.offsets, 1.0, 1, True, promised=np.nan)
        return [replace(there, **lost), there]

    monkeypatch.setattr(workbench, "solve", solved)
    first, second = bench.refits(point.names, np.repeat(point.unit[:, None], 2, axis=1), point.offsets)
    assert first.chi2 == first.foreseen == np.inf
    assert second.foreseen == second.chi2 < np.inf


ALIKE = ("heading-bias", "gyro-scale", "gyro-bias", "speed-scale", "rpm-scale", "rudder-gain")
"""Effects with two sides and no form."""


def test_where_little_is_left_what_does_not_earn_its_price_is_not_refitted():
    """But for the best three, and what a score says little of: a lag has one side only, a loading a form."""
    refitter, by_names = first_look({}, (*ALIKE, "steering-lag", "loading"))
    assert not refitter.strong
    scored = sorted(by_names.values(), key=lambda score: -score.score)
    price = refitter.bench.price
    earns = {s.hypothesis.tag for s in scored if s.score / s.inflation > len(s.hypothesis.names) * price}
    best = {s.hypothesis.tag for s in scored[:3]}
    fitted = {refit.hypothesis.tag for refit in Refitting(refitter).best(list(by_names.values()), quick=False)}
    assert best <= fitted
    assert {"steering-lag", "loading"} <= fitted
    assert set(ALIKE) - best - earns
    assert not fitted & (set(ALIKE) - best - earns)


@pytest.mark.daily("nan")
@pytest.mark.parametrize("chi2", [np.inf, np.nan])
def test_nothing_is_looked_for_where_what_has_no_leeway_runs_away(monkeypatch, chi2):
    refitter, _ = first_look({}, ("current",))
    bench, point = refitter.bench, refitter.point
    monkeypatch.setattr(bench, "refit", lambda *_, **__: replace(point, chi2=chi2))
    assert as_given(bench, point, known_causes(bench.model.profile, bench.trials, bench.options)) is None
