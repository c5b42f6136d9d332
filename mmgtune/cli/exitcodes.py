"""Exit codes: CI believes these, not prose."""

from enum import IntEnum, unique


@unique
class ExitCode(IntEnum):
    """What a command ends with."""

    GOOD = 0
    NO = 1  # ran correctly, and the answer is no
    COULD_NOT_RUN = 2
    BUG = 3
    INTERRUPTED = 130  # by Ctrl-C
    TERMINATED = 143  # by SIGTERM
