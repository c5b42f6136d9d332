"""Which manoeuvres make up the sets of Wakita et al. (ensemble learning), tables 2 to 4 and 6, and how they are run.

Everything is sailed by the 3 m model in her own time and scaled to the ship that is asked for: by Froude's law that is
the motion of the larger ship, to rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model import Model
from ..options import MakeOptions
from ..units import DEG
from .orders import AtRandom, Zigzags
from .pilot import Berthing
from .sailing import Commander, Sailed, sail

ANGLES = (5, 10, 15, 20, 25, 30)
"""Of zigzags and turning circles [deg]: table 3."""

STRONGEST = 1.5
"""Largest mean wind [m/s] over the model, 21 kn over the ship (assumption)."""

DRIFTING = 0.3
"""Largest speed [m/s] of the model at which orders at random begin (assumption)."""

STEP = 0.1
"""Of the integration, in the model's time [s]: table 2."""


@dataclass(frozen=True)
class Plan:
    """One set.

    about     in words
    ids       of its trials; manoeuvres what each is
    total     time of all trials together [s], by scale
    windy     whether it has wind in the paper
    uneven    whether its trials differ in length
    command   (model, rng, seconds (n_trials,), headings) -> helmsman and states (6, n_trials) to begin with
    """

    name: str
    about: str
    ids: tuple[str, ...]
    manoeuvres: tuple[str, ...]
    total: dict[str, int]
    windy: bool
    command: Callable[[Model, np.random.Generator, FloatArray, FloatArray], tuple[Commander, FloatArray]]
    uneven: bool = False

    def durations(self, scale: str, rng: np.random.Generator) -> IntArray:
        """(n_trials,) whole seconds, ``total`` together; uneven ones lie within a fifth of the mean."""
        shares = rng.uniform(0.8, 1.2, len(self.ids)) if self.uneven else np.ones(len(self.ids))
        ends = np.round(np.cumsum(shares) / shares.sum() * self.total[scale]).astype(np.int64)
        found: IntArray = np.diff(ends, prepend=0)
        return found


def _berthing(
    model: Model, rng: np.random.Generator, seconds: FloatArray, headings: FloatArray
) -> tuple[Commander, FloatArray]:
    pilot = Berthing(model, rng, seconds, headings)
    return pilot, pilot.start(headings)


def _standard(
    model: Model, rng: np.random.Generator, seconds: FloatArray, headings: FloatArray
) -> tuple[Commander, FloatArray]:
    approach = model.profile.require_approach()
    angle = np.array(ANGLES) * DEG
    none = np.full(len(ANGLES), np.inf)
    both = np.concatenate([angle, angle])
    return Zigzags(both, np.concatenate([angle, none]), headings), _ahead(headings, np.full(len(both), approach.speed))


def _at_random(
    model: Model, rng: np.random.Generator, seconds: FloatArray, headings: FloatArray
) -> tuple[Commander, FloatArray]:
    n = len(headings)
    return AtRandom(rng, n, float(seconds.max())), _ahead(headings, rng.uniform(0.0, DRIFTING, n))


def _ahead(headings: FloatArray, speed: FloatArray) -> FloatArray:
    still = 0.0 * speed
    return np.stack([still, still, headings, speed, still, still])


def _numbered(letter: str, first: int, last: int) -> tuple[str, ...]:
    return tuple(f"{letter}{k:02d}" for k in range(first, last + 1))


PLANS: dict[str, Plan] = {
    plan.name: plan
    for plan in (
        Plan(
            "train-b",
            "berthing",
            _numbered("b", 1, 27),
            ("berthing",) * 27,
            {"model": 4770, "full": 32180},
            True,
            _berthing,
            uneven=True,
        ),
        Plan(
            "test-b",
            "berthing",
            _numbered("b", 28, 41),
            ("berthing",) * 14,
            {"model": 2304, "full": 16230},
            True,
            _berthing,
            uneven=True,
        ),
        Plan(
            "test-zt",
            "zigzags and turning circles",
            (*(f"z{k:02d}" for k in ANGLES), *(f"t{k:02d}" for k in ANGLES)),
            (*(f"zigzag {k}/{k}" for k in ANGLES), *(f"turning {k}" for k in ANGLES)),
            {"model": 2400, "full": 16800},
            False,
            _standard,
        ),
        Plan(
            "test-r",
            "orders at random",
            _numbered("r", 1, 10),
            ("random",) * 10,
            {"model": 2000, "full": 14000},
            True,
            _at_random,
        ),
    )
}
"""The sets there are, in the order of the paper; the paper's full scale has berthing only."""


def sailed(model: Model, plan: Plan, options: MakeOptions, root: float) -> tuple[Sailed, IntArray]:
    """A set as the model sails it in her own time, and how many samples of each trial count.

    root  of the length of the ship over that of the model
    """
    rng = np.random.default_rng([options.seed, [*PLANS].index(plan.name)])
    own = plan.durations(options.scale, rng)
    n = len(plan.ids)
    headings = rng.uniform(-np.pi, np.pi, n)
    windy = plan.windy if options.wind == "paper" else options.wind == "all"
    mean_wind = np.stack([rng.uniform(0.0, STRONGEST, n), rng.uniform(0.0, 2.0 * np.pi, n)])
    mean_wind[0] *= float(windy)
    commander, start = plan.command(model, rng, own / root, headings)
    n_samples = np.floor(own / options.sample + 1e-9).astype(np.int64) + 1
    seconds, sample = (int(n_samples.max()) - 1) * options.sample / root, options.sample / root
    return sail(model, commander, start, mean_wind, rng, seconds=seconds, sample=sample, step=STEP), n_samples
