"""Command lines that Typer cannot make sense of, as problems of ours: what, where, why, and a fix with an example."""

from __future__ import annotations

import inspect
import re
import shlex
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import typer

from ..errors import Problem, among, near_to
from ..phrases import counted, small
from ..run_files import PARTICLES
from ..units import with_point

Mistyped: type[Exception] = next(one for one in typer.BadParameter.__mro__ if one.__name__ == "UsageError")
"""What Typer raises; releases keep it at different places."""

_SPOKEN = {
    "help": "write mmgtune --help, or mmgtune fit --help of a command",
    "version": "write mmgtune --version",
    "effects": "write mmgtune diagnose -p SHIP -t TRIALS --dry-run, which lists what would be looked for",
}
"""What to write for commands that other programs have."""

_ALIKE = {"check": "validate", "validate": "check", "show": "inspect", "inspect": "show"}
"""Commands of a group by what the other group calls the like: files are looked at and checked in both."""

_GIVEN = ("-p", "--profile", "-t", "--trials")
"""Options that some commands take as words."""

_NUMBERS = {"int": "a whole number", "float": "a number", "number": "a number"}
"""What to give, by the word for it in what Typer says."""


def problem_of(error: Any) -> Problem | None:
    """The problem behind what Typer raised; None where it only shows the help."""
    kind, ctx = type(error).__name__, error.ctx
    if kind == "NoArgsIsHelpError":
        return None
    if kind == "BadOptionUsage":
        why = "the command line ends, or goes on with another option, where its value belongs"
        return Problem(f"{error.option_name} has no value", error.option_name, why, "give one, or leave the option out")
    if ctx is None:
        return Problem(error.format_message(), "command line", "it cannot be read", "mmgtune --help says what there is")
    path, message = path_of(ctx), error.format_message().rstrip(".")
    example = _example(ctx) or f"{path} --help"
    if kind == "MissingParameter" and error.param is not None:
        return Problem(
            f"{_named(error.param)} is missing", path, f"it is needed: {_help(error.param)}", f"write {example}"
        )
    if kind == "NoSuchOption":
        return _unknown_option(error.option_name, ctx)
    if kind == "BadParameter" and error.param is not None:
        takes = next((words for kind, words in _NUMBERS.items() if f"valid {kind}" in message), "")
        fix = f"give {takes}" if takes else f"write {example}"
        if takes == "a number" and (meant := _as_number(error.param.opts)):
            fix = f"write {meant}"
        what = f"the value is not {takes}" if takes else error.message.rstrip(".")
        return Problem(what, _named(error.param), f"it sets this: {_help(error.param)}", fix)
    if message.startswith("No such command") and (name := re.search("'(.*?)'", message)):
        return Problem(f"unknown command '{name[1]}'", path, **_meant(name[1], ctx))
    if extra := re.search(r"extra arguments?(?:\(s\))? \((.*)\)", message):
        takes = ", ".join(_named(one) for one in ctx.command.params if one.param_type_name == "argument")
        why = f"{path} takes {takes or 'options alone'}"
        fix = f"write {as_options(extra[1].split(), ctx) or example}"
        many = "is one word too many" if len(extra[1].split()) == 1 else "are words too many"
        return Problem(f"'{extra[1]}' {many}", path, why, fix)
    return Problem(small(message), path, "the command line ends or goes on elsewhere", f"write {example}")


def as_options(words: list[str], ctx: Any) -> str:
    """The command with a profile and trials that were given as words, as its options; "" where it cannot be that."""
    shorts = {one.name: one.opts for one in ctx.command.params if one.param_type_name == "option"}
    wanted = [flag for name, flag in (("profile", "-p"), ("trials", "-t")) if flag in shorts.get(name, ())]
    if len(wanted) == 2 and len(words) == 1 and _are_trials(words[0]):
        wanted = wanted[1:]
    if not wanted or len(words) > len(wanted):
        return ""
    return " ".join([path_of(ctx), *(f"{flag} {shlex.quote(word)}" for flag, word in zip(wanted, words, strict=False))])


def as_arguments(typed: list[str], ctx: Any) -> str:
    """The command as it was typed, with what followed -p and -t as words, the profile first and the trials last; ""
    where nothing followed."""
    before = path_of(ctx).split()[1:]
    if typed[: len(before)] != before:
        return ""
    first: list[str] = []
    last: list[str] = []
    rest: list[str] = []
    words = iter(typed[len(before) :])
    for word in words:
        flag, given, value = word.partition("=")
        if flag not in _GIVEN:
            rest.append(word)
            continue
        value = value if given else next(words, "")
        if not value or value.startswith("-"):
            return ""
        (first if flag in _GIVEN[:2] else last).append(value)
    options = next((k for k, word in enumerate(rest) if word.startswith("-")), len(rest))
    return " ".join([path_of(ctx), *map(shlex.quote, (*first, *rest[:options], *last, *rest[options:]))])


