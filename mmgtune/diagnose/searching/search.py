"""The search for causes: screen, refit, decide, add, and look again.

A hypothesis is believed only where all of this holds: refitted together with the targets it explains far more than
chance would bring anywhere in the search, its size is worth speaking of, and no other hypothesis does nearly as well.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from ...arrays import FloatArray
from ...fitting.box import AT, base_of
from ...fitting.journal import side_by_side
from ...fitting.lost import require_simulated
from ...hooks import Phase
from ...trial import Held
from ..bench.hypotheses import Hypothesis, n_terms
from ..bench.runs import within
from ..bench.workbench import Point, Workbench
from .base_fit import PRECISE, base_fit, unnoticed
from .look import Step, finer, fitted_beside, look, look_again
from .refit import ENOUGH, Refit, rivals_among
from .refitter import STRONG, Stopped, hopeless_beside

ALMOST = 0.9
"""Share of the best gain from which a finer integration step, which has no parameter, is believed before any effect."""

HALF = 0.5
"""Share of the best gain from which a log that looks held is read accordingly: it is seen in the log, and a late clock
explains most of it too."""

TOO_MANY = 4
"""Terms of a sum of causes from which it is not believed."""

AS_WELL = 0.02
"""Share by which the gains of two effects differ at most that do as well as each other at the first look."""

OTHER_NOISE = 0.1
"""Share of chi-squared by which a cause left more or less when it was found than in the end, from which its rivals are
judged anew: the noise was known badly then, and what it hid may tell them apart."""

ALIKE, HARDLY = 0.0005, 0.05
"""Share of the fall of chi-squared, and chi-squared per residual, that one value for all may leave beside values of
each run to be taken for them: a current that is the same within a hundredth belongs in the profile."""


@dataclass(eq=False)
class Found:
    """The outcome of a search.

    base    the model re-tuned without any cause
    final   the model with all accepted causes
    causes  accepted hypotheses, in the order found, after those that others made superfluous were dropped
    steps   every look, the last one in vain
    held    what the logs hold between updates, where that is a cause; the base is read accordingly too
    more    whether much is left beside as many causes as are believed together, so that no further one was looked for
    left_out  refits of another search of an effect that was not looked for in this one
    """

    base: Point
    final: Point
    causes: list[Hypothesis] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)
    finer_step: float | None = None
    held: Held | None = None
    more: bool = False
    left_out: list[Refit] = field(default_factory=list)

    @property
    def n_terms(self) -> int:
        """Terms of the sum of the causes."""
        return n_terms([cause.tag for cause in self.causes])

    @property
    def is_beyond_belief(self) -> bool:
        """Whether a sum of so many terms is not believed."""
        return self.more or self.n_terms >= TOO_MANY


def search(
    bench: Workbench,
    hypotheses: Sequence[Hypothesis],
    in_place: Sequence[Hypothesis] = (),
    say: Callable[[str], None] = lambda _: None,
    again: Step | None = None,
    than: Found | None = None,
) -> Found:
    """Forward search with a backward look after each addition; where it is stopped, what was accepted by then.

    in_place  hypotheses that do the same as targets; looked at where these end at a bound of their box
    again     the first look of another search, among these hypotheses and more, which is taken up once more
    than      what this has to fit better than to be of use: given up once as many causes as are believed do not
    """
    if again is None:
        say("re-tuning the model without any cause")
    base = base_fit(bench) if again is None else again.base
    if not np.isfinite(base.chi2):
        problem = bench.problem_of(base.names).with_offsets(base.offsets)
        require_simulated(bench.model.profile, problem, base.unit, bench.trials)
    at_end = {name for name, z in zip(base.names, base.unit, strict=True) if z <= 0.0 or z >= 1.0}
    hypotheses = [*hypotheses, *(one for one in in_place if set(one.instead) <= at_end)]
    found = Found(base, base)
    left = _left(hypotheses, found, ())
    dropped: list[Hypothesis] = []
    once: list[Hypothesis] = []
    while hypotheses and not bench.stop():
        found.more = found.n_terms >= TOO_MANY - 1 and found.final.chi2 > STRONG * bench.problem.n_residuals
        if found.more or (than and found.n_terms >= TOO_MANY - 1 and not fits_better(bench, found, than)):
            break
        number = len(found.causes) + 1
        say(Phase("looking for a cause" if number == 1 else f"looking for cause {number}", look=number))
        try:
            if again is not None and not found.steps:
                step = look_again(bench, again, left)
            else:
                step = look(bench, found.final, left, first=not found.steps)
        except Stopped:
            break
        found.steps.append(step)
        if step.settled_by(step.evenly, HALF):
            say("the log holds its values")
            found.held = bench.held
            bench.read_evenly()
            found.final = bench.refit(step.base.names, step.base.unit[:, None], step.base.offsets)
            _drop_superfluous(bench, found, found.causes)  # what was taken for it
            left = _left(hypotheses, found, dropped)
            continue
        if step.settled_by(step.finer, ALMOST):
            say("the integration step is a cause")
            found.finer_step = step.finer
            bench.integrate(finer(bench.problem.integrator))
            found.final = bench.refit(step.base.names, step.base.unit[:, None], step.base.offsets)
            continue
        if not step.accepted:
            found.final = step.base
            break
        best = step.refits[0]
        found.causes = [*(cause for cause in found.causes if not best.hypothesis.holds(cause)), best.hypothesis]
        found.final = best.point
        bench.spreads = dict(best.point.spreads)
        known = list(found.causes)
        _drop_superfluous(bench, found, [cause for cause in known[:-1] if cause.by])  # these bend to much
        dropped += [cause for cause in known if cause not in found.causes]
        bent = [cause for cause in found.causes[:-1] if cause.by and cause not in once]
        _make_alike(bench, found, bent)
        once += bent
        left = _left(hypotheses, found, dropped)
        if len(found.causes) >= bench.options.most:
            break
    if found.steps:
        first = found.steps[0].base
        tolerance = unnoticed(bench, first.chi2)
        found.base = bench.refit(first.names, first.unit[:, None], first.offsets, tolerance=tolerance)
        found.final = bench.refit(found.final.names, found.final.unit[:, None], found.final.offsets, tolerance=PRECISE)
    if len(found.causes) > 1 and not bench.stop():
        _drop_superfluous(bench, found, found.causes[:-1])
    if not bench.stop():
        _make_plain(bench, found, hypotheses)
    found.more = found.more and found.n_terms >= TOO_MANY - 1
    return found


def fits_better(bench: Workbench, one: Found, other: Found) -> bool:
    """Whether the causes of one search leave less than those of another, by the noise as known now, their prices
    included."""
    costs = []
    for found in (one, other):
        point = found.final
        left = bench.refit(point.names, point.unit[:, None], point.offsets, max_iterations=0, spreads=point.spreads)
        costs.append(left.chi2 + sum(price_of(bench, found, cause) for cause in found.causes))
    return costs[0] < costs[1] - ENOUGH


def doubtful_beginning(bench: Workbench, found: Found) -> list[Refit]:
    """Refits of the first cause where another may have been the one to begin with; none else.

    That is so where a part of its form ended at the end of its range, so that its force is that of others together,
    where another effect did as well at the first look, be what was begun with a cause still or not, and where a cause
    that acts much like it was found beside it: the two may push against each other in the place of the second alone.
    """
    looks = [step.refits for step in found.steps if step.accepted and step.refits]
    read_otherwise = found.held is not None or found.finer_step is not None  # since the first look
    if read_otherwise or not (found.causes and looks):
        return []
    first, unit = found.causes[0], dict(zip(found.final.names, found.final.unit, strict=True))
    best, *others = looks[0]
    tag = ""
    at_end = any(not 0.0 < unit.get(name, 0.5) < 1.0 for name in bench.believed.form_of(first.effect))
    if at_end or against_its_kin(found):
        tag = first.tag
    elif any(one.hypothesis.tag != best.hypothesis.tag and abs(one.gain / best.gain - 1.0) < AS_WELL for one in others):
        tag = best.hypothesis.tag
    return [one for refits in looks for one in refits if one.hypothesis.tag == tag]


def against_its_kin(found: Found) -> bool:
    """Whether a cause was found that acts much like the first."""
    return any(cause.tag in first.effect.akin for first in found.causes[:1] for cause in found.causes[1:])


def _beside(hypothesis: Hypothesis, cause: Hypothesis) -> bool:
    """Whether a hypothesis may be looked at where a cause is known: it is of something else, or says more of it."""
    return hypothesis.holds(cause) or not set(hypothesis.bases) & set(cause.bases)


def _left(hypotheses: Sequence[Hypothesis], found: Found, dropped: Sequence[Hypothesis]) -> list[Hypothesis]:
    """Hypotheses that may still be looked at beside the causes found; of a form that is a part of another only that,
    where a cause is the other part: a limit of the rate of a rudder that lags is one cause with the lag."""
    open_ones = [h for h in hypotheses if h not in dropped and all(_beside(h, cause) for cause in found.causes)]
    wholes = [h for h in open_ones if any(h.holds(cause) for cause in found.causes)]
    parts = [h for h in open_ones if h not in wholes and any(whole.holds(h) for whole in wholes)]
    return [h for h in open_ones if h not in parts and (not h.refines or h in wholes)]


def without(bench: Workbench, point: Point, hypothesis: Hypothesis) -> Point:
    """The point refitted without one of its hypotheses."""
    back = [name for name in hypothesis.instead if name in bench.targets and name not in point.names]
    return _exchanged(bench, point, hypothesis.names, back, bench.null(back))


def _exchanged(
    bench: Workbench,
    point: Point,
    gone: Sequence[str],
    names: Sequence[str] = (),
    unit: Sequence[float] | FloatArray = (),
) -> Point:
    """The point refitted without some of its names, and with others from ``unit`` on."""
    kept = [i for i, name in enumerate(point.names) if name not in gone]
    start = np.concatenate([point.unit[kept], unit])
    free = (*(point.names[i] for i in kept), *names)
    return bench.refit(free, start[:, None], point.offsets, spreads=point.spreads)


def _drop_superfluous(bench: Workbench, found: Found, asked: Sequence[Hypothesis]) -> None:
    """Drop causes of those asked for that others explain."""
    asked, final = list(asked), found.final
    alone = side_by_side([partial(without, bench, final, hypothesis) for hypothesis in asked])
    for hypothesis, fewer in zip(asked, alone, strict=True):
        if found.final is not final:  # one was dropped since
            fewer = without(bench, found.final, hypothesis)
        if fewer.chi2 - found.final.chi2 < price_of(bench, found, hypothesis) + ENOUGH:
            found.causes.remove(hypothesis)
            found.final = fewer


def _make_alike(bench: Workbench, found: Found, asked: Sequence[Hypothesis]) -> None:
    """Make values of each run one for all where that leaves little more than noise beside what was found since.

    The next look asks again whether they differ.
    """
    for cause in asked:
        one = replace(cause, by="", groups=())
        alike = as_special(bench, found.final, cause, one)
        if alike.chi2 < STRONG * bench.problem.n_residuals:
            found.causes[found.causes.index(cause)] = one
            found.final = alike


def as_special(bench: Workbench, point: Point, cause: Hypothesis, special: Hypothesis) -> Point:
    """The point refitted with a special case in the place of a cause; one value for all, or for a group of runs, begins
    at the mean of those of each run."""
    gone = [name for name in cause.names if name not in special.names]
    if special.by == cause.by:
        return _exchanged(bench, point, gone)
    values = dict(zip(point.names, point.unit, strict=True))
    mean = [
        float(np.mean([values[name] for name in cause.names if within(name, one, bench.trials)]))
        for one in special.names
    ]
    if special.by:
        own = {f"{base}{AT}{special.by}": point.spreads[f"{base}{AT}{cause.by}"] for base in special.bases}
        point = replace(point, spreads={**point.spreads, **own})
    return _exchanged(bench, point, gone, special.names, mean)


def _make_plain(bench: Workbench, found: Found, hypotheses: Sequence[Hypothesis]) -> None:
    """Put a special case in the place of a cause where the parameters it does without earn too little: what else was
    wrong when the cause was found may have bent them, or made them differ from run to run.  Or another form of the same
    effect that has fewer: one rate of the rudder for two that are alike."""
    for cause in list(found.causes):
        if (plainer := _in_plainer_form(bench, found, cause, hypotheses)) is not None:
            found.causes[found.causes.index(cause)], found.final = plainer
            continue
        special = [one for one in hypotheses if cause.holds(one)]
        for one in sorted(special, key=lambda one: len(one.names)):
            fewer = as_special(bench, found.final, cause, one)
            saved = (len(cause.names) - len(one.names)) * bench.price
            if one.by != cause.by:
                saved = price_of(bench, found, cause) - len(one.names) * bench.price
            rise, fall = fewer.chi2 - found.final.chi2, found.base.chi2 - found.final.chi2
            hardly = rise < min(ALIKE * fall, HARDLY * bench.problem.n_residuals)
            if rise < saved + ENOUGH or (one.by != cause.by and hardly):
                found.causes[found.causes.index(cause)] = one
                found.final = fewer
                break


def _in_plainer_form(
    bench: Workbench, found: Found, cause: Hypothesis, hypotheses: Sequence[Hypothesis]
) -> tuple[Hypothesis, Point] | None:
    """A form of the effect of a cause with fewer parameters, none of them among its own, that does nearly as well."""
    step = step_of(found, cause)
    forms = [one for one in hypotheses if one.effect is cause.effect and one.by == cause.by]
    plainer = [one for one in forms if len(one.names) < len(cause.names) and not set(one.names) & set(cause.names)]
    if step is None or not plainer:
        return None
    refits = {refit.hypothesis.names: refit for refit in step.refits}
    values = dict(zip(found.final.names, found.final.unit, strict=True))
    mean = float(np.mean([values[name] for name in cause.names]))
    fewer = without(bench, found.final, cause)
    for one in sorted(plainer, key=lambda one: len(one.names)):
        refit = refits.get(one.names)
        start = np.full(len(one.names), mean)  # where it was not looked at: one rate of the rudder for two
        other = fitted_beside(bench, fewer, refit) if refit else _exchanged(bench, fewer, (), one.names, start)
        saved = (len(cause.names) - len(one.names)) * bench.price
        inflation = (refit or step.refits[0]).score.inflation
        if (other.chi2 - found.final.chi2) / inflation < saved + ENOUGH:
            return one, other
    return None


def step_of(found: Found, cause: Hypothesis) -> Step | None:
    """The look in which a cause was found, or what it is a special case of."""
    steps = [step for step in found.steps if step.refits]
    as_it_is = [step for step in steps if step.refits[0].hypothesis == cause]
    of_more = [step for step in steps if step.refits[0].hypothesis.holds(cause)]
    return next(iter([*as_it_is, *of_more]), None)


def price_of(bench: Workbench, found: Found, hypothesis: Hypothesis) -> float:
    """What a cause must explain at least: its share by BIC, or what it was charged when it was found."""
    paid = [r.cost for step in found.steps for r in step.refits[:1] if r.hypothesis == hypothesis and hypothesis.by]
    return paid[0] if paid else len(hypothesis.names) * bench.price


def rivals_of(bench: Workbench, found: Found, cause: Hypothesis) -> list[Refit]:
    """Other hypotheses that would do nearly as well in the place of a cause, all others in place: of those that were
    near when it was found, or another form of the same effect whose place it took."""
    step = step_of(found, cause)
    if step is None:
        return []
    others = [one for one in found.steps if one is not step and one.accepted and _is_of(one, cause)]
    in_other_noise = abs(found.final.chi2 - step.refits[0].point.chi2) > OTHER_NOISE * found.final.chi2
    if len(found.causes) == 1 and not others and not found.left_out and not in_other_noise:
        return rivals_among(step.refits)
    near = [*(rival for one in (step, *others) for rival in _near(one, cause)), *found.left_out]
    fewer = without(bench, found.final, cause)
    before = fewer.chi2 if np.isfinite(fewer.chi2) else found.base.chi2  # without it a run may be lost
    best = replace(step.refits[0], point=found.final, gain=before - found.final.chi2)
    rivals: dict[str, Refit] = {}
    for rival in near:
        if set(rival.hypothesis.bases) & {base_of(name) for name in fewer.names}:
            continue
        for start in (found.final, fewer):  # a ship tuned to nothing in its place may be far off
            other = fitted_beside(bench, _where(fewer, start), rival, hopeless_beside(bench, found.final.chi2))
            one = replace(rival, point=other, gain=before - other.chi2)
            if np.isfinite(other.chi2) and not best.beats(one):
                rivals.setdefault(one.hypothesis.tag, one)
                break
    return list(rivals.values())


def _where(point: Point, there: Point) -> Point:
    """A point at the values that what is free in it has at another, where it is free there too."""
    values = dict(zip(there.names, there.unit, strict=True))
    unit = np.array([values.get(name, z) for name, z in zip(point.names, point.unit, strict=True)])
    return replace(point, unit=unit, offsets=there.offsets)


def _is_of(step: Step, cause: Hypothesis) -> bool:
    """Whether what was found in a look is of the effect of a cause, in whatever form."""
    return bool(step.refits) and step.refits[0].hypothesis.tag == cause.tag


def _near(step: Step, cause: Hypothesis) -> list[Refit]:
    """Refits of a look that came near to the best, and are of another effect than a cause."""
    return [r for r in step.refits[1:] if r.hypothesis.tag != cause.tag and r.gain > 0.5 * step.refits[0].gain]
