"""What each cause contributes with all others in place, and which are no more than traces.

A test of significance asks whether something is there, not whether it matters: with thousands of samples and one large
cause in place, the smallest mismatch of the model's form passes it under some name.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...backends import STATES
from ...effects import Effect, ForceEffect, SensorEffect
from ...fitting.journal import side_by_side
from ...fitting.least_squares import fit_offsets
from ...trial import Trial
from ..bench.hypotheses import Hypothesis
from ..bench.inputs import unsteady
from ..bench.of_hull import AS_WELL, explained_by_hull
from ..bench.workbench import Point, Workbench
from ..evidence.leftover import Leftover, leftover
from ..held_out.gain import INDICES, LOST, measured
from ..held_out.unseen import Beside, Unseen
from ..searching.refit import WORTH
from ..searching.search import Found, step_of, without
from ..signatures.intervals import Estimate, estimates
from ..signatures.linear import typical
from ..signatures.retuned import retuned, unlike_any

SHARE = 0.01
"""Share of the error that all causes remove on held-out trials, below which one of them is not noticed."""

OF_NOISE = 0.05
"""Error on held-out trials, in any channel, over the variance of its noise: a smaller one is not noticed."""

OF_LENGTH = 0.01
"""Change of advance and tactical diameter, as a share of them, that is not noticed."""

OF_ANGLE = 0.5
"""Change of overshoots [deg] that is not noticed."""

SMALL, WORTH_ASKING = 0.05, 0.3
"""Share of the fall of chi-squared on the trials looked at up to which a cause may be a trace, and up to which held-out
trials are asked whether it does any good."""

FORM, FORM_IF_ROUGH, FORM_OF_TERM = 0.0005, 0.003, 0.02
"""Share of the error that a cause leaves whose form is 2 % off, one whose formula is no better than 5 %, and, to other
forces and to values that differ from run to run and bend to all that is left, one of many terms, which is the nearest
to what there is; and, to such a term, any cause that is no error of a log."""

FORM_OF_HULL = 0.05
"""Likewise, to terms of the hull, of a cause whose formula is rough, as of the hull's force in shallow water and of an
engine that gives way, and to a force of wind or waves of another such force: formulas of shallow water, winds and waves
differ by a fifth, and what one leaves of the other is a term, or a light wind."""

HARDLY_SEEN = 0.005
"""Share of the fall of chi-squared up to which a cause has to remove more than ``FORM`` on held-out trials, and
share of the error there up to which one that shows in a channel of its own may seem to add to others."""

DOUBTFUL = 0.02
"""Share of the fall of chi-squared, and of the error removed on held-out trials, up to which a cause that these trials
do not tell from others is a trace: errors of coefficients that nobody tunes are as large, and look like several."""

LEFT, OF_REST, BESIDE_SENSORS = 0.2, 0.9, 0.5
"""Error beyond noise, as a share of it, that others must leave, and the share of that which a cause with one value for
all must remove, for it to be no matter of their form: what a form leaves has no such shape; beside causes in sensors
alone, which have no form that could be a little off: a log that shows 1.1 times the speed does so exactly."""

BY_VALUES_OF_RUNS = 10.0
"""Share of the error on held-out trials over that of the fall of chi-squared, beside a cause with values of each run,
beyond which it is no more than these: estimated on the first part of a run they miss the rest by chance."""

MOVES = 0.1
"""Share of the size of another cause by which that would be off, and beyond its interval, without one that a user would
notice by this."""

TWICE = 2.0
"""Half-widths of its interval by which another cause must be off for that."""

SHOWS, OWN = 0.2, 100.0
"""Error in a channel on held-out trials, over the variance of its noise, and share of what all causes remove there,
over what the others' form may leave: a cause that removes as much in any channel is no matter of that form."""

SURELY = 3.0
"""Half-widths of its interval from none from which a cause is there, whatever little it changes, beside exact ones."""

MOST_RUNS = 0.5
"""A cause that does harm tells more than this share of the held-out runs worse: a sum may be decided by one run."""


