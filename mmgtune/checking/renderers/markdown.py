"""Markdown for the summary of a CI run or a comment on a pull request."""

from __future__ import annotations

from collections.abc import Sequence

from ...report.markdown import escaped
from ..result import CheckReport, Item
from .numbers import change, value

LONGEST = 500
"""Rows of a table; a summary page takes no more than a megabyte."""


def render(report: CheckReport) -> str:
    """The verdict, what is wrong or better, what changed, everything else folded away, and how to repeat it."""
    parts = [f"### {escaped(report.sentence())}"]
    parts += [f"- {escaped(str(problem))}" for problem in report.problems]
    rows = [item for status in ("regressed", "not comparable", "improved") for item in report.by_status[status]]
    if rows:
        parts.append(_table(rows))
    if report.changed:
        parts.append("Coefficients that changed since the baseline:")
        parts.append("\n".join(f"- {escaped(str(one))}" for one in report.changed))
    parts += [f"Note: {escaped(note)}." for note in report.notes]
    rest = [item for status in ("not shown", "ok") for item in report.by_status[status]]
    if rest:
        parts.append(f"<details><summary>{len(rest)} more</summary>\n\n{_table(rest)}\n\n</details>")
    if report.profile and not report.problems:
        again = f"mmgtune check {report.profile} {report.trials}"
        again += f" --baseline {report.baseline}" if report.baseline else ""
        parts.append(f"Repeat it: {_code(again)}" + (f", then {_code(report.next)}" if report.next else ""))
    how = f"{report.made_by}, {report.backend} back end, {report.integrator}" if report.backend else report.made_by
    parts.append(f"<sub>{escaped(how)}</sub>")
    return "\n\n".join(parts) + "\n"


def _table(items: Sequence[Item]) -> str:
    lines = ["| trial | metric | baseline | now | change | passes | |", "|---|---|---:|---:|---:|---:|---|"]
    for item in items[:LONGEST]:
        numbers = [value(one, item.unit) for one in (item.baseline, item.now)]
        passes = value(item.allowed, item.unit)
        status = f"{item.status}: {item.reason}" if item.reason else item.status
        cells = (item.trial, item.words, *numbers, change(item), passes, status)
        lines.append("| " + " | ".join(escaped(cell) for cell in cells) + " |")
    if len(items) > LONGEST:
        lines.append(f"| {len(items) - LONGEST} more | | | | | | |")
    return "\n".join(lines)


def _code(text: str) -> str:
    """A code span: as many backticks around it as it takes."""
    ticks = "`"
    while ticks in text:
        ticks += "`"
    clean = " ".join(text.split())
    return f"{ticks}{clean}{ticks}" if ticks == "`" else f"{ticks} {clean} {ticks}"
