"""The propeller of a ship of which little is known, and the revolutions that drive her at her approach speed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..physics.regressions import wageningen

PITCHES = wageningen.FORMULA.valid["P/D"]
USUAL_PITCH = 0.75


@dataclass(frozen=True)
class Propulsion:
    """A propeller and its revolutions.

    pitch_     pitch over diameter [-]
    k          k_0, k_1, k_2 of K_T = k_0 + k_1 J + k_2 J^2
    misfit     largest difference of that parabola from the open-water curve [-]
    n          revolutions at the approach speed [1/s]
    pitch_rule, n_rule  where pitch and revolutions come from, "" where they were given
    warning    what is doubtful, "" where nothing is
    """

    pitch_: float
    k: tuple[float, float, float]
    misfit: float
    n: float
    pitch_rule: str
    n_rule: str
    warning: str = ""


def propulsion(
    u_P: float,
    thrust: float,
    D_P: float,
    pitch_: float | None,
    n: float | None,
    area: float,
    blades: float,
    curve: tuple[tuple[float, ...], tuple[float, ...]] = ((), ()),
) -> Propulsion:
    """Pitch, open-water curve and revolutions that give ``thrust`` over rho [m^4/s^2] at the inflow u_P [m/s].

    D_P [m]; pitch_ over D_P, n [1/s], None where not known: one of them is found from the other, so that the ship keeps
    her approach speed; curve: advance ratios and thrust coefficients measured, else those of the B-series.
    """
    wanted = thrust / D_P**4
    warning = ""
    pitch_rule = n_rule = ""
    if n is not None and pitch_ is None and not curve[0]:
        J = u_P / (n * D_P)
        needed = wanted / (n * n)
        low, high = PITCHES
        pitch_ = _root(lambda P: float(wageningen.thrust_coefficient(J, P, area, blades)) - needed, low, high)
        pitch_rule = "thrust is resistance at the approach speed and revolutions given"
        if pitch_ in PITCHES:
            warning = (
                f"no pitch of the series, P/D {low:g}-{high:g}, gives K_T {needed:.3f} at J {J:.3f}: "
                "speed, revolutions and propeller diameter do not go together"
            )
    elif pitch_ is None:
        pitch_, pitch_rule = USUAL_PITCH, "usual"
    k, misfit = _parabola(pitch_, area, blades, curve)
    if n is None:
        top = 20.0 * u_P / D_P
        n = _root(lambda n: n * n * float(k @ [1.0, u_P / (n * D_P), (u_P / (n * D_P)) ** 2]) - wanted, 1e-3 * top, top)
        n_rule = "thrust is resistance at the approach speed"
    return Propulsion(pitch_, (float(k[0]), float(k[1]), float(k[2])), misfit, n, pitch_rule, n_rule, warning)


def _parabola(
    pitch_: float, area: float, blades: float, curve: tuple[tuple[float, ...], tuple[float, ...]]
) -> tuple[FloatArray, float]:
    """The parabola through an open-water curve, between no advance and no thrust."""
    J, K_T = np.array(curve[0]), np.array(curve[1])
    if not curve[0]:
        J = np.linspace(0.0, 1.3 * pitch_ + 0.2, 400)
        K_T = wageningen.thrust_coefficient(J, pitch_, area, blades)
        pulls = int(np.argmax(K_T <= 0.0)) or len(J)
        J, K_T = J[:pulls], K_T[:pulls]
    k: FloatArray
    k, misfit = wageningen.quadratic_through(J, K_T)
    return k, float(misfit)


def _root(f: Callable[[float], float], low: float, high: float) -> float:
    """Where a rising function passes 0, by halving; the end that is nearer where it does not."""
    if f(low) >= 0.0:
        return low
    if f(high) <= 0.0:
        return high
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if f(middle) < 0.0 else (low, middle)
    return 0.5 * (low + high)
