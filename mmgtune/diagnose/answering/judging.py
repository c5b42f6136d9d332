"""From the outcome of a search to the answer: its causes, their rivals and what they gain."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import combinations
from typing import Any

import numpy as np

from ...backends import STATES
from ...effects import Effect
from ...fitting.journal import side_by_side
from ...fitting.one_sided import coverage_notes, followers
from ...hooks import Hooks
from ...options import DiagnoseOptions
from ...options.scoring import WINDOW
from ...phrases import listed
from ...profile import ShipProfile
from ...trial import Coverage, Trial
from ..bench.hypotheses import INPUTS_HELD, INTEGRATION_STEP, Hypothesis
from ..bench.inputs import unsteady
from ..bench.of_hull import in_words as explained_in_words
from ..bench.workbench import Point, Workbench
from ..causes.belief import MOSTLY, TOLD
from ..causes.by_run import ByRun
from ..causes.cause import Candidate, Cause, Trace
from ..causes.contributions import Aside, Contribution, contributions, size_of, unlike_without, with_only
from ..causes.doubted import Doubted, Leading
from ..evidence.gathering import error_of, evidence
from ..evidence.leftover import NOTICED, OF_ANOTHER_FORM, Leftover, leftover
from ..held_out.gain import WORSE, J_of, held_out
from ..held_out.unseen import Unseen
from ..result import Diagnosis
from ..searching.instead import instead_of_tuning
from ..searching.refit import WORTH, Refit, kin_among
from ..searching.search import Found, as_special, rivals_of, step_of
from ..signatures.at_ends import AtEnds
from ..signatures.intervals import Estimate, estimates
from ..signatures.linear import typical
from ..signatures.retuned import retuned, unlike_any
from ..voyages.difference import Difference
from ..voyages.windows import Choice
from .detecting import detectability
from .one_form import AS_UNSEEN, told_on_test
from .separate import Suggestion, suggest

A_LITTLE_OFF, NEARLY_ALL = 0.1, 0.99
"""That variance from which it may be a little off, and share of the fall of chi-squared from which an effect that acts
much like it does as well then: wind and the drift of waves."""

EITHER = 0.1
"""Share of what all causes do that is lost without one of two that act alike, up to which the other does it all."""

OF_RUNS_OFF = 0.03
"""The same of values of each run, which bend to most of it, with what gusts are thought to leave."""

PROMISING = 0.05
"""Share of the best gain from which a hypothesis is held against the test trials."""

PLAIN = 0.9
"""Share of the fall of chi-squared by the first cause of a sum from which a plainer form of it is told."""

MUCH_OPEN = 2.0
"""Variance that inputs leave open, over that of the noise, from which windows are advised where runs are long."""


@dataclass(frozen=True, eq=False)
class Judge:
    """Makes answers from outcomes of the search; holds what all answers of a diagnosis share.

    profile, options, provenance  as given
    asked     hypotheses that were looked for, and those that do the same as a target
    unseen    what answers are judged by: the trials kept for testing, or each run in turn
    before    what the model without any cause leaves
    traces    what was set aside; of_traces: what they remove of ``Leftover.unknown``
    choice    windows of voyages, None for trials; differing: what differs between the voyages
    """

    bench: Workbench
    profile: ShipProfile
    options: DiagnoseOptions
    provenance: Mapping[str, Any]
    hooks: Hooks
    asked: Sequence[Hypothesis]
    unseen: Unseen
    before: Leftover
    traces: Sequence[Aside]
    of_traces: float
    choice: Choice | None
    differing: Sequence[Difference]
    _J_test: dict[int, float | None] = field(default_factory=dict)  # of refits of the first look, which outlive this

    def answer(self, found: Found, brought: Sequence[Contribution]) -> tuple[Diagnosis, Found]:
        """The answer, and the causes it is about: those found, or a smaller set where only that is believed.

        brought  what each cause contributes
        """
        result = self._compared(self._judged(found, brought), found)
        result, found = self._without_doubtful(result, found, brought)
        result, found = self._one_of_kin(result, found)
        for causes, doubted in _fewer(result, found) if result.unclear and not self.hooks.stop() else []:
            fewer = with_only(self.bench, found, causes)
            if doubted is not None and causes:
                fewer = self._plainest(fewer)
            brought = contributions(self.bench, fewer, self.unseen)
            other = self._compared(self._judged(fewer, brought, doubted), fewer)
            enough = other.explains_all if other.differs_by_run else other.explains_nearly_all
            if other.names_causes and enough:
                result, found = other, fewer
                break
            if doubted is None and other.explained_share >= MOSTLY and not other.unclear:
                result, found = other, fewer  # as little is believed, and it takes less
            if doubted is not None:
                result = replace(result, leading=Leading.of(result, other))
        if result.is_next_to_nothing and self._may_be_noise(result) and not self.hooks.stop():
            for least, brought in self._least(found):
                other = self._judged(least, brought)
                if other.names_causes if least.causes else other.verdict == "none":
                    certain = self._of_a_run(result, found, least)
                    result, found = replace(other, traces=(*other.traces, *certain)), least
                    break
        if result.verdict == "unexplained" and not result.misses_test:
            result = replace(result, whereabouts=error_of(self.bench, found, self.before, result.leftover))
        elif result.verdict != "interrupted":
            result = replace(result, moved=tuple(retuned(self.bench, found.final)))
        if result.verdict == "none" and self.choice is None:
            self.hooks.on_phase("asking what re-tuning may stand for")
            result = replace(result, instead=instead_of_tuning(self.bench, found.base, self.asked))
        return result, found

    def _plainest(self, found: Found) -> Found:
        """What was found with the first of its causes alone, of the form with fewest values that does nearly as much:
        values of each run, and what changes within runs, bend to the rest of what is wrong."""
        (cause,) = found.causes
        fall = found.base.chi2 - found.final.chi2
        for one in sorted((one for one in self.asked if cause.holds(one)), key=lambda one: len(one.names)):
            point = as_special(self.bench, found.final, cause, one)
            if found.base.chi2 - point.chi2 > PLAIN * fall:
                return replace(found, final=point, causes=[one])
        return found

    def _may_be_noise(self, result: Diagnosis) -> bool:
        """Whether what the re-tuned model leaves is next to nothing, or has no shape and is next to nothing beside
        noise of the sensors that fades slowly; or no run has a value for certain of what was found beside it."""
        shapeless = not self.before.structured and result.chi2[0] < 1.0 + NOTICED
        in_no_run = all(cause.runs and cause.runs.in_none for cause in result.causes)
        return shapeless or not self.before.noticed or in_no_run

    def _least(self, found: Found) -> Iterator[tuple[Found, list[Contribution]]]:
        """Of causes beside which the re-tuned model leaves noise alone the first without which mass or inertia would be
        what no ship's is, and with which alone they are not; then none.  And what they bring."""
        for cause in found.causes if unlike_without(self.bench, found, found.base) else []:
            alone = with_only(self.bench, found, [cause])
            if unlike := unlike_without(self.bench, alone, found.base):
                yield alone, [Contribution(1.0, unlike_any=unlike)]
                break
        yield with_only(self.bench, found, []), []

    def _of_a_run(self, result: Diagnosis, found: Found, least: Found) -> list[Trace]:
        """Of causes that are left out as what they remove may be nothing, those of which a run has a value for certain:
        a clock that is late in one of eight, as traces."""
        runs = {cause.tag: cause.runs for cause in result.causes if cause.runs and not cause.runs.in_none}
        gone = [
            (cause, brings)
            for cause, (tag, brings) in zip(found.causes, result.contributions, strict=True)
            if cause.by and tag in runs and cause not in least.causes
        ]
        return [_trace(self.bench, Aside.of(self.bench, found, cause, brings)) for cause, brings in gone]

    def _without_doubtful(
        self, result: Diagnosis, found: Found, brought: Sequence[Contribution]
    ) -> tuple[Diagnosis, Found]:
        """The answer without small causes that cannot be told from others, or from none, or of a size that is not worth
        speaking of, the smallest first, as long as it holds without them; a small third may be all that keeps two from
        being believed."""
        while len(found.causes) > 1 and not self.hooks.stop():
            groups = {tag: others for tag, *others in result.groups}
            of_no_size = {cause.tag for cause in result.causes if not cause.sized}
            doubtful = [
                (one.seen, cause, one)
                for cause, one in zip(found.causes, brought, strict=True)
                if one.little and (cause.tag in {*groups, *of_no_size} or self._is_tiny(found, cause))
            ]
            if not doubtful:
                break
            _, cause, brings = min(doubtful, key=lambda one: one[0])
            fewer = with_only(self.bench, found, [one for one in found.causes if one is not cause])
            brought = contributions(self.bench, fewer, self.unseen)
            other = self._judged(fewer, brought)
            if cause.tag in of_no_size:  # what it removes is none of anything
                removed = max(other.leftover.unknown - result.leftover.unknown, 0.0)
                other = replace(other, of_traces=other.of_traces + removed)
            other = self._compared(other, fewer)
            if not (other.names_causes and other.explains_nearly_all):
                break
            trace = _trace(self.bench, Aside.of(self.bench, found, cause, brings, groups.get(cause.tag, [])))
            result, found = replace(other, traces=(*result.traces, trace)), fewer
        return result, found

    def _is_tiny(self, found: Found, cause: Hypothesis) -> bool:
        """Whether the size of a cause, or by how much it differs from run to run, is not worth speaking of."""
        if not cause.by:
            return size_of(self.bench, found.final, cause) < WORTH
        there = dict(zip(found.final.names, found.final.unit, strict=True))
        values = np.array([there[name] for name in cause.names]).reshape(len(cause.groups), -1)
        return math.hypot(*np.std(values, axis=0) / [typical(self.bench, name) for name in cause.bases]) < WORTH

    def _one_of_kin(self, result: Diagnosis, found: Found) -> tuple[Diagnosis, Found]:
        """The answer with one of two causes that act much alike, where each does nearly all that both do and both by
        formulas far off: a wind that pushes by another formula than the model's looks like one with waves from there.
        """
        brings = {id(cause): one.seen for cause, (_, one) in zip(found.causes, result.contributions, strict=True)}
        alike_in_all = [cause for cause in found.causes if not cause.by]
        for more, less in combinations(sorted(alike_in_all, key=lambda cause: -brings[id(cause)]), 2):
            alike = {more.tag, less.tag} & {*more.effect.akin, *less.effect.akin}
            far = all(self.bench.is_deformed(found.final, cause.effect) for cause in (more, less))
            if alike and far and brings[id(more)] < EITHER:
                fewer = with_only(self.bench, found, [one for one in found.causes if one is not less])
                other = self._compared(self._judged(fewer, contributions(self.bench, fewer, self.unseen)), fewer)
                if other.names_causes and other.explains_nearly_all:
                    groups = {first: rest for first, *rest in other.groups}
                    groups[more.tag] = list(dict.fromkeys([*groups.get(more.tag, []), less.tag]))
                    told = tuple((tag, *groups[tag]) for tag, _ in other.contributions if tag in groups)
                    return replace(other, groups=told), fewer
        return result, found

    def _judged(self, found: Found, brought: Sequence[Contribution], doubted: Doubted | None = None) -> Diagnosis:
        """The answer before its causes are compared with their rivals."""
        bench = self.bench
        sizes = estimates(bench, found.final)
        left = leftover(bench, found.final) if found.causes or found.finer_step else self.before
        theta, alone = (_targets_of(bench, point) for point in (found.final, found.base))
        coverage = Coverage.of(bench.trials, self.profile.L_pp)
        causes = _causes(bench, found, sizes, self.unseen.test)
        if any(cause.of_one_log for cause in causes):  # which may stand for a log that is off in a few runs
            left = replace(left, misread=self.before.misread)
        asked = [*zip(found.causes, brought, strict=True), *((one.hypothesis, one.contribution) for one in self.traces)]
        of_hull = [said for cause, one in asked if (said := explained_in_words(bench, cause.tag, one.of_hull))]
        notes = (
            *coverage_notes(bench.model, bench.targets, coverage),
            *_too_small(bench, found),
            *_deformed(causes),
            *of_hull,
            *_left_open(bench, left, self.options),
        )
        return Diagnosis(
            profile=self.profile,
            options=self.options,
            causes=tuple(causes),
            traces=tuple(_trace(bench, one) for one in self.traces),
            contributions=tuple((h.tag, one) for h, one in zip(found.causes, brought, strict=True)),
            groups=(),
            candidates=tuple(self._candidates(found)),
            detectability=tuple(detectability(bench, found.steps[0])) if found.steps else (),
            suggestion=None,
            gain=held_out(found, self.unseen),
            leftover=left,
            explained_share=_explained(found, self.before, left),
            theta=theta,
            retuned=alone,
            coverage=coverage,
            warnings=notes,
            noise=_noise(bench),
            chi2=(
                _first(found).chi2 / max(1, bench.problem.n_residuals),
                found.final.chi2 / max(1, bench.problem.n_residuals),
            ),
            evidence=evidence(bench, found, self.before, left),
            provenance=self.provenance,
            choice=self.choice,
            differing=tuple(self.differing),
            doubted=doubted,
            more=found.more,
            ends=AtEnds.of(bench, found.base, found.final),
            read_off=bench.read_off,
            unlike_any=unlike_any(retuned(bench, found.final)) if any(one.by for one in found.causes) else "",
            of_traces=self.of_traces if found.causes else 0.0,
            wall_s=0.0,
            interrupted=self.hooks.stop(),
        )

    def _candidates(self, found: Found) -> list[Candidate]:
        """Every hypothesis of the first look that was refitted, best first; then scores of the others."""
        if not found.steps:
            return []
        first = found.steps[0]
        promising = {id(r): r.point for r in first.refits if r.gain >= PROMISING * first.refits[0].gain}
        asked = {of: point for of, point in promising.items() if of not in self._J_test}
        tested = side_by_side([partial(J_of, self.bench, point, self.unseen.test) for point in asked.values()])
        self._J_test.update(zip(asked, tested, strict=True))
        listed = [
            Candidate(
                r.hypothesis.tag,
                tuple(r.hypothesis.variant),
                r.score.score,
                r.gain,
                r.p_value,
                self._J_test[id(r)] if id(r) in promising else None,
                r.unvisited if id(r) in promising else "",
                by=r.hypothesis.by,
            )
            for r in first.refits
        ]
        refitted = [r.hypothesis for r in first.refits]
        others = sorted((s for s in first.scores if s.hypothesis not in refitted), key=lambda s: -s.score)
        return listed + [
            Candidate(s.hypothesis.tag, s.hypothesis.variant, s.score, None, None, None, by=s.hypothesis.by)
            for s in others
        ]

    def _compared(self, result: Diagnosis, found: Found) -> Diagnosis:
        """The answer with the rivals that these trials cannot tell from its causes, where these are believed."""
        if result.verdict in ("unexplained", "interrupted") or not found.causes:
            return result
        self.hooks.on_phase("comparing the causes with their rivals")
        rivals = _of_effects(found.causes, [rivals_of(self.bench, found, cause) for cause in found.causes])
        if len(found.causes) == 1 and not rivals[0]:
            rivals = [_of_kin(result, found) or _telling_as_much(result, found)]
        if len(found.causes) == 1:
            rivals = [_not_refuted(result, rivals[0])]
        groups = tuple(
            tuple(dict.fromkeys([cause.tag, *(rival.hypothesis.tag for rival in of)]))
            for cause, of in zip(found.causes, rivals, strict=True)
            if of
        )
        suggestion = _suggestion(self.bench, found, rivals)
        return replace(result, groups=groups, suggestion=suggestion, interrupted=self.hooks.stop())


