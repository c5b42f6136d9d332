"""Simulating trials: what a predictor makes of the inputs a ship was given, and of the forces on the way."""

from __future__ import annotations

import contextlib
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arguments import ShipGiven, ship_of
from .arrays import FloatArray, numbers_of, runs_of_true
from .backends import STATES, Integrator, LaneModel
from .displayed import Plotted, inert
from .errors import OptionError, Problem, TrialError, among, kind_of, must_be_a
from .inputs import INPUTS, Role
from .manoeuvres import Track, manoeuvre_kind, zigzag_indices
from .manoeuvres.summary import indices_of
from .model import Model
from .physics.quantities import UNKNOWN, Force, State, Surroundings
from .predictor import (
    PhysicsPredictor,
    Predictor,
    as_predictor,
    cases_from,
    draught_of,
    portions,
    predicted,
    profile_of,
)
from .profile import ShipProfile
from .trial import Trial
from .trial.gaps import bridged
from .trial.schema import ATTRIBUTES, FILE_CHANNELS, MAIN_INPUTS
from .units import DEG

ORDERED = re.compile(r"zig-?zag\D*(\d+(?:\.\d+)?)\s*/\s*(\d+(?:\.\d+)?)", re.IGNORECASE)
"""How a trial's manoeuvre names the angles of a zigzag."""


@dataclass(frozen=True, eq=False)
class Motion(Plotted):
    """A simulated run.

    t         (n_samples,) time [s]
    states    (n_samples, 6) x, y [m], psi [rad], u, v_m [m/s], r [rad/s]
    controls  (n_samples, n_inputs) what drove the ship
    diverged  whether the simulation left the world of ships, as one that spins does, by more than half a turn from a
              sample to the next; its states then mean nothing
    inputs    names of the inputs, see ``inputs.INPUTS``
    member    of the predictor, from 0
    around    (n_samples, n_surroundings) what was measured around the ship, as ``Surroundings``; None where
              nothing was
    """

    id: str
    t: FloatArray
    states: FloatArray
    controls: FloatArray
    diverged: bool
    inputs: tuple[str, ...] = MAIN_INPUTS
    member: int = 0
    around: FloatArray | None = None

    def __post_init__(self) -> None:
        if np.any(np.abs(np.diff(self.states[:, STATES.index("psi")])) > np.pi):
            object.__setattr__(self, "diverged", True)

    def __repr__(self) -> str:
        """In a line."""
        end = "diverged" if self.diverged else f"{self.t[-1]:g} s, {len(self.t)} samples"
        return f"Motion({inert(self.id)}: {end})"

    def channel(self, name: str) -> FloatArray:
        """One of x, y, psi, u, v, r: (n_samples,); sway is ``v`` as in files, or ``v_m``.

        Raises OptionError for a name that is no channel of motion.
        """
        must_be_a(name, str, "channel")
        state = ATTRIBUTES.get(name, name)
        if state in STATES:
            return self.states[:, STATES.index(state)]
        known = {"t": "write motion.t", "time": "write motion.t", "heading": "write channel('psi')"}
        known |= {one: f"write motion.controls[:, {k}]" for k, one in enumerate(self.inputs)}
        problem = {"why": f"channels are {', '.join(FILE_CHANNELS)}", "fix": known.get(name, "")}
        raise OptionError(
            Problem(f"no channel '{name}'", "channel", **problem if name in known else among(name, FILE_CHANNELS))
        )

    def track(self) -> Track:
        """The run as indices of manoeuvres are computed from it."""
        columns = dict(zip(STATES, self.states.T, strict=True))
        return Track(t=self.t, n=self.mean_of("propeller"), delta=self.mean_of("rudder"), **columns)

    def mean_of(self, role: Role) -> FloatArray:
        """(n_samples,) mean over the inputs of one role; 0 where there is none."""
        of = [k for k, name in enumerate(self.inputs) if INPUTS[name].role == role]
        return self.controls[:, of].mean(axis=1) if of else np.zeros(len(self.t))


def simulate_trials(
    ship: Predictor | ShipProfile | Model,
    trials: Sequence[Trial],
    *,
    integrator: Integrator = Integrator(),
    backend: str = "compiled",
) -> list[Motion]:
    """Simulate each trial from its first measured state with its measured inputs.

    integrator  "rk4", or "euler" at the trial's own step as Suyama et al. 2023 do
    backend     one of ``options.BACKENDS``; they agree to rounding
    -> trial by trial, and of each all members
    Never raises for a run that diverges: it is marked so.
    """
    return list(motions(as_predictor(ship, integrator=integrator, backend=backend), trials))


