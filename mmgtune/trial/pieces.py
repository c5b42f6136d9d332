"""Long trials cut into windows, each simulated anew from a measured state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .model import Trial
from .schema import ATTRIBUTES
from .smoothing import FEWEST


def windows(trial: Trial, length: float) -> list[Trial]:
    """Consecutive pieces of a trial, each ``length`` [s] long but for the last, which ends with the trial.

    A piece begins at the sample the one before it ends at, or at the first after that without a gap; so every sample
    is compared once.  A rest of fewer than FEWEST samples belongs to the piece before it.  Ids get the second they
    begin at, "run_7@100"; ``part_of`` is the trial's own id.
    """
    whole = np.flatnonzero(np.isfinite(trial.motion).all(axis=1))
    pieces: list[Trial] = []
    at = 0
    while at < len(whole):
        first = int(whole[at])
        at = int(np.searchsorted(trial.t[whole], trial.t[first] + length - 1e-9))
        if len(whole) - at < FEWEST:
            at = len(whole)
        last = int(whole[at]) if at < len(whole) else trial.n_samples - 1
        if last > first + 1:  # two samples are no motion
            pieces.append(_piece(trial, first, last + 1))
    return pieces


def _piece(trial: Trial, first: int, end: int) -> Trial:
    columns = {name: getattr(trial, name)[first:end] for name in ATTRIBUTES.values()}
    columns["t"] = columns["t"] - columns["t"][0]
    return replace(
        trial,
        id=f"{trial.id}@{trial.t[first] - trial.t[0]:g}",
        part_of=trial.part_of or trial.id,
        extra={name: values[first:end] for name, values in trial.extra.items()},
        **columns,
    )
