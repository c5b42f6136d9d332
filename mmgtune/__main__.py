"""``python -m mmgtune``, and the command itself: Ctrl-C has its exit code from the first moment."""

import os
import signal
import sys
from typing import Any


def _too_early(_signal: int, _frame: Any) -> None:
    os.write(sys.stderr.fileno(), b"interrupted: nothing was begun\n")
    os._exit(130)


def main() -> None:
    """Run the command line."""
    signal.signal(signal.SIGINT, _too_early)
    from .cli import main as command_line

    command_line()


if __name__ == "__main__":
    main()
