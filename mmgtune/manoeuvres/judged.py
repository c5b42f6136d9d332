"""The indices by which turning circles and zigzags are usually judged."""

from __future__ import annotations

JUDGED = {
    "advance_over_L": ("advance", "L", 2),
    "transfer_over_L": ("transfer", "L", 2),
    "tactical_diameter_over_L": ("tactical diameter", "L", 2),
    "steady_diameter_over_L": ("steady diameter", "L", 2),
    "overshoot_1_deg": ("1st overshoot", "deg", 1),
    "overshoot_2_deg": ("2nd overshoot", "deg", 1),
    "initial_turning_time_s": ("initial turning time", "s", 1),
}
"""What a manoeuvre is usually judged by: words, unit and decimals worth showing."""
