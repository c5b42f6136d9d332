"""Manoeuvres repeated by models, as a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from .output import table as aligned

if TYPE_CHECKING:
    from ..repeating import Repeated


def table(by_model: Mapping[str, Sequence[Repeated]]) -> str:
    """Measured indices beside those of each model, and the errors over all manoeuvres; one model at least."""
    from ..manoeuvres.judged import JUDGED
    from ..repeating import summary

    first = next(iter(by_model.values()))
    if not first:
        return "No trial is a turning circle or a zigzag without gaps."
    rows: list[tuple[str, ...]] = []
    for k, one in enumerate(first):
        rows.append((f"{one.id}: {one.order}", *("" for _ in range(1 + len(by_model)))))
        for key, (words, unit, decimals) in JUDGED.items():
            if (measured := one.measured.get(key)) is None:
                continue
            values = [repeated[k].simulated.get(key) for repeated in by_model.values()]
            shown = ["-" if value is None else f"{value:.{decimals}f}" for value in values]
            rows.append((f"    {words} [{unit}]", f"{measured:.{decimals}f}", *shown))
    errors = {name: summary(repeated) for name, repeated in by_model.items()}
    for heading, which in (("mean error", "mean"), ("root mean square error", "rms")):
        rows.append((heading, *("" for _ in range(1 + len(by_model)))))
        for key, (words, unit, _) in JUDGED.items():
            if any(key in of for of in errors.values()):
                rows.append((f"    {words}", "", *(_error(of.get(key), which, unit) for of in errors.values())))
    return "\n".join(aligned(("manoeuvres repeated", "measured", *by_model), rows))


def _error(of: Mapping[str, float] | None, which: str, unit: str) -> str:
    if of is None:
        return "-"
    sign = "+" if which == "mean" else ""
    return f"{of[which]:{sign}.1f} deg" if unit == "deg" else f"{100.0 * of[which]:{sign}.1f} %"
