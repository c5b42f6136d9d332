"""The same equations compiled: blocks of lanes through vector instructions, blocks shared out over the cores."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from types import ModuleType
from typing import NamedTuple

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..effects import Effect, LagEffect
from ..errors import OptionError, Problem, reason
from ..model import Model
from ..physics.quantities import State
from ..threads import cores, free_cores
from .cases import Cases, Integrator, LaneResult, finish, lanes_of
from .kernel.source import functions_of, kernel_source
from .kernel.text import IN_KERNEL, N_STATES, WIDTH, acting_in
from .logged import Logged
from .numpy_lanes import LaneModel
from .whole import Whole, whole_of

WORTH_A_THREAD = 20_000
"""Lane-steps (under a millisecond of work) below which starting a second thread costs more than it saves."""

WORTH_COMPILING = 3e8
"""Stages of lane-steps (some 15 s) from which a kernel made to measure is worth the seconds it takes to compile; until
then one of all effects serves where there is one."""

FULL = 0.75
"""Share of lanes in use from which the lanes of a block are candidates of one case, which is the quicker way."""


@lru_cache(maxsize=1)
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(max_workers=cores(), thread_name_prefix="mmgtune")


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_pool.cache_clear)  # threads stay behind in the parent


def compiler() -> ModuleType:
    """The module that compiles; it is imported where something is to run, since numba takes long to import.

    Raises OptionError where the environment keeps numba from compiling.
    """
    fix = "unset what begins with NUMBA_ in the environment, or choose backend=numpy"
    try:
        import numba

        from . import compiling
    except ValueError as error:
        what = "numba does not take its settings"
        raise OptionError(Problem(what, "environment", reason(error), fix)) from error
    if numba.config.DISABLE_JIT:
        what, why = "numba is told not to compile", "the compiled back end is nothing without it"
        raise OptionError(Problem(what, "environment, NUMBA_DISABLE_JIT", why, fix))
    return compiling


@dataclass(frozen=True, eq=False)
class Blocks:
    """Which lanes march together: a case and a candidate for each, (n_blocks, WIDTH).

    theta_of  (n_blocks,) which of ``thetas`` (n_distinct, WIDTH) rows of columns of theta a block has
    mixed     whether the lanes of a block belong to different cases
    """

    case_of: IntArray
    candidate_of: IntArray
    thetas: IntArray
    theta_of: IntArray
    mixed: bool


def make_blocks(cases: Cases, n_candidates: int, paired: bool = False) -> Blocks:
    """Blocks over all cases and candidates; the last lane is repeated where they do not fill the last block.

    paired  one candidate, of which every case has coefficients of its own
    """
    n_cases = len(cases)
    if n_cases == 1 or n_candidates >= FULL * WIDTH * -(-n_candidates // WIDTH):
        return _blocks_of_one_case(n_cases, n_candidates)
    by_length = np.argsort(cases.n_samples, kind="stable")  # cases of a block should end together
    n_lanes = n_cases * n_candidates
    lanes = np.minimum(np.arange(-(-n_lanes // WIDTH) * WIDTH), n_lanes - 1).reshape(-1, WIDTH)
    case_of, candidate_of = by_length[lanes // n_candidates], lanes % n_candidates
    thetas, theta_of = np.unique(case_of if paired else candidate_of, axis=0, return_inverse=True)
    return Blocks(case_of, candidate_of, thetas, theta_of.reshape(-1), mixed=True)


@lru_cache(maxsize=16)
def _blocks_of_one_case(n_cases: int, n_candidates: int) -> Blocks:
    per_case = -(-n_candidates // WIDTH)
    thetas = np.minimum(np.arange(per_case * WIDTH), n_candidates - 1).reshape(per_case, WIDTH)
    case_of = np.repeat(np.arange(n_cases), per_case)[:, None].repeat(WIDTH, axis=1)
    return Blocks(case_of, np.tile(thetas, (n_cases, 1)), thetas, np.tile(np.arange(per_case), n_cases), mixed=False)


@lru_cache(maxsize=64)
def _nulls(model: Model, places: tuple[type[Effect], ...]) -> tuple[IntArray, FloatArray, IntArray]:
    """Rows of the parameters of effects, their nulls, and where those of each effect begin; one without has NaN."""
    rows: list[int] = []
    nulls: list[float] = []
    first = []
    for effect in acting_in(model, places):
        first.append(len(rows))
        fields = dict(zip(effect.params._fields, model.fields(effect), strict=True))
        for name, null in effect.nulls.items():
            rows += fields[name]
            nulls += [null] * len(fields[name])
        if len(rows) == first[-1]:
            rows, nulls = [*rows, 0], [*nulls, np.nan]
    return np.array(rows, dtype=int), np.array(nulls), np.array(first, dtype=int)


def present(model: Model, places: tuple[type[Effect], ...], theta: FloatArray) -> BoolArray:
    """(n, n_effects) which effects any lane of blocks (n, n_rows, n_lanes) of coefficients has: not at their null."""
    rows, nulls, first = _nulls(model, places)
    if not len(first):
        return np.zeros((len(theta), 1), dtype=bool)
    return np.logical_or.reduceat((theta[:, rows] != nulls[:, None]).any(axis=2), first, axis=1)


def first_states(
    model: Model, theta: FloatArray, cases: Cases, initial: FloatArray | None, paired: bool = False
) -> FloatArray:
    """(n_cases, n_candidates, n_states) where lanes start: the state as the sensors show it, then what lags remember.

    The latter is worked out by the reference, once a run: a kernel would need all forces a second time for it.
    """
    n_candidates = 1 if paired else theta.shape[-1]
    if initial is None:
        initial = np.broadcast_to(cases.initial[:, None], (len(cases), n_candidates, N_STATES))
    lags = model.acting(LagEffect)
    if not lags:
        return initial
    if not present(model, (LagEffect,), theta.reshape(1, len(theta), -1)).any():
        return np.concatenate([initial, np.zeros((*initial.shape[:2], sum(len(lag.states) for lag in lags)))], axis=2)
    with np.errstate(all="ignore"):
        ship = LaneModel(model, lanes_of(theta, len(cases), paired))
        log = Logged(model, cases, n_candidates, ship.shift)
        shown = State(*initial.reshape(-1, N_STATES).T)
        behind = ship.start(shown, log.inputs(1, 0.0), log.around(1, 0.0)).s[N_STATES:]
    return np.concatenate([initial, behind.T.reshape(len(cases), n_candidates, -1)], axis=2)


class Compiled:
    """Runs kernels made by ``kernel``; one per combination of components, kept in memory and on disk."""

    name = "compiled"

    def __init__(self) -> None:
        self._kernels: dict[str, Callable[..., None]] = {}
        self._done: dict[str, float] = {}
        self._whole_serves: dict[str, bool] = {}

    def kernel(self, model: Model) -> Callable[..., None]:
        """The compiled simulator for the components of ``model``."""
        text = kernel_source(model)
        if text not in self._kernels:
            self._kernels[text] = compiler().load_kernel(text, functions_of(model))
        return self._kernels[text]

    def is_ready(self, model: Model) -> bool:
        """Whether a short run of a model needs nothing compiled: its own simulator, or that of all effects, is kept."""
        if self._is_there(model):
            return True
        whole = whole_of(model)
        return whole is not None and self._is_there(whole.model)

    def _among_all(self, model: Model, work: float) -> Whole | None:
        """The model among all effects, where that has a kernel already and the model itself has none worth waiting for.

        work  stages of lane-steps that are to be run
        """
        text = kernel_source(model)
        if text in self._kernels:
            return None
        done = self._done[text] = self._done.get(text, 0.0) + work
        if done > WORTH_COMPILING:
            return None
        if text not in self._whole_serves:
            whole = None if self._is_there(model) else whole_of(model)
            self._whole_serves[text] = whole is not None and self._is_there(whole.model)
        return whole_of(model) if self._whole_serves[text] else None

    def _is_there(self, model: Model) -> bool:
        """Whether a model's kernel needs no compiling."""
        text = kernel_source(model)
        if text in self._kernels:
            return True
        try:
            return bool(compiler().is_kept(text, functions_of(model)))
        except OptionError:  # said where something is to be compiled
            return False

    def run(
        self,
        model: Model,
        theta: FloatArray,
        cases: Cases,
        *,
        initial: FloatArray | None = None,
        integrator: Integrator = Integrator(),
        keep_states: bool = False,
        keep_residuals: bool = False,
        paired: bool = False,
    ) -> LaneResult:
        """See ``Backend.run``."""
        cores()  # what the environment says of them is refused whether or not this work takes several
        n_cases, n_candidates = len(cases), 1 if paired else theta.shape[-1]
        position, share = integrator.tableau
        work = cases.steps * n_candidates * len(position) * integrator.substeps
        if (whole := self._among_all(model, work)) is not None:
            model, theta = whole.model, whole.theta(theta)
        blocks = make_blocks(cases, n_candidates, paired)
        thetas, theta_of = _thetas_of(blocks, theta)
        start = first_states(model, theta, cases, initial, paired)[blocks.case_of, blocks.candidate_of]
        read = (
            np.ascontiguousarray(thetas).reshape(len(thetas), -1),
            theta_of,
            present(model, IN_KERNEL, thetas),
            np.ascontiguousarray(start.transpose(0, 2, 1)).reshape(len(start), -1),
            blocks.case_of,
            blocks.candidate_of,
            blocks.mixed,
            *map(
                np.ascontiguousarray,
                (cases.t, cases.n_samples, cases.controls, cases.around, cases.target, cases.weight),
            ),
            position,
            share,
            integrator.substeps,
            cases.rows if keep_residuals else np.zeros((1, 1, 1), dtype=np.int64),
        )
        written = _Written.for_blocks(blocks, cases, n_candidates, keep_states, keep_residuals)
        _share_out(self.kernel(model), len(blocks.case_of), work, read, (keep_states, keep_residuals, *written))
        last = written.end.reshape(-1, N_STATES, WIDTH).transpose(0, 2, 1)
        return finish(
            _by_lane(written.cost, blocks, n_cases, n_candidates),
            _by_lane(written.fastest2, blocks, n_cases, n_candidates),
            _by_lane(last, blocks, n_cases, n_candidates),
            written.states if keep_states else None,
            written.residuals[:, :n_candidates] if keep_residuals else None,
        )


