"""Logs of hours: which of their windows are looked at, and what differs from voyage to voyage."""
