"""Units that no name says: what speaks for those that are taken, and positions whose unit their speed contradicts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ... import units
from ...arrays import FloatArray
from .finder import Finder
from .guess import ASKED, LIKELY, MARK, SURE, Guess
from .look import Look
from .words import LOG_SPEED

SPEEDS = ("u", "sog", LOG_SPEED)
"""What names say of columns that hold the speed along the track, or nearly so."""
USUAL = ("m/s", "kn", "km/h")
"""Units of speed where no name says one, the likeliest first."""
STEADY = 0.2
"""Spread of the ratio of two speeds, over its median, up to which the one is the other in another unit."""
FITS, SAME = 0.08, 0.05
"""How far that ratio may be from 1 where units are right, and from that of two units which are taken for others."""


def say_units(find: Finder) -> None:
    """Say of each column whose unit nothing in the log says how it was taken, with the numbers that speak for it."""
    for name, guess in list(find.guesses.items()):
        unit = guess.keys.get("unit")
        if guess.column is None or not isinstance(unit, str) or unit.startswith(MARK) or _is_said(find, guess.column):
            continue
        words, confidence = _TOLD.get(name, _size)(find, guess, unit)
        if words:
            lower = LIKELY if guess.confidence == SURE and confidence == LIKELY else guess.confidence
            evidence = (*guess.evidence, f"no unit is said: {words}")
            find.guesses[name] = replace(guess, evidence=evidence, confidence=lower)


def other_length(find: Finder, looks: Sequence[Look], columns: Sequence[int]) -> tuple[str, str]:
    """The unit of length in which positions without a unit agree with a speed that is logged, and why it is not m; ""
    where they agree in m, or no speed tells.

    columns  of the position
    """
    if any(_is_said(find, k) for k in columns):
        return "", ""
    for k in (k for k in find.numeric if find.said[k] in SPEEDS and k not in columns):
        ratio = _ratio(looks, k, lambda look: look.speed)
        if ratio is None:
            continue
        speeds = {one: units.factors("m/s")[one] for one in ([find.units_said[k]] if find.units_said[k] else USUAL)}
        if any(abs(np.log(ratio * factor)) < FITS for factor in speeds.values()):
            continue
        found = [
            (abs(np.log(ratio * factor / size)), length, speed)
            for length, size in units.factors("m").items()
            for speed, factor in speeds.items()
            if length != "m"
        ]
        off, length, speed = min(found)
        if off < SAME:
            in_speed = speed if find.units_said[k] else f"{speed}, which no name says either"
            times = _times(1.0 / (ratio * speeds[speed]))
            return length, f"in m the track is {times} as fast as {find.shown(k)} in {in_speed}, in {length} as fast"
    return "", ""


def asked_length(guess: Guess, unit: str, why: str) -> Guess:
    """A position whose unit its speed contradicts, as a question."""
    keys = {**guess.keys, "unit": f'{MARK} "{unit}" or "m": no unit is said; {why}'}
    return replace(guess, keys=keys, confidence=ASKED)


def _is_said(find: Finder, k: int) -> bool:
    known = find.units_said[k] or find.units_wrong.get(k) or any(one.units[k] for one in find.samples)
    return bool(known) or k in find.first.written or k in find.own_units or k in find.ddmm


def _ratio(looks: Sequence[Look], k: int, of: Callable[[Look], FloatArray]) -> float | None:
    """How many times something seen of the motion a column is; None where that is not steady."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = [look.mean(k)[fast] / of(look)[fast] for look in looks if (fast := _fast(look)).sum() > 8]
    every = np.concatenate(ratios) if ratios else np.zeros(0)
    every = every[np.isfinite(every)]
    if len(every) < 8:
        return None
    low, middle, high = np.percentile(every, [10.0, 50.0, 90.0])
    return float(middle) if middle > 0.0 and high - low < 2.0 * STEADY * middle else None


def _fast(look: Look) -> Any:
    return np.isfinite(look.speed) & (look.speed > 0.5 * look.usual_speed)


