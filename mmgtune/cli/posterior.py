"""``mmgtune posterior``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..options import PosteriorOptions
from ..phrases import counted
from . import common as c
from .options import RunOptions, takes
from .progress import Progress

if TYPE_CHECKING:
    from pathlib import Path

    from ..posterior import Posterior


@takes(options=PosteriorOptions, run=RunOptions)
def command(
    profile: c.Profile = c.DEFAULT,
    trials: c.Trials = c.DEFAULT,
    *,
    options: PosteriorOptions,
    run: RunOptions,
) -> None:
    """Draw ships that the trials leave possible, the form of the model not taken as right: bands for predictions.

    The folder may be that of the fit whose profile is given; particles lie beside its results then.

    Examples:

      mmgtune posterior -p my_ship.toml -t my_trials/ --out runs/bands

      mmgtune posterior -p runs/today/profile.toml --out runs/today
    """
    from ..files import refuse_existing
    from ..posterior import plan_posterior, posterior, write_posterior
    from ..posterior.folder import FILES
    from ..run_folders import claimed

    ship, data = c.load(profile, trials)
    folder = run.out or c.default_out(ship)
    if run.dry_run:
        c.print_plan(plan_posterior(ship, data, options), folder, run.json)
        return
    refuse_existing([folder / name for name in FILES], run.force or run.resume)
    with claimed(folder, resume=True), Progress(run.quiet, folder) as progress:
        result = posterior(
            ship, data, options, hooks=progress.hooks(), folder=folder, resume=run.resume, command=c.command_line()
        )
        document = write_posterior(result, folder, overwrite=True)
        progress.saved(result.interrupted)
    if run.json:
        c.print_json(document)
    else:
        c.show(summary(result, folder))
    progress.leave()


def summary(result: Posterior, folder: Path) -> str:
    """What a person wants to read in a terminal."""
    lines = [*result.sentences(), *(f"Note: {warning}" for warning in result.warnings)]
    return "\n".join([*lines, f"{counted(len(result.particles), 'particle')}: {folder}/particles.parquet"])
