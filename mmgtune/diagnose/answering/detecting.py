"""What the trials could tell of each hypothesis, before looking at what they do tell."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..bench.workbench import Workbench
from ..causes.cause import Detectability
from ..searching.look import Step
from ..searching.refit import ENOUGH, WORTH
from ..signatures.linear import Linear, typical
from ..signatures.screening import NEVER, angles

TWINS = 3
"""Most similar effects listed for each."""


def detectability(bench: Workbench, step: Step) -> list[Detectability]:
    """Detectability of every named hypothesis, from the first look."""
    named = [s for s in step.scores if not s.hypothesis.effect.one_of_many and not s.hypothesis.by]
    cosine = angles(step.linear, [s.hypothesis for s in named])
    found = []
    for i, score in enumerate(named):
        h = score.hypothesis
        needed = ENOUGH + len(h.names) * bench.price
        power = told_apart(step.linear, h.names)
        sizes = math.sqrt(needed * score.inflation) / power if power > 0.0 else math.inf
        sizes = max(sizes, WORTH, *(step.linear.reach.get(name, 0.0) for name in h.names))
        nearest: dict[str, int] = {}  # of each other effect
        for j in np.argsort(-cosine[i]):
            nearest.setdefault(named[j].hypothesis.tag, int(j))
        order = [j for tag, j in nearest.items() if tag != h.tag][:TWINS]
        found.append(
            Detectability(
                h.tag,
                tuple(h.variant),
                score.share,
                score.power,
                {name.rpartition(".")[2]: _limit(bench, name, sizes) for name in h.names},
                {name: h.effect.parameters[name].unit for name in h.variant},
                tuple((named[j].hypothesis.tag, math.degrees(math.acos(min(1.0, cosine[i, j])))) for j in order),
            )
        )
    return found


def told_apart(linear: Linear, names: Sequence[str]) -> float:
    """Smallest signal-to-noise ratio over the hypothesis's signatures.

    Of parameters of a typical size, what re-tuning cannot imitate, in deviations of the noise: the shortest of the
    signatures at a tiny, a small and a typical size that show at all.

    A large effect that is not linear leaves more in the linear problem than after a fit: water 20 m deep leaves
    hundreds of deviations there, though a refitted hull with leeway follows it almost entirely.
    """
    looks = (*linear.looks(names), linear.slopes(names))
    lengths = [float(np.linalg.norm(look, axis=0).min()) for look in looks]
    return min((length for length in lengths if length > NEVER), default=0.0)


def _limit(bench: Workbench, name: str, sizes: float) -> float | None:
    """Value of a parameter at ``sizes`` typical sizes from the profile's; None where no value of its range is that
    far."""
    parameter = bench.parameter(name)
    i = bench.box.names.index(name)
    if any(i == direction for _, direction in bench.box.polar):
        return None
    step = sizes * typical(bench, name) * float(bench.box.width[i])
    value = parameter.searched(float(bench.box.pre[i])) + step
    if any(i == size for size, _ in bench.box.polar):
        return value if value <= bench.box.high[i] else None
    if parameter.chart == "reciprocal" and value <= bench.box.low[i]:  # nothing happens that far
        return None
    return parameter.searched(value) if value <= bench.box.high[i] else None
