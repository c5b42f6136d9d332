"""Write ``docs/check-sensitivity.md``: which wrong coefficients a check of the bundled trials notices.

python tools/write_check_sensitivity.py
"""

from __future__ import annotations

from pathlib import Path

from mmgtune.checking import read_baseline
from mmgtune.checking.sensitivity import Noticed, pairs, sensitivity
from mmgtune.files import write_text
from mmgtune.metrics import METRICS
from mmgtune.profile import load_profile
from mmgtune.resources import folder
from mmgtune.trial import load_trials

SHARE = 0.02
TRACE = 1e-6
"""Margin below which a coefficient leaves no trace but rounding."""

HEAD = """# What a check would notice

Written by `tools/write_check_sensitivity.py`. Each coefficient of SUZAKU is changed by 2 % of itself, up and down, and
checked against the committed baseline of the bundled generated trials with the default tolerances. The **margin** is
the largest loss of any metric of any trial over what passes: above 1 the check fails. A change that makes the model
fit better fails nothing, so a coefficient counts as noticed where either direction is. The same for your own ship:

```
mmgtune check suzaku suzaku --baseline trials/suzaku/check.json --sensitivity 0.02
```

| coefficient | margin up | margin down | most in | |
|---|---:|---:|---|---|
"""


def page(rows: list[Noticed]) -> str:
    """The page."""
    by_name = pairs(rows)
    ordered = sorted(by_name.items(), key=lambda one: -max(row.margin for row in one[1]))
    lines = [line(name, up, down) for name, (up, down) in ordered]
    noticed = sum(up.noticed or down.noticed for up, down in by_name.values())
    blind = sum(max(up.margin, down.margin) <= TRACE for up, down in by_name.values())
    return (
        f"{HEAD}{''.join(lines)}\n"
        f"{noticed} of {len(by_name)} are noticed. {blind} leave no trace in these trials: they act in wind, astern or"
        " at revolutions that none of them has, or, as the density of water, on ship and forces alike. The others"
        " move the metrics by less than the 1 % that passes; a tighter tolerance in the baseline notices them.\n"
    )


def line(name: str, up: Noticed, down: Noticed) -> str:
    """One coefficient."""
    most = max((up, down), key=lambda row: row.margin)
    verdict = "noticed" if up.noticed or down.noticed else "no trace" if most.margin <= TRACE else "within 1 %"
    where = f"{METRICS[most.worst.metric].words}, {most.worst.trial}" if most.worst and most.margin > TRACE else ""
    numbers = ["0" if row.margin <= TRACE else f"{row.margin:.2g}" for row in (up, down)]
    return f"| `{name}` | {numbers[0]} | {numbers[1]} | {where} | {verdict} |\n"


if __name__ == "__main__":
    baseline = read_baseline(folder("trials") / "suzaku" / "check.json")
    found = sensitivity(load_profile("suzaku"), load_trials("suzaku"), baseline, SHARE)
    write_text(Path(__file__).parent.parent / "docs" / "check-sensitivity.md", page(found))
