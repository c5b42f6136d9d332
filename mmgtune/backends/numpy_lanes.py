"""The equations on NumPy arrays, one time step of all lanes at once: the reference, and quick for a single run."""

from __future__ import annotations

import numpy as np

from ..model import Model
from ..physics.mmg import derivatives
from ..physics.quantities import Control, State
from .cases import Cases, FloatArray, Integrator, LaneResult, finish


class NumpyLanes:
    """Evaluates ``physics`` as it stands, on arrays of n_cases * n_candidates lanes."""

    name = "numpy"

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
        """See ``Backend.run``."""
        n_cases, n_candidates = len(cases), theta.shape[1]
        shape = (n_cases, n_candidates)
        p = model.coefficients(np.ascontiguousarray(np.tile(theta, n_cases)))
        if initial is None:
            initial = np.repeat(cases.initial[:, None], n_candidates, axis=1)
        s = np.ascontiguousarray(initial.reshape(-1, 6).T)
        position, share = integrator.tableau
        T = cases.t.shape[1]
        cost = np.zeros(shape)
        fastest2 = np.zeros(s.shape[1])
        states = np.empty((n_cases, n_candidates, T, 6)) if keep_states else None
        residuals = np.empty((cases.n_residuals, n_candidates)) if keep_residuals else None
        if states is not None:
            states[:, :, 0] = initial

        def per_lane(values: FloatArray) -> FloatArray:
            return np.repeat(values, n_candidates)

        with np.errstate(all="ignore"):
            for k in range(1, T):
                before, after = cases.controls[:, k - 1], cases.controls[:, k]
                h = per_lane((cases.t[:, k] - cases.t[:, k - 1]) / integrator.substeps)
                for sub in range(integrator.substeps):
                    total = np.zeros_like(s)
                    z = s
                    for stage in range(len(position)):
                        f = (sub + position[stage]) / integrator.substeps
                        now = before + f * (after - before)
                        control = Control(n=per_lane(now[:, 0]), delta=per_lane(now[:, 1]))
                        rate = np.array(derivatives(State(*z), control, model.components, p))
                        total = total + share[stage] * rate
                        if stage + 1 < len(position):
                            z = s + position[stage + 1] * h * rate
                    s = s + h * total
                fastest2 = np.fmax(fastest2, s[3] * s[3] + s[4] * s[4])
                now_states = s.T.reshape(n_cases, n_candidates, 6)
                difference = now_states - cases.target[:, None, k]
                cost += np.sum(cases.weight[:, None, k] * difference * difference, axis=-1)
                if states is not None:
                    states[:, :, k] = now_states
                if residuals is not None:
                    counts = cases.rows[:, k] >= 0
                    scaled = np.sqrt(cases.weight[:, None, k]) * difference
                    residuals[cases.rows[:, k][counts]] = scaled.transpose(0, 2, 1)[counts]
        return finish(cost, fastest2.reshape(shape), s.T.reshape(n_cases, n_candidates, 6), states, residuals)
