"""What drives a ship and is logged: the inputs that arrangements of components name.

A further input is one entry here; an arrangement that has a field of that name in its ``Control`` is driven by it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Role = Literal["propeller", "rudder", "thruster"]
"""What an input moves: helmsmen order rudders, engines turn propellers, and effects act on inputs of one role."""


@dataclass(frozen=True)
class Input:
    """One logged input.

    name   column of trial files, and field of the ``Control`` of arrangements that have it
    unit   SI unit
    words  what people call it, with its sign
    """

    name: str
    unit: str
    words: str
    role: Role

    @property
    def rate_unit(self) -> str:
        """Unit of its rate of change."""
        return {"rad": "rad/s", "1/s": "1/s^2"}[self.unit]


INPUTS: dict[str, Input] = {
    one.name: one
    for one in (
        Input("n", "1/s", "propeller revolutions", "propeller"),
        Input("delta", "rad", "rudder angle, to starboard: a positive angle turns the ship to starboard", "rudder"),
        Input("delta_port", "rad", "port rudder angle", "rudder"),
        Input("delta_stbd", "rad", "starboard rudder angle", "rudder"),
        Input("n_bow", "1/s", "bow thruster revolutions", "thruster"),
        Input("n_stern", "1/s", "stern thruster revolutions", "thruster"),
    )
}
"""Every input there is, by name."""
