"""What the data says about each coefficient, what it says about combinations only, and what it does not say."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Literal, NamedTuple

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..displayed import Brief
from .combinations import COMBINATIONS
from .problem import FitProblem
from .whitening import estimate_whitening

NULL_RATIO = 1e-6
"""Singular values below this share of the largest are zero but for the rounding of finite differences."""

CHECK_STEP = 1e-3
"""Share of a step of 1 % over which a direction is checked by simulation: trading is exact along a curve only."""

LEAST_PART = 0.02
"""Share of a direction's largest weight from which a coefficient counts as taking part in it."""


class Undetermined(NamedTuple):
    """Why a target has no value of its own: "traded" against others, or "weak", less known than its box is wide."""

    kind: Literal["traded", "weak"]
    words: str


@dataclass(frozen=True, repr=False)
class NullDirection(Brief):
    """Coefficients that can be traded against each other without changing any simulated motion.

    weights  relative change of each member [%] for one step of 1 % of the first
    largest_shift  largest change of any simulated position [m] over a thousandth of that step
    """

    weights: dict[str, float]
    largest_shift: float

    @property
    def sentence(self) -> str:
        """The direction in words."""
        parts = ", ".join(f"{name} {weight:+.3g} %" for name, weight in self.weights.items())
        return (
            f"No trial can tell these coefficients apart: {parts} together leave every simulated motion unchanged "
            f"(a thousandth of this step shifts no position by more than {self.largest_shift:.1e} m). "
            f"Only combinations of them are known; hold one with fixed={next(iter(self.weights))}."
        )


@dataclass(frozen=True)
class KnownCombination:
    """A combination the data determines, with its standard error."""

    expression: str
    value: float
    stderr: float


@dataclass(frozen=True, eq=False, repr=False)
class Identifiability(Brief):
    """Result of the analysis at one point.

    names            targets, the order of everything below
    singular_values  of the whitened derivatives by relative change of each target, largest first [-]
    stderr           per target, in profile units; None on a bound or where the data does not determine it
    correlation      names and matrix for the targets that have a standard error
    undetermined     targets the data does not determine, each with why
    autocorrelation  of neighbouring residuals per channel
    from_data        (n_directions,) for combinations of targets, largest first, how much better the trials know each
                     than prior and box do, as a ratio of standard deviations; None without terms beside J
    """

    names: tuple[str, ...]
    singular_values: FloatArray
    stderr: dict[str, float | None]
    correlation_names: tuple[str, ...]
    correlation: FloatArray
    null_directions: tuple[NullDirection, ...]
    undetermined: dict[str, Undetermined]
    combinations: tuple[KnownCombination, ...]
    autocorrelation: dict[str, float]
    from_data: FloatArray | None = None
    sentences: tuple[str, ...] = field(default=())

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "names": list(self.names),
            "singular_values": self.singular_values.tolist(),
            "correlation": {"names": list(self.correlation_names), "matrix": self.correlation.tolist()},
            "null_directions": [
                {"sentence": d.sentence, "weights": d.weights, "largest_shift_m": d.largest_shift}
                for d in self.null_directions
            ],
            "combinations": [
                {"expression": c.expression, "value": c.value, "stderr": c.stderr} for c in self.combinations
            ],
            "undetermined": {name: of.words for name, of in self.undetermined.items()},
            "undetermined_why": {name: of.kind for name, of in self.undetermined.items()},
            "autocorrelation": self.autocorrelation,
            **({} if self.from_data is None else {"from_data": self.from_data.tolist()}),
            "sentences": list(self.sentences),
        }


