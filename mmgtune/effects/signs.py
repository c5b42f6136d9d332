"""Signs in words."""


def signed(size: str, positive: str, negative: str) -> str:
    """A size in words with what its sign means: "-2.1 ± 0.3 m", forward or aft, is "2.1 ± 0.3 m aft"."""
    return f"{size.removeprefix('-')} {negative if size.startswith('-') else positive}"
