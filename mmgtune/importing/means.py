"""Ships with several rudders or propellers: the one angle, or the one speed, that manoeuvres are recognised by."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..inputs import INPUTS
from .maps.mapping import LogMap


def with_mean(columns: dict[str, FloatArray], name: str, log_map: LogMap) -> list[str]:
    """Put in an input that the map makes the mean of others, in place; what was done, in sentences.

    columns  (n_samples,) by name, the others in the trial format's signs
    """
    of = log_map.means.get(name)
    if of is None or name in columns:
        return []
    columns[name] = np.mean([columns[one] for one in of], axis=0)
    return [f"'{name}', {INPUTS[name].words}: the mean of {' and '.join(of)}"]