def _position(find: Finder, guess: Guess, unit: str) -> tuple[str, str]:
    partner = find.guesses.get("y" if guess.quantity == "x" else "x")
    if partner is not None and partner.column is not None and _is_said(find, partner.column):
        return f"{unit}, as {find.shown(partner.column)} says", SURE
    for name in ("sog", "u"):
        speed = find.guesses.get(name)
        if speed is None or speed.column is None or str(speed.keys.get("unit", MARK)).startswith(MARK):
            continue
        ratio = _ratio(find.looks, speed.column, lambda look: look.speed)
        if ratio is not None:
            said = str(speed.keys["unit"])
            times = _times(1.0 / (ratio * units.factors("m/s")[said]))
            also = "" if _is_said(find, speed.column) else ", of which no unit is said either"
            return (
                f"in {unit} the track is {times} as fast as {find.shown(speed.column)} in {said}{also}",
                SURE,
            )
    if not find.looks:
        return f"{unit} is the usual one", LIKELY
    return f"{unit} is the usual one, and no speed is logged that would show another", LIKELY


def _heading(find: Finder, _: Guess, unit: str) -> tuple[str, str]:
    psi = find.guesses["psi"].column
    turned, course = [], []
    for look in find.looks:
        way = np.arctan2(look.east, look.north)
        both = np.isfinite(way) & np.isfinite(look.psi)
        if both.sum() > 8:
            turned.append(float(np.std(look.mean(psi)[both] if psi is not None else look.psi[both])))
            course.append(float(np.std(np.unwrap(way[both]))))
    if not course or not np.median(course) > 0.0:
        return f"{unit} is taken", LIKELY
    size = float(np.median(turned) / np.median(course))
    return _either(size, "rad", unit, "it turns", "as far as the course"), SURE


def _speed(find: Finder, guess: Guess, unit: str) -> tuple[str, str]:
    ratio = None if guess.column is None else _ratio(find.looks, guess.column, lambda look: look.speed)
    if ratio is None:
        return f"{unit} is taken", guess.confidence
    return _either(ratio, "m/s", unit, "it is", "the speed of the track"), guess.confidence


def _rate(find: Finder, guess: Guess, unit: str) -> tuple[str, str]:
    sizes = []
    for look in find.looks:
        mean = look.mean(guess.column or 0)
        both = np.isfinite(mean) & np.isfinite(look.rate)
        if both.sum() > 8 and np.any(look.rate[both]):
            sizes.append(float(np.std(mean[both]) / np.std(look.rate[both])))
    if not sizes:
        return f"{unit} is taken", guess.confidence
    return _either(float(np.median(sizes)), "rad/s", unit, "it is", "the slope of the heading"), guess.confidence


def _times(ratio: float) -> str:
    return f"{f'{ratio:#.3g}'.rstrip('.')} times"


def _either(size: float, kind: str, unit: str, verb: str, of: str) -> str:
    """How large a column is in its unit, and in SI where that is another one."""
    known = units.factors(kind)
    other = kind if unit != kind else {"rad": "deg", "m/s": "kn", "rad/s": "deg/s"}[kind]
    return f"in {unit} {verb} {_times(size * known[unit])} {of}, in {other} {_times(size * known[other])}"


def _size(find: Finder, guess: Guess, unit: str) -> tuple[str, str]:
    """Of others the size is what there is; time and revolutions say already how their unit was found."""
    if guess.quantity in ("t", "n", "n_port", "n_stbd", "v", "latitude", "longitude") or guess.column is None:
        return "", guess.confidence
    values = np.concatenate([one.numbers[guess.column] for one in find.samples])
    if not np.isfinite(values).any():
        return f"{unit} is taken", guess.confidence
    return f"{unit} is taken, in which it is {np.nanmax(np.abs(values)):.3g} at most", guess.confidence


_TOLD: dict[str, Callable[[Finder, Guess, str], tuple[str, str]]] = {
    "x": _position, "y": _position, "psi": _heading, "u": _speed, "sog": _speed, "r": _rate,
}  # fmt: skip
