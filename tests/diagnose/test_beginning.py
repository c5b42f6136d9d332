"""A search that begins with the wrong cause begins once more without it."""

from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.diagnose.search import doubtful_beginning
from mmgtune.effects import find_effect


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
        steps=[SimpleNamespace(refits=[refit(tag, gain) for tag, gain in gains.items()])],
    )
    bench = SimpleNamespace(believed=SimpleNamespace(form_of=lambda effect: ("effects.wind.ahead",)))
    assert doubtful_beginning(bench, found) == doubtful