def _of_effects(causes: Sequence[Hypothesis], rivals: Sequence[list[Refit]]) -> list[list[Refit]]:
    """Rivals of each cause; none of a further form of an effect that another form tells: who doubts the time constant
    of the moment besides does not doubt the memory."""
    told = {cause.tag for cause, of in zip(causes, rivals, strict=True) if not (of or cause.effect.one_of_many)}
    return [[] if cause.tag in told else of for cause, of in zip(causes, rivals, strict=True)]


def _fewer(result: Diagnosis, found: Found) -> list[tuple[list[Hypothesis], Doubted | None]]:
    """Which of the causes found may be believed without the others, and what is doubted then: those whose size is told,
    where others act much like them, for these may stand for nothing; else the first alone."""
    unsized = {cause.tag for cause in result.causes if not cause.sized}
    sized = {one.tag for one in found.causes} - unsized
    needless = [one for one in found.causes if one.tag in unsized and sized.intersection(one.effect.akin)]
    rest = [one for one in found.causes if one not in needless]
    first = (found.causes[:1], Doubted.of(result))
    return [(rest, None), first] if needless else [first]


def _first(found: Found) -> Point:
    """The re-tuned model before any correction of integration step or inputs."""
    as_given = found.held is None and found.finer_step is None
    return found.base if as_given else found.steps[0].base


