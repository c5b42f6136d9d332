"""Write ``docs/detectability.md``: what the bundled trials could tell of every effect.

python tools/write_detectability.py
"""

from __future__ import annotations

from pathlib import Path

from mmgtune.diagnose import Diagnosis, diagnose
from mmgtune.diagnose.causes.cause import Detectability
from mmgtune.files import write_text
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials
from mmgtune.units import read_as

HEAD = """# What the bundled trials could tell

Written by `tools/write_detectability.py`: the table every diagnosis has in its report, here for the bundled generated
trials of SUZAKU (four turns and two zigzags; the four turns of the test set are kept out). Before any cause is looked
for, it says of each effect

- **share**: how much of what the effect changes survives when the twelve targets, the initial states and, within
  5 %, the hull are re-tuned;
- **found from**: the size from which it would be named, by noise of sensors and of the logged inputs, in the sense of
  the search (the criterion of information by Bayes plus 10, and at least a tenth of a typical size);
- **closest**: the effects whose surviving signatures point most nearly the same way, with the angle between. Below
  about 10 degrees these trials tell the two apart only where they are large.

| effect | share | found from | closest |
|---|---|---|---|
"""


def page(result: Diagnosis) -> str:
    """The page."""
    rows = sorted(result.detectability, key=lambda one: -one.share)
    return HEAD + "".join(line(one) for one in rows)


def line(one: Detectability) -> str:
    """One effect."""
    limits = []
    for name, value in one.limit.items():
        if value is not None:
            unit, factor = ("", 1.0) if one.units[name] == "-" else read_as(one.units[name])
            digits = 4 if unit == "" else 2
            limits.append(f"{name} {factor * value:.{digits}g} {unit}".strip())
    twins = ", ".join(f"{tag} {angle:.0f}°" for tag, angle in one.twins)
    effect = f"`{one.effect}` ({', '.join(one.parameters)})"
    return f"| {effect} | {100.0 * one.share:.1f} % | {', '.join(limits) or 'not within its range'} | {twins} |\n"


if __name__ == "__main__":
    found = diagnose(load_profile("suzaku"), load_trials("suzaku"))
    write_text(Path(__file__).parent.parent / "docs" / "detectability.md", page(found))
