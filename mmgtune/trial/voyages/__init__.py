"""Logs of hours and days, read block by block; windows: as they are cut on the way; voyage_set: folders of them."""
