"""How often an answer of each kind was right, in the study of ships with hidden effects (docs/hidden.md).

The numbers travel with the program in ``answers.json``, written by ``tools/write_answers.py``.  They are of generated
ships, of effects as the study draws them: where other things go wrong, other shares of answers are right.
"""

from __future__ import annotations

import json
from collections.abc import Collection
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

ANSWERS = Path(__file__).parent / "answers.json"

_NUMBERS = ("no cause", "one cause", "two causes", "three causes")


@dataclass(frozen=True)
class Record:
    """Number of answers of a kind in the study, and how many of them were right."""

    kind: str
    right: int
    of: int

    @property
    def sentence(self) -> str:
        """In words."""
        if not self.of:
            return f"No answer of this kind ({self.kind}) was given in the study of generated ships."
        return (
            f"In the study of generated ships, {self.right} of {self.of} answers of this kind ({self.kind}) were right."
        )

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {"kind": self.kind, "right": self.right, "of": self.of, "sentence": self.sentence}


def kind_of(verdict: str, causes: Collection[Any], groups: Collection[Any]) -> str:
    """What kind of answer a verdict with these causes and groups is; "" for a search that was stopped."""
    if verdict == "none":
        return "nothing found"
    if verdict == "unexplained":
        return "unexplained"
    if verdict == "interrupted":
        return ""
    number = _NUMBERS[len(causes)] if len(causes) < len(_NUMBERS) else "four causes or more"
    if not groups:
        return number
    return "a group" if len(causes) == 1 else f"{number}, a group among them"


@cache
def _known() -> dict[str, dict[str, int]]:
    answers: dict[str, dict[str, int]] = json.loads(ANSWERS.read_text(encoding="utf-8"))["answers"]
    return answers


def record_of(kind: str) -> Record:
    """The record of a kind of answer; of zero answers where the study has none."""
    found = _known().get(kind, {"right": 0, "of": 0})
    return Record(kind, found["right"], found["of"])
