"""What a trial would leave open of a question, before it is sailed.

Particles alone cannot say: conditioning some hundreds of them on the hundreds of numbers of a log finds relations among
so many numbers by chance.  So a trial is taken as ``posterior`` takes those that were sailed: windows begun anew from
the log, whitened residuals r(z) with slopes J in all the room there is, each with the variance T that trials of this
ship count with.  Of the particles only the covariance C of z is taken.  The answer q has the mean gradient g over
particles, since of Gaussian z the covariance of z and q is C E[dq/dz] (Stein 1981).  Then

    var q         = g C g
    var q after   = g C g - g C J' (J C J' + T)^-1 J C g

(Bishop 2006, eq. 2.117; Chaloner & Verdinelli 1995 of expected information).  The variance after does not depend on
what the trial will show, as the problem is linear.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..backends import Backend, Integrator
from ..model import Model
from ..particles import Particles
from ..posterior.local import make_windowed
from ..posterior.room import Room
from ..predicting.asked import Approach
from ..predicting.steering import sail
from ..predictor import PhysicsPredictor
from ..trial import Trial
from .question import Question

POINTS = 8
"""Particles at which the gradient of an answer is taken."""

STEP = 0.1
"""Step of the gradient, in deviations of the room."""


def answers(predictor: PhysicsPredictor, question: Question, approach: Approach) -> FloatArray:
    """(n_members,) in the unit of the index, NaN of those that never reach it."""
    (found,) = sail(predictor, [question.asked], approach)
    return np.asarray(found.indices[question.index.key])


def gradient(
    particles: Particles, room: Room, z: FloatArray, question: Question, approach: Approach, backend: str
) -> FloatArray:
    """Mean derivatives (n_names,) of an answer over points z (n_names, n); zero of what belongs to the day.

    NaN where it is reached at none of the points, or at some of the steps only.
    """
    n, points = z.shape
    day = {*particles.of_the_day()}
    ship = np.array([k for k, name in enumerate(room.names) if name not in day])
    columns = np.repeat(z[:, :, None], len(ship) + 1, axis=2)  # n_names, points, steps
    # Towards the middle of the room, so that no step leaves it.
    steps = np.where(z[ship] > 0.0, -STEP, STEP)
    columns[ship, :, 1 + np.arange(len(ship))] += steps
    values = room.values(columns.reshape(n, -1))[ship]
    model = Model(particles.profile)
    theta = model.matrix([room.names[k] for k in ship], values)
    found = answers(PhysicsPredictor(model, theta, backend=backend), question, approach).reshape(points, -1)
    slopes = (found[:, 1:] - found[:, :1]) / steps.T
    reached = slopes[np.isfinite(slopes).all(axis=1)]
    whole = np.zeros(n)
    whole[ship] = reached.mean(axis=0) if len(reached) else np.nan
    return whole


def slopes_of(room: Room, trial: Trial, z: FloatArray, backend: Backend, integrator: Integrator) -> FloatArray:
    """Derivatives (n_rows, n_names) of the white residuals of a trial at z (n_names,)."""
    return make_windowed(room, [trial], backend, integrator).linearised(z)[1]


def share_left(g: FloatArray, C: FloatArray, J: FloatArray, temper: float, n: int) -> float:
    """Deviation of an answer after a trial over that before.

    g       (n_names,) gradient of the answer
    C       (n_names, n_names) covariance of ``n`` particles
    J       (n_rows, n_names) derivatives of the trial's white residuals, of variance ``temper``

    A covariance of n particles promises too much: what is left given k exact numbers is (n - 1 - k)/(n - 1) of the
    truth in the mean (of a Wishart matrix, Muirhead 1982, th. 3.2.10), with k the numbers that the trial determines.
    That is mended.  NaN where k is not below half of n, 1 where the answer is not open.
    """
    before = float(g @ C @ g)
    CJ = C @ J.T
    K = J @ CJ + temper * np.eye(len(J))
    told = g @ CJ
    determined = float(np.trace(np.linalg.solve(K, J @ CJ)))
    if determined >= 0.5 * (n - 1):
        return np.nan
    if before <= 0.0:
        return 1.0
    after = (before - float(told @ np.linalg.solve(K, told))) / (1.0 - determined / (n - 1))
    return float(np.sqrt(np.clip(after / before, 0.0, 1.0)))
