"""Everything around a fitted point made linear: what an effect would change that re-tuning cannot imitate.

Signatures are differences over a typical size of the effect, not derivatives at its null: a lag of the rudder or a rate
limit has no slope there; over a larger one where an effect does nothing at a typical size.  An effect with one side
only gets another over a small size, as it need not look like a large one.  They are whitened, and freed of what the
initial states and the free coefficients explain.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...backends import STATES
from ...fitting.box import base_of, parameter_of
from ...fitting.problem import FitProblem
from ...fitting.quadratic import flat_where_lost
from ...profile import scale_of
from ..bench.inputs import wander
from ..bench.workbench import Point, Workbench

STEP = 1e-5
"""Step of derivatives, in the unit cube."""

SMALL = 0.1
"""A small size of an effect, as a share of the typical one."""

TINY = 1e-3
"""Size of an effect at which the response is linear, as a share of the typical one."""

FURTHER = (2.0, 4.0)
"""Sizes, in typical ones, at which an effect with one side only is looked at that does nothing at a typical size: a
limit of 2.6 deg/s cuts nothing off a rudder that is logged at 2.3 deg/s."""

ACTS = 0.5
"""Share of the change at a small size, in proportion, from which an effect acts at a tiny one: a lag within the step of
the log does not."""

BLOCK = 60.0
"""Length [s] of the pieces noise is resampled in."""

BOXED = 0.5
"""Standard deviation of a target, as a share of its box, when the size of a cause is estimated: targets far outside
their box are not allowed to imitate it."""

SAME = 1e-5
"""Directions whose signatures are shorter than this share of the longest are numerical noise."""

UNSURE = 0.02
"""Share by which the variance of the noise may be known wrongly."""


@dataclass(frozen=True, eq=False)
class Tuned:
    """The part of columns that re-tuning explains: all that free coefficients can change, and of what coefficients with
    leeway can change as much as they are expected to move.

    free   (n_rows, n) orthonormal basis of what free coefficients can change
    loose  (n_rows, k) directions of what coefficients with leeway change besides
    left   (k,) share of a column along each that is left
    """

    free: FloatArray
    loose: FloatArray
    left: FloatArray

    @classmethod
    def by(cls, free: FloatArray, loose: FloatArray) -> Tuned:
        """From what each free coefficient changes (n_rows, n), and each with leeway over its standard deviation."""
        Q = basis(free)
        directions, sizes, _ = np.linalg.svd(loose - Q @ (Q.T @ loose), full_matrices=False)
        return cls(Q, directions, 1.0 / np.sqrt(1.0 + sizes**2))

    def out_of(self, columns: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Re-tuning projected out of ``columns`` (n_rows, k); independent noise of variance 1 and coefficients with
        leeway together have variance 1 in the result.

        out  where that is written to, ``columns`` themselves perhaps
        """
        explained = self.free @ (self.free.T @ columns)
        rest = np.subtract(columns, explained, out=out)
        np.matmul(self.loose, (1.0 - self.left)[:, None] * (self.loose.T @ rest), out=explained)
        rest -= explained
        return np.asarray(rest)


def measured_rows(cases: IntArray, n_rows: int) -> BoolArray:
    """(n_rows,) which rows are residuals, where those of each case end with its six initial offsets.

    cases  first rows of the cases
    """
    rows = np.ones(n_rows, dtype=bool)
    for end in np.append(cases[1:], n_rows):
        rows[end - len(STATES) : end] = False
    return rows