def motions(predictor: Predictor, trials: Sequence[Trial], offsets: FloatArray | None = None) -> Iterator[Motion]:
    """Trials simulated with their measured inputs, one after the other: no more is held than is being looked at.

    offsets  (n_trials, 6) added to the first measured states
    """
    inputs = tuple(predictor.inputs)
    for portion in portions([trial.n_samples for trial in trials], predictor.n_members):
        some = trials[portion]
        start = None if offsets is None else begun(some, offsets[portion])
        cases = cases_from(some, inputs, draught_of(predictor), initial=start)
        found = predicted(predictor, cases)
        for i, trial in enumerate(some):
            controls = np.array(cases.controls[i, : trial.n_samples])  # copies: a view would hold all of them
            around = np.array(cases.around[i, : trial.n_samples]) if cases.around[i].any() else None
            for k in range(predictor.n_members):
                states = np.array(found.states[i, k, : trial.n_samples])
                yield Motion(trial.id, trial.t, states, controls, bool(found.diverged[i, k]), inputs, k, around)


def begun(trials: Sequence[Trial], offsets: FloatArray) -> list[FloatArray]:
    """States (6,) that trials begin with: the first measured ones with offsets (n_trials, 6) added."""
    return [trial.motion[0] + own for trial, own in zip(trials, offsets, strict=True)]


def breakdown(
    ship: ShipGiven | Model,
    states: FloatArray,
    controls: FloatArray,
    around: FloatArray | None = None,
    theta: FloatArray | None = None,
) -> Any:
    """Forces and intermediates along a run, by the very functions the simulation uses.

    ship object, path or bundled name, states (n_samples, 6), controls (n_samples, n_inputs), around
    (n_samples, n_surroundings) or None as in ``Motion``, theta (n_rows,) coefficients, the profile's own where None
    -> the breakdown of the profile's arrangement, of arrays (n_samples,).

    Effects of the profile have acted; forces they add are in the total only.  What depends on the past is left out:
    lags count as settled.  Raises OptionError for arrays of other shapes.
    """
    model = ship if isinstance(ship, Model) else Model(ship_of(ship))
    rows = sized(states, "states", (None, len(STATES)), f"each row is {', '.join(STATES)}")
    n_samples, inputs = len(rows), model.inputs
    controls = sized(controls, "controls", (n_samples, len(inputs)), f"the inputs of this ship are {', '.join(inputs)}")
    if around is not None:
        around = sized(around, "around", (n_samples, len(Surroundings._fields)), "each row is as in Motion.around")
    if theta is not None:
        theta = sized(theta, "theta", (len(model.matrix()),), "it is one set of coefficients of the model")
    own = model.matrix() if theta is None else theta[:, None]
    lanes = LaneModel(model, np.repeat(own, n_samples, axis=1))
    logged = model.arrangement.control(*controls.T)
    control = lanes.moved([], logged, None, np.zeros(n_samples))[-1]
    measured = UNKNOWN if around is None else Surroundings(*around.T)
    return lanes.breakdown(lanes.unsensed(State(*rows.T)), control, measured, lanes.here(measured))


def sized(given: object, name: str, shape: tuple[int | None, ...], why: str) -> FloatArray:
    """Numbers as an array of that shape, None standing for any length.  Raises OptionError for what is none."""
    wanted = f"({', '.join('n_samples' if size is None else str(size) for size in shape)}{',' * (len(shape) == 1)})"
    fix = f"give an array of shape {wanted}"
    found = numbers_of(given)
    if found is None:
        raise OptionError(Problem(f"{name} is {kind_of(given)}, no array of numbers", name, why, fix))
    if found.ndim != len(shape) or any(
        size not in (None, there) for size, there in zip(shape, found.shape, strict=True)
    ):
        raise OptionError(Problem(f"{name} has shape {found.shape}", name, why, fix))
    return found


SHORT_GAP = 3
"""Samples in a row that may be missing where indices of manoeuvres are read: a cell here and there."""


def track_of(trial: Trial) -> Track:
    """A measured trial as indices of manoeuvres are computed from it.

    Gaps of no more than ``SHORT_GAP`` samples are bridged linearly, and left off at either end.  Raises TrialError for
    longer ones, OptionError for what is no trial.
    """
    must_be_a(trial, Trial, "trial")
    return _track(trial, SHORT_GAP)


def _track(trial: Trial, longest: float) -> Track:
    """The same with gaps of up to ``longest`` samples bridged."""
    motion, kept = trial.motion, slice(None)
    gaps = [stop - start for channel in motion.T for start, stop in runs_of_true(~np.isfinite(channel))]
    whole = np.flatnonzero(np.isfinite(motion).all(axis=1))
    if gaps and max(gaps) <= longest and len(whole):
        kept = slice(whole[0], whole[-1] + 1)
        bridges = (bridged(trial.t[kept], channel[kept]) for channel in motion.T)
        motion = np.column_stack([channel for channel in bridges if channel is not None])
    columns = dict(zip(STATES, motion.T, strict=True))
    return Track(t=trial.t[kept], n=trial.n[kept], delta=trial.delta[kept], **columns)


def track_if_whole(trial: Trial) -> Track | None:
    """The measured track; None where no indices can be read from it: gaps, jumps of the heading, few samples."""
    try:
        return track_of(trial)
    except TrialError:
        return None


def ordered_angles(trial: Trial) -> tuple[float, float] | None:
    """Rudder and check angle [rad] that a zigzag was ordered with, where the trial says so: "zigzag 35/5"."""
    said = ORDERED.search(trial.manoeuvre)
    return (float(said[1]) * DEG, float(said[2]) * DEG) if said else None


