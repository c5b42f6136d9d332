"""What no other effect is: small smooth forces of unknown form, so that a model need not be right to be believed.

The force is a sum of waves over lateral velocity, yaw rate and angle of attack of the rudder, random Fourier features
(Rahimi & Recht 2007, "Random features for large-scale kernel machines") of a Gaussian process over these three.  With
independent normal coefficients it is a smooth function like any other, as small near the straight course as the
motion, and where no trial has been the coefficients say nothing of it but their prior.  Sines are what a ship alike to
port and starboard can have in Y' and N', and their squares in X'; the others favour one side.
"""

from __future__ import annotations

from collections import namedtuple
from typing import Any

from ..physics.elementary import sin
from ..physics.prime import force_from_prime
from ..physics.quantities import Force, State, Surroundings
from .effect import ForceEffect, Parameter

N_WAVES = 8
"""Waves: enough for the one or two directions in which manoeuvres move among the three coordinates."""

LENGTHS = (0.3, 0.8, 0.5)
"""v', r' and sine of the angle of attack over which the force changes its course: those of a tight turn."""

FREQUENCIES = (
    (0.86, -0.42, 0.31),
    (-0.35, 1.12, 0.54),
    (0.27, 0.48, -1.31),
    (-1.46, 0.21, 0.77),
    (0.62, 1.58, -0.44),
    (1.03, 0.95, 1.22),
    (-0.74, -0.66, 1.64),
    (0.12, -1.84, -0.93),
)
"""One drawing of standard normal numbers, in radians over these lengths."""

SIZE = {"X": 0.003, "Y": 0.012, "N": 0.003}
"""A force in a tight turn that formulas and fits are commonly wrong by [prime], a tenth of what acts there."""

TERMS = tuple(f"{force}_{parity}{k}" for force in "XYN" for parity in ("odd", "even") for k in range(N_WAVES))
"""Coefficients of sines (odd in v', r' and the rudder) and of their squares (even), of each force."""

Discrepancy = namedtuple("Discrepancy", TERMS)  # type: ignore[misc]


def discrepancy(state: State, around: Surroundings, found: Any, components: Any, p: Any, e: Any) -> Force:
    """The sum of the waves, in the prime system at the reference speed; written out, so that lanes stay vectors."""
    a = found.flow.v_ / LENGTHS[0]
    b = found.flow.r_ / LENGTHS[1]
    c = sin(found.rudder.alpha_R) / LENGTHS[2]
    s0 = sin(FREQUENCIES[0][0] * a + FREQUENCIES[0][1] * b + FREQUENCIES[0][2] * c)
    s1 = sin(FREQUENCIES[1][0] * a + FREQUENCIES[1][1] * b + FREQUENCIES[1][2] * c)
    s2 = sin(FREQUENCIES[2][0] * a + FREQUENCIES[2][1] * b + FREQUENCIES[2][2] * c)
    s3 = sin(FREQUENCIES[3][0] * a + FREQUENCIES[3][1] * b + FREQUENCIES[3][2] * c)
    s4 = sin(FREQUENCIES[4][0] * a + FREQUENCIES[4][1] * b + FREQUENCIES[4][2] * c)
    s5 = sin(FREQUENCIES[5][0] * a + FREQUENCIES[5][1] * b + FREQUENCIES[5][2] * c)
    s6 = sin(FREQUENCIES[6][0] * a + FREQUENCIES[6][1] * b + FREQUENCIES[6][2] * c)
    s7 = sin(FREQUENCIES[7][0] * a + FREQUENCIES[7][1] * b + FREQUENCIES[7][2] * c)
    X_ = (
        e.X_odd0 * s0
        + e.X_odd1 * s1
        + e.X_odd2 * s2
        + e.X_odd3 * s3
        + e.X_odd4 * s4
        + e.X_odd5 * s5
        + e.X_odd6 * s6
        + e.X_odd7 * s7
        + e.X_even0 * (s0 * s0)
        + e.X_even1 * (s1 * s1)
        + e.X_even2 * (s2 * s2)
        + e.X_even3 * (s3 * s3)
        + e.X_even4 * (s4 * s4)
        + e.X_even5 * (s5 * s5)
        + e.X_even6 * (s6 * s6)
        + e.X_even7 * (s7 * s7)
    )
    Y_ = (
        e.Y_odd0 * s0
        + e.Y_odd1 * s1
        + e.Y_odd2 * s2
        + e.Y_odd3 * s3
        + e.Y_odd4 * s4
        + e.Y_odd5 * s5
        + e.Y_odd6 * s6
        + e.Y_odd7 * s7
        + e.Y_even0 * (s0 * s0)
        + e.Y_even1 * (s1 * s1)
        + e.Y_even2 * (s2 * s2)
        + e.Y_even3 * (s3 * s3)
        + e.Y_even4 * (s4 * s4)
        + e.Y_even5 * (s5 * s5)
        + e.Y_even6 * (s6 * s6)
        + e.Y_even7 * (s7 * s7)
    )
    N_ = (
        e.N_odd0 * s0
        + e.N_odd1 * s1
        + e.N_odd2 * s2
        + e.N_odd3 * s3
        + e.N_odd4 * s4
        + e.N_odd5 * s5
        + e.N_odd6 * s6
        + e.N_odd7 * s7
        + e.N_even0 * (s0 * s0)
        + e.N_even1 * (s1 * s1)
        + e.N_even2 * (s2 * s2)
        + e.N_even3 * (s3 * s3)
        + e.N_even4 * (s4 * s4)
        + e.N_even5 * (s5 * s5)
        + e.N_even6 * (s6 * s6)
        + e.N_even7 * (s7 * s7)
    )
    force: Force = force_from_prime(p.ship, found.flow.U, X_, Y_, N_)
    return force


def shared_by_sides(term: str) -> bool:
    """Whether a coefficient is of a force that a ship alike to port and starboard can have."""
    return ("odd" in term) != (term[0] == "X")


def _coefficient(term: str) -> Parameter:
    size = SIZE[term[0]]
    wave = "sine" if "odd" in term else "squared sine"
    return Parameter(
        f"{wave} of wave {term[-1]} in {term[0]}'",
        "prime",
        bounds=lambda _: (-10.0 * size, 10.0 * size),
        typical=lambda _: size,
        bounds_source="ten times what models are commonly wrong by",
    )


EFFECT = ForceEffect(
    kind="effects.discrepancy",
    tag="discrepancy",
    title="small smooth forces of unknown form",
    params=Discrepancy,
    function=discrepancy,
    cites=(),
    fields={term: _coefficient(term) for term in TERMS},
    variants=(),
    of_parts=("rudder",),
    sentence=lambda v: "Forces of unknown form act",
)
