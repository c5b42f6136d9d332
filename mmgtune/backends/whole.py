"""Run a model through the already compiled kernel of all effects.

A kernel of its own takes seconds to compile for every combination of effects.  The kernel of all effects skips those
that a model does not have, with bit-identical results; it takes a little longer.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model import Model
from ..profile import with_all_effects


@dataclass(frozen=True, eq=False)
class Whole:
    """A model with every effect that applies to its ship, those it does not have at their null.

    rows  (n_rows of the model it was made of,) where its coefficients stand there
    """

    model: Model
    rows: IntArray

    def theta(self, theta: FloatArray) -> FloatArray:
        """Coefficients (n_rows, ...) of the model it was made of as coefficients of this one."""
        base = self.model.base.reshape(-1, *(1 for _ in theta.shape[1:]))
        found = np.repeat(base, theta[0].size, axis=1).reshape(len(base), *theta.shape[1:])
        found[self.rows] = theta
        return found


@lru_cache(maxsize=64)
def whole_of(model: Model) -> Whole | None:
    """The model among all effects; None where it has all of them, or one of its own that no registry holds."""
    whole = Model(with_all_effects(model.profile), model.ties)
    known = {id(effect) for effect in whole.effects}
    if len(known) == len(model.effects) or any(id(effect) not in known for effect in model.effects):
        return None
    return Whole(whole, np.array([whole.rows[name] for name in model.rows]))
