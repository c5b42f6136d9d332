"""What names say where behaviour does not, digits to be recovered, and what is asked for."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np

from ... import units
from ...inputs import INPUTS
from ..cells.digits import print_step
from ..formats.sides import takes_side
from ..maps.quantities import known_quantity, meaning, quantity_of
from .finder import FEW_DIGITS, Finder
from .guess import ASKED, LIKELY, MARK, Guess
from .joined import is_whole
from .misnamed import agrees


def by_name(find: Finder) -> None:
    """What behaviour did not show and names say."""
    for k, name in enumerate(find.said):
        if k in find.used or k not in find.numeric or not name or name in find.guesses or quantity_of(name) is None:
            continue
        if _makes_no_sense(find, name, k):
            continue
        quantity = known_quantity(name)
        own: dict[str, Any] = {}
        said = find.units_said[k] or _usual_unit(name)
        known = units.factors(quantity.unit)
        if k not in find.first.written:
            short = [one for one in ("m", "m/s", "kn", "deg", "rad", "rpm", "rps", "deg/s", "deg/min") if one in known]
            options = " or ".join(f'"{one}"' for one in short)
            own["unit"] = said if said in known else f"{MARK} {options}: which is {find.shown(k)} in?"
        words = ["by its name alone: the motion does not show it"]
        if quantity.points:
            own["direction"] = f'{MARK} "from" or "to": does it say where it comes from, or where it goes?'
        if find.says_side(k) and takes_side(name):
            own["positive"] = quantity.positive[0]
            words.append("its cells say the side")
        elif name in INPUTS and INPUTS[name].role == "rudder":
            own["positive"] = f'{MARK} "starboard" or "port": to which side does a positive angle turn the ship?'
        elif name == "r":
            own["positive"] = f'{MARK} "starboard" or "port": to which side is it positive?'
        asked = any(str(one).startswith(MARK) for one in own.values())
        find.add(Guess(name, k, own, tuple(words), ASKED if asked else LIKELY))


def whole_degrees(find: Finder) -> None:
    """Say where latitude or longitude is whole degrees only, and which column may hold the minutes."""
    for name in ("latitude", "longitude"):
        guess = find.guesses.get(name)
        if guess is None or guess.column is None:
            continue
        named = [k for k, word in enumerate(find.said) if word == name or k == guess.column]
        minutes = [k for k in named if re.search(r"min(ute)?s?\b|'|′", find.first.names[k].lower())]
        whole = [k for k in named if k not in minutes and is_whole(find, k)]
        if not whole or guess.column not in (whole[0], *minutes):
            continue
        said = f"{find.shown(whole[0])} holds whole degrees only, by which the position does not change"
        if minutes:
            said += f": the minutes are in {find.shown(minutes[0])}"
        find.notes.append(f'{said}; a map says where they are with minutes = "..." beside the column')
        find.guesses[name] = replace(guess, confidence=ASKED)


def _makes_no_sense(find: Finder, name: str, k: int) -> bool:
    """Whether a quantity that a name speaks of contradicts what was found, or is of no use alone."""
    have = set(find.guesses)
    named = {find.said[k] for k in find.numeric if k not in find.used} | have
    if name in ("x", "y"):
        return bool({"latitude", "longitude"} & named)
    if name in ("latitude", "longitude"):
        return "x" in have
    if name in ("u", "v", "sog", "cog") and find.looks and agrees(find, k):
        return True  # what is known already
    if name in ("u", "v", "sog", "cog") and find.looks:
        find.notes.append(
            f"{find.shown(k)} is called {meaning(name).split(',')[0]}, and contradicts the positions: it is left out"
        )
        return True
    if name in ("sog", "cog"):
        return not {"sog", "cog"} <= named or "u" in named
    if name == "r" and find.looks:
        find.notes.append(f"{find.shown(k)} is called yaw rate, and contradicts the heading: it is left out")
        return True
    return (name == "delta" and "delta_port" in have) or (name == "n" and "n_port" in have)


def _usual_unit(name: str) -> str:
    """The unit of a quantity where only one is usual."""
    return {"latitude": "deg", "longitude": "deg", "x": "m", "y": "m", "depth": "m", "wave_height": "m"}.get(name, "")


def few_digits(find: Finder) -> None:
    """Positions and headings that are printed more coarsely than the ship moves from row to row."""
    for name, way in (("x", "print-resolution"), ("y", "print-resolution"), ("psi", "yaw-rate")):
        guess = find.guesses.get(name)
        if guess is None or guess.column is None or guess.column in find.first.written:
            continue
        coarse = []
        for sample in find.samples:
            values = sample.numbers[guess.column]
            values = values[np.isfinite(values)]
            steps, digits = print_step(values)
            if digits and digits <= FEW_DIGITS and len(values) > 20:
                moved = float(np.mean(np.abs(np.diff(values))))
                same = float(np.mean(np.diff(values) == 0.0))
                coarse.append((digits, float(np.nanmax(steps)), same, moved))
        rate = find.guesses.get("r")
        if len(coarse) < 0.5 * len(find.samples) or np.median([one[2] for one in coarse]) < 0.3:
            continue
        if name == "psi" and (rate is None or str(rate.keys.get("positive", MARK)).startswith(MARK)):
            continue
        said = f"printed with {coarse[0][0]} digits, in steps of up to {coarse[0][1]:.3g} {guess.keys.get('unit', '')}"
        find.as_printed[name] = guess, said
        find.guesses[name] = replace(
            guess, keys={**guess.keys, "recover": way}, evidence=(*guess.evidence, f"{said}: recovered")
        )


def missing(find: Finder) -> None:
    """Questions for what a trial needs and no column was found to be."""
    have = set(find.guesses)
    # One half of a position asks for the other one.
    for name in ("latitude", "longitude") if {"latitude", "longitude"} & have else ("x", "y"):
        find.guesses.setdefault(name, _asked(name))
    for name, pair in (("psi", ()), ("n", ("n_port", "n_stbd")), ("delta", ("delta_port", "delta_stbd"))):
        if name not in have and not (pair and set(pair) <= have):
            find.guesses[name] = _asked(name)


def _asked(name: str) -> Guess:
    item = INPUTS.get(name)
    more = ', or value = "1.5 rps" where it is constant' if item is not None and item.unit == "1/s" else ""
    more = ', or value = "0 deg" where it is constant' if item is not None and item.unit == "rad" else more
    holds = meaning(name) if name in ("x", "y") else meaning(name).split(",")[0]
    question = f"{MARK} the name or number of the column that holds {holds}{more}"
    return Guess(name, None, {"column": question}, ("no column was found to be it",), ASKED)
