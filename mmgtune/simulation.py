"""Simulating trials: what a predictor makes of the inputs a ship was given, and of the forces on the way."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arrays import FloatArray
from .backends import STATES, Integrator, LaneModel
from .manoeuvres import Track, manoeuvre_kind, zigzag_indices
from .manoeuvres.summary import indices_of
from .model import Model
from .physics.mmg import Breakdown
from .physics.quantities import Control, State
from .predictor import Predictor, as_predictor, cases_from, portions
from .profile import ShipProfile
from .trial import Trial
from .units import DEG

ORDERED = re.compile(r"zig-?zag\D*(\d+(?:\.\d+)?)\s*/\s*(\d+(?:\.\d+)?)", re.IGNORECASE)
"""How a trial's manoeuvre names the angles of a zigzag."""


@dataclass(frozen=True, eq=False)
class Motion:
    """A simulated run.

    t         (n_samples,) time [s]
    states    (n_samples, 6) x, y [m], psi [rad], u, v_m [m/s], r [rad/s]
    controls  (n_samples, 2) propeller revolutions [1/s], rudder angle [rad]
    diverged  whether the simulation left the world of ships; its states then mean nothing
    member    of the predictor, from 0
    """

    id: str
    t: FloatArray
    states: FloatArray
    controls: FloatArray
    diverged: bool
    member: int = 0

    def channel(self, name: str) -> FloatArray:
        """One of x, y, psi, u, v_m, r: (n_samples,)."""
        return self.states[:, STATES.index(name)]

    def track(self) -> Track:
        """The run as indices of manoeuvres are computed from it."""
        columns = dict(zip(STATES, self.states.T, strict=True))
        return Track(t=self.t, n=self.controls[:, 0], delta=self.controls[:, 1], **columns)


def simulate(
    ship: Predictor | ShipProfile | Model,
    trials: Sequence[Trial],
    *,
    integrator: Integrator = Integrator(),
    backend: str = "compiled",
) -> list[Motion]:
    """Simulate each trial from its first measured state with its measured inputs.

    integrator  "rk4", or "euler" at the trial's own step as Suyama et al. 2023 do
    backend     "compiled" or "numpy"; they agree to rounding
    -> trial by trial, and of each all members
    Never raises for a run that diverges: it is marked so.
    """
    return list(motions(as_predictor(ship, integrator=integrator, backend=backend), trials))


def motions(predictor: Predictor, trials: Sequence[Trial], offsets: FloatArray | None = None) -> Iterator[Motion]:
    """The same one after the other, so that no more is held than is being looked at.

    offsets  (n_trials, 6) added to the first measured states
    """
    for portion in portions([trial.n_samples for trial in trials], predictor.n_members):
        some = trials[portion]
        start = None
        if offsets is not None:
            start = [trial.motion[0] + own for trial, own in zip(some, offsets[portion], strict=True)]
        found = predictor.predict(cases_from(some, initial=start))
        for i, trial in enumerate(some):
            controls = np.column_stack([trial.n, trial.delta])
            for k in range(predictor.n_members):
                states = np.array(found.states[i, k, : trial.n_samples])  # a copy: a view would hold all of them
                yield Motion(trial.id, trial.t, states, controls, bool(found.diverged[i, k]), k)


def breakdown(ship: ShipProfile | Model, states: FloatArray, controls: FloatArray) -> Breakdown:
    """Forces and intermediates along a run, by the very functions the simulation uses.

    states (n_samples, 6), controls (n_samples, 2) as in ``Motion`` -> Breakdown of arrays (n_samples,).

    Effects of the profile have acted; forces they add are in the total only.  What depends on the past or on measured
    wind is left out: lags count as settled.
    """
    model = ship if isinstance(ship, Model) else Model(ship)
    lanes = LaneModel(model, np.repeat(model.matrix(), len(states), axis=1))
    logged = [Control(*controls.T)]
    control = lanes.moved(logged, logged, None, np.zeros(len(states)))[-1]
    return lanes.breakdown(lanes.unsensed(State(*states.T)), control)


def track_of(trial: Trial) -> Track:
    """A measured trial as indices of manoeuvres are computed from it.  Raises ValueError where it has gaps."""
    columns = dict(zip(STATES, trial.motion.T, strict=True))
    return Track(t=trial.t, n=trial.n, delta=trial.delta, **columns)


def ordered_angles(trial: Trial) -> tuple[float, float] | None:
    """Rudder and check angle [rad] that a zigzag was ordered with, where the trial says so: "zigzag 35/5"."""
    said = ORDERED.search(trial.manoeuvre)
    return (float(said[1]) * DEG, float(said[2]) * DEG) if said else None


def trial_indices(trial: Trial, L_pp: float) -> dict[str, Any]:
    """Manoeuvring indices of a measured trial; empty where gaps forbid them.  L_pp [m]."""
    if np.isnan(trial.motion).any():
        return {}
    track = track_of(trial)
    if manoeuvre_kind(track) == "zigzag":
        return zigzag_indices(track, L_pp, ordered_angles(trial)).to_dict()
    return indices_of(track, L_pp)


def as_trial(ship: ShipProfile, motion: Motion, *, with_forces: bool = False) -> Trial:
    """A simulated run as a trial, labelled generated.

    with_forces  adds forces [N], moments [N m] and intermediates as columns: hull_X, propeller_X, rudder_Y, w_P, ...
    """
    extra: dict[str, FloatArray] = {}
    if with_forces:
        found = breakdown(ship, motion.states, motion.controls)
        parts = {
            "hull": found.hull,
            "propeller": found.propeller.force,
            "rudder": found.rudder.force,
            "total": found.total,
        }
        for part, force in parts.items():
            extra.update({f"{part}_{axis}": np.asarray(value) for axis, value in force._asdict().items()})
        for group, names in (
            (found.flow, ("U", "beta")),
            (found.wake, ("w_P", "u_P", "beta_P")),
            (found.propeller, ("J", "K_T")),
        ):
            extra.update({name: np.asarray(getattr(group, name)) for name in names})
        extra.update(
            {name: np.asarray(getattr(found.rudder, name)) for name in ("u_R", "v_R", "alpha_R", "beta_R", "F_N")}
        )
    x, y, psi, u, v_m, r = motion.states.T
    return Trial(
        id=motion.id,
        ship=ship.id,
        manoeuvre=manoeuvre_kind(motion.track()),
        source="generated",
        t=motion.t,
        x=x,
        y=y,
        psi=psi,
        u=u,
        v_m=v_m,
        r=r,
        n=motion.controls[:, 0],
        delta=motion.controls[:, 1],
        extra=extra,
        noise={},
        note=f"Simulated by mmgtune with profile '{ship.id}', sha256 {ship.sha256}.",
        path=None,
        sha256="",
    )