def leaves_much_open(trials: Sequence[Trial], left: Leftover, options: DiagnoseOptions) -> bool:
    """Whether the inputs of long runs are known too seldom to follow these to their end: windows tell more of them."""
    longest = max(trial.duration for trial in trials)
    return options.restart is None and left.left_open >= MUCH_OPEN and longest >= 2.0 * WINDOW


def _left_open(bench: Workbench, left: Leftover, options: DiagnoseOptions) -> list[str]:
    """That windows would tell more of such runs."""
    if not leaves_much_open(bench.trials, left, options):
        return []
    said = (
        "what the inputs did between samples of their log grows to many times the noise in runs as long as these: "
        f"windows that begin again tell more, restart={WINDOW:g}"
    )
    return [said]


def _too_small(bench: Workbench, found: Found) -> list[str]:
    """What the last look saw beyond chance, and did not believe since it is little and has rivals."""
    last = found.steps[-1] if found.steps else None
    if last is None or last.accepted or not last.refits or not last.rivals or last.refits[0].size >= WORTH:
        return []
    if last.refits[0].by_chance(bench.options.level) or last.refits[0].unvisited:
        return []
    tags = dict.fromkeys(refit.hypothesis.tag for refit in (last.refits[0], *last.rivals))
    told = f"Something shows beyond chance that is too small to be told: {' or '.join(tags)}."
    return [f"{told} Of the first of them it would be less than a {1.0 / WORTH:.0f}th of what is worth speaking of."]