@dataclass(frozen=True)
class Contribution:
    """What a cause brings, the others in place: everything is refitted without it.

    seen     share of the fall of chi-squared by all causes, on the trials looked at, that is lost without it
    share    share of the error on held-out trials removed by all causes that is lost without it
    channels by channel, the error on held-out trials that it removes over the variance of the noise
    indices  by manoeuvring index, the largest change on held-out trials: of lengths as a share, of angles [deg]
    form     share that an error in the form of the other causes may leave
    own      by channel, share of the error removed in that channel by all causes that is lost without it
    whole    whether it removes nearly all of what the others leave, which no form of theirs would let it
    bends    whether it has run-specific values, which can imitate other errors, on held-out trials too
    beside_runs  whether another cause has such values
    slight   whether it is the only cause, of a size that is not worth reporting, and unnoticed when left out
    moves    share of its size by which another cause would be off, and told wrong, without it
    unlike_any what mass or inertia would have to be without it, in words, as no ship has them; "" where they would not,
             or with it too
    good     as ``share``, of the channels alone that it can change: on others it acts by what is fitted beside it;
             infinite where it tells no more than half of the held-out runs worse; None for ``share``
    sure     whether its size is far from none beside others of exact form, which leave nothing that looks like it
    of_hull  share of what it explains that a hull further off than believed would explain; see ``explained_by_hull``

    Where ``seen`` alone shows that it is no trace, the other fields are not worked out: NaN and empty.
    """

    seen: float
    share: float = float("nan")
    channels: Mapping[str, float] | None = None
    indices: Mapping[str, float] | None = None
    form: float = FORM
    own: Mapping[str, float] = field(default_factory=dict)
    whole: bool = False
    bends: bool = False
    beside_runs: bool = False
    slight: bool = False
    moves: float = 0.0
    unlike_any: str = ""
    of_hull: float = 0.0
    good: float | None = None
    sure: bool = False

    @property
    def like_hull(self) -> bool:
        """Whether it is not told from a hull further off than believed, of a mass and inertia that a ship may have."""
        return self.of_hull >= AS_WELL and not self.unlike_any

    @property
    def harmful(self) -> bool:
        """Whether held-out trials are predicted no better with it than without.

        Where it shows in a channel of its own, errors in the form of larger causes may add as much in other channels as
        it removes in that one.
        """
        good = self.share if self.good is None else self.good
        return self.channels is not None and good <= (-HARDLY_SEEN if self.stands_out else 0.0)

    @property
    def stands_out(self) -> bool:
        """Whether it shows in a channel of which the others remove little else, such as that of a gyro that is off."""
        channels = self.channels or {}
        return any(error >= SHOWS and self.own.get(name, 0.0) >= OWN * self.form for name, error in channels.items())

    @property
    def apart(self) -> bool:
        """Whether it shows in a channel of its own and is nothing to all others, as the filter of a gyro is: no other
        cause looks different beside it."""
        return self.stands_out and self.share < FORM and self.seen < HARDLY_SEEN

    @property
    def unnoticed(self) -> bool:
        """Whether a user would notice nothing without it, or find held-out trials predicted no worse.

        It is also unnoticed where the other causes, a little off in their form, would leave as much.
        """
        if self.like_hull:
            return True
        if self.channels is None or self.indices is None:
            return self.slight
        if self.harmful:
            return True
        if self._needed:
            return False
        little = self._shown < self.form or (self.share < FORM and self.seen < HARDLY_SEEN)
        if little and not (self.stands_out or self.whole):
            return True
        moved = all(
            change < (OF_ANGLE if name.endswith("_deg") else OF_LENGTH) for name, change in self.indices.items()
        )
        return self.seen < SMALL and self.share < SHARE and max(self.channels.values()) < OF_NOISE and moved

    @property
    def _needed(self) -> bool:
        """Whether another cause, or mass and inertia, would be told wrong without it, or it is surely there."""
        return self.moves >= MOVES or bool(self.unlike_any) or self.sure

    @property
    def _shown(self) -> float:
        """Share that it shows of what all causes remove."""
        if self.bends:
            return self.seen
        held_out = min(self.share, BY_VALUES_OF_RUNS * self.seen) if self.beside_runs else self.share
        return max(held_out, self.seen)

    @property
    def little(self) -> bool:
        """Whether it is so small that it is named only if it can be told from all other causes."""
        asked = self.channels is not None
        little = asked and max(self.seen, self.share) < DOUBTFUL
        return little and not (self.stands_out or self.whole or self._needed)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        asked = self.channels is not None
        return {
            "share_of_fall": self.seen,
            "share_held_out": self.share if asked else None,
            "error_over_noise": dict(self.channels or {}),
            "index_changes": dict(self.indices or {}),
            "share_of_hull": self.of_hull,
            "moves_another": self.moves,
        }


