"""Channels of the motion as people call what shows them."""

LOGGED = {"psi": "heading", "u": "surge velocity", "v_m": "sway velocity", "r": "yaw rate"}
"""Channels whose sensor can be off by a number; positions begin where they were measured."""
