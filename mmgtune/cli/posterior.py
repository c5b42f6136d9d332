"""``mmgtune posterior``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ..options import PosteriorOptions
from ..phrases import counted
from . import common as c
from .options import takes

if TYPE_CHECKING:
    from pathlib import Path

    from ..posterior import Posterior


@takes(options=PosteriorOptions)
def command(
    profile: c.Profile = "suzaku",
    trials: c.Trials = "suzaku",
    *,
    options: PosteriorOptions,
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", help="Folder for the particles. Default: runs/TIME-PROFILE.", rich_help_panel=c.OUTPUT
        ),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace particles in the folder.", rich_help_panel=c.OUTPUT)
    ] = False,
    json: c.Json = False,
) -> None:
    """Draw ships that the trials leave possible, the form of the model not taken as right: bands for predictions.

    Examples:

      mmgtune posterior -p my_ship.toml -t my_trials/ --out runs/bands

      mmgtune posterior -p runs/today/profile.toml --out runs/today
    """
    from pathlib import Path

    from ..files import alone_in, make_folder, refuse_existing
    from ..posterior import posterior, write_posterior
    from ..posterior.folder import FILES

    ship, data = c.load(profile, trials)
    folder = Path(out) if out else c.default_out(ship)
    refuse_existing([folder / name for name in FILES], force)
    make_folder(folder)
    with alone_in(folder):
        result = posterior(ship, data, options, command=c.command_line())
        document = write_posterior(result, folder, overwrite=force)
    if json:
        c.print_json(document)
    else:
        c.show(summary(result, folder))


def summary(result: Posterior, folder: Path) -> str:
    """What a person wants to read in a terminal."""
    lines = [*result.sentences(), *(f"Note: {warning}" for warning in result.warnings())]
    return "\n".join([*lines, f"{counted(len(result.particles), 'particle')}: {folder}/particles.parquet"])
