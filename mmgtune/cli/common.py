"""What commands share: options with the same name mean the same everywhere."""

from __future__ import annotations

import json
import sys
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import OptionError, Problem

if TYPE_CHECKING:
    from ..backends import Integrator
    from ..fitting import FitOptions
    from ..profile import ShipProfile
    from ..trial import TrialSet

INPUT, SEARCH, OUTPUT, REPRODUCE = "Input", "Search", "Output", "Reproducibility"


def complete_profile(incomplete: str) -> list[str]:
    from ..resources import profile_names

    return [name for name in profile_names() if name.startswith(incomplete)]


def complete_trials(incomplete: str) -> list[str]:
    from ..resources import trial_set_names

    return [name for name in trial_set_names() if name.startswith(incomplete)]


Profile = Annotated[
    str,
    typer.Option(
        "--profile",
        "-p",
        help="Ship profile: a TOML file or a bundled name.",
        rich_help_panel=INPUT,
        autocompletion=complete_profile,
    ),
]
Trials = Annotated[
    str,
    typer.Option(
        "--trials",
        "-t",
        help="Folder of trial files, one file, or a bundled name.",
        rich_help_panel=INPUT,
        autocompletion=complete_trials,
    ),
]
Targets = Annotated[
    list[str] | None,
    typer.Option(
        "--targets",
        help='Coefficients to tune: names or patterns as "hull.Y_*", comma-separated. Default: the profile\'s list.',
        rich_help_panel=SEARCH,
    ),
]
WithEffects = Annotated[
    list[str] | None,
    typer.Option(
        "--with-effects",
        help="Effects to put into the profile and tune besides, such as wind-drift; they begin at none.",
        rich_help_panel=SEARCH,
    ),
]
Fix = Annotated[
    list[str] | None,
    typer.Option("--fix", help="Coefficients to leave out of the targets; names or patterns.", rich_help_panel=SEARCH),
]
Identifiable = Annotated[
    bool,
    typer.Option(
        "--identifiable", help="Hold one coefficient of every direction that no trial can tell.", rich_help_panel=SEARCH
    ),
]
Channels = Annotated[
    list[str] | None,
    typer.Option(
        "--channels",
        help="What J compares: x, y, psi, u, v, r, with weights as u:2. Default: x,y,psi.",
        rich_help_panel=SEARCH,
    ),
]
Window = Annotated[
    str | None, typer.Option("--window", help="Only samples between FIRST:LAST seconds count.", rich_help_panel=SEARCH)
]
Objective = Annotated[
    str,
    typer.Option(
        "--objective",
        help="paper: position and heading over L_pp and pi/4; standardised: all states over their spread (L_MSE).",
        rich_help_panel=SEARCH,
    ),
]
Restart = Annotated[
    float | None,
    typer.Option(
        "--restart",
        help="Cut trials into windows this long (s), each begun anew from a measured state.",
        rich_help_panel=SEARCH,
    ),
]
Every = Annotated[
    float | None,
    typer.Option("--every", help="Compare samples this far apart (s); default all.", rich_help_panel=SEARCH),
]
Loss = Annotated[
    str,
    typer.Option(
        "--loss", help="squares, or huber: outliers count by size; with least-squares.", rich_help_panel=SEARCH
    ),
]
Regularise = Annotated[
    float,
    typer.Option(
        "--regularise",
        help="Cost of moving one coefficient to the edge of its box, as a share of J before; with least-squares.",
        rich_help_panel=SEARCH,
    ),
]
Method = Annotated[
    str,
    typer.Option("--method", help="cma-es (then least squares) or least-squares alone.", rich_help_panel=SEARCH),
]
Starts = Annotated[int, typer.Option("--starts", help="Starts of the least-squares solve.", rich_help_panel=SEARCH)]
Initial = Annotated[
    str,
    typer.Option(
        "--initial",
        help="Start trials from the measured first sample, or estimated within its noise.",
        rich_help_panel=SEARCH,
    ),
]
IntegratorName = Annotated[
    str, typer.Option("--integrator", help="rk4, or euler (as the paper).", rich_help_panel=SEARCH)
]
Substeps = Annotated[
    int, typer.Option("--substeps", help="Integration steps between two samples.", rich_help_panel=SEARCH)
]
BackendName = Annotated[str, typer.Option("--backend", help="compiled or numpy.", rich_help_panel=SEARCH)]
Seed = Annotated[int, typer.Option("--seed", help="Seed of every random number, 1 or more.", rich_help_panel=REPRODUCE)]
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", help="Folder for the results. Default: runs/<time>-<profile>.", rich_help_panel=OUTPUT),
]
Force = Annotated[bool, typer.Option("--force", help="Replace the results in --out.", rich_help_panel=OUTPUT)]
Manoeuvres = Annotated[
    bool,
    typer.Option(
        "--manoeuvres",
        help="Also repeat measured turning circles and zigzags with the model's own helmsman: advance, overshoots, ...",
    ),
]
Json = Annotated[
    bool, typer.Option("--json", help="Print the result as one JSON document on stdout.", rich_help_panel=OUTPUT)
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress.", rich_help_panel=OUTPUT)]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Say what would be done, and stop.", rich_help_panel=OUTPUT)]
NoReport = Annotated[bool, typer.Option("--no-report", help="Do not render the report.", rich_help_panel=OUTPUT)]


