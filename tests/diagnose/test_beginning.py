"""A search that begins with the wrong cause begins once more without it."""

from dataclasses import dataclass, replace
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.diagnose.search import doubtful_beginning
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

    @property
    def names_causes(self):
        return self.verdict == "found"


UNEXPLAINED = Answer("unexplained")


@pytest.mark.parametrize(
    ("first", "begun", "other", "fits", "told"),
    [
        (UNEXPLAINED, True, Answer("found"), True, Answer("found")),
        (UNEXPLAINED, True, Answer("found"), False, UNEXPLAINED),
        (UNEXPLAINED, True, Answer("none"), True, UNEXPLAINED),
        (UNEXPLAINED, True, Answer("interrupted", interrupted=True), True, replace(UNEXPLAINED, interrupted=True)),
        (UNEXPLAINED, False, None, True, UNEXPLAINED),
        (Answer("found"), True, None, True, Answer("found")),  # not asked for
    ],
)
def test_the_answer_of_the_second_search_is_told_where_it_is_believed_and_fits_better(
    first, begun, other, fits, told, monkeypatch
):
    run = import_module("mmgtune.diagnose.run")
    monkeypatch.setattr(run, "doubtful_beginning", lambda bench, found: [refit("wind", 1.0)] if begun else [])
    monkeypatch.setattr(run, "_fits_better", lambda *searches: fits)
    asked = []

    def answered(hypotheses, left_out):
        asked.append([one.tag for one in hypotheses])
        return (first, other)[len(asked) - 1], None

    hypotheses = [SimpleNamespace(tag=tag) for tag in ("wind", "current", "wind")]
    bench = SimpleNamespace(spreads={"of": "the first"})
    assert run._of_the_better_beginning(bench, answered, hypotheses, Hooks())[0] == told
    assert asked[1:] == ([["current"]] if other else [])
    assert bench.spreads == ({} if told.names_causes and other else {"of": "the first"})
