"""A term that the hull polynomial of the profile does not have, or has with the wrong coefficient."""

from collections import namedtuple
from typing import Any

import numpy as np

from ..physics.prime import force_from_prime
from ..physics.quantities import Force, Forces, State, Surroundings
from .effect import ForceEffect, Parameter

_X = ("vv", "vr", "rr", "absv", "absr", "vvvv", "vvrr", "rrrr")
_ODD = ("v", "r", "uv", "ur", "vabsv", "rabsr", "vabsr", "rabsv", "vvv", "vvr", "vrr", "rrr")
_EVEN = ("absr", "vv", "rr", "rrabsr")
TERMS = (*(f"X_{t}" for t in _X), *(f"{f}_{t}" for f in "YN" for t in (*_ODD, *_EVEN)))
"""Terms of X' (even in v', r': the same to port and starboard), of Y' and N' (odd, then those that favour one side)."""

HullTerm = namedtuple("HullTerm", TERMS)  # type: ignore[misc]


def hull_term(state: State, around: Surroundings, found: Forces, components: Any, p: Any, e: Any) -> Force:
    """Force of each coefficient times its monomial in u' = u/U, v', r', |v'|, |r'|, in the prime system."""
    u = found.flow.u / found.flow.U
    v = found.flow.v_
    r = found.flow.r_
    av = np.abs(v)
    ar = np.abs(r)
    vv = v * v
    rr = r * r
    X_ = (
        e.X_vv * vv
        + e.X_vr * (v * r)
        + e.X_rr * rr
        + e.X_absv * av
        + e.X_absr * ar
        + e.X_vvvv * (vv * vv)
        + e.X_vvrr * (vv * rr)
        + e.X_rrrr * (rr * rr)
    )
    Y_ = (
        v * (e.Y_v + e.Y_uv * u + e.Y_vabsv * av + e.Y_vabsr * ar + e.Y_vvv * vv + e.Y_vvr * (v * r) + e.Y_vrr * rr)
        + r * (e.Y_r + e.Y_ur * u + e.Y_rabsr * ar + e.Y_rabsv * av + e.Y_rrr * rr)
        + (e.Y_absr * ar + e.Y_vv * vv + e.Y_rr * rr + e.Y_rrabsr * (rr * ar))
    )
    N_ = (
        v * (e.N_v + e.N_uv * u + e.N_vabsv * av + e.N_vabsr * ar + e.N_vvv * vv + e.N_vvr * (v * r) + e.N_vrr * rr)
        + r * (e.N_r + e.N_ur * u + e.N_rabsr * ar + e.N_rabsv * av + e.N_rrr * rr)
        + (e.N_absr * ar + e.N_vv * vv + e.N_rr * rr + e.N_rrabsr * (rr * ar))
    )
    force: Force = force_from_prime(p.ship, found.flow.U, X_, Y_, N_)
    return force


def symbol(term: str) -> str:
    """The term as papers write it: N_rabsr is N_r|r|."""
    return term.replace("absr", "|r|").replace("absv", "|v|")


_SIZE = {"X": 0.006, "Y": 0.02, "N": 0.004}
"""A force worth finding in a tight turn [prime]."""

_DRIFT, _YAW = 0.3, 1.5
"""v' and r' of a tight turn."""


def _coefficient(term: str) -> Parameter:
    monomial = term[2:].replace("abs", "")
    size = _SIZE[term[0]] / (_DRIFT ** monomial.count("v") * _YAW ** monomial.count("r"))
    return Parameter(
        f"coefficient of the term {symbol(term)}",
        "prime",
        bounds=lambda _: (-20.0 * size, 20.0 * size),
        typical=lambda _: size,
        bounds_source="twenty times what a tight turn would show",
    )


EFFECT = ForceEffect(
    kind="effects.hull-term",
    tag="hull-term",
    title="one more term of the hull force",
    params=HullTerm,
    function=hull_term,
    cites=(),
    fields={term: _coefficient(term) for term in TERMS},
    variants=tuple((term,) for term in TERMS),
    one_of_many=True,
    absorbed={term: f"hull.{term}" for term in TERMS},
    rough=True,
    sentence=lambda v: (
        "The hull force lacks " + " and ".join(f"a term {symbol(name)} of {value}" for name, value in v.items())
    ),
)
