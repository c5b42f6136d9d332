"""Models held against voyages: logs of hours and days, cut into windows while they are read.

run        voyages scored, window by window
features   what the ship did in a window, and what was around her
scores     many windows scored at a time; table: all of them
turning    the ship's largest yaw rate
where      by which features the error goes; drawing_anew: intervals
result     what was found; folder: written
"""

from ..hooks import Hooks
from ..options import VoyageOptions
from .folder import write_voyages
from .result import VoyageValidation
from .run import validate_voyages

__all__ = ["Hooks", "VoyageOptions", "VoyageValidation", "validate_voyages", "write_voyages"]
