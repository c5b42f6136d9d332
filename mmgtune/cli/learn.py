"""``mmgtune learn``: networks trained on trials."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from shlex import quote
from statistics import fmean, stdev
from typing import TYPE_CHECKING, Any

from ..options.learning import ROLES, EnsembleOptions, HybridOptions, LearnOptions, TrainingOptions
from ..phrases import counted
from . import common as c
from . import compare, learn_mixture
from .options import App, RunOptions, takes
from .progress import Progress

if TYPE_CHECKING:
    from ..fitting import Plan
    from ..learning import Learned, LearnedEnsemble, LearnedHybrid
    from ..scores import TrialScore

app = App(
    help="Train networks that predict the motion of a ship, and hold them against other models.",
)

app.command("compare")(compare.command)
app.command("mixture")(learn_mixture.command)


@app.command("rnn")
@takes(options=LearnOptions, run=RunOptions)
def rnn(
    profile: c.Profile = c.DEFAULT,
    trials: c.Trials = c.DEFAULT,
    *,
    options: LearnOptions,
    run: RunOptions,
    no_report: c.NoReport = False,
) -> None:
    """Train recurrent networks on the trials that tune: velocities, inputs and wind in, accelerations out.

    The networks of Wakita et al. 2022. Of the profile only the ship's name, her length and what drives her are used.
    Whole runs are kept back, and the weights are kept that do best on windows of these; with --validation 0 all runs
    are learned from and the last weights kept. Trials that test play no part and are scored at the end. What comes
    out is one file, model.safetensors in the run folder, that simulate and validate take in place of a profile. Needs
    the extra called learn.

    Examples:

      mmgtune learn rnn -p esso_osaka_3m -t esso --type 1 --seeds 5 --out runs/type1

      mmgtune validate esso_osaka_3m_tuned runs/type1/model.safetensors esso --restart 100
    """
    from ..learning import learn_rnn
    from ..learning.planning import plan_rnn

    _train(profile, trials, options, run, no_report, plan_rnn, learn_rnn, summary)


@app.command("hybrid")
@takes(options=HybridOptions, run=RunOptions)
def hybrid(
    profile: c.Profile = c.DEFAULT,
    trials: c.Trials = c.DEFAULT,
    *,
    options: HybridOptions,
    run: RunOptions,
    no_report: c.NoReport = False,
) -> None:
    """Train a small network for what a profile's forces leave, inside the profile's own simulation.

    The profile's coefficients stay. The network adds to the accelerations, begins at nothing, is as strong to port as
    to starboard, and is silent outside the data. It is kept only where it does better on runs it has not seen; a tuned
    profile is tuned anew without these runs for that comparison. What comes out is one file, model.safetensors, that
    simulate and validate take in place of a profile. Needs the extra called learn.

    Examples:

      mmgtune learn hybrid -p esso_osaka_3m_tuned -t esso --out runs/hybrid

      mmgtune learn hybrid -p tuned.toml -t my_trials/ --folds 5 --penalty 5,15,50
    """
    from ..learning import learn_hybrid
    from ..learning.planning import plan_hybrid

    _train(profile, trials, options, run, no_report, plan_hybrid, learn_hybrid, hybrid_summary)


@app.command("ensemble")
@takes(options=EnsembleOptions, run=RunOptions)
def ensemble(
    profile: c.Profile = c.DEFAULT,
    trials: c.Trials = c.DEFAULT,
    *,
    options: EnsembleOptions,
    run: RunOptions,
    no_report: c.NoReport = False,
) -> None:
    """Train an ensemble of networks on the trials that tune: it knows where these say little, since its members differ.

    The feed-forward networks of Wakita, Akimoto and Maki, by the likelihood of the measured velocities. Members differ
    by their initial values and by the order of windows alone; each is trained to the end, and none is chosen. Of the
    profile only the ship's name, her length and what drives her are used; trials that test play no part and are scored
    at the end. What comes out is one file, model.safetensors in the run folder, that simulate and validate take in
    place of a profile. Needs the extra called learn.

    Examples:

      mmgtune learn ensemble -p my_ship.toml -t my_trials --members 5 --out runs/ensemble

      mmgtune validate runs/ensemble/model.safetensors my_trials --restart 100
    """
    from ..learning import learn_ensemble
    from ..learning.planning import plan_ensemble

    _train(profile, trials, options, run, no_report, plan_ensemble, learn_ensemble, ensemble_summary)


def _train(
    profile: str,
    trials: str,
    options: TrainingOptions,
    run: RunOptions,
    no_report: bool,
    plan: Callable[..., Plan],
    learn: Callable[..., Any],
    words: Callable[[Any, dict[str, Any], str, bool], str],
) -> None:
    """Say what would be done, or train, write the run folder and print what was found."""
    from ..hooks import Hooks
    from ..learning import write_learned
    from ..report import render
    from ..run_folders import claimed

    ship, data = c.load(profile, trials)
    folder = run.out or c.default_out(ship)
    if run.dry_run:
        c.print_plan(plan(ship, data, options), folder, run.json)
        return
    progress = Progress(run.quiet, folder, kept="what was learned so far")
    with claimed(folder, force=run.force, resume=run.resume, anew=True, reads=(profile, trials)), progress:
        hooks = Hooks(on_progress=progress.on_share, stop=lambda: progress.stopped)
        result = learn(ship, data, options, hooks=hooks, folder=folder, resume=run.resume, command=c.command_line())
        document = write_learned(result, folder, overwrite=True)
        progress.saved(result.interrupted)
        if not no_report:
            render(folder)
    if run.json:
        c.print_json(document)
    else:
        c.show(words(result, document, str(folder), not no_report))
    progress.leave()


def hybrid_summary(_: LearnedHybrid, found: dict[str, Any], folder: str, report: bool) -> str:
    """Plain-text summary of the result."""
    from ..fitting.comparison import rounded
    from ..how_far_off import rms_errors

    lines = []
    if found["gained"]:
        lines += [f"{'runs not learned from':<24}{'runs':>6}{'L_MSE model':>13}{'hybrid':>10}   removed"]
        for row in found["gains"]:
            interval = row["share_removed_ci95"]
            removed = f"{100 * row['share_removed']:.0f} %"
            if interval:
                removed += f" ({100 * interval[0]:.0f} to {100 * interval[1]:.0f} %, runs drawn anew)"
            name = row["manoeuvre"] or "manoeuvre not stated"
            lines.append(
                f"{name:<24}{row['runs']:>6}{row['L_MSE_before']:>13.4g}{row['L_MSE_after']:>10.4g}   {removed}"
            )
        lines += ["", f"kept: penalty {found['penalty']:g}, {found['updates']} updates, trained on all runs that tune"]
        lines += ["", *found["reading"]["sentences"]]
    elif found["interrupted"]:
        lines.append("Stopped before a network was chosen: the model is the profile as it is.")
    else:
        lines.append("No gain: no network does better on runs it has not seen. The model is the profile as it is.")
    if found["scores"]:
        rows = [found["scores"][which] for which in ("before", "after")]
        place, heading = zip(*(rms_errors(found, row) for row in rows), strict=True)
        off = (
            (place, 3, " m off track"),
            (heading, 2, " deg off heading"),
            ([row["L_MSE"] for row in rows], 3, " L_MSE"),
        )
        parts = []
        for pair, digits, unit in off:
            both = ("diverged" if one is None else rounded(one, digits) for one in pair)
            parts.append(f"{' -> '.join(both)}{unit}")
        lines.append(f"held out, without -> with the network (root mean square): {', '.join(parts)}")
    return "\n".join([*lines, "", SCALE, *_ending(found, found["events"], folder, report)])


def summary(result: Learned, found: dict[str, Any], folder: str, report: bool) -> str:
    """Plain-text summary of the result."""
    members = found["members"]
    lines = [f"type {found['type']}: {found['recipe']}; {len(members)} x {found['width']} units"]
    learned = f"learned from {counted(len(found['learned_from']), 'trial')}"
    if found["chosen_by"]:
        lines += [f"{learned}, chosen by {counted(len(found['chosen_by']), 'other')}", ""]
        lines.append(f"{'seed':>6}{'best step':>11}{'L_MSE of validation':>22}")
        lines += [f"{row['seed']:>6}{row['best_step']:>11}{row['score']:>22.4g}" for row in members]
    else:
        lines += [f"{learned}; none chose: the mean of the last updates' weights is kept", ""]
        lines.append(f"{'seed':>6}{'updates':>11}{'loss':>12}")
        lines += [f"{row['seed']:>6}{row['best_step']:>11}{_shown(row['loss']):>12}" for row in members]
    for role, scores in result.scores.items():
        lines += ["", f"L_MSE on the trials {ROLES[role]}, mean and deviation over seeds", *_by_kind(scores)]
    events = [event for one in members for event in one["events"]]
    return "\n".join([*lines, "", SCALE, *_ending(found, events, folder, report)])


def ensemble_summary(result: LearnedEnsemble, found: dict[str, Any], folder: str, report: bool) -> str:
    """Plain-text summary of the result."""
    members = found["members"]
    lines = [f"ensemble of {len(members)} x {found['layers']} x {found['width']} units"]
    lines.append(f"learned from {counted(len(found['learned_from']), 'trial')}")
    watched = "of runs kept back" if found["watched_by"] else "on all windows of these"
    lines += ["", "loss: squared errors of three velocities over their noise; 3 is as near as the noise lets it be"]
    lines += [f"{'member':>8}{'updates':>9}{'loss':>10}   {watched}"]
    lines += [
        f"{k:>8}{row['steps']:>9}{_shown(row['loss']):>10}   {_shown(row['score'])}" for k, row in enumerate(members)
    ]
    for role, scores in result.scores.items():
        lines += ["", f"L_MSE on the trials {ROLES[role]}, mean and deviation over members", *_by_kind(scores)]
    events = [event for one in members for event in one["events"]]
    return "\n".join([*lines, "", SCALE, *_ending(found, events, folder, report)])


SCALE = (
    "L_MSE is counted in the spread of the trials that tune; mmgtune compare counts in that of the trials it is given, "
    "or of those named by --sigma-from."
)


def _shown(value: float | None) -> str:
    return "diverged" if value is None else f"{value:.4g}"


def _by_kind(scores: Sequence[TrialScore]) -> list[str]:
    from ..scores import L_MSE, by_manoeuvre, by_member

    found = []
    for kind, of in by_manoeuvre(scores).items():
        values = [L_MSE(one) for one in by_member(of)]
        spread = f" ± {stdev(values):.2g}" if len(values) > 1 and all(map(isfinite, values)) else ""
        found.append(f"  {kind or 'manoeuvre not stated':<24}{fmean(values):>10.4g}{spread}")
    return found


def _ending(found: dict[str, Any], events: list[dict[str, Any]], folder: str, report: bool) -> list[str]:
    """What went wrong on the way, how to go on, and where the results are."""
    lines = [
        f"note: diverged at step {event['step']}, went back to step {event['back_to']} at half the rate"
        for event in events
    ]
    if found["interrupted"]:
        lines += ["", f"Stopped early; --resume --out {quote(str(folder))} continues."]
    where = f"Report: {folder}/report.html" if report else ""
    return [*lines, "", f"{found['wall_s']:.1f} s. Model: {folder}/model.safetensors. {where}".rstrip()]
