"""What trials say about coefficients apart from anything known before: a quadratic of the logarithm of probability.

Near the optimum minus twice the logarithm is J over the weight s2 of ``weighing`` but for a constant, and

    log p(trials | theta) = constant - theta' H theta / 2 + b' theta,    H = S' S / s2,    b = H theta_0 - g

with derivatives S of the residuals and the slope g at the optimum theta_0 of the fit: none where J alone was made
small, that of the prior turned round where there was one.  H may be singular: where trials say nothing of a combination
it says nothing of it either.  An optimum on a bound of the box is taken to be there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from ..arrays import FloatArray

ROUNDING = 1e-6
"""Share of the largest entry, in units of what was known before, by which a matrix of a file may miss its form."""


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
        """What the trials say about the other coefficients while these are unknown."""
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
        """Sum of two pieces of information on the same ship, from independent trials."""
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
        """From a document.  Raises KeyError or ValueError where it is none."""
        if not isinstance(document, Mapping):
            raise ValueError("it is no table")
        names = document["names"]
        if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
            raise ValueError("'names' is no list of names")
        if len(set(names)) < len(names):
            raise ValueError("'names' has a name twice")
        n = len(names)
        shapes = {"H": (n, n), "b": (n,), "before": (n,), "known": (n,)}
        found = cls(tuple(names), **{name: _numbers(document[name], name, shape) for name, shape in shapes.items()})
        if not (found.known > 0.0).all():
            raise ValueError("'known' holds standard deviations, which are above 0")
        if not _is_information(found.H, found.known):
            raise ValueError("'H' is not symmetric, or not positive semidefinite: no trials say that")
        return found


def _numbers(value: object, name: str, shape: tuple[int, ...]) -> FloatArray:
    """Finite numbers of a document in a shape.  Raises ValueError for anything else."""
    found = np.asarray(value)
    if found.dtype.kind not in "iuf" or not np.isfinite(found).all():
        raise ValueError(f"'{name}' has something in it that is no finite number")
    if found.size != math.prod(shape):
        raise ValueError(f"'{name}' has {found.size} numbers for {math.prod(shape)}")
    return found.astype(float).reshape(shape)


def _is_information(H: FloatArray, known: FloatArray) -> bool:
    """Whether a matrix is one of second derivatives about a maximum, but for rounding."""
    with np.errstate(all="ignore"):
        whole = H * np.outer(known, known)
    rounding = ROUNDING * np.abs(whole).max(initial=1.0)
    if not np.isfinite(rounding) or (np.abs(whole - whole.T) > rounding).any():
        return False
    return bool(np.linalg.eigvalsh(whole).min(initial=0.0) >= -rounding)
