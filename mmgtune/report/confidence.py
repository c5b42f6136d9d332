"""Sections on how far a fit can be trusted: whether it is the best in the box, and what the trials can tell."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import FloatArray
from . import findings, tables
from .blocks import Block, Fold, Prose, Section, Table
from .common import picture
from .figures import of_fit as figures
from .wording import count, number, sentence, short, shown

if TYPE_CHECKING:
    from .load import RunRecord


def best_fit(record: RunRecord) -> Section:
    """Convergence, agreement of methods, and what the bounds cost."""
    data, blocks = record.data, list[Block]()
    certificate = data.get("certificate") or {}
    said = [sentence(text) for text in certificate.get("sentences") or ()]
    said += [sentence(text) for text in (data.get("beside") or {}).get("sentences") or ()]
    blocks.append(Prose(tuple(said or findings.agreement(data)), listed=True))
    active = certificate.get("active") or []
    if active:
        ordered = sorted(active, key=lambda row: -(number(row.get("gain_per_percent")) or 0.0))
        bounds = tables.pairs(
            "bounds-table",
            "Fall of J if a touched bound were 1 % of the pre-determined value wider",
            ("coefficient and bound", "fall of J"),
            (
                (f"{short(str(row['name']))}, {row.get('side')} bound", shown(row.get("gain_per_percent"), 3))
                for row in ordered
            ),
            numeric=True,
        )
        blocks.append(Fold("What each touched bound costs", (bounds,)))
    history = record.history
    if history and len(history.get("J_best", ())):
        evaluations = running(history)
        least = number((data.get("agreement") or {}).get("J_least_squares"))
        figure = figures.convergence(evaluations, history, least)
        entries = data.get("restarts") or []
        more = (tables.restarts(entries),) if entries else ()
        blocks.append(picture(figure, "Convergence", findings.convergence(data), *more))
    else:
        blocks.append(Prose(("No evolution strategy ran, so there is no history of its generations.",)))
    return Section("trust", "Is this the best fit in the box?", tuple(blocks))


def running(history: Any) -> FloatArray:
    """Evaluations counted through all restarts, also where each restart counts from its own beginning."""
    spent = np.asarray(history["evaluations"], dtype=np.float64)
    falls = np.where(np.diff(spent, prepend=spent[:1]) < 0.0, np.roll(spent, 1), 0.0)
    total: FloatArray = np.maximum(spent + np.cumsum(falls), 1.0)
    return total


def identifiability(record: RunRecord) -> Section | None:
    found = record.data.get("identifiability") or {}
    blocks = list[Block]()
    said = [sentence(text) for text in found.get("sentences") or ()]
    said += [sentence(row["sentence"]) for row in found.get("null_directions") or () if row.get("sentence")]
    if said:
        blocks.append(Prose(tuple(dict.fromkeys(said)), listed=True))
    combinations = found.get("combinations") or []
    if combinations:
        blocks.append(
            tables.pairs(
                "combinations-table",
                "Combinations that the trials do determine",
                ("combination", "value ± std. error"),
                (
                    (str(row.get("expression")), f"{shown(row.get('value'))} ± {shown(row.get('stderr'), 2)}")
                    for row in combinations
                ),
                numeric=True,
            )
        )
    correlation = found.get("correlation") or {}
    names, matrix = correlation.get("names") or [], correlation.get("matrix") or []
    if len(names) > 1 and len(matrix) == len(names):
        blocks.append(
            picture(
                figures.correlation(names, matrix),
                "Correlations",
                findings.correlation(names, matrix),
                tables.correlation(names, matrix),
            )
        )
    numbers = _numbers(found)
    if numbers:
        blocks.append(Fold("Singular values and autocorrelation", (numbers,)))
    if not blocks:
        return None
    return Section("identifiability", "What the trials can and cannot tell", tuple(blocks))


def _numbers(found: Any) -> Table | None:
    """Singular values of the sensitivity, and how far residuals follow one another."""
    values = found.get("singular_values") or []
    rows = [(f"singular value {place}", shown(value, 3)) for place, value in enumerate(values, start=1)]
    rows += [
        (f"autocorrelation of the {name} residual, one sample apart", shown(value, 3))
        for name, value in (found.get("autocorrelation") or {}).items()
    ]
    if not rows:
        return None
    caption = f"Sensitivity of the residuals to {count(len(found.get('names') or []), 'free coefficient')}"
    return tables.pairs("sensitivity-table", caption, ("what", "value"), rows, numeric=True)
