"""Values of each run to which a form of the same effect that is the same in all runs leads."""

import importlib
from types import SimpleNamespace

import pytest

from mmgtune.diagnose.answering.one_form import misleading, of_one_form, tells_as_well
from tests.diagnose.test_beginning import Knowing

run = importlib.import_module("mmgtune.diagnose.run")  # the package has a function of a like name


def answer(after=0.05, *, runs=True, candidates=(), named=True, n=1):
    """What the rule sees of an answer of a gain of each run."""
    of = SimpleNamespace(variant=("factor",)) if runs else None
    cause = SimpleNamespace(tag="rudder-gain", runs=of, gain_test=0.9)
    gain = SimpleNamespace(J=(5.0, after))
    return SimpleNamespace(names_causes=named, causes=(cause,) * n, gain=gain, candidates=candidates, traces=())


def form(J_test, parameters=("factor", "curve"), effect="rudder-gain", by=""):
    return SimpleNamespace(effect=effect, parameters=parameters, by=by, J_test=J_test)


@pytest.mark.parametrize(
    ("given", "tag"),
    [
        ({"candidates": [form(0.2)]}, "rudder-gain"),
        ({"candidates": [form(None), form(0.2)]}, "rudder-gain"),
        ({"candidates": [form(0.4)]}, ""),  # it tells test trials less well
        ({"candidates": [form(0.2, ("factor",))]}, ""),  # one gain for all is no form of what differs
        ({"candidates": [form(0.2, by="trial")]}, ""),
        ({"candidates": [form(0.2, effect="loading")]}, ""),
        ({"candidates": [form(0.2)], "runs": False}, ""),
        ({"candidates": [form(0.2)], "named": False}, ""),
        ({"candidates": [form(0.2)], "n": 2}, ""),
        ({}, ""),
    ],
)
def test_a_form_that_is_the_same_in_all_runs_is_looked_for(given, tag):
    assert of_one_form(answer(**given)) == tag


def test_without_test_trials_nothing_is_told():
    one = answer(candidates=[form(None)])
    one.gain.J = (None, None)
    assert of_one_form(one) == ""
    assert not tells_as_well(answer(0.4, runs=False), answer(0.05))
    assert tells_as_well(answer(0.2, runs=False), answer(0.05))
    assert not tells_as_well(answer(0.2, runs=False, named=False), answer(0.05))


@pytest.mark.parametrize(
    ("runs", "gain_test", "of_trace", "harmful", "tag"),
    [
        (True, -1.03, False, False, "loading"),  # an engine that gives way, and play of the linkage
        (True, 0.6, False, False, ""),
        (True, None, False, False, ""),
        (False, -1.03, False, False, ""),
        (False, 0.9, True, True, "wind"),
        (False, 0.9, True, False, ""),
        (False, 0.9, False, True, ""),
    ],
)
def test_values_of_each_run_that_tell_what_is_held_out_worse_mislead(runs, gain_test, of_trace, harmful, tag):
    cause = SimpleNamespace(tag="loading", runs=runs or None, gain_test=gain_test)
    trace = SimpleNamespace(cause=SimpleNamespace(tag="wind", runs=of_trace or None))
    trace.contribution = SimpleNamespace(harmful=harmful)
    assert misleading(SimpleNamespace(names_causes=True, causes=(cause,), traces=(trace,))) == tag
    assert misleading(SimpleNamespace(names_causes=False, causes=(cause,), traces=(trace,))) == ""


@pytest.mark.parametrize(("after", "taken"), [(0.2, True), (0.6, False)])
def test_the_second_search_looks_for_no_values_of_runs(monkeypatch, after, taken):
    """A blade that lags by up to 15 % at 35 deg was a gain of each run, 0.87 to 0.97, which no extended profile has."""
    first, second = answer(candidates=[form(0.2)]), answer(after, runs=False)
    asked = []

    def searched(hypotheses, left_out=(), earlier=None):
        asked.append([one.by for one in hypotheses])
        bench.knows = len(asked)
        assert earlier == (None if len(asked) == 1 else "first")
        return "first" if len(asked) == 1 else "second"

    def answered(found):
        return (first if found == "first" else second), found

    for one in (first, second):
        one.verdict, one.interrupted = "found", False
    bench = Knowing()
    known = [SimpleNamespace(by=by, tag="rudder-gain") for by in ("", "trial", "group")]
    said = []
    hooks = SimpleNamespace(stop=lambda: False, on_phase=said.append)
    monkeypatch.setattr(run, "replace", lambda one, **_: one)
    monkeypatch.setattr(run, "against_its_kin", lambda _: False)
    found = run._of_the_better_beginning(bench, searched, answered, known, hooks)
    assert found == ((second, "second") if taken else (first, "first"))
    assert asked == [["", "trial", "group"], [""]]
    assert bench.knows == (2 if taken else 1)  # noise and spreads of what is answered
    assert said == ["looking again without rudder-gain of each run"]