@dataclass(frozen=True, eq=False)
class Linear:
    """The problem made linear at a point.  Rows: whitened residuals of each trial, then its six initial offsets.

    residual    (n_rows,) less what free coefficients and initial states explain
    names       parameters with a signature
    signature   (n_rows, n_names) likewise, scaled to one typical size of each
    one_sided   parameters whose null is an end of their range
    small       (n_rows, n_one_sided) signatures of one-sided parameters over a small size, scaled to a typical one
    tiny        as ``small``, over a size so small that the response is linear, if the effect acts there
    share       (n_names,) of the signature's length that re-tuning leaves
    reach       sizes, in typical ones, that signatures are over of parameters that do nothing at a typical one, by name
    noise       (n_rows,) the residual less all signatures: hardly anything but noise
    wander      (n_rows, DRAWS) what other noise of the logged inputs would change
    blocks      first rows of pieces of about a minute of one trial
    cases       first rows of the trials
    tuned       what re-tuning takes out of columns
    plain       signatures (n_rows,) of what may differ between runs, by name, coefficients not taken out
    groups      of each trial
    retuned     what re-tuning leaves of changes of whitened residuals (n_residuals, k): (n_rows, k)
    fitted      as ``retuned``, with all signatures projected out too, as they are out of ``noise``: (n_rows, k)
    kept        cache of derived quantities
    """

    residual: FloatArray
    names: tuple[str, ...]
    signature: FloatArray
    one_sided: tuple[str, ...]
    small: FloatArray
    tiny: FloatArray
    share: FloatArray
    reach: Mapping[str, float]
    noise: FloatArray
    wander: FloatArray
    blocks: IntArray
    cases: IntArray
    tuned: Tuned
    plain: Mapping[str, FloatArray]
    groups: tuple[frozenset[str], ...]
    retuned: Callable[[FloatArray], FloatArray]
    fitted: Callable[[FloatArray], FloatArray]
    kept: dict[Any, Any] = field(default_factory=dict)

    def with_inputs_seen(self, chi2: float, explained: FloatArray) -> Linear:
        """With no more left open by the inputs than a fit shows that leaves ``chi2``.

        What other inputs change is part of what is left beyond noise, wherever the fit does not explain it.  They may
        be as large as would leave no more than that even with the draw that leaves least.

        explained  (n_rows, k) what the fit explains besides re-tuning
        """
        Q = basis(explained)
        least = float(np.min(np.sum((self.wander - Q @ (Q.T @ self.wander)) ** 2, axis=0)))
        n = int(np.count_nonzero(self.measured))
        left = max(chi2 - n, 0.0) + UNSURE * n
        return self if left >= least else replace(self, wander=np.sqrt(left / least) * self.wander, kept={})

    @property
    def measured(self) -> BoolArray:
        """(n_rows,) which rows are residuals; the others are offsets."""
        return measured_rows(self.cases, len(self.residual))

    def columns(self, names: Sequence[str]) -> FloatArray:
        """Signatures of some parameters, (n_rows, n_parameters)."""
        return np.asarray(self.signature[:, [self.names.index(name) for name in names]])

    def columns_of(self, bases: Sequence[str], groups: Sequence[str]) -> FloatArray:
        """Signatures of values that groups of trials have of their own, (n_rows, n_groups * n_parameters).

        A parameter that is free for all already has none in the direction of all.
        """
        ends = np.append(self.cases[1:], len(self.residual))
        found = np.zeros((len(self.residual), len(groups) * len(bases)))
        k = 0
        for group in groups:
            for base in bases:
                for first, end, own in zip(self.cases, ends, self.groups, strict=True):
                    if group in own:
                        found[first:end, k] = self.plain[base][first:end]
                k += 1
        return self.tuned.out_of(found)

    def absent(self, names: Sequence[str]) -> list[str]:
        """The given parameters that are not free already."""
        return [name for name in names if name in self.names]

    def looks(self, names: Sequence[str]) -> list[FloatArray]:
        """Signatures of some parameters, each (n_rows, n_parameters): at a typical size and, where these differ, at a
        small one."""
        names = self.absent(names)
        return [self.columns(names), *([self._over(self.small, names)] if set(names) & set(self.one_sided) else [])]

    def slopes(self, names: Sequence[str]) -> FloatArray:
        """(n_rows, n_parameters) signatures of some parameters at sizes so small that the response is linear."""
        return self._over(self.tiny, self.absent(names))

    def _over(self, sizes: FloatArray, names: Sequence[str]) -> FloatArray:
        """Signatures of some parameters, with the one-sided ones over another size, (n_rows, n_one_sided)."""
        found = self.columns(names)
        for i, name in enumerate(names):
            if name in self.one_sided:
                found[:, i] = sizes[:, self.one_sided.index(name)]
        return found

    def chance(self, Q: FloatArray, own: bool = False) -> tuple[FloatArray, FloatArray]:
        """Components of the noise along orthonormal directions Q (n_rows, k): by block (n_blocks, k), and by trial and
        draw of the input noise (n_cases, DRAWS, k).

        own  whether ``noise`` still holds the signal along these directions, which is then taken out first
        """
        noise = self.noise - Q @ (Q.T @ self.noise) if own else self.noise
        by_block = np.add.reduceat(Q * noise[:, None], self.blocks, axis=0)
        ends = np.append(self.cases[1:], len(Q))
        by_trial = [self.wander[a:b].T @ Q[a:b] for a, b in zip(self.cases, ends, strict=True)]
        return by_block, np.array(by_trial)

    def inflation(self, Q: FloatArray) -> float:
        """Variance of noise along directions Q over that of independent noise of variance 1; at least 1."""
        return inflation(*self.chance(Q))


