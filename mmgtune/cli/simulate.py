"""``mmgtune simulate``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..options import SimulateOptions
from ..phrases import listed
from . import common as c
from .exitcodes import ExitCode
from .options import takes
from .predict import banded

if TYPE_CHECKING:
    from ..simulating import Simulated


@takes(options=SimulateOptions)
def command(
    profile: c.Profile = c.DEFAULT,
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
    """Simulate turning circles, zigzags, a crash stop or whole trials; print their indices and the IMO criteria.

    Examples:

      mmgtune simulate --turn 35 --turn -35 --zigzag 10/10

      mmgtune simulate -p esso_osaka --stop --astern 50

      mmgtune simulate -p kvlcc2 --turn 35 --speed "15.5 kn" --json

      mmgtune simulate --trials suzaku --out simulated --forces
    """
    from ..predicting import with_bands
    from ..recording import write_simulation
    from ..report import render
    from ..simulating import simulate

    reads = (profile, trials)
    with c.placed(out, force=force, anew=True, reads=reads, forces=forces, no_report=no_report):
        result = with_bands(simulate(profile, trials, options))
        files: list[Path] = []
        if out is not None:
            files = result.write(out, with_forces=forces, overwrite=force)
            write_simulation(result, out, c.command_line(), overwrite=True)
            files += [] if no_report else render(out)[:1]
    notes = list(result.notes)
    if result.bands is not None:
        notes.append(f"±: half the band of {result.bands['level']:g} % of {result.bands['particles']} particles")
    lost = list(dict.fromkeys(motion.id for motion in result.motions if motion.diverged))
    if lost:
        notes.append(f"{listed(lost)} diverged: the ship spins, or is faster than any; none of it is judged or written")
    if json:
        c.print_json({**result.to_dict(), "notes": notes, "files": [str(f) for f in files]})
    else:
        _show(result, notes, files)
    if lost:
        raise typer.Exit(ExitCode.NO)


def _show(result: Simulated, notes: list[str], files: list[Path]) -> None:
    """The same for people."""
    from ..report import measures

    rows = result.rows()
    for row in rows:
        c.show(_text(row))
    for name, words in measures.about(list(dict.fromkeys(name for row in rows for name in row["measures"] or ()))):
        c.say(f"{name}: {words}")
    for note in notes:
        c.say(f"note: {note}")
    c.say_doubts(result.ship.doubts() if result.ship else ())
    for file in files:
        c.say(f"wrote {file}")


def _text(result: dict[str, Any]) -> str:
    """Plain-text summary of a run: what the report's tables hold, in their words and units."""
    from ..report import measures
    from ..report.wording import run_words

    words = run_words(result["id"])
    order = "" if words == result["id"] else f"{words}, "
    lost = "" if result["status"] == "ok" else f", {result['status']}"
    lines = [f"{result['id']}  ({order}{result['duration_s']:.0f} s, {result['integrator']}{lost})"]
    rows = _indices(result)
    if rows:
        lines += c.table(("",) * len(rows[0]), rows, less=2, spare=(4, 2))[1:]
    for name, value in (result["measures"] or {}).items():
        lines.append(f"{measures.with_unit(name):<9} {value:.4g}")
    for criterion in result["criteria"]:
        passed = criterion["passed"]
        word = "not applicable: " + criterion["reason"] if passed is None else "pass" if passed else "FAIL"
        value = "-" if criterion["value"] is None else f"{criterion['value']:.3g}"
        lines.append(f"IMO {criterion['name']}: {value} (limit {criterion['limit']:.3g} {criterion['unit']}) {word}")
    return "\n  ".join(lines)


def _indices(result: dict[str, Any]) -> list[tuple[str, ...]]:
    """Cells: an index, its value, the same in ship lengths, what was measured, the same in ship lengths, the band."""
    from ..manoeuvres.named import in_order
    from ..report.wording import index_words, is_index, number

    def lengths(of: dict[str, Any], name: str) -> str:
        value = number(of.get(f"{name.removesuffix('_m')}_over_L"))
        return "" if value is None else f"{value:.4g} L"

    measured, bands = result["measured"] or {}, result.get("bands", {})
    found: list[tuple[str, ...]] = []
    for name in filter(is_index, in_order(result["indices"])):
        value, true = number(result["indices"][name]), number(measured.get(name))
        words, unit = index_words(name)
        if value is not None:
            beside = "" if true is None else f"measured {true:>6.4g} {unit:<5}"
            over = lengths(measured, name) if beside else ""
            one = (f"{value:.4g} {unit:<5}", lengths(result["indices"], name), beside, over, _band(bands.get(name)))
            found.append((words, *one))
    return found


def _band(row: dict[str, Any] | None) -> str:
    """The band of an index, also in ship lengths where it has one; nothing where there is none."""
    if row is None:
        return ""
    over = f", {banded(row['over_L'], 'L')}" if row["over_L"] else ""
    return f"{banded(row, row['unit'])}{over}"
