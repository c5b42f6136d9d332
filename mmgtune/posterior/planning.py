"""What drawing particles would do, before it does it, and about how long that takes here."""

from __future__ import annotations

import time

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from ..backends import get_backend, get_ready_backend
from ..fitting.planning import ROUGHLY, Plan
from ..model import Model
from ..options import PosteriorOptions
from ..phrases import counted
from .folder import FILES
from .local import make_windowed
from .room import make_room, tags_of
from .run import require_some
from .sizing import left_out_of

SLOPES = (8, 40)
"""Times that the slopes of everything are worked out, or as much time is taken, for each part of the trials left out,
from few to many."""


def plan_posterior(profile: ShipGiven, trials: TrialsGiven, options: PosteriorOptions) -> Plan:
    """What drawing particles would do.  Raises OptionError and TrialError for what it would refuse."""
    ship, data = ship_of(profile), trials_of(trials)
    chosen = [data.trials[name] for name in data.tune]
    require_some(chosen)
    room = make_room(ship, size=options.room, without=options.without)
    groups, parts = left_out_of(chosen) if options.leave_out else ((), [])
    backend, integrator = get_backend(options.backend), options.make_integrator()
    tried = backend.name != "compiled" or get_ready_backend(Model(room.profile)) is not None
    if tried:
        windowed = make_windowed(room, chosen, backend, integrator)
        began = time.perf_counter()
        windowed.linearised(np.zeros(len(room)))
        each = time.perf_counter() - began
    else:
        steps = sum(trial.n_samples for trial in chosen) * len(integrator.tableau[0]) * integrator.substeps
        each = ROUGHLY * steps * (len(room) + 1)
    left = f"{', '.join(groups)}, and parts of these: {counted(len(parts), 'part')} in all" if parts else "nothing"
    lines = (
        f"profile   {ship.name} ({ship.path})",
        f"trials    {', '.join(data.tune)} ({data.path})",
        f"room      {counted(len(room), 'number')}: coefficients, and {', '.join(tags_of(room))}",
        f"left out  in turn: {left}",
        f"draws     {counted(options.particles, 'particle')}, seed {options.seed}",
        f"runs      {options.integrator}, back end {backend.name}",
    )
    low, high = (each * n * (2 + len(parts)) for n in SLOPES)
    return Plan(lines, (low, high), FILES, tried)