@dataclass(frozen=True, eq=False)
class Aside:
    """A cause that was set aside as a trace, with its contribution, and the tags of the causes it cannot be told
    from."""

    hypothesis: Hypothesis
    estimates: Mapping[str, Estimate]
    p_value: float
    contribution: Contribution
    alike: Sequence[str] = ()

    @classmethod
    def of(
        cls, bench: Workbench, found: Found, cause: Hypothesis, brings: Contribution, alike: Sequence[str] = ()
    ) -> Aside:
        """Contribution of one of the causes that were found."""
        sizes = estimates(bench, found.final)
        step = step_of(found, cause)
        p_value = step.refits[0].p_value if step else 0.0
        return cls(cause, {name: sizes[name] for name in cause.names}, p_value, brings, alike)


def contributions(bench: Workbench, found: Found, unseen: Unseen) -> list[Contribution]:
    """Contribution of each cause; a cause that is alone, or beside a finer integration step only, contributes
    everything."""
    return _brought(bench, found, _fewer(bench, found), unseen)


def _fewer(bench: Workbench, found: Found) -> list[Point]:
    """What was found, refitted without each cause in turn; nothing where there is only one."""
    if len(found.causes) < 2:
        return []
    return side_by_side([partial(without, bench, found.final, cause) for cause in found.causes])


def _brought(bench: Workbench, found: Found, fewer: Sequence[Point], unseen: Unseen) -> list[Contribution]:
    """Contributions from fits without each cause in turn."""
    if not fewer:
        return [Contribution(1.0) for _ in found.causes]
    seen = [share_lost(found.base.chi2, point.chi2, found.final.chi2) for point in fewer]
    asked = [k for k, share in enumerate(seen) if share < WORTH_ASKING]
    held_out = dict(zip(asked, _held_out(found, [fewer[k] for k in asked], unseen), strict=True))
    return [
        _of(bench, found, cause, fewer[k], seen[k], held_out[k]) if k in held_out else Contribution(seen[k])
        for k, cause in enumerate(found.causes)
    ]


def set_aside(
    bench: Workbench, found: Found, unseen: Unseen, before: Leftover
) -> tuple[list[Aside], list[Contribution]]:
    """Take traces out of what was found, the least first, and refit the rest.

    before  what the model without any cause leaves

    -> the traces, and what each cause that stays brings
    """
    traces: list[Aside] = []
    fewer = _fewer(bench, found)
    brought = _brought(bench, found, fewer, unseen)
    if len(brought) == 1 and (unlike := unlike_without(bench, found, found.base)):
        brought = [replace(brought[0], unlike_any=unlike)]
    elif unseen.test and len(brought) == 1 and not before.structured:
        brought = [_alone(found, unseen)]
    if len(brought) == 1 and not before.noticed and size_of(bench, found.final, found.causes[0]) < WORTH:
        brought = [replace(brought[0], slight=True)]
    brought = _weighed(bench, found, fewer, brought)
    while any(one.unnoticed for one in brought):
        k = min((i for i, one in enumerate(brought) if one.unnoticed), key=lambda i: brought[i].seen)
        cause = found.causes[k]
        traces.append(Aside.of(bench, found, cause, brought[k]))
        found.final = fewer[k] if fewer else without(bench, found.final, cause)
        del found.causes[k]
        fewer = _fewer(bench, found)
        brought = _weighed(bench, found, fewer, _brought(bench, found, fewer, unseen))
    return traces, brought


