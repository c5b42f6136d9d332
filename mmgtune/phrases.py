"""Words put together as in a sentence."""

from __future__ import annotations

import math
from collections.abc import Sequence

LARGE = 10.0
"""Variance beyond the noise, over that of the noise, from which an error is told as a multiple of the noise."""

QUANTITIES = {
    "heading": "heading",
    "drift": "drift angle",
    "yaw_rate": "yaw rate r L/U",
    "rudder": "rudder angle",
    "ordered": "time since the last order",
    "speed": "speed",
    "time": "time",
    "north": "position north",
    "east": "position east",
    "wind_angle": "angle of the measured wind",
    "wind_speed": "speed of the measured wind",
}
"""What an error is held against, by the names that records have for it."""


def capital(text: str) -> str:
    """A text as a sentence begins."""
    return text[:1].upper() + text[1:]


def small(text: str) -> str:
    """A sentence as it goes on behind a colon."""
    return text[:1].lower() + text[1:]


def counted(amount: int, noun: str, plural: str = "") -> str:
    """A number with its noun: "1 trial", "8 trials"."""
    return f"{amount} {noun if amount == 1 else plural or noun + 's'}"


def counted_pieces(wholes: Sequence[str], ids: Sequence[str], piece: str = "window") -> str:
    """How many trials there are, in words: "5 trials"; where they were cut into windows "65 windows of 5 trials".

    wholes  of each trial, or window of one, the id of the trial
    ids     their own ids, in the same order
    piece   what one is that is no whole trial
    """
    trials = counted(len(set(wholes)), "trial")
    return trials if list(wholes) == list(ids) else f"{counted(len(ids), piece)} of {trials}"


def in_percent(part: float, counted: bool = False) -> str:
    """A share of a whole in percent, "93 %": never below 0 nor, of what is measured, quite all.

    Whole numbers, and tenths from 99.5 %, where they tell something.

    counted  whether it is a share of things that were counted, of which all may be meant
    """
    part = 1.0 if counted and part >= 1.0 else min(max(part, 0.0), 0.999)
    return f"{100.0 * part:.{0 if part < 0.995 or part == 1.0 else 1}f} %"


def figures(value: float, digits: int = 2) -> str:
    """A number to some figures, without a power of ten up to a million: "110", not "1.1e+02"."""
    return f"{float(f'{value:.{digits}g}'):g}"


def listed(words: Sequence[str], most: int | None = None) -> str:
    """Words as a phrase: "a, b and c"; "" for none.

    most  of more than so many the first are named, and how many more there are: "a, b and 4 more"
    """
    if most is not None and len(words) > most:
        words = [*words[: most - 1], f"{len(words) - most + 1} more"]
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def on_compass(angle: float) -> str:
    """A direction [rad] in whole degrees from north, 0 to 359: "0°", never "360°"."""
    return f"{round(math.degrees(angle)) % 360}°"


def aboard(ahead: float, across: float, digits: int = 3) -> str:
    """How far [m] one place of a ship is from another: "12 m aft and 3 m to starboard"."""
    way, side = "forward" if ahead >= 0.0 else "aft", "to starboard" if across >= 0.0 else "to port"
    return f"{figures(abs(ahead), digits)} m {way} and {figures(abs(across), digits)} m {side}"
