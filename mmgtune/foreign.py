"""Predictors that others wrote: what is looked at before one of them is believed.

NumPy would broadcast states of a wrong shape and score them in silence, so both what a predictor says of itself and
what it predicts are held against what ``predictor.Predictor`` promises.
"""

from __future__ import annotations

from collections.abc import Sequence
from numbers import Integral, Real
from typing import Any

import numpy as np

from .arrays import BoolArray, FloatArray
from .backends import STATES, Cases
from .errors import OptionError, Problem, brief, kind_of
from .inputs import INPUTS, meant_by

SELF_TOLD = {
    "name": "a text",
    "L_pp": "a length in m, above 0",
    "n_members": "a whole number, 1 or more",
    "inputs": "names of what drives it, in a tuple",
    "method": "a text",
}
"""Members by which a predictor describes itself, and what each is."""

MEMBERS = (*SELF_TOLD, "predict")
"""Everything that makes a predictor."""

RETURNED = "mmgtune.Prediction(states, diverged), shapes (n_cases, n_members, T, 6) and (n_cases, n_members)"
"""What ``predict`` returns, for messages."""


def lacking(given: object) -> list[str]:
    """Members of a predictor that something is without; nothing where it has too few to be meant as one."""
    gone = [name for name in MEMBERS if not hasattr(given, name)]
    return gone if callable(getattr(given, "predict", None)) or len(gone) < len(MEMBERS) / 2 else []


def hold_described(predictor: object) -> None:
    """Raises OptionError with everything that a predictor says of itself and that can not be."""
    told = {name: getattr(predictor, name) for name in SELF_TOLD}
    right = {
        "name": isinstance(told["name"], str),
        "L_pp": _is_number(told["L_pp"]) and 0.0 < told["L_pp"] < np.inf,
        "n_members": isinstance(told["n_members"], Integral) and int(told["n_members"]) >= 1,
        "inputs": _are_names(told["inputs"]),
        "method": isinstance(told["method"], str),
    }
    who = type(predictor).__name__
    problems = [
        Problem(f"'{name}' of a {who} is {brief(told[name])}", f"{who}.{name}", f"it has to be {SELF_TOLD[name]}", fix)
        for name, fix in (
            ("name", "give it a name"),
            ("L_pp", "write the number alone, in metres"),
            ("n_members", "write how many predictions it makes of each case"),
            ("inputs", f"write some of {', '.join(INPUTS)}, as ('n', 'delta')"),
            ("method", 'say how it gets on in time, such as "rk4"'),
        )
        if not right[name]
    ]
    if right["inputs"]:
        for name in told["inputs"]:
            if name not in INPUTS:
                what = f"a {who} is driven by '{name}', which no trial has"
                problems.append(Problem(what, f"{who}.inputs", **meant_by(name)))
    if problems:
        raise OptionError(*problems)


def hold_predicted(predictor: Any, cases: Cases, found: object) -> tuple[FloatArray, BoolArray]:
    """The states and marks of a prediction, neither copied.

    Raises OptionError where they are not there, have another shape than is promised, or are not finite before the end
    of a case whose run is not marked as diverged.
    """
    who = f"predict of {type(predictor).__name__}"
    if not (hasattr(found, "states") and hasattr(found, "diverged")):
        what = f"{who} returns {'None' if found is None else kind_of(found)}"
        raise OptionError(Problem(what, "predict", "it is no Prediction", f"return {RETURNED}"))
    states, diverged = np.asarray(found.states), np.asarray(found.diverged)
    n, members, T = len(cases), predictor.n_members, cases.t.shape[1]
    if diverged.shape != (n, members) or diverged.dtype != bool:
        what = f"diverged of {who} is an array of {diverged.dtype.name}, shape {diverged.shape}"
        why = f"{n} cases and {members} members want truth values of shape {(n, members)}"
        fix = "return numpy.zeros((len(cases), n_members), dtype=bool) where no run diverges"
        raise OptionError(Problem(what, "predict", why, fix))
    wanted = (n, members, T, len(STATES))
    if states.shape != wanted or states.dtype.kind not in "fiu":
        what = f"states of {who} are an array of {states.dtype.name}, shape {states.shape}"
        why = f"shape {wanted} is wanted: cases, members, samples as in cases.t, and {', '.join(STATES)}"
        fix = "make a state for each sample of cases.t, of each member"
        if members == 1 and states.shape == (n, T, len(STATES)):
            fix = "the axis of members is missing: return states[:, None]"
        raise OptionError(Problem(what, "predict", why, fix))
    for k in np.flatnonzero(np.isfinite(cases.initial).all(axis=1)):
        unsound = _unsound(states[k, :, : cases.n_samples[k]]) & ~diverged[k]
        if unsound.any():
            what = f"states of {who} are not finite in case {k}, member {np.flatnonzero(unsound)[0]}"
            why = "the run is not marked as diverged, so it would be scored"
            fix = "mark it: diverged = ~numpy.isfinite(states).all(axis=(2, 3)), or correct the states"
            raise OptionError(Problem(what, "predict", why, fix))
    return states, diverged


def _unsound(states: FloatArray) -> BoolArray:
    """(n_members,) whether states (n_members, n_samples, 6) are not finite somewhere."""
    with np.errstate(over="ignore", invalid="ignore"):
        total = states.sum()  # makes no copy; of finite numbers it may still be beyond all bounds
    if np.isfinite(total):
        return np.zeros(len(states), dtype=bool)
    return np.asarray(~np.isfinite(states).all(axis=(1, 2)))


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _are_names(value: object) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, str) and all(isinstance(one, str) for one in value)