def removed_by(bench: Workbench, traces: Sequence[Aside], whole: Point, without_them: Point) -> float:
    """What traces remove of the variance beyond noise, as a share of it; nothing where one of them does harm, or may be
    a hull further off: what it removes is of something else.

    whole  the point with them
    """
    if not traces or any(one.contribution.harmful or one.contribution.like_hull for one in traces):
        return 0.0
    return max(leftover(bench, without_them).unknown - leftover(bench, whole).unknown, 0.0)


def _weighed(
    bench: Workbench, found: Found, fewer: Sequence[Point], brought: Sequence[Contribution]
) -> list[Contribution]:
    """Contributions with what a hull further off would explain of each cause, and what others would be without those
    that seem unnoticed, or little."""
    points = fewer or [found.base] * len(found.causes)
    weighed = [
        replace(one, of_hull=explained_by_hull(bench, cause, point, found.final.chi2))
        for one, cause, point in zip(brought, found.causes, points, strict=True)
    ]
    seems = [(one.unnoticed or one.little) and not one.harmful for one in weighed]
    asked = [k for k, little in enumerate(seems) if fewer and little]
    if not asked:
        return weighed
    sizes = estimates(bench, found.final)
    for k in asked:
        moves = _moved(bench, found, found.causes[k], fewer[k], sizes)
        unlike = unlike_without(bench, found, fewer[k])
        sure = _is_sure(bench, found, found.causes[k], sizes)
        weighed[k] = replace(weighed[k], moves=moves, unlike_any=unlike, sure=sure)
    return weighed


def unlike_without(bench: Workbench, found: Found, fewer: Point) -> str:
    """What mass or inertia would have to be without a cause, in words, as no ship has them; "" where they would not, or
    with all causes too.

    fewer  the best fit without it
    """
    unlike = unlike_any(retuned(bench, fewer))
    return "" if unlike and unlike_any(retuned(bench, found.final)) else unlike


def _is_sure(bench: Workbench, found: Found, cause: Hypothesis, sizes: Mapping[str, Estimate]) -> bool:
    """Whether a cause of a single size is far from none, beside others whose formulas are exact and whose values are
    the same in all runs: others bend to what is left."""
    others = [one for one in found.causes if one is not cause]
    plain = len(cause.names) == 1 and not (cause.by or cause.effect.one_of_many)
    formed = any(one.effect.rough or one.effect.one_of_many or bench.believed.form_of(one.effect) for one in others)
    rough = formed or any(one.by for one in others)
    if not plain or rough or size_of(bench, found.final, cause) < WORTH:
        return False
    size, parameter = sizes[cause.names[0]], cause.effect.parameters[cause.variant[0]]
    if size.low is None or size.high is None:
        return False
    absent = parameter.null if size.stated is None else size.stated
    value, null, low, high = map(parameter.searched, (size.value, absent, size.low, size.high))
    return abs(value - null) > SURELY * 0.5 * abs(high - low)


def _moved(bench: Workbench, found: Found, cause: Hypothesis, fewer: Point, sizes: Mapping[str, Estimate]) -> float:
    """Largest share of its size by which another cause with one value for all is off without one, of those that are off
    by more than their interval allows.

    fewer  the best fit without it
    """
    values = bench.values(fewer)
    there, gone = (dict(zip(point.names, point.unit, strict=True)) for point in (found.final, fewer))
    largest = 0.0
    for other in found.causes:
        if other is cause or other.by or not set(other.names) <= set(gone):
            continue
        # Intervals allow for gusts and groups, which are the same without the cause.
        times = 1.0 if unsteady(other.effect) else TWICE
        wrong = any(_is_beyond(sizes[name], values[name], times) for name in other.names)
        size = size_of(bench, found.final, other)
        if not wrong or not size > 0.0:
            continue
        off = math.hypot(*((gone[name] - there[name]) / typical(bench, name) for name in other.names))
        largest = max(largest, off / size)
    return largest


