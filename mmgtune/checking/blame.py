"""Which coefficients changed since the baseline, and which of them the loss is owed to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..backends import Integrator, get_backend
from ..model import Model
from ..objective import cases_of, make_objective
from ..toml_reading import line_index
from ..trial import Trial
from .baseline import Baseline
from .result import Changed


def changed_coefficients(
    model: Model, trials: Sequence[Trial], baseline: Baseline, integrator: Integrator, backend: str
) -> tuple[Changed, ...]:
    """Coefficients that differ from the baseline's, those with the largest share in the loss first.

    trials  those that can be compared; each coefficient is put back alone, all of them as lanes of one run
    """
    now = model.numbers()
    then = baseline.coefficients
    differing = [name for name in now if name in then and now[name] != then[name]]
    shares = _shares(model, trials, {name: then[name] for name in differing}, baseline, integrator, backend)
    lines = line_index(model.profile.text)
    found = [Changed(name, then[name], now[name], _line(lines, name), shares.get(name)) for name in differing]
    found += [Changed(name, None, now[name], _line(lines, name), None) for name in now if name not in then]
    found += [Changed(name, then[name], None, None, None) for name in then if name not in now]
    return tuple(sorted(found, key=lambda one: -(one.share or 0.0)))


def _shares(
    model: Model,
    trials: Sequence[Trial],
    then: Mapping[str, float],
    baseline: Baseline,
    integrator: Integrator,
    backend: str,
) -> dict[str, float]:
    """Share of the loss in J that the old value of each coefficient undoes; empty where J did not get worse."""
    comparable = [trial for trial in trials if "J" in baseline.trials[trial.id].metrics]
    if not comparable or not then:
        return {}
    names = list(then)
    here = model.base[[model.rows[name] for name in names]]
    values = np.repeat(here[:, None], len(names) + 1, axis=1)
    values[np.arange(len(names)), np.arange(len(names)) + 1] = list(then.values())
    cases = cases_of(comparable, make_objective(model.L_pp), model.inputs, model.draught)
    result = get_backend(backend).run(model, model.matrix(names, values), cases, integrator=integrator)
    J = result.cost.sum(axis=0)
    loss = J[0] - sum(baseline.trials[trial.id].metrics["J"] for trial in comparable)
    if not (np.isfinite(loss) and loss > 0.0):
        return {}
    return {name: float(share) for name, share in zip(names, (J[0] - J[1:]) / loss, strict=True) if np.isfinite(share)}


def _line(lines: Mapping[tuple[str, str], int], name: str) -> int | None:
    section, _, symbol = name.rpartition(".")
    return lines.get((section, symbol.partition("[")[0]))
