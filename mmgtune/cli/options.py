"""Dataclasses of options as flags of commands, and problems that name fields said in flags."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import typer
from typer.core import TyperCommand
from typer.models import OptionInfo

from ..errors import MmgtuneError, OptionError, OutputError, Problem
from ..files import refuse_file, resumed_nowhere
from ..options import FLAGS, Options, again, choice, flags_of, in_flags
from ..options.choice import OUTPUT
from ..options.flags import off_flag
from . import completing, interrupts
from .exitcodes import EPILOG


@dataclass(frozen=True)
class RunOptions(Options):
    """What every long command can be told about what it leaves behind."""

    out: Path | None = choice(None, "Folder for the results. Default: runs/TIME-PROFILE.", short="-o", panel=OUTPUT)
    force: bool = choice(False, "Replace the results in --out.", panel=OUTPUT)
    resume: bool = choice(False, "Continue the interrupted run in --out.", panel=OUTPUT)
    dry_run: bool = choice(False, "Say what would be done, and stop.", panel=OUTPUT)
    json: bool = choice(False, "Print the result as one JSON document on stdout.", panel=OUTPUT)
    quiet: bool = choice(False, "No progress.", short="-q", panel=OUTPUT)

    def problems(self) -> list[Problem]:
        """A run to continue needs its folder, and is not replaced; results need a folder."""
        return super().problems() + _of_no_folder(self.out) + _of_resuming(self.out, self.force, self.resume)


@dataclass(frozen=True)
class WrittenOptions(Options):
    """What a command that writes a folder only for some trials can be told about what it leaves behind."""

    out: Path | None = again(RunOptions, "out")
    force: bool = again(RunOptions, "force")
    resume: bool = again(RunOptions, "resume")
    quiet: bool = again(RunOptions, "quiet")

    def problems(self) -> list[Problem]:
        """As of ``RunOptions``."""
        return super().problems() + _of_no_folder(self.out) + _of_resuming(self.out, self.force, self.resume)


def _of_no_folder(out: Path | None) -> list[Problem]:
    """A file is no folder: known before any work, and without it."""
    if out is None:
        return []
    try:
        refuse_file(out)
    except OutputError as error:
        return list(error.problems)
    return []


def _of_resuming(out: Path | None, force: bool, resume: bool) -> list[Problem]:
    """A run to continue needs its folder, and is not replaced."""
    found = []
    if resume and out is None:
        found.append(resumed_nowhere("out"))
    if resume and force:
        what = "resume=True and force=True do not go together"
        why = "resume=True goes on with what is there, force=True replaces it"
        found.append(Problem(what, "resume", why, "leave one out"))
    return found


METAVARS: dict[tuple[Any, ...], str] = {
    (str, ...): "A,B,...",
    (float, ...): "N,N,...",
    (float, float): "FIRST:LAST",
}
"""What stands for tuples in the help, by what they are of."""

NAMES: dict[str, Callable[[], Sequence[str]]] = {}
"""The words that options may be, by field, where they are only known when asked for."""


class Command(TyperCommand):
    """A command whose help says which words its options may be, which are looked up when it is shown."""

    def __init__(self, *of: Any, **how: Any):
        super().__init__(*of, **{**how, "epilog": EPILOG})

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help."""
        for parameter in self.params:
            parameter.help = help_of(parameter)  # type: ignore[attr-defined]
        super().format_help(ctx, formatter)


class App(typer.Typer):
    """A group of such commands, whose help is shown where none of them is named."""

    def __init__(self, **how: Any):
        super().__init__(**how, epilog=EPILOG, no_args_is_help=True)

    def command(  # type: ignore[override]  # of its many options none is used here
        self, name: str | None = None, **how: Any
    ) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        """As of Typer."""
        return super().command(name, cls=Command, **how)


def help_of(parameter: Any) -> str:
    """The help of an option of the command line, with the words that it may be."""
    words = str(getattr(parameter, "help", None) or "")
    names = NAMES.get(parameter.name)
    missing = names is not None and not all(name in words for name in names())
    return f"{words} Known: {', '.join(names())}." if names is not None and missing else words


