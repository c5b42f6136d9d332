"""Write ``mmgtune/diagnose/answers.json``: of each kind of answer, how many were right in the hidden-effects study.

python tools/write_answers.py [docs/hidden.jsonl]

An answer that names causes is right where it names, or holds in a group, everything hidden and nothing else.  That
nothing was found is right where nothing was hidden that is larger than the limit stated, and nothing that is in no
registry; ``unexplained`` where what was hidden is in no registry.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from mmgtune.diagnose.record import ANSWERS, kind_of
from mmgtune.files import write_text

ROOT = Path(__file__).parent.parent
UNKNOWN = "unknown"


def right(row: dict[str, Any]) -> bool:
    """Whether the answer of a case of the study is."""
    unknown = any(tag.startswith(UNKNOWN) for tag in row["hidden"])
    if row["verdict"] == "none":  # a jump of positions is told beside that nothing else was found
        small = row["outcome"] == "missed" and not row["above_limit"] and not unknown
        return row["outcome"] in ("clear", "right") or small
    if row["verdict"] == "unexplained":
        return unknown
    return row["outcome"] in ("right", "grouped")


def answers(rows: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """The document."""
    counted: dict[str, dict[str, int]] = {}
    total = 0
    for row in rows:
        total += 1
        one = counted.setdefault(kind_of(row["verdict"], row["causes"], row["groups"]), {"right": 0, "of": 0})
        one["of"] += 1
        one["right"] += right(row)
    return {"cases": total, "answers": dict(sorted(counted.items()))}


if __name__ == "__main__":
    study = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "hidden.jsonl"
    found = answers(json.loads(line) for line in study.read_text(encoding="utf-8").splitlines())
    write_text(ANSWERS, json.dumps(found, indent=1) + "\n")
