"""What a captive test buys over formulas, and tuning over both: models of SUZAKU on the generated voyages.

    python tools/voyage_gains.py

prints the tables of docs/suzaku-voyages.md.  Each model is tuned to windows of the first six voyages and held against
those of the last six.
"""

from __future__ import annotations

from dataclasses import replace

from mmgtune import EstimateOptions, FitOptions, estimate, fit, load_profile, load_trials, read_particulars
from mmgtune.cli.voyages import in_words
from mmgtune.profile import ShipProfile, with_effects
from mmgtune.trial import load_voyages
from mmgtune.voyages import VoyageOptions, VoyageValidation, validate_voyages

VOYAGES = "voyages"
AROUND = {tag: {"measured": 1.0} for tag in ("current", "wind", "waves")}
R_MAX = 1.8
"""The ship's largest yaw rate as Mathioudakis et al. have it [deg/s]."""

SHOWN = ("MED", "PMD", "cVDM")


def untuned() -> dict[str, ShipProfile]:
    """The models before any tuning, all with what was measured around the ship."""
    ship = read_particulars("suzaku")
    return {
        "captive tests": with_effects(load_profile("suzaku"), AROUND, "as measured"),
        "dimensions, `mmg`": estimate(ship, EstimateOptions(form="mmg")),
        "dimensions, `fam`": estimate(ship, EstimateOptions(form="fam")),
    }


def tuned(profiles: dict[str, ShipProfile]) -> dict[str, ShipProfile]:
    """The same, tuned to windows of the first six voyages."""
    data = load_trials(VOYAGES)
    options = FitOptions(method="least-squares", restart=120.0, starts=4)
    return {f"{name}, tuned": fit(ship, data, options).tuned_profile() for name, ship in profiles.items()}


def held_out(profiles: dict[str, ShipProfile]) -> VoyageValidation:
    """Scores on the last six voyages."""
    data = load_voyages(VOYAGES)
    test = load_trials(VOYAGES).test
    some = replace(data, voyages=tuple(one for one in data.voyages if one.id in test))
    return validate_voyages(profiles, some, VoyageOptions(r_max=R_MAX))


def table(found: VoyageValidation) -> str:
    """Median distances and classes, a row a model."""
    lines = ["| model | MED [m] | PMD [%] | cVDM [%] | optimal | satisfactory | sub-optimal |", "|---|" + "---:|" * 6]
    for row in found.to_dict()["models"]:
        medians = " | ".join(f"{row['measures'][name]['median']:.3g}" for name in SHOWN)
        classes = " | ".join(str(row["classes"][name]) for name in ("optimal", "satisfactory", "sub-optimal"))
        lines.append(f"| {row['profile']} | {medians} | {classes} |")
    return "\n".join(lines)


def where(found: VoyageValidation) -> str:
    """Mean cVDM by rudder angle, and with the rudder moving or steady, a row a model."""
    models = found.to_dict()["models"]
    bins = [
        (feature["feature"], number, in_words(one, feature["unit"]))
        for feature in models[0]["where"]
        if feature["feature"] in ("rudder_largest", "rudder_range")
        for number, one in enumerate(feature["bins"])
    ]
    lines = ["| model | " + " | ".join(words for *_, words in bins) + " |", "|---|" + "---:|" * len(bins)]
    for row in models:
        of = {feature["feature"]: feature["bins"] for feature in row["where"]}
        means = [of[feature][number]["cVDM_mean"] for feature, number, _ in bins]
        lines.append(f"| {row['profile']} | " + " | ".join("-" if m is None else f"{m:.3g}" for m in means) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    before = untuned()
    compared = held_out({**before, **tuned(before)})
    print(table(compared))
    print()
    print(where(compared))