def _deformed(causes: Sequence[Cause]) -> list[str]:
    """What is said of causes whose form ended at the end of what is thought possible."""
    return [
        f"Of {cause.tag} a part of its form ended at the end of its range ({listed(ended)}): its force is none of "
        "those that are known, and its size may be off by more than is said."
        for cause in causes
        if (ended := cause.form_at_end)
    ]


def _targets_of(bench: Workbench, point: Point) -> dict[str, float]:
    """Targets at a point, with what is tied to them, and what had leeway.

    The profile's own value where a cause takes the place of a target.
    """
    values = bench.values(point)
    own = {name: values[name] if name in values else bench.model.numbers()[name] for name in bench.tuned_alone}
    return own | followers(bench.model.ties, own)


def _causes(bench: Workbench, found: Found, sizes: Mapping[str, Estimate], test: Sequence[Trial]) -> list[Cause]:
    """Causes by tag, those of several parameters together."""
    causes: list[Cause] = []
    if found.finer_step is not None:
        causes.append(Cause(INTEGRATION_STEP, None, {}, 0.0, None))
    if found.held is not None:
        causes.append(Cause(INPUTS_HELD, None, {}, 0.0, None, words=found.held.sentence))
    J_before = J_of(bench, found.base, test)
    for tag, by in dict.fromkeys((h.tag, h.by) for h in found.causes):
        own = [h for h in found.causes if (h.tag, h.by) == (tag, by)]
        names = [name for h in own for name in h.names]
        steps = [step for one in own if (step := step_of(found, one)) is not None]
        J_after = J_of(bench, steps[0].refits[0].point, test) if steps else None
        gain = 1.0 - J_after / J_before if J_before and J_after is not None else None
        p_value = max((s.refits[0].p_value for s in steps), default=0.0)
        estimated = {name: sizes[name] for name in names}
        form = {name: sizes[name] for name in bench.believed.form_of(own[0].effect) if name in sizes}
        effect, variant = own[0].effect, tuple(dict.fromkeys(name for h in own for name in h.variant))
        runs = ByRun.of(effect, variant, by, own[0].groups, bench.trials, estimated) if by else None
        has = _in_profile(bench, effect)
        causes.append(Cause(tag, effect, {} if by else estimated | form, p_value, gain, runs, has=has))
    return causes


