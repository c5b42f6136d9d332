"""Numbers, units and names as a naval architect reads them."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .. import phrases
from ..manoeuvres.named import BY_KEY
from ..options import in_flags
from ..phrases import LARGE, listed
from ..units import DEG, shown_in

MINUS = "\u2212"
NONE = "\u2013"
UNIT_PERCENT = "\u00a0%"
LITTLE = 0.02
"""Variance over that of the noise up to which none is beyond it."""
_MARKUP = re.compile(r"[<>&]")
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ud800-\udfff\ufffe\uffff]")


@dataclass(frozen=True)
class Channel:
    """A measured or simulated quantity: words, the unit people read, the factor to it from SI, and its resolution."""

    name: str
    words: str
    unit: str
    factor: float
    decimals: int

    @property
    def title(self) -> str:
        """Words with the unit."""
        return f"{self.words} [{self.unit}]"


CHANNELS: Mapping[str, Channel] = {
    channel.name: channel
    for channel in (
        Channel("x", "position north", "m", 1.0, 2),
        Channel("y", "position east", "m", 1.0, 2),
        Channel("psi", "heading", "deg", 1.0 / DEG, 2),
        Channel("u", "surge velocity", "m/s", 1.0, 3),
        Channel("v_m", "sway velocity", "m/s", 1.0, 3),
        Channel("r", "yaw rate", "deg/s", 1.0 / DEG, 3),
    )
}
"""The motions of a ship; what drives her differs from ship to ship, and records name it."""

OVER_TIME = ("psi", "u", "v_m", "r")
"""Motions shown over time; positions are seen in the tracks."""

ROLES = {"tune": "tuned on", "test": "test", "other": "not used", "left-out": "left out"}
"""Trials by what they are to a fit, beside their names."""

TRIALS_OF_ROLE = {"test": "test trials", "left-out": "trials left out in turn", "tune": "trials tuned on"}
"""Trials by what they are to a fit, in sentences; those not tuned on first, as what is said of them counts most."""


def input_channel(name: str, words: str, unit: str) -> Channel:
    """An input of a ship as people read it."""
    shown, factor = shown_in(unit)
    return Channel(
        name, _MARKUP.sub("", clean(words)), _MARKUP.sub("", clean(shown)), factor, 1 if shown == "rpm" else 2
    )


def count_of_trials(rows: Sequence[Mapping[str, Any]]) -> str:
    """How many trials rows of ``trial_results`` are of, "5 trials" or "65 windows of 5 trials"; records of older
    versions do not say what a window is of."""
    ids = [str(row["id"]) for row in rows]
    return phrases.counted_pieces([row.get("part_of") or row["id"] for row in rows], ids, piece_of(rows))


def piece_of(rows: Sequence[Mapping[str, Any]]) -> str:
    """What rows that are not of whole trials are of: "window", or "part" where runs were divided otherwise."""
    return next((str(row["piece"]) for row in rows if "piece" in row), "window")


_SUFFIXES = (
    ("_deg_per_s", "deg/s"), ("_m_per_s", "m/s"), ("_deg", "deg"), ("_kn", "kn"), ("_m", "m"), ("_s", "s"),
)  # fmt: skip


_CIRCUMSTANCES = re.compile(
    r"L_pp|order|execute|rudder_|heading_angle|approach_|drift_|residual_rate|steady_heading|direction|.*_over_L$"
)


PRINCIPAL = (
    "advance_m", "transfer_m", "tactical_diameter_m", "steady_diameter_m", "steady_speed_m_per_s",
    "steady_drift_angle_deg", "time_90_s", "overshoot_1_deg", "overshoot_2_deg", "initial_turning_time_s", "period_s",
)  # fmt: skip
"""The indices a manoeuvre is first judged by; the others stand in the table of every trial."""


MODEL_LETTERS = 40
"""Letters of a model's name that a page has room for."""

_FILES = (".toml", ".safetensors")
"""Endings of files that hold a model."""


def is_index(key: str) -> bool:
    """Whether an index says how the ship manoeuvres, rather than how the trial was run, or the same in lengths."""
    return _CIRCUMSTANCES.match(key) is None


def number(value: Any) -> float | None:
    """The value as a finite float, or None where there is none."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return float(value)


def coefficient_text(value: Any) -> str:
    """A coefficient's number, which is infinite where JSON has null: an effect that is absent only there."""
    return "∞" if value is None else shown(value)


def shown(value: Any, digits: int = 4) -> str:
    """A number with ``digits`` significant digits, a true minus and thin thousands; a dash where there is none."""
    size = number(value)
    if size is None:
        return NONE
    text = f"{size:.{digits}g}"
    if "e" in text and 1.0 <= abs(size) < 1e9:
        text = f"{float(text):.0f}"
    elif "e" in text:
        mantissa, exponent = text.split("e")
        text = f"{mantissa}e{int(exponent)}"
    elif float(text) != 0.0 and "." not in text and len(text.lstrip("-")) < digits:
        text = f"{size:.{digits - len(text.lstrip('-'))}f}" if size != int(size) else text
    if "e" not in text and "." not in text and len(text.lstrip("-")) > 4:
        text = f"{int(text):,}".replace(",", "\u202f")
    return text.replace("-", MINUS)


