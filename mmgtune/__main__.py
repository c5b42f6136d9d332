"""``python -m mmgtune``, and the command itself: Ctrl-C, SIGTERM and SIGHUP have exit codes from the first moment."""

# What ``signal`` wraps: to import that takes longer than all else before the handlers are there.
import _signal  # type: ignore[import-not-found]
import os


def _too_early(number: int, _frame: object) -> None:
    word = {_signal.SIGINT: b"interrupted", _signal.SIGTERM: b"terminated"}.get(number, b"hung up")
    os.write(2, word + b": nothing was begun\n")
    os._exit(128 + number)


def main() -> None:
    """Run the command line."""
    _signal.signal(_signal.SIGINT, _too_early)
    _signal.signal(_signal.SIGTERM, _too_early)
    hung_up = getattr(_signal, "SIGHUP", None)  # which Windows lacks; nohup has it ignored
    if hung_up is not None and _signal.getsignal(hung_up) != _signal.SIG_IGN:
        _signal.signal(hung_up, _too_early)
    from .cli import main as command_line

    command_line()


if __name__ == "__main__":
    main()
