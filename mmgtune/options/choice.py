"""An option as the field of a dataclass: what it means, what it may be, and what it is called on the command line."""

from __future__ import annotations

import functools
import inspect
import math
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from numbers import Integral, Real
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, get_args, get_type_hints

from ..errors import OptionError, Problem, among, brief, kind_of, repr_of
from ..limits import as_float, is_real

INPUT, SEARCH, OUTPUT, REPRODUCE = "Input", "Search", "Output", "Reproducibility"
"""Panels of the help, in its order."""

_KEY = "choice"
_UNSET: Any = object()

PERCENT = 2.0
"""Least number that may have been meant in percent."""


@dataclass(frozen=True)
class Choice:
    """What is known of an option besides its name, type and default.

    help    what it means, in a line
    flag    on the command line; from the field's name where empty
    short   the flag of one letter, if any
    panel   of the help
    values  words it may be, empty for any
    names   the words that it, or each part of it, may be, asked for when they are shown or completed; None for any
    called  what it is called where a word is wrong
    unit    of a number, or one that a text has to name; for messages
    least, above, most, below  limits of a number: from, more than, up to, less than
    bare    whether a number may stand for the text of it, such as 35 for "35"
    example  of a text that no number stands for, "" where the number as a text shows what is meant
    """

    help: str
    flag: str = ""
    short: str = ""
    panel: str = SEARCH
    values: tuple[str, ...] = ()
    names: Callable[[], Sequence[str]] | None = None
    called: str = ""
    unit: str = ""
    least: float | None = None
    above: float | None = None
    most: float | None = None
    below: float | None = None
    bare: bool = False
    example: str = ""

    def problems(self, name: str, value: Any) -> list[Problem]:
        """What is wrong with a value; None is never wrong, each part of a tuple is looked at."""
        if isinstance(value, (tuple, list)):
            return [problem for part in value for problem in self.problems(name, part)]
        if value is None or isinstance(value, bool):
            return []
        if self.values:
            if value in self.values:
                return []
            return [Problem(f"unknown {self.called or name} '{value}'", name, **among(str(value), self.values))]
        if self._limits and not self.allows(value):
            unit = f" {self.unit}" if self.unit else ""
            shown = f"{value:g}" if isinstance(value, float) else _short(value)
            return [Problem(f"{name} is {shown}{unit}", name, f"it sets this: {self.help}", self._fix(name, value))]
        return []

    def allows(self, value: Any) -> bool:
        """Whether a number is finite and within the limits."""
        if not isinstance(value, Real) or not (isinstance(value, Integral) or math.isfinite(value)):
            return False
        number: Any = value
        return (
            (self.least is None or number >= self.least)
            and (self.above is None or number > self.above)
            and (self.most is None or number <= self.most)
            and (self.below is None or number < self.below)
        )

    @property
    def meaning(self) -> str:
        """Its help, the unit of a number and the words it may be, in a line."""
        unit = f" [{self.unit}]" if self.unit else ""
        return f"{self.help}{unit}{' One of: ' + ', '.join(self.values) + '.' if self.values else ''}"

    @property
    def _limits(self) -> list[str]:
        ends = [("{:g} or more", self.least), ("above {:g}", self.above)]
        ends += [("{:g} or less", self.most), ("below {:g}", self.below)]
        return [words.format(limit) for words, limit in ends if limit is not None]

    def _fix(self, name: str, value: Any) -> str:
        most = self.most if self.most is not None and self.most <= 10.0 else 0.0
        if (
            isinstance(value, (int, float))
            and max(most, PERCENT) < value <= 100.0 * most
            and self.allows(value / 100.0)
        ):
            return f"did you mean {name}={value / 100.0:g}?"
        of = f" in {self.unit}" if self.unit else ""
        return f"give a number{of}, {' and '.join(self._limits)}"


def choice(default: Any, help: str, **known: Any) -> Any:
    """A field of a dataclass of options; ``known`` as for ``Choice``."""
    return field(default=default, metadata={_KEY: Choice(help, **known)})


def effects() -> Sequence[str]:
    """Names of the effects there are, those of installed packages among them."""
    from ..effects import effect_tags

    return effect_tags()


