"""``mmgtune simulate``."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import OptionError, Problem
from . import common as c

if TYPE_CHECKING:
    from ..evaluation import TrialRecord
    from ..orders import Helmsman
    from ..profile import ShipProfile
    from ..simulation import Motion

MANOEUVRE = "Manoeuvre"

ORDERED = "rk4"
"""How manoeuvres given as orders are simulated, at steps of their own."""


def command(
    profile: c.Profile = "suzaku",
    turn: Annotated[
        list[float] | None,
        typer.Option(
            "--turn",
            help="Turning circle at this rudder angle (deg), starboard positive; repeatable.",
            rich_help_panel=MANOEUVRE,
        ),
    ] = None,
    zigzag: Annotated[
        list[str] | None,
        typer.Option(
            "--zigzag",
            help="Zigzag RUDDER/HEADING (deg), such as 20/20 or -10/10; repeatable.",
            rich_help_panel=MANOEUVRE,
        ),
    ] = None,
    speed: Annotated[
        str | None,
        typer.Option(
            "--speed", help='Approach speed, such as "12 kn". Default: the profile\'s.', rich_help_panel=MANOEUVRE
        ),
    ] = None,
    rpm: Annotated[
        float | None,
        typer.Option("--rpm", help="Propeller revolutions (1/min). Default: the profile's.", rich_help_panel=MANOEUVRE),
    ] = None,
    trials: Annotated[
        str | None,
        typer.Option(
            "--trials", "-t", help="Simulate these trials with their own inputs instead.", rich_help_panel=c.INPUT
        ),
    ] = None,
    integrator: c.IntegratorName = "rk4",
    substeps: c.Substeps = 1,
    backend: c.BackendName = "compiled",
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
    force: c.Force = False,
    json: c.Json = False,
) -> None:
    """Simulate turning circles, zigzags or whole trials; print their indices and the IMO criteria.

    Examples:

      mmgtune simulate --turn 35 --turn -35 --zigzag 10/10

      mmgtune simulate -p kvlcc2 --turn 35 --speed "15.5 kn" --json

      mmgtune simulate --trials suzaku --out simulated --forces
    """
    from ..profile import load_profile

    if forces and out is None:
        raise OptionError(Problem("--forces needs a folder to write to", "--forces", fix="add --out FOLDER"))
    ship = load_profile(profile)
    if trials is not None:
        if turn or zigzag or speed or rpm:
            raise OptionError(
                Problem("--trials has its own inputs", "--trials", fix="leave out --turn, --zigzag, --speed and --rpm")
            )
        runs, records = _on_trials(ship, trials, integrator, substeps, backend)
    else:
        runs, records = _on_orders(ship, turn or ([] if zigzag else [35.0, -35.0]), zigzag or [], speed, rpm), {}
    results = [_described(ship, motion, records.get(motion.id)) for motion in runs]
    files = _write(ship, runs, out, forces, force) if out is not None else []
    if json:
        c.print_json(
            {"schema": 1, "profile": ship.id, "sha256": ship.sha256, "runs": results, "files": [str(f) for f in files]}
        )
        return
    for result in results:
        print(_text(result))
    for file in files:
        c.say(f"wrote {file}")


def _on_orders(
    ship: ShipProfile, turns: list[float], zigzags: list[str], speed: str | None, rpm: float | None
) -> list[Motion]:
    from ..orders import TurningOrder, ZigzagOrder, run_manoeuvre

    U = _speed(speed)
    n = rpm / 60.0 if rpm is not None else None
    orders: list[tuple[str, Helmsman]] = []
    for angle in turns:
        if not 0.0 < abs(angle) <= 90.0:
            raise OptionError(
                Problem(f"rudder angle {angle:g} deg", "--turn", fix="give an angle between -90 and 90 deg, not 0")
            )
        orders.append((f"turn_{_signed(angle)}", TurningOrder(math.radians(angle))))
    for text in zigzags:
        rudder, heading = _angles(text)
        orders.append(
            (f"zigzag_{_signed(rudder)}_{heading:g}", ZigzagOrder(math.radians(rudder), math.radians(heading)))
        )
    L, V = ship.L_pp, U or (ship.approach.speed if ship.approach else 1.0)
    # Models are quicker than ships: sample ten times per ship length travelled, once a second at most.
    sample = min(1.0, round(L / V / 10.0, 1) or 0.1)
    longest = max(600.0, 150.0 * L / V)
    return [
        run_manoeuvre(ship, helmsman, id=name, speed=U, n=n, longest=longest, sample=sample)
        for name, helmsman in orders
    ]


def _on_trials(
    ship: ShipProfile, name: str, integrator: str, substeps: int, backend: str
) -> tuple[list[Motion], dict[str, TrialRecord]]:
    from ..evaluation import evaluate
    from ..fitting import FitOptions
    from ..trial import load_trials

    options = FitOptions(integrator=integrator, substeps=substeps, backend=backend)
    trials = list(load_trials(name).trials.values())
    records = evaluate(ship, trials, integrator=options.make_integrator(), backend=backend)
    return [record.motion for record in records], {record.trial.id: record for record in records}


def _described(ship: ShipProfile, motion: Motion, record: TrialRecord | None) -> dict[str, Any]:
    from ..manoeuvres.summary import criteria_of, indices_of

    V = ship.approach.speed if ship.approach else float(motion.states[0, 3])
    track = None if motion.diverged else motion.track()
    return {
        "id": motion.id,
        "status": "diverged" if motion.diverged else "ok",
        "duration_s": float(motion.t[-1]),
        "integrator": record.method if record else ORDERED,
        "indices": record.indices if record else indices_of(track, ship.L_pp) if track else {},
        "measured": record.measured.indices if record else None,
        "measures": record.measures if record and not motion.diverged else None,
        "criteria": [criterion.to_dict() for criterion in criteria_of(track, ship.L_pp, V)] if track else [],
    }


def _write(ship: ShipProfile, runs: list[Motion], out: Path, forces: bool, replace: bool) -> list[Path]:
    from ..errors import OutputError
    from ..files import exists
    from ..simulation import as_trial
    from ..trial import write_trial

    paths = [out / f"{motion.id}.parquet" for motion in runs]
    taken = [exists(path) for path in paths if path.exists() and not replace]
    if taken:
        raise OutputError(*taken)
    for motion, path in zip(runs, paths, strict=True):
        write_trial(as_trial(ship, motion, with_forces=forces), path, overwrite=replace)
    return paths


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


def _signed(angle: float) -> str:
    return f"{'p' if angle > 0 else 'm'}{abs(angle):g}"


def _speed(text: str | None) -> float | None:
    from ..units import parse

    if text is None:
        return None
    try:
        return parse(text, "m/s")[0]
    except ValueError as error:
        raise OptionError(Problem(str(error), "--speed", fix='write --speed "12 kn" or --speed "6.2 m/s"')) from None


def _angles(text: str) -> tuple[float, float]:
    try:
        rudder, heading = (float(part) for part in text.split("/"))
        if not (0.0 < abs(rudder) <= 90.0 and 0.0 < heading <= 180.0):
            raise ValueError
    except ValueError:
        raise OptionError(
            Problem(f"'{text}' is not a zigzag", "--zigzag", fix="write RUDDER/HEADING in degrees, such as 20/20")
        ) from None
    return rudder, heading
