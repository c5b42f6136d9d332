"""Logs that hold what they logged until the next update, told from those of orders and from coarse ones."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.trial import load_trials
from mmgtune.trial.held import Held

EVERY = 6
ZIGZAG = np.radians([0.0, 20.0, 20.0, -20.0, -20.0, 20.0, 20.0, -20.0, -20.0])
AT = np.array([0.0, 27.0, 80.0, 98.0, 160.0, 178.0, 250.0, 268.0, 400.0])


def made(*deltas):
    """Trials that differ in their rudder angles."""
    trial = next(iter(load_trials("suzaku").trials.values()))
    few = {name: getattr(trial, name)[:401] for name in ("t", "x", "y", "psi", "u", "v_m", "r", "n")}
    return [replace(trial, id=f"zigzag_{k}", **few, delta=delta) for k, delta in enumerate(deltas)]


def moved(later):
    return np.interp(np.arange(401.0), AT + later, ZIGZAG)


@pytest.mark.parametrize("noise", ["none", "before", "after"])
def test_held_values_are_seen_and_read_at_their_updates(noise):
    rng = np.random.default_rng(1)
    true = [moved(later) for later in (0.0, 2.0, 5.0)]
    error = [np.radians(0.05) * rng.standard_normal(401) for _ in true]
    held = np.arange(401) // EVERY * EVERY
    logged = {
        "none": [one[held] for one in true],
        "before": [(one + e)[held] for one, e in zip(true, error, strict=True)],
        "after": [one[held] + e for one, e in zip(true, error, strict=True)],
    }[noise]
    trials = made(*logged)
    found = Held.of(trials)
    assert found is not None
    assert found.samples == {"delta": EVERY}
    assert "rudder angle every 6 s" in found.sentence
    for trial, one in zip(trials, true, strict=True):
        read = found.evenly(trial).delta
        assert np.sqrt(np.mean((read - one) ** 2)) < 0.4 * np.sqrt(np.mean((trial.delta - one) ** 2))
        at = found.updates(trial, "delta")
        assert at[0] == 0
        assert at[-1] == 400
        assert np.all(np.diff(at) > 0)


def test_values_that_came_at_odd_times_are_seen_as_held():
    """A network passed them on after three to eight samples: no two updates were as far apart as the usual ones."""
    rng = np.random.default_rng(4)
    at = np.unique(np.minimum(np.cumsum(rng.integers(3, 9, 200)), 400))
    held = np.repeat(np.append(0, at), np.diff([0, *at, 401]))
    true = [moved(later) for later in (0.0, 2.0, 5.0)]
    trials = made(*(one[held] for one in true))
    found = Held.of(trials)
    assert found is not None
    for trial, one in zip(trials, true, strict=True):
        read = found.evenly(trial).delta
        assert np.sqrt(np.mean((read - one) ** 2)) < 0.5 * np.sqrt(np.mean((trial.delta - one) ** 2))


@pytest.mark.parametrize("step", [0.0, 0.1, 1.0], ids=["as measured", "tenths of a degree", "whole degrees"])
def test_a_rudder_logged_all_along_holds_nothing(step):
    true = [moved(later) for later in (0.0, 2.0, 5.0)]
    assert (
        Held.of(made(*(np.radians(np.round(np.degrees(one) / step) * step) if step else one for one in true))) is None
    )


def test_orders_are_not_taken_for_updates():
    orders = [np.sign(moved(later)) * np.radians(20.0) for later in (0.0, 2.0, 5.0)]
    assert Held.of(made(*orders)) is None


def test_bundled_trials_hold_nothing():
    assert Held.of(list(load_trials("suzaku").trials.values())) is None
