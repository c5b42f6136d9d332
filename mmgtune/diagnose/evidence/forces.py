"""Residual forces: what acted on the ship, by inverse dynamics, less what the model makes of the same motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from ...arrays import FloatArray
from ...backends import LaneModel
from ...model import Model
from ...motions import breakdown
from ...physics.prime import force_unit, moment_unit
from ...physics.quantities import HELD, Forces, Ship, Surroundings
from ...physics.rigid_body import accelerations
from ...trial import Trial, surroundings
from ...trial.kinematics import white_noise
from .smoothing import Smoothed, smooth

MOMENT = 3.0
"""Time [s] over which the rudder is looked at to tell whether it moves."""

LEAST_ORDER = np.radians(1.0)
"""Rudder movement [rad] within that time that counts as one."""


@dataclass(frozen=True, eq=False)
class ResidualForces:
    """Force and moment that the measured motion needed beyond the model's, where both can be relied on.

    id       of the trial
    sample   (n,) samples of the trial these are; near ends and long gaps there are none
    force    (n, 3) dX, dY [N], dN [N m] about midship, needed less modelled
    noise    (n, 3) deviation of these from white noise of the sensors, [N], [N m]
    unit     (n, 3) what makes them prime: 0.5 rho L d U^2 [N] twice, 0.5 rho L^2 d U^2 [N m]
    time     (n,) of the trial [s]
    heading  (n,) smoothed [rad], unwrapped; NaN where it was not measured
    drift    (n,) drift angle beta [rad]
    yaw_rate (n,) r' = r L / U [-]
    rudder   (n,) logged rudder angle [rad], the mean where there are several rudders
    ordered  (n,) time since the last rudder order [s]; NaN before the first
    speed    (n,) U [m/s]
    tau      time scale of the smoothing [s]; what is quicker cannot be seen
    L_pp     of the model [m]

    Drift angle, r' and U are those of the model's flow: through the water as far as the model knows a current.
    """

    id: str
    sample: npt.NDArray[np.intp]
    force: FloatArray
    noise: FloatArray
    unit: FloatArray
    time: FloatArray
    heading: FloatArray
    drift: FloatArray
    yaw_rate: FloatArray
    rudder: FloatArray
    ordered: FloatArray
    speed: FloatArray
    tau: float
    L_pp: float

    @property
    def prime(self) -> FloatArray:
        """(n, 3) dX', dY', dN' [-]."""
        return self.force / self.unit

    @property
    def prime_noise(self) -> FloatArray:
        """(n, 3) deviation of these from white noise of the sensors [-]."""
        return self.noise / self.unit

    @property
    def dX(self) -> FloatArray:
        """(n,) surge force the model lacks [N]."""
        return self.force[:, 0]

    @property
    def dY(self) -> FloatArray:
        """(n,) sway force the model lacks [N]."""
        return self.force[:, 1]

    @property
    def dN(self) -> FloatArray:
        """(n,) yaw moment about midship the model lacks [N m]."""
        return self.force[:, 2]

    @property
    def variables(self) -> dict[str, FloatArray]:
        """What may explain them, (n,) each, SI units.

        Time since the last order is log(1 + ship lengths run since): most happens within the first few.
        """
        return {
            "heading": self.heading,
            "drift": self.drift,
            "yaw_rate": self.yaw_rate,
            "rudder": self.rudder,
            "ordered": np.log1p(self.ordered * self.speed / self.L_pp),
            "speed": self.speed,
            "time": self.time,
        }


def residual_forces(model: Model, trial: Trial) -> ResidualForces:
    """Residual forces of a trial against a model, by inverse dynamics from smoothed measured motion.

    Both sides are blunted alike: inputs and what was measured around the ship are smoothed as the motion is (see
    ``smoothing``).  Effects of the model act as in ``simulation.breakdown``: what depends on the past is not in the
    model's forces.

    Raises ValueError where u, v_m and r are measured together at fewer than 10 samples, or nowhere for long enough.
    """
    motion = smooth(trial)
    at = np.flatnonzero(motion.inner)
    if not len(at):
        raise ValueError(f"trial '{trial.id}' is too short, or too broken by gaps, for forces: tau {motion.tau:.3g} s")
    known = np.flatnonzero(np.isfinite(motion.states[:, 3:]).all(axis=1))
    controls = motion.alike(trial.inputs(model.inputs))
    around = measured(model, trial, motion)
    found = breakdown(model, motion.states[known], controls[known], around[known])
    velocities = _velocities(found)
    # A natural cubic spline through a natural cubic spline's own values at its knots is that spline.
    slopes = CubicSpline(motion.t[known], velocities, bc_type="natural")(motion.t[known], 1)
    inner = motion.inner[known]
    ship = ship_in(model, around[at])
    force = needed_force(ship, velocities[inner], slopes[inner]) - _total(found)[inner]
    U = np.asarray(found.flow.U)[inner]
    unit_F = force_unit(ship.rho, ship.L_pp, ship.d, U)
    unit_M = moment_unit(ship.rho, ship.L_pp, ship.d, U)
    return ResidualForces(
        id=trial.id,
        sample=at,
        force=force,
        noise=_noise(model, motion, controls, around, at, slopes[inner]),
        unit=np.column_stack([unit_F, unit_F, unit_M]),
        time=trial.t[at],
        heading=motion.states[at, 2],
        drift=np.asarray(found.flow.beta)[inner],
        yaw_rate=np.asarray(found.flow.r_)[inner],
        rudder=trial.delta[at],
        ordered=time_since_order(trial.t, trial.delta)[at],
        speed=U,
        tau=motion.tau,
        L_pp=float(ship.L_pp[0]),
    )


