"""What is known of logs while their columns are found out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ... import units
from ..cells.degrees import DDMM
from ..cells.headers import in_percent
from .clocks import Clock
from .guess import ASKED, LIKELY, MARK, SURE, Guess
from .look import Look
from .sampling import Sample
from .scaled import scaled, without_factor
from .words import ORDER, helms, numbered, of_starboard, ordered, plain, quantity_named, unit_named

MOST_LOGS = 8
"""Logs whose motion is looked at."""
MOST_COLUMNS = 48
"""Columns whose behaviour is looked at; of more, those whose names say something."""
ROUGH = 0.15
"""Share of the speed by which velocities may miss the positions and still be what they are taken for."""
FEW_DIGITS = 4


class Finder:
    """One pass over logs of one kind, with the same columns.

    said, units_said  (n_columns,) what names say: a quantity, a unit
    units_wrong       units that names say and behaviour refutes, by column; ``units_said`` has "" there
    own_units         columns whose unit each log says itself, as they differ in it
    guesses           by quantity, in the order they were found; guess_t: time, before its unit is known
    used, numeric     columns that are something already, and those whose behaviour can be looked at
    parts             further columns of what is in several, by the first of them and by what they hold
    factors           by what the numbers of columns were multiplied that are in parts of a unit
    ddmm              columns of degrees and minutes in one number
    as_printed        columns whose few digits are to be recovered: what was known before, and how they are printed
    looks             logs whose motion is known; unit: of time; axes: of the velocities
    readings          how well the motion fits with time in each unit, or format, that it was tried in
    tables, comments  further tables of the map, and what is said above them
    notes             what else is to be said
    """

    axes: str | None = None

    def __init__(self, samples: Sequence[Sample], own_units: Sequence[str] = ()):
        self.samples = list(samples)
        self.first = samples[0]
        self.own_units = {k for k, name in enumerate(self.first.names) if name in own_units}
        below = [row if any(one.units[k] == row for one in samples) else "" for k, row in enumerate(self.first.units)]
        # A unit below a name tells what it is of as one behind it does.
        groups = self.first.groups or ("",) * len(below)
        shown = [
            without_factor(f"{group} {name} [{row}]" if row else f"{group} {name}".strip())
            for group, name, row in zip(groups, self.first.names, below, strict=True)
        ]
        counted = numbered(self.first.names)
        # Of many columns called alike the name is that of the table.
        self.said = ["" if k in counted else quantity_named(name) for k, name in enumerate(shown)]
        for k in of_starboard(self.first.names, self.said):
            self.said[k] += "_stbd"
        for k in helms(self.first.names, self.said):
            self.said[k] = ORDER
        # North and east by a letter each; alone, n is what propellers turn with.
        letters = {plain(name): k for k, name in enumerate(self.first.names)}
        if {"n", "e"} <= set(letters):
            self.said[letters["n"]], self.said[letters["e"]] = "x", "y"
        self.samples, self.factors = scaled(self.samples, self.said)
        self.first = self.samples[0]
        self.units_said = [unit_named(name) for name in shown]
        said = zip(self.first.names, below, self.units_said, strict=True)
        self.in_percent = {k for k, (name, row, unit) in enumerate(said) if not unit and in_percent(name, row)}
        self.units_wrong: dict[int, str] = {}
        self.guesses: dict[str, Guess] = {}
        self.as_printed: dict[str, tuple[Guess, str]] = {}
        self.used: set[int] = set()
        self.parts: dict[int, dict[str, int]] = {}
        self.ddmm: set[int] = set()
        self.notes: list[str] = []
        self.tables: dict[str, dict[str, Any]] = {}
        self.comments: dict[str, str] = {}
        self.numeric: list[int] = []
        self.unit = "s"
        self.readings: dict[str, float] = {}
        self.clock: Clock
        self.guess_t: Guess
        self.looks: list[Look] = []

    def shown(self, k: int) -> str:
        """A column for people."""
        return self.first.shown(k)

    def add(self, guess: Guess) -> None:
        """Take a guess, whose column is then nothing else; a name that is wrong in its unit leaves a doubt."""
        if "header_says" in guess.keys and guess.confidence == SURE:
            guess = replace(guess, confidence=LIKELY)
        if guess.column in self.parts:
            parts = {part: self.first.reference(k) for part, k in self.parts[guess.column].items()}
            guess = replace(guess, keys={**parts, **guess.keys})
        if guess.column in self.own_units and "header_says" not in guess.keys:
            keys = {key: value for key, value in guess.keys.items() if key != "unit"}
            guess = replace(guess, keys=keys, evidence=(*guess.evidence, "its unit is what each log says"))
        if guess.column is not None and (factor := self.factors.get(guess.column)):
            keys = {**guess.keys, "scale": factor}
            guess = replace(
                guess, keys=keys, evidence=(*guess.evidence, f"its numbers are {1.0 / factor:.10g} times as large")
            )
        unit = str(guess.keys.get("unit", MARK))
        if guess.column in self.in_percent and not unit.startswith(MARK):
            of = f"how many {unit} are 100 % of {self.shown(guess.column)}?"
            scale = {"scale": f"{MARK} a hundredth of its {unit} at 100 %: {of}"}
            said = (*guess.evidence, "its name says percent")
            guess = replace(guess, keys=guess.keys | scale, evidence=said, confidence=ASKED)
        if guess.column in self.ddmm:
            guess = replace(guess, keys={**guess.keys, "unit": DDMM})
        self.guesses[guess.quantity] = guess
        if guess.column is not None:
            self.used.add(guess.column)

    def says_side(self, k: int) -> bool:
        """Whether the cells of a column say the side themselves."""
        return any(k in sample.sided for sample in self.samples)

    def pool(self, *not_said: str) -> list[int]:
        """Columns that are nothing yet, whose behaviour can be looked at, and whose names say none of some words."""
        return [k for k in self.numeric if k not in self.used and self.said[k] not in not_said]

    def orders(self, quantity: str) -> list[int]:
        """Columns that are nothing yet and hold orders of a quantity by their names."""
        return [k for k in self.pool() if ordered(self.first.names[k]) == quantity]

    def unit_of(self, k: int, kind: str, seen: str) -> tuple[dict[str, str], str]:
        """Keys for the unit of a column that behaviour shows to be ``seen``, and what its name says of it."""
        said = self.units_said[k]
        known = units.factors(kind)
        if said and units.factors(kind).get(said) == known[seen]:
            return {"unit": said}, "; its name says so too"
        if wrong := self.units_wrong.get(k):
            return {"unit": seen, "header_says": wrong}, f", although its name says {wrong}"
        return {"unit": seen}, ""


def moves(values: Any) -> bool:
    """Whether a column has numbers enough to look at."""
    return int(np.isfinite(values).sum()) > 10
