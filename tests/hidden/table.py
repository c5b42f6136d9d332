"""The published table of the study of hidden effects, from its results.

python -m tests.hidden.table [runs/hidden/results.jsonl] [docs/hidden.md]
"""

from __future__ import annotations

import json
import statistics
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from mmgtune.files import write_text

from .cases import LADDER
from .unknown import UNKNOWN

Row = dict[str, Any]

HEAD = """# Hidden effects: what was found of what was there

Written by `python -m tests.hidden.table` from the results of `make hidden`. Each case is a ship drawn at random (twelve
coefficients within ±22 %), sailed by a plant of its own with something hidden in it, measured with noise (0.4 m, 0.17°,
0.02 m/s, 0.03°/s), and diagnosed from the files alone: five trials to look at, five held out. **All of it is generated;
no measured ship is in this table.**

"""


def page(rows: Sequence[Row]) -> str:
    """The page."""
    sets: dict[str, list[Row]] = {}
    for row in rows:
        sets.setdefault(row["set"], []).append(row)
    parts = [HEAD, *_summary(sets), "\n## Every effect by size\n\n", *_effects(sets), "\n## In no registry\n\n"]
    parts += _unknown(sets.get("unknown", []))
    return "".join(parts)


def _share(rows: Iterable[Row], *outcomes: str) -> str:
    listed = list(rows)
    if not listed:
        return "-"
    good = sum(row["outcome"] in outcomes for row in listed)
    return f"{good} of {len(listed)}"


def _summary(sets: dict[str, list[Row]]) -> list[str]:
    visible = [row for name, rows in sets.items() if name.endswith((":3", ":4")) for row in rows]
    inside = [held for row in visible if row["outcome"] == "right" for held in row["covered"]]
    seconds = [row["seconds"] for rows in sets.values() for row in rows]
    lines = [
        ("null cases called clear", _share(sets.get("null", []), "clear")),
        (
            "null cases with noise autocorrelated over 30 s called clear",
            _share(sets.get("null-autocorrelated", []), "clear"),
        ),
        ("single effects of typical size and above named alone", _share(visible, "right")),
        ("named, or in the reported group", _share(visible, "right", "grouped")),
        ("named wrong", _share(visible, "wrong")),
        ("95 % intervals that hold the truth", f"{sum(inside)} of {len(inside)}" if inside else "-"),
        ("pairs of typical size, both found", _share(sets.get("pair", []), "right", "grouped")),
        ("effects in no registry not called by a wrong name", _share(sets.get("unknown", []), "right", "missed")),
        ("median time on one core [s]", f"{statistics.median(seconds):.0f}" if seconds else "-"),
    ]
    return ["| over the study | |\n|---|---|\n", *(f"| {what} | {share} |\n" for what, share in lines)]


def _effects(sets: dict[str, list[Row]]) -> list[str]:
    parts = ["| effect | " + " | ".join(f"size {level}" for level in range(5)) + " |\n|---|---|---|---|---|---|\n"]
    for tag in LADDER:
        cells = []
        for level in range(5):
            rows = sets.get(f"{tag}:{level}", [])
            counts = Counter(row["outcome"] for row in rows)
            cells.append(", ".join(f"{n} {outcome}" for outcome, n in counts.most_common()) or "-")
        parts.append(f"| `{tag}` | {' | '.join(cells)} |\n")
    parts.append(
        "\nSize 3 is typical, 4 about twice that, 2 about a third, 1 and 0 far below (`tests/hidden/cases.py`).\n"
    )
    return parts


def _unknown(rows: Sequence[Row]) -> list[str]:
    parts = ["| hidden | magnitude | outcome | verdict | named |\n|---|---|---|---|---|\n"]
    for row in rows:
        (tag,) = row["hidden"]
        magnitude = f"{row['hidden'][tag]['magnitude']:.3g} {UNKNOWN[tag].unit}"
        named = ", ".join(cause["effect"] for cause in row["causes"]) or "-"
        parts.append(
            f"| {tag.removeprefix('unknown-')} | {magnitude} | {row['outcome']} | {row['verdict']} | {named} |\n"
        )
    return parts


if __name__ == "__main__":
    source = Path(sys.argv[1] if len(sys.argv) > 1 else "runs/hidden/results.jsonl")
    results = [json.loads(line) for line in source.read_text(encoding="utf-8").splitlines()]
    write_text(Path(sys.argv[2] if len(sys.argv) > 2 else "docs/hidden.md"), page(results))