def needed_force(ship: Ship, velocities: FloatArray, slopes: FloatArray) -> FloatArray:
    """Force and moment that give the ship with her added mass these accelerations.

    ship of (1,) or (n,) each, velocities (n, 3) u, v_m [m/s], r [rad/s] through the water, slopes (n, 3) their time
    derivatives -> (n, 3) X, Y [N], N [N m].

    Accelerations are affine in the forces; they are evaluated at none and at one of each, and solved for the forces.
    """
    size = float((ship.rho * ship.L_pp * ship.B * ship.d)[0])  # about the ship's mass, to keep digits
    units = size * np.array([1.0, 1.0, float(ship.L_pp[0])])

    u, v_m, r = velocities.T

    def caused(X: float, Y: float, N: float) -> FloatArray:
        return np.column_stack([np.broadcast_to(a, len(slopes)) for a in accelerations(u, v_m, r, X, Y, N, ship)])

    free = caused(0.0, 0.0, 0.0)
    by_force = np.stack([caused(*unit) - free for unit in np.diag(units)], axis=-1)
    return np.asarray(np.linalg.solve(by_force, (slopes - free)[..., None])[..., 0] * units)


def time_since_order(t: FloatArray, delta: FloatArray) -> FloatArray:
    """Time since the last rudder order [s], (n_samples,); NaN before the first.  t [s], delta [rad] (n_samples,).

    An order is the first sample at which the rudder has moved by more than a degree, or six deviations of its noise,
    within the last three seconds, after it had not, or had moved the other way.
    """
    known = np.isfinite(delta)
    if known.sum() < 2:
        return np.full(len(t), np.nan)
    moment = max(MOMENT, 2.0 * float(np.median(np.diff(t))))
    now, before = (np.interp(at, t[known], delta[known]) for at in (t, t - moment))
    swing = now - before
    least = max(LEAST_ORDER, 6.0 * white_noise(delta))
    ordered = np.full(len(t), np.nan)
    last, moving = np.nan, 0.0
    for i, turned in enumerate(swing):
        if abs(turned) > least and np.sign(turned) != moving:
            last, moving = t[i], float(np.sign(turned))
        elif abs(turned) < 0.5 * least:
            moving = 0.0
        ordered[i] = t[i] - last
    return ordered


def measured(model: Model, trial: Trial, motion: Smoothed) -> FloatArray:
    """(n_samples, n_surroundings) as ``surroundings`` has them, blunted as the motion is."""
    found = surroundings(trial, model.draught)
    moving = [k for k, name in enumerate(Surroundings._fields) if name not in (*HELD, "elapsed") and found[:, k].any()]
    if moving:
        found[:, moving] = motion.alike(found[:, moving])
    return found


def _noise(
    model: Model,
    motion: Smoothed,
    controls: FloatArray,
    around: FloatArray,
    at: npt.NDArray[np.intp],
    slopes: FloatArray,
) -> FloatArray:
    """(n, 3) deviation of residual forces from noise in u, v_m and r and, apart from it, in their slopes."""
    states, controls, around = motion.states[at], controls[at], around[at]
    ship = ship_in(model, around)
    value_noise, slope_noise = motion.value_noise[3:], motion.slope_noise[3:]

    def force(moved: FloatArray, change: FloatArray) -> FloatArray:
        found = breakdown(model, moved, controls, around)
        return needed_force(ship, _velocities(found), slopes + change) - _total(found)

    base = force(states, np.zeros(3))
    variance = np.zeros_like(base)
    for k in range(3):
        moved = states.copy()
        moved[:, 3 + k] += value_noise[k]
        variance += (force(moved, np.zeros(3)) - base) ** 2
        variance += (force(states, slope_noise[k] * np.eye(3)[k]) - base) ** 2
    return np.sqrt(variance)


def ship_in(model: Model, around: FloatArray) -> Ship:
    """The ship with the water that she carries along in surroundings (n, n_surroundings)."""
    found = LaneModel(model, model.matrix()).here(Surroundings(*around.T)).ship
    assert isinstance(found, Ship)
    return found


def _velocities(found: Forces) -> FloatArray:
    return np.column_stack([found.flow.u, found.flow.v_m, found.flow.r])


def _total(found: Forces) -> FloatArray:
    return np.column_stack([found.total.X, found.total.Y, found.total.N])
