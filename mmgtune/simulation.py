"""Simulating trials: what the model makes of the inputs a ship was given, and of the forces on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arrays import FloatArray
from .backends import STATES, Integrator, LaneModel, get_backend, pad
from .manoeuvres import Track, manoeuvre_kind
from .manoeuvres.summary import indices_of
from .measures import distance_measures, reference_of
from .model import Model
from .physics.mmg import Breakdown
from .physics.quantities import Control, State
from .profile import ShipProfile
from .trial import Trial, measured_wind


@dataclass(frozen=True, eq=False)
class Motion:
    """A simulated run.

    t         (n_samples,) time [s]
    states    (n_samples, 6) x, y [m], psi [rad], u, v_m [m/s], r [rad/s]
    controls  (n_samples, 2) propeller revolutions [1/s], rudder angle [rad]
    diverged  whether the simulation left the world of ships; its states then mean nothing
    """

    id: str
    t: FloatArray
    states: FloatArray
    controls: FloatArray
    diverged: bool

    def __repr__(self) -> str:
        """In a line."""
        end = "diverged" if self.diverged else f"{self.t[-1]:g} s, {len(self.t)} samples"
        return f"Motion({self.id}: {end})"

    def channel(self, name: str) -> FloatArray:
        """One of x, y, psi, u, v_m, r: (n_samples,)."""
        return self.states[:, STATES.index(name)]

    def track(self) -> Track:
        """The run as indices of manoeuvres are computed from it."""
        columns = dict(zip(STATES, self.states.T, strict=True))
        return Track(t=self.t, n=self.controls[:, 0], delta=self.controls[:, 1], **columns)


def simulate(
    ship: ShipProfile | Model,
    trials: Sequence[Trial],
    *,
    integrator: Integrator = Integrator(),
    backend: str = "compiled",
) -> list[Motion]:
    """Simulate each trial from its first measured state with its measured inputs.

    integrator  "euler" at the trial's own step as Suyama et al. 2023 do, or "rk4"
    backend     "compiled" or "numpy"; they agree to rounding
    Never raises for a run that diverges: it is marked so.
    """
    model = ship if isinstance(ship, Model) else Model(ship)
    if not trials:
        return []
    controls = [np.column_stack([trial.n, trial.delta]) for trial in trials]
    wind = [measured_wind(trial) for trial in trials]
    cases = pad([trial.t for trial in trials], controls, [trial.motion[0] for trial in trials], wind=wind)
    result = get_backend(backend).run(model, model.matrix(), cases, integrator=integrator, keep_states=True)
    assert result.states is not None  # asked for
    return [
        Motion(trial.id, trial.t, result.states[i, 0, : trial.n_samples], controls[i], bool(result.diverged[i, 0]))
        for i, trial in enumerate(trials)
    ]


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


def trial_indices(trial: Trial, L_pp: float) -> dict[str, Any]:
    """Manoeuvring indices of a measured trial; empty where gaps forbid them.  L_pp [m]."""
    return {} if np.isnan(trial.motion).any() else indices_of(track_of(trial), L_pp)


def trial_measures(trial: Trial, motion: Motion) -> dict[str, float]:
    """The seven distance measures between a measured trial and its simulation; empty where they do not exist."""
    try:
        return distance_measures(trial.motion, motion.states, reference_of(trial.motion))
    except ValueError:  # a ship at rest, or never a complete sample
        return {}


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