def unknown_effects(name: str, tags: Sequence[str]) -> list[Problem]:
    """What is wrong with the tags of effects in an option: those that no effect has."""
    known = effects() if tags else ()
    return [Problem(f"unknown effect '{tag}'", name, **among(tag, known)) for tag in tags if tag not in known]


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


class _Named(type):
    """Classes of options are made by the names of their fields."""

    def __call__(cls, *given: Any, **named: Any) -> Any:
        """Raises OptionError for options without a name, and for names that no option has."""
        known: Any = cls
        names = [one.name for one in fields(known)]
        if given:
            what, why = f"{_short(given[0])} is given no name", "options are given by name, and have defaults"
            fix = f"write {cls.__name__}(NAME={_short(given[0])}); the names are {', '.join(names)}"
            raise OptionError(Problem(what, cls.__name__, why, fix))
        flags = {one.flag.lstrip("-").replace("-", "_"): name for name, one in choices(known).items()}
        problems = [
            Problem(f"{cls.__name__} has no option {name}", name, **_meant(name, names, flags))
            for name in named
            if name not in names
        ]
        if problems:
            raise OptionError(*problems)
        return super().__call__(**named)

    @property
    def __signature__(cls) -> inspect.Signature:
        """What notebooks and ``help`` show: the options by name, with their defaults."""
        known: Any = cls
        named = inspect.Parameter.KEYWORD_ONLY
        shown = [inspect.Parameter(one.name, named, default=one.default, annotation=one.type) for one in fields(known)]
        return inspect.Signature(shown)

    @property
    def __doc__(cls) -> str:  # type: ignore[override]
        """What the class says, and what each option means."""
        said = inspect.cleandoc(vars(cls).get("__doc__") or "")
        if "__dataclass_fields__" not in vars(cls):
            return said
        known: Any = cls
        return "\n".join([said, "", *(f"{name}: {one.meaning}" for name, one in choices(known).items())])


def _meant(name: str, names: Sequence[str], flags: Mapping[str, str]) -> dict[str, str]:
    """Why an option is unknown, and which is meant: the one of that flag, or the nearest."""
    found = among(name, names)
    return {**found, "fix": f"did you mean '{flags[name]}'?"} if name in flags else found


@dataclass(frozen=True)
class Options(metaclass=_Named):
    """Choices that belong together; they are looked at when they are made."""

    def __init_subclass__(cls) -> None:
        """Dataclasses keep a ``repr`` that their class has, not one that it inherits."""
        cls.__repr__ = Options.__repr__  # type: ignore[method-assign]

    def __repr__(self) -> str:
        """What differs from the defaults."""
        chosen = {one.name: getattr(self, one.name) for one in fields(self) if getattr(self, one.name) != one.default}
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in chosen.items())})"

    def __post_init__(self) -> None:
        """Raises OptionError with everything that makes no sense; it names fields.

        Numbers of other libraries become Python's, which every writer of documents knows.
        """
        for name, known in choices(type(self)).items():
            if known.bare:
                object.__setattr__(
                    self, name, _as_text(getattr(self, name), isinstance(getattr(type(self), name), tuple))
                )
        problems = self._of_other_kinds()
        if not problems:
            for one in fields(self):
                object.__setattr__(self, one.name, _pythons(getattr(self, one.name)))
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

    def _of_other_kinds(self) -> list[Problem]:
        hints: dict[str, Any] = _hints(type(self))
        return [
            problem
            for name, known in choices(type(self)).items()
            for problem in _of_another_kind(name, getattr(self, name), hints[name], known.unit, known.example)
        ]

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {key: _plain(value) for key, value in asdict(self).items()}

    def shared_with(self, of: type[Options]) -> dict[str, Any]:
        """Values of the choices that another dataclass has too, by field."""
        return {name: getattr(self, name) for name in choices(of) if hasattr(self, name)}


def must_be(options: object, of: type[Options]) -> None:
    """Raises OptionError for options that are not of the class a function takes."""
    if isinstance(options, of):
        return
    why = f"they are given as a {of.__name__}, whose fields have defaults and are looked at when it is made"
    fix = f"write mmgtune.{of.__name__}(...)"
    if isinstance(options, Mapping) and all(isinstance(name, str) for name in options):
        given = ", ".join(f"{name}={value!r}" for name, value in options.items())
        fix = f"write mmgtune.{of.__name__}({textwrap.shorten(given, 200, placeholder=' ...')})"
    raise OptionError(Problem(f"{kind_of(options)} is no {of.__name__}", "options", why, fix))


