"""What measures of error are, for readers: a unit and a line each."""

from __future__ import annotations

from collections.abc import Mapping

MEASURES: Mapping[str, tuple[str, str]] = {
    "MMD": ("m", "mean distance off the measured place, north and east added"),
    "MED": ("m", "mean distance off the measured place, as the crow flies"),
    "ASD": ("–", "mean of the absolute differences of all six states, in SI units, added as they are"),
    "MSD": ("–", "mean root of the squared differences of all six states, in SI units, added as they are"),
    "PMD": ("%", "differences of position, heading and surge velocity over their measured sizes, added"),
    "PED": ("%", "the same as a root of squares; both depend on where the origin is"),
    "cVDM": (
        "%",
        "position over path, heading over a half turn, velocities over the ship's own: comparable between trials",
    ),
}
"""The distance measures of Mathioudakis et al., eq. 10-16."""

J = "squared differences of simulated and measured motion over all samples, each over a scale; 0 is a perfect fit"
L_MSE = (
    "squared differences of all six states over their variance, mean over time; 0 is perfect, a model that knows "
    "only the mean has about 6"
)


def about(names: list[str]) -> tuple[tuple[str, str], ...]:
    """Lines for the measures among these names."""
    return tuple((name, MEASURES[name][1]) for name in names if name in MEASURES)


def with_unit(name: str) -> str:
    """A measure as the head of a row: MED [m]."""
    return f"{name} [{MEASURES[name][0]}]" if name in MEASURES else name
