"""What drives a ship and is logged: the inputs that arrangements of components name.

A further input is one entry here; an arrangement that has a field of that name in its ``Control`` is driven by it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .errors import among

Role = Literal["propeller", "rudder", "thruster"]
"""What an input moves: helmsmen order rudders, engines turn propellers, and effects act on inputs of one role."""


@dataclass(frozen=True)
class Input:
    """One logged input.

    name   column of trial files, and field of the ``Control`` of arrangements that have it
    unit   SI unit
    words  what people call it
    sign   what a positive value does, "" where the words leave no doubt
    """

    name: str
    unit: str
    words: str
    role: Role
    sign: str = ""

    @property
    def meaning(self) -> str:
        """Words with the sign."""
        return f"{self.words}, {self.sign}" if self.sign else self.words

    def to_dict(self) -> dict[str, str]:
        """As records of runs name it."""
        return {"name": self.name, "unit": self.unit, "words": self.words, "role": self.role}

    @property
    def rate_unit(self) -> str:
        """Unit of its rate of change."""
        return {"rad": "rad/s", "1/s": "1/s^2"}[self.unit]


INPUTS: dict[str, Input] = {
    one.name: one
    for one in (
        Input("n", "1/s", "propeller revolutions", "propeller"),
        Input("n_port", "1/s", "port propeller revolutions", "propeller"),
        Input("n_stbd", "1/s", "starboard propeller revolutions", "propeller"),
        Input("delta", "rad", "rudder angle", "rudder", "to starboard: a positive angle turns the ship to starboard"),
        Input("delta_port", "rad", "port rudder angle", "rudder", "turning the ship to starboard"),
        Input("delta_stbd", "rad", "starboard rudder angle", "rudder", "turning the ship to starboard"),
        Input("n_bow", "1/s", "bow thruster revolutions", "thruster", "pushing the bow to starboard"),
        Input("n_stern", "1/s", "stern thruster revolutions", "thruster", "pushing the stern to starboard"),
    )
}
"""Every input there is, by name."""


def meant_by(name: str) -> dict[str, str]:
    """Why and fix of a name that is none of ``INPUTS``: by what people call an input, or by the names there are."""
    meant = [one.name for one in INPUTS.values() if str(name).lower() in (one.role, one.words, one.words.split()[0])]
    if not meant:
        return among(str(name), tuple(INPUTS))
    return {"why": f"inputs have the names of columns of trials: {', '.join(INPUTS)}", "fix": f"write '{meant[0]}'"}
