"""What particulars leave out, by rules of thumb: each value with the rule it comes from, an assumption."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ..units import DEG
from .particulars import Particulars


@dataclass(frozen=True)
class Known:
    """A value of a ship; rule says where it comes from if it was not given, "" if it was."""

    value: float
    rule: str = ""


class Complete:
    """Particulars with everything: given, or by a rule."""

    def __init__(self, ship: Particulars):
        self.ship = ship
        self.known: dict[tuple[str, str], Known] = {}
        for (section, name), (rule, value) in RULES.items():
            given = ship.get(section, name)
            self.known[section, name] = Known(given) if given is not None else Known(value(self), rule)

    def __call__(self, section: str, name: str) -> float:
        """A value in the unit of its field."""
        found = self.known.get((section, name))
        return found.value if found else self.ship[section, name]

    def rule(self, section: str, name: str) -> str:
        """Where a value comes from that was not given."""
        found = self.known.get((section, name))
        return found.rule if found else ""


def _rudder_area(of: Complete) -> float:
    L, B, d = (of("particulars", name) for name in ("L_pp", "B", "d"))
    return 0.01 * L * d * (1.0 + 25.0 * (B / L) * (B / L))


def _span(of: Complete) -> float:
    return min(0.85 * of("particulars", "d"), math.sqrt(1.8 * of("rudder", "A_R")))


def _lcb(of: Complete) -> float:
    x_G = of.ship.get("particulars", "x_G")
    return 100.0 * (x_G or 0.0) / of("particulars", "L_pp")


RULES: dict[tuple[str, str], tuple[str, Callable[[Complete], float]]] = {
    ("particulars", "rho"): ("sea water", lambda _: 1025.0),
    ("particulars", "lcb"): ("above or below the centre of gravity, else midship", _lcb),
    ("particulars", "x_G"): (
        "the centre of buoyancy, on even keel",
        lambda of: 0.01 * of("particulars", "lcb") * of("particulars", "L_pp"),
    ),
    ("particulars", "k_zz_"): ("usual for the MMG model", lambda _: 0.25),
    ("particulars", "trim"): ("even keel", lambda _: 0.0),
    ("particulars", "C_M"): (
        "Kerlen 1970, 1.006 - 0.0056 C_b^-3.56",
        lambda of: max(1.006 - 0.0056 * of("particulars", "C_b") ** -3.56, of("particulars", "C_b") + 0.01),
    ),
    ("particulars", "C_WP"): ("(1 + 2 C_b) / 3", lambda of: (1.0 + 2.0 * of("particulars", "C_b")) / 3.0),
    ("particulars", "C_st"): ("normal sections", lambda _: 0.0),
    ("particulars", "A_BT"): ("no bulb", lambda _: 0.0),
    ("particulars", "h_B"): ("no bulb", lambda of: 0.4 * of("particulars", "d")),
    ("particulars", "A_T"): ("transom clear of the water", lambda _: 0.0),
    ("propeller", "D_P"): (
        "0.395 d + 1.3 m, bulk carriers and tankers",
        lambda of: 0.395 * of("particulars", "d") + 1.3,
    ),
    ("propeller", "area_ratio"): ("usual", lambda _: 0.55),
    ("propeller", "blades"): ("usual", lambda _: 4.0),
    ("rudder", "A_R"): ("DNV minimum, L d / 100 (1 + 25 (B/L)^2)", _rudder_area),
    ("rudder", "H_R"): ("aspect ratio 1.8, at most 0.85 d", _span),
    ("rudder", "x_R_"): ("at the aft perpendicular", lambda _: -0.5),
    ("steering_gear", "max_angle"): ("usual", lambda _: 35.0 * DEG),
    ("steering_gear", "rate"): (
        "SOLAS II-1/29: 35 deg to 30 deg on the other side in 28 s",
        lambda _: 2.32 * DEG,
    ),
}
"""Rules in the order in which they need each other."""
