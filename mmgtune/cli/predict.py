"""``mmgtune predict``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import floor, log10
from typing import Annotated, Any

import typer

from ..options import PredictOptions
from . import common as c
from . import completing
from .compare import FolderOptions
from .options import takes


@takes(options=PredictOptions, run=FolderOptions)
def command(
    model: Annotated[
        str,
        typer.Argument(
            help="Profile, network, hybrid or ensemble: a file or a bundled name.", autocompletion=completing.models
        ),
    ],
    orders: Annotated[
        str | None, typer.Argument(help="CSV file: time and inputs with units in its header, a row an order.")
    ] = None,
    trials: c.TheirOwnInputs = None,
    *,
    options: PredictOptions,
    run: FolderOptions,
    keep_particles: Annotated[
        bool, typer.Option("--keep-particles", help="Write all particles to --out.", rich_help_panel=c.OUTPUT)
    ] = False,
    json: c.Json = False,
    no_report: c.NoReport = False,
) -> None:
    """Predict manoeuvres with bands: a model that knows its doubts says how sure it is.

    Without orders: turning circles with 35 deg to both sides, zigzags 10/10 and 20/20. Particles are members of a
    network of several seeds, or are drawn of an ensemble or of the coefficients of a fit; a single model has no band.
    With trials, what was measured stands beside, and scores say whether the bands held it.

    Examples:

      mmgtune predict kvlcc2_tuned --turn 35 --zigzag 20/20

      mmgtune predict runs/ensemble/model.safetensors orders.csv --speed "1.2 m/s" --rpm 400 --out runs/foretold

      mmgtune predict runs/type1/model.safetensors --trials esso --restart 100 --level 50
    """
    from ..predicting import predict, write_prediction

    if run.out is None:
        c.needs_folder(keep_particles=keep_particles, no_report=no_report)
        document = predict(model, orders, trials, options).to_dict(c.command_line())
    else:
        from ..report import render
        from ..run_folders import claimed

        with claimed(run.out, force=run.force):
            result = predict(model, orders, trials, options)
            document = write_prediction(
                result, run.out, c.command_line(), keep_particles=keep_particles, overwrite=True
            )
            if not no_report:
                render(run.out)
    if json:
        c.print_json(document)
        return
    c.show(summary(document))
    for note in document["notes"]:
        c.say(f"note: {note}")
    if run.out is not None:
        c.say(f"wrote {run.out}")


def summary(document: Mapping[str, Any]) -> str:
    """The bands as a person wants to read them in a terminal."""
    n, level = document["particles"], document["level"]
    head = f"{document['model']['name']} ({document['model']['method']})"
    lines = [f"{head}: {n} particles, ± half the band of {level:g} %" if document["has_band"] else f"{head}: one run"]
    for run in document["runs"]:
        lines += ["", *indices_text(run, n)]
        if not run["indices"] and run["diverged"] < n:
            lines.append(f"  at the end: {ended(run['end'], document['has_band'])}")
        if run["scores"]:
            lines.append(f"  {_score(run['scores'])}")
    if document["scores"] and len(document["runs"]) > 1:
        lines += ["", f"all  {_score(document['scores'])}"]
    return "\n".join(lines)


def indices_text(run: Mapping[str, Any], n: int) -> list[str]:
    """Lines of a run by n particles: what was ordered, and its indices with their bands."""
    lost = f", {run['diverged']} diverged" if run["diverged"] and n > 1 else ""
    lines = [f"{run['id']}  ({run['order']}, {run['duration_s']:.0f} s{lost})"]
    lines += ["  diverged"] if run["diverged"] == n else []
    return lines + [_index(row, n, n > 1) for row in run["indices"]]


def ended(rows: Sequence[Mapping[str, Any]], has_band: bool) -> str:
    """Where a run ends."""
    return ", ".join(f"{row['words']} {banded(row, row['unit'], has_band)}" for row in rows)


def _index(row: Mapping[str, Any], n: int, has_band: bool) -> str:
    shown = [banded(row, row["unit"], has_band)]
    if row["over_L"]:
        shown.append(banded(row["over_L"], "L", has_band))
    never = (
        "" if row["reached"] == row["particles"] else f"   {row['particles'] - row['reached']} of {n} never reach it"
    )
    measured = ""
    if row["measured"] is not None:
        beside = f" ({row['over_L']['measured']:.3g} L)" if row["over_L"] else ""
        measured = f"   measured {row['measured']:.4g}{beside}"
    first, *over = shown
    text = f"  {row['words']:<25} {first:<17}" + "".join(f" {one:<14}" for one in over or [""])
    return (text + never + measured).rstrip()


def banded(row: Mapping[str, Any], unit: str, has_band: bool = True) -> str:
    """A mean with half its band and the unit."""
    unit = "" if unit == "-" else f" {unit}"
    if row["mean"] is None:
        return "never reached"
    if not has_band:
        return f"{row['mean']:.4g}{unit}"
    if row["half_width"] is None:
        return f"{row['low']:.3g} or more{unit}" if row["low"] is not None else f"{row['mean']:.4g} ± ?{unit}"
    decimals = decimals_of(row["half_width"])
    return f"{row['mean']:.{decimals}f} ± {row['half_width']:.{decimals}f}{unit}"


def decimals_of(half: float) -> int:
    """Decimals that show two digits of half a band, 6 at most."""
    return 1 if half <= 0.0 else min(max(1 - floor(log10(half)), 0), 6)


def _score(scores: Mapping[str, Any]) -> str:
    """Scores in a line."""
    said = [
        ("L_fit", scores["L_fit"]),
        ("L_Eucl", scores["L_Eucl"]),
        ("L_Maha", scores["L_Maha"]),
        ("correlation", scores["correlation"]),
        ("CRPS", scores["CRPS"]),
        ("width", scores["sharpness"]),
    ]
    parts = [f"{name} {value:.3g}" for name, value in said if value is not None]
    for level in (50, 90):
        if scores[f"coverage_{level}"] is not None:
            parts.append(f"{level} % band holds {100.0 * scores[f'coverage_{level}']:.0f} %")
    return ", ".join(parts) or "no score: too few particles are left"
