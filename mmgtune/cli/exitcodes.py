"""Exit codes: CI believes these, not prose."""

from enum import IntEnum, unique


@unique
class ExitCode(IntEnum):
    """What a command ends with."""

    GOOD = 0
    NO = 1  # ran correctly, and the answer is no
    COULD_NOT_RUN = 2
    BUG = 3
    HUNG_UP = 129  # by SIGHUP
    INTERRUPTED = 130  # by Ctrl-C
    TERMINATED = 143  # by SIGTERM


EPILOG = (
    "Exit codes: 0 good; 1 the answer is no; 2 could not run; 3 bug; 130, 143 or 129 interrupted, terminated or hung "
    "up, best so far saved."
)
"""Below the help of every command."""
