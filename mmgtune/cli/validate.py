"""``mmgtune validate``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import OptionError, Problem
from ..options import ValidateOptions
from . import common as c
from .options import takes
from .stated import stated_table

if TYPE_CHECKING:
    from ..validating import Validation


@takes(options=ValidateOptions)
def command(
    names: Annotated[
        list[str],
        typer.Argument(metavar="PROFILE... TRIALS", help="Profiles, then the trials: files, folders or bundled names."),
    ],
    *,
    options: ValidateOptions,
    formerly: Annotated[str | None, typer.Option("--window", hidden=True)] = None,
    json: c.Json = False,
) -> None:
    """Score profiles on trials: J and the standardised error L_MSE, per trial and per kind of manoeuvre.

    Each trial, or window of it, is simulated from its first measured state with its measured inputs. L_MSE is the mean
    over time of the sum over all six states of squared differences over their variances (Wakita et al. 2022, eq. 26).

    Examples:

      mmgtune validate suzaku suzaku

      mmgtune validate before.toml after.toml my_trials/ --restart 100 --json

      mmgtune validate suzaku suzaku --manoeuvres
    """
    from ..validating import validate

    if formerly is not None:
        why = "--window FIRST:LAST is the time that counts, in the commands that fit"
        raise OptionError(
            Problem("the length of windows has another name", "--window", why, f"write --restart {formerly}")
        )
    if len(names) < 2:
        raise OptionError(
            Problem("a profile or the trials are missing", "PROFILE... TRIALS", fix="write mmgtune validate suzaku DIR")
        )
    result = validate(names[:-1], names[-1], options)
    if json:
        c.print_json(result.to_dict())
    else:
        c.show(summary(result))


def summary(result: Validation) -> str:
    """The result as a person wants to read it in a terminal."""
    from .repeated import table

    lines = []
    for one in result.to_dict()["profiles"]:
        lines.append(f"{one['profile']} ({one['id']}), {one['method']}")
        if one.get("stated"):
            lines += [
                "",
                *stated_table(one["stated"], ("simulated",)),
                "",
                f"  off by {_rms(one['stated'])}",
            ]
        if "J" not in one:
            continue
        lines.append(f"  {'':<34}{'runs':>6}{'J':>12}{'L_MSE':>10}")
        for kind, row in one["by_manoeuvre"].items():
            name = kind or "manoeuvre not stated"
            lines.append(f"  {name:<34}{row['runs']:>6}{_shown(row['J'])}{_shown(row['L_MSE'], 10)}")
        lines.append(f"  {'all':<34}{len(one['trials']):>6}{_shown(one['J'])}{_shown(one['L_MSE'], 10)}")
        for row in one["trials"]:
            lines.append(f"    {row['id']:<38}{_shown(row['J'])}{_shown(row['L_MSE'], 10)}")
    if result.options.manoeuvres:
        lines.append(table({one.name: one.repeated for one in result.profiles}))
    return "\n".join(lines)


def _rms(rows: list[dict[str, Any]]) -> str:
    """Root mean square of what stated indices are off by."""
    off = [row["off"]["simulated"] for row in rows]
    if None in off:
        return "more than a thousand tolerances: some are never reached"
    return f"{(sum(one**2 for one in off) / len(off)) ** 0.5:.3g} tolerances, root mean square over {len(off)} indices"


def _shown(value: float | None, width: int = 12) -> str:
    return f"{'diverged':>{width}}" if value is None else f"{value:>{width}.4g}"
