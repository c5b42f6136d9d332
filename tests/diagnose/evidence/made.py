"""Trials of a plant integrated here, at a finer step than any back end's, with a force beside the model's if wanted."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mmgtune.backends.cases import FloatArray
from mmgtune.model import Model
from mmgtune.physics.arrangements.single_propeller_single_rudder import Control, forces
from mmgtune.physics.kinematics import pose_rate
from mmgtune.physics.quantities import Force, State
from mmgtune.physics.rigid_body import accelerations
from mmgtune.trial import Trial

DEG = np.pi / 180.0
NOISE = np.array([0.4, 0.4, 0.17 * DEG, 0.02, 0.02, 0.03 * DEG])
"""Of x, y [m], psi [rad], u, v_m [m/s], r [rad/s]."""

SUBSTEPS = 4
RATE = 2.32 * DEG

Beside = Callable[[State], tuple[FloatArray, FloatArray, FloatArray]]
"""Force [N] and moment [N m] in the ship's axes beside the model's, lanes (n_trials,)."""


def turn_order(degrees: float, seconds: int) -> FloatArray:
    """(n_samples,) rudder of a turn [rad], ordered after 60 s."""
    t = np.arange(seconds + 1.0)
    return np.asarray(np.sign(degrees) * np.clip((t - 60.0) * RATE, 0.0, abs(degrees) * DEG))


def zigzag_order(degrees: float, seconds: int, every: float = 50.0) -> FloatArray:
    """(n_samples,) rudder [rad] put over to the other side again and again, first after 60 s."""
    t = np.arange(seconds + 1.0)
    aim = np.where(t <= 60.0, 0.0, np.where(np.ceil((t - 60.0) / every) % 2 == 1, 1.0, -1.0)) * degrees * DEG
    delta = np.zeros(len(t))
    for k in range(1, len(t)):
        delta[k] = delta[k - 1] + np.clip(aim[k] - delta[k - 1], -RATE, RATE)
    return delta


def make_trials(model: Model, *, beside: Beside | None = None, noise: float = 1.0, seconds: int = 420) -> list[Trial]:
    """Two turns and two zigzags from different headings, at 1 Hz, of the ship with the model's coefficients.

    noise  times NOISE
    """
    orders = {
        "turn_p20": (turn_order(20.0, seconds), 0.4),
        "turn_m35": (turn_order(-35.0, seconds), 2.5),
        "zigzag_10": (zigzag_order(10.0, seconds), -1.2),
        "zigzag_20": (zigzag_order(20.0, seconds), 4.0),
    }
    deltas = np.array([delta for delta, _ in orders.values()])
    start = np.zeros((6, len(orders)))
    start[2], start[3] = [heading for _, heading in orders.values()], 3.2
    n = np.full(len(orders), 104.0 / 60.0)
    motions = integrated(model, start, n, deltas, beside)
    random = np.random.default_rng(7)
    t = np.arange(seconds + 1.0)
    trials = []
    for id, delta, motion in zip(orders, deltas, motions, strict=True):
        shown = motion + noise * NOISE * random.standard_normal(motion.shape)
        columns = dict(zip(("x", "y", "psi", "u", "v_m", "r"), shown.T, strict=True))
        same = {"ship": "suzaku", "manoeuvre": "", "source": "generated", "t": t, "n": np.full(len(t), n[0])}
        trials.append(Trial(id=id, delta=delta, **same, **columns))
    return trials


def integrated(model: Model, start: FloatArray, n: FloatArray, deltas: FloatArray, beside: Beside | None) -> FloatArray:
    """(n_trials, n_samples, 6) states by Runge-Kutta at a quarter of a second; start (6, n_trials)."""
    p = model.coefficients(np.repeat(model.matrix(), len(deltas), axis=1))

    def slope(s: FloatArray, angle: FloatArray) -> FloatArray:
        state = State(*s)
        total = forces(state, Control(n, angle), model.components, p).total
        if beside is not None:
            total = Force(*(a + b for a, b in zip(total, beside(state), strict=True)))
        _, _, _, u, v_m, r = s
        return np.array([*pose_rate(state.psi, u, v_m, r), *accelerations(u, v_m, r, *total, p.ship)])

    s, h = start, 1.0 / SUBSTEPS
    motion = [s]
    for begin, end in zip(deltas.T[:-1], deltas.T[1:], strict=True):
        for k in range(SUBSTEPS):
            a, b, c = (begin + (k + f) * h * (end - begin) for f in (0.0, 0.5, 1.0))
            k1 = slope(s, a)
            k2 = slope(s + 0.5 * h * k1, b)
            k3 = slope(s + 0.5 * h * k2, b)
            k4 = slope(s + h * k3, c)
            s = s + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        motion.append(s)
    return np.array(motion).transpose(2, 0, 1)
