"""For a terminal or a log: only what is wrong or better, and the verdict last."""

from __future__ import annotations

from ... import text_tables
from ...phrases import counted
from ..result import CheckReport, Item
from .numbers import change, value

MOST = 25
"""Rows shown, the most severe first."""

MOST_CHANGED = 10
"""Coefficients shown, the most responsible first."""

SHOWN = ("regressed", "not comparable", "improved")


def render(report: CheckReport, everything: bool = False, width: int = 120) -> str:
    """Lines, the verdict last.

    everything  also what passed
    width  letters of a line of the table
    """
    lines = [_head(report)] if report.profile else []
    lines += [f"error: {problem}" for problem in report.problems]
    rows = [item for status, items in report.by_status.items() if everything or status in SHOWN for item in items]
    unseen = 0 if everything else len(rows) - MOST
    rows = rows[: len(rows) if everything else MOST]
    if rows:
        heads = ("trial", "metric", "baseline", "now", "change", "passes", "")
        table = text_tables.table(heads, [_row(item) for item in rows], width=width - 1, words=(0, 1, 6), spare=(5, 2))
        lines += [f" {line}" for line in table]
        lines += [f" {unseen} more like these; --all lists them"] if unseen > 0 else []
    quiet = [item for item in report.by_status["ok"] if item.change]
    if quiet and not everything:
        most = max(quiet, key=lambda item: abs(item.change or 0.0))
        lines.append(
            f" {len(quiet)} more changed within what passes, by {100 * abs(most.change or 0.0):.2g} % at most"
            f" ({most.words} of {most.trial})"
        )
    if report.changed:
        lines.append(" coefficients that changed since the baseline:")
        shown = report.changed if everything else report.changed[:MOST_CHANGED]
        lines += [f"   {one}" for one in shown]
        if len(shown) < len(report.changed):
            lines.append(f"   and {len(report.changed) - len(shown)} more")
    lines += [f" note: {note}" for note in report.notes]
    if report.next:
        lines.append(f" next: {report.next}")
    lines.append(report.sentence())
    return "\n".join(lines) + "\n"


def difference(report: CheckReport, path: str) -> str:
    """What a baseline written anew changes; the report is of a comparison with the one before."""
    rows = [item for item in report.items if item.status == "not comparable" or item.now != item.baseline]
    lines = [_head(report)]
    if rows:
        width = max(len(item.trial) for item in rows)
        words = max(len(item.words) for item in rows)
        for item in rows:
            old, new = (value(one, item.unit) for one in (item.baseline, item.now))
            told = f"{old:>12} -> {new:<12} {change(item)}" if item.metric else item.reason
            lines.append(f" {item.trial:<{width}}  {item.words:<{words}} {told}".rstrip())
    else:
        lines.append(" no value changes")
    lines += [f"   {one}" for one in report.changed]
    worse, better = (len(report.by_status[status]) for status in ("regressed", "improved"))
    lines.append(f"wrote {path}: {len(rows)} entries changed, {worse} for the worse, {better} for the better.")
    return "\n".join(lines) + "\n"


def _head(report: CheckReport) -> str:
    how = f"{report.backend}, {report.integrator}"
    parts = [
        report.made_by,
        f"{report.profile} (sha256 {report.sha256[:8]})",
        counted(len(report.trial_ids), "trial"),
        how,
    ]
    return " · ".join(parts) if report.sha256 else f"{report.made_by} · {report.profile}"


def _row(item: Item) -> tuple[str, ...]:
    if not item.metric:
        return (item.trial, item.words, "", "", "", "", f"{item.reason}: {item.status.upper()}")
    numbers = (value(one, item.unit) for one in (item.baseline, item.now))
    word = {"ok": "ok", "improved": "better"}.get(item.status, item.status.upper())
    said = f"{word} ({item.reason})" if item.reason else word
    return (item.trial, item.words, *numbers, change(item), value(item.allowed, item.unit), said)
