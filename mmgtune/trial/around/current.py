"""The current a trial was measured in."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ...arrays import FloatArray
from ..gaps import bridged
from ..model import Trial
from ..schema import LAYER

CURRENT_PAIR = ("current_speed", "current_dir")
"""Columns that are a current together, and nothing alone."""


def current_pairs(columns: Iterable[str]) -> list[tuple[str, str]]:
    """Pairs of columns that are a current together, of which at least one is there; those of layers by depth."""
    there = set(columns)
    layers = {layer[2] for name in there if (layer := LAYER.fullmatch(name))}
    pairs = [CURRENT_PAIR, *((f"current_speed_at_{z}m", f"current_dir_at_{z}m") for z in sorted(layers, key=float))]
    return [pair for pair in pairs if there & set(pair)]


def measured_current(trial: Trial, draught: float | None) -> FloatArray:
    """(n_samples, 5) velocity of the water over ground, north and east [m/s], its rates over the step that ends at a
    sample [m/s^2], and 1 where the trial has a current, else 0.

    draught  of the ship [m], None where nobody knows it

    ``current_speed`` and ``current_dir`` count where both are there.  Else the mean over the draught of what layers
    say, linear between them and held above the first and below the last; where the draught is not known, the mean down
    to the deepest.  Short gaps are bridged linearly, and between samples the current is linear.
    """
    found = _of(trial, CURRENT_PAIR)
    if found is None:
        found = _mean_of_layers(trial, draught)
    if found is None:
        return np.zeros((trial.n_samples, 5))
    rates = np.zeros_like(found)
    rates[1:] = np.diff(found, axis=0) / np.diff(trial.t)[:, None]
    return np.column_stack([found, rates, np.ones(trial.n_samples)])


def _of(trial: Trial, pair: tuple[str, str]) -> FloatArray | None:
    """(n_samples, 2) north and east [m/s] of one pair of columns, None where the trial has no current there."""
    if not set(pair) <= set(trial.extra):
        return None
    speed, towards = trial.extra[pair[0]], trial.extra[pair[1]]
    north, east = speed * np.cos(towards), speed * np.sin(towards)
    return bridged(trial.t, north, east)


def _mean_of_layers(trial: Trial, draught: float | None) -> FloatArray | None:
    layers = {}
    for pair in current_pairs(trial.extra):
        layer, found = LAYER.fullmatch(pair[0]), _of(trial, pair)
        if layer and found is not None:
            layers[float(layer[2])] = found
    if not layers:
        return None
    shares = layer_shares(np.array(list(layers)), max(layers) if draught is None else draught)
    return np.asarray(np.tensordot(shares, np.array(list(layers.values())), axes=1))


def layer_shares(z: FloatArray, draught: float) -> FloatArray:
    """Share (n_layers,) of each layer in the mean from the surface down to the draught [m].

    z  (n_layers,) depths of the layers [m], increasing; linear between them, held above the first and below the last
    """
    if draught <= z[0]:
        return np.array(np.eye(len(z))[0])
    at = np.concatenate([[0.0], z[(z > 0.0) & (z < draught)], [draught]])
    hats = np.array([np.interp(at, z, layer) for layer in np.eye(len(z))])
    shares: FloatArray = np.sum(0.5 * (hats[:, 1:] + hats[:, :-1]) * np.diff(at), axis=1) / draught
    return shares
