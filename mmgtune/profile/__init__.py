"""Ship profiles: TOML files with every number, its unit and its source."""

from .model import Approach, Coefficient, Section, ShipProfile, SteeringGear
from .reading import find_profile, load_profile, parse_profile
from .writing import tuned_text

__all__ = [
    "Approach",
    "Coefficient",
    "Section",
    "ShipProfile",
    "SteeringGear",
    "find_profile",
    "load_profile",
    "parse_profile",
    "tuned_text",
]
