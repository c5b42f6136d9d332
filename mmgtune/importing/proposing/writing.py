"""A proposed map as TOML, each entry with what speaks for it, and as a table for people."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from ..maps.quantities import meaning
from .guess import Guess
from .sampling import Sample

_ORDER = ("latitude", "longitude", "x", "y", "psi", "sog", "cog", "u", "v", "r", "n", "n_port", "n_stbd", "delta")


def toml_of_map(
    guesses: Mapping[str, Guess],
    sample: Sample,
    count: int,
    tables: Mapping[str, Mapping[str, Any]],
    comments: Mapping[str, str],
    left: Sequence[str],
    notes: Sequence[str],
) -> str:
    """The map.

    tables    further tables, such as "velocity", with their keys; comments: what is said above them
    left      columns that are not used, in words
    """
    name = _comment_safe(sample.path.name)
    how_many = f"{count} logs, such as {name}" if count > 1 else name
    lines = [
        f"# Proposed by mmgtune trials map from {how_many}.",
        "# Above each entry stands what speaks for it: sure, likely (look at it), asked (answer what begins with '?').",
        "schema = 1",
        "",
        "[log]",
        *(f"{key} = {_value(value)}" for key, value in sample.layout.items()),
        "",
        "[trial]",
        '# ship = "her profile\'s id"',
        "",
        "[time]",
        *_said(guesses["t"]),
        *(f"{key} = {_value(value)}" for key, value in _keys(guesses["t"], sample).items()),
    ]
    for table, keys in tables.items():
        lines += ["", *_wrapped(comments.get(table, "")), f"[{table}]"]
        lines += [f"{key} = {_value(value)}" for key, value in keys.items()]
    lines += ["", "[columns]"]
    for quantity in _in_order(guesses):
        guess = guesses[quantity]
        lines += [*_said(guess), f"{quantity} = {_value(_keys(guess, sample))}"]
    if "antenna" not in tables:
        lines += [
            "",
            *_wrapped("Positions are taken to be of midship. Where they are of an antenna, say where that is:"),
        ]
        lines += ["# [antenna]", '# x = "0 m"  # forward of midship', '# y = "0 m"  # to starboard']
    if left:
        lines += ["", *_wrapped(f"Not used: {'; '.join(left)}.")]
    for note in notes:
        lines += ["", *_wrapped(note)]
    return "\n".join(lines) + "\n"


def table_of_guesses(guesses: Mapping[str, Guess], sample: Sample) -> list[tuple[str, str, str, str, str]]:
    """Rows for people: quantity, column, how it counts, confidence, evidence."""
    rows = []
    for quantity in ("t", *_in_order(guesses)):
        guess = guesses[quantity]
        column = "-" if guess.column is None else sample.shown(guess.column)
        if isinstance(several := guess.keys.get("column"), list):
            column = ", ".join(f"'{one}'" if isinstance(one, str) else f"column {one}" for one in several)
        told = [
            ", ".join(one) if isinstance(one, list) else f"times {one:.3g}" if isinstance(one, float) else str(one)
            for key, one in guess.keys.items()
            if key not in ("column", "header_says")
        ]
        counts = ", ".join(one for one in told if not one.startswith("?"))
        rows.append((quantity, column, counts, guess.confidence, "; ".join(guess.evidence)))
    return rows


def guess_dict(guess: Guess, sample: Sample) -> dict[str, Any]:
    """A guess as JSON."""
    return {
        "quantity": guess.quantity,
        "meaning": "time" if guess.quantity == "t" else meaning(guess.quantity),
        "column": None if guess.column is None else guess.column + 1,
        "name": None if guess.column is None else sample.names[guess.column],
        "keys": dict(guess.keys),
        "confidence": guess.confidence,
        "evidence": list(guess.evidence),
    }


def _in_order(guesses: Mapping[str, Guess]) -> list[str]:
    return [*(one for one in _ORDER if one in guesses), *(one for one in guesses if one not in (*_ORDER, "t"))]


def _keys(guess: Guess, sample: Sample) -> dict[str, Any]:
    """All keys of an entry, the column first."""
    return {**({} if guess.column is None else {"column": sample.reference(guess.column)}), **guess.keys}


def _said(guess: Guess) -> list[str]:
    return _wrapped(f"{guess.confidence}: {'; '.join(guess.evidence)}")


def _wrapped(text: str) -> list[str]:
    text = _comment_safe(text)
    return [f"# {line}" for line in textwrap.wrap(text, 118, break_long_words=False)] if text else []


def _comment_safe(text: str) -> str:
    """Text without what a comment may not hold."""
    return "".join(one if one.isprintable() else " " for one in text)


def _value(value: Any) -> str:
    """A value as TOML."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_value(one)}" for key, one in value.items()) + " }"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
