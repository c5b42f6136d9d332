"""Ship profiles: TOML files with every number, its unit and its source."""

from .extending import missing_for, scale_of, with_all_effects, with_effects
from .model import Approach, Coefficient, Section, ShipProfile, SteeringGear
from .reading import find_profile, load_profile, parse_profile
from .writing import extended_text, tuned_text

__all__ = [
    "Approach",
    "Coefficient",
    "Section",
    "ShipProfile",
    "SteeringGear",
    "extended_text",
    "find_profile",
    "load_profile",
    "missing_for",
    "parse_profile",
    "scale_of",
    "tuned_text",
    "with_all_effects",
    "with_effects",
]
