"""Write ``docs/regressions.md``: formulas from main dimensions held against the captive tests of ships.

python tools/write_regressions.py
"""

from __future__ import annotations

from pathlib import Path

from mmgtune import EstimateOptions, estimate, load_profile, read_particulars, simulate
from mmgtune.comparing_profiles import TURNS, ZIGZAGS
from mmgtune.files import write_text
from mmgtune.options import SimulateOptions
from mmgtune.profile import ShipProfile

HEAD = """# What formulas from main dimensions are worth

Written by `tools/write_regressions.py`. Two ships of which captive tests are published, by `mmgtune profile new` from
their dimensions alone (`ship_profiles/particulars`), beside the coefficients of those tests. "Scatter" is the one
standard deviation that such a profile gives the coefficient: an assumption of about the size of the differences seen
here, since the sources at hand give none. A fit takes it for the box (two of them to either side) and for what it
expects.
"""

FORMS = {"KVLCC2": ("kvlcc2", "mmg"), "SUZAKU": ("suzaku", "mmg")}

INDICES = {
    "tactical diameter, 35° to starboard": ("turn_p35", "tactical_diameter_over_L", "L"),
    "tactical diameter, 35° to port": ("turn_m35", "tactical_diameter_over_L", "L"),
    "advance, 35° to starboard": ("turn_p35", "advance_over_L", "L"),
    "first overshoot, zigzag 10/10": ("zigzag_p10_10", "overshoot_1_deg", "°"),
    "second overshoot, zigzag 10/10": ("zigzag_p10_10", "overshoot_2_deg", "°"),
    "first overshoot, zigzag 20/20": ("zigzag_p20_20", "overshoot_1_deg", "°"),
}

SETS = {
    "`mmg`, Yoshimura": EstimateOptions(form="mmg"),
    "`fam`, Inoue": EstimateOptions(form="fam", derivatives="inoue"),
    "`fam`, Clarke": EstimateOptions(form="fam", derivatives="clarke"),
    "`fam`, Kijima": EstimateOptions(form="fam", derivatives="kijima"),
}

FOOT = """
SUZAKU's captive rudder has a flap, which no formula here knows: her hull forces by formula lie close to those of the
tests (`mmgtune profile compare suzaku suzaku_fam` draws them), her rudder force is half of what it was, and she turns
as much too wide. What a captive test buys over formulas is the rudder behind this hull and propeller first, the
nonlinear terms next; linear terms and added masses are had for nothing.

The full-scale resistance by Holtrop's formulas is less than the captive $R_0'$, which is of a model.
"""


def coefficients(title: str, name: str, form: str) -> list[str]:
    """A ship's coefficients by formula and from captive tests."""
    made, captive = estimate(read_particulars(name), EstimateOptions(form=form)), load_profile(name)
    lines = [f"\n## {title}: coefficients\n\n| coefficient | formula | captive | difference | in scatters |"]
    lines.append("|---|---:|---:|---:|---:|")
    known = set(captive.names())
    for kind in ("particulars", "hull", "wake", "propeller", "rudder"):
        for symbol, coefficient in made.sections[kind].coefficients.items():
            full = f"{kind}.{symbol}"
            if coefficient.scatter is None or full not in known or full == "wake.C_w":
                continue
            by, was = made.value(full), captive.value(full)
            share = f"{100.0 * (by - was) / abs(was):+.0f} %" if abs(was) > 0.05 else ""
            lines.append(f"| `{full}` | {by:.4f} | {was:.4f} | {share} | {(by - was) / coefficient.scatter:+.1f} |")
    return lines


def manoeuvres(title: str, name: str) -> list[str]:
    """A ship's indices by captive tests and by each set of formulas."""
    options = SimulateOptions(turn=TURNS, zigzag=ZIGZAGS)

    def indices(ship: ShipProfile) -> dict[str, dict[str, float]]:
        return {row["id"]: row["indices"] for row in simulate(ship, options=options).rows()}

    found = {"captive": indices(load_profile(name))}
    found |= {words: indices(estimate(read_particulars(name), of)) for words, of in SETS.items()}
    lines = [f"\n## {title}: manoeuvres\n\n| index | {' | '.join(found)} |", "|---|" + "---:|" * len(found)]
    for words, (run, index, unit) in INDICES.items():
        values = " | ".join(f"{one[run][index]:.2f} {unit}" for one in found.values())
        lines.append(f"| {words} | {values} |")
    return lines


def page() -> str:
    """The page."""
    lines = []
    for title, (name, form) in FORMS.items():
        lines += coefficients(title, name, form) + manoeuvres(title, name)
    return HEAD + "\n".join(lines) + "\n" + FOOT


if __name__ == "__main__":
    write_text(Path(__file__).parent.parent / "docs" / "regressions.md", page())
