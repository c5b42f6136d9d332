"""What to do next: commands, each with the reason this run gives for it."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from typing import Any

from .wording import clean, count, number, shown


def _inputs(data: Mapping[str, Any]) -> tuple[str, str]:
    """The profile and the trials as words of a shell command."""
    profile = shlex.quote(clean(data["profile"].get("path") or data["profile"].get("id") or "PROFILE"))
    return profile, shlex.quote(clean(data["trials"].get("path") or "TRIALS"))


def after_fit(data: Mapping[str, Any]) -> tuple[tuple[str, str], ...]:
    """(reason, command) pairs that follow from a fit."""
    profile, trials = _inputs(data)
    a_r = number(data["options"].get("a_r"))
    out = clean(data.get("out") or "RUN").rstrip("/")
    items = []
    if data.get("at_bound"):
        wider = f" (this run: {shown(a_r)})" if a_r is not None else ""
        bound = count(len(data["at_bound"]), "coefficient")
        reason = f"{bound} at a bound: see what other ranges do on trials that were not tuned on{wider}"
        items.append((reason, f"mmgtune sweep {profile} {trials}"))
    if data.get("J_test") is None:
        items.append(
            (
                "No test set: hold some trials back, or let a sweep leave each out in turn",
                f"mmgtune sweep {profile} {trials}",
            )
        )
    items.append(
        (
            "Check the tuned profile against trials it has not seen, in this project's tests",
            f"mmgtune check {shlex.quote(out + '/profile.toml')} {trials}",
        )
    )
    if data.get("command"):
        items.append(("Repeat this run exactly", clean(data["command"])))
    seen: dict[str, str] = {}
    for reason, command in items:
        seen[command] = f"{seen[command]}; {reason[0].lower()}{reason[1:]}" if command in seen else reason
    return tuple((reason, command) for command, reason in seen.items())


def after_sweep(data: Mapping[str, Any]) -> tuple[tuple[str, str], ...]:
    """(reason, command) pairs that follow from a sweep."""
    profile, trials = _inputs(data)
    chosen = number((data.get("recommended") or {}).get("a_r"))
    items = []
    if chosen is not None:
        run = next((run for run in data["runs"] if number(run.get("a_r")) == chosen), None)
        if run is not None and run.get("out"):
            where = f"{clean(data.get('out') or 'SWEEP').rstrip('/')}/{clean(run['out'])}"
            items.append(
                (
                    "Check the recommended run's profile in this project's tests",
                    f"mmgtune check {shlex.quote(where + '/profile.toml')} {trials}",
                )
            )
        else:
            items.append(("Fit with the recommended range", f"mmgtune fit {profile} {trials} --ar {chosen:g}"))
    if data.get("command"):
        items.append(("Repeat this sweep exactly", clean(data["command"])))
    return tuple(items)
