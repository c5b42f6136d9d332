"""Marks that divide the thousands of numbers: 12'345, 12 345, and perhaps 12.345,67 and 1,234,567.8."""

from __future__ import annotations

import re
from typing import Any

from ...errors import Problem

ALL = 0.98
"""Share of the cells from which all are meant: a few are damaged."""
NEAR, FEWEST = 100.0, 3
"""Numbers without a mark, from so large on and so many different ones, beside which those of four digits have one."""


APART = "'’ \u00a0\u2009\u202f"
"""Marks that divide thousands wherever they stand in a number: an apostrophe and blanks of all kinds."""
CLOSED = rf"[-+]?[1-9]\d{{0,2}}(?:[{APART}]\d{{3}})+"
"""Whole numbers so divided."""


def closed(texts: Any) -> Any:
    """A pandas column of texts without apostrophes and blanks that divide thousands."""
    divided = texts.str.fullmatch(rf"{CLOSED}([.,]\d*)?").fillna(False)
    return texts.mask(divided, texts.str.replace(f"[{APART}]", "", regex=True)) if divided.any() else texts


def divider(decimal: str) -> str:
    """The mark that may divide thousands beside a decimal sign."""
    return "." if decimal == "," else ","


def in_thousands(texts: Any, decimal: str) -> bool | None:
    """Whether the mark that is not the decimal sign divides the thousands of a pandas column of texts.

    None where each of its cells can be read either way, such as 1.234 where the decimal sign is a comma: programs that
    print both signs exist.  False where no cell has the mark.
    """
    mark = divider(decimal)
    marked = texts[texts.str.contains(mark, regex=False).fillna(False)]
    if not len(marked):
        return False
    marked = marked[marked.str.fullmatch(_LIKE_NUMBERS).fillna(False)]
    sign, point = re.escape(mark), re.escape(decimal)
    groups = rf"[-+]?[1-9]\d{{0,2}}({sign}\d{{3}})"
    if not len(marked) or marked.str.fullmatch(rf"{groups}+({point}\d*)?").mean() < ALL:
        return False
    if marked.str.fullmatch(rf"{groups}+{point}\d*|{groups}{{2,}}").mean() >= 1.0 - ALL:
        return True
    if decimal == ".":
        return False  # 1,234 alone is a decimal comma as well, which is asked for
    # One column is printed in one way: where commas are decimal signs in it, points are none.
    if texts.str.fullmatch(r"[-+]?\d+,\d+").fillna(False).any():
        return True
    whole = texts[texts.str.fullmatch(r"[-+]?\d+").fillna(False)].str.slice(0, 18).astype(float).abs()
    if (whole >= 1000.0).any():
        return False
    # One that repeats, such as 999, may stand for no value.
    return True if whole[whole >= NEAR].nunique() >= FEWEST else None


def undivided(texts: Any, decimal: str) -> Any:
    """A pandas column of texts without the marks that divide thousands; NA where a mark stands elsewhere."""
    mark = divider(decimal)
    right = rf"[-+]?\d{{1,3}}({re.escape(mark)}\d{{3}})+({re.escape(decimal)}\d*)?"
    odd = texts.str.contains(mark, regex=False).fillna(False) & ~texts.str.fullmatch(right).fillna(False)
    return texts.mask(odd).str.replace(mark, "", regex=False)


def either_way(text: str, place: str) -> Problem:
    """The question what a point in a number is, where the decimal sign is a comma."""
    read = text.replace(".", "")
    why = "the decimal sign is a comma, and nothing in the column shows whether the point divides thousands"
    fix = 'say thousands = "." in [log], or thousands = "none" where the point is a decimal sign too'
    return Problem(f"is '{text}' {read}, or {text} with a decimal point?", place, why, fix)


def first_marked(texts: Any, decimal: str) -> int:
    """Position of the first cell of a pandas column of texts that has a mark and can be read either way."""
    mark = divider(decimal)
    return int(texts.str.fullmatch(rf"[-+]?\d{{1,3}}{re.escape(mark)}\d{{3}}").fillna(False).to_numpy().argmax())


_LIKE_NUMBERS = r"[-+]?[\d.,]*\d[\d.,]*(?:[eE][-+]?\d+)?"