_KINDS: dict[type, tuple[type, str]] = {
    bool: (bool, "True or False"),
    int: (Integral, "a whole number"),
    float: (Real, "a number"),
    str: (str, "a text"),
    Path: (Path, "a path"),
}
"""What a value of a type may be, and what that is called."""


@functools.cache
def _hints(of: Any) -> dict[str, Any]:
    return get_type_hints(of)


def _of_another_kind(name: str, value: Any, hint: Any, unit: str = "", example: str = "") -> list[Problem]:
    """The problem of a value that is not of the type of its field; a list does for a tuple, None where it may be.

    unit     that a text has to have, "" where it needs none
    example  of a text
    """
    kinds = get_args(hint) if isinstance(hint, UnionType) else (hint,)
    if value is None and NoneType in kinds:
        return []
    (kind,) = [one for one in kinds if one is not NoneType]
    parts = get_args(kind)
    if parts:
        if isinstance(value, str) or not isinstance(value, Sequence):
            fix = f"give a tuple, each part {_KINDS[parts[0]][1]}{_as_tuple(name, example or value, parts)}"
            return [Problem(f"{name} is {_short(value)}", name, fix=fix)]
        if ... not in parts and len(value) != len(parts):
            return [Problem(f"{name} is {_short(value)}", name, fix=f"give {len(parts)} numbers")]
        return [problem for part in value for problem in _of_another_kind(name, part, parts[0], example=example)][:1]
    known, words = _KINDS[kind]
    if isinstance(value, known) and (kind is bool or not isinstance(value, bool)):
        beyond = kind is float and isinstance(value, Integral) and math.isinf(as_float(value))
        return (
            [Problem(f"{name} is {brief(value)}, more than a number can be", name, fix="give less")] if beyond else []
        )
    such = f": {_part(example or value, kind, unit)}" if kind is str and isinstance(value, (int, float)) else ""
    of = " with its unit" if kind is str and unit else ""
    return [Problem(f"{name} is {_short(value)}", name, fix=f"give {words}{of}{such}")]


def _as_tuple(name: str, value: Any, parts: tuple[Any, ...]) -> str:
    """How a value that is no tuple may have been meant: "0:100" as two numbers; "" where that does not show."""
    if isinstance(value, (int, float)) and ... in parts:
        return f": {name}=({_part(value, parts[0])},)"
    if not isinstance(value, str):
        return ""
    if parts[0] is str:
        return f": {name}=({_short(value)},)"
    try:
        numbers = [float(part) for part in re.split("[:,]", value.strip("()[]"))]
    except ValueError:
        return ""
    return f": {name}=({', '.join(map(repr, numbers))}{',' * (len(numbers) == 1)})"


def _as_text(value: Any, several: bool) -> Any:
    """Numbers as the texts that mean the same, one as the only one of several; everything else as it is."""
    if isinstance(value, (list, tuple)):
        return tuple(_as_text(part, False) for part in value)
    if not is_real(value):
        return value
    number = as_float(value)
    text = str(int(number)) if number.is_integer() and abs(number) < 1e15 else str(number)
    return (text,) if several else text


def _pythons(value: Any) -> Any:
    """A number of NumPy's as one of Python's, also within a tuple; everything else as it is."""
    if isinstance(value, (list, tuple)):
        same = [_pythons(part) for part in value]
        return value if all(a is b for a, b in zip(same, value, strict=True)) else tuple(same)
    if type(value) in (bool, int, float) or not isinstance(value, Real):
        return value
    return int(value) if isinstance(value, Integral) else float(value)


def _part(value: Any, kind: type, unit: str = "") -> str:
    """A value as it might have been meant."""
    return _short(f"{value} {unit}".rstrip() if kind is str else value)


def _short(value: Any) -> str:
    return textwrap.shorten(repr_of(value), 60, placeholder=" ...")


def _plain(value: Any) -> Any:
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [_plain(part) for part in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return str(value) if isinstance(value, Path) else value
