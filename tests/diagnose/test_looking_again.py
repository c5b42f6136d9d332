"""A second search, without one of the effects: it takes up the first look of the first one."""

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.diagnose import DiagnoseOptions
from mmgtune.diagnose.answering import judging
from mmgtune.diagnose.bench.hypotheses import known_causes
from mmgtune.diagnose.bench.workbench import make_workbench
from mmgtune.diagnose.searching.look import look_again
from mmgtune.diagnose.searching.refitter import Known
from mmgtune.diagnose.searching.search import fits_better, search
from mmgtune.motions import simulate_trials
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import load_trials
from tests.diagnose.sensors import logged

search_of = import_module("mmgtune.diagnose.searching.search")
EFFECTS = ("current", "heading-bias", "rudder-offset", "steering-lag")


@pytest.fixture(scope="module")
def searched():
    """A workbench, all hypotheses, and what was found of a ship in a current whose rudder has another zero."""
    profile, rng = load_profile("suzaku"), np.random.default_rng(5)
    trials = [load_trials("suzaku").trials[name] for name in ("turn_p35", "turn_m20", "zigzag_20")]
    hidden = {"current": {"north": 0.3, "east": -0.2}, "rudder-offset": {"angle": 0.035}}
    for tag, values in hidden.items():
        profile = with_effects(profile, {tag: values}, "made")
    made = [logged(*pair, rng) for pair in zip(trials, simulate_trials(profile, trials), strict=True)]
    options = DiagnoseOptions(effects=EFFECTS, targets=("hull.R_0", "hull.Y_v"), leeway=0.0)
    known = known_causes(load_profile("suzaku"), made, options)
    bench = make_workbench(load_profile("suzaku"), made, options, [name for one in known for name in one.names])
    return bench, known, search(bench, known)


def without(known, tag):
    return [one for one in known if one.tag != tag]


def test_the_first_look_is_taken_up_with_what_was_known_then(searched):
    """A wind was named as a search began with the noise that another one had come to."""
    bench, known, found = searched
    assert {cause.tag for cause in found.causes} == {"current", "rudder-offset"}
    first, *others = found.steps
    assert first.begun is not None
    assert all(step.begun is None for step in others)
    after = bench.known()
    fewer = without(known, found.causes[0].tag)
    again = look_again(bench, first, fewer)
    assert bench.noise is first.begun.bench["noise"]
    assert bench.spreads == {}
    assert again.base is first.base
    assert all(one.hypothesis in fewer for one in again.refits)
    best = {one.hypothesis.names: one for one in first.refits}
    for one in again.refits:  # none is begun anew, and any may go on
        assert one.point.chi2 <= best[one.hypothesis.names].point.chi2 if one.hypothesis.names in best else True
    assert (again.finer, again.evenly) == (first.finer, first.evenly)
    bench.put_back(after)
    assert bench.known() == after


def test_a_second_search_finds_what_a_search_among_fewer_finds(searched):
    bench, known, found = searched
    after, fewer = bench.known(), without(known, "heading-bias")
    said = []
    again = search(bench, fewer, (), said.append, found.steps[0])
    assert [cause.names for cause in again.causes] == [cause.names for cause in found.causes]
    assert again.final.chi2 == pytest.approx(found.final.chi2, rel=1e-3)
    assert "re-tuning the model without any cause" not in said
    bench.put_back(after)


@pytest.mark.parametrize("given_up", [False, True])
def test_a_second_search_is_given_up_where_as_many_causes_as_are_believed_fit_no_better(
    searched, given_up, monkeypatch
):
    bench, known, found = searched
    after = bench.known()
    monkeypatch.setattr(search_of, "TOO_MANY", 2)
    monkeypatch.setattr(search_of, "STRONG", np.inf)  # much is left without the current
    beaten = found if given_up else replace(found, final=found.base, causes=[])
    again = search(bench, without(known, "current"), (), lambda _: None, found.steps[0], beaten)
    assert not fits_better(bench, again, found)
    assert (len(again.steps) == 1) == given_up
    bench.put_back(after)


def test_a_search_without_the_first_cause_is_told_what_it_has_to_beat(searched, monkeypatch):
    bench, *_ = searched
    run, asked = import_module("mmgtune.diagnose.run"), []

    def seen(*arguments, than=None):
        asked.append(than)
        return search(*arguments, than=than)

    monkeypatch.setattr(run, "search", seen)
    monkeypatch.setattr(run, "against_its_kin", lambda found: True)
    monkeypatch.setattr(run, "doubtful_beginning", lambda bench, found: found.steps[0].refits[:1])
    options = DiagnoseOptions(effects=EFFECTS[:1], targets=("hull.R_0", "hull.Y_v"), leeway=0.0)
    run.diagnose("suzaku", bench.trials, options)
    assert [than is None for than in asked] == [True, False]
    assert [cause.tag for cause in asked[1].causes] == ["current"]


def test_what_is_left_out_says_no_more_what_is_hopeless():
    def one(name, by=""):
        return SimpleNamespace(names=(name,), by=by)

    ends = {(name,): SimpleNamespace(chi2=chi2) for name, chi2 in (("a", 1.0), ("b", 3.0), ("c", 2.0))}
    known = Known(ends, True, {("a",): [], ("b",): []}, 1.0)
    fewer = known.among([one("b"), one("c", "trial")])
    assert list(fewer.ends) == [("b",), ("c",)]
    assert list(fewer.begun) == [("b",)]
    assert fewer.least == 3.0  # of one value for all
    assert known.among([]).least == np.inf
    assert known.least == 1.0


def test_test_trials_are_told_once_by_each_candidate(monkeypatch):
    """They were for each answer that was weighed, a third of what gathering the evidence took."""

    def refit(tag, gain):
        hypothesis = SimpleNamespace(tag=tag, variant=(), by="")
        score = SimpleNamespace(hypothesis=hypothesis, score=gain)
        return SimpleNamespace(hypothesis=hypothesis, score=score, point=tag, gain=gain, p_value=0.0, unvisited="")

    refits = [refit("current", 100.0), refit("wind", 90.0), refit("flap", 1.0)]
    step = SimpleNamespace(refits=refits, scores=[one.score for one in refits])
    asked = []
    monkeypatch.setattr(judging, "J_of", lambda bench, point, test: asked.append(point) or float(len(point)))
    judge = judging.Judge(None, None, None, {}, None, [], SimpleNamespace(test=[]), None, [], 0.0, None, [])
    once, twice = judge._candidates(SimpleNamespace(steps=[step])), judge._candidates(SimpleNamespace(steps=[step]))
    assert once == twice
    assert [one.J_test for one in once] == [7.0, 4.0, None]
    assert sorted(asked) == ["current", "wind"]
    assert judge._candidates(SimpleNamespace(steps=[])) == []
