"""Forces on a ship under way ahead do not jump: searches for coefficients cannot follow an objective of steps."""

import numpy as np
import pytest

from mmgtune.model import Model
from mmgtune.motions import breakdown
from mmgtune.profile import load_profile

LINES, POINTS, CLOSER, TIMES = 100, 300, 40, 5
"""Straight lines between states, points on each, and parts that the steepest of their pieces is divided in, and how
often: in the end a piece is 3e-11 of a line."""

KNOWN = {
    "suzaku": 0.001,  # sides of flow straightening by beta - l_R' r', while sin(beta) - l_R' r' is what it multiplies
    "suzaku_fam": 0.002,  # a propeller race that depends on the side of the rudder
}
"""The largest jump, over the range of the force, of models whose source has one."""


def ends(model, rng):
    """States and inputs (LINES, ...) of a ship under way ahead, in any turn."""
    approach, L = model.profile.approach, model.profile.L_pp
    speed, beta = approach.speed * rng.uniform(0.3, 1.1, LINES), rng.uniform(-0.6, 0.6, LINES)
    states = np.zeros((LINES, 6))
    states[:, 3], states[:, 4] = speed * np.cos(beta), -speed * np.sin(beta)
    states[:, 5] = rng.uniform(-0.8, 0.8, LINES) * speed / L
    drawn = {
        "propeller": lambda: approach.n * rng.uniform(0.3, 1.1, LINES),
        "rudder": lambda: np.radians(rng.uniform(-35.0, 35.0, LINES)),
        "thruster": lambda: np.zeros(LINES),
    }
    return states, np.column_stack([drawn[one.role]() for one in model.arrangement.inputs])


def largest_jump(model):
    """The largest change of X, Y or N, over its range, within next to no piece of a line."""
    rng = np.random.default_rng(0)
    (s0, c0), (s1, c1) = ends(model, rng), ends(model, rng)

    def forces(lines, at):
        """X, Y, N (n_lines, n_points, 3) at places (n_lines, n_points) on lines."""
        states = s0[lines][:, None] + (s1 - s0)[lines][:, None] * at[..., None]
        inputs = c0[lines][:, None] + (c1 - c0)[lines][:, None] * at[..., None]
        total = breakdown(model, states.reshape(-1, 6), inputs.reshape(-1, inputs.shape[-1])).total
        return np.stack([np.broadcast_to(part, at.size) for part in total], axis=-1).reshape(*at.shape, 3)

    places = np.repeat(np.linspace(0.0, 1.0, POINTS + 1)[None], LINES, axis=0)
    found = forces(np.arange(LINES), places)
    size = np.ptp(found, axis=1).max(axis=0)
    change = np.abs(np.diff(found, axis=1)) / size
    bend = np.abs(np.diff(change, axis=1)).max(axis=2)
    sudden = np.argsort(-np.maximum(np.pad(bend, ((0, 0), (1, 0))), np.pad(bend, ((0, 0), (0, 1)))), axis=1)[:, :6]
    lines = np.repeat(np.arange(LINES), sudden.shape[1])
    low, high = places[0, sudden.ravel()], places[0, sudden.ravel() + 1]
    every = np.arange(len(lines))
    for _ in range(TIMES):
        closer = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, CLOSER + 1)
        change = (np.abs(np.diff(forces(lines, closer), axis=1)) / size).max(axis=2)
        steepest = change.argmax(axis=1)
        low, high = closer[every, steepest], closer[every, steepest + 1]
    return float(change.max())


@pytest.mark.parametrize(
    "name", ["suzaku", "suzaku_fam", "kvlcc2", "kvlcc2_l7", "esso_osaka", "esso_osaka_3m", "vectwin_3m"]
)
def test_forces_under_way_ahead_do_not_jump(name):
    """The yaw moment of SUZAKU's propeller did, by 0.005 of the range, at revolutions of a ship that stops."""
    assert largest_jump(Model(load_profile(name))) <= KNOWN.get(name, 1e-6)
