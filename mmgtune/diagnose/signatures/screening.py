"""Scores: what each hypothesis promises to explain, and how large a score chance alone would bring."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import gammaincc

from ...arrays import FloatArray, IntArray
from ..bench.hypotheses import Hypothesis
from .hierarchy import ROUGHLY, Hierarchy
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
    spread     of values that differ between runs, in typical sizes; 0 for one value for all
    volume     what their integration costs, see ``hierarchy``; ``score`` is what is left after it
    """

    hypothesis: Hypothesis
    score: float
    step: FloatArray
    power: float
    share: float
    inflation: float
    spread: float = 0.0
    volume: float = 0.0

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
    return [_of_runs(linear, one) if one.by else _best_look(linear, one) for one in hypotheses]


def degrees(hypothesis: Hypothesis) -> int:
    """Numbers that are fitted for a hypothesis: of values that differ between runs, their means and their spread."""
    return len(hypothesis.variant) + bool(hypothesis.by)


@dataclass(frozen=True, eq=False)
class _Between:
    """Values that differ between runs, on directions.

    chance   what noise has along these, see ``Linear.chance``; noise: its covariance (k, k)
    residual (k,) along them; shown (k, n_names) the signatures of the values, and how long these are (n_names,)
    """

    chance: tuple[FloatArray, FloatArray]
    noise: FloatArray
    residual: FloatArray
    shown: FloatArray
    length: FloatArray
    hierarchy: Hierarchy


def _between_runs(linear: Linear, hypothesis: Hypothesis) -> _Between | None:
    """Values that differ between runs; None where no trial shows them."""
    if hypothesis.names not in linear.kept:
        linear.kept[hypothesis.names] = _worked_out(linear, hypothesis)
    found: _Between | None = linear.kept[hypothesis.names]
    return found


def _worked_out(linear: Linear, hypothesis: Hypothesis) -> _Between | None:
    columns = linear.columns_of(hypothesis.bases, hypothesis.groups)
    if not _shown(columns):
        return None
    Q = basis(columns)
    chance, shown = linear.chance(Q, own=True), Q.T @ columns
    noise = _covariance(*chance)
    hierarchy = Hierarchy(shown, noise, len(hypothesis.variant))
    return _Between(chance, noise, Q.T @ linear.residual, shown, np.linalg.norm(columns, axis=0), hierarchy)


def _covariance(by_block: FloatArray, by_trial: FloatArray) -> FloatArray:
    """Covariance (k, k) of what ``Linear.chance`` gives: noise with its memory, and what logged inputs leave open."""
    n_directions = int(by_block.shape[1])
    memory = max(1.0, float(np.sum(by_block**2)) / n_directions)
    own = np.einsum("cdk,cdl->kl", by_trial, by_trial) / by_trial.shape[1]
    return np.asarray(memory * np.eye(n_directions) + own)


def _of_runs(linear: Linear, hypothesis: Hypothesis) -> Score:
    """The score of values that differ between runs: twice the gain in likelihood once they are integrated out."""
    found = _between_runs(linear, hypothesis)
    n = len(hypothesis.names)
    if found is None:
        return Score(hypothesis, 0.0, np.zeros(n), 0.0, 0.0, 1.0)
    best = found.hierarchy.best(found.residual)
    along = found.shown @ best.values
    length = float(np.linalg.norm(along))
    inflation = max(1.0, float(along @ found.noise @ along) / length**2) if length > 0.0 else 1.0
    power = float(np.median(found.length))
    return Score(hypothesis, best.gain, best.values, power, 1.0, inflation, best.spread, best.volume)


def told_by(linear: Linear, hypothesis: Hypothesis, values: FloatArray) -> tuple[float, float]:
    """Spread of values (n_names,) in typical sizes that differ between runs, and what their integration costs."""
    found = _between_runs(linear, hypothesis)
    if found is None:
        return 0.0, 0.0
    best = found.hierarchy.best(-(found.shown @ values))
    return best.spread, best.volume


def _best_look(linear: Linear, hypothesis: Hypothesis) -> Score:
    """The score of a hypothesis by the look of it that explains most; power and share are those of a typical size."""
    looks = linear.looks(hypothesis.names)
    absent = linear.absent(hypothesis.names)
    own = [k for k, name in enumerate(hypothesis.names) if name in absent]
    power = float(np.linalg.norm(looks[0], axis=0).min()) if _shown(looks[0]) else 0.0
    share = float(linear.share[[linear.names.index(name) for name in absent]].min())
    best = Score(hypothesis, 0.0, np.zeros(len(hypothesis.names)), power, share, 1.0)
    for columns in looks:
        if not _shown(columns):  # a stall where no rudder angle is large enough, for example
            continue
        lengths = np.linalg.norm(columns, axis=0)
        Q, R = np.linalg.qr(columns / np.maximum(lengths, 1e-300))
        along = Q.T @ linear.residual
        score = float(along @ along)
        if score > best.score:
            step = np.zeros(len(hypothesis.names))
            step[own] = -np.linalg.lstsq(R, along, rcond=1e-8)[0] / np.maximum(lengths, 1e-300)
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
        scores: dict[int, FloatArray] = {}

        def add(score: FloatArray, parameters: int) -> None:
            """Keep the largest, of that many parameters: the most evidence is of the largest score."""
            scores[parameters] = np.maximum(scores.get(parameters, 0.0), score)

        for hypothesis in (one for one in hypotheses if one.by):
            found = _between_runs(linear, hypothesis)
            if found is None:
                continue
            drawn = self._drawn(found.chance, signs, pick)
            drawn += _lacking(found.chance, rng)
            gain = found.hierarchy.gains(drawn, found.hierarchy.spreads(ROUGHLY)).max(axis=0)
            add(gain, degrees(hypothesis))
        for hypothesis in (one for one in hypotheses if not one.by):
            for columns in linear.looks(hypothesis.names):
                if not _shown(columns):
                    continue
                Q = basis(columns)
                chance = linear.chance(Q)
                drawn = self._drawn(chance, signs, pick) + _lacking(chance, rng)
                add(np.sum(drawn**2, axis=0) / inflation(*chance), Q.shape[1])
        evidences = [_evidence(score, parameters) for parameters, score in scores.items()]
        self.largest = np.sort(np.max([np.zeros(DRAWS), *evidences], axis=0))

    @staticmethod
    def _drawn(chance: tuple[FloatArray, FloatArray], signs: FloatArray, pick: IntArray) -> FloatArray:
        """Simulated residuals (k, DRAWS) along directions, from what noise has along these."""
        by_block, by_trial = chance
        drawn = by_block.T @ signs
        for trial, picked in enumerate(pick):
            drawn += by_trial[trial][picked].T
        return np.asarray(drawn)

    def p_value(self, evidence: float) -> float:
        """Probability of evidence as strong as this anywhere in the search, were there nothing to find.

        Beyond what was simulated it falls as fast as the tail of a single score.
        """
        beyond = len(self.largest) - int(np.searchsorted(self.largest, evidence))
        if beyond >= 10:
            return beyond / len(self.largest)
        tail = float(self.largest[-10])
        return float(min(1.0, 10.0 / len(self.largest) * np.exp(min(0.0, tail - evidence))))


def _lacking(chance: tuple[FloatArray, FloatArray], rng: np.random.Generator) -> FloatArray:
    """(k, DRAWS) what noise has along directions beyond its blocks: these were freed of the directions themselves."""
    lacking = np.sqrt(np.maximum(0.0, 1.0 - np.sum(chance[0] ** 2, axis=0)))
    return np.asarray(lacking[:, None] * rng.standard_normal((len(lacking), DRAWS)))


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
