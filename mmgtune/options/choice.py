"""An option as the field of a dataclass: what it means, what it may be, and what it is called on the command line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from ..errors import OptionError, Problem, closest

INPUT, SEARCH, OUTPUT, REPRODUCE = "Input", "Search", "Output", "Reproducibility"
"""Panels of the help, in its order."""

_KEY = "choice"
_UNSET: Any = object()


@dataclass(frozen=True)
class Choice:
    """What is known of an option besides its name, type and default.

    help    what it means, in a line
    flag    on the command line; from the field's name where empty
    short   the flag of one letter, if any
    panel   of the help
    values  words it may be, empty for any
    called  what it is called where a word is wrong
    unit    of a number, for messages
    least, above, most, below  limits of a number: from, more than, up to, less than
    """

    help: str
    flag: str = ""
    short: str = ""
    panel: str = SEARCH
    values: tuple[str, ...] = ()
    called: str = ""
    unit: str = ""
    least: float | None = None
    above: float | None = None
    most: float | None = None
    below: float | None = None

    def problems(self, name: str, value: Any) -> list[Problem]:
        """What is wrong with a value; None is never wrong, each part of a tuple is looked at."""
        if isinstance(value, tuple):
            return [problem for part in value for problem in self.problems(name, part)]
        if value is None or isinstance(value, bool):
            return []
        if self.values:
            if value in self.values:
                return []
            return [Problem(f"unknown {self.called or name} '{value}'", name, fix=closest(str(value), self.values))]
        if self._limits and not self.allows(value):
            unit = f" {self.unit}" if self.unit else ""
            shown = f"{value:g}" if isinstance(value, (int, float)) else repr(value)
            return [Problem(f"{name} is {shown}{unit}", name, fix=self._fix(name, value))]
        return []

    def allows(self, value: Any) -> bool:
        """Whether a number is finite and within the limits."""
        return (
            isinstance(value, (int, float))
            and math.isfinite(value)
            and (self.least is None or value >= self.least)
            and (self.above is None or value > self.above)
            and (self.most is None or value <= self.most)
            and (self.below is None or value < self.below)
        )

    @property
    def _limits(self) -> list[str]:
        ends = [("{:g} or more", self.least), ("above {:g}", self.above)]
        ends += [("{:g} or less", self.most), ("below {:g}", self.below)]
        return [words.format(limit) for words, limit in ends if limit is not None]

    def _fix(self, name: str, value: Any) -> str:
        if isinstance(value, (int, float)) and self.most and value > self.most and self.allows(value / 100.0):
            return f"did you mean {name}={value / 100.0:g}?"
        of = f" in {self.unit}" if self.unit else ""
        return f"give a number{of}, {' and '.join(self._limits)}"


def choice(default: Any, help: str, **known: Any) -> Any:
    """A field of a dataclass of options; ``known`` as for ``Choice``."""
    return field(default=default, metadata={_KEY: Choice(help, **known)})


def again(of: type[Options], name: str, default: Any = _UNSET, *, but: str = "") -> Any:
    """The field of another dataclass once more: same flag, same meaning, with a default of its own where one is given.

    but  a sentence to add to its help, such as what the default stands for
    """
    (found,) = [one for one in fields(of) if one.name == name]
    known: Choice = found.metadata[_KEY]
    known = replace(known, help=f"{known.help} {but}") if but else known
    return field(default=found.default if default is _UNSET else default, metadata={_KEY: known})


def choices(of: type[Options]) -> dict[str, Choice]:
    """The options of a dataclass by field, own before inherited, each with its flag."""
    first: dict[str, Choice] = {}
    known = {one.name: one.metadata[_KEY] for one in fields(of)}
    for cls in of.__mro__:
        for name in vars(cls).get("__annotations__", {}):
            if name in known and name not in first:
                first[name] = replace(known[name], flag=known[name].flag or f"--{name.replace('_', '-')}")
    return first


@dataclass(frozen=True)
class Options:
    """Choices that belong together; they are looked at when they are made."""

    def __post_init__(self) -> None:
        """Raises OptionError with everything that makes no sense; it names fields."""
        problems = self.problems()
        if problems:
            raise OptionError(*problems)

    def problems(self) -> list[Problem]:
        """What makes no sense, each choice alone; more in those where choices must go together."""
        return [
            problem
            for name, known in choices(type(self)).items()
            for problem in known.problems(name, getattr(self, name))
        ]

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {key: _plain(value) for key, value in asdict(self).items()}

    def shared_with(self, of: type[Options]) -> dict[str, Any]:
        """Values of the choices that another dataclass has too, by field."""
        return {name: getattr(self, name) for name in choices(of) if hasattr(self, name)}


def _plain(value: Any) -> Any:
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [_plain(part) for part in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return str(value) if isinstance(value, Path) else value
