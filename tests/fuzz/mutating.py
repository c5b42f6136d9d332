"""What is done to bytes, lines, cells and numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

One = TypeVar("One")

NUMBERS = (
    "0", "-0", "1", "-1", "NaN", "inf", "-inf", "1e300", "-1e300", "1e308", "1e-320", "1e999", "1e9", "-1e9", "1e-9",
    "9" * 400, "0." + "3" * 400, "1e" + "9" * 30, "1e-" + "9" * 30, "0x10", "1_000", "1,5", "٣", "½", "1e", ".", "-",
    "2147483648", "9223372036854775808", "18446744073709551616", "1.7976931348623157e308",
)  # fmt: skip
"""Texts where a number belongs."""

TEXTS = (
    "", " ", "\t", "\x00", "\x1b[31m", "\n", "\r", "\ufeff", "\u202e", "💥", "a" * 5000, "'", '"', '""', "`", "${x}",
    "%s%n", "../..", "None", "true", "\\", "m/s", "12 kn", "2024-05-01T10:00:00", "12:00:00", "NA", "\udcff",
)  # fmt: skip
"""Texts where another one belongs."""


def pick(rng: np.random.Generator, among: Sequence[One]) -> One:
    """One of several."""
    return among[int(rng.integers(len(among)))]


def odd_number(rng: np.random.Generator) -> str:
    """A number as no log should have it."""
    if rng.random() < 0.3:
        return f"{rng.normal() * 10.0 ** rng.integers(-30, 31):.6g}"
    return pick(rng, NUMBERS)


def odd_text(rng: np.random.Generator) -> str:
    """A number or a text that does not belong."""
    return odd_number(rng) if rng.random() < 0.6 else pick(rng, TEXTS)


def encoded(text: str, encoding: str = "utf-8") -> bytes:
    """Bytes of a text, whatever is in it."""
    return text.encode(encoding, "surrogateescape" if encoding == "utf-8" else "replace")


# bytes


def flipped(rng: np.random.Generator, content: bytes) -> bytes:
    """A few bits turned over."""
    out = bytearray(content)
    for _ in range(int(rng.integers(1, 9)) if out else 0):
        out[int(rng.integers(len(out)))] ^= 1 << int(rng.integers(8))
    return bytes(out)


def truncated(rng: np.random.Generator, content: bytes) -> bytes:
    """Cut off somewhere."""
    return content[: int(rng.integers(len(content) + 1))]


def overwritten(rng: np.random.Generator, content: bytes) -> bytes:
    """A stretch of arbitrary bytes."""
    at, size = int(rng.integers(len(content) + 1)), int(rng.integers(1, 40))
    return content[:at] + rng.bytes(size) + content[at + size :]


def doubled(rng: np.random.Generator, content: bytes) -> bytes:
    """A stretch there twice."""
    first, last = sorted(int(one) for one in rng.integers(len(content) + 1, size=2))
    return content[:last] + content[first:]


BYTES = (flipped, truncated, overwritten, doubled)


def mutated_bytes(rng: np.random.Generator, content: bytes) -> bytes:
    """One of all that can be done to bytes."""
    return pick(rng, BYTES)(rng, content)


# lines


def line_removed(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """Without some lines in a row."""
    at = int(rng.integers(len(lines)))
    return lines[:at] + lines[at + int(rng.integers(1, 30)) :]


def line_doubled(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """A line many times."""
    at = int(rng.integers(len(lines)))
    return lines[:at] + [lines[at]] * int(rng.integers(1, 40)) + lines[at:]


def lines_shuffled(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """Two stretches exchanged."""
    a, b = sorted(int(one) for one in rng.integers(len(lines) + 1, size=2))
    return lines[b:] + lines[a:b] + lines[:a]


def line_lengthened(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """One line far longer than the others."""
    at = int(rng.integers(len(lines)))
    return [*lines[:at], lines[at] + pick(rng, (",", "9", ";", " ", "\t", "x", '"')) * 3000, *lines[at + 1 :]]


def line_emptied(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """Nothing where a line was."""
    at = int(rng.integers(len(lines)))
    return [*lines[:at], pick(rng, ("", " ", "#", "\x00", '"')), *lines[at + 1 :]]


LINES = (line_removed, line_doubled, lines_shuffled, line_lengthened, line_emptied)


def mutated_lines(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """One of all that can be done to lines."""
    return pick(rng, LINES)(rng, lines) if lines else lines


# cells


def mutated_cells(rng: np.random.Generator, lines: list[str], separator: str) -> list[str]:
    """Cells of some lines, or of one column from somewhere on, replaced, exchanged, left out, added or scaled."""
    out = list(lines)
    if not out:
        return out
    width = max(1, out[len(out) // 2].count(separator) + 1)
    column = int(rng.integers(width))
    first = int(rng.integers(len(out)))
    last = int(pick(rng, (first + 1, first + 3, len(out))))
    change = pick(rng, (_replaced, _replaced, _exchanged, _left_out, _added, _scaled, _scaled))
    written = odd_text(rng)
    factor = float(pick(rng, (0.0, -1.0, 10.0, 60.0, 1.94, 1e9, 1e-9, 1e300, 57.3)))
    for k in range(first, min(last, len(out))):
        cells = out[k].split(separator)
        if column < len(cells):
            change(cells, column, written, factor)
        out[k] = separator.join(cells)
    return out


def _replaced(cells: list[str], k: int, written: str, factor: float) -> None:
    cells[k] = written


def _exchanged(cells: list[str], k: int, written: str, factor: float) -> None:
    cells[k], cells[0] = cells[0], cells[k]


def _left_out(cells: list[str], k: int, written: str, factor: float) -> None:
    del cells[k]


def _added(cells: list[str], k: int, written: str, factor: float) -> None:
    cells.insert(k, written)


def _scaled(cells: list[str], k: int, written: str, factor: float) -> None:
    try:
        cells[k] = repr(float(cells[k]) * factor)
    except ValueError:
        cells[k] = written


def several(rng: np.random.Generator, value: One, changes: Sequence[Callable[[np.random.Generator, One], One]]) -> One:
    """One to three changes, one after the other."""
    for _ in range(int(rng.integers(1, 4))):
        value = pick(rng, changes)(rng, value)
    return value
