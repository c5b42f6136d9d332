"""What is not known of a wind that is found: its gusts, and how its force changes with the angle it comes from.

Gusts are drawn as first-order processes along the wind and across it, the same all over the ship, as large and as long
as they usually are at the height of a ship over open sea: assumed, not measured.  What the force is at each angle is
drawn about the formulas, which ships lie about by a fifth and more.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from ...arrays import FloatArray
from ...backends import Cases
from ...effects import Effect
from ...effects.wind import EFFECT
from ...model import Model
from ...physics.frame import to_ship
from ...physics.quantities import HARMONICS, Surroundings

ALONG, ACROSS = 0.12, 0.1
"""Deviations of gusts along and across the mean wind, as shares of it."""

LENGTH = 250.0
"""Distance [m] of air over which gusts fade to 1/e."""

OFF = {"X": 0.2, "Y": 0.1, "N": 0.2}
"""Deviation of each harmonic of a force, as a share of all of that force."""


def blows(effect: Effect | None) -> bool:
    """Whether an effect is a wind that is found."""
    return effect is EFFECT


def in_words(effects: Collection[Effect]) -> list[dict[str, str]]:
    """What is assumed where a wind is among effects that were found: name, value and note."""
    if EFFECT not in effects:
        return []
    size = f"{100.0 * ALONG:.3g} % of the mean wind along it and {100.0 * ACROSS:.3g} % across it, {LENGTH:g} m long"
    return [{"name": "gusts", "value": size, "note": "as usual over open sea: what they leave is no unknown cause"}]


def other_winds(
    model: Model, theta: FloatArray, cases: Cases, n_draws: int, seed: int
) -> tuple[FloatArray, FloatArray]:
    """Surroundings and coefficients as they are, and with winds that may have blown just as well, case by case.

    theta  (n_rows, 1) coefficients, or (n_rows, n_cases, 1)

    -> (n_cases, 1 + n_draws, T, n_surroundings), and coefficients (n_rows, n_cases, 1 + n_draws) that make a model
    simulate these winds; all draws are alike where no wind acts on the ship
    """
    copies = 1 + n_draws
    around = np.repeat(cases.around[:, None], copies, axis=1)
    each = np.repeat(theta[:, None] if theta.ndim == 2 else theta, copies, axis=2)
    each = np.repeat(each, len(cases) // each.shape[1], axis=1)
    if f"{EFFECT.kind}.speed" not in model.rows:
        return around, each
    rng = np.random.default_rng(seed)
    shapes = _shapes(model, theta, n_draws, rng)
    north, east, known = (Surroundings._fields.index(f"wind_{name}") for name in ("north", "east", "known"))
    for case in range(len(cases)):
        speed, direction, measured, turned = (
            float(each[model.rows[f"{EFFECT.kind}.{name}"], case, 0])
            for name in ("speed", "direction", "measured", "turned")
        )
        factor = measured if measured > 0.0 else 1.0
        by_log = (cases.around[case, :, known] * measured > 0.0)[:, None]
        steady = -speed * np.array([np.cos(direction), np.sin(direction)])
        logged = np.column_stack(to_ship(turned, *cases.around[case][:, [north, east]].T))
        air = np.where(by_log, factor * logged, steady)
        if not np.any(air):
            continue
        blown = (air + _gusts(cases.t[case], air, n_draws, rng)) / factor
        around[case, :, :, north], around[case, :, :, east] = blown[..., 0], blown[..., 1]
        around[case, :, :, known] = 1.0
        each[model.rows[f"{EFFECT.kind}.measured"], case] = factor
        each[model.rows[f"{EFFECT.kind}.turned"], case] = 0.0  # turned back already
        for row, values in shapes.items():
            each[row, case, 1:] = values
    return around, each


def _shapes(model: Model, theta: FloatArray, n_draws: int, rng: np.random.Generator) -> dict[int, FloatArray]:
    """Harmonics of the force, (n_draws,) by their row."""
    found: dict[int, FloatArray] = {}
    for force, off in OFF.items():
        rows = [model.rows[EFFECT.borrowed[name]] for name in HARMONICS if name.startswith(force)]
        values = theta.reshape(len(theta), -1)[rows, 0]
        drawn = values[:, None] + off * np.linalg.norm(values) * rng.standard_normal((len(rows), n_draws))
        found.update(zip(rows, drawn, strict=True))
    return found


def _gusts(t: FloatArray, air: FloatArray, n_draws: int, rng: np.random.Generator) -> FloatArray:
    """None, then gusts (1 + n_draws, T, 2) about the velocity of the air (T, 2), north and east [m/s]."""
    mean = np.mean(air, axis=0)
    U = float(np.hypot(*mean))
    along = mean / max(U, 1e-9)
    frame = np.stack([ALONG * U * along, ACROSS * U * np.array([-along[1], along[0]])])
    kept = np.exp(-np.maximum(np.diff(t, prepend=t[0]), 0.0) * U / LENGTH)
    step = rng.standard_normal((len(t), n_draws, 2))
    n = np.empty_like(step)
    n[0] = step[0]
    for k in range(1, len(t)):
        n[k] = kept[k] * n[k - 1] + np.sqrt(1.0 - kept[k] ** 2) * step[k]
    drawn = np.moveaxis(n, 0, 1) @ frame
    return np.concatenate([np.zeros((1, *drawn.shape[1:])), drawn])
