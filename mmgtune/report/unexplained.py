"""What a diagnosis does not name: traces too small to matter, and where an error lives that nothing explains."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .page import Block, Details, Table, cells
from .wording import CHANNELS, NONE, clean, index_words, shown


def traces(data: Mapping[str, Any]) -> list[Block]:
    """What is statistically there and changes nothing that a user would notice, folded away; nothing without any."""
    listed = data.get("traces") or []
    if not listed:
        return []
    rows = []
    for trace in listed:
        found = trace["contribution"]
        share = found["share_held_out"]
        rows.append(
            cells(
                clean(trace["sentence"]),
                NONE if share is None else f"{100.0 * share:.2g} %",
                _largest(found["error_over_noise"], 100.0, " %", {name: one.words for name, one in CHANNELS.items()}),
                _largest(found["index_changes"], 1.0, "", {}),
            )
        )
    table = Table(
        "traces-table",
        "What is there by the statistics and would not be noticed: share of the error removed on held-out trials, the "
        "largest error it removes in a channel over the variance of its noise, the largest change of an index",
        ("trace", "share removed", "largest in a channel", "largest change of an index"),
        tuple(rows),
        (1,),
    )
    return [Details(f"Traces ({len(listed)}), in no profile", (table,))]


def _largest(values: Mapping[str, float], factor: float, unit: str, words: Mapping[str, str]) -> str:
    """The largest of some values with its name; lengths as a share of them."""
    if not values:
        return NONE
    name = max(values, key=lambda one: values[one])
    told, of = index_words(name) if name not in words else (words[name], "")
    if name not in words and of != "deg":
        factor, unit = 100.0, " %"
    return f"{clean(told)} {shown(factor * values[name], 2)}{unit or (' ' + of)}"