def fixed(value: Any, decimals: int) -> str:
    """A number with fixed decimals and a true minus; a dash where there is none."""
    size = number(value)
    if size is None:
        return NONE
    text = f"{size:.{decimals}f}"
    return (text.lstrip("-") if float(text) == 0.0 else text).replace("-", MINUS)


def change(before: Any, after: Any) -> float | None:
    """The relative change in percent, or None where it makes no sense."""
    first, last = number(before), number(after)
    if first is None or last is None or first == 0.0:
        return None
    return 100.0 * (last - first) / abs(first)


def percent(value: float | None) -> str:
    """A signed change in percent, or a dash; of what grew more than tenfold, how many times it is what it was.

    What falls by nearly all says 99.9 and never 100, as sentences do: nothing measured falls by all.
    """
    if value is None:
        return NONE
    magnitude = abs(value)
    if value >= 1000.0:
        return f"{shown(value / 100.0 + 1.0, 2)} times"
    if -100.0 < value < -99.9:
        magnitude = 99.9
    text = f"{magnitude:.1f}" if magnitude < 100.0 else f"{magnitude:.0f}"
    if float(text) == 0.0:
        return "0\u00a0%"
    return f"{'+' if value > 0 else MINUS}{text}\u00a0%"


def share(value: Any, counted: bool = False) -> str:
    """A share of a whole as percent, by the rule of ``phrases.in_percent``; a dash where there is none.

    The one way in which sentences, cards and tables write the same result.
    """
    size = number(value)
    return NONE if size is None else phrases.in_percent(size, counted).replace(" %", UNIT_PERCENT)


def span(low: Any, high: Any) -> str:
    """An interval of shares; one number where both ends are written alike, and "or more" of the highest written."""
    first, last = share(low), share(high)
    if first != last:
        return f"{first.removesuffix(UNIT_PERCENT)} to {last}"
    return f"{first} or more" if first == share(1.0) else f"{first}, either end"


def within_noise(value: Any) -> bool:
    """Whether a variance beyond that of the noise, as a share of it, is known and too little to be worth a number."""
    size = number(value)
    return size is not None and size < LITTLE


def beyond_noise(value: Any) -> str:
    """Variance beyond that of the noise, as a share of it; where large, how many times the noise the error is."""
    size = number(value)
    if size is None:
        return NONE
    if within_noise(size):
        return "none"
    if size < LARGE:
        return f"{100.0 * size:.0f}\u00a0%"
    return f"{shown(math.sqrt(1.0 + size), 2)} times the noise"


def model_names(names: Sequence[Any]) -> list[str]:
    """What models are called on a page: of a file its folder and name, where they still differ."""
    whole = [clean(name) for name in names]
    ends = ["/".join(name.split("/")[-2:]) if name.endswith(_FILES) else name for name in whole]
    found = [name if len(name) <= MODEL_LETTERS else f"…{name[1 - MODEL_LETTERS :]}" for name in ends]
    return found if len(set(found)) == len(set(whole)) else whole


def clean(text: Any) -> str:
    """Text from a file without control characters, which neither XML nor a terminal can hold."""
    return _CONTROL.sub("\ufffd", str(text))


def sentence(text: Any) -> str:
    """A sentence of the library for a reader of the report: without control characters, options as flags."""
    return in_flags(clean(text))


def index_words(key: str) -> tuple[str, str]:
    """Words and unit of an index of a manoeuvre, from its key: tactical_diameter_m is a tactical diameter in m."""
    if known := BY_KEY.get(key):
        return known.words, unit_words(known.unit)
    for suffix, unit in _SUFFIXES:
        if key.endswith(suffix):
            return clean(key.removesuffix(suffix)).replace("_", " "), unit
    return clean(key).replace("_", " "), ""


def unit_words(unit: Any) -> str:
    """The unit of a coefficient, empty where it has none."""
    return "" if unit in ("prime", "-", "1", "", None) else clean(unit)


def listing(names: list[str], limit: int = 6) -> str:
    """Names as a phrase: "a, b and c", or the first few "and 4 more"."""
    return listed(names, limit) or "none"


_RUN = re.compile(r"(turn|zigzag)_([pm])(\d+(?:\.\d+)?)(?:_(\d+(?:\.\d+)?))?")


def run_words(name: Any) -> str:
    """A manoeuvre by orders in words: turn_p35 is a turn 35° to starboard; other names as they are."""
    if name == "stop":
        return "crash stop"
    found = _RUN.fullmatch(str(name))
    if found is None:
        return clean(name)
    kind, side, rudder, heading = found.groups()
    where = "starboard" if side == "p" else "port"
    if kind == "turn":
        return f"turn {rudder}° to {where}"
    return f"zigzag {rudder}/{heading or rudder}" + ("" if side == "p" else " to port")


count = phrases.counted


def short(name: str) -> str:
    """A coefficient's symbol without its component: hull.R_0 is R_0."""
    return name.rsplit(".", 1)[-1]
