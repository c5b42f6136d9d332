"""``mmgtune validate`` on voyages: a run folder, and what is found in it."""

from __future__ import annotations

from collections.abc import Sequence
from shlex import quote
from typing import TYPE_CHECKING, Any

from ..errors import TrialError
from ..options import VoyageOptions
from ..phrases import counted
from ..units import DEG, shown_in
from . import common as c
from .options import WrittenOptions
from .progress import Progress

if TYPE_CHECKING:
    from ..voyages import VoyageValidation

SHOWN = 5
"""Features whose bins are printed; the report has all."""


def on_voyages(
    profiles: Sequence[str],
    trials: str,
    options: VoyageOptions,
    run: WrittenOptions,
    *,
    json: bool,
    no_report: bool,
) -> None:
    """Score profiles on voyages, write the run folder and print what was found."""
    from ..hooks import Hooks
    from ..networks import named_ship
    from ..predictor import profile_of
    from ..report import render
    from ..run_folders import claimed
    from ..trial import load_voyages
    from ..voyages import validate_voyages, write_voyages

    ships = [named_ship(name) for name in profiles]
    data = load_voyages(trials)
    if data.ship and data.ship != ships[0].id:
        c.say(f"warning: the voyages are of '{data.ship}', the first profile is of '{ships[0].id}'")
    folder = run.out or c.default_out(ships[0])
    kept = "what is done so far"
    with claimed(folder, force=run.force, resume=run.resume), Progress(run.quiet, folder, kept=kept) as progress:
        hooks = Hooks(on_progress=progress.on_share, stop=lambda: progress.stopped)
        try:
            result = validate_voyages(
                list(profiles), data, options, hooks=hooks, folder=folder, resume=run.resume, command=c.command_line()
            )
        except TrialError:
            c.say(
                f"what is done so far is kept: once the voyages are mended, --resume --out {quote(str(folder))} goes on"
            )
            raise
        document = write_voyages(result, folder, overwrite=True)
        progress.saved(result.interrupted)
        if not no_report:
            render(folder)
    if json:
        c.print_json(document)
    else:
        c.show(summary(result, str(folder), report=not no_report))
        for name, notes in result.notes.items():
            for note in notes:
                c.say(f"note: {name}: {note}")
        for name, predictor in result.predictors.items():
            if (profile := profile_of(predictor)) is not None:
                c.say_doubts(profile.doubts(), f"{name}: ")
    progress.leave()


def summary(result: VoyageValidation, folder: str, report: bool) -> str:
    """Plain-text summary of the result."""
    found = result.to_dict()
    lines = [found["verdict"]]
    if result.n_windows:
        limits, models = found["classes"]["cVDM_limits"], found["models"]
        lines += ["", f"windows by cVDM: optimal to {limits[0]:g} %, satisfactory to {limits[1]:g} %"]
        counts = [(one["profile"][-40:], *map(str, (*one["classes"].values(), one["diverged"]))) for one in models]
        lines += _indented(("", *found["classes"]["names"], "diverged"), counts)
        medians = [
            (f"{name} [{row['unit']}]", *(_median(one["measures"][name]) for one in models))
            for name, row in models[0]["measures"].items()
        ]
        lines += ["", *_indented(("median (95 % stay below)", *(one["profile"][-20:] for one in models)), medians)]
        for one in models:
            if held := one.get("bands"):
                share = "-" if held["coverage_90"] is None else f"{100.0 * held['coverage_90']:.0f} %"
                lines.append(f"bands of 90 % of {one['profile']} hold {share} of {held['windows']} windows")
        for one in found["comparisons"]:
            lines.append(_compared(one, found["drawn_anew"]))
        first = models[0]
        lines += ["", f"where the error of {first['profile']} lives: mean cVDM [%] (windows)"]
        for row in first["where"][:SHOWN]:
            lines.append(f"  {row['words']}, explains {100.0 * row['explained']:.0f} %")
            lines += c.filled([_bin(one, row["unit"]) for one in row["bins"]], "    ")
        r_max = found["r_max"]
        if r_max["rad_per_s"] is not None:
            lines += ["", f"cVDM is relative to {r_max['rad_per_s'] / DEG:.3g} deg/s, {r_max['from']}."]
    lines.append(_left_out(found))
    if result.interrupted:
        done = sum(log["complete"] for log in found["logs"])
        lines.append(f"Stopped after {done} of {found['n_logs']} voyages; everything is of the windows scored by then.")
    lines.append(f"{counted(found['n_windows'], 'window')} of {found['window_s']:g} s in {found['wall_s']:.1f} s.")
    lines.append(f"Report: {folder}/report.html" if report else f"Results: {folder}")
    return "\n".join(lines)


def _indented(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    return [f"  {line}" for line in c.table(head, rows, less=2)]


def _median(row: dict[str, Any]) -> str:
    return f"{_number(row['median'])} ({_number(row['q95'])})"


def _number(value: float | None) -> str:
    return "diverged" if value is None else f"{value:.3g}"


def _bin(one: dict[str, Any], unit: str) -> str:
    mean = "-" if one["cVDM_mean"] is None else f"{one['cVDM_mean']:.3g}"
    return f"{in_words(one, unit)}: {mean} ({one['windows']})"


def in_words(one: dict[str, Any], unit: str) -> str:
    """A bin by its ends, in the unit that people read."""
    if one["name"]:
        return str(one["name"])
    shown, factor = shown_in(unit)
    low, high = (None if one[end] is None else f"{one[end] * factor:.3g}" for end in ("low", "high"))
    if low is None:
        return f"below {high} {shown}"
    return f"from {low} {shown}" if high is None else f"{low} to {high} {shown}"


def _compared(one: dict[str, Any], anew: str) -> str:
    share = "-" if one["share_second_better"] is None else f"{100.0 * one['share_second_better']:.0f} %"
    said = f"{one['second']} is better than {one['first']} in {share} of the windows"
    if one["cVDM_difference"] is not None:
        said += f"; cVDM differs by {one['cVDM_difference']:+.3g} % on average"
    if one["cVDM_difference_ci95"]:
        low, high = one["cVDM_difference_ci95"]
        said += f" ({low:+.3g} to {high:+.3g}, {anew} drawn anew)"
    return said + "."


def _left_out(found: dict[str, Any]) -> str:
    from ..trial.voyages.windows import Unused

    rows = sum(log["rows_read"] for log in found["logs"])
    left: dict[str, int] = {}
    for log in found["logs"]:
        for reason, count in log["rows_left_out"].items():
            left[reason] = left.get(reason, 0) + count
    resting = sum(log["windows_at_rest"] for log in found["logs"])
    parts = [
        f"{count} in pieces {reason}" if reason == Unused.TOO_SHORT else f"{count} with {reason}"
        for reason, count in left.items()
        if count
    ]
    said = f"Left out of {rows} rows: {', '.join(parts)}" if parts else f"Every one of {rows} rows is in a window"
    return said + (f"; {resting} windows with the ship at rest" if resting else "") + "."
