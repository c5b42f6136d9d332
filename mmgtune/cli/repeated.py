"""Manoeuvres repeated by models, as a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..repeating import Repeated


def table(by_model: Mapping[str, Sequence[Repeated]]) -> str:
    """Measured indices beside those of each model, and the errors over all manoeuvres; one model at least."""
    from ..repeating import JUDGED, summary

    width = max(10, *(len(name) + 2 for name in by_model))
    first = next(iter(by_model.values()))
    if not first:
        return "No trial is a turning circle or a zigzag without gaps."
    lines = [f"{'manoeuvres repeated':<46}{'measured':>10}" + "".join(f"{name:>{width}}" for name in by_model)]
    for k, one in enumerate(first):
        lines.append(f"{one.id}: {one.order}")
        for key, (words, unit, decimals) in JUDGED.items():
            if (measured := one.measured.get(key)) is None:
                continue
            values = [repeated[k].simulated.get(key) for repeated in by_model.values()]
            shown = ["-" if value is None else f"{value:.{decimals}f}" for value in values]
            lines.append(
                f"    {f'{words} [{unit}]':<42}{measured:>10.{decimals}f}" + "".join(f"{s:>{width}}" for s in shown)
            )
    errors = {name: summary(repeated) for name, repeated in by_model.items()}
    for heading, which in (("mean error", "mean"), ("root mean square error", "rms")):
        lines.append(heading)
        for key, (words, unit, _) in JUDGED.items():
            if any(key in of for of in errors.values()):
                shown = [_error(of.get(key), which, unit) for of in errors.values()]
                lines.append(f"    {words:<42}{'':>10}" + "".join(f"{s:>{width}}" for s in shown))
    return "\n".join(lines)


def _error(of: Mapping[str, float] | None, which: str, unit: str) -> str:
    if of is None:
        return "-"
    sign = "+" if which == "mean" else ""
    return f"{of[which]:{sign}.1f} deg" if unit == "deg" else f"{100.0 * of[which]:{sign}.1f} %"