def _is_beyond(estimate: Estimate, value: float, times: float) -> bool:
    """Whether a value is further from an estimate than so many times its interval reaches."""
    if estimate.low is None or estimate.high is None:
        return False
    middle, half = 0.5 * (estimate.low + estimate.high), 0.5 * (estimate.high - estimate.low)
    return abs(value - middle) > times * half


def size_of(bench: Workbench, point: Point, cause: Hypothesis) -> float:
    """Distance of the parameters of a cause from their null, in typical sizes."""
    unit = dict(zip(point.names, point.unit, strict=True))
    null = bench.null(cause.names)
    return math.hypot(*((unit[name] - z) / typical(bench, name) for name, z in zip(cause.names, null, strict=True)))


def with_only(bench: Workbench, found: Found, causes: Sequence[Hypothesis]) -> Found:
    """What was found with some of its causes only, all else refitted."""
    final = found.final
    for cause in found.causes:
        if cause not in causes:
            final = without(bench, final, cause)
    return replace(found, final=final, causes=list(causes), more=found.more and len(causes) == len(found.causes))


def _alone(found: Found, unseen: Unseen) -> Contribution:
    """Contribution of the only cause, where the model without it leaves nothing but noise: a trace if it does harm."""
    gain = measured(found, unseen)
    return Contribution(1.0, gain.share_removed, {}, {}) if gain.worse else Contribution(1.0)


@dataclass(eq=False)
class _HeldOut:
    """Trials that nothing was fitted to, by the model without any cause, without one, and with all.

    errors   (3, 6) squares by channel in variances of white noise
    counts   (6,) samples
    changes  the largest of each index by the cause
    worse    of each part that was left out, whether it is told worse with the cause
    """

    errors: FloatArray = field(default_factory=lambda: np.zeros((3, len(STATES))))
    counts: FloatArray = field(default_factory=lambda: np.zeros(len(STATES)))
    changes: dict[str, float] = field(default_factory=dict)
    worse: list[bool] = field(default_factory=list)

    def add(self, errors: FloatArray, counts: FloatArray, changes: Mapping[str, Sequence[float]]) -> None:
        """Further trials."""
        self.errors, self.counts = self.errors + errors, self.counts + counts
        self.worse.append(bool(errors[1].sum() < errors[2].sum()))
        for name, those in changes.items():
            if those:
                self.changes[name] = max(self.changes.get(name, 0.0), *those)


def _held_out(found: Found, fewer: Sequence[Point], unseen: Unseen) -> list[_HeldOut]:
    """Errors on held-out trials, with one point for each cause left out."""
    all_of = [_HeldOut() for _ in fewer]
    for points, trials in unseen.fits((found.base, found.final, *fewer)) if fewer else ():
        base, final, *others = points
        for one, point in zip(all_of, others, strict=True):
            one.add(*_errors(unseen.bench, (base, point, final), trials))
    return all_of


def _of(
    bench: Workbench, found: Found, cause: Hypothesis, fewer: Point, seen: float, held_out: _HeldOut
) -> Contribution:
    errors, counts, changes = held_out.errors, held_out.counts, held_out.changes
    removed = errors[:2].sum(axis=1) - errors[2].sum()
    channels = {
        name: float((errors[1, k] - errors[2, k]) / (counts[k] * noise.variance))
        for k, name in enumerate(STATES)
        if counts[k] and (noise := bench.noise.channels.get(name))
    }
    scale = max(float(removed[0]), abs(float(removed[1])))  # all together may remove less than one, or nothing
    form = _form_of_others(found, cause)
    own = {}
    for k, name in enumerate(STATES):
        by_all, by_one = errors[0, k] - errors[2, k], errors[1, k] - errors[2, k]
        if name in channels and by_one > 0.0:
            own[name] = float(by_one / max(by_all, by_one))
    share = float(removed[1]) / scale if scale > 0.0 else 1.0
    whole = takes_the_rest(bench, found, cause, fewer)
    beside_runs = any(one.by for one in found.causes if one is not cause)
    good = share
    if np.mean(held_out.worse) <= MOST_RUNS:
        good = math.inf
    elif isinstance(cause.effect, SensorEffect) and scale > 0.0 and (logs := cause.effect.shown_in(cause.variant)):
        shown = [STATES.index(name) for name in logs]
        good = float(np.sum((errors[1] - errors[2])[shown])) / scale
    return Contribution(seen, share, channels, changes, form, own, whole, bool(cause.by), beside_runs, good=good)


