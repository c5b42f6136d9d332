"""What options are called on the command line: the library names fields, commands and reports say flags."""

from __future__ import annotations

import re

from .choice import Choice, Options, choices

FLAGS: dict[str, str] = {"overwrite": "--force", "keep_going": "--keep-going"}
"""The flag of every field of every dataclass of options, and of what functions that write are asked; commands add what
they have to themselves."""


def flags_of(of: type[Options]) -> dict[str, Choice]:
    """The options of a dataclass by field, each flag noted.

    Raises TypeError where a field of that name has another flag elsewhere: one name, one meaning.
    """
    found = choices(of)
    for name, known in found.items():
        if FLAGS.setdefault(name, known.flag) != known.flag:
            raise TypeError(f"{of.__name__}.{name} is {known.flag}, elsewhere {FLAGS[name]}")
    return found


def in_flags(text: str) -> str:
    """A text of the library as the command line says it: name=value becomes --flag value, for every option."""

    def flagged(found: re.Match[str]) -> str:
        name, value = found.groups()
        if name not in FLAGS:
            return found[0]
        if value == "False":
            return off_flag(FLAGS[name])
        return FLAGS[name] if value == "True" else f"{FLAGS[name]} {value}"

    return _KEYWORD.sub(flagged, text)


def off_flag(flag: str) -> str:
    """What turns off what is on unless it is turned off; the flag itself where it is named after that."""
    return flag if flag.startswith("--no-") else f"--no-{flag.lstrip('-')}"


_KEYWORD = re.compile(r'(?<![\w.-])([a-z]\w*)=("[^"]*"|[^\s;)?]*[^\s;:,.)?])')
"""A keyword argument in a sentence, without the sentence's own signs after it."""
