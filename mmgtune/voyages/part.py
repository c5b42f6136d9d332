"""One voyage, scored: what a run adds to what it has, and what its journal keeps."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..trial import Cutting
from .scores import Scores
from .spread import Spread
from .table import Gathered


@dataclass(eq=False)
class Part:
    """What came of one voyage.

    at_rest   windows in which the ship hardly moved, left out
    around    (n, n_surroundings) of each model, see ``circumstances.extremes``; only of those that act on any
    complete  whether it was read to its end
    """

    counted: Cutting = field(default_factory=Cutting)
    gathered: Gathered = field(default_factory=Gathered)
    spread: Spread = field(default_factory=Spread)
    around: dict[str, FloatArray] = field(default_factory=dict)
    at_rest: int = 0
    complete: bool = True


def noted(part: Part) -> dict[str, Any]:
    """A part as JSON, to the last bit."""
    whole = part.gathered
    return {
        "counted": asdict(part.counted),
        "ids": whole.ids,
        "about": [list(one) for one in whole.about],
        "features": [_arrays(one) for one in whole.features],
        "counts": [_array(one) for one in whole.counts],
        "scores": {
            name: [
                {
                    "diverged": _array(one.diverged),
                    "measures": _arrays(one.measures),
                    "mean": _array(one.mean),
                    "squares": _array(one.squares),
                    "J": _array(one.J),
                }
                for one in of
            ]
            for name, of in whole.scores.items()
        },
        "spread": [_array(one) for one in part.spread.state],
        "around": _arrays(part.around),
        "at_rest": part.at_rest,
        "complete": part.complete,
    }


def recalled(found: Mapping[str, Any]) -> Part:
    """The part that was noted."""
    return Part(
        Cutting(**found["counted"]),
        Gathered(
            list(found["ids"]),
            [(int(number), int(row), int(n), begins, duration) for number, row, n, begins, duration in found["about"]],
            [_recalled(one) for one in found["features"]],
            [_read(one) for one in found["counts"]],
            {
                name: [
                    Scores(
                        _read(one["diverged"]),
                        _recalled(one["measures"]),
                        _read(one["mean"]),
                        _read(one["squares"]),
                        _read(one["J"]),
                    )
                    for one in of
                ]
                for name, of in found["scores"].items()
            },
        ),
        Spread(*(_read(one) for one in found["spread"])),
        _recalled(found["around"]),
        int(found["at_rest"]),
        bool(found["complete"]),
    )


def _arrays(named: Mapping[str, np.ndarray]) -> dict[str, list[Any]]:
    return {name: _array(values) for name, values in named.items()}


def _array(values: np.ndarray) -> list[Any]:
    """Kind, shape and bytes: a third of the length of the numbers written out."""
    whole = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
    return [whole.dtype.str, list(whole.shape), base64.b64encode(whole.tobytes()).decode()]


def _recalled(named: Mapping[str, list[Any]]) -> dict[str, Any]:
    return {name: _read(one) for name, one in named.items()}


def _read(one: list[Any]) -> Any:
    kind, shape, content = one
    return np.frombuffer(base64.b64decode(content), dtype=kind).reshape(shape).astype(np.dtype(kind).newbyteorder("="))
