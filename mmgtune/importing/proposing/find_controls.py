"""Rudder and propeller, voted on by all logs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np

from ...inputs import INPUTS
from ...units import DEG
from .finder import Finder
from .guess import ASKED, LIKELY, MARK, SURE, Guess
from .look import Look
from .orders import TURNS, Shaft, rudders, shafts, side_of_circles
from .words import LOG_SPEED, ORDER, OTHER, ROLL, side_named, turns

WAY = (0.01, 0.04)
"""Ship lengths that ships make with each turn of the propeller."""
HARDLY = 1.6
"""Factor beyond those at which no ship is believed to make so much: the length is guessed from how she turns."""
NEVER = 8.0
"""Factor beyond those at which what turns is no propeller, nor an engine that drives one through a gear."""
GEAR = 1.3
"""Factor between two columns of revolutions, from which one is of what turns before a gear."""


ORDERS_ONLY = "no column holds what was measured, and this one holds orders, which {} follows later"
"""Said of a column that is taken for want of a better one."""

MOTIONS = ("x", "y", "u", "v", "r", "wind_speed", "wind_dir", "wind_speed_app", "wind_dir_app")


def rudder(find: Finder) -> None:
    """The rudder a ship answers to; the one ordered where no other is logged."""
    if not _rudder_among(find, find.pool(ORDER, OTHER, ROLL, "n", "depth", *MOTIONS)):
        _rudder_among(find, find.orders("delta"), ORDERS_ONLY.format("the rudder"))


def _rudder_among(find: Finder, columns: Sequence[int], remark: str = "") -> bool:
    """Take the column of some that a ship answers to most; False where there is none."""
    weights: dict[tuple[int, bool], float] = defaultdict(float)
    sides: dict[int, list[int]] = defaultdict(list)
    strongest: dict[int, tuple[float, str]] = {}
    circles: dict[int, list[tuple[int, int]]] = defaultdict(list)
    names = [name for name, item in INPUTS.items() if item.role == "rudder"]
    for look in find.looks:
        # Degrees with N, S, E or W are no angles of a rudder; S alone would look like one, of the wrong sign.
        pool = [k for k in columns if k not in look.sample.written or remark or find.said[k] in names]
        for one in rudders(look, pool, find.units_said):
            weights[one.column, one.degrees] += one.weight
            if one.evidence.side:
                sides[one.column].append(one.evidence.side)
            if one.circle:
                circles[one.column].append(one.circle)
            if one.weight > strongest.get(one.column, (0.0, ""))[0]:
                strongest[one.column] = one.weight, str(one.evidence)
    for column, turns_of in circles.items():
        if not sides[column] and (side := side_of_circles(turns_of)):
            sides[column] = [side] * len(turns_of)
            strongest[column] = (0.0, f"in {len(turns_of)} turns with it over to one side, some to either")
    named = {k for k, _ in weights if find.said[k] in names}
    pairs = {find.said[k]: k for k in named if find.said[k] != "delta"}
    if len(pairs) == 2:
        for name, k in pairs.items():
            _rudder(find, name, k, weights, sides, strongest, len(named) > 2)
        return True
    ranked = sorted(weights, key=lambda key: -(weights[key] * (6.0 if key[0] in named else 1.0)))
    if not ranked:
        return False
    best = ranked[0][0]
    if best not in named and not sides[best] and find.orders("delta"):
        return False  # what may be anything is no rudder where one is ordered
    rival = next((weights[key] for key in ranked if key[0] != best), 0.0)
    clear = best in named or (weights[ranked[0]] > 1.5 * rival and bool(sides[best]))
    _rudder(find, "delta", best, weights, sides, strongest, clear and not remark, remark)
    return True


def _rudder(
    find: Finder,
    name: str,
    column: int,
    weights: Mapping[tuple[int, bool], float],
    sides: Mapping[int, list[int]],
    strongest: Mapping[int, tuple[float, str]],
    clear: bool,
    remark: str = "",
) -> None:
    degrees = weights.get((column, True), 0.0) >= weights.get((column, False), 0.0)
    own, more = find.unit_of(column, "rad", "deg" if degrees else "rad")
    seen = sides.get(column, [])
    starboard, port = seen.count(1), seen.count(-1)
    words = [f"the ship turns after it: {strongest.get(column, (0.0, 'no evidence'))[1]}"]
    if find.units_said[column] in ("deg", "rad"):
        words.append(f"in {own['unit']}{more}")
    else:
        words.append(f"in {own['unit']} by its size")
    confidence = SURE if clear else LIKELY
    if find.says_side(column):
        own["positive"] = "starboard"
        words.append("its cells say the side")
        if port > starboard:
            words.append("but she turns to the other one: are the sides those of a wheel that turns the other way?")
            confidence = LIKELY
    elif max(starboard, port) > 4 * min(starboard, port):
        own["positive"] = "starboard" if starboard > port else "port"
        words.append(f"positive to {own['positive']} in {max(starboard, port)} of {len(find.looks)} logs")
        if side_named(find.first.names[column]) not in ("", own["positive"]):
            words.append(f"although its name says {side_named(find.first.names[column])}")
            confidence = LIKELY
    elif side := side_named(find.first.names[column]):
        own["positive"] = side
        words.append(f"its name says that it is positive to {side}")
        confidence = LIKELY
    else:
        own["positive"] = f'{MARK} "starboard" or "port": to which side does a positive angle turn the ship?'
        confidence = ASKED
    if remark:
        words.append(remark)
    find.add(Guess(name, column, own, tuple(words), confidence))


def propeller(find: Finder) -> None:
    """The revolutions; those ordered where no others are logged."""
    pool = find.pool(ORDER, OTHER, ROLL, "psi", "sog", "cog", LOG_SPEED, "delta", "depth", "wave_height", *MOTIONS)
    if not _shafts_among(find, pool):
        _shafts_among(find, find.orders("n"), ORDERS_ONLY.format("the shaft"))


def _shafts_among(find: Finder, columns: Sequence[int], remark: str = "") -> bool:
    """Take the column of some that moves most as revolutions do, or one for each side; False where there is none."""
    ranks: dict[int, float] = defaultdict(float)
    per_column: dict[tuple[int, str], list[float]] = defaultdict(list)
    delta = find.guesses.get("delta") or find.guesses.get("delta_port")
    for look in find.looks:
        found = shafts(look, columns, find.units_said, _rudder_angle(look, delta))
        for place, one in enumerate(found):
            named = find.said[one.column].startswith("n") and not _of_another(find, one)
            ranks[one.column] += 1.0 / (1.0 + place) + (2.0 if named else 0.0)
            for unit, way in one.advance.items():
                if np.isfinite(way):
                    per_column[one.column, unit].append(way)
    sides = {side: [k for k in ranks if find.said[k] == side] for side in ("n_port", "n_stbd")}
    among = sides if all(sides.values()) else {"n": list(ranks)} if ranks else {}
    for name, columns in among.items():
        column = max(columns, key=lambda k: ranks[k])
        column, why, clear = _behind_the_gear(find, column, columns, per_column)
        _shaft(find, name, column, ranks, per_column, (*why, *((remark,) if remark else ())), clear)
    return bool(among)


def _of_another(find: Finder, shaft: Shaft) -> bool:
    """Whether revolutions in a unit that is said are those of what no propeller is driven by, as of a turbocharger."""
    way = shaft.advance.get(_unit_said(find, shaft.column), np.nan)
    return bool(way < WAY[0] / NEVER or way > WAY[1] * NEVER)


def _behind_the_gear(
    find: Finder, column: int, columns: Sequence[int], ways: Mapping[tuple[int, str], list[float]]
) -> tuple[int, list[str], bool]:
    """Of columns that turn in proportion to one: that of the shaft, by names or else by the way a ship makes; why; and
    whether that is clear.
    """
    alike = {k: times for k in columns if k != column and (times := _times(find, k, column))}
    if not alike:
        return column, [], True

    def merit(k: int) -> tuple[int, float]:
        said = _unit_said(find, k)
        fits = [float(np.median(many)) for (one, unit), many in ways.items() if one == k and said in ("", unit)]
        return turns(find.first.names[k]), -min((abs(np.log(way / 0.02)) for way in fits if way > 0.0), default=99.0)

    best = max([column, *alike], key=merit)
    others = [k for k in (column, *alike) if k != best]
    second = max(others, key=merit)
    times = _times(find, second, best)
    by_name = merit(best)[0] > merit(second)[0]
    why = "by their names" if by_name else "by the way she makes with each turn"
    words = f"{find.shown(second)} turns {times:.3g} times as fast, on the other side of a gear, {why}"
    return best, [words], by_name or merit(best)[1] > merit(second)[1] + np.log(2.0)


def _times(find: Finder, k: int, other: int) -> float:
    """How many times as fast one column of revolutions turns as another, 0.0 where they do not turn in proportion."""
    if _unit_said(find, k) != _unit_said(find, other):
        return 0.0
    both = np.concatenate([np.stack([look.mean(k), look.mean(other)]) for look in find.looks], axis=1)
    both = both[:, np.isfinite(both).all(axis=0)]
    both = both[:, np.abs(both[1]) > 0.3 * np.abs(both[1]).max(initial=0.0)]
    if both.shape[1] < 8 or not np.abs(both[1]).any():
        return 0.0
    low, usual, high = np.percentile(both[0] / both[1], [10.0, 50.0, 90.0])
    apart = usual > 0.0 and abs(np.log(usual)) > np.log(GEAR)
    return float(usual) if apart and high - low < 0.1 * usual else 0.0


def _unit_said(find: Finder, k: int) -> str:
    return find.units_said[k].replace("1/s", "rps")


def _rudder_angle(look: Look, delta: Guess | None) -> float:
    """Largest usual rudder angle [rad] of a log; that of a turning circle where none is known."""
    if delta is None or delta.column is None:
        return 35.0 * DEG
    values = np.abs(look.windows.columns[delta.column]) * (DEG if delta.keys.get("unit") == "deg" else 1.0)
    return (
        float(np.clip(np.nanpercentile(values, 95.0), 1.0 * DEG, 35.0 * DEG))
        if np.isfinite(values).any()
        else 35.0 * DEG
    )


def _shaft(
    find: Finder,
    name: str,
    column: int,
    ranks: Mapping[int, float],
    ways: Mapping[tuple[int, str], list[float]],
    remarks: Sequence[str] = (),
    clear: bool = True,
) -> None:
    said = _unit_said(find, column)
    fits = {unit: float(np.median(ways[column, unit])) for unit in TURNS if ways.get((column, unit))}
    sizes = {unit: abs(np.log(way / 0.02)) for unit, way in fits.items() if way > 0.0}
    seen = min(sizes, key=lambda one: sizes[one], default="")
    named = find.said[column].startswith("n")
    words = ["its name says so"] if named else ["it stays the same over long times, as revolutions do"]
    confidence = SURE if named and clear else LIKELY
    if said in TURNS:
        unit = said
        words.append(f"in {said}, as its name says")
        if said in fits and not WAY[0] / HARDLY < fits[said] < WAY[1] * HARDLY:
            confidence = LIKELY
            words.append(
                f"but she makes some {fits[said]:.2g} of her length with each turn then, ships {WAY[0]:g} to "
                f"{WAY[1]:g}: is it of an engine before a gear?"
            )
    elif column in find.in_percent:
        unit = "rpm"
    elif seen and sizes[seen] < np.log(12.0) and (named or WAY[0] <= fits[seen] <= WAY[1]):
        unit = seen
        ships = f"ships {WAY[0]:g} to {WAY[1]:g}"
        words.append(f"in {seen}: she makes some {fits[seen]:.2g} of her length with each turn then, {ships}")
    else:
        unit = f'{MARK} "rpm" or "rps": which is {find.shown(column)} in?'
        confidence = ASKED
    values = np.concatenate([look.windows.columns[column] for look in find.looks])
    own = {"unit": unit}
    if np.nanmedian(values) < 0.0:
        own["positive"] = "astern"
        words.append("negative while she goes ahead")
    rivals = [k for k, rank in ranks.items() if k != column and rank > 0.6 * ranks[column]]
    if rivals and confidence == LIKELY:
        words.append(f"{', '.join(find.shown(k) for k in rivals[:3])} might be it too")
    words.extend(remarks)
    find.add(Guess(name, column, own, tuple(words), confidence))
