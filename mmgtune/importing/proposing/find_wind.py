"""True and apparent wind, voted on by all logs."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import numpy as np

from ...phrases import figures
from .finder import Finder
from .guess import ASKED, LIKELY, MARK, Guess
from .winds import CLOSES, candidates, steadiness, triangles


def wind(find: Finder) -> None:
    among = find.pool(*[one for one in find.said if one and not one.startswith("wind")])
    named = [k for k in among if find.said[k].startswith("wind")]
    columns = named if len(named) >= 2 else among
    if not 2 <= len(columns) <= 10:
        return
    votes: dict[tuple[Any, Any], list[float]] = defaultdict(list)
    for look in find.looks:
        for one in triangles(look, candidates(look, columns, find.units_said)):
            votes[one.true, one.apparent].append(one.miss)
    full = {key: float(np.median(many)) for key, many in votes.items() if len(many) >= 0.6 * len(find.looks)}
    best = min(full, key=lambda one: full[one], default=None)
    if best is not None and full[best] < CLOSES:
        words = f"true wind, heading and motion make the apparent wind within {figures(100.0 * full[best])} %"
        for wind, tail in zip(best, ("", "_app"), strict=True):
            find.add(Guess(f"wind_speed{tail}", wind.speed, {"unit": wind.unit}, (words,)))
            keys = {"unit": "deg" if wind.degrees else "rad", "direction": wind.points}
            find.add(Guess(f"wind_dir{tail}", wind.direction, keys, (words, f"directions it comes {wind.points}")))
        return
    for tail in ("", "_app"):
        _named_wind(find, tail)


def _named_wind(find: Finder, tail: str) -> None:
    """One wind, by its names; how it counts, and whether it is the true one, by how steady it is."""
    said = [next((k for k in find.pool() if find.said[k] == f"wind_{what}{tail}"), None) for what in ("speed", "dir")]
    speed, direction = said
    if speed is None or direction is None:
        return
    pair = speed, direction
    steady: dict[tuple[str, str], list[float]] = defaultdict(list)
    unit_asked = not find.units_said[speed]
    every = [
        [one for one in candidates(look, pair, find.units_said) if (one.speed, one.direction) == pair]
        for look in find.looks
    ]
    degrees = any(one.degrees for among in every for one in among)
    for look, among in zip(find.looks, every, strict=True):
        for one in among:
            if one.degrees == degrees and one.unit == (find.units_said[speed] or "m/s"):
                for kind, size in steadiness(look, one).items():
                    steady[kind, one.points].append(size)
    found = {key: float(np.median(many)) for key, many in steady.items()}
    if not found:
        return
    speed_unit = find.units_said[speed] or f'{MARK} "m/s" or "kn": which is {find.shown(speed)} in?'
    best = min(found, key=lambda one: found[one])
    kind_named = "apparent" if tail else "true"
    words = [f"its name says {kind_named} wind" if tail else "its name says wind"]
    kind = kind_named
    others = [size for (other, _), size in found.items() if other != best[0]]
    # Read wrongly the wind seems to turn with the ship.
    if not tail and best[0] == "apparent" and min(others, default=1.0) > 2.0 * found[best]:
        kind = "apparent"
        words.append(
            f"apparent: the true wind it makes is steady within {figures(100.0 * found[best])} %, "
            f"read as true within {figures(100.0 * min(others))} %"
        )
    points = f'{MARK} "from" or "to": does it say where the wind comes from, or where it goes?'
    senses = {way: found.get((kind, way), 1.0) for way in ("from", "to")}
    if kind == "apparent" and max(senses.values()) > 2.0 * min(senses.values()):
        points = min(senses, key=lambda one: senses[one])
        words.append(f"directions it comes {points}, as the true wind is steadier then")
    asked = points.startswith(MARK)
    end = "_app" if kind == "apparent" else ""
    find.add(Guess(f"wind_speed{end}", speed, {"unit": speed_unit}, tuple(words), ASKED if unit_asked else LIKELY))
    keys = {"unit": "deg" if degrees else "rad", "direction": points}
    find.add(Guess(f"wind_dir{end}", direction, keys, tuple(words), ASKED if asked else LIKELY))
