"""Who gets the cores: lanes of a simulation and searches side by side, not the linear algebra."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextvars import ContextVar, copy_context
from functools import lru_cache, wraps
from threading import Lock
from typing import ParamSpec, TypeVar

from .errors import OptionError, Problem, brief

P = ParamSpec("P")
R = TypeVar("R")

_BESIDE: ContextVar[bool] = ContextVar("beside", default=False)
"""Whether what runs here is one of several pieces of work on threads of their own."""

QUICKLY = 5e-4
"""Seconds after which a thread lets another have the interpreter: five thousandths, as Python has it, are as long as
many a simulation, whose thread then waits for it."""


class _Shared:
    """The interpreter is shared quickly within this context, which several threads may be in at a time."""

    def __init__(self) -> None:
        self._one_by_one, self._inside, self._usual = Lock(), 0, 0.0

    def __enter__(self) -> None:
        with self._one_by_one:
            if not self._inside:
                self._usual = sys.getswitchinterval()
                sys.setswitchinterval(QUICKLY)
            self._inside += 1

    def __exit__(self, *_: object) -> None:
        with self._one_by_one:
            self._inside -= 1
            if not self._inside:
                sys.setswitchinterval(self._usual)


_SHARED = _Shared()


@lru_cache(maxsize=1)
def cores() -> int:
    """Cores this process may use: MMGTUNE_THREADS of them where that is set, for many processes side by side.

    Raises OptionError where that is no number of cores.
    """
    allowed = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    told = os.environ.get("MMGTUNE_THREADS", "").strip()
    if not told:
        return allowed
    if not re.fullmatch("0*[1-9][0-9]{0,8}", told):
        what, fix = f"MMGTUNE_THREADS is {brief(told)}, not a number of cores", "set it to 1 or more, or unset it"
        raise OptionError(Problem(what, "environment", "it says how many cores this process may use", fix))
    return min(allowed, int(told))


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=cores.cache_clear)  # a child may be told another number


def blas_on_one_thread(work: Callable[P, R]) -> Callable[P, R]:
    """The same function with linear algebra on one thread while it runs.

    Its matrices are narrow: a second thread gains nothing, and on a busy machine the two wait for each other, spinning,
    for many times as long as the work takes.
    """

    @wraps(work)
    def limited(*args: P.args, **kwargs: P.kwargs) -> R:
        from threadpoolctl import threadpool_limits

        with threadpool_limits(limits=1, user_api="blas"):
            return work(*args, **kwargs)

    return limited


def on_threads(pieces: Sequence[Callable[[], R]], n: int) -> list[R]:
    """Results of pieces of work in their order, n at a time; what one of them raises, after all that began have ended.

    Each runs with the context variables of the caller, such as how NumPy takes an overflow, and on one core.
    """
    if n < 2 or len(pieces) < 2:
        return [copy_context().run(piece) for piece in pieces]
    with _SHARED, ThreadPoolExecutor(min(n, len(pieces)), thread_name_prefix="mmgtune-work") as pool:
        begun = [pool.submit(copy_context().run, _on_one_core, piece) for piece in pieces]
        try:
            return [one.result() for one in begun]
        finally:
            for one in begun:
                one.cancel()


def _on_one_core(piece: Callable[[], R]) -> R:
    """The result of a piece of work that leaves the other cores to what is done beside it."""
    _BESIDE.set(True)
    return piece()


def free_cores() -> int:
    """Cores that what runs here may use: one beside other work."""
    return 1 if _BESIDE.get() else cores()
