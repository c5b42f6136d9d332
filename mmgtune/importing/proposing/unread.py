"""Cells of chosen columns that are read as something else than they say, or not at all."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np

from ...phrases import counted
from ..cells.numerals import numbers_in
from ..cells.thousands import first_marked, in_thousands
from ..formats.sides import midships
from ..formats.table import MISSING
from .finder import Finder
from .guess import MARK

READ_AS_NONE = frozenset({"#n/a n/a", "#na", "-1.#ind", "-1.#qnan", "-nan", "1.#ind", "1.#qnan", "<na>"})
"""More texts for no value, in small letters, that readers of tables know."""


def doubt_thousands(find: Finder) -> None:
    """Ask what points in chosen columns are where the decimal sign is a comma and nothing shows it."""
    layouts = [one.layout for one in find.samples]
    if any("thousands" in one for one in layouts):
        find.first = replace(find.first, layout={**find.first.layout, "thousands": "."})
        return
    for sample in find.samples:
        decimal = sample.layout.get("decimal", ".")
        for k in (one.column for one in find.guesses.values() if one.column is not None):
            texts = sample.texts[k]
            if str(texts.dtype) == "string" and in_thousands(texts, decimal) is None:
                text = texts.iloc[first_marked(texts, decimal)]
                asks = (
                    f'{MARK} "." or "none": is {text} in {find.shown(k)} {text.replace(".", "")}, or a decimal point?'
                )
                find.first = replace(find.first, layout={**find.first.layout, "thousands": asks})
                return


def unread(find: Finder) -> None:
    """Say how many cells are words for amidships, and how many cannot be read, with an example of each."""
    for name, guess in find.guesses.items():
        k = guess.column
        if name == "t" or k is None:
            continue
        zeros: Counter[str] = Counter()
        lost: Counter[str] = Counter()
        total, where = 0, ""
        for sample in find.samples:
            texts, numbers = sample.texts[k], sample.numbers[k]
            total += len(numbers)
            if str(texts.dtype) != "string":
                continue
            there = ~texts.str.lower().isin(MISSING | READ_AS_NONE).to_numpy() & texts.notna().to_numpy(dtype=bool)
            known = np.isfinite(numbers)
            if (zero := there & known & midships(texts)).any():
                zeros.update(texts[zero].tolist())
            # What is beyond all numbers is told as impossible.
            bad = (
                there
                & ~known
                & np.isnan(numbers_in(texts, sample.layout.get("decimal", "."), sample.layout.get("thousands")))
            )
            if bad.any():
                lost.update(texts[bad].str.slice(0, 40).tolist())
                where = where or str(sample.path)
        if zeros:
            find.notes.append(f"{find.shown(k)}: {counted(zeros.total(), 'cell')} such as '{next(iter(zeros))}' are 0")
        if lost:
            what = "is no number and becomes a gap" if lost.total() == 1 else "are no numbers and become gaps"
            find.notes.append(
                f"{find.shown(k)}: {lost.total()} of {total} cells {what}, the first is '{next(iter(lost))}' ({where})"
            )
