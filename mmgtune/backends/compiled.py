"""The same equations compiled: blocks of lanes through vector instructions, blocks shared out over the cores."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from itertools import pairwise

import numpy as np

from ..arrays import FloatArray
from ..model import Model
from .cases import Cases, Integrator, LaneResult, finish
from .kernel_source import WIDTH, kernel_source

WORTH_A_THREAD = 20_000
"""Lane-steps (under a millisecond of work) below which starting a second thread costs more than it saves."""


@lru_cache(maxsize=1)
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(max_workers=cores(), thread_name_prefix="mmgtune")


def cores() -> int:
    """Cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Compiled:
    """Runs kernels made by ``kernel_source``; one per combination of components, kept in memory and on disk."""

    name = "compiled"

    def __init__(self) -> None:
        self._kernels: dict[str, Callable[..., None]] = {}

    def kernel(self, model: Model) -> Callable[..., None]:
        """The compiled simulator for the components of ``model``."""
        text = kernel_source(model)
        if text not in self._kernels:
            from .compiling import load_kernel

            self._kernels[text] = load_kernel(text)
        return self._kernels[text]

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
    ) -> LaneResult:
        """See ``Backend.run``.  Lanes are padded to whole blocks by repeating the last candidate."""
        n_cases, n_candidates = len(cases), theta.shape[1]
        n_blocks = -(-n_candidates // WIDTH)
        lanes = np.minimum(np.arange(n_blocks * WIDTH), n_candidates - 1)
        blocked = theta[:, lanes].reshape(-1, n_blocks, WIDTH).transpose(1, 0, 2).reshape(n_blocks, -1)
        if initial is None:
            initial = np.repeat(cases.initial[:, None], n_candidates, axis=1)
        start = initial[:, lanes].reshape(n_cases, n_blocks, WIDTH, 6).transpose(0, 1, 3, 2)
        T = cases.t.shape[1]
        cost = np.empty((n_cases, n_blocks, WIDTH))
        fastest2 = np.empty((n_cases, n_blocks, WIDTH))
        end = np.empty((n_cases, n_blocks, 6 * WIDTH))
        states = np.empty((n_cases, T if keep_states else 1, 6, n_blocks * WIDTH))
        residuals = np.empty((cases.n_residuals if keep_residuals else 0, n_blocks * WIDTH))
        position, share = integrator.tableau
        fixed = (
            np.ascontiguousarray(blocked),
            np.ascontiguousarray(start).reshape(n_cases, n_blocks, 6 * WIDTH),
            *map(
                np.ascontiguousarray,
                (cases.t, cases.n_samples, cases.controls, cases.wind, cases.target, cases.weight),
            ),
            position,
            share,
            integrator.substeps,
            cases.rows,
        )
        kernel = self.kernel(model)
        tasks = n_cases * n_blocks
        work = cases.steps * n_blocks * WIDTH * len(position) * integrator.substeps
        if work < WORTH_A_THREAD or tasks == 1 or cores() == 1:
            kernel(*fixed, 0, tasks, cost, fastest2, end, states, residuals)
        else:
            cuts = np.linspace(0, tasks, min(tasks, 4 * cores()) + 1).astype(int)
            jobs = [
                _pool().submit(kernel, *fixed, int(a), int(b), cost, fastest2, end, states, residuals)
                for a, b in pairwise(cuts)
            ]
            for job in jobs:
                job.result()

        def per_candidate(values: FloatArray) -> FloatArray:
            return values.reshape(n_cases, n_blocks * WIDTH)[:, :n_candidates]

        last = end.reshape(n_cases, n_blocks, 6, WIDTH).transpose(0, 1, 3, 2).reshape(n_cases, -1, 6)[:, :n_candidates]
        kept = states[..., :n_candidates].transpose(0, 3, 1, 2) if keep_states else None
        listed = residuals[:, :n_candidates] if keep_residuals else None
        return finish(per_candidate(cost), per_candidate(fastest2), last, kept, listed)
