"""Scores: what each hypothesis promises to explain, and how large a score chance alone would bring."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import gammaincc

from ..arrays import FloatArray
from .hypotheses import Hypothesis
from .linear import Linear, basis, inflation

DRAWS = 4000
"""Simulated data sets without any effect."""

UNDERFLOW = 1200.0
"""Chi-squared whose tail probability is still a number."""

NEVER = 1e-6
"""Length of a signature that no trial shows."""


@dataclass(frozen=True, eq=False)
class Score:
    """One hypothesis at a point where it is absent.

    score      fall of chi-squared it promises
    step       (n_parameters,) sizes that promise it, in typical sizes
    power      length of its signature beyond re-tuning, in deviations of the noise, for one typical size
    share      of its signature that survives re-tuning
    inflation  variance of what chance brings along it, over that of independent noise; 1 or more
    """

    hypothesis: Hypothesis
    score: float
    step: FloatArray
    power: float
    share: float
    inflation: float

    @property
    def evidence(self) -> float:
        """The score less its expectation by chance, comparable between hypotheses: -ln of its tail probability."""
        return evidence(self.score / self.inflation, max(1, len(self.step)))


def evidence(score: float, parameters: int) -> float:
    """-ln of the probability of a larger chi-squared of that many degrees of freedom."""
    return float(_evidence(np.array(score), parameters))


def _evidence(scores: FloatArray, parameters: int) -> FloatArray:
    """``evidence`` of many scores; beyond where the probability underflows it goes on as the exponential does."""
    half = 0.5 * np.minimum(scores, UNDERFLOW)
    return np.asarray(-np.log(gammaincc(0.5 * parameters, half)) + 0.5 * np.maximum(scores - UNDERFLOW, 0.0))


def scores(linear: Linear, hypotheses: Sequence[Hypothesis]) -> list[Score]:
    """The score of every hypothesis."""
    return [_best_look(linear, hypothesis) for hypothesis in hypotheses]


def _best_look(linear: Linear, hypothesis: Hypothesis) -> Score:
    """The score of a hypothesis by the look of it that explains most; power and share are those of a typical size."""
    looks = linear.looks(hypothesis.names)
    power = float(np.linalg.norm(looks[0], axis=0).min()) if _shown(looks[0]) else 0.0
    share = float(linear.share[[linear.names.index(name) for name in hypothesis.names]].min())
    best = Score(hypothesis, 0.0, np.zeros(len(hypothesis.names)), power, share, 1.0)
    for columns in looks:
        if not _shown(columns):  # a stall where no rudder angle is large enough, for example
            continue
        lengths = np.linalg.norm(columns, axis=0)
        Q, R = np.linalg.qr(columns / np.maximum(lengths, 1e-300))
        along = Q.T @ linear.residual
        score = float(along @ along)
        if score > best.score:
            step = -np.linalg.lstsq(R, along, rcond=1e-8)[0] / np.maximum(lengths, 1e-300)
            best = replace(best, score=score, step=step, inflation=linear.inflation(Q))
    return best


def _shown(columns: FloatArray) -> bool:
    """Whether any trial shows a signature."""
    return bool(np.linalg.norm(columns, axis=0).max() > NEVER)


class ChanceScores:
    """The largest evidence over the whole search in data without any effect, simulated at the fitted point.

    Blocks of the residual keep their place and change their sign at random, which keeps whatever memory and uneven
    size the noise has (wild bootstrap); noise of the logged inputs is added.  Each score is compared through its tail
    probability under its own inflation.
    """

    def __init__(self, linear: Linear, hypotheses: Sequence[Hypothesis], seed: int):
        rng = np.random.default_rng(seed)
        signs = rng.choice([-1.0, 1.0], size=(len(linear.blocks), DRAWS))
        n_draws = linear.wander.shape[1]
        pick = rng.integers(n_draws, size=(len(linear.cases), DRAWS))
        self.largest = np.zeros(DRAWS)
        for hypothesis in hypotheses:
            for columns in linear.looks(hypothesis.names):
                if not _shown(columns):
                    continue
                Q = basis(columns)
                by_block, by_trial = linear.chance(Q)
                drawn = by_block.T @ signs
                for trial, picked in enumerate(pick):
                    drawn += by_trial[trial][picked].T
                score = np.sum(drawn**2, axis=0) / inflation(by_block, by_trial)
                self.largest = np.maximum(self.largest, _evidence(score, Q.shape[1]))
        self.largest.sort()

    def p_value(self, evidence: float) -> float:
        """Probability of evidence as strong as this anywhere in the search, were there nothing to find.

        Beyond what was simulated it falls as fast as the tail of a single score.
        """
        beyond = len(self.largest) - int(np.searchsorted(self.largest, evidence))
        if beyond >= 10:
            return beyond / len(self.largest)
        tail = float(self.largest[-10])
        return float(min(1.0, 10.0 / len(self.largest) * np.exp(min(0.0, tail - evidence))))


def angles(linear: Linear, hypotheses: Sequence[Hypothesis]) -> FloatArray:
    """Cosine of the smallest angle between what re-tuning leaves of two hypotheses' signatures, (n, n)."""
    bases = []
    for hypothesis in hypotheses:
        columns = linear.columns(hypothesis.names)
        bases.append(basis(columns) if _shown(columns) else None)
    cosine = np.eye(len(hypotheses))
    for i, a in enumerate(bases):
        for j in range(i):
            b = bases[j]
            if a is not None and b is not None:
                cosine[i, j] = cosine[j, i] = min(1.0, float(np.linalg.norm(a.T @ b, 2)))
    return cosine
