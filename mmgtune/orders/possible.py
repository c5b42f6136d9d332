"""Approaches that a ship can be asked for."""

from __future__ import annotations

from ..components.speeds import fastest_speed, too_fast
from ..errors import OptionError, Problem
from ..profile import Approach
from ..profile.possible import FASTEST_SHAFT
from ..units import KNOT

FASTER = 5.0
"""Times the revolutions of the profile's approach beyond which no shaft turns: engines have a tenth to spare."""


def possible_approach(
    speed: float | None, n: float | None, L_pp: float, own: Approach | None, *, option: str = "rpm"
) -> None:
    """Raises OptionError for an approach that was ordered and is beyond any ship; None where nothing was.

    own     approach of the profile, None where there is none
    option  that ordered the revolutions
    """
    if speed is not None and (froude := too_fast(speed, L_pp)) is not None:
        why = f"a Froude number of {froude:.2g} with {L_pp:.4g} m between perpendiculars; ships stay below 0.5"
        fix = f"give a speed below {0.5 * fastest_speed(L_pp) / KNOT:.3g} kn, with its unit"
        raise OptionError(Problem(f"the approach speed is {speed / KNOT:.4g} kn", "speed", why, fix))
    most = FASTEST_SHAFT if own is None else FASTER * own.n
    if n is not None and n > most:
        why = "no propeller turns so fast, not even a model's"
        if own is not None:
            why = f"that is {n / own.n:.3g} times the {60.0 * own.n:.4g} rpm of the profile's approach"
        fix = f"give less than {60.0 * most:.4g} rpm, or correct [approach] of the profile"
        if option == "n":
            fix = f"write n={n / 60.0:.4g} for {n:g} rpm: it is in 1/s, and less than {most:.4g}"
        raise OptionError(Problem(f"the revolutions are {60.0 * n:.4g} rpm", option, why, fix))
