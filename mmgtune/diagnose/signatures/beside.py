"""What is free beside a hypothesis at a point, and where its own parameters stand there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...arrays import FloatArray
from ...fitting.box import base_of
from ..bench.hypotheses import Hypothesis
from ..bench.workbench import Point, Workbench


def kept_free(point: Point, hypothesis: Hypothesis) -> list[int]:
    """Indices of the point's parameters that remain free when ``hypothesis`` is added: all but its own parameters, for
    all runs or for fewer, and the targets that it replaces."""
    gone = {*hypothesis.bases, *hypothesis.instead}
    return [i for i, name in enumerate(point.names) if base_of(name) not in gone]


def free_with(point: Point, hypothesis: Hypothesis) -> tuple[str, ...]:
    """Names of the parameters that are free at a point with a hypothesis added, its own parameters last."""
    return (*(point.names[i] for i in kept_free(point, hypothesis)), *hypothesis.names)


def origin(bench: Workbench, point: Point, names: Sequence[str]) -> FloatArray:
    """(n_names,) values of parameters at a point, in the unit cube: a parameter's own value, the value for all runs, or
    its null; a factor that replaces a target begins at the re-tuned value of that target."""
    unit = dict(zip(point.names, point.unit, strict=True))
    null = bench.null(names)
    for k, name in enumerate(names):
        target = bench.factors.get(base_of(name))
        if target in unit:
            factor = bench.values(point)[target] / bench.model.numbers()[target]
            (place,) = bench.sub_box([base_of(name)]).to_unit([factor])
            null[k] = np.clip(place, 0.0, 1.0)
    return np.array([unit.get(name, unit.get(base_of(name), z)) for name, z in zip(names, null, strict=True)])
