"""``mmgtune sweep``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..options import SweepOptions, in_flags
from . import common as c
from .options import RunOptions, takes
from .progress import Progress

if TYPE_CHECKING:
    from ..fitting import SweepResult


@takes(options=SweepOptions, run=RunOptions)
def command(
    profile: c.Profile = c.DEFAULT,
    trials: c.Trials = c.DEFAULT,
    *,
    options: SweepOptions,
    run: RunOptions,
    no_report: c.NoReport = False,
) -> None:
    """Fit at several widths of the box, recommend one, and say where over-fitting begins.

    Examples:

      mmgtune sweep --ar 0.2,0.3,0.4,0.5,0.6

      mmgtune sweep --method least-squares --out runs/sweep
    """
    from ..fitting import plan_sweep, sweep
    from ..report import render
    from ..run_folders import claimed

    ship, data = c.load(profile, trials)
    if (asked := c.planned(run, ship, lambda: plan_sweep(ship, data, options))) is None:
        return
    folder, _ = asked
    with (
        claimed(folder, force=run.force, resume=run.resume, anew=True, reads=(profile, trials)),
        Progress(run.quiet, folder) as progress,
    ):
        result = sweep(
            ship, data, options, hooks=progress.hooks(), folder=folder, resume=run.resume, command=c.command_line()
        )
        progress.saved(result.interrupted)
        if not no_report:
            render(folder)
    if run.json:
        c.print_json({**result.to_dict(), "out": str(folder)})
    else:
        c.show(summary(result, str(folder), report=not no_report))
    progress.leave()


def off(result: SweepResult, role: str, of: str) -> list[str]:
    """How far off "track" [m] or "heading" [deg] the trials of a role are with every width; "" where not known."""
    from ..fitting.comparison import mean_off, rounded

    sizes = [mean_off(held, "after") if (held := result.compared(i, role)) else {} for i in range(len(result.runs))]
    return [rounded(size[of], 3 if of == "track" else 2) if of in size else "" for size in sizes]


def summary(result: SweepResult, folder: str, report: bool) -> str:
    """The paper's Table 7 for this data, how far off trials are and J on both sets, and the recommendation."""
    names = list(result.runs[0].theta)
    digits = 4 if c.width() >= 30 + 11 * len(result.runs) else 3

    def line(label: str, values: Sequence[float], marks: Sequence[str] = ()) -> tuple[str, ...]:
        marked = marks or [""] * len(values)
        return (label, *(f"{value:.{digits}g}{mark:1}" for value, mark in zip(values, marked, strict=True)))

    rows = [
        line(
            name, [run.theta[name] for run in result.runs], ["*" if name in run.at_bound else "" for run in result.runs]
        )
        for name in names
    ]
    rows.append(("",) * (1 + len(result.runs)))
    for role in ("test", "left-out", "tune"):
        for of, unit in (("track", "m"), ("heading", "deg")):
            sizes = off(result, role, of)
            if any(sizes):
                rows.append((f"off {of} {role} [{unit}]", *(f"{size} " for size in sizes)))
    rows.append(("",) * (1 + len(result.runs)))
    before = {}
    for label, role in (("J tune", "tune"), ("J test", "test")):
        first = result.runs[0].J_of(role, "before")
        if first is not None:
            before[label] = f"{label[2:]} {first:.4g}"
            rows.append(line(label, [run.J_of(role, "after") or float("nan") for run in result.runs]))
    if result.leave_one_out is not None:
        rows.append(line("J left out", result.leave_one_out))
    head, *rest = c.table(line("a_r", result.widths), rows)
    lines = [head, "", *rest]
    if before:
        lines.append(f"J before, {result.runs[0].method}: {', '.join(before.values())}")
    lines += ["", "* on a bound", ""]
    lines += [f"Note: {in_flags(warning)}" for warning in result.warnings]
    lines += [result.recommended()["sentence"], result.overfitting()["sentence"]]
    lines.append(
        f"{'Interrupted after' if result.interrupted else 'Finished in'} {result.wall_s:.1f} s. "
        + (f"Report: {folder}/report.html" if report else f"Results: {folder}")
    )
    return "\n".join(lines)
