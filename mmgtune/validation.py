"""How well a model follows trials it is given: J of the fine-tuning paper and the standardised error L_MSE."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray
from .backends import STATES, Integrator, get_backend
from .model import Model
from .objective import cases_of, default_scales, make_objective
from .trial import Trial

DRAWS = 2000
"""Times runs are drawn anew for an interval."""


@dataclass(frozen=True)
class TrialScore:
    """One trial, or one window of it.

    trial      id of the whole trial
    run        name of the run it belongs to
    J          sum of squared differences of position and heading over L_pp and pi/4 (Suyama et al. 2023, eq. 39-40)
    squares    sum over samples of each state's squared difference over its sigma squared, by state
    n_samples  samples compared: complete ones after the first
    """

    id: str
    trial: str
    run: str
    manoeuvre: str
    J: float
    squares: Mapping[str, float]
    n_samples: int

    @property
    def L_MSE(self) -> float:
        """Mean over the samples of the sum over the six states (Wakita et al. 2022, eq. 26); inf where diverged."""
        return L_MSE([self])


def L_MSE(scores: Sequence[TrialScore]) -> float:
    """The standardised error over several trials: each sample counts alike; NaN where there is none."""
    n = sum(score.n_samples for score in scores)
    return float(sum(sum(score.squares.values()) for score in scores) / n) if n else float("nan")


def by_manoeuvre(scores: Sequence[TrialScore]) -> dict[str, list[TrialScore]]:
    """Scores by kind of manoeuvre, "" where trials do not say."""
    return _grouped(scores, lambda score: score.manoeuvre)


def by_run(scores: Sequence[TrialScore]) -> dict[str, list[TrialScore]]:
    """Scores by run: windows of one, and trials cut from one, together."""
    return _grouped(scores, lambda score: score.run)


def by_trial(scores: Sequence[TrialScore]) -> dict[str, list[TrialScore]]:
    """Scores by trial: the windows of one together."""
    return _grouped(scores, lambda score: score.trial)


def _grouped(scores: Sequence[TrialScore], key: Callable[[TrialScore], str]) -> dict[str, list[TrialScore]]:
    groups: dict[str, list[TrialScore]] = {}
    for score in scores:
        groups.setdefault(key(score), []).append(score)
    return groups


def score(
    model: Model,
    trials: Sequence[Trial],
    sigma: Mapping[str, float],
    *,
    theta: FloatArray | None = None,
    integrator: Integrator = Integrator("rk4"),
    backend: str = "compiled",
) -> list[TrialScore]:
    """Scores of trials, each simulated from its first measured state with its measured inputs.

    sigma  what differences of each state are divided by in L_MSE [SI], see ``objective.spread``
    theta  (n_rows, 1) coefficients, those of the profile where None
    Windows of long trials are trials like any other (``TrialSet.in_windows``).
    """
    cases = cases_of(trials, make_objective(model.L_pp, STATES), model.inputs)
    result = get_backend(backend).run(
        model, model.matrix() if theta is None else theta, cases, integrator=integrator, keep_states=True
    )
    assert result.states is not None  # asked for
    scales = default_scales(model.L_pp)
    found = []
    for i, trial in enumerate(trials):
        with np.errstate(all="ignore"):
            difference = (result.states[i, 0, : trial.n_samples] - trial.motion)[1:]
        difference = difference[np.isfinite(trial.motion[1:]).all(axis=1)]
        squares = dict(zip(STATES, np.sum(difference**2, axis=0).tolist(), strict=True))
        if result.diverged[i, 0]:
            squares = dict.fromkeys(STATES, float("inf"))
        found.append(
            TrialScore(
                trial.id,
                trial.whole,
                trial.run,
                trial.manoeuvre,
                sum(squares[name] / scales[name] ** 2 for name in ("x", "y", "psi")),
                {name: value / sigma[name] ** 2 for name, value in squares.items()},
                len(difference),
            )
        )
    return found


def improvement(
    before: Sequence[TrialScore],
    after: Sequence[TrialScore],
    measure: Callable[[Sequence[TrialScore]], float] = L_MSE,
    seed: int = 1,
) -> tuple[float, tuple[float, float] | None]:
    """Share of an error that is gone, and its 95 % interval by drawing runs anew; None with fewer than three runs.

    before, after  scores of the same trials by two models
    """
    share = 1.0 - measure(after) / measure(before)
    old, new = by_run(before), by_run(after)
    runs = list(old)
    if len(runs) < 3:
        return share, None
    rng = np.random.default_rng(seed)
    drawn = []
    for _ in range(DRAWS):
        chosen = rng.integers(len(runs), size=len(runs))
        a = measure([score for k in chosen for score in new[runs[k]]])
        b = measure([score for k in chosen for score in old[runs[k]]])
        drawn.append(1.0 - a / b)
    low, high = np.percentile(drawn, [2.5, 97.5])
    return share, (float(low), float(high))
