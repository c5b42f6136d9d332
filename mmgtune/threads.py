"""Who gets the cores: the lanes of a simulation, not the linear algebra."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


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
