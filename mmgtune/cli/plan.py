"""``mmgtune plan``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import typer

from ..errors import OptionError, Problem
from ..options import PlanOptions
from . import common as c
from .compare import FolderOptions
from .options import takes
from .predict import decimals_of


@takes(options=PlanOptions, run=FolderOptions)
def command(
    model: Annotated[str, typer.Argument(help="Particles of posterior: a run folder or its particles.parquet.")],
    question: Annotated[
        str | None,
        typer.Option(
            "--question",
            "-q",
            help='Index and manoeuvre: "tactical diameter, turn -35", "1st overshoot, zigzag 10/10".',
            rich_help_panel=c.INPUT,
            show_default=False,
        ),
    ] = None,
    *,
    options: PlanOptions,
    run: FolderOptions,
    json: c.Json = False,
) -> None:
    """Which trial to sail next: by how much each would shrink the band of a question, best first.

    Turns of 10, 20 and 35 deg and zigzags 10/10 and 20/20 to both sides, at full and half speed, spirals, a crash stop
    where the propeller's equations reach astern, a straight run and orders of changing size. Nothing is sailed: each
    trial is simulated, and its information added to what the particles know.

    Examples:

      mmgtune plan runs/bands --question "tactical diameter, turn -35"

      mmgtune plan runs/bands --question "1st overshoot, zigzag 20/20" --kind turn --kind zigzag --out runs/plan
    """
    from ..planning import plan_trial, write_plan
    from ..planning.question import SUCH_AS

    if question is None:
        why = "a trial is worth as much as it tells of the number that is wanted"
        raise OptionError(Problem("no question is asked", "question", why, f"add --question; {SUCH_AS}"))
    if run.out is None:
        document = plan_trial(model, question, options).to_dict(c.command_line())
    else:
        from ..report import render
        from ..run_folders import claimed

        with claimed(run.out, force=run.force):
            document = write_plan(plan_trial(model, question, options), run.out, c.command_line(), overwrite=True)
            render(run.out)
    if json:
        c.print_json(document)
        return
    c.show(summary(document))
    for note in document["notes"]:
        c.say(f"note: {note}")
    if run.out is not None:
        c.show(f"Report: {run.out}/report.html")


def summary(document: Mapping[str, Any]) -> str:
    """The trials as a person wants to read them in a terminal."""
    asked = document["question"]
    unit = "" if asked["unit"] == "-" else f" {asked['unit']}"
    halves = [one["half_width_after"] for one in document["trials"]]
    decimals = decimals_of(min(halves))
    level = document["options"]["level"]
    now = f"{asked['mean']:.{decimals}f} ± {asked['half_width']:.{decimals}f}{unit}"
    lines = [
        f"{asked['words']}, {asked['order']}: {now} (half the band of {level:g} %)",
        "",
    ]
    rows = []
    for one in document["trials"]:
        after = f"± {one['half_width_after']:.{decimals}f}{unit}"
        rows.append((one["trial"], after, f"{100.0 * one['shrinks']:.0f} %", f"{one['duration_s']:.0f} s"))
    table = c.table(("trial", "after it", "shrinks by", "takes"), rows, less=2, spare=(3,))
    lines += [f"  {line}" for line in table]
    lines += [f"  left out: {one}" for one in document["left_out"]]
    return "\n".join(lines)
