"""What commands share besides options."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator, Sequence
from datetime import datetime
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Protocol

import typer

from ..errors import OptionError, Problem
from ..options.choice import INPUT, OUTPUT
from . import completing
from .output import filled as filled
from .output import print_json as print_json
from .output import say as say
from .output import show as show
from .output import table as table
from .output import width as width

if TYPE_CHECKING:
    from ..fitting import Plan
    from ..profile import ShipProfile
    from ..profile.doubts import Doubt
    from ..trial import TrialSet, VoyageSet
    from .options import RunOptions


_MADE: list[Path] = []


class NotNamed(str):
    """What stands for a name that was not given, to be told from the same name given."""


def _told_apart(context: typer.Context, option: typer.CallbackParam, value: str) -> str:
    source = context.get_parameter_source(option.name or "")
    return NotNamed(value) if source is not None and source.name == "DEFAULT" else value


DEFAULT = "suzaku"
"""The profile and the trials that commands take where none are named."""

PROFILE, TRIALS = "FILE|NAME", "DIR|FILE|NAME"
"""Kinds of paths, in the help."""


class HasId(Protocol):
    """A profile, or what was trained for one."""

    @property
    def id(self) -> str:
        """Of the ship."""


Profile = Annotated[
    str,
    typer.Option(
        "--profile",
        "-p",
        callback=_told_apart,
        help="Ship profile: a TOML file or a bundled name.",
        rich_help_panel=INPUT,
        autocompletion=completing.profiles,
        metavar=PROFILE,
    ),
]
Trials = Annotated[
    str,
    typer.Option(
        "--trials",
        "-t",
        help="Folder of trial files, one file, or a bundled name.",
        rich_help_panel=INPUT,
        autocompletion=completing.trials,
        metavar=TRIALS,
    ),
]
TheirOwnInputs = Annotated[
    str | None,
    typer.Option(
        "--trials",
        "-t",
        help="Take these trials with their own inputs instead.",
        rich_help_panel=INPUT,
        autocompletion=completing.trials,
        metavar=TRIALS,
    ),
]
Json = Annotated[
    bool, typer.Option("--json", help="Print the result as one JSON document on stdout.", rich_help_panel=OUTPUT)
]
NoReport = Annotated[bool, typer.Option("--no-report", help="Do not render the report.", rich_help_panel=OUTPUT)]


def load(profile: str, trials: str) -> tuple[ShipProfile, TrialSet]:
    """Profile and trials by path or name; warns on stderr where the trials are of another ship."""
    from ..profile import load_profile
    from ..trial import load_trials

    ship, data = load_profile(profile), load_trials(trials)
    warn_of_another_ship(ship, data)
    _say_which_ship(profile, ship, data)
    return ship, data


def load_with_voyages(profile: str, trials: str) -> tuple[ShipProfile, TrialSet | VoyageSet]:
    """Likewise; of voyages no more than what they say of themselves."""
    from ..profile import load_profile
    from ..trial import holds_voyages, load_voyages

    if not holds_voyages(trials):
        return load(profile, trials)
    ship, data = load_profile(profile), load_voyages(trials)
    warn_of_another_ship(ship, data)
    _say_which_ship(profile, ship, data)
    return ship, data


def _say_which_ship(profile: str, ship: ShipProfile, data: TrialSet | VoyageSet) -> None:
    """Say on stderr that the bundled ship stands for that of trials which name none, where nobody named her."""
    if isinstance(profile, NotNamed) and not data.ship:
        whose = f"{ship.name}, {ship.L_pp:.0f} m long, is taken for her"
        say(f"warning: the trials do not say which ship they are of: {whose}; name her profile with --profile")


def warn_of_another_ship(ship: HasId, data: TrialSet | VoyageSet) -> None:
    """Say on stderr that trials are of another ship than the model."""
    from ..trial import another_ship

    for words in another_ship(data.ship, ship.id):
        say(f"warning: {words}")


def say_odd(data: TrialSet | VoyageSet, L_pp: float) -> None:
    """Say on stderr what is odd about trials, before long work on them; of voyages the work itself tells."""
    from ..trial import TrialSet, oddities

    for words in oddities(data.trials, L_pp) if isinstance(data, TrialSet) else ():
        say(f"note: {words}")


def say_doubts(doubts: Sequence[Doubt], whose: str = "") -> None:
    """Say on stderr which numbers of a profile may be wrong."""
    from ..profile.doubts import in_words

    for words in in_words(doubts):
        say(f"note: {whose}{words}")


def print_plan(plan: Plan, folder: Path, json: bool) -> None:
    """What a command would do, with what it would leave where."""
    if json:
        print_json({**plan.to_dict(), "out": str(folder)})
        return
    show(f"{plan}\nwrites    {folder}: {', '.join(plan.writes)}")


def planned(run: RunOptions, ship: HasId, plan: Callable[[], Plan]) -> tuple[Path, Plan] | None:
    """Where a long run writes, and its plan; None where only that was asked for, which is then said.

    plan  makes it, and finds what is wrong before a folder is made
    Raises OutputError for a folder that results cannot go to.
    """
    from ..run_folders import refuse_taken

    folder = run.out or default_out(ship)
    if not run.dry_run:
        refuse_taken(folder, force=run.force, resume=run.resume)
    made = plan()
    if run.dry_run:
        print_plan(made, folder, run.json)
        return None
    return folder, made


def needs_folder(**asked: bool) -> None:
    """Of a command without a folder to write to: OptionError where that was asked for which only files have."""
    if name := next((name for name, value in asked.items() if value), ""):
        why = "files are only written with out=FOLDER"
        raise OptionError(Problem("nothing is written", name, why, "add out=FOLDER, or leave it out"))


@contextlib.contextmanager
def placed(
    out: Path | None, *, force: bool, anew: bool = False, reads: Sequence[str | None] = (), **asked: bool
) -> Iterator[None]:
    """A context in which results are written to ``out``, as ``claimed`` gives it; where there is none nothing is.

    asked  what else was asked for which only files have
    """
    from ..run_folders import claimed

    if out is None:
        needs_folder(**asked, force=force)
        yield
    else:
        with claimed(out, force=force, anew=anew, reads=reads):
            yield


def default_out(ship: HasId) -> Path:
    """A folder under runs/, made here so that no other command takes it; ``tidy`` removes it where it stays empty."""
    name = f"{datetime.now():%Y%m%d-%H%M%S}-{ship.id}"
    tries = (Path("runs") / (f"{name}-{k}" if k > 1 else name) for k in count(1))
    while True:
        folder = next(tries)
        new = [one.absolute() for one in (folder, *folder.parents) if not one.exists()]
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            if folder.parent.is_dir():
                continue
        except OSError:
            pass  # who wants to write there will say so
        _MADE.extend(new)
        return folder


def tidy() -> None:
    """Remove folders that ``default_out`` made and nothing was written to."""
    while _MADE:
        with contextlib.suppress(OSError):
            _MADE.pop(0).rmdir()


def command_line() -> str:
    """The command as it was typed, with the program's own name in front."""
    import shlex

    return shlex.join(["mmgtune", *sys.argv[1:]])


def terms(ship: ShipProfile) -> list[str]:
    """Licence and citation of the data a profile was tuned to, as lines; none where it was not."""
    named = (("licence of the data it was tuned to", ship.licence), ("cite for them", ship.citation))
    return [f"{name}: {text}" for name, text in named if text]
