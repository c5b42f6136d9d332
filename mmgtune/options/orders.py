"""What a user can choose about standard manoeuvres given as orders."""

from __future__ import annotations

from dataclasses import dataclass

from .choice import choice
from .simulation import SimulationOptions

MANOEUVRE = "Manoeuvre"


@dataclass(frozen=True)
class SimulateOptions(SimulationOptions):
    """All choices of a simulation: manoeuvres by orders, or how trials are simulated.

    Angles, speed and revolutions are texts with a unit, as a profile has them; a plain number is in the unit named.
    """

    turn: tuple[str, ...] = choice(
        (),
        'Turning circle at this rudder angle, starboard positive: 35 (deg) or "0.61 rad"; repeatable.',
        panel=MANOEUVRE,
    )
    zigzag: tuple[str, ...] = choice(
        (), "Zigzag RUDDER/HEADING (deg), such as 20/20 or -10/10; repeatable.", panel=MANOEUVRE
    )
    speed: str | None = choice(
        None, 'Approach speed, such as "12 kn". Default: the profile\'s.', unit="m/s", panel=MANOEUVRE
    )
    rpm: str | None = choice(
        None, 'Propeller revolutions: 106 (1/min) or "1.77 1/s". Default: the profile\'s.', panel=MANOEUVRE
    )
