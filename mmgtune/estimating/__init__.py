"""Ship profiles from main dimensions, by published formulas.

particulars  what is known of a ship: a small TOML file
defaults     what such a file leaves out, by rules of thumb
scatter      how far ships lie about the formulas
making       the profile
"""

from .making import estimate
from .particulars import QUESTIONS, Particulars, parse_particulars, read_particulars

__all__ = ["QUESTIONS", "Particulars", "estimate", "parse_particulars", "read_particulars"]
