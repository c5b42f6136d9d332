"""Manoeuvres that models repeat from their orders, with a helmsman of their own, beside what was measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ..manoeuvres.judged import JUDGED
from .blocks import Cell, Fold, Nothing, Prose, Section, Table, cells
from .wording import NONE, clean, fixed, number, percent

ABOUT = (
    "Each turning circle and zigzag is ordered anew and steered by the model's own helmsman, from the trial's approach "
    "speed and revolutions: the indices that the model would have promised, simulated and not measured."
)


def section(models: Mapping[str, Mapping[str, Any] | None]) -> Section | None:
    """Measured indices beside those of each model, and the errors over all; None where none was asked to repeat any.

    models  what each is called -> its manoeuvres as ``repeating.document`` has them
    """
    asked = {clean(name): found for name, found in models.items() if found is not None}
    if not asked:
        return None
    title = "Manoeuvres repeated"
    rows = _rows(asked)
    if not rows:
        return Section("repeated", title, (Nothing("No trial is a turning circle or a zigzag without gaps."),))
    heads = ("trial", "index", "measured", *asked)
    about = (("[L]", "in ship lengths"), ("ordered", "; ".join(_ordered(asked))))
    caption = "Indices as measured, and as each model repeats the manoeuvre"
    table = Table("repeated-table", caption, heads, rows, range(2, len(heads)), about)
    every = Fold(f"Every manoeuvre: {len(rows)} indices", (table,)) if len(rows) > _MANY else table
    errors = _errors(asked)
    return Section("repeated", title, (Prose((ABOUT,)), *((errors,) if errors else ()), every))


_MANY = 24
"""Rows from which the indices of every manoeuvre are folded away under the errors over all."""


def _rows(asked: Mapping[str, Mapping[str, Any]]) -> tuple[tuple[Cell, ...], ...]:
    """A row an index of a trial; of a model of several members their mean."""
    by_trial: dict[str, dict[str, list[Mapping[str, Any]]]] = {}
    for name, found in asked.items():
        for run in found.get("runs") or ():
            by_trial.setdefault(str(run["id"]), {}).setdefault(name, []).append(run)
    rows = []
    for id, by_model in by_trial.items():
        first = next(iter(by_model.values()))[0]
        for key, (words, unit, decimals) in JUDGED.items():
            measured = number((first.get("measured") or {}).get(key))
            if measured is None:
                continue
            values = (_mean(by_model.get(name) or (), key) for name in asked)
            shown = (fixed(value, decimals) for value in (measured, *values))
            rows.append(cells(clean(id), f"{words} [{unit}]", *shown))
    return tuple(rows)


def _mean(runs: Sequence[Mapping[str, Any]], key: str) -> float | None:
    """Of the members that reach it."""
    values = [value for run in runs if (value := number((run.get("simulated") or {}).get(key))) is not None]
    return sum(values) / len(values) if values else None


def _ordered(asked: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Each trial with its order in words."""
    runs = (run for found in asked.values() for run in found.get("runs") or ())
    return [f"{id}: {order}" for id, order in {clean(run["id"]): clean(run.get("order") or "") for run in runs}.items()]


def _errors(asked: Mapping[str, Mapping[str, Any]]) -> Table | None:
    """Mean and root-mean-square error of each index over all manoeuvres, a pair of columns a model."""
    rows = []
    for key, (words, unit, _) in JUDGED.items():
        of = [(found.get("errors") or {}).get(key) for found in asked.values()]
        if any(of):
            n = next(one["n"] for one in of if one)
            rows.append(cells(words, str(n), *(text for one in of for text in _error(one, unit))))
    if not rows:
        return None
    alone = len(asked) == 1
    heads = [what if alone else f"{name}, {what}" for name in asked for what in ("mean error", "root mean square")]
    said = (("error", "simulated less measured, of the measured value; of overshoots in degrees"),)
    return Table("repeated-errors-table", "Errors of the manoeuvres repeated, over all of them",
                 ("index", "manoeuvres", *heads), tuple(rows), range(1, 2 + len(heads)), said)  # fmt: skip


def _error(of: Mapping[str, Any] | None, unit: str) -> tuple[str, str]:
    mean, rms = (None, None) if of is None else (number(of.get("mean")), number(of.get("rms")))
    if mean is None or rms is None:
        return NONE, NONE
    if unit == "deg":
        return f"{'+' if mean > 0.0 else ''}{fixed(mean, 1)}°", f"{fixed(rms, 1)}°"
    return percent(100.0 * mean), percent(100.0 * rms).removeprefix("+")
