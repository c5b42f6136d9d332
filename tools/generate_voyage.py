"""Make a log of days out of a model, with the noise of sensors: what voyages are tested and timed on.

    python -m tools.generate_voyage FOLDER [HOURS]

The rudder follows a programme, mostly a few degrees and now and then a turn; the ship is simulated open loop, hour
after hour, by the equations that judge her later.  All of it is generated; nothing is measured.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.arrays import FloatArray
from mmgtune.backends import Integrator, pad
from mmgtune.model import Model
from mmgtune.predictor import PhysicsPredictor
from mmgtune.profile import load_profile
from mmgtune.trial import Trial, write_trial
from mmgtune.units import DEG

NOISE = {"x": 0.4, "y": 0.4, "psi": 0.17 * DEG, "u": 0.02, "v": 0.02, "r": 0.03 * DEG}
"""Standard deviations of the sensors [SI]."""

ANGLES = np.array([0.0, 0.0, 0.0, 1.0, -1.0, 2.0, -2.0, 5.0, -5.0, 10.0, -10.0, 20.0, -20.0, 35.0, -35.0]) * DEG
RATE = 2.3 * DEG
"""Rudder angles ordered, and how fast the rudder moves [rad], [rad/s]."""


def rudder(n_samples: int, rng: np.random.Generator, dt: float = 1.0) -> FloatArray:
    """(n_samples,) a rudder that is put over every one to ten minutes [rad]."""
    delta = np.zeros(n_samples)
    at, now = 0, 0.0
    while at < n_samples:
        order = float(rng.choice(ANGLES))
        moving = now + np.sign(order - now) * np.arange(1, int(abs(order - now) / (RATE * dt)) + 1) * RATE * dt
        held = int(rng.uniform(60.0, 600.0) / dt)
        leg = np.concatenate([moving, np.full(held, order)])[: n_samples - at]
        delta[at : at + len(leg)] = leg
        at, now = at + len(leg), order
    return delta


def make_voyage(
    model: Model, hours: float, *, id: str = "voyage", seed: int = 1, dt: float = 1.0, noise: float = 1.0, **facts: Any
) -> Trial:
    """A voyage of a model as a trial in memory.

    noise  scale of the sensors' noise; 0 for none
    """
    rng = np.random.default_rng(seed)
    n_samples = int(hours * 3600.0 / dt) + 1
    t = dt * np.arange(n_samples)
    delta = rudder(n_samples, rng, dt)
    approach = model.profile.approach
    assert approach is not None
    n = np.full(n_samples, approach.n)
    controls = np.column_stack([n if one.role == "propeller" else delta for one in model.arrangement.inputs])
    predictor = PhysicsPredictor(model, model.matrix(), Integrator())
    motion = np.zeros((n_samples, 6))
    state = np.array([0.0, 0.0, 0.0, approach.speed, 0.0, 0.0])
    step = round(3600.0 / dt)
    for first in range(0, n_samples - 1, step):
        part = slice(first, min(first + step, n_samples - 1) + 1)
        found = predictor.predict(pad([t[part]], [controls[part]], [state]))
        motion[part] = found.states[0, 0]
        state = motion[part.stop - 1]
    for k, sigma in enumerate(NOISE.values()):
        motion[:, k] += noise * sigma * rng.standard_normal(n_samples)
    x, y, psi, u, v, r = motion.T
    slow = 2.0 * np.pi * t / 86_400.0
    extra = {
        "wind_speed": 7.0 + 4.0 * np.sin(slow),
        "wind_dir": np.mod(slow, 2.0 * np.pi),
        "depth": 60.0 + 40.0 * np.cos(3.0 * slow),
    }
    told: dict[str, Any] = {"ship": model.profile.id, "manoeuvre": "voyage", "source": "generated", **facts}
    note = "Simulated with a rudder programme, not measured; wind and depth are written down and act on nothing."
    return Trial(
        id=id, t=t, x=x, y=y, psi=psi, u=u, v_m=v, r=r, n=n, delta=delta, extra=extra, noise=NOISE, note=note, **told
    )


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    length = float(sys.argv[2]) if len(sys.argv) > 2 else 24.0
    print(write_trial(make_voyage(Model(load_profile("suzaku")), length), folder / "voyage.parquet", overwrite=True))