def split(values: list[str] | None) -> tuple[str, ...]:
    """Values of an option that may be repeated and may hold commas."""
    return tuple(part.strip() for value in values or () for part in value.split(",") if part.strip())


def window_of(text: str | None) -> tuple[float, float] | None:
    """FIRST:LAST in seconds; either may be left out."""
    if text is None:
        return None
    first, colon, last = text.partition(":")
    try:
        if not colon:
            raise ValueError
        return (float(first) if first else float("-inf"), float(last) if last else float("inf"))
    except ValueError:
        raise OptionError(
            Problem(
                f"'{text}' is not a time window", "--window", fix="write --window FIRST:LAST in seconds, such as 0:300"
            )
        ) from None


def integrator_of(name: str, substeps: int) -> Integrator:
    """The integrator of two options.  Raises OptionError for one that does not exist."""
    from ..backends import Integrator

    try:
        return Integrator(name, substeps)
    except ValueError as error:
        raise OptionError(Problem(str(error), "--integrator", fix="rk4 or euler")) from None


def load(profile: str, trials: str) -> tuple[ShipProfile, TrialSet]:
    """Profile and trials by path or name; warns on stderr where the trials are of another ship."""
    from ..profile import load_profile
    from ..trial import load_trials

    ship, data = load_profile(profile), load_trials(trials)
    warn_of_another_ship(ship, data)
    return ship, data


def warn_of_another_ship(ship: ShipProfile, data: TrialSet) -> None:
    """Say on stderr that trials are of another ship than the profile."""
    if data.ship and data.ship != ship.id:
        say(f"warning: the trials are of '{data.ship}', the profile is of '{ship.id}'")


def with_effects(ship: ShipProfile, tags: tuple[str, ...]) -> tuple[ShipProfile, tuple[str, ...]]:
    """The profile with these effects written into it at their null, and the names of their parameters.

    Raises OptionError for an unknown effect, or one that does not apply.
    """
    from ..effects import effect_tags, find_effect
    from ..errors import closest
    from ..profile import missing_for
    from ..profile import with_effects as put_in

    added: dict[str, dict[str, float]] = {}
    for tag in tags:
        effect = find_effect(tag)
        if effect is None:
            raise OptionError(Problem(f"unknown effect '{tag}'", "--with-effects", fix=closest(tag, effect_tags())))
        missing = missing_for(effect, ship)
        if missing:
            raise OptionError(
                Problem(
                    f"the effect '{tag}' does not apply to this ship",
                    "--with-effects",
                    f"it needs {', '.join(missing)}, which the profile does not have",
                    "add what is missing, or leave the effect out",
                )
            )
        if effect.kind not in ship.sections:
            added[tag] = {name: parameter.null for name, parameter in effect.parameters.items()}
    names = tuple(f"effects.{tag}.{name}" for tag, parameters in added.items() for name in parameters)
    return put_in(ship, added, "put in to be tuned"), names


def terms(ship: ShipProfile) -> list[str]:
    """Licence and citation of the data a profile was tuned to, as lines; none where it was not."""
    named = (("licence of the data it was tuned to", ship.licence), ("cite for them", ship.citation))
    return [f"{name}: {text}" for name, text in named if text]


def default_out(profile: ShipProfile) -> Path:
    """A folder under runs/ that does not exist yet."""
    return Path("runs") / f"{datetime.now():%Y%m%d-%H%M%S}-{profile.id}"


def plan(profile: ShipProfile, trials: TrialSet, options: FitOptions, out: Path) -> str:
    """What a fit would do, in words."""
    from ..fitting import in_pieces, make_problem

    trials = in_pieces(trials, options)
    problem = make_problem(profile, trials, options)
    lines = [
        f"profile   {profile.name} ({profile.path})",
        f"trials    tune: {', '.join(trials.tune)}; test: {', '.join(trials.test) or 'none'} ({trials.path})",
        f"search    {options.method}, seed {options.seed}, {options.starts} least-squares starts",
        f"runs      {options.integrator}, initial states {options.initial}",
        f"compares  {problem.n_residuals} differences over {problem.cases.steps} steps; back end {options.backend}",
        f"writes    {out}: fit.json, profile.toml, history.parquet, motions.parquet, report.html and .md, figures",
        f"targets   within +-{options.a_r:g} of their values:",
    ]
    box = problem.box
    low, high = box.limits
    lines += [
        f"  {name:<22}{low[i]:>12.5g} .. {box.pre[i]:>10.5g} .. {high[i]:<10.5g}" for i, name in enumerate(box.names)
    ]
    return "\n".join(lines)


def say(text: str) -> None:
    """A line for people, on stderr: stdout is data."""
    print(text, file=sys.stderr, flush=True)


def print_json(document: dict[str, Any]) -> None:
    """One JSON document on stdout."""
    print(json.dumps(document, indent=1, allow_nan=False, ensure_ascii=False))


def command_line() -> str:
    """The command as it was typed, with the program's own name in front."""
    import shlex

    return shlex.join(["mmgtune", *sys.argv[1:]])
