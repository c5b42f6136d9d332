"""Runs of a model ship with orders drawn at random, as noisy sensors see them, and as they were."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mmgtune.backends import Integrator, pad
from mmgtune.predictor import as_predictor
from mmgtune.profile import load_profile
from mmgtune.trial import Trial

SHIP = "esso_osaka_3m"

NOISE = np.array([0.01, 0.01, np.radians(0.1)])
"""Deviations of the measured u, v_m [m/s] and r [rad/s]."""


def sailed(count: int, largest: float, *, seconds: int = 150, seed: int = 1, name: str = "run") -> list[Trial]:
    """Runs with rudders drawn within ``largest`` [deg] every 15 s, a sample a second, as they were."""
    rng = np.random.default_rng(seed)
    t = np.arange(seconds + 1.0)
    cases = pad(
        [t] * count,
        [
            np.column_stack(
                [np.full(len(t), 8.0), np.repeat(np.radians(rng.uniform(-largest, largest, 99)), 15)[: len(t)]]
            )
            for _ in range(count)
        ],
        [np.array([0.0, 0.0, 0.0, rng.uniform(0.3, 0.45), 0.0, 0.0]) for _ in range(count)],
    )
    states = as_predictor(load_profile(SHIP), integrator=Integrator("rk4", 5)).predict(cases).states[:, 0]
    return [
        Trial(f"{name}_{k}", SHIP, "random", "generated", t, *states[k].T, n=driven[:, 0], delta=driven[:, 1])
        for k, driven in enumerate(cases.controls)
    ]


def noisy(trials: list[Trial], *, seed: int = 2) -> list[Trial]:
    """The same as sensors see them."""
    rng = np.random.default_rng(seed)
    return [
        replace(
            one,
            **{
                name: getattr(one, name) + sigma * rng.standard_normal(one.n_samples)
                for name, sigma in zip(("u", "v_m", "r"), NOISE, strict=True)
            },
        )
        for one in trials
    ]
