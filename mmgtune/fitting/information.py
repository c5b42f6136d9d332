"""What trials say about coefficients apart from anything known before: a quadratic of the logarithm of probability.

Near the optimum minus twice the logarithm is J over the weight s2 of ``weighing`` but for a constant, and

    log p(trials | theta) = constant - theta' H theta / 2 + b' theta,    H = S' S / s2,    b = H theta_0 - g

with derivatives S of the residuals and the slope g at the optimum theta_0 of the fit: none where J alone was made
small, that of the prior turned round where there was one.  H may be singular: where trials say nothing of a combination
it says nothing of it either.  An optimum on a bound of the box is taken to be there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from ..arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Information:
    """What trials say about some coefficients, in profile units.

    names   (n,) of the coefficients
    H       (n, n) minus the second derivatives of the logarithm of probability
    b       (n,) its first derivatives at 0
    before  (n,) pre-determined values
    known   (n,) how well each was known before any trial, one standard deviation: its formula's scatter, or a quarter
            of its box
    """

    names: tuple[str, ...]
    H: FloatArray
    b: FloatArray
    before: FloatArray
    known: FloatArray

    def apart_from(self, names: Sequence[str]) -> Self:
        """What they say of the others while these are open."""
        out = [k for k, name in enumerate(self.names) if name in names]
        kept = [k for k, name in enumerate(self.names) if name not in names]
        if not out:
            return self
        scale = np.sqrt(np.maximum(np.diag(self.H)[out], 1e-300))
        inverse = np.linalg.pinv(self.H[np.ix_(out, out)] / np.outer(scale, scale), hermitian=True)
        across = self.H[np.ix_(kept, out)] / scale @ inverse / scale
        return replace(
            self,
            names=tuple(self.names[k] for k in kept),
            H=self.H[np.ix_(kept, kept)] - across @ self.H[np.ix_(out, kept)],
            b=self.b[kept] - across @ self.b[out],
            before=self.before[kept],
            known=self.known[kept],
        )

    def and_of(self, other: Information) -> Self:
        """What both say of the same ship, by trials independent of each other."""
        names = tuple(dict.fromkeys((*self.names, *other.names)))
        H, b = np.zeros((len(names), len(names))), np.zeros(len(names))
        before, known = np.zeros(len(names)), np.zeros(len(names))
        for one in (other, self):
            at = [names.index(name) for name in one.names]
            H[np.ix_(at, at)] += one.H
            b[at] += one.b
            before[at], known[at] = one.before, one.known
        return replace(self, names=names, H=H, b=b, before=before, known=known)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        arrays = {name: getattr(self, name).tolist() for name in ("H", "b", "before", "known")}
        return {"names": list(self.names), **arrays}

    @classmethod
    def from_dict(cls, document: Mapping[str, Any]) -> Self:
        """Of a document.  Raises KeyError or ValueError where it is none."""
        n = len(document["names"])
        shapes = {"H": (n, n), "b": (n,), "before": (n,), "known": (n,)}
        arrays = {name: np.asarray(document[name], dtype=float).reshape(shape) for name, shape in shapes.items()}
        if not all(np.isfinite(one).all() for one in arrays.values()):
            raise ValueError("numbers that are not finite")
        return cls(tuple(str(name) for name in document["names"]), **arrays)