def inflation(by_block: FloatArray, by_trial: FloatArray) -> float:
    """Variance of what ``Linear.chance`` gives over that of independent noise of variance 1; at least 1."""
    n_directions = int(by_block.shape[1])
    memory = max(1.0, float(np.sum(by_block**2)) / n_directions)
    return memory + float(np.sum(np.mean(by_trial**2, axis=1))) / n_directions


def inwards(null: FloatArray) -> FloatArray:
    """Which way parameters leave their null, in the unit cube: 1 or -1 where it is an end, 0 for both ways."""
    return np.where(null <= 0.0, 1.0, np.where(null >= 1.0, -1.0, 0.0))


def typical(bench: Workbench, name: str) -> float:
    """A typical size of a parameter as a step in the unit cube."""
    parameter = bench.parameter(name)
    name = base_of(name)
    i = bench.box.names.index(name)
    size = {direction: first for first, direction in bench.box.polar}.get(i)
    if size is not None:  # the second component of a size
        return typical(bench, bench.box.names[size])
    return float(parameter.typical(scale_of(bench.model.profile)) / bench.box.width[i])


def far_from_null(bench: Workbench, names: Sequence[str]) -> list[FloatArray]:
    """Places (n_names,) in the unit cube far from the null of a single parameter; none of several."""
    if len(names) > 1:
        return []
    far = bench.parameter(names[0]).far(scale_of(bench.model.profile))
    return [bench.sub_box(names).to_unit([value]) for value in far]


