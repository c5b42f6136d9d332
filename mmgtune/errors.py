"""What the program says when it cannot go on: what, where, why, and the fix."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from json import JSONDecodeError
from types import NoneType
from typing import Any, Self


@dataclass(frozen=True)
class Problem:
    """One thing wrong with an input: everything a user needs to put it right.

    what   what is wrong, in one sentence without the place
    where  file, key, row or option it was found at ("" if it has no place)
    why    why that cannot be worked with ("" if evident)
    fix    what to do about it ("" if nothing better than what ``what`` says)
    """

    what: str
    where: str = ""
    why: str = ""
    fix: str = ""

    def __str__(self) -> str:
        lines = [f"{self.what} ({self.where})" if self.where else self.what]
        if self.why:
            lines.append(f"  why: {self.why}")
        if self.fix:
            lines.append(f"  fix: {self.fix}")
        return "\n".join(lines)

    def at(self, where: str) -> Self:
        """The same problem, found at another place."""
        return replace(self, where=where)

    def to_dict(self) -> dict[str, str]:
        """The four fields, for JSON."""
        return {"what": self.what, "where": self.where, "why": self.why, "fix": self.fix}


class MmgtuneError(Exception):
    """The program could not run; carries every problem found, not only the first.  Exit code 2."""

    def __init__(self, *problems: Problem):
        self.problems = problems
        super().__init__("\n".join(str(problem) for problem in problems))


class ProfileError(MmgtuneError):
    """A ship profile cannot be used."""


class TrialError(MmgtuneError):
    """A trial file or a data set cannot be used."""


class LogError(MmgtuneError):
    """A log of a trial, or the map that says how to read it, cannot be used."""


class NetworkError(MmgtuneError):
    """A trained network cannot be used."""


class OptionError(MmgtuneError):
    """An option or argument makes no sense, alone or with the others."""


class OutputError(MmgtuneError):
    """A result cannot be written."""


FEW = 12
"""Names that are listed where one of them is meant; of more it is said how many there are."""


def among(name: object, known: Sequence[str]) -> dict[str, str]:
    """Why a name is not understood and what to do, by the names there are: ``Problem(what, where, **among(...))``."""
    if not known:
        return {"why": "there is nothing here that it could mean", "fix": "leave it out"}
    near = near_to(name, known)
    if not near:
        return {"why": f"it is like none of the names that are {_listed(known)}", "fix": "write one of these"}
    few = f"the only names {_listed(known)}"
    return {"why": few if len(known) <= FEW else f"it is none of the {len(known)} names known here", "fix": near}


def closest(name: object, known: Sequence[str]) -> str:
    """A sentence naming the nearest known names, or what is known if nothing is near."""
    return near_to(name, known) or _listed(known)


def near_to(name: object, known: Sequence[str], cutoff: float = 0.62) -> str:
    """A question naming the nearest known names, "" where none is near; capitals count as small letters.

    Where none is near, those that begin with the name are.

    cutoff  likeness from which a name is near, 1 being the same
    """
    import difflib

    # Names may come from files: comparing grows with the product of lengths.
    short: dict[str, list[str]] = {}
    for other in known[:1000]:
        if len(other) <= 80:
            short.setdefault(other.lower(), []).append(other)
    asked = (name if isinstance(name, str) else brief(name))[:80].lower()
    alike = difflib.get_close_matches(asked, short, n=3, cutoff=cutoff)
    alike = alike or [one for one in short if asked and one.startswith(asked)]
    near = [other for one in alike for other in short[one]][:3]
    return "did you mean " + " or ".join(f"'{other}'" for other in near) + "?" if near else ""


def _listed(known: Sequence[str]) -> str:
    more = f" and {len(known) - 40} more" if len(known) > 40 else ""
    return "known here: " + ", ".join(other if len(other) <= 80 else f"{other[:80]}..." for other in known[:40]) + more


def brief(value: object) -> str:
    """A value from a file as messages show it: short, whatever it is and however deep."""
    import reprlib

    class Short(reprlib.Repr):
        def repr_int(self, x: int, level: int) -> str:
            return repr(x) if abs(x) < 10**40 else f"a number of {int((x.bit_length() - 1) * 0.30103) + 1} digits"

        def repr1(self, x: object, level: int) -> str:
            is_time = type(x).__module__ == "datetime"  # as TOML has it
            return str(x) if is_time else super().repr1(x, level)

        def repr_instance(self, x: object, level: int) -> str:
            text = super().repr_instance(x, level)
            return f"<{kind_of(x)}>" if "\n" in text else text  # such as a table, of which a piece says nothing

    short = Short()
    short.maxlevel, short.maxstring, short.maxother = 3, 80, 80
    short.maxlist = short.maxdict = short.maxtuple = 8
    return short.repr(value)


def repr_of(value: object) -> str:
    """The ``repr`` of a value, or where that fails what kind it is."""
    try:
        return repr(value)
    except Exception:  # whatever a class of somebody else raises
        return f"<{kind_of(value)}>"


def kind_of(value: object) -> str:
    """The type of a value with its article: "a dict", "an int"."""
    return article(type(value).__name__)


def must_be_a(value: object, of: type | tuple[type, ...], name: str) -> None:
    """Raises OptionError for an argument that is of none of some classes; one that belongs elsewhere is told where.

    name  of the argument
    """
    several = of if isinstance(of, tuple) else (of,)
    if isinstance(value, several):
        return
    words = " or ".join(_called(one) for one in several if one is not NoneType)
    writer = getattr(value, "written_by", "")
    fix = (
        f"mmgtune.{writer}(RESULT, FOLDER) writes it"
        if isinstance(writer, str) and writer
        else f"give {article(words)}"
    )
    raise OptionError(Problem(f"{kind_of(value)} is no {words}", name, f"{article(words)} is wanted here", fix))


def all_of(given: object, of: type, name: str) -> tuple[Any, ...]:
    """Several of a class as a tuple.  Raises OptionError for anything else, a single one too."""
    words = _called(of)
    parts = parts_of(given)
    others = [one for one in parts or () if not isinstance(one, of)]
    if parts is None or others:
        what = f"{kind_of(others[0])} in {name} is no {words}" if others else f"{name} is {brief(given)}"
        fix = f"give a list, each part {article(words)}"
        raise OptionError(Problem(what, name, f"several may be wanted, each of them {article(words)}", fix))
    return tuple(parts)


def parts_of(given: object) -> list[Any] | None:
    """What several things are given as, one by one; None for a text, a mapping and what is but one thing."""
    if isinstance(given, (str, bytes, Mapping)) or not isinstance(given, Iterable):
        return None
    try:
        return list(given)
    except TypeError:  # an array of no axis
        return None


def _called(of: type) -> str:
    """A class in sentences."""
    words: dict[Any, str] = {str: "text", Mapping: "dict", Callable: "function"}
    return words.get(of, of.__name__)


def article(word: str) -> str:
    """A word with its article."""
    return f"{'an' if word[0].lower() in 'aeiou' else 'a'} {word}"


def reason(error: BaseException) -> str:
    """What an exception says, in one short line: of a file, what the system says, without its number and the path."""
    if isinstance(error, UnicodeDecodeError):
        return f"byte {error.start} is no {error.encoding} text"
    if isinstance(error, JSONDecodeError):
        return f"it is no JSON: line {error.lineno}, column {error.colno}"
    if isinstance(error, IsADirectoryError):
        return "it is a folder"
    if isinstance(error, KeyError) and error.args:
        return f"it has no '{error.args[0]}'"
    if isinstance(error, (TypeError, AttributeError)) and re.search(r"'\w+' object|unsupported operand", str(error)):
        return "something in it is of another kind than was written"  # Python's own words are for programmers
    said = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return (said.strip().splitlines() or [type(error).__name__])[0][:300]


def cannot_write_reason(error: OSError) -> str:
    """Why something could not be written, in one short line, with the place."""
    return f"{reason(error)}: {error.filename}" if error.filename else reason(error)
