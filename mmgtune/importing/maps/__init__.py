"""The map of a log; reading_map: from TOML; checking_map: its contradictions; quantities: what a log can hold."""
