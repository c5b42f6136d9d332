"""Elementary functions the equations use.

NumPy evaluates them with its own library functions. The compiled back end replaces each one by an
arithmetic-only form with a stated error (``mmgtune.backends.vector_math``), so that the compiler can
vectorise over lanes; the equations above this module are the same source for both.
"""

import numpy as np


def exp(x):
    """Exponential of x [-]."""
    return np.exp(x)


def log(x):
    """Natural logarithm of x > 0 [-]."""
    return np.log(x)


def sin(x):
    """Sine of an angle [rad]."""
    return np.sin(x)


def cos(x):
    """Cosine of an angle [rad]."""
    return np.cos(x)


def arctan2(y, x):
    """Angle of the point (x, y) [rad], in [-pi, pi]; 0 at the origin."""
    return np.arctan2(y, x)


def where(condition, a, b):
    """a where the condition holds, else b; both are evaluated, so guard their arguments."""
    return np.where(condition, a, b)[()]  # a number of numbers, not an array without axes
