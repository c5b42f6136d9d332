"""Known truth: trials made from coefficients inside the box, with and without noise."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from mmgtune.backends import pad
from mmgtune.fitting.box import choose_targets
from mmgtune.fitting.journal import _hash, arguments
from mmgtune.fitting.least_squares import _asked, solve
from mmgtune.model import Model
from mmgtune.trial import Trial, TrialSet
from tests.runs import states

TRUTH = {  # within 35 % of the pre-determined values of SUZAKU, on no bound
    "hull.R_0": 0.0195,
    "propeller.t_P": 0.07,
    "wake.w_P0": 0.50,
    "wake.C_w": -2.3,
    "rudder.t_R": -0.05,
    "rudder.a_H": 0.18,
    "rudder.x_H_": -0.68,
    "rudder.eps": 1.15,
    "rudder.kappa": 0.45,
    "rudder.l_R_": -1.0,
    "rudder.gamma_Rp": 0.42,
    "rudder.gamma_Rn": 0.20,
}
NOISE = np.array([0.4, 0.4, np.radians(0.17), 0.02, 0.02, np.radians(0.03)])


def make_trial(
    model: Model, name: str, degrees: float, seconds: int, truth: Mapping[str, float], noise: float = 0.0
) -> Trial:
    """A turn of the ship with coefficients ``truth``, steps of 1 s, after 20 s straight on."""
    t = np.arange(seconds + 1.0)
    delta = np.sign(degrees) * np.clip((t - 20.0) * np.radians(2.32), 0.0, np.radians(abs(degrees)))
    controls = np.column_stack([np.full(len(t), 104.0 / 60.0), delta])
    theta = model.matrix(list(truth), np.array([list(truth.values())]).T)
    motion = states(model, pad([t], [controls], [np.array([0.0, 0.0, 0.4, 3.2, 0.0, 0.0])]), theta)[0, 0]
    motion = motion + noise * NOISE * np.random.default_rng(abs(hash(degrees)) % 1000).standard_normal(motion.shape)
    columns = dict(zip(("x", "y", "psi", "u", "v_m", "r"), motion.T, strict=True))
    return Trial(
        id=name,
        ship="suzaku",
        manoeuvre="turning",
        source="generated",
        t=t,
        n=controls[:, 0],
        delta=delta,
        sha256=name,
        **columns,
    )


def make_set(model: Model, truth: Mapping[str, float] = TRUTH, noise: float = 0.0, test: bool = True) -> TrialSet:
    """Four turns to tune and four to test, as in the paper, a little shorter."""
    turns = {10: 400, 20: 300, 35: 240, 40: 240}
    trials = {
        f"turn_{'p' if side > 0 else 'm'}{angle}": make_trial(
            model, f"turn_{'p' if side > 0 else 'm'}{angle}", side * angle, seconds, truth, noise
        )
        for angle, seconds in turns.items()
        for side in (1, -1)
    }
    tune = ("turn_p10", "turn_m20", "turn_p35", "turn_m40")
    tests = tuple(name for name in trials if name not in tune) if test else ()
    kept = {name: trial for name, trial in trials.items() if test or name in tune}
    return TrialSet(kept, tune, tests, "suzaku")


@pytest.fixture(scope="session")
def clean(suzaku: Model) -> TrialSet:
    """Noise-free trials of ``TRUTH``."""
    return make_set(suzaku)


@pytest.fixture(scope="session")
def noisy(suzaku: Model) -> TrialSet:
    """The same with sensor noise."""
    return make_set(suzaku, noise=1.0)


@pytest.fixture(scope="session")
def targets(suzaku: Model) -> tuple[str, ...]:
    """The paper's twelve."""
    return choose_targets(suzaku, ())


def solve_asked(problem, starts, **how):
    """The hash by which a journal tells a solve from another."""
    return _hash(_asked(**arguments(solve, problem, starts, **how)))