def _form_of_others(found: Found, cause: Hypothesis) -> float:
    """Share of the error that the other causes may leave by their form."""
    if cause.effect.one_of_many:
        others = [one.effect for one in found.causes if not one.effect.one_of_many]
        if any(one.rough for one in others):
            return FORM_OF_HULL
        if any(not isinstance(one, SensorEffect) for one in others):
            return FORM_OF_TERM
    if _of_weather(cause.effect) and any(_of_weather(one.effect) for one in found.causes if one is not cause):
        return FORM_OF_HULL
    bends = cause.by or (isinstance(cause.effect, ForceEffect) and not cause.effect.one_of_many)
    if bends and any(one.effect.one_of_many for one in found.causes):
        return FORM_OF_TERM
    # Another form of the same effect, as of a filter of second order, is what its formula is off by.
    again = any(one.tag == cause.tag for one in found.causes if one is not cause)
    return FORM_IF_ROUGH if again or any(one.rough for one in found.causes) else FORM


def _of_weather(effect: Effect) -> bool:
    """Whether it is a force of wind or waves, found or measured."""
    return isinstance(effect, ForceEffect) and (unsteady(effect) or "wave" in effect.of_measured.values())


def share_lost(base: float, fewer: float, final: float) -> float:
    """Share of the fall of chi-squared from ``base`` to ``final`` that is lost at ``fewer``.

    Motion without a cause may leave all bounds, and chi-squared with it: without that cause all is lost.
    """
    if fewer >= base or not final < base:
        return 1.0
    return (fewer - final) / (base - final) if np.isfinite(base) else 0.0


def takes_the_rest(bench: Workbench, found: Found, cause: Hypothesis, fewer: Point) -> bool:
    """Whether a cause with one value for all removes nearly all that the others leave beyond noise.

    fewer  the best fit without it
    """
    n = bench.problem.n_residuals
    rest = fewer.chi2 - n
    if cause.by or cause.effect.one_of_many or rest < LEFT * n:
        return False
    others = [one for one in found.causes if one is not cause]
    exact = bool(others) and all(isinstance(one.effect, SensorEffect) for one in others)
    return fewer.chi2 - found.final.chi2 >= (BESIDE_SENSORS if exact else OF_REST) * rest


def squares(off: FloatArray) -> FloatArray:
    """Sums of squares by channel (6,) of errors (n_trials, n_samples, 6); of a run that was lost, very much."""
    with np.errstate(over="ignore"):
        found = np.sum(off**2, axis=(0, 1))
    return np.where(found < LOST, found, LOST)


def _errors(
    bench: Workbench, points: Sequence[Point], trials: Sequence[Trial]
) -> tuple[FloatArray, FloatArray, dict[str, list[float]]]:
    """Squared errors by point and channel (n_points, 6) in variances of white noise, samples by channel (6,), and
    changes of indices from the last point but one to the last."""
    beside = Beside.of(bench, points, trials)
    scaled, counted = beside.scaled, beside.judged.cases.weight > 0.0
    errors = np.zeros((len(points), len(STATES)))
    for k, unit in enumerate(beside.units):
        states = scaled.states(unit[:, None], fit_offsets(scaled, unit)[:, None]).states[:, 0]
        off = np.where(counted, states - scaled.cases.target, 0.0)
        errors[k] = squares(off / bench.sigma)
    changes: dict[str, list[float]] = {name: [] for name in INDICES}
    for one in beside.compared():
        for name in INDICES:
            old, new = one.indices["before"].get(name), one.indices["after"].get(name)
            if old is not None and new is not None:
                changes[name].append(abs(new - old) / (1.0 if name.endswith("_deg") else max(abs(new), 1e-9)))
    return errors, counted.sum(axis=(0, 1)), changes
