"""A single cause instead of re-tuning: re-tuned coefficients can absorb a cause, which then does not show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...fitting.least_squares import fit_offsets
from ...phrases import in_percent, small
from ..bench.hypotheses import Hypothesis
from ..bench.workbench import Point, Workbench
from ..signatures.intervals import Estimate
from ..signatures.linear import linearise
from ..signatures.screening import scores
from ..signatures.wording import parameters_in_words
from .base_fit import PRECISE
from .refit import ENOUGH, Refit
from .refitter import Known, Refitter, Stopped
from .refitting import Refitting

MISSES = 2.0
"""Chi-squared per residual of the profile as it is from which there is something to explain."""

NEARLY = 0.85
"""Share of what re-tuning removes that a cause alone must remove."""

OF_OTHERS = 1.0 / 3.0
"""Largest ratio of the error it leaves to the error that the next best other effect leaves."""

LEAST = 1.0
"""Typical sizes of a cause from which it is told: a hull a few per cent off looks like a draught two per cent off."""

MATTERS = 1.0 - (1.0 - NEARLY) / OF_OTHERS
"""Share of what re-tuning removes that a cause must promise to be followed to its end: less changes no answer."""

CLOSE, AS_CLOSE = 2.0, 1.1
"""Times what re-tuning leaves that a cause may leave at most: where coefficients are off in many ways it explains much
by chance, and leaves what re-tuning does not; and times from which down the noise decides between two."""

ALSO, FAR_LESS = 0.75, 0.02
"""Share of what re-tuning removes beyond which another effect does much the same, as any does of a ship that is unlike
her profile in many ways; and the share of what that one leaves that the best may leave then."""

ALIKE = 0.95
"""Share of what a cause removes from which another form of the same cause is told beside it."""


@dataclass(frozen=True)
class Instead:
    """A cause that alone removes most of the error that re-tuning removes, with all coefficients at the profile's
    values.

    words       the cause as a sentence without its full stop
    share       of the fall of chi-squared by re-tuning that it brings
    forms       other forms of it that do nearly the same, as such sentences
    next_effect tag of the next best effect, "" where none was worth following to its end
    next_share  that it brings
    """

    effect: str
    words: str
    share: float
    next_effect: str
    next_share: float
    forms: tuple[str, ...] = ()

    @property
    def sentence(self) -> str:
        """What re-tuning may stand for."""
        words = "; or ".join([small(self.words), *(_told_apart(form, self.words) for form in self.forms)])
        return f"Re-tuning may stand for a cause: {words}."

    @property
    def why(self) -> str:
        """Why it may, in a sentence."""
        other = f"no other cause promises more than {100.0 * MATTERS:.0f} %"
        if self.next_effect:
            other = f"the next best, {self.next_effect}, {in_percent(self.next_share)}"
        return (
            f"With all coefficients as the profile has them, that alone removes {in_percent(self.share)} of what "
            f"re-tuning removes; {other}."
        )

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "effect": self.effect,
            "sentence": self.words,
            "share": self.share,
            "next_effect": self.next_effect or None,
            "next_share": self.next_share if self.next_effect else None,
            "forms": list(self.forms),
        }


def instead_of_tuning(bench: Workbench, tuned: Point, hypotheses: Sequence[Hypothesis]) -> Instead | None:
    """The cause that alone does nearly as much as re-tuning, where re-tuning did much and no other cause comes near.

    tuned  the model re-tuned without any cause

    None where there is no such cause, or it ends at an end of its range, or the search was stopped.
    """
    if not bench.targets:
        return None
    as_it_is = _untuned(bench, tuned)
    fall = as_it_is.chi2 - tuned.chi2
    if as_it_is.chi2 < MISSES * bench.problem.n_residuals or fall <= 0.0:
        return None
    asked = [one for one in hypotheses if not (one.by or one.effect.one_of_many or one.refines)]
    linear = linearise(bench, as_it_is, [name for one in asked for name in one.bases], roughly=True)
    ranked, least = scores(linear, asked), min(CLOSE * tuned.chi2, as_it_is.chi2 - NEARLY * fall)
    fits: list[Refit] = []
    try:
        for enough in (least, as_it_is.chi2 - MATTERS * fall):  # others matter only beside one that is to be told
            refitting = Refitting(Refitter(bench, as_it_is, linear, Known(), enough=enough), every=True)
            fits = sorted(refitting.best(ranked, quick=False), key=lambda fit: -fit.gain)
            if not fits or fits[0].point.chi2 > least:
                return None
    except Stopped:
        return None
    best = fits[0]
    if best.size < LEAST:
        return None
    other = next((fit for fit in fits if fit.hypothesis.tag != best.hypothesis.tag), None)
    if other and other.gain < MATTERS * fall:  # it may not have been followed to its end
        other = None
    next_gain = other.gain if other else 0.0
    if best.point.chi2 < AS_CLOSE * tuned.chi2 and other is not None:
        told = best.gain - next_gain > ENOUGH
    else:
        told = fall - best.gain <= (FAR_LESS if next_gain > ALSO * fall else OF_OTHERS) * (fall - next_gain)
    if not told:
        return None
    words = _in_words(bench, best)
    if not words:
        return None
    alike = [fit for fit in fits[1:] if fit.hypothesis.tag == best.hypothesis.tag and fit.gain > ALIKE * best.gain]
    forms = tuple(filter(None, (_in_words(bench, fit) for fit in alike)))
    tag = other.hypothesis.tag if other else ""
    return Instead(best.hypothesis.tag, words, min(best.gain / fall, 1.0), tag, next_gain / fall, forms)


def _in_words(bench: Workbench, fit: Refit) -> str:
    """A cause as a sentence without its full stop; "" where it ends at an end of its range."""
    there, hypothesis = fit.point, fit.hypothesis
    end = bench.refit(there.names, there.unit[:, None], there.offsets, integrator=there.integrator, tolerance=PRECISE)
    unit = dict(zip(end.names, end.unit, strict=True))
    if any(not 0.0 < unit[name] < 1.0 for name in hypothesis.names):  # no such size is thought possible
        return ""
    values = bench.values(end)
    own = {name: Estimate(name, values[name], None, None, None) for name in hypothesis.names}
    return hypothesis.effect.sentence(parameters_in_words(hypothesis.effect, own))


def _told_apart(sentence: str, first: str) -> str:
    """A sentence behind one that begins alike: only what stands behind the colon then."""
    head, colon, rest = sentence.partition(": ")
    return rest if colon and first.startswith(head + colon) else small(sentence)


def _untuned(bench: Workbench, tuned: Point) -> Point:
    """The profile as it is, its initial states fitted."""
    anyone = bench.targets[:1]  # a problem is of something that is free
    null = bench.null(anyone)
    offsets = fit_offsets(bench.problem_of(anyone, tuned.integrator), null)
    there = bench.refit(anyone, null[:, None], offsets, max_iterations=0, integrator=tuned.integrator)
    return Point((), np.zeros(0), offsets, there.chi2, tuned.integrator)