def _in_profile(bench: Workbench, effect: Effect) -> dict[str, float]:
    """What the profile has already of terms that an effect may add to its hull, by name: of a polynomial in the same
    terms."""
    profile = bench.model.profile
    if not effect.one_of_many or profile.sections["hull"].component.tag != "cubic":
        return {}
    own = {name: profile.value(full) for name, full in effect.absorbed.items() if full in profile.names()}
    return {name: value for name, value in own.items() if value}


def _trace(bench: Workbench, aside: Aside) -> Trace:
    one = aside.hypothesis
    runs = ByRun.of(one.effect, one.variant, one.by, one.groups, bench.trials, aside.estimates) if one.by else None
    has, estimated = _in_profile(bench, one.effect), {} if one.by else aside.estimates
    cause = Cause(one.tag, one.effect, estimated, aside.p_value, None, runs, has=has)
    return Trace(cause, aside.contribution, tuple(aside.alike))


def _of_kin(result: Diagnosis, found: Found) -> list[Refit]:
    """The effect that acts much like a single cause and may be meant, where this leaves more than noise: of wind or
    waves with what their own gusts may leave, of values of each run, which bend to what there is, be it that alone."""
    (cause,), left = found.causes, result.leftover.unknown
    if left > OF_ANOTHER_FORM:
        step = step_of(found, cause)
        return kin_among(step.refits, cause.tag) if step else []
    gusty = left + result.leftover.left_open if unsteady(cause.effect) else left
    off = gusty > A_LITTLE_OFF or (bool(cause.by) and result.chi2[1] > 1.0 + OF_RUNS_OFF)
    return kin_among(found.steps[0].refits, cause.tag, NEARLY_ALL) if off else []


