"""Windows of trials that were not learned from: what chooses among weights."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends.differentiable import filled
from ..backends.twins import jax_module
from ..trial import Trial
from ..trial.pieces import windows
from .samples import samples_of

Single = np.float32
"""Training is in single precision: half the memory, twice as quick, and far below the noise of any sensor."""

Roll = Callable[[Any, Any, Any, Any], Any]
"""Parameters, initial (n, 6), controls (T, n, n_inputs), around (T, n, n_surroundings) -> states (T, n, 6)."""


def pieces_of(trials: Sequence[Trial], restart: float | None) -> list[Trial]:
    """Trials, or their windows of ``restart`` [s]."""
    return [piece for trial in trials for piece in (windows(trial, restart) if restart else [trial])]


Squares = Callable[[Any, Any, Any], Any]
"""Parameters, the windows' (initial, controls, around, states, counts), sigma -> (n, 6) sums of squares over sigma."""


def squares_of(roll: Roll) -> Squares:
    """Squares of the errors of roll-outs, compiled."""
    jax = jax_module()

    def squares(parameters: Any, given: Any, sigma: Any) -> Any:
        initial, controls, around, states, counts = given
        off = (roll(parameters, initial, controls, around) - states) / sigma
        return jax.numpy.sum(jax.numpy.where(counts, off * off, 0.0), axis=0)

    compiled: Squares = jax.jit(squares)
    return compiled


class Chooser:
    """L_MSE of roll-outs on windows side by side, padded at the end, by kind of manoeuvre or by run.

    squares  of the roll-outs; windows are filled up to counts of which there are few, so that they share a compilation
    sigma    (6,) deviations that errors are counted in
    """

    def __init__(
        self,
        squares: Squares,
        trials: Sequence[Trial],
        inputs: Sequence[str],
        step: float,
        sigma: FloatArray,
        *,
        restart: float | None,
        draught: float | None = None,
    ):
        jax = jax_module()
        pieces = pieces_of(trials, restart)
        cut = samples_of(pieces, inputs, step, draught)
        lengths = np.diff(cut.first)
        steps = np.arange(int(lengths.max()))[:, None]
        rows = cut.first[:-1] + np.minimum(steps, lengths - 1)
        states = cut.states[rows]
        states[:, :, :2] -= states[:1, :, :2]  # single precision has seven digits
        counts = np.isfinite(states) & (steps < lengths)[:, :, None]
        counts[0] = False
        self._kinds = np.array([piece.manoeuvre for piece in pieces])
        self._runs = np.array([piece.run for piece in pieces])
        self._counts = counts.sum(axis=0)
        states = np.nan_to_num(states)
        self._squares = squares
        places = filled(len(pieces))
        self._given = tuple(
            jax.numpy.asarray(one[..., places, :], dtype=kind)
            for one, kind in (
                (states[0], Single),
                (cut.controls[rows], Single),
                (cut.around[rows], Single),
                (states, Single),
                (counts, bool),
            )
        )
        self._sigma = jax.numpy.asarray(sigma, dtype=Single)

    def by_kind(self, parameters: Any) -> dict[str, float]:
        """L_MSE by kind of manoeuvre; infinite where a run diverged."""
        return self._grouped(parameters, self._kinds)

    def by_run(self, parameters: Any) -> dict[str, float]:
        """L_MSE by run; infinite where it diverged."""
        return self._grouped(parameters, self._runs)

    @property
    def runs(self) -> dict[str, tuple[str, int]]:
        """Kind of manoeuvre of each run, and the samples of it that count."""
        most = self._counts.max(axis=1)
        return {
            str(run): (str(self._kinds[self._runs == run][0]), int(most[self._runs == run].sum()))
            for run in sorted(set(self._runs.tolist()))
        }

    def _grouped(self, parameters: Any, groups: Any) -> dict[str, float]:
        squares = np.asarray(self._squares(parameters, self._given, self._sigma), dtype=float)[: len(self._kinds)]
        found = {}
        for group in sorted(set(groups.tolist())):
            of = groups == group
            n = self._counts[of].sum(axis=0)
            total = float(np.sum(squares[of].sum(axis=0)[n > 0] / n[n > 0]))
            found[str(group)] = total if np.isfinite(total) else float("inf")
        return found


def from_origin(states: Any) -> Any:
    """Windows (T, n, 6) moved so that each begins at the origin: single precision has seven digits."""
    jnp = jax_module().numpy
    begin = states[:1, :, :2]
    return jnp.concatenate([states[..., :2] - begin, states[..., 2:]], axis=-1)
