"""Ships side by side under orders: actuators that follow them, and a wind of its own for each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..arrays import FloatArray
from ..backends import Integrator, LaneModel
from ..model import Model
from ..physics.actuation import actuated
from ..physics.quantities import UNKNOWN, State, Surroundings
from ..physics.stochastic_wind import sigma_of, wind_step

RK4 = Integrator("rk4")

GUSTS_FADE, VEER_FADES = 5.0, 10.0
"""Time [s] in which speed and direction of the wind come back to their mean: half a minute and a minute on a ship of
150 m (assumption; the spectra the source fits them to are not at hand)."""

GUSTINESS, VEER = 0.12, np.radians(10.0)
"""Standard deviation of the speed over its mean [-], and of the direction [rad] (assumption, as above)."""


class Commander(Protocol):
    """Gives orders to all ships."""

    def orders(self, t: float, states: FloatArray) -> FloatArray:
        """Orders (n_orders, n_lanes) to rudders and thrusters at time t [s], of ships in states (6, n_lanes)."""
        ...


@dataclass(frozen=True, eq=False)
class Sailed:
    """Runs of the same length, side by side.

    t         (n_samples,) time [s]
    states    (n_samples, 6, n_lanes); controls (n_samples, n_inputs, n_lanes)
    wind      (n_samples, 2, n_lanes) speed [m/s] and direction it comes from [rad]
    """

    t: FloatArray
    states: FloatArray
    controls: FloatArray
    wind: FloatArray


def sail(
    model: Model,
    commander: Commander,
    start: FloatArray,
    mean_wind: FloatArray,
    rng: np.random.Generator,
    *,
    seconds: float,
    sample: float,
    step: float,
) -> Sailed:
    """Ships from states (6, n_lanes) in winds of mean speed [m/s] and direction [rad], (2, n_lanes).

    The propeller turns as in the approach condition of the profile; rudders and thrusters begin at rest at the first
    order.  Ship and actuators by fourth-order Runge-Kutta, wind by Euler and Maruyama, in steps of about ``step`` [s],
    as in Wakita et al., section 5.1.
    """
    profile, inputs = model.profile, model.arrangement.inputs
    approach = profile.require_approach()
    n_lanes = start.shape[1]
    steps = max(1, round(sample / step))
    h = sample / steps
    alpha = np.array([[-1.0 / GUSTS_FADE], [-1.0 / VEER_FADES]])
    sigma = sigma_of(np.stack([GUSTINESS * mean_wind[0], np.where(mean_wind[0] > 0.0, VEER, 0.0)]), alpha)
    lanes = LaneModel(model, np.repeat(model.matrix(), n_lanes, axis=1))
    wind = mean_wind + np.where(sigma > 0.0, sigma / np.sqrt(-2.0 * alpha), 0.0) * rng.standard_normal((2, n_lanes))
    moving = [k for k, one in enumerate(inputs) if one.role != "propeller"]
    actuators = [profile.actuator(inputs[k].name) for k in moving]
    low, high, rate = (np.array([[getattr(one, name)] for one in actuators]) for name in ("low", "high", "rate"))

    def driven(moved: FloatArray) -> FloatArray:
        rows = np.full((len(inputs), n_lanes), approach.n)
        rows[moving] = moved
        return rows

    states = np.empty((round(seconds / sample) + 1, 6, n_lanes))
    controls, winds = np.empty((len(states), len(inputs), n_lanes)), np.empty((len(states), 2, n_lanes))
    at = np.clip(commander.orders(0.0, start), low, high)
    run = lanes.under_way(State(*start), model.arrangement.control(*driven(at)), _around(wind))
    states[0], controls[0], winds[0] = start, driven(at), wind
    for i in range(1, len(states)):
        for k in range(steps):
            seen = np.array(run.shown)
            ordered = np.clip(commander.orders((i - 1) * sample + k * h, seen), low, high)
            at = actuated(at, ordered, rate, h, h)
            wind = wind_step(wind, mean_wind, alpha, sigma, h, rng.standard_normal((2, n_lanes)))
            wind[0] = np.maximum(wind[0], 0.0)
            run.step(model.arrangement.control(*driven(at)), _around(wind), h, RK4)
        states[i], controls[i], winds[i] = np.array(run.shown), driven(at), wind
    return Sailed(sample * np.arange(float(len(states))), states, controls, winds)


def _around(wind: FloatArray) -> Surroundings:
    speed, direction = wind
    known = np.ones_like(speed)
    return UNKNOWN._replace(
        wind_north=-speed * np.cos(direction), wind_east=-speed * np.sin(direction), wind_known=known
    )