ORDER = ("rudder_angle_deg", "heading_angle_deg", "direction")
"""Indices that say what was ordered."""


def orders_of(trials: Sequence[Trial], L_pp: float) -> dict[str, dict[str, Any]]:
    """What each turning circle and zigzag ordered, by trial and by the names of its indices; others are left out.

    A report tells by it what the code of a trial stands for.
    """
    read = {trial.id: order_of(trial, L_pp) for trial in trials}
    return {id: order for id, order in read.items() if order}


def order_of(trial: Trial, L_pp: float) -> dict[str, Any]:
    """What a trial ordered, by the names of ``ORDER``; empty where it shows neither a turn nor a zigzag.  L_pp [m].

    The rudder tells it over a gap too, but not the check angle of a zigzag, which is None there unless it is said.
    """
    indices = trial_indices(trial, L_pp)
    if track_if_whole(trial) is None:
        with contextlib.suppress(TrialError):
            indices = indices_of(_track(trial, math.inf), L_pp)
        if "heading_angle_deg" in indices:
            said = ordered_angles(trial)
            rudder, check = (None, None) if said is None else (angle / DEG for angle in said)
            indices |= {"rudder_angle_deg": rudder or indices["rudder_angle_deg"], "heading_angle_deg": check}
    if indices.get("rudder_angle_deg") is None:
        return {}
    return {name: indices[name] for name in ORDER if name in indices}


def trial_indices(trial: Trial, L_pp: float) -> dict[str, Any]:
    """Manoeuvring indices of a measured trial; empty where ``track_if_whole`` finds no record.  L_pp [m]."""
    track = track_if_whole(trial)
    if track is None:
        return {}
    if manoeuvre_kind(track) == "zigzag":
        return zigzag_indices(track, L_pp, ordered_angles(trial)).to_dict()
    return indices_of(track, L_pp)


def as_trial(ship: ShipProfile | Predictor, motion: Motion, *, with_forces: bool = False) -> Trial:
    """A simulated run as a trial, labelled generated.

    with_forces  adds forces [N], moments [N m] and intermediates as columns: hull_X, propeller_X, rudder_Y, w_P, ...
    Raises OptionError for forces of a predictor that has no profile to compute them by.
    """
    profile = ship if isinstance(ship, ShipProfile) else profile_of(ship)
    id = profile.id if profile else str(getattr(ship, "id", ship.name))
    by = f"profile '{id}', sha256 {profile.sha256}" if profile else f"predictor '{id}'"
    of: ShipProfile | Model | None = profile
    theta: FloatArray | None = None
    if isinstance(ship, PhysicsPredictor):
        of, theta = ship.model, ship.theta[:, motion.member]
        by += "" if np.array_equal(theta, ship.model.matrix()[:, 0]) else ", with other coefficients"
    extra: dict[str, FloatArray] = {}
    if with_forces:
        if of is None:
            raise OptionError(Problem(f"'{id}' has no forces", "with_forces", "only a ship profile has them"))
        extra = _columns(breakdown(of, motion.states, motion.controls, motion.around, theta))
    note = f"Simulated by mmgtune with {by}."
    return generated_trial(motion, ship=id, manoeuvre=manoeuvre_kind(motion.track()), note=note, beside=extra)


def generated_trial(motion: Motion, *, ship: str, manoeuvre: str, note: str, beside: Mapping[str, FloatArray]) -> Trial:
    """A run that was made, not measured, as a trial.

    beside  further columns (n_samples,) by name, behind the inputs that have no field of their own
    """
    own = {name: motion.controls[:, k] for k, name in enumerate(motion.inputs) if name not in MAIN_INPUTS}
    x, y, psi, u, v_m, r = motion.states.T
    return Trial(
        id=motion.id,
        ship=ship,
        manoeuvre=manoeuvre,
        source="generated",
        t=motion.t,
        x=x,
        y=y,
        psi=psi,
        u=u,
        v_m=v_m,
        r=r,
        n=motion.mean_of("propeller"),
        delta=motion.mean_of("rudder"),
        extra={**own, **beside},
        note=note,
    )


KEPT_BACK = ("u", "v_m", "r", "v_", "r_", "jet", "D_P", "n", "delta")
"""Parts of a breakdown that say nothing of their own beside the motion, the inputs and the others."""


def _columns(found: Any) -> dict[str, FloatArray]:
    """A breakdown as columns: forces as hull_X, rudder_N, ...; intermediates by their names, w_P, alpha_R, ..."""
    columns: dict[str, FloatArray] = {}
    for part, value in found._asdict().items():
        for name, number in ({"force": value} if isinstance(value, Force) else value._asdict()).items():
            if isinstance(number, Force):
                columns.update({f"{part}_{axis}": np.asarray(one) for axis, one in number._asdict().items()})
            elif name not in KEPT_BACK:
                columns[f"{part}_{name}" if name in columns else name] = np.asarray(number)
    return columns
