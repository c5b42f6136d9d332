"""What was measured around the ship: wind, current, waves and depth, and all of it as simulators take it."""
