"""Elementary functions as plain arithmetic, for the compiler to vectorise over lanes.

Numba brings no vector mathematics library, and a call to a scalar one stops the vectoriser.  These forms have
no branch, no call and no table: select instructions, a polynomial, and bit shifts for powers of two.  Largest
errors, checked by the tests against NumPy: relative 4e-16 for exp on [-700, 700] and for log of normal numbers,
absolute 4e-16 for sin and cos to 1e5 rad, absolute 8e-16 for arctan2.  A NaN comes out as NaN.
"""

from __future__ import annotations

import math
from typing import Any

from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic

OPTIONS: dict[str, Any] = {
    "forceinline": True, "error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True,
}  # fmt: skip
"""How everything inside a kernel is compiled; no fast-math, so that both back ends agree and runs repeat.

Nothing but a kernel calls these, so no way in from Python is compiled for each: a tenth of the time of all.
"""

# Adding and subtracting 1.5 * 2^52 rounds to the nearest integer and leaves it in the low bits.
_ROUND = 6755399441055744.0
_LN2_HIGH, _LN2_LOW = 0.693147180369123816490, 1.90821492927058770002e-10
_PIO2_HIGH, _PIO2_LOW = 1.57079632673412561417, 6.07710050650619224932e-11
_TAN_PI_8 = math.tan(math.pi / 8.0)


@intrinsic
def _bits(context: Any, x: Any) -> Any:
    def generate(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.IntType(64))

    return types.int64(types.float64), generate


@intrinsic
def _float(context: Any, x: Any) -> Any:
    def generate(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.DoubleType())

    return types.float64(types.int64), generate


@intrinsic
def select(context: Any, condition: Any, a: Any, b: Any) -> Any:
    """a if the condition holds, else b, as one instruction instead of a branch."""

    def generate(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return builder.select(args[0], args[1], args[2])

    return types.float64(types.boolean, types.float64, types.float64), generate


@njit(**OPTIONS)
def vector_exp(x: float) -> float:
    """Exponential: 2^k times a Taylor polynomial on [-ln 2 / 2, ln 2 / 2]; arguments beyond +-700 count as +-700."""
    x = select(x < -700.0, -700.0, select(x > 700.0, 700.0, x))
    t = x * 1.4426950408889634 + _ROUND
    k = t - _ROUND
    r = (x - k * _LN2_HIGH) - k * _LN2_LOW
    p = 1.0 / 6227020800.0
    for factorial in (479001600.0, 39916800.0, 3628800.0, 362880.0, 40320.0, 5040.0, 720.0, 120.0, 24.0, 6.0, 2.0):
        p = p * r + 1.0 / factorial
    p = (p * r + 1.0) * r + 1.0
    return _float(_bits(p) + (_bits(t) << 52))


_ROOT_HALF = 0x3FE6A09E667F3BCD
"""Bits of the root of one half: the logarithm is that of a number between there and twice that, and a power of two."""


@njit(**OPTIONS)
def vector_log(x: float) -> float:
    """Natural logarithm of a positive normal number: a rational function on [sqrt(1/2), sqrt(2)]; NaN elsewhere."""
    k = (_bits(x) - _ROOT_HALF) >> 52
    power = _float(_bits(_ROUND) + k) - _ROUND
    f = _float(_bits(x) - (k << 52)) - 1.0
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    p = z * (
        0.6666666666666735130 + w * (0.2857142874366239149 + w * (0.1818357216161805012 + w * 0.1479819860511658591))
    )
    p += w * (0.3999999999940941908 + w * (0.2222219843214978396 + w * 0.1531383769920937332))
    half = 0.5 * f * f
    value = power * _LN2_HIGH - ((half - (s * (half + p) + power * _LN2_LOW)) - f)
    return select(x > 0.0, value, math.nan)


@njit(**OPTIONS)
def _quadrant(x: float) -> tuple[float, int]:
    """x reduced to [-pi/4, pi/4], and which multiple of pi/2 was taken off (in the low bits)."""
    t = x * (2.0 / math.pi) + _ROUND
    k = t - _ROUND
    return (x - k * _PIO2_HIGH) - k * _PIO2_LOW, _bits(t)


# Minimax coefficients of the sine and cosine on [-pi/4, pi/4], as tabulated for double precision.
@njit(**OPTIONS)
def _sine(r: float) -> float:
    z = r * r
    p = 1.58969099521155010221e-10 * z - 2.50507602534068634195e-08
    p = (p * z + 2.75573137070700676789e-06) * z - 1.98412698298579493134e-04
    p = (p * z + 8.33333333332248946124e-03) * z - 1.66666666666666324348e-01
    return r + r * z * p


@njit(**OPTIONS)
def _cosine(r: float) -> float:
    z = r * r
    p = -1.13596475577881948265e-11 * z + 2.08757232129817482790e-09
    p = (p * z - 2.75573143513906633035e-07) * z + 2.48015872894767294178e-05
    p = (p * z - 1.38888888888741095749e-03) * z + 4.16666666666666019037e-02
    return 1.0 - (0.5 * z - z * z * p)


@njit(**OPTIONS)
def vector_sin(x: float) -> float:
    """Sine."""
    r, k = _quadrant(x)
    value = select((k & 1) == 1, _cosine(r), _sine(r))
    return select((k & 2) == 2, -value, value)


@njit(**OPTIONS)
def vector_cos(x: float) -> float:
    """Cosine."""
    r, k = _quadrant(x)
    value = select((k & 1) == 1, _sine(r), _cosine(r))
    return select(((k + 1) & 2) == 2, -value, value)


@njit(**OPTIONS)
def vector_arctan2(y: float, x: float) -> float:
    """Angle of the point (x, y): a rational function on [-tan(pi/8), tan(pi/8)] and the symmetries of octants."""
    a, b = abs(x), abs(y)
    larger = select(b > a, b, a)
    smaller = select(b > a, a, b)
    steep = smaller > _TAN_PI_8 * larger
    numerator = select(steep, smaller - larger, smaller)
    denominator = select(steep, smaller + larger, larger)
    denominator = select(denominator == 0.0, 1.0, denominator)
    z = numerator / denominator
    w = z * z
    p = (((-0.8750608600031904 * w - 16.157537187333652) * w - 75.00855792314705) * w - 122.88666844901361) * w
    p = (p - 64.85021904942025) * w
    q = ((((w + 24.858464901423062) * w + 165.02700983169885) * w + 432.88106049129027) * w + 485.3903996359137) * w
    angle = z + z * (p / (q + 194.5506571482614))
    angle = select(steep, angle + 0.25 * math.pi, angle)
    angle = select(b > a, 0.5 * math.pi - angle, angle)
    angle = select(x < 0.0, math.pi - angle, angle)
    return select(_bits(y) < 0, -angle, angle)
