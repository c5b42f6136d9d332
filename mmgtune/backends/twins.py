"""The equations rebuilt on JAX, from the same source: compiled, on a GPU, and with derivatives.

A twin is a function with the same code whose globals name ``jax.numpy`` where they named NumPy, and twins where they
named other functions of equations.
"""

from __future__ import annotations

import functools
import types
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import numpy as np

from ..errors import OptionError, Problem

F = TypeVar("F", bound=Callable[..., Any])

LIBRARIES = ("numpy", "jax", "jaxlib", "builtins", "math", "typing", "collections", "functools")
"""Packages whose functions are used as they are."""


def jax_module() -> Any:
    """JAX.  Raises OptionError with the command that installs it where it is not there."""
    try:
        import jax
    except ImportError as error:
        raise OptionError(
            Problem(
                "JAX is not installed",
                "",
                f"networks and exact derivatives need it: {error}",
                "install it with: pip install 'mmgtune[learn]'",
            )
        ) from error
    return jax


def twin(function: F) -> F:
    """A pure function of the equations on JAX.  Raises OptionError where JAX is missing."""
    jax_module()
    made: F = _twin(function)
    return made


@functools.cache
def _twin(function: Any) -> Any:
    if isinstance(function, functools.partial):
        return functools.partial(_twin(function.func), *function.args, **function.keywords)
    if not _is_equation(function):
        return function
    import jax.numpy as jnp

    space = dict(function.__globals__)
    made = types.FunctionType(function.__code__, space, function.__name__, function.__defaults__, _cells(function))
    made.__kwdefaults__ = function.__kwdefaults__
    _UNDER_WAY[function] = made
    try:
        for name in {*_names(function.__code__)}:
            value = space.get(name)
            if value is np:
                space[name] = jnp
            elif _is_equation(value) or isinstance(value, functools.partial):
                space[name] = _UNDER_WAY.get(value) or _twin(value)
    finally:
        del _UNDER_WAY[function]
    return made


_UNDER_WAY: dict[Any, Any] = {}
"""Twins whose globals are being filled: a function that names itself ends there."""


def _is_equation(value: Any) -> bool:
    return isinstance(value, types.FunctionType) and value.__module__.partition(".")[0] not in LIBRARIES


def _cells(function: types.FunctionType) -> tuple[types.CellType, ...] | None:
    """What a function closes over, functions among it rebuilt."""
    if function.__closure__ is None:
        return None
    held = (cell.cell_contents for cell in function.__closure__)
    return tuple(types.CellType(_twin(value) if _is_equation(value) else value) for value in held)


def _names(code: types.CodeType) -> Iterator[str]:
    """Every global a function names, those of functions inside it too."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _names(constant)
