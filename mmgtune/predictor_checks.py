"""Predictors that others wrote: what is looked at before one of them is believed.

NumPy would broadcast states of a wrong shape and score them in silence, so both what a predictor says of itself and
what it predicts are held against what ``predictor.Predictor`` promises.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from numbers import Integral
from typing import Any, NamedTuple

import numpy as np

from .arrays import BoolArray, FloatArray
from .backends import STATES, Cases
from .errors import OptionError, Problem, brief, kind_of
from .inputs import INPUTS, meant_by
from .limits import as_float, is_real


class Told(NamedTuple):
    """A member by which a predictor describes itself: whether a value can be, what it has to be, and what to write."""

    right: Callable[[Any], bool]
    words: str
    fix: str


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _is_length(value: Any) -> bool:
    return is_real(value) and 0.0 < as_float(value) < np.inf


def _is_count(value: object) -> bool:
    return isinstance(value, Integral) and int(value) >= 1


def _are_names(value: object) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, str) and all(isinstance(one, str) for one in value)


SELF_TOLD = {
    "name": Told(_is_text, "a text", "give it a name"),
    "L_pp": Told(_is_length, "a length in m, above 0", "write the number alone, in metres"),
    "n_members": Told(_is_count, "a whole number, 1 or more", "write how many predictions it makes of each case"),
    "inputs": Told(
        _are_names,
        "names of what drives it, in a tuple",
        f"write some of {', '.join(INPUTS)}, as ('n', 'delta')",
    ),
    "method": Told(_is_text, "a text", 'say how it gets on in time, such as "rk4"'),
}
"""What a predictor says of itself."""

MEMBERS = (*SELF_TOLD, "predict")
"""Everything that makes a predictor."""

RETURNED = "mmgtune.Prediction(states, diverged), shapes (n_cases, n_members, T, 6) and (n_cases, n_members)"
"""What ``predict`` returns, for messages."""


def lacking(given: object) -> list[str]:
    """Members of a predictor that something is without; nothing where it has too few to be meant as one."""
    gone = [name for name in MEMBERS if not hasattr(given, name)]
    return gone if callable(getattr(given, "predict", None)) or len(gone) < len(MEMBERS) / 2 else []


def require_described(predictor: object) -> None:
    """Raises OptionError with everything that a predictor says of itself and that can not be."""
    who = type(predictor).__name__
    problems = []
    for name, told in SELF_TOLD.items():
        value = getattr(predictor, name)
        if not told.right(value):
            what = f"'{name}' of a {who} is {brief(value)}"
            problems.append(Problem(what, f"{who}.{name}", f"it has to be {told.words}", told.fix))
        elif name == "inputs":
            for one in value:
                if one not in INPUTS:
                    what = f"a {who} is driven by '{one}', which no trial has"
                    problems.append(Problem(what, f"{who}.inputs", **meant_by(one)))
    if problems:
        raise OptionError(*problems)


def require_predicted(predictor: Any, cases: Cases, found: object) -> tuple[FloatArray, BoolArray]:
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
    if _sound(states):
        return states, diverged
    for k in np.flatnonzero(np.isfinite(cases.initial).all(axis=1)):
        run = states[k, :, : cases.n_samples[k]]
        unsound = ~np.isfinite(run).all(axis=(1, 2)) & ~diverged[k]
        if unsound.any():
            what = f"states of {who} are not finite in case {k}, member {np.flatnonzero(unsound)[0]}"
            why = "the run is not marked as diverged, so it would be scored"
            fix = "mark it: diverged = ~numpy.isfinite(states).all(axis=(2, 3)), or correct the states"
            raise OptionError(Problem(what, "predict", why, fix))
    return states, diverged


def _sound(states: FloatArray) -> bool:
    """Whether all states are finite, told by their sum, which makes no copy; False where that is beyond all bounds."""
    with np.errstate(over="ignore", invalid="ignore"):
        return bool(np.isfinite(states.sum()))
