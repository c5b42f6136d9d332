"""What is known of a ship before any test: main dimensions, propeller, rudder, approach speed; a small TOML file."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from .. import limits
from ..components import ABOVE_WATER, AT_LEAST_0, SHIP, Field
from ..errors import Problem, ProfileError
from ..physics.constants import GRAVITY
from ..physics.quantities import ABOVE_WATER as GEOMETRY
from ..profile.possible import limits_in_words, out_of_proportion
from ..profile.reading import APPROACH, IDENTIFIER, STEERING_GEAR
from ..resources import must_be_name, particulars, particulars_names, taken
from ..toml_reading import TomlReader, toml_of

SCHEMA = 1
POINTS = 50
"""Points an open-water curve may have."""

_SHIP = SHIP.fields
FIELDS: dict[str, dict[str, Field]] = {
    "particulars": {
        **{name: _SHIP[name] for name in ("L_pp", "B", "d")},
        "C_b": Field("block coefficient", low=0.3, high=1.0),
        "rho": _SHIP["rho"],
        "x_G": _SHIP["x_G"],
        "k_zz_": _SHIP["k_zz_"],
        "trim": Field("trim by the stern", "m"),
        "C_M": Field("midship section coefficient", low=0.5, high=1.0),
        "C_WP": Field("waterplane coefficient", low=0.4, high=1.0),
        "lcb": Field("centre of buoyancy forward of midship, in % of L_pp", low=-10.0, high=10.0),
        "C_st": Field("shape of the stern: -25 pram, -10 V, 0 normal, 10 U", low=-30.0, high=15.0),
        "A_BT": Field("transverse area of the bulb", "m^2", low=AT_LEAST_0, high=500.0),
        "h_B": Field("centre of the bulb above the keel", "m", low=AT_LEAST_0, high=30.0),
        "A_T": Field("immersed area of the transom at rest", "m^2", low=AT_LEAST_0, high=1000.0),
    },
    "propeller": {
        "D_P": Field("propeller diameter", "m", low=0.0, high=20.0),
        "pitch_": Field("propeller pitch over diameter", low=0.2, high=2.0),
        "area_ratio": Field("expanded blade area over disk area", low=0.1, high=1.5),
        "blades": Field("number of blades", low=1.5, high=7.5),
        "J": Field("advance ratios of an open-water curve", table=POINTS),
        "K_T": Field("thrust coefficients of an open-water curve", table=POINTS),
    },
    "rudder": {
        "A_R": Field("rudder area", "m^2", low=0.0, high=500.0),
        "H_R": Field("rudder span", "m", low=0.0, high=30.0),
        "x_R_": Field("longitudinal position of the rudder, over L_pp", low=-1.0, high=0.0),
    },
    "steering_gear": STEERING_GEAR,
    "approach": APPROACH,
    "above_water": {name: ABOVE_WATER.fields[name] for name in GEOMETRY},
}
"""What a file of particulars may say, by section; units as in a profile."""

NEEDED = {"particulars": ("L_pp", "B", "d", "C_b"), "approach": ("speed",)}
QUESTIONS = (
    *(("particulars", name) for name in ("L_pp", "B", "d", "C_b")),
    ("approach", "speed"),
    ("approach", "n"),
    ("propeller", "D_P"),
    ("propeller", "pitch_"),
    ("rudder", "A_R"),
    ("rudder", "H_R"),
)
"""What is asked of somebody at a terminal; answers to those not in NEEDED may be empty."""


@dataclass(frozen=True, eq=False)
class Particulars:
    """What is known of a ship.

    values  {section: {name: value in the unit of its field}}, only what was given
    curve   points of an open-water curve: advance ratios and thrust coefficients, empty where there is none
    sources what a section says of its origin
    sha256  of the text, for the provenance of what is made of it
    """

    name: str
    id: str
    source: str
    values: dict[str, dict[str, float]]
    curve: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    sources: dict[str, str] = field(default_factory=dict)
    path: Path | None = None
    sha256: str = ""

    def get(self, section: str, name: str) -> float | None:
        """A value, None where it was not given."""
        return self.values.get(section, {}).get(name)

    def __getitem__(self, key: tuple[str, str]) -> float:
        return self.values[key[0]][key[1]]


def read_particulars(path: str | Path) -> Particulars:
    """The particulars in a file, or bundled under a name.  Raises ProfileError with everything wrong in them."""
    must_be_name(path, "file of particulars", ProfileError)
    path = taken(path, Path(path).exists(), particulars() / f"{path}.toml") or Path(path)
    try:
        text = limits.text(path, limits.PROFILE_BYTES, ProfileError)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or "it is not UTF-8 text"
        fix = f"give a TOML file with [ship], [particulars], [approach], or one of: {', '.join(particulars_names())}"
        raise ProfileError(Problem("the particulars cannot be read", str(path), why, fix)) from error
    return parse_particulars(text, path)


def parse_particulars(text: str, path: Path | None = None) -> Particulars:
    """The particulars written in ``text``; ``path`` is for messages.  Raises ProfileError."""
    where = str(path) if path else "particulars"
    reader = _Reader(toml_of(text, "the file of particulars", where, ProfileError), text, where)
    found = reader.read(path)
    if reader.problems:
        raise ProfileError(*reader.problems)
    return found


class _Reader(TomlReader):
    """One pass over parsed particulars."""

    def read(self, path: Path | None) -> Particulars:
        self.unknown("", self.data, ("schema", "ship", *FIELDS))
        self.schema(SCHEMA)
        ship = self.section("ship")
        self.unknown("ship", ship, ("name", "id", "source"))
        name, id = self.text_of("ship", ship, "name"), self.text_of("ship", ship, "id")
        if not name:
            self.problem("the ship has no name", "ship", "name", fix='write name = "..." under [ship]')
        if not IDENTIFIER.fullmatch(id):
            self.problem("'ship.id' is missing or no id", "ship", "id", fix='write id = "my_ship" under [ship]')
        values: dict[str, dict[str, float]] = {}
        curve: dict[str, tuple[float, ...]] = {}
        sources: dict[str, str] = {}
        for section, fields in FIELDS.items():
            table = self.section(section, needed=section in NEEDED)
            self.unknown(section, table, ("source", *fields))
            sources[section] = self.text_of(section, table, "source")
            for key, known in fields.items():
                if key not in table:
                    continue
                if known.table:
                    curve[key] = self.points(section, key, table[key])
                elif (number := self.number(section, key, known, table[key])) is not None:
                    values.setdefault(section, {})[key] = number
            for key in NEEDED.get(section, ()):
                if key not in table and section in self.data:
                    unit = "" if fields[key].unit == "-" else f" [{fields[key].unit}]"
                    what = f"'{section}.{key}' is missing ({fields[key].label or key}{unit})"
                    self.problem(what, section, fix=f"add it to [{section}]: no formula gives it")
        found = Particulars(
            name,
            id,
            self.text_of("ship", ship, "source"),
            values,
            (curve.get("J", ()), curve.get("K_T", ())),
            {section: said for section, said in sources.items() if said},
            path,
            hashlib.sha256(self.text.encode()).hexdigest(),
        )
        if not self.problems:
            self.together(found)
        return found

    def section(self, name: str, needed: bool = True) -> dict[str, Any]:
        value = self.data.get(name, {})
        if not isinstance(value, dict) or (needed and name not in self.data):
            self.problem(f"section [{name}] is missing", fix=f"add [{name}]")
            return {}
        return value

    def number(self, section: str, key: str, known: Field, written: Any) -> float | None:
        numbers = self.quantities(section, key, written, known.unit, low=known.low, high=known.high)
        if numbers is None:
            return None
        if len(numbers) != 1:
            self.problem(f"'{section}.{key}' has {len(numbers)} values, not 1", section, key)
            return None
        (number,) = numbers
        low, high = known.low, known.high
        # Infinite numbers and NaN pass no comparison with limits that are there.
        if not (-1e12 < number < 1e12) or (low is not None and number <= low) or (high is not None and number >= high):
            why = f"{known.label or key} must be {limits_in_words(known) or 'finite'}"
            self.problem(f"'{section}.{key}' = {number:g} is impossible", section, key, why, "check number and unit")
            return None
        return number

    def points(self, section: str, key: str, written: Any) -> tuple[float, ...]:
        if isinstance(written, list) and 3 <= len(written) <= POINTS:
            numbers = [self.quantities(section, key, one, "-") for one in written]
            if all(one is not None and len(one) == 1 and abs(one[0]) < 10.0 for one in numbers):
                return tuple(one[0] for one in numbers if one)
        self.problem(
            f"'{section}.{key}' is no list of 3 to {POINTS} numbers", section, key, fix=f"write {key} = [0, ...]"
        )
        return ()

    def together(self, ship: Particulars) -> None:
        """What is impossible about numbers that are possible one by one."""
        of = ship.values["particulars"]
        L, d = of["L_pp"], of["d"]

        def wrong(section: str, key: str, what: str, why: str) -> None:
            self.problem(what, section, key, why, "check number and unit")

        numbers = {f"{section}.{key}": value for section, some in ship.values.items() for key, value in some.items()}
        for one in out_of_proportion(numbers):
            wrong(*one)
        if abs(of.get("trim", 0.0)) > d:
            wrong("particulars", "trim", "the trim is more than the draught", f"d is {d:g} m")
        if of.get("C_M", 1.0) <= of["C_b"]:
            why = "C_b over C_M is the prismatic coefficient, below 1"
            wrong("particulars", "C_M", "the midship section coefficient is not above C_b", why)
        froude = ship["approach", "speed"] / (GRAVITY * L) ** 0.5
        if froude > 0.45:
            why = f"the Froude number would be {froude:.2f}; the formulas are for ships that displace water"
            wrong("approach", "speed", "the approach speed is impossible for this length", why)
        n = ship.get("approach", "n")
        if n is not None and n <= 0.0:
            wrong("approach", "n", "revolutions ahead are positive", "")
        J, K_T = ship.curve
        if len(J) != len(K_T):
            wrong("propeller", "K_T", f"{len(J)} advance ratios and {len(K_T)} thrust coefficients", "they are pairs")
        elif J and (any(b <= a for a, b in pairwise(J)) or J[0] < 0.0):
            wrong("propeller", "J", "advance ratios do not rise from 0 or more", "")
        elif K_T and (K_T[0] <= 0.0 or K_T[-1] >= K_T[0]):
            wrong("propeller", "K_T", "the thrust coefficient does not fall with the advance ratio", "")
        above = ship.values.get("above_water", {})
        if above and len(above) < len(GEOMETRY):
            lacking = ", ".join(name for name in GEOMETRY if name not in above)
            self.problem(f"[above_water] lacks {lacking}", "above_water", fix="give all of it, or leave it out")
