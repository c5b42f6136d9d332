"""Profiles from main dimensions."""
