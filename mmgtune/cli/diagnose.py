"""``mmgtune diagnose``."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import OptionError, Problem, among
from ..hooks import Phase
from ..options import DiagnoseOptions, in_flags
from ..units import NORMAL_95, in_time
from . import common as c
from . import completing
from .exitcodes import ExitCode
from .options import RunOptions, split, takes
from .progress import Progress

if TYPE_CHECKING:
    from ..diagnose import Diagnosis
    from ..diagnose.causes.by_run import ByRun
    from ..diagnose.voyages.difference import Difference


class Left:
    """About how long a diagnosis still takes, as far as that can be told.

    seconds  what was reckoned before it began, from and to [s]
    most     causes that may be looked for
    """

    def __init__(self, seconds: tuple[float, float], most: int):
        self.seconds, self.most = seconds, most
        self.began = time.monotonic()
        self.looks: list[tuple[int, float]] = []

    def words(self, phase: str) -> str:
        """While it looks: before the first look is over what was reckoned, then what as many looks would take.

        What follows the looks is not in these.  Where it takes longer than was reckoned, that is said.
        """
        now = time.monotonic()
        look = phase.look if isinstance(phase, Phase) else 0
        if not look:
            return ""
        if not self.looks or self.looks[-1][0] != look:
            self.looks.append((look, now))
        done = len(self.looks) - 1
        if not done:
            low, high = (seconds - (now - self.began) for seconds in self.seconds)
            if high <= 0.0:
                return self._longer(now)
            return f"about {in_time(low)} to {in_time(high)} left" if low > 0.0 else f"up to {in_time(high)} left"
        each = (self.looks[-1][1] - self.looks[0][1]) / done
        rest = each * max(1, self.most - done) - (now - self.looks[-1][1])
        return f"up to {in_time(rest)} more of looking" if rest > 0.0 else self._longer(now)

    def _longer(self, now: float) -> str:
        return f"longer than was reckoned, {in_time(now - self.began)} so far"


FAILING = ("none", "found", "not-separable", "unexplained")
"""Verdicts that a diagnosis may be told to fail on."""


@takes(options=DiagnoseOptions, run=RunOptions)
def command(
    profile: c.Profile = c.DEFAULT,
    trials: c.Trials = c.DEFAULT,
    *,
    options: DiagnoseOptions,
    run: RunOptions,
    fail_on: Annotated[
        list[str] | None,
        typer.Option(
            "--fail-on",
            help="Exit 1 on these verdicts: none, found, not-separable, unexplained. Interrupted ends with 130.",
            autocompletion=completing.words(FAILING),
            rich_help_panel=c.OUTPUT,
        ),
    ] = None,
    no_report: c.NoReport = False,
) -> None:
    """Name what a re-tuned model still gets wrong: cause, size, and the gain on trials not used.

    Of voyages (logs that say manoeuvre "voyage", or last more than an hour) at most --windows windows of 120 s, or
    --restart, are looked at, and what differs from voyage to voyage is told besides: current and resistance.

    Examples:

      mmgtune diagnose --profile suzaku --trials suzaku

      mmgtune diagnose -p my_ship.toml -t my_trials/ --json | jq .verdict

      mmgtune diagnose -p my_ship.toml -t my_trials/ --fail-on found,unexplained
    """
    from ..diagnose import diagnose, plan_diagnosis, write_diagnosis
    from ..report import render
    from ..run_folders import claimed

    failing = split(fail_on, "fail_on")
    unknown = [word for word in failing if word not in FAILING]
    if unknown:
        raise OptionError(
            *(Problem(f"unknown verdict '{word}'", "fail_on", **among(word, FAILING)) for word in unknown)
        )
    ship, data = c.load_with_voyages(profile, trials)
    if (asked := c.planned(run, ship, lambda: plan_diagnosis(ship, data, options))) is None:
        return
    folder, plan = asked
    if not run.quiet:
        c.say_odd(data, ship.L_pp)
    left = Left(plan.seconds, options.most).words
    with (
        claimed(folder, force=run.force, resume=run.resume, anew=True, reads=(profile, trials)),
        Progress(run.quiet, folder, left=left) as progress,
    ):
        result = diagnose(
            ship, data, options, hooks=progress.hooks(), folder=folder, resume=run.resume, command=c.command_line()
        )
        document = write_diagnosis(result, folder, overwrite=True)
        progress.saved(result.interrupted)
        if not no_report:
            render(folder)
    if run.json:
        c.print_json(document)
    else:
        c.show(summary(result, str(folder), report=not no_report))
    progress.leave()
    if result.verdict in failing:
        raise typer.Exit(ExitCode.NO)


def _by_voyage(one: Difference) -> list[str]:
    """A line for each voyage, where these differ."""
    if one.pattern not in ("each", "trend"):
        return []
    width = max(len(name) for name in one.voyages)
    rows = []
    for name, values, errors in zip(one.voyages, one.values, one.stderr, strict=True):
        told = (
            f"{parameter} {value:7.3f} +- {NORMAL_95 * error:.3f}"
            for parameter, value, error in zip(one.quantity.parameters, values, errors, strict=True)
        )
        rows.append(f"  {name:<{width}}  {'   '.join(told)}")
    return rows


def _of_runs(one: ByRun) -> list[str]:
    """A line for each run, or group of runs, with its 95 % interval."""
    rows = one.table()
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  " + "   ".join(word.ljust(width) for word, width in zip(row, widths, strict=True)).rstrip() for row in rows
    ]


def summary(result: Diagnosis, folder: str, report: bool) -> str:
    """Plain-text summary of the result."""
    from ..profile.doubts import in_words
    from ..report.wording import span
    from ..run_files import CALM

    rows = []
    for row in result.candidates[:12]:
        J = "" if row.J_test is None else f"{row.J_test:.4g}"
        gain = "not refitted" if row.gain is None else f"{row.gain:.4g}"
        by_chance = "" if row.p_value is None else f"{row.p_value:.2g}"
        rows.append((row.label, f"{row.score:.4g}", gain, by_chance, J))
    head, *rest = c.table(("hypothesis", "score", "gain", "by chance", "J test"), rows, spare=(1,))
    lines = [head, "", *rest, ""] if rows else []
    before, after = result.gain.J
    lines += [f"verdict: {result.verdict}", result.sentence()]
    if result.record:
        lines.append(result.record.sentence)
    first = "one more" if result.causes else "a cause"
    lines += [trace.told("another" if k else first) for k, trace in enumerate(result.traces)]
    where = f"J held out ({result.gain.words}; {result.gain.method})"
    named = result.causes and result.verdict != "unexplained" and not result.interrupted
    if named and before is not None and after is not None:
        interval = result.gain.interval
        sure = f"; 95 % interval of the share removed: {span(*interval)}" if interval else ", of one trial"
        of = f" {result.gain.J_is_of}." if result.gain.J_is_of else ""
        lines.append(f"{where}: {before:.4g} -> {after:.4g}{sure}.{of}".replace("\u00a0", " "))
    elif before is not None:
        lines.append(f"{where}: {before:.4g}, re-tuned without a cause.")
    by_run = [cause.runs for cause in result.causes if cause.runs and not result.interrupted]
    if by_run and not result.names_causes:
        lines += ["", "By run, as the best partial explanation has it:"]
    for runs in by_run:
        lines += ["", *_of_runs(runs)]
    if result.whereabouts:
        lines += ["", *result.whereabouts.sentences()]
    for one in result.differing:
        lines += ["", one.sentence, *_by_voyage(one)]
    if result.suggestion:
        lines.append(result.suggestion.sentence())
    if result.coverage and result.coverage.to_dict():
        lines += ["", result.coverage.sentence]
    notes = [*map(in_flags, result.warnings), *(f"{words}." for words in in_words(result.profile.doubts()))]
    lines += ["", *(f"Note: {words}" for words in notes)] if notes else []
    lines += ["", f"{'Stopped after' if result.interrupted else 'Finished in'} {result.wall_s:.1f} s."]
    lines.append(f"Report: {folder}/report.html" if report else f"Results: {folder}")
    if (calm := Path(folder) / CALM).is_file():
        lines.append(f"For predictions in calm water, without what was of the day: {calm}")
    return "\n".join(lines)
