"""What a check would notice: every coefficient changed in turn, as lanes of one run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..backends import Integrator
from ..errors import OptionError, Problem
from ..metrics import METRICS
from ..model import Model
from ..profile import ShipProfile
from ..trial import TrialSet
from .baseline import Baseline, Recorded
from .measuring import Values, measure
from .result import Item
from .run import compared


@dataclass(frozen=True)
class Noticed:
    """A coefficient changed by a share of itself, up or down.

    change      "+" or "-"
    regressed, improved  number of metrics that got worse, or better, by more than passes, over all trials
    worst       the metric that changed most beyond what passes, None where none did
    margin      the largest change for the worse over what passes: above 1 it is noticed
    """

    name: str
    change: str
    regressed: int
    improved: int
    worst: Item | None
    margin: float

    @property
    def noticed(self) -> bool:
        """Whether the check would fail."""
        return self.regressed > 0

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "coefficient": self.name,
            "change": self.change,
            "noticed": self.noticed,
            "regressed": self.regressed,
            "improved": self.improved,
            "margin": self.margin if np.isfinite(self.margin) else None,
            "worst": None if self.worst is None else {"trial": self.worst.trial, "metric": self.worst.metric},
        }


def sensitivity(
    profile: ShipProfile, trials: TrialSet, baseline: Baseline, share: float, *, backend: str = "compiled"
) -> list[Noticed]:
    """Whether a check against the model as it is would notice each coefficient changed by +-share of itself.

    Tolerances, metrics and integrator are the baseline's; values are compared with those of the profile now, so that
    an old baseline does not blur the answer.  Coefficients that are zero or infinite, and words, are left
    out.
    Raises OptionError for a share that is none.
    """
    if not 0.0 < share < 1.0:
        raise OptionError(Problem(f"a change by {share:g} of itself", "sensitivity", fix="write 0.02 for 2 %"))
    model = Model(profile)
    names = [name for name in model.rows if _can_change(model, name)]
    here = np.array([model.base[model.rows[name]] for name in names])
    n = len(names)
    values = np.repeat(here[:, None], 2 * n + 1, axis=1)
    values[np.arange(n), np.arange(n)] *= 1.0 + share
    values[np.arange(n), n + np.arange(n)] *= 1.0 - share
    integrator = Integrator(baseline.integrator, baseline.substeps)
    chosen = list(trials.trials.values())
    found = measure(
        model, chosen, baseline.metrics, theta=model.matrix(names, values), integrator=integrator, backend=backend
    )
    recorded = {name: Recorded(trials.trials[name].sha256, values) for name, values in found[-1].items()}
    now = replace(baseline, trials=recorded)
    return [_noticed(names[k % n], "+" if k < n else "-", one, now, trials) for k, one in enumerate(found[:-1])]


def table(rows: Sequence[Noticed], share: float) -> str:
    """Coefficients by how well the check sees them, and a verdict last."""
    by_name = pairs(rows)
    width = max(len(name) for name in by_name)
    lines = [f" {'coefficient':<{width}} {'up':>10} {'down':>10}   most in"]
    for name, (up, down) in sorted(by_name.items(), key=lambda one: -max(row.margin for row in one[1])):
        seen = max((up, down), key=lambda row: row.margin)
        most = f"{METRICS[seen.worst.metric].words} of {seen.worst.trial}" if seen.worst else ""
        lines.append(f" {name:<{width}} {_margin(up):>10} {_margin(down):>10}   {most}")
    either = sum(up.noticed or down.noticed for up, down in by_name.values())
    lines.append(
        f"{either} of {len(by_name)} coefficients are noticed when changed by {100 * share:g} % (margin above 1)."
    )
    return "\n".join(lines) + "\n"


def pairs(rows: Sequence[Noticed]) -> dict[str, tuple[Noticed, Noticed]]:
    """Up and down by coefficient."""
    by_key = {(row.name, row.change): row for row in rows}
    return {name: (by_key[name, "+"], by_key[name, "-"]) for name in dict.fromkeys(row.name for row in rows)}


def _margin(row: Noticed) -> str:
    return "diverges" if not np.isfinite(row.margin) else f"{row.margin:.3g}"


def _noticed(name: str, change: str, found: dict[str, Values], now: Baseline, trials: TrialSet) -> Noticed:
    items = [
        item
        for trial, values in found.items()
        for item in compared(trial, values, trials.trials[trial].sha256, now.metrics, {}, now)
    ]
    margins = [_worse(item) for item in items]
    k = int(np.argmax(margins)) if margins else 0
    return Noticed(
        name,
        change,
        sum(item.status == "regressed" for item in items),
        sum(item.status == "improved" for item in items),
        items[k] if margins and margins[k] > 0.0 else None,
        max(0.0, margins[k]) if margins else 0.0,
    )


def _worse(item: Item) -> float:
    """Change for the worse over what passes."""
    if item.now is None or item.baseline is None or item.allowed is None:
        return 0.0
    room = item.allowed - abs(item.baseline)
    return (abs(item.now) - abs(item.baseline)) / room if room > 0.0 else np.inf


def _can_change(model: Model, name: str) -> bool:
    """Whether it is a quantity with a share of itself, not a word that stands for one."""
    value = model.base[model.rows[name]]
    section, _, symbol = name.rpartition(".")
    field = model.profile.sections[section].component.fields.get(symbol.partition("[")[0])
    return bool(value != 0.0 and np.isfinite(value)) and (field is None or not field.choices)
