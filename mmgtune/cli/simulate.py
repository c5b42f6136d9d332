"""``mmgtune simulate``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from ..errors import OptionError, Problem
from ..options import SimulateOptions
from . import common as c
from .options import takes


@takes(options=SimulateOptions)
def command(
    profile: c.Profile = "suzaku",
    trials: Annotated[
        str | None,
        typer.Option(
            "--trials", "-t", help="Simulate these trials with their own inputs instead.", rich_help_panel=c.INPUT
        ),
    ] = None,
    *,
    options: SimulateOptions,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Folder to write the simulated runs to, as trial files.", rich_help_panel=c.OUTPUT
        ),
    ] = None,
    forces: Annotated[
        bool,
        typer.Option(
            "--forces",
            help="Add forces and intermediates (hull_X, w_P, J, u_R, F_N, ...) to the files.",
            rich_help_panel=c.OUTPUT,
        ),
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Replace the files in --out.", rich_help_panel=c.OUTPUT)
    ] = False,
    json: c.Json = False,
) -> None:
    """Simulate turning circles, zigzags or whole trials; print their indices and the IMO criteria.

    Examples:

      mmgtune simulate --turn 35 --turn -35 --zigzag 10/10

      mmgtune simulate -p kvlcc2 --turn 35 --speed "15.5 kn" --json

      mmgtune simulate --trials suzaku --out simulated --forces
    """
    from ..files import refuse_existing
    from ..simulating import files_of, simulate

    if forces and out is None:
        raise OptionError(Problem("forces need a folder to write to", "forces", fix="add out=FOLDER"))
    if out is not None and not force:
        refuse_existing(files_of(out, trials, options))
    result = simulate(profile, trials, options)
    files = result.write(out, with_forces=forces, overwrite=force) if out is not None else []
    if json:
        c.print_json({**result.to_dict(), "files": [str(f) for f in files]})
        return
    for row in result.rows():
        c.show(_text(row))
    for note in result.notes:
        c.say(f"note: {note}")
    c.say_doubts(result.ship.doubts() if result.ship else ())
    for file in files:
        c.say(f"wrote {file}")


def _text(result: dict[str, Any]) -> str:
    from ..measures import UNITS

    lines = [f"{result['id']}  ({result['status']}, {result['duration_s']:.0f} s, {result['integrator']})"]
    measured = result["measured"] or {}
    for name, value in result["indices"].items():
        if value is not None and value != []:
            beside = f"   measured {_value(measured[name])}" if measured.get(name) is not None else ""
            lines.append(f"  {name:<34}{_value(value)}{beside}")
    for name, value in (result["measures"] or {}).items():
        lines.append(f"  {name:<34}{value:.4g} {UNITS[name]}")
    for criterion in result["criteria"]:
        passed = criterion["passed"]
        word = "not applicable: " + criterion["reason"] if passed is None else "pass" if passed else "FAIL"
        value = "-" if criterion["value"] is None else f"{criterion['value']:.3g}"
        lines.append(f"  IMO {criterion['name']}: {value} (limit {criterion['limit']:.3g} {criterion['unit']}) {word}")
    return "\n".join(lines)


def _value(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    return ", ".join(_value(v) for v in value) if isinstance(value, (list, tuple)) else str(value)
