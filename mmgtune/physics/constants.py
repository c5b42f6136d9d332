"""Constants of nature that equations and whatever counts in them share."""

GRAVITY = 9.81
"""Acceleration of gravity [m/s^2]; Holtrop's formulas have their own, as published."""
