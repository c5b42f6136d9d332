"""What is odd about trials.

all_checks        everything odd about one; set_checks: about one among others of the same ship
finding           what a check has to say
motion_checks     gaps, jumps, spikes, channels that contradict each other; and position_jumps,
                  standing, saturation, in_parts, swell
control_checks    rudders, propellers, thrusters
cross_checks      channels against each other and against what ships can do
surroundings_checks, wind_checks      what was measured around the ship
"""
