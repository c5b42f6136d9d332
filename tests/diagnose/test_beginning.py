"""A search that begins with the wrong cause begins once more without it."""

from dataclasses import dataclass, replace
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.diagnose.searching.search import against_its_kin, doubtful_beginning, fits_better
from mmgtune.effects import find_effect
from mmgtune.hooks import Hooks


def refit(tag, gain):
    return SimpleNamespace(hypothesis=SimpleNamespace(tag=tag), gain=gain)


@pytest.mark.parametrize(
    ("ahead", "gains", "doubtful"),
    [
        (0.6, {"wind": 100.0, "current": 90.0}, ""),
        (0.0, {"wind": 100.0, "current": 90.0}, "wind"),  # a force ahead that no wind has: it is that of a current too
        (0.6, {"wind": 100.0, "wave-drift": 99.0}, "wind"),
        (0.6, {"wave-drift": 100.0, "wind": 99.0}, "wave-drift"),  # though it is no cause any more: it took a place
        (0.6, {"wind": 100.0, "current": 400.0}, ""),  # by chance, or it would have been the first
        (0.6, {}, ""),
    ],
)
def test_where_another_cause_may_have_been_the_first(ahead, gains, doubtful):
    wind = SimpleNamespace(tag="wind", effect=find_effect("wind"))
    found = SimpleNamespace(
        causes=[wind] if gains else [],
        final=SimpleNamespace(names=("effects.wind.speed", "effects.wind.ahead"), unit=np.array([0.5, ahead])),
        held=None,
        finer_step=None,
        steps=[
            SimpleNamespace(refits=[], accepted=False),
            SimpleNamespace(refits=[refit(tag, gain) for tag, gain in gains.items()], accepted=True),
        ],
    )
    bench = SimpleNamespace(believed=SimpleNamespace(form_of=lambda effect: ("effects.wind.ahead",)))
    assert [one.hypothesis.tag for one in doubtful_beginning(bench, found)] == ([doubtful] if doubtful else [])


@dataclass(frozen=True)
class Answer:
    """What decides which of two searches is told."""

    verdict: str
    interrupted: bool = False
    kin: bool = False
    causes: tuple = ()
    traces: tuple = ()

    @property
    def names_causes(self):
        return self.verdict in ("found", "not-separable")


UNEXPLAINED = Answer("unexplained")


class Knowing:
    """A workbench that knows one thing."""

    knows = 0

    def known(self):
        return self.knows

    def put_back(self, known):
        self.knows = known


@pytest.mark.parametrize(("second", "doubtful"), [("wave-drift", ["wind"]), ("current", [])])
def test_a_first_cause_beside_one_that_acts_like_it_is_doubtful(second, doubtful):
    """Waves of 49 kN and a wind against them stood for a wind alone, which the first look could not try."""
    causes = [SimpleNamespace(tag=tag, effect=find_effect(tag)) for tag in ("wind", second)]
    steps = [SimpleNamespace(refits=[refit("wind", 100.0)], accepted=True)]
    final = SimpleNamespace(names=(), unit=np.zeros(0))
    found = SimpleNamespace(causes=causes, final=final, held=None, finer_step=None, steps=steps)
    bench = SimpleNamespace(believed=SimpleNamespace(form_of=lambda effect: ()))
    assert [one.hypothesis.tag for one in doubtful_beginning(bench, found)] == doubtful
    assert against_its_kin(found) == bool(doubtful)
    assert not against_its_kin(SimpleNamespace(causes=[]))


@pytest.mark.parametrize(("left", "names", "better"), [(980.0, 4, True), (1005.0, 2, True), (1005.0, 4, False)])
def test_of_two_searches_that_leave_as_much_the_one_of_fewer_sizes_fits_better(left, names, better):
    def found(chi2, n_names):
        point = SimpleNamespace(names=(), unit=np.zeros(0), offsets=None, spreads={}, chi2=chi2)
        return SimpleNamespace(final=point, causes=[SimpleNamespace(names=("one",) * n_names, by="")], steps=[])

    chi2 = iter([left, 1000.0])
    bench = SimpleNamespace(price=9.0, refit=lambda *_, **__: SimpleNamespace(chi2=next(chi2)))
    assert fits_better(bench, found(left, names), found(1000.0, 4)) == better


@pytest.mark.parametrize("too_many", [False, True])  # causes: then it is not believed, and not judged
@pytest.mark.parametrize(
    ("first", "begun", "other", "fits", "told"),
    [
        (UNEXPLAINED, True, Answer("found"), True, Answer("found")),
        (UNEXPLAINED, True, Answer("found"), False, UNEXPLAINED),
        (UNEXPLAINED, True, Answer("none"), True, UNEXPLAINED),
        (UNEXPLAINED, True, Answer("interrupted", interrupted=True), True, replace(UNEXPLAINED, interrupted=True)),
        (UNEXPLAINED, False, None, True, UNEXPLAINED),
        (Answer("found"), True, None, True, Answer("found")),  # not asked for
        (Answer("found", kin=True), True, Answer("not-separable"), True, Answer("not-separable")),
        (Answer("found", kin=True), True, Answer("found"), False, Answer("found", kin=True)),
        (Answer("none", kin=True), True, None, True, Answer("none", kin=True)),
    ],
)
def test_the_answer_of_the_second_search_is_told_where_it_is_believed_and_fits_better(
    first, begun, other, fits, told, too_many, monkeypatch
):
    told = first if too_many and not (other and other.interrupted) else told
    run = import_module("mmgtune.diagnose.run")
    monkeypatch.setattr(run, "doubtful_beginning", lambda bench, found: [refit("wind", 1.0)] if begun else [])
    monkeypatch.setattr(run, "fits_better", lambda *searches: fits)
    monkeypatch.setattr(run, "against_its_kin", lambda found: first.kin)
    asked = []

    def searched(hypotheses, left_out=(), earlier=None):
        asked.append([one.tag for one in hypotheses])
        bench.knows = len(asked)
        assert earlier == (None if len(asked) == 1 else "found first")
        return "found first" if len(asked) == 1 else then

    def answered(found):
        judged.append(found)
        return (first, other)[len(asked) - 1], found

    judged, then = [], SimpleNamespace(is_beyond_belief=too_many)
    hypotheses = [SimpleNamespace(tag=tag) for tag in ("wind", "current", "wind")]
    bench = Knowing()
    hooks = Hooks(stop=lambda: bool(other and other.interrupted and len(asked) > 1))
    assert run._of_the_better_beginning(bench, searched, answered, hypotheses, hooks)[0] == told
    assert asked[1:] == ([["current"]] if other else [])
    assert judged[1:] == ([then] if other and fits and not too_many else [])  # not in vain
    assert bench.knows == (2 if told == other else 1)  # noise and spreads of what is answered