def analyse(problem: FitProblem, unit: FloatArray, active: BoolArray) -> Identifiability:
    """Identifiability at a point of the unit cube (n_targets,); ``active`` marks targets held by their bound.

    Standard errors are those of the whitened, linearised problem over the targets that are free, together with the
    initial states where the problem estimates these; they leave out errors of the model itself, and of measured initial
    states that are held.
    """
    box = problem.box
    residuals, jacobian = problem.central_jacobian(unit)
    whitening = estimate_whitening(problem, residuals)
    relative = box.relative
    sensitivity = jacobian * (relative / box.width)
    if problem.terms:  # every row over its deviation, as ``terms`` counts them
        sensitivity /= np.sqrt(problem.weight)
        if problem.sigma is not None:
            by_offset = problem.central_offsets(unit) / np.sqrt(problem.weight)
            sensitivity = problem.without_offsets(sensitivity, by_offset, problem.prior / problem.weight)
    else:
        sensitivity = whitening.apply(sensitivity)
        if problem.sigma is not None:
            by_offset = whitening.apply(problem.central_offsets(unit))
            sensitivity = problem.without_offsets(sensitivity, by_offset, problem.sigma**-2.0)
    from_data = _from_data(problem, sensitivity) if problem.terms else None
    lacking = len(box) - len(sensitivity)
    if lacking > 0:  # fewer numbers than targets: the rest of the directions is null
        sensitivity = np.vstack([sensitivity, np.zeros((lacking, len(box)))])
    _, singular, vectors = np.linalg.svd(sensitivity, full_matrices=False)
    null = singular < NULL_RATIO * singular[0]
    directions = tuple(_direction(problem, unit, relative, v) for v in _sparse(vectors[null]))

    undetermined: dict[str, Undetermined] = {}
    for direction in directions:
        for name in direction.weights:
            undetermined[name] = Undetermined("traded", "only combinations of it with others show in the motion")
    stderr, covariance, known = _errors(sensitivity, ~active)
    for i, name in enumerate(box.names):
        half = 0.5 * box.width[i] / relative[i]
        if name not in undetermined and not active[i] and not stderr[i] < half:
            words = f"its standard error exceeds the half width of its box, {half:.0%} of its value"
            undetermined[name] = Undetermined("weak", words)
    usable = [i for i in range(len(box)) if known[i] and box.names[i] not in undetermined]
    deviation = np.sqrt(np.diag(covariance))[usable]
    correlation = covariance[np.ix_(usable, usable)] / np.outer(deviation, deviation)
    result = Identifiability(
        names=box.names,
        singular_values=singular,
        # A size with a direction, or a reciprocal, has no error of its own in these coordinates.
        stderr={
            name: float(stderr[i] * relative[i]) if i in usable and i not in box.charted else None
            for i, name in enumerate(box.names)
        },
        correlation_names=tuple(box.names[i] for i in usable),
        correlation=correlation,
        null_directions=directions,
        undetermined=undetermined,
        combinations=_combinations(problem, unit, relative, singular, vectors, null),
        autocorrelation=whitening.phi,
        from_data=from_data,
    )
    return replace(result, sentences=_sentences(problem, result, active))


def _from_data(problem: FitProblem, sensitivity: FloatArray) -> FloatArray:
    """See ``Identifiability``; a target without a formula is known beforehand to a quarter of its box."""
    box = problem.box
    known = 0.25 * box.width
    own = len(sensitivity)
    for term in reversed(problem.terms):
        rows = term.n_rows(problem)
        if term.known_before:
            sensitivity = np.delete(sensitivity, np.s_[own - rows : own], axis=0)
        own -= rows
    for i in range(len(box)):
        formula = box.prior_of(i)
        known[i] = formula[1] if formula else known[i]
    return np.asarray(np.linalg.svd(sensitivity * (known / box.relative), compute_uv=False))