def _thetas_of(blocks: Blocks, theta: FloatArray) -> tuple[FloatArray, IntArray]:
    """(n, n_rows, WIDTH) coefficients of blocks, and which of these each block has.

    theta  (n_rows, n_candidates), or (n_rows, n_cases, n_candidates) where every case has its own
    """
    if theta.ndim == 3:
        return theta[:, blocks.case_of, blocks.candidate_of].transpose(1, 0, 2), np.arange(len(blocks.case_of))
    return theta[:, blocks.thetas].transpose(1, 0, 2), blocks.theta_of


class _Written(NamedTuple):
    """What a kernel writes into, in the order of its arguments; what is not to be kept is a single number."""

    cost: FloatArray  # (n_blocks, WIDTH)
    fastest2: FloatArray  # (n_blocks, WIDTH)
    end: FloatArray  # (n_blocks, n_states * WIDTH)
    states: FloatArray  # (n_cases, n_candidates, n_samples, n_states)
    residuals: FloatArray  # (n_residuals, n_columns)

    @classmethod
    def for_blocks(
        cls, blocks: Blocks, cases: Cases, n_candidates: int, keep_states: bool, keep_residuals: bool
    ) -> _Written:
        """Room for the results of blocks."""
        n_blocks = len(blocks.case_of)
        columns = n_candidates if blocks.mixed else blocks.thetas.size
        return cls(
            np.empty((n_blocks, WIDTH)),
            np.empty((n_blocks, WIDTH)),
            np.empty((n_blocks, N_STATES * WIDTH)),
            np.empty((len(cases), n_candidates, cases.t.shape[1], N_STATES) if keep_states else (1, 1, 1, 1)),
            np.empty((cases.n_residuals, columns) if keep_residuals else (1, 1)),
        )


def _share_out(
    kernel: Callable[..., None], n_blocks: int, work: float, read: tuple[object, ...], written: tuple[object, ...]
) -> None:
    """Run a kernel over all blocks, on several cores where that is worth it; work in stages of lane-steps."""
    if work < WORTH_A_THREAD or n_blocks == 1 or free_cores() == 1:
        kernel(*read, 0, n_blocks, *written)
        return
    cuts = np.linspace(0, n_blocks, min(n_blocks, 4 * cores()) + 1).astype(int)
    jobs = [_pool().submit(kernel, *read, int(a), int(b), *written) for a, b in pairwise(cuts)]
    for job in jobs:
        job.result()


def _by_lane(values: FloatArray, blocks: Blocks, n_cases: int, n_candidates: int) -> FloatArray:
    """(n_cases, n_candidates, ...) of (n_blocks, WIDTH, ...)."""
    if not blocks.mixed:
        return values.reshape(n_cases, -1, *values.shape[2:])[:, :n_candidates]
    ordered = np.empty((n_cases, n_candidates, *values.shape[2:]))
    ordered[blocks.case_of, blocks.candidate_of] = values
    return ordered
