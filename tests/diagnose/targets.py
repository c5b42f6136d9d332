"""Targets where a test is not about them: a diagnosis with five ends in half the time of one with twelve."""

FEW = ("hull.R_0", "wake.w_P0", "rudder.eps", "rudder.gamma_Rp", "rudder.gamma_Rn")
"""For ships that are the profile's own but for what is hidden in them."""
