"""Ship profiles: TOML files with every number, its unit and its source."""

from .changing import missing_for, read_off, scale_of, tuned, with_all_effects, with_effects, with_values
from .model import Actuator, Approach, Coefficient, Section, ShipProfile, SteeringGear
from .reading import find_profile, load_profile, parse_profile
from .scaling import froude_scaled
from .writing import profile_text

__all__ = [
    "Actuator",
    "Approach",
    "Coefficient",
    "Section",
    "ShipProfile",
    "SteeringGear",
    "find_profile",
    "froude_scaled",
    "load_profile",
    "missing_for",
    "parse_profile",
    "profile_text",
    "read_off",
    "scale_of",
    "tuned",
    "with_all_effects",
    "with_effects",
    "with_values",
]