def takes(**groups: type[Options]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """A command with the flags of dataclasses: it gets one filled in for each argument named here.

    Of the command's own parameters those before the ``*`` come first in the help, the others last.
    """

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        own = [p for p in inspect.signature(command, eval_str=True).parameters.values() if p.name not in groups]
        owner: dict[str, str] = {}
        parameters: list[inspect.Parameter] = []
        for group, of in groups.items():
            for parameter in parameters_of(of):
                owner[parameter.name] = group
                parameters.append(parameter)
        for parameter in own:
            _remember(parameter)
        # Profile and trials first, then what is chosen, then what only this command has.
        first = [p for p in own if p.kind is p.POSITIONAL_OR_KEYWORD]
        last = [p.replace(kind=inspect.Parameter.POSITIONAL_OR_KEYWORD) for p in own if p.kind is p.KEYWORD_ONLY]
        parameters = [*first, *parameters, *last]

        @wraps(command)
        def filled(**given: Any) -> None:
            values: dict[str, dict[str, Any]] = {group: {} for group in groups}
            rest = {}
            for name, value in given.items():
                if name in owner:
                    values[owner[name]][name] = value
                else:
                    rest[name] = value
            made: dict[str, Options] = {}
            problems: list[Problem] = []
            for group, of in groups.items():
                try:
                    made[group] = of(**_read(of, values[group]))
                except OptionError as error:
                    problems += error.problems
            if problems:
                raise OptionError(*problems)
            for run in made.values():
                if isinstance(run, RunOptions | WrittenOptions) and run.resume and run.out is not None:
                    interrupts.handle(interrupts.stop_at_once(interrupts.continued(run.out)))
            command(**rest, **made)

        named = [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in parameters]
        filled.__signature__ = inspect.Signature(named)  # type: ignore[attr-defined]
        filled.__annotations__ = {p.name: p.annotation for p in named}
        filled.takes = groups  # type: ignore[attr-defined]
        return filled

    return decorate


def _remember(parameter: inspect.Parameter) -> None:
    """Note the flag of an option that a command has to itself."""
    for known in get_args(parameter.annotation)[1:]:
        if isinstance(known, OptionInfo):
            decls = [known.default, *(known.param_decls or ())]
            flag = next(one for one in decls if isinstance(one, str) and one.startswith("--"))
            FLAGS.setdefault(parameter.name, flag)


def parameters_of(of: type[Options]) -> list[inspect.Parameter]:
    """A parameter for each field: what Typer makes a flag of."""
    hints = get_type_hints(of)
    defaults = {one.name: one.default for one in fields(of)}
    found = []
    for name, known in flags_of(of).items():
        kind, default = _typed(hints[name], defaults[name])
        shown = known.flag
        only_off = defaults[name] is True and off_flag(known.flag) == known.flag
        if defaults[name] is True:  # what is on can be turned off
            off = off_flag(known.flag)
            shown = f" /{off}" if off == known.flag else f"{known.flag}/{off}"
        decls = [shown, *([known.short] if known.short else [])]
        if known.names is not None:
            NAMES[name] = known.names
        option = typer.Option(
            *decls,
            help=known.help,
            show_default=not only_off,  # "--no-prior, default True" reads as if it were given
            rich_help_panel=known.panel,
            metavar="|".join(known.values) or METAVARS.get(_parts(hints[name]) or ()),
            autocompletion=completing.of_choice(name, known),
        )
        found.append(
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[kind, option])
        )
    return found


def _typed(hint: Any, default: Any) -> tuple[Any, Any]:
    """Type and default as Typer takes them: words in a list, numbers and intervals as one text."""
    parts = _parts(hint)
    if parts is None:
        return hint, default
    if parts == (str, ...):
        return list[str] | None, None
    if parts == (float, ...):
        return str, ",".join(f"{value:g}" for value in default)
    return str | None, None


def _read(of: type[Options], given: dict[str, Any]) -> dict[str, Any]:
    """Values as the dataclass has them."""
    hints = get_type_hints(of)
    read: dict[str, Any] = {}
    for name, value in given.items():
        parts = _parts(hints[name])
        if parts == (str, ...):
            read[name] = split(value, name)
        elif parts == (float, ...):
            read[name] = numbers_of(value, name)
        elif parts is not None:
            read[name] = interval_of(value, name)
        else:
            read[name] = value
    return read


def _parts(hint: Any) -> tuple[Any, ...] | None:
    """What a tuple is of, None for other types; a tuple that may be None counts."""
    for one in (hint, *get_args(hint)):
        if get_origin(one) is tuple:
            return get_args(one)
    return None


_ONE_OR_TWO = re.compile(r"([-+]?[0-9]+),([0-9])")


def split(values: list[str] | None, name: str) -> tuple[str, ...]:
    """Values of an option that may be repeated and may hold commas.

    Raises OptionError for "35,5", which is 35.5 where numbers have a decimal comma.
    """
    for value in values or ():
        if both := _ONE_OR_TWO.fullmatch(value.strip()):
            why = "a comma stands between values, and numbers have a decimal point"
            fix = f'write {name}={both[1]}.{both[2]}, or {name}="{both[1]}, {both[2]}" for two'
            raise OptionError(Problem(f"'{value}' may be one number or two", name, why, fix))
    return tuple(part.strip() for value in values or () for part in value.split(",") if part.strip())


def numbers_of(text: str, name: str) -> tuple[float, ...]:
    """Numbers with commas between."""
    try:
        return tuple(float(part) for part in text.split(",") if part.strip())
    except ValueError:
        fix = f"write {name}=0.2,0.3,0.4,0.5,0.6"
        raise OptionError(
            Problem(f"'{text}' is not a list of numbers", name, "a part between commas is no number", fix)
        ) from None


def interval_of(text: str | None, name: str) -> tuple[float, float] | None:
    """FIRST:LAST in seconds; either may be left out."""
    if text is None:
        return None
    first, colon, last = text.partition(":")
    try:
        if not colon:
            raise ValueError
        return (float(first) if first else float("-inf"), float(last) if last else float("inf"))
    except ValueError:
        fix = f"write {name}=FIRST:LAST in seconds, such as 0:300"
        raise OptionError(
            Problem(f"'{text}' is not a time {name}", name, "it is not two times with a colon between", fix)
        ) from None


def problems_in_flags(error: MmgtuneError) -> list[Problem]:
    """The problems of an error, with flags where the library names fields."""
    found = []
    for problem in error.problems:
        where = problem.where
        if isinstance(error, OptionError):
            where = FLAGS.get(where, where)
        found.append(
            replace(
                problem, where=where, what=in_flags(problem.what), why=in_flags(problem.why), fix=in_flags(problem.fix)
            )
        )
    return found