def _telling_as_much(result: Diagnosis, found: Found) -> list[Refit]:
    """Refits of the first look that tell test trials about as well as values of each run, which are estimated on a part
    of these: play of a linkage turns the blade less by a share that differs between turns.

    However little such a cause explains where it was fitted: what the noise of the log does there is not its doing.
    """
    cause, named = found.causes[0], result.causes[0]
    if not cause.by or not named.gain_test or named.gain_test < TOLD or result.gain.J[0] is None:
        return []
    told = {
        (one.effect, one.parameters)
        for one in result.candidates
        if not one.by and one.effect != cause.tag and one.J_test is not None
        if told_on_test(result, one.J_test) >= AS_UNSEEN * named.gain_test
    }
    refits = [one for one in found.steps[0].refits if not one.hypothesis.by]
    return [one for one in refits if (one.hypothesis.tag, tuple(one.hypothesis.variant)) in told]


def _not_refuted(result: Diagnosis, rivals: Sequence[Refit]) -> list[Refit]:
    """Rivals of a single cause without those that test trials refute: what the cause tells these would foretell worse
    than no cause at all."""
    told = result.causes[0].gain_test
    if told is None or told < TOLD:
        return [*rivals]
    refuted = {
        (one.effect, one.parameters, one.by)
        for one in result.candidates
        if told_on_test(result, one.J_test) < -WORSE  # 0 where it was not measured
    }
    own = [(one.hypothesis.tag, tuple(one.hypothesis.variant), one.hypothesis.by) for one in rivals]
    return [one for one, said in zip(rivals, own, strict=True) if said not in refuted]


def _explained(found: Found, before: Leftover, left: Leftover) -> float:
    """Share of the error above the noise of the sensors on the trials looked at that the causes remove.

    What the logged inputs may have left open is error too where causes remove that: then the inputs did not.
    """
    if not found.causes:
        return 0.0
    whole, rest = before.excess - (left.excess - left.unknown), max(left.unknown, 0.0)
    removed = [1.0 - rest / whole] if whole > 0.0 else []
    if (largest := whole + before.left_open) > 0.0:
        removed.append(1.0 - (rest + left.left_open) / largest)
    return max(removed, default=0.0)


def _suggestion(bench: Workbench, found: Found, rivals: Sequence[Sequence[Refit]]) -> Suggestion | None:
    """The trial that would separate the first cause that has rivals."""
    for cause, of in zip(found.causes, rivals, strict=True):
        if of:
            best = [(cause.tag, found.final), *((r.hypothesis.tag, r.point) for r in of[:3])]
            return suggest(bench, best)
    return None


def _noise(bench: Workbench) -> dict[str, dict[str, float]]:
    """Noise by channel in SI units: white part, fading part and its autocorrelation."""
    return {
        name: {
            "white": float(bench.sigma[STATES.index(name)] * np.sqrt(noise.white)),
            "fading": float(bench.sigma[STATES.index(name)] * np.sqrt(noise.fading)),
            "autocorrelation": noise.phi,
        }
        for name, noise in bench.noise.channels.items()
    }
