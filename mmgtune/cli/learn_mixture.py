"""``mmgtune learn mixture``: a hybrid and recurrent networks put together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..options import Options, again
from ..options.learning import MixtureOptions
from . import common as c
from . import completing
from .options import RunOptions, takes

if TYPE_CHECKING:
    from ..learning import LearnedMixture


@dataclass(frozen=True)
class MixtureRunOptions(Options):
    """What is left behind."""

    out: Path | None = again(RunOptions, "out", but="Default: runs/TIME-SHIP.")
    force: bool = again(RunOptions, "force")


@takes(options=MixtureOptions, run=MixtureRunOptions)
def command(
    model: Annotated[
        str,
        typer.Argument(
            metavar="MODEL",
            help="Profile, or model.safetensors of learn hybrid.",
            autocompletion=completing.models,
        ),
    ],
    names: Annotated[
        list[str],
        typer.Argument(
            metavar="NETWORK... [TRIALS]",
            help="model.safetensors of learn rnn, same ship, one or several of one step; then, if any, trials that no "
            "part has seen: those that tune choose the share.",
            autocompletion=completing.models_and_trials,
        ),
    ],
    *,
    options: MixtureOptions,
    run: MixtureRunOptions,
    json: c.Json = False,
    no_report: c.NoReport = False,
) -> None:
    """Let a model of forces and recurrent networks drive one ship together.

    Her accelerations are a weighted mean of theirs. Both err, but differently, so that together they often err less
    than either. Several trainings of one step may be given, with other types, memories or runs to learn from: all their
    networks count alike. The share is tried on trials that no part was trained on, and what does best is written as one
    file, model.safetensors, that simulate and validate take in place of a profile; where no mixture does better, that
    is the hybrid or the best of the trainings alone. Without trials one share must be given. Needs no JAX.

    Examples:

      mmgtune learn mixture esso_osaka_3m_tuned runs/type1/model.safetensors unseen --out runs/mixture

      mmgtune learn mixture esso_osaka_3m_hybrid runs/type1/model.safetensors --share 0.35

      mmgtune learn mixture esso_osaka_3m_hybrid runs/type1 runs/type2 --share 0.35 --out runs/mixture
    """
    from ..comparing_models import write_model_comparison
    from ..learning import compare_parts, learn_mixture, write_learned
    from ..networks import named_ship
    from ..networks.naming import file_of
    from ..report import render
    from ..run_folders import claimed

    # What stands last is trials unless it is a trained model; what stands first after the model never is.
    trials = names[-1] if names[1:] and file_of(names[-1]) is None else None
    networks = names if trials is None else names[:-1]
    given = named_ship(model)
    folder = run.out or c.default_out(given)
    with claimed(folder, force=run.force, anew=True, reads=(model, *names)):
        result = learn_mixture(given, networks, trials, options, command=c.command_line())
        document = write_learned(result, folder, overwrite=True)
        if trials is not None and not no_report:
            compared = compare_parts(result, trials)
            write_model_comparison(compared, folder, c.command_line(), result.notes, overwrite=True)
            render(folder)
    if json:
        c.print_json(document)
    else:
        c.show(summary(result, document, report=trials is not None and not no_report))


def summary(result: LearnedMixture, document: Mapping[str, Any], *, report: bool) -> str:
    """Plain-text summary of the result."""
    lines = []
    if document["tried"]:
        kinds = list(document["tried"][0]["L_MSE"])
        several = any("network" in row for row in document["tried"])
        wide = 20 if several else 8
        lines.append(f"{'share':<{wide}}{'error':>10}" + "".join(f"{kind or 'not stated':>12}" for kind in kinds))
        for row in document["tried"]:
            errors = ["diverged" if row["L_MSE"][kind] is None else f"{row['L_MSE'][kind]:.4g}" for kind in kinds]
            total = "diverged" if row["score"] is None else f"{100 * row['score']:.1f} %"
            kept = (row["share"], row.get("network")) == (document["share"], document["network"])
            chosen = " *" if kept else ""
            share = f"{row['share']:g}" + (f", networks {row['network']}" if "network" in row else "")
            lines.append(f"{share:<{wide}}{total:>10}" + "".join(f"{one:>12}" for one in errors) + chosen)
        lines += ["error: mean over kinds of manoeuvre of L_MSE over that of the model of forces; * kept", ""]
    lines += [text for note in (*result.warnings, *result.notes) for text in (note, "")]
    lines.append(repr(result.model))
    if report:
        lines.append(f"Report: {document['out']}/report.html")
    lines.append(f"Model: {document['out']}/model.safetensors.")
    return "\n".join(lines)
