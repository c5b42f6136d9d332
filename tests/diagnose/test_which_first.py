"""Which of two explanations stands first: one value for all runs, or values that differ between them."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from mmgtune.diagnose.refitting import Refitting

N_RESIDUALS, BEFORE = 10_000, 15_000.0


def refit(chi2, by, cost):
    """A refit that leaves chi2, of values that differ or not."""
    return SimpleNamespace(
        hypothesis=SimpleNamespace(by=by),
        score=SimpleNamespace(inflation=2.0),
        point=SimpleNamespace(chi2=chi2),
        gain=BEFORE - chi2,
        cost=cost,
        evidence=(BEFORE - chi2) / 2.0 - cost,
    )


@pytest.mark.parametrize(
    ("differing", "alike", "first"),
    [
        (9_900.0, 10_100.0, ""),  # both leave no more than noise
        (10_100.0, 13_000.0, "trial"),
        (12_000.0, 14_000.0, ""),  # neither is the answer: values of many runs bend to anything
        (8_000.0, 9_500.0, "trial"),  # noise was known as too large, from a model without the cause
        (9_400.0, 9_600.0, ""),
        (9_590.0, 9_600.0, ""),
    ],
)
def test_values_that_differ_stand_first_where_they_leave_far_less(differing, alike, first):
    look = SimpleNamespace(strong=True, bench=SimpleNamespace(problem=SimpleNamespace(n_residuals=N_RESIDUALS)))
    ordered = Refitting._ordered(look, [refit(alike, "", 20.0), refit(differing, "trial", 60.0)])
    assert ordered[0].hypothesis.by == first
