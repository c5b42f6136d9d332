"""``mmgtune validate``."""

from __future__ import annotations

from typing import Annotated

import typer

from ..errors import OptionError, Problem
from . import common as c


def command(
    names: Annotated[
        list[str],
        typer.Argument(metavar="PROFILE... TRIALS", help="Profiles, then the trials: files, folders or bundled names."),
    ],
    window: Annotated[
        float | None,
        typer.Option(
            "--window", "--restart", help="Cut trials into windows this long (s), each begun from a measured state."
        ),
    ] = None,
    sigma_from: Annotated[
        str | None,
        typer.Option("--sigma-from", help="Trials whose spread L_MSE is counted in. Default: the trials scored."),
    ] = None,
    manoeuvres: c.Manoeuvres = False,
    integrator: c.IntegratorName = "rk4",
    substeps: c.Substeps = 1,
    backend: c.BackendName = "compiled",
    json: c.Json = False,
) -> None:
    """Score profiles on trials: J and the standardised error L_MSE, per trial and per kind of manoeuvre.

    Each trial, or window of it, is simulated from its first measured state with its measured inputs. L_MSE is the mean
    over time of the sum over all six states of squared differences over their variances (Wakita et al. 2022, eq. 26).

    Examples:

      mmgtune validate suzaku suzaku

      mmgtune validate before.toml after.toml my_trials/ --window 100 --json

      mmgtune validate suzaku suzaku --manoeuvres
    """
    from ..objective import spread
    from ..profile import load_profile
    from ..trial import load_trials
    from ..validation import validate
    from .repeated import table

    if len(names) < 2:
        raise OptionError(
            Problem("a profile or the trials are missing", "PROFILE... TRIALS", fix="write mmgtune validate suzaku DIR")
        )
    if window is not None and not window > 0.0:
        raise OptionError(Problem(f"the window is {window:g} s", "--window", fix="give a time in seconds above 0"))
    chosen = c.integrator_of(integrator, substeps)
    data = load_trials(names[-1])
    sigma = spread(list((load_trials(sigma_from) if sigma_from else data).trials.values()))
    still = [name for name, value in sigma.items() if not value > 0.0]
    if still:
        raise OptionError(
            Problem(
                f"these trials do not vary in {', '.join(still)}",
                "--sigma-from" if sigma_from else names[-1],
                "L_MSE divides by the spread of each state",
                "name trials that do with --sigma-from",
            )
        )
    found = validate(
        {name: load_profile(name) for name in names[:-1]},
        data,
        window=window,
        sigma=sigma,
        manoeuvres=manoeuvres,
        integrator=chosen,
        backend=backend,
    )
    rows = found.rows
    document = {
        **found.to_dict(),
        "trials": names[-1],
        "sigma_from": sigma_from or names[-1],
        "integrator": integrator,
        "substeps": substeps,
    }
    if json:
        c.print_json(document)
        return
    for one in rows:
        print(f"{one['profile']} ({one['id']}), {one['method']}")
        print(f"  {'':<34}{'runs':>6}{'J':>12}{'L_MSE':>10}")
        for kind, row in one["by_manoeuvre"].items():
            print(f"  {kind or 'manoeuvre not stated':<34}{row['runs']:>6}{_shown(row['J'])}{_shown(row['L_MSE'], 10)}")
        print(f"  {'all':<34}{len(one['trials']):>6}{_shown(one['J'])}{_shown(one['L_MSE'], 10)}")
        for row in one["trials"]:
            print(f"    {row['id']:<38}{_shown(row['J'])}{_shown(row['L_MSE'], 10)}")
    if found.repeated is not None:
        print(table(found.repeated))


def _shown(value: float | None, width: int = 12) -> str:
    return f"{'diverged':>{width}}" if value is None else f"{value:>{width}.4g}"
