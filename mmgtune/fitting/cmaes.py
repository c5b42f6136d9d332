"""Restart CMA-ES within the box: Hansen's covariance matrix adaptation by the ``cma`` package.

The paper uses the box constraint handling of Sakamoto & Akimoto 2017; here the box is the image of all space under
unit = (1 - cos(pi z)) / 2.  That map is smooth, periodic and mirrored, so an optimum on a bound is an ordinary interior
minimum of what CMA-ES sees and is reached exactly, and the strategy never learns of bounds at all.

A run is a function of its seed and of the costs it was told.  So a checkpoint holds the costs, and resuming replays
them: bit-identical, without a pickle.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import astuple, dataclass, field
from typing import Any

import numpy as np

from ..arrays import FloatArray
from .journal import remembered
from .problem import FitProblem

LAMBDAS = (12, 24, 48, 96, 128)
"""Population sizes: 12 at first, doubled at each restart, up to 128 (Suyama et al. 2023, section 5)."""

USUAL_GENERATIONS = (700, 500, 400, 300, 220)
"""Generations of each restart, as counted for SUZAKU's 12 targets: what is left of a search is told by them."""

SIGMA_0 = 0.25
"""First step size in z; the whole box is one unit of it."""

FAILED = 1e30
"""What the strategy is told of a candidate that diverged: bad, but a number it can rank."""


def to_box(z: FloatArray) -> FloatArray:
    """Positions in the unit cube of points of the search space."""
    return 0.5 - 0.5 * np.cos(math.pi * z)


def from_box(unit: FloatArray) -> FloatArray:
    """A point of the search space that maps to a position in the unit cube."""
    return np.arccos(1.0 - 2.0 * np.clip(unit, 0.0, 1.0)) / math.pi


@dataclass(frozen=True)
class Restart:
    """How one restart went; ``stop`` says in the terms of the ``cma`` package why it ended."""

    population: int
    J: float
    generations: int
    evaluations: int
    stop: str


@dataclass(frozen=True)
class Generation:
    """One generation: what progress displays and the history file show."""

    restart: int
    generation: int
    evaluations: int
    population: int
    J: float
    J_best: float
    sigma: float


@dataclass(eq=False)
class Search:
    """What a search has found so far."""

    unit: FloatArray
    J: float
    restarts: list[Restart] = field(default_factory=list)
    history: list[Generation] = field(default_factory=list)
    costs: list[FloatArray] = field(default_factory=list)
    diverged: int = 0
    finished: bool = False


def _asked(
    problem: FitProblem, seed: int, start: FloatArray, populations: tuple[int, ...], tolerance: float | None, **_: Any
) -> list[Any]:
    """Numbers and texts that identify a search in a journal."""
    return ["search", *problem.asked(), seed, start, tolerance, populations]


def _noted(found: Search) -> dict[str, Any]:
    return {
        "unit": found.unit.tolist(),
        "J": found.J,
        "restarts": [list(astuple(one)) for one in found.restarts],
        "history": [list(astuple(one)) for one in found.history],
        "diverged": found.diverged,
    }


def _recalled(noted: dict[str, Any]) -> Search:
    return Search(
        np.array(noted["unit"]),
        noted["J"],
        [Restart(*one) for one in noted["restarts"]],
        [Generation(*one) for one in noted["history"]],
        diverged=noted["diverged"],
        finished=True,
    )


@remembered(_asked, _noted, _recalled, lambda problem, **_: problem.counter)
def search(
    problem: FitProblem,
    seed: int,
    start: FloatArray,
    *,
    populations: tuple[int, ...] = LAMBDAS,
    tolerance: float | None = None,
    recorded: list[FloatArray] | None = None,
    on_generation: Callable[[Search], None] = lambda _: None,
    stop: Callable[[], bool] = lambda: False,
) -> Search:
    """Minimise J: the first restart from ``start`` (n_targets,) in the unit cube, the others from random points.

    tolerance       a restart ends once J varies by less than this; a 1e-9th of J at the start where None
    recorded        costs of generations of an earlier, interrupted run with the same problem and seed; replayed
    on_generation   called after every generation that was simulated
    stop            asked after every generation; True ends the search with what it has
    """
    replay: Iterator[FloatArray] = iter(recorded or [])
    found = Search(unit=start.copy(), J=float(problem.costs(start[:, None])[0]))
    if tolerance is None:
        tolerance = 1e-9 * found.J if np.isfinite(found.J) else 1e-9
    evaluations = 0
    for index, population in enumerate(populations):
        rng = np.random.RandomState(np.random.SeedSequence([seed, index]).generate_state(4))
        origin = start if index == 0 else rng.uniform(size=len(start))
        strategy = _strategy(from_box(origin), population, rng, tolerance)
        best = math.inf
        generation = 0
        while not strategy.stop():
            asked = strategy.ask()
            unit = to_box(np.array(asked).T)
            costs = next(replay, None)
            fresh = costs is None
            if costs is None:
                costs = problem.costs(unit)
            else:
                problem.counter.evaluations += population  # when they were made
            found.costs.append(costs)
            failed = ~np.isfinite(costs)
            found.diverged += int(failed.sum())
            strategy.tell(asked, np.where(failed, FAILED, costs).tolist())
            generation += 1
            evaluations += population
            k = int(np.argmin(costs))
            best = min(best, float(costs[k]))
            if costs[k] < found.J:
                found.J, found.unit = float(costs[k]), unit[:, k].copy()
            found.history.append(
                Generation(index, generation, evaluations, population, float(costs[k]), found.J, float(strategy.sigma))
            )
            if fresh:
                on_generation(found)
            if stop():
                found.restarts.append(Restart(population, best, generation, generation * population, "interrupted"))
                return found
        reason = ", ".join(strategy.stop())
        found.restarts.append(Restart(population, best, generation, generation * population, reason))
    found.finished = True
    return found


def _strategy(z: FloatArray, population: int, rng: np.random.RandomState, tolerance: float) -> Any:
    """A strategy with a random stream of its own, which writes and reads no files."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import cma

        options = {
            "popsize": population,
            "seed": math.nan,  # with randn given, cma leaves NumPy's global stream alone
            "randn": rng.randn,
            "verbose": -9,
            "verb_log": 0,
            "signals_filename": None,
            "tolfun": tolerance,
            "tolfunhist": 1e-3 * tolerance,
            "tolx": 1e-9,
            "tolflatfitness": 20,
        }
        return cma.CMAEvolutionStrategy(z.tolist(), SIGMA_0, options)