def _errors(sensitivity: FloatArray, free: BoolArray) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Relative standard errors (inf where unknown), covariance, which targets have one; null directions left out."""
    n = sensitivity.shape[1]
    covariance = np.zeros((n, n))
    error = np.full(n, np.inf)
    if free.any():
        _, s, v = np.linalg.svd(sensitivity[:, free], full_matrices=False)
        kept = s > NULL_RATIO * s[0]
        covariance[np.ix_(free, free)] = (v[kept].T / s[kept] ** 2) @ v[kept]
        taking_part = (
            (np.abs(v[~kept]) > LEAST_PART).any(axis=0) if (~kept).any() else np.zeros(int(free.sum()), dtype=bool)
        )
        deviation = np.sqrt(np.diag(covariance)[free])
        error[free] = np.where(taking_part, np.inf, deviation)
    return error, covariance, np.isfinite(error)


def _sparse(vectors: FloatArray) -> list[FloatArray]:
    """A basis of the same space in which as many members as possible are zero (reduced row echelon, by pivots)."""
    basis = vectors.copy()
    for k in range(len(basis)):
        pivot = int(np.argmax(np.abs(basis[k])))
        basis[k] /= basis[k, pivot]
        for other in range(len(basis)):
            if other != k:
                basis[other] -= basis[other, pivot] * basis[k]
    return list(basis)


def _direction(problem: FitProblem, unit: FloatArray, relative: FloatArray, vector: FloatArray) -> NullDirection:
    """The direction in percent of each member, scaled to 1 % of a member near the middle of the range, and checked."""
    box = problem.box
    members = np.flatnonzero(np.abs(vector) > LEAST_PART * np.abs(vector).max())
    values = box.from_unit(unit)
    percent = 100.0 * vector * relative / np.where(values != 0.0, values, relative)
    # The unit is a member of middling weight; of those that scale alike the first target, whatever the rounding.
    sizes = [float(f"{abs(percent[i]):.3g}") for i in members]
    first = members[sizes.index(sorted(sizes)[len(sizes) // 3])]
    factor = 1.0 / percent[first]
    step = CHECK_STEP * vector * relative * factor / box.width
    shift = 0.0
    if len(problem.cases):
        states = problem.states(np.column_stack([unit, unit + step])).states
        shift = np.abs(states[:, 1, :, :2] - states[:, 0, :, :2]).max()
    ordered = [first, *(i for i in members if i != first)]
    return NullDirection({box.names[i]: float(percent[i] * factor) for i in ordered}, float(shift))


def _combinations(
    problem: FitProblem,
    unit: FloatArray,
    relative: FloatArray,
    singular: FloatArray,
    vectors: FloatArray,
    null: BoolArray,
) -> tuple[KnownCombination, ...]:
    """Offered combinations that involve an undetermined target and are constant along every null direction."""
    if not null.any():
        return ()
    box, profile = problem.box, problem.model.profile
    names = profile.names()
    values = {name: profile.value(name) for name in names}
    values.update(zip(box.names, box.from_unit(unit).tolist(), strict=True))
    known: list[KnownCombination] = []
    for offered in COMBINATIONS:
        if not set(offered.needs) <= set(values) or not set(offered.needs) & set(box.names):
            continue
        gradient = np.zeros(len(box))
        for i, name in enumerate(box.names):
            if name in offered.needs:
                h = 1e-6 * relative[i]
                above, below = ({**values, name: values[name] + side * h} for side in (1.0, -1.0))
                gradient[i] = (offered.value(above) - offered.value(below)) / (2e-6)
        along = np.abs(vectors[null] @ gradient) / np.linalg.norm(gradient)
        if along.max() < 1e-3:
            variance = np.sum((vectors[~null] @ gradient) ** 2 / singular[~null] ** 2)
            known.append(KnownCombination(offered.expression, float(offered.value(values)), float(np.sqrt(variance))))
    return tuple(known)


def _decided(problem: FitProblem, from_data: FloatArray) -> str:
    """What the trials decide and what the prior does."""
    n = len(problem.box)
    decided = int(np.sum(from_data > 1.0))
    formulas = len(problem.box.from_formula)
    prior = any(term.known_before for term in problem.terms)
    rest = "the prior decides the rest" if formulas and prior else "the box holds the rest"
    numbers = sum(term.n_rows(problem) for term in problem.terms if not term.known_before)
    given = f"{numbers} stated numbers, {n} coefficients: " if numbers and not problem.n_residuals else ""
    return (
        f"{given}The trials determine {decided} of {n} combinations of the targets better than they were known "
        f"beforehand; {rest}."
    )


def _sentences(problem: FitProblem, result: Identifiability, active: BoolArray) -> tuple[str, ...]:
    """The findings in words, most important first."""
    n, lost = len(result.names), len(result.null_directions)
    sentences = [f"{n - lost} of {n} combinations of the targets can be known from these trials."]
    if result.from_data is not None:
        sentences = [_decided(problem, result.from_data)]
    if problem.n_residuals:  # a few stated numbers leave more directions open than anybody reads
        sentences += [direction.sentence for direction in result.null_directions]
    weak = [name for name, of in result.undetermined.items() if of.kind == "weak"]
    if weak:
        sentences.append(f"Not determined by these trials within their box: {', '.join(weak)}.")
    held = [name for name, on in zip(result.names, active, strict=True) if on]
    if held:
        sentences.append(f"Held by a bound, so known to one side only: {', '.join(held)}.")
    pairs = [
        (abs(result.correlation[i, j]), a, b)
        for i, a in enumerate(result.correlation_names)
        for j, b in enumerate(result.correlation_names[:i])
        if abs(result.correlation[i, j]) > 0.95
    ]
    if pairs:
        worst = ", ".join(f"{a} with {b} ({value:.3f})" for value, a, b in sorted(pairs, reverse=True)[:4])
        sentences.append(f"Strongly correlated, so hardly known one by one: {worst}.")
    phi = max(result.autocorrelation.values(), default=0.0)
    if problem.terms:
        sentences.append(
            "Standard errors are of trials and prior together, by the weight between them; "
            "they do not cover errors of the model's form."
        )
        return tuple(sentences)
    sentences.append(
        f"Standard errors take account of neighbouring residuals being correlated (up to {phi:.3f}); "
        "they do not cover errors of the model's form."
    )
    return tuple(sentences)
