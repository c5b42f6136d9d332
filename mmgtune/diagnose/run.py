"""A diagnosis from beginning to end."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, ship_of
from ..circumstances import another_size, reversals, reversed_in
from ..errors import ProfileError, must_be_a
from ..files import kept_in
from ..fitting.extending import with_width
from ..fitting.journal import journalled
from ..fitting.setting import in_pieces
from ..hooks import Hooks
from ..model import Model
from ..options import DiagnoseOptions
from ..options.choice import must_be
from ..options.scoring import WINDOW
from ..phrases import capital
from ..profile import ShipProfile, with_all_effects
from ..run_provenance import identity_of, make_provenance
from ..threads import blas_on_one_thread
from ..trial import Trial, TrialSet, VoyageSet, another_ship, check_trials
from ..trial.checks.control_checks import RUDDER_SIGN
from ..trial.checks.finding import Finding
from ..trial.checks.motion_checks import CONTRADICTED, YAW_SIGN
from ..trial.checks.set_checks import found_in, told_of
from ..trial.checks.swell import period_of, swings
from ..trial.schema import MOTION
from .answering.ended import in_words as ends_in_words
from .answering.ended import within_range
from .answering.judging import Judge, leaves_much_open
from .answering.jumped import beginnings_in_words, from_the_track_on, in_parts
from .answering.jumped import in_words as jumps_in_words
from .answering.one_form import misleading, of_one_form, tells_as_well
from .bench.hypotheses import Hypothesis, known_causes, not_looked_for, of_runs
from .bench.workbench import Workbench, make_workbench
from .causes.belief import TOLD
from .causes.contributions import removed_by, set_aside
from .evidence.leftover import NOTICED, SWELLS, beside_swell, leftover, motions_of
from .evidence.misread import LeftOut, both, is_of_few, without
from .evidence.odd_runs import put_right
from .held_out.together import Together
from .held_out.unseen import Unseen
from .result import Diagnosis
from .searching.narrow import narrow_box
from .searching.refit import Refit
from .searching.search import Found, against_its_kin, doubtful_beginning, fits_better, search
from .voyages.difference import LEG_NAMES, Difference
from .voyages.differences import differences
from .voyages.windows import Choice, looked_at, with_hull_held

LONG = 8.0
"""Windows in a run from which it is looked at in windows first, where it is the only one."""

Checked = Mapping[str, Sequence[Finding]]
"""What ``check_trials`` found, by trial."""

Look = Callable[[TrialSet, Choice | None, DiagnoseOptions], Diagnosis]
"""The answer of trials, windows of voyages or None, and options."""


@blas_on_one_thread
def diagnose(
    profile: ShipGiven,
    trials: TrialsGiven | VoyageSet,
    options: DiagnoseOptions = DiagnoseOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | str | None = None,
    resume: bool = False,
    command: str = "",
) -> Diagnosis:
    """Show what the model gets wrong on the trials, name the cause, extend the model, measure the gain.

    Causes are looked for on every trial that the split does not keep for testing; the gain is that on the test trials,
    or on each trial in turn where there are none.  Where what is found does not tell the test trials, all are looked at
    together, unless the options keep them or a sum of several terms is not believed already.  Nothing is read but the
    profile, the columns and the split.

    What single runs log otherwise than all others is put right first, or left out, and said.  Of one long run windows
    are looked at first.

    Of voyages, logs of hours, a bounded number of windows is looked at, and what differs from one to the next is told.

    profile, trials  objects, paths or bundled names
    hooks   what is told on the way, and what ends it: see ``until_interrupted`` for Ctrl-C
    folder  where each finished refit is noted at once; None for nowhere
    resume  continue what was stopped in the folder
    Raises OptionError for choices that make no sense, OutputError where the folder cannot be written to, ProfileError
    where the simulation of a trial runs away wherever the targets are.
    """
    folder = kept_in(folder, resume)
    must_be(options, DiagnoseOptions)
    must_be_a(hooks, Hooks, "hooks")
    profile = ship_of(profile)
    options = with_width(profile, options)
    trials, choice = looked_at(profile, trials, options)
    provenance = make_provenance(profile, trials, command)
    identity = identity_of(profile, trials, options, provenance)
    with journalled(folder, identity, hooks.stop, resume=resume):
        began = time.perf_counter()
        checked = check_trials(trials.trials, profile.L_pp) if choice is None else {}
        odd = (found_in(checked, code) for code in (RUDDER_SIGN, CONTRADICTED))
        right, misread = put_right(profile, trials.trials, *odd)
        trials = replace(trials, trials=right) if misread else trials

        def look(trials: TrialSet, choice: Choice | None, options: DiagnoseOptions) -> Diagnosis:
            return _looked_at(profile, trials, checked, choice, options, hooks, provenance)

        alone = choice is None and _is_one_long_run(trials, options)
        windows = _windows(look, trials, options, hooks) if alone else None
        told = windows if windows and (windows.names_causes or windows.interrupted) else None
        result = told or look(trials, choice, options)
        if result.gain.missed and not (options.keep_test or choice or result.is_beyond_all or hooks.stop()):
            hooks.on_phase("looking at all trials together")
            with suppress(ProfileError):  # where the model runs away on the others there is nothing more to look at
                result = _settled(result, look(replace(trials, test=()), None, options))
        elif not (choice or alone or hooks.stop()) and result.verdict in ("unexplained", "not-separable"):
            result = _in_windows(look, trials, options, hooks, result)
        if misread:
            result = replace(result, misread=both(misread, result.misread))
        return replace(result, wall_s=time.perf_counter() - began)


def _is_one_long_run(trials: TrialSet, options: DiagnoseOptions) -> bool:
    """Whether all there is is one run, so long that what is small adds up in it, and no other run tells it apart."""
    runs = {trial.run for trial in trials.trials.values()}
    longest = max(trial.duration for trial in trials.trials.values())
    return options.restart is None and len(runs) == 1 and longest >= LONG * WINDOW


def _in_windows(look: Look, trials: TrialSet, options: DiagnoseOptions, hooks: Hooks, whole: Diagnosis) -> Diagnosis:
    """The answer of whole runs, or that of windows of these, where inputs leave too much open over whole runs, and
    windows name causes that these do not, or fewer rivals of them."""
    if not leaves_much_open(list(trials.trials.values()), whole.leftover, options):
        return whole
    windows = _windows(look, trials, options, hooks)
    if windows is None:
        return whole
    if windows.names_causes and (not whole.names_causes or _rivals(windows) < _rivals(whole)):
        return windows
    return replace(whole, interrupted=windows.interrupted)


def _windows(look: Look, trials: TrialSet, options: DiagnoseOptions, hooks: Hooks) -> Diagnosis | None:
    """The answer of windows, which says so; None where the model runs away in one."""
    hooks.on_phase(f"looking at windows of {WINDOW:g} s")
    with suppress(ProfileError):
        windows = look(trials, None, replace(options, restart=WINDOW))
        said = (
            f"Told by windows of {WINDOW:g} s, each with a beginning of its own: over whole runs, what the inputs did "
            "between samples of their log hides it."
        )
        return replace(windows, warnings=(said, *windows.warnings))
    return None


def _rivals(result: Diagnosis) -> int:
    """How many causes are not told apart."""
    return sum(map(len, result.groups))


def _settled(alone: Diagnosis, of_all: Diagnosis) -> Diagnosis:
    """Of an answer that does not tell the trials kept for testing and that of all together, the one to give.

    A cause that the others show stays if it tells most of the error of those, unless all together show one that tells
    what is held out better.
    """
    if of_all.interrupted:
        return replace(alone, interrupted=True)
    effects = tuple(cause.tag for cause in alone.causes)
    together = Together.of(alone.gain, effects, believed=alone.names_causes, settled=True)
    settled = replace(of_all, together=together)
    better = settled.names_causes and of_all.gain.share_removed > alone.gain.share_removed
    if better or not alone.names_causes or alone.gain.share_removed < TOLD:
        return settled
    return replace(alone, together=replace(together, settled=False))


def _looked_at(
    profile: ShipProfile,
    trials: TrialSet,
    checked: Checked,
    choice: Choice | None,
    options: DiagnoseOptions,
    hooks: Hooks,
    provenance: dict[str, Any],
    gone: LeftOut | None = None,
) -> Diagnosis:
    """The answer of the trials that are not kept for testing; how long it took is for the caller to say.

    checked  what is odd about the trials as given
    gone     logs that were found to be misread, in whose place the trials have gaps
    """
    odd = [f"{capital(words)}." for words in another_ship(trials.ship, profile.id)]
    odd += told_of(checked)
    odd += _derived(trials.trials)
    given, whole = trials, trials.trials
    off: dict[str, float] = {}
    jumped: dict[str, float] = {}
    if choice is None and options.restart is None:
        trials, off = from_the_track_on(trials)
        trials, jumped = in_parts(trials)
    trials = in_pieces(trials, options.fit_options())
    trials, ended = within_range(trials, whole)
    seen = _in_order([trial for name, trial in trials.trials.items() if name not in trials.test])
    test = _in_order([trials.trials[name] for name in trials.test])
    first = "" if choice else _contradicted(whole, checked, SIGNS) or _of_another_size(profile, seen)
    known = known_causes(profile, seen, options) if not first else []
    in_place = known_causes(profile, seen, options, in_place=True) if choice is None and not first else []
    names = [name for h in (*known, *in_place) for name in h.names]
    options = with_hull_held(options) if choice else options
    bench = make_workbench(profile, seen, options, [*names, *(_legs(profile, names) if choice else ())])
    bench.stop = hooks.stop
    known = [h for h in known if not set(h.names) & set(bench.targets)]
    known = [h for h in known if not set(h.instead) & set(bench.targets)]
    differing_by_run = of_runs([*known, *in_place], seen) if choice is None else []
    asked = [*known, *in_place]

    def searched(
        hypotheses: Sequence[Hypothesis], left_out: Sequence[Refit] = (), earlier: Found | None = None
    ) -> Found:
        """What a search finds among some of the hypotheses; an effect left out may do as well as what is found.

        earlier  what was found among all: its first look is taken up again; with an effect left out it is to be beaten
        """
        again = earlier.steps[0] if earlier else None
        found = search(bench, hypotheses, in_place, hooks.on_phase, again, than=earlier if left_out else None)
        found.left_out = list(left_out)
        return found

    def answered(found: Found) -> tuple[Diagnosis, Found]:
        """The answer of what a search found, and the causes it is about."""
        hooks.on_phase("measuring the gain")
        before = leftover(bench, found.base)
        unseen = Unseen(bench, [found.held.evenly(trial) for trial in test] if found.held else test)
        with_traces = found.final
        traces, brought = set_aside(bench, found, unseen, before)
        of_traces = removed_by(bench, traces, with_traces, found.final)
        differing: Sequence[Difference] = ()
        if choice is not None and not hooks.stop():
            hooks.on_phase("comparing the voyages")
            differing = differences(bench, found.final, choice.voyages)
        hooks.on_phase("gathering the evidence")
        judge = Judge(
            bench, profile, options, provenance, hooks, asked, unseen, before, traces, of_traces, choice, differing
        )
        return judge.answer(found, brought)

    result, found = _of_the_better_beginning(bench, searched, answered, [*known, *differing_by_run], hooks)
    doubtful = result.verdict != "none" or result.leaves_open
    left_out = not_looked_for(profile, options.effects) if doubtful else []
    told = capital(jumps_in_words(jumped))
    beside = [f"{told}: runs are taken in parts there, which begin where their own samples say."] if told else []
    told = capital(ends_in_words(ended))
    beside += [f"{told}: what it shows there is left out."] if told else []
    told = capital(beginnings_in_words(off, len(whole)))
    beside += [f"{told}, as of a receiver that is late: runs begin after these."] if told else []
    astern = [f"{capital(said)}." for said in reversals(bench.model, seen)]
    odd += astern
    warnings = (*odd, *beside, *result.warnings, *left_out, *(narrow_box(bench, found) if not hooks.stop() else ()))
    result = replace(result, warnings=warnings, jumped=jumped, ended=ended)
    if is_of_few(misread := result.leftover.misread, len(seen)) and not hooks.stop():
        hooks.on_phase("looking again without logs that are misread")
        right = replace(given, trials={id: without(trial, misread) for id, trial in whole.items()})
        wrong = {id: trial for id, trial in whole.items() if any(id in runs for runs in misread.values())}
        without_them = LeftOut(misread, wrong).beside(gone)
        return _looked_at(profile, right, checked, choice, options, hooks, provenance, without_them)
    if gone:
        shown = {trial.id: states for trial, states in zip(bench.trials, motions_of(bench, found.final), strict=True)}
        result = replace(result, misread=gone.as_all_else_shows(shown))
    if result.verdict not in ("unexplained", "none") or choice is not None:
        return result
    if contradicted := first or _contradicted(whole, checked):
        return replace(result, contradicted=contradicted, instead=None)
    if result.verdict == "none":
        return result
    if astern and len(reversed_in(bench.model, seen)) < len({trial.whole for trial in seen}):
        return replace(result, contradicted=f"{astern[0]} Leave that out, and diagnose what else was sailed.")
    swinging, period = _swinging(whole, profile.L_pp)
    if not swinging:
        return result
    if not result.causes and not test and beside_swell(bench, found.final, period) < NOTICED:
        averaged = f"Averaged over {SWELLS:g} such periods, what the re-tuned model leaves is noise"
        return replace(result, swell=f"{swinging}. {averaged}: nothing else is wrong.", whereabouts=None)
    return replace(result, contradicted=f"{swinging}: that may be all that is left.")


def _of_the_better_beginning(
    bench: Workbench,
    searched: Callable[..., Found],
    answered: Callable[[Found], tuple[Diagnosis, Found]],
    hypotheses: Sequence[Hypothesis],
    hooks: Hooks,
) -> tuple[Diagnosis, Found]:
    """The answer of a search; where that is unexplained or has a cause beside one that acts like it, and another may
    have been the one to begin with, of one without the first, if its causes are believed and fit better.  Where it has
    values of each run to which a form that is the same in all runs may have led, of one without such values."""
    result, found = answered(searched(hypotheses))
    if not hooks.stop() and (tag := of_one_form(result) or misleading(result)):
        hooks.on_phase(f"looking again without {tag} of each run")
        known = bench.known()
        other, others = answered(searched([one for one in hypotheses if not one.by], (), found))
        if tells_as_well(other, result):
            return other, others
        bench.put_back(known)
        result = replace(result, interrupted=other.interrupted)
    doubted = result.verdict == "unexplained" or (result.names_causes and against_its_kin(found))
    begun = doubtful_beginning(bench, found) if doubted and not hooks.stop() else []
    if not begun:
        return result, found
    first = begun[0].hypothesis.tag
    hooks.on_phase(f"looking again without {first}")
    known = bench.known()
    others = searched([one for one in hypotheses if one.tag != first], begun, found)
    if not others.is_beyond_belief and fits_better(bench, others, found):
        other, others = answered(others)
        if other.names_causes and fits_better(bench, others, found):
            return other, others
    bench.put_back(known)
    return replace(result, interrupted=hooks.stop()), found


def _legs(profile: ShipProfile, names: Sequence[str]) -> list[str]:
    """What may differ from voyage to voyage, of the effects that apply, besides what is looked for anyhow."""
    there = {f"{effect.kind}.{name}" for effect in Model(with_all_effects(profile)).effects for name in effect.fields}
    return [name for name in LEG_NAMES if name in there and name not in names]


SIGNS = (RUDDER_SIGN, YAW_SIGN)
"""Codes of findings of which no cause is the reason: where most trials have them none is looked for."""


def _contradicted(trials: Mapping[str, Trial], checked: Checked, codes: Sequence[str] = (*SIGNS, CONTRADICTED)) -> str:
    """What the logs of most trials say against each other, which is to be put right before a cause is looked for; by
    what ``check_trials`` found in them, of some codes."""
    for code in codes:
        apart = found_in(checked, code)
        if of := _most(len(apart), trials):
            one = next(iter(apart.values()))
            said = f"{one.what}, whatever the model: {one.why}"
            if code == RUDDER_SIGN:
                said = f"{one.what}: the sign of its angle is wrong, or those of heading and yaw rate"
            return f"First put the logs right: in {of} {said}."
    return ""


def _of_another_size(profile: ShipProfile, trials: Sequence[Trial]) -> str:
    """That profile and trials cannot be of one ship as they are; "" where they can."""
    return "".join(f"First see which ship these trials are of: {said}." for said in another_size(profile, trials))


def _swinging(trials: Mapping[str, Trial], L_pp: float) -> tuple[str, float]:
    """That the ship swings in most trials as in waves, without a full stop, and the period [s]; "" where not."""
    periods = [period_of(found) for trial in trials.values() if (found := swings(trial, L_pp))]
    of = _most(len(periods), trials)
    if not of:
        return "", 0.0
    period = float(np.median(periods))
    swings_so = f"the ship swings from beginning to end with a period of {period:.2g} s, as in waves"
    return f"In {of} {swings_so}, which no manoeuvring model follows", period


def _most(number: int, trials: Mapping[str, Trial]) -> str:
    """So many of the trials, in words, where they are most of them; else ""."""
    if 2 * number <= len(trials):
        return ""
    return f"{number} of {len(trials)} {_pieces(trials)}s" if len(trials) > 1 else f"the {_pieces(trials)}"


def _pieces(trials: Mapping[str, Trial]) -> str:
    """What they are: of voyages windows."""
    return "window" if any(trial.part_of for trial in trials.values()) else "trial"


def _derived(trials: Mapping[str, Trial]) -> list[str]:
    """A sentence on what was worked out from other channels; none where nothing was."""
    names = [name for name in MOTION if any(name in trial.derived for trial in trials.values())]
    if not names:
        return []
    n = sum(bool(trial.derived) for trial in trials.values())
    was, does = ("was", "does") if len(names) == 1 else ("were", "do")
    of = f"{n} of {len(trials)} {_pieces(trials)}s"
    return [f"{', '.join(names)} {was} derived from other channels in {of}, not measured, and {does} not count there."]


def _in_order(trials: Sequence[Trial]) -> list[Trial]:
    """Trials without what their files say about them and what was derived, in an order that depends on what was
    measured alone."""
    bare = [replace(trial.as_measured(), noise={}) for trial in trials]
    return sorted(bare, key=lambda trial: (trial.n_samples, trial.motion[0].tolist(), trial.delta.tobytes()))
