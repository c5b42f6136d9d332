"""Forces of a run's model along its own motions, which reports draw beside the tracks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import FloatArray
from ..errors import MmgtuneError
from ..physics.quantities import STATES
from ..run_files import PROFILE

if TYPE_CHECKING:
    from ..model import Model

    Motion = Mapping[str, FloatArray]

MOST = 40
"""Motions that get forces; of more none does, since they are looked at for what differs between them."""


@dataclass(frozen=True)
class Ship:
    """What a report knows of the ship of a run: her length [m], and her model where there is one."""

    L_pp: float | None = None
    model: Model | None = None

    def with_forces(self, motion: Motion) -> Motion:
        """The motion with X and Y [N] and N [N m] of the model, as they are where nothing is known of the water."""
        from ..motions import breakdown

        if self.model is None or not all(name in motion for name in self.model.inputs):
            return motion
        states, controls = (np.column_stack([motion[name] for name in names]) for names in (STATES, self.model.inputs))
        with np.errstate(all="ignore"):
            total = breakdown(self.model, states, controls).total
        return {**motion, **{axis: np.broadcast_to(getattr(total, axis), len(states)) for axis in "XYN"}}


NO_SHIP = Ship()


def ship_of(folder: Path) -> Ship:
    """The ship whose profile the run wrote; nothing is known where it cannot be read."""
    from ..model import Model
    from ..profile import load_profile

    path = folder / PROFILE
    if not path.is_file():
        return NO_SHIP
    try:
        profile = load_profile(path)
        return Ship(profile.L_pp, Model(profile))
    except MmgtuneError:
        return NO_SHIP
