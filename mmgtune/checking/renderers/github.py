"""Annotations of GitHub Actions: workflow commands, the worst first, since only so many are shown."""

from __future__ import annotations

from ..result import CheckReport, Item
from .numbers import change, told

MOST = 9
"""Annotations of a kind written; GitHub shows ten of each kind in a step, and the verdict is one."""


def render(report: CheckReport) -> str:
    """One line per annotation; those of regressions point at the coefficient most responsible, where one is known."""
    file = {"file": report.profile_file} if report.profile_file else {}
    line = next((str(one.line) for one in report.changed if one.line and (one.share or 0.0) > 0.0), "")
    place = {**file, "line": line} if file and line else file
    lines = [_command("error", {"title": f"could not run: {one.what}"}, str(one)) for one in report.problems[:MOST]]
    bad, odd, better = (report.by_status[status] for status in ("regressed", "not comparable", "improved"))
    if report.verdict != "pass" and not report.problems:
        lines.append(_command("error", {**place, "title": "mmgtune check"}, report.sentence() + _owed(report)))
    lines += [_item("error", item, place) for item in bad[:MOST]]
    # Where there are regressions, what could not be compared is the lesser news.
    lines += [_item("warning" if bad else "error", item, {}) for item in odd[: MOST if bad else MOST - 1]]
    if better:
        lines.append(_command("notice", {**file, "title": "mmgtune check"}, f"{len(better)} metrics are better"))
    return "".join(f"{one}\n" for one in lines)


def _item(level: str, item: Item, place: dict[str, str]) -> str:
    title = " ".join(part for part in (item.trial, item.words, change(item)) if part)
    return _command(level, {**place, "title": title}, told(item))


def _owed(report: CheckReport) -> str:
    named = [one for one in report.changed if (one.share or 0.0) >= 0.005]
    return f" Changed: {named[0]}." if named else ""


def _command(level: str, properties: dict[str, str], message: str) -> str:
    told = ",".join(f"{key}={_property(text)}" for key, text in properties.items())
    return f"::{level} {told}::{_data(message)}"


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