def _are_trials(word: str) -> bool:

    return Path(word).name != PARTICLES and (word.endswith(".parquet") or Path(word).is_dir())


def _meant(name: str, ctx: Any) -> dict[str, str]:
    """Why a command is unknown, and what to write: one that another group has, or the nearest."""
    found = among(name, [*ctx.command.commands])
    if ctx.parent is not None and _ALIKE.get(name) in ctx.command.commands:
        return {**found, "fix": f"write {path_of(ctx)} {_ALIKE[name]}"}
    elsewhere = [path for path, _ in _commands(ctx.find_root().command) if path.split()[-1] == name]
    if elsewhere:
        return {**found, "fix": f"write mmgtune {' or mmgtune '.join(elsewhere)}"}
    return {**found, "fix": _SPOKEN.get(name, found["fix"])}


def _unknown_option(name: str, ctx: Any) -> Problem:
    """Only near spellings are proposed; of an option that other commands have it is said which."""
    path, known = path_of(ctx), _flags(ctx.command)
    takes = [_named(one) for one in ctx.command.params if one.param_type_name == "argument"]
    if name in _GIVEN and takes:
        why = f"{path} takes {', '.join(takes)}, with no option before"
        fix = f"write {as_arguments(sys.argv[1:], ctx) or _example(ctx) or f'{path} --help'}"
        return Problem(f"unknown option {name}", path, why, fix)
    why = f"{path} has {counted(len(known), 'option')}, and none is called that"
    elsewhere = [others for others, command in _commands(ctx.find_root().command) if name in _flags(command)]
    if elsewhere:
        why += f"; these have it: {', '.join(elsewhere[:10])}{' and others' * (len(elsewhere) > 10)}"
    # The dashes are alike in all: they say nothing of the spelling.
    near = near_to(name.lstrip("-"), [flag.lstrip("-") for flag in known], cutoff=0.65)
    return Problem(f"unknown option {name}", path, why, near.replace(" '", " '--") or f"{path} --help lists them")


def _flags(command: Any) -> list[str]:
    """The long flags of a command."""
    return [flag for one in command.params for flag in one.opts if flag[:2] == "--"]


def _commands(group: Any, before: str = "") -> list[tuple[str, Any]]:
    """The commands of a group and of those in it, each by what is typed behind ``mmgtune``."""
    found: list[tuple[str, Any]] = []
    for name, one in sorted(getattr(group, "commands", {}).items()):
        if not one.hidden:
            found += _commands(one, f"{before}{name} ") if hasattr(one, "commands") else [(before + name, one)]
    return found


def path_of(ctx: Any) -> str:
    """The command as it is typed: "mmgtune trials map"."""
    names: list[str] = []
    while ctx.parent is not None:
        names.insert(0, ctx.info_name)
        ctx = ctx.parent
    return " ".join(["mmgtune", *names])


def _as_number(flags: list[str]) -> str:
    """The option as typed with a number that is plainly meant: "30 %" for 0.3, "0,5" for 0.5; "" where none is."""
    typed = [(flag, value) for flag, value in pairwise(sys.argv[1:]) if flag in flags]
    typed += [(word.partition("=")[0], word.partition("=")[2]) for word in sys.argv[1:] if word.split("=")[0] in flags]
    for flag, value in typed:
        if percent := re.fullmatch(r"\s*([0-9]+(?:[.,][0-9]+)?)\s*%\s*", value):
            return f"{flag} {float(percent[1].replace(',', '.')) / 100.0:g}"
        if pointed := with_point(value):
            return f"{flag} {pointed}"
    return ""


def _named(parameter: Any) -> str:
    """A parameter as people know it: "argument MODEL", or its flag."""
    if parameter.param_type_name == "argument":
        return f"argument {parameter.metavar or parameter.name.upper()}"
    return str(max(parameter.opts, key=len))


def _help(parameter: Any) -> str:
    return str(getattr(parameter, "help", None) or "see --help").rstrip(".")


def _example(ctx: Any) -> str:
    """The first example of the command's help, with the arguments that were typed in the place of its own."""
    lines = [line.strip() for line in inspect.cleandoc(ctx.command.help or "").splitlines()]
    before = f"{path_of(ctx)} "
    example = next((line for line in lines if line.startswith(before)), "")
    words = example.removeprefix(before).split(" ")
    arguments = [one for one in ctx.command.params if one.param_type_name == "argument"]
    for k, (one, word) in enumerate(zip(arguments, words, strict=False)):
        if one.nargs != 1 or word.startswith("-"):
            break
        typed = ctx.params.get(one.name)
        words[k] = shlex.quote(str(typed)) if typed is not None else word
    return f"{before}{' '.join(words)}" if example else ""
