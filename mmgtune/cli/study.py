"""``mmgtune study``: controllers judged in simulation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import typer

from ..options import HeadingOptions
from . import common as c
from . import completing
from .compare import FolderOptions
from .options import App, takes

app = App(help="Judge controllers in simulation, and the simulators by what is true.")


@app.callback()
def _several() -> None:
    pass


@app.command("heading-keeping")
@takes(options=HeadingOptions, run=FolderOptions)
def heading_keeping(
    models: Annotated[
        list[str],
        typer.Argument(
            metavar="MODEL...",
            help="Profiles and model.safetensors files: the simulators.",
            autocompletion=completing.models,
        ),
    ],
    truth: Annotated[
        str, typer.Option("--truth", "-p", help="Profile of the true system.", autocompletion=completing.profiles)
    ],
    *,
    options: HeadingOptions,
    run: FolderOptions,
    json: c.Json = False,
) -> None:
    """Judge the gains of a heading controller in simulators, and how often these promise more than is true.

    The rudders follow -K_P (heading error) - K_D (yaw rate), in deg per rad and per rad/s, through the actuators of the
    true system, in calm air. A pair of gains is judged by the integral of the absolute errors of heading and yaw rate.
    A simulator with several members is read in three ways: one of them, their mean, and the worst. With --out the
    record and a report with maps of the gains are written. Needs no JAX.

    Examples:

      mmgtune study heading-keeping runs/ensemble/model.safetensors --truth vectwin_3m --out runs/gains
    """
    from ..heading_keeping import study_heading_keeping, write_heading_study
    from ..report import render
    from ..run_folders import claimed

    if run.out is None:
        document = study_heading_keeping(models, truth, options).to_dict(c.command_line())
    else:
        with claimed(run.out, force=run.force):
            result = study_heading_keeping(models, truth, options)
            document = write_heading_study(result, run.out, c.command_line(), overwrite=True)
            render(run.out)
    if json:
        c.print_json(document)
    else:
        c.show(summary(document))


def summary(document: Mapping[str, Any]) -> str:
    """Plain-text summary of the result."""
    from ..heading_keeping import shares_of

    n = len(document["gains"])
    lines = [f"{n} x {n} gains in {document['truth']['name']}, and share of them at which a simulator promises more"]
    lines.append(f"{'':<44}{'more':>8}{'by 5 %':>9}")
    for model in document["models"]:
        lines.append(f"{model['name']}, {model['members']} members" if model["members"] > 1 else model["name"])
        lines += [
            f"  {words:<42}{100 * share:>6.1f} %{100 * clear:>7.1f} %" for words, share, clear in shares_of(model)
        ]
    lines += ["", f"{document['wall_s']:.1f} s."]
    if "out" in document:
        lines[-1] += f" Report: {document['out']}/report.html"
    return "\n".join(lines)
