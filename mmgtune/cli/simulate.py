"""``mmgtune simulate``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import OptionError, Problem
from ..options import PredictOptions, SimulateOptions
from . import common as c
from .banded import bands_on
from .options import takes
from .predict import banded

if TYPE_CHECKING:
    from ..predictor import Uncertain


@takes(options=SimulateOptions)
def command(
    profile: c.Profile = "suzaku",
    trials: c.TheirOwnInputs = None,
    *,
    options: SimulateOptions,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Folder for the simulated runs, as trial files, and a report.", rich_help_panel=c.OUTPUT
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
    no_report: c.NoReport = False,
) -> None:
    """Simulate turning circles, zigzags or whole trials; print their indices and the IMO criteria.

    Examples:

      mmgtune simulate --turn 35 --turn -35 --zigzag 10/10

      mmgtune simulate -p kvlcc2 --turn 35 --speed "15.5 kn" --json

      mmgtune simulate --trials suzaku --out simulated --forces
    """
    from ..files import refuse_existing
    from ..predictor import Uncertain
    from ..recording import write_simulation
    from ..report import render
    from ..simulating import files_of, simulate

    if forces and out is None:
        raise OptionError(Problem("forces need a folder to write to", "forces", fix="add out=FOLDER"))
    if out is not None and not force:
        refuse_existing(files_of(out, trials, options))
    result = simulate(profile, trials, options)
    rows = result.rows()
    notes = list(result.notes)
    if trials is None and isinstance(result.predictor, Uncertain):
        notes += _add_bands(rows, result.predictor, options)
    files = result.write(out, with_forces=forces, overwrite=force) if out is not None else []
    if out is not None and not no_report:
        write_simulation(result, rows, out, c.command_line())
        files.append(render(out)[0])
    if json:
        c.print_json({**result.to_dict(), "runs": rows, "notes": notes, "files": [str(f) for f in files]})
        return
    for row in rows:
        c.show(_text(row))
    for note in notes:
        c.say(f"note: {note}")
    c.say_doubts(result.ship.doubts() if result.ship else ())
    for file in files:
        c.say(f"wrote {file}")


def _add_bands(rows: list[dict[str, Any]], ship: Uncertain, options: SimulateOptions) -> list[str]:
    """Give each run ``bands``: rows by index, as ``predict`` has them.  Returns notes."""
    turn = options.turn or (() if options.zigzag else ("35", "-35"))
    found, notes = bands_on(ship, PredictOptions(**{**options.shared_with(PredictOptions), "turn": turn}))
    if found is None:
        return notes
    by_id = {run["id"]: {one["index"]: one for one in run["indices"]} for run in found["runs"]}
    for row in rows:
        row["bands"] = by_id[row["id"]]
    return [f"±: half the band of {found['level']:g} % of {found['particles']} particles", *notes]


def _text(result: dict[str, Any]) -> str:
    from ..measures import UNITS

    lines = [f"{result['id']}  ({result['status']}, {result['duration_s']:.0f} s, {result['integrator']})"]
    measured, bands = result["measured"] or {}, result.get("bands", {})
    for name, value in result["indices"].items():
        if value is not None and value != []:
            beside = f"   measured {_value(measured[name])}" if measured.get(name) is not None else ""
            lines.append(f"  {name:<34}{_value(value)}{beside}{_band(bands, name)}")
    for name, value in (result["measures"] or {}).items():
        lines.append(f"  {name:<34}{value:.4g} {UNITS[name]}")
    for criterion in result["criteria"]:
        passed = criterion["passed"]
        word = "not applicable: " + criterion["reason"] if passed is None else "pass" if passed else "FAIL"
        value = "-" if criterion["value"] is None else f"{criterion['value']:.3g}"
        lines.append(f"  IMO {criterion['name']}: {value} (limit {criterion['limit']:.3g} {criterion['unit']}) {word}")
    return "\n".join(lines)


def _band(bands: dict[str, Any], name: str) -> str:
    """The band as it stands beside the value of an index, nothing where there is none."""
    length = name.removesuffix("_over_L")
    if name in bands:
        return f"   {banded(bands[name], bands[name]['unit'])}"
    if length != name and f"{length}_m" in bands:
        return f"   {banded(bands[f'{length}_m']['over_L'], 'L')}"
    return ""


def _value(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    return ", ".join(_value(v) for v in value) if isinstance(value, (list, tuple)) else str(value)