@dataclass(eq=False)
class Steps:
    """Steps that differences are taken over, about a place in the unit cube: of what is free to either side, of what is
    absent a typical size, and of what has one side only a small and a tiny one besides, in this order.

    moved        which name each step moves
    plus, minus  its size to either side, 0 where that side is left out
    places       which of the places simulated shows each step to one side, then to the other; the first, as it is,
                 where a side is left out
    ends         which of what is absent has one side only
    reach        (n_absent,) size of the step of what is absent, in typical ones
    """

    moved: IntArray
    plus: FloatArray
    minus: FloatArray
    places: IntArray
    ends: IntArray
    reach: FloatArray

    @classmethod
    def about(cls, at: FloatArray, n_free: int, size: FloatArray, inward: FloatArray, within: BoolArray) -> Steps:
        """Of places ``at`` (n_names,), the first ``n_free`` of which are free, the others at their null.

        size    (n_absent,) typical sizes in the unit cube; inward: as ``inwards`` has it
        within  (n_names,) of which there may be nothing beyond the bounds, such as a negative time constant
        """
        ends = np.flatnonzero(inward)
        moved = np.concatenate([np.arange(len(at)), n_free + ends, n_free + ends])
        plus = np.concatenate([np.full(n_free, STEP), size, SMALL * size[ends], TINY * size[ends]])
        minus = plus.copy()
        plus[within[moved] & (at[moved] + plus > 1.0)] = 0.0
        minus[within[moved] & (at[moved] - minus < 0.0)] = 0.0
        taken = np.concatenate([plus, minus]) > 0.0
        return cls(moved, plus, minus, np.where(taken, np.cumsum(taken), 0), ends, np.ones(len(size)))

    def columns(self, at: FloatArray) -> FloatArray:
        """Places to simulate at, (n_names, n_places): as it is, then every step taken."""
        found = np.repeat(at[:, None], 1 + int(self.places.max(initial=0)), axis=1)
        for by, places in zip((self.plus, -self.minus), np.split(self.places, 2), strict=True):
            found[self.moved, places] += by
        return found

    def reaching(self, at: FloatArray, runs: FloatArray, simulated: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """Residuals at ``columns`` (n_residuals, n_places), with larger steps of what has one side only and does
        nothing over a typical one.

        simulated  residuals (n_residuals, k) at places (n_names, k)
        """
        first, places = len(at) - len(self.reach), np.maximum(*np.split(self.places, 2))
        for size in FURTHER:
            steps = first + self.ends
            still = steps[(places[steps] > 0) & np.all(runs[:, places[steps]] == runs[:, :1], axis=0)]
            if not len(still):
                break
            larger = size / self.reach[still - first]
            self.plus[still] = np.minimum(larger * self.plus[still], 1.0 - at[still])
            self.minus[still] = np.minimum(larger * self.minus[still], at[still])
            self.reach[still - first] = size
            runs[:, places[still]] = simulated(self.columns(at)[:, places[still]])
        return runs

    def without_lost(self, runs: FloatArray) -> FloatArray:
        """Residuals there (n_residuals, n_places); a run that diverged says nothing: its side is left out."""
        lost = np.asarray(~np.isfinite(runs).all(axis=0))
        runs[:, lost] = runs[:, :1]
        for by, places in zip((self.plus, self.minus), np.split(self.places, 2), strict=True):
            by[lost[places]] = 0.0
        return runs

    def slopes(self, values: FloatArray) -> FloatArray:
        """(n_rows, n_moved) out of whitened residuals at ``columns``."""
        plus, minus = np.split(self.places, 2)
        found = values[:, plus]
        found -= values[:, minus]
        found /= np.maximum(self.plus + self.minus, 1e-300)
        return np.asarray(found)


def linearise(
    bench: Workbench,
    point: Point,
    absent: Sequence[str] = (),
    apart: Sequence[str] = (),
    varying: Sequence[str] = (),
    roughly: bool = False,
) -> Linear:
    """The problem made linear at ``point``.

    absent  parameters at their null that get a signature over a typical size
    apart   parameters that are free in the point and get a signature, by their derivative, instead of being re-tuned;
            targets are re-tuned beside these no farther than their boxes let them, those at a bound inwards too
    varying parameters, free or among the absent, that trials may have values of their own of
    roughly whether derivatives and signatures may be simulated as those of refits are
    """
    there = {base_of(name) for name in point.names}
    wanted = tuple(dict.fromkeys(name for name in absent if name not in there))
    names = (*point.names, *wanted)
    own = bench.problem_of(names, point.integrator).with_offsets(point.offsets)
    problem = bench.by_slopes(own) if roughly else own
    null = bench.null(wanted)
    at = np.concatenate([point.unit, null])
    n_free = len(point.names)
    within = np.array([parameter_of(bench.model, name) is not None for name in names], dtype=bool)
    steps = Steps.about(at, n_free, np.array([typical(bench, name) for name in wanted]), inwards(null), within)
    runs = problem.residuals(steps.columns(at)).T
    if problem is not own and not np.isfinite(runs[:, 0]).all():  # the other method diverges here
        problem = own
        runs = problem.residuals(steps.columns(at)).T
    runs = steps.reaching(at, runs, lambda places: problem.residuals(places).T)
    values = bench.noise.apply(steps.without_lost(runs), out=runs)
    slopes = steps.slopes(values)
    residual = values[:, 0] if problem is own else bench.noise.apply(own.residuals(at[:, None])[0])
    slopes *= np.array([unit_of(bench, names[i]) for i in steps.moved])
    n_moved, ends = len(steps.moved), steps.ends
    by_offset = bench.noise.apply(flat_where_lost(offset_derivatives(bench, point)))

    columns = np.column_stack([residual, slopes, wander(bench, point)])
    left = problem.without_offsets(columns, by_offset, problem.prior, point.offsets)
    plain = {
        base: np.sum(left[:, [1 + i for i, name in enumerate(names) if base_of(name) == base]], axis=1)
        for base in dict.fromkeys(varying)
    }
    tuned, left[:, 0] = _tuning(bench, point, apart, left[:, 0], left[:, 1 : 1 + n_free])
    left = tuned.out_of(left, out=left)
    chosen = (*apart, *wanted)
    at_chosen = [1 + names.index(name) for name in chosen]
    signature = left[:, at_chosen]
    small, tiny = np.split(left[:, 1 + len(names) : 1 + n_moved], 2, axis=1)
    of_small, of_tiny = np.split(np.linalg.norm(slopes[:, len(names) :], axis=0), 2)
    tiny = np.where(of_tiny > ACTS * of_small, tiny, small)
    length = np.linalg.norm(slopes[:, [i - 1 for i in at_chosen]], axis=0)
    every = basis(np.column_stack([signature, small]))
    first, blocks = blocks_of(problem)

    def retuned(columns: FloatArray) -> FloatArray:
        return tuned.out_of(problem.without_offsets(columns, by_offset, problem.prior))

    def fitted(columns: FloatArray) -> FloatArray:
        left = retuned(columns)
        return np.asarray(left - every @ (every.T @ left))

    return Linear(
        residual=left[:, 0],
        names=chosen,
        signature=signature,
        one_sided=tuple(wanted[i] for i in ends),
        small=small,
        tiny=tiny,
        share=np.linalg.norm(signature, axis=0) / np.maximum(length, 1e-300),
        reach={wanted[i]: float(steps.reach[i]) for i in ends if steps.reach[i] > 1.0},
        noise=left[:, 0] - every @ (every.T @ left[:, 0]),
        wander=left[:, 1 + n_moved :],
        blocks=blocks,
        cases=first,
        tuned=tuned,
        plain=plain,
        groups=problem.groups,
        retuned=retuned,
        fitted=fitted,
    )


def _tuning(
    bench: Workbench, point: Point, apart: Sequence[str], residual: FloatArray, columns: FloatArray
) -> tuple[Tuned, FloatArray]:
    """What re-tuning takes out of columns, and the residual (n_rows,) where nothing with leeway has moved.

    residual, columns  (n_rows,) and (n_rows, n_free) for a step of each name, initial states taken out
    """
    free = zip(point.names, point.unit, strict=True)
    inside = np.array([name not in apart and 0.0 < z < 1.0 for name, z in free], dtype=bool)
    loose = inside & np.array([name in bench.believed.deviations for name in point.names], dtype=bool)
    own = [name for name, is_loose in zip(point.names, loose, strict=True) if is_loose]
    inwards_from = _from_bounds(bench, point, apart, residual, columns)
    by_leeway = columns[:, loose] / np.array([unit_of(bench, name) for name in own])
    unmoved = residual - by_leeway @ (point.unit[loose] - bench.null(own))
    by_leeway = by_leeway * np.array([bench.believed.deviations[name] for name in own])
    by_tuning = columns[:, inside & ~loose]
    if apart:
        widths = [unit_of(bench, name) for name in np.array(point.names)[inside & ~loose].tolist()]
        by_leeway = np.column_stack([by_leeway, BOXED * by_tuning / np.array(widths), inwards_from])
        by_tuning = by_tuning[:, :0]
    return Tuned.by(by_tuning, by_leeway), unmoved


def _from_bounds(
    bench: Workbench, point: Point, apart: Sequence[str], residual: FloatArray, columns: FloatArray
) -> FloatArray:
    """What free coefficients that ended at a bound change (n_rows, k), over the standard deviation of where they may be
    within it: as far as they get until chi-squared has grown by two, or anywhere in their box; what has leeway is no
    better known there than elsewhere.

    residual, columns  (n_rows,) and (n_rows, n_free) for a step of each name, initial states taken out
    """
    at_bound = [k for k, z in enumerate(point.unit) if not 0.0 < z < 1.0 and point.names[k] not in apart]
    if not at_bound:
        return columns[:, :0]
    kept = columns[:, at_bound]
    steep = np.abs(kept.T @ residual)
    names, leeway = [point.names[k] for k in at_bound], bench.believed.leeway
    box = np.array([BOXED / unit_of(bench, name) for name in names])
    within = np.minimum(box, 1.0 / np.maximum(steep, 1e-300))
    known = np.array([leeway.get(name, np.nan) / unit_of(bench, name) for name in names])
    return np.asarray(kept * np.where(np.isnan(known), within, known))


def unit_of(bench: Workbench, name: str) -> float:
    """Step in the unit cube that a column of a free parameter stands for: a typical size for a parameter of an
    effect."""
    return 1.0 if parameter_of(bench.model, name) is None else typical(bench, name)


def offset_derivatives(bench: Workbench, point: Point) -> FloatArray:
    """Derivatives of the residuals by the initial offsets of their own case, (n_residuals, 6)."""
    problem = bench.problem_of(point.names, point.integrator)
    return problem.offset_slopes(point.unit, point.offsets)[1]


def basis(columns: FloatArray) -> FloatArray:
    """An orthonormal basis of the span of columns; directions that no motion shows are left out."""
    length = np.linalg.norm(columns, axis=0)
    shown = columns[:, length > SAME * length.max(initial=0.0)]
    if shown.shape[1] == 0:
        return shown
    shown = shown / np.linalg.norm(shown, axis=0)
    if shown.shape[1] == 1:
        return np.asarray(shown)
    square, vectors = np.linalg.eigh(shown.T @ shown)
    kept = square > SAME**2 * square[-1]
    return np.asarray(shown @ (vectors[:, kept] / np.sqrt(square[kept])))


def blocks_of(problem: FitProblem) -> tuple[IntArray, IntArray]:
    """First row of each trial, and of each block; the rows of a trial's offsets belong to its last."""
    first, blocks, row = [], [], 0
    for case, rows in enumerate(problem.rows_of_cases):
        n = rows.stop - rows.start
        t = problem.cases.t[case, : problem.cases.n_samples[case]]
        pieces = max(1, round(float(t[-1] - t[0]) / BLOCK))
        first.append(row)
        blocks += [row + (n * k) // pieces for k in range(pieces)]
        row += n + len(STATES)
    return np.array(first), np.array(sorted(set(blocks)))
