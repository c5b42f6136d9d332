"""Standard manoeuvres given as orders: a helmsman, a steering gear and the model.

The rudder depends on the motion here, so the inputs of these runs are known as they come.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..arguments import ShipGiven, ship_of
from ..arrays import FloatArray
from ..backends import get_ready_backend
from ..errors import parts_of
from ..model import Model
from ..motions import Motion, sized
from .helmsmen import Helmsman, SpiralOrder, Straight, TurningOrder, Weave, ZigzagOrder, in_radians
from .ordering import order_by_order, serves
from .possible import possible_approach
from .sailing import LONGEST_STEP, Sailing, Watch, sample_of
from .stepping import step_by_step

__all__ = [
    "LONGEST_STEP",
    "Helmsman",
    "Sailing",
    "SpiralOrder",
    "Straight",
    "TurningOrder",
    "Weave",
    "ZigzagOrder",
    "in_radians",
    "possible_approach",
    "run_manoeuvre",
    "run_manoeuvres",
    "sample_of",
]


def run_manoeuvre(
    ship: ShipGiven | Model,
    helmsman: Helmsman,
    *,
    id: str = "run",
    speed: float | None = None,
    n: float | None = None,
    heading: float = 0.0,
    longest: float = 1800.0,
    sample: float = 1.0,
    step: float | None = None,
    engine: Callable[[float], float] | None = None,
    theta: FloatArray | None = None,
) -> Motion:
    """Simulate a manoeuvre given as orders, sampled every ``sample`` seconds.

    ship   object, path or bundled name
    theta  (n_rows, 1) coefficients, those of the profile where None
    The others are those of a ``Sailing``; see ``run_manoeuvres``.  Raises what that raises, and OptionError for a speed
    or revolutions beyond any ship.
    """
    sailing = Sailing(helmsman, id, speed, n, heading, longest, sample, step, engine)
    model = ship if isinstance(ship, Model) else Model(ship_of(ship))
    possible_approach(speed, n, model.L_pp, model.profile.approach, option="n")
    return run_manoeuvres(model, [sailing], theta=theta)[0]


def run_manoeuvres(
    ship: ShipGiven | Model,
    sailings: Sailing | Helmsman | Sequence[Sailing | Helmsman],
    *,
    theta: FloatArray | None = None,
) -> list[Motion]:
    """Simulate manoeuvres given as orders, side by side, each with a helmsman and steps of its own.

    The order goes to every rudder, the revolutions to every propeller, each moved by its actuator in the profile;
    thrusters rest.

    ship      object, path or bundled name
    sailings  one or several; orders alone are carried out from the profile's approach
    theta     (n_rows, n_sailings) coefficients, those of the profile where None
    Raises OptionError for what is no order, and where the profile has no approach condition and none is given.
    """
    parts = parts_of(sailings)
    given: list[Any] = [sailings] if parts is None else parts
    several = [one if isinstance(one, Sailing) else Sailing(one) for one in given]
    if not several:
        return []
    model = ship if isinstance(ship, Model) else Model(ship_of(ship))
    own = np.repeat(model.matrix()[:, :1], len(several), axis=1)
    theta = own if theta is None else sized(theta, "theta", own.shape, "each manoeuvre has coefficients of its own")
    watches = [Watch(sailing, model) for sailing in several]
    backend = get_ready_backend(model)
    quick = [k for k, watch in enumerate(watches) if backend and serves(watch)]
    if backend and quick:
        order_by_order(model, theta[:, quick], [watches[k] for k in quick], backend)
    stepped = [k for k in range(len(watches)) if k not in quick]
    if stepped:
        step_by_step(model, theta[:, stepped], [watches[k] for k in stepped])
    return [watch.motion(model) for watch in watches]
