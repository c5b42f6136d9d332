"""The equations rebuilt on JAX, from the same source: compiled, on a GPU, and with derivatives.

A twin is a function with the same code whose globals name ``jax_math`` where they named NumPy, and twins where they
named other functions of equations.  What its code says is all it is: a twin has no state and writes nothing.
"""

from __future__ import annotations

import functools
import os
import sys
import threading
import types
import weakref
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import numpy as np

from ..errors import OptionError, Problem
from .kernel_folder import kernel_folder

F = TypeVar("F", bound=Callable[..., Any])

LIBRARIES = ("numpy", "jax", "jaxlib", "builtins", "math", "typing", "collections", "functools")
"""Packages whose functions are used as they are, or by the name JAX has for them."""


FUSE = "xla_backend_extra_options=xla_cpu_use_multi_output_fusion=true"
"""A flag of JAX's compiler: the forces of a step are computed once, not for each of the rates anew, which takes less
than half the time.  A release that does not know it passes it over."""


def jax_module() -> Any:
    """JAX.  Raises OptionError with the command that installs it where it is not there.

    Imported here first, it is told to ``FUSE``; where XLA_FLAGS is set, that counts.  What it compiles is then kept
    beside the kernels, for the next run; where JAX_COMPILATION_CACHE_DIR is set, there.
    """
    first = "jax" not in sys.modules
    if first:
        os.environ.setdefault("XLA_FLAGS", f"{2 * '-'}{FUSE}")
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
    if first and not jax.config.jax_compilation_cache_dir:
        jax.config.update("jax_compilation_cache_dir", str(kernel_folder() / "jax"))
    return jax


def accelerated() -> bool:
    """Whether JAX computes on a GPU or the like.  Raises OptionError where JAX is missing."""
    return bool(jax_module().default_backend() != "cpu")


def twin(function: F) -> F:
    """A pure function of the equations on JAX; the same one whenever it is asked for.

    Takes functions of ``physics`` and of effects, of this and of other packages, also partial and bound ones and those
    that close over others.  Raises OptionError where JAX is missing.
    """
    jax_module()
    with _LOCK:
        made: F = _rebuilt(function)
    return made


_LOCK = threading.RLock()
_MADE: weakref.WeakKeyDictionary[Any, Any] = weakref.WeakKeyDictionary()


def _rebuilt(value: Any) -> Any:
    """What a twin has in the place of a global, a cell, or an argument of a partial function."""
    if isinstance(value, types.ModuleType):
        return _rebuilt_module(value)
    if isinstance(value, np.ufunc) or (callable(value) and getattr(value, "__module__", None) == "numpy"):
        return getattr(_space(), getattr(value, "__name__", ""), value)
    if isinstance(value, functools.partial):
        held = (_rebuilt(one) for one in value.args)
        return functools.partial(_rebuilt(value.func), *held, **{k: _rebuilt(v) for k, v in value.keywords.items()})
    if isinstance(value, types.MethodType):
        return types.MethodType(_rebuilt(value.__func__), value.__self__)
    if isinstance(value, tuple) and any(map(callable, value)):
        parts = [_rebuilt(one) for one in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    return _rebuilt_function(value) if _is_equation(value) else value


def _rebuilt_function(function: types.FunctionType) -> types.FunctionType:
    if function in _MADE:
        return _MADE[function]
    space = dict(function.__globals__)
    # Cells are filled after the function is known, so that functions may call themselves and each other.
    cells = tuple(types.CellType() for _ in function.__closure__ or ())
    made = types.FunctionType(
        function.__code__, space, function.__name__, function.__defaults__, cells if function.__closure__ else None
    )
    made.__kwdefaults__, made.__doc__, made.__module__ = function.__kwdefaults__, function.__doc__, function.__module__
    _MADE[function] = made
    try:
        for name in {*_names(function.__code__)} & space.keys():
            space[name] = _rebuilt(space[name])
        for cell, own in zip(cells, function.__closure__ or (), strict=True):
            cell.cell_contents = _rebuilt(own.cell_contents)
    except BaseException:
        del _MADE[function]
        raise
    return made


class _Module(types.SimpleNamespace):
    """A module whose functions are twins, made when they are looked up."""

    def __init__(self, module: types.ModuleType):
        super().__init__(_of=module)

    def __getattr__(self, name: str) -> Any:
        with _LOCK:
            found = _rebuilt(getattr(self._of, name))
        setattr(self, name, found)
        return found


def _rebuilt_module(module: types.ModuleType) -> Any:
    """NumPy on JAX, and any other module of equations with twins in it."""
    top, _, rest = module.__name__.partition(".")
    if top == "numpy":
        return functools.reduce(getattr, rest.split(".") if rest else (), _space())
    return module if top in LIBRARIES else _Module(module)


def _space() -> Any:
    from . import jax_math

    return jax_math


def _is_equation(value: Any) -> bool:
    return isinstance(value, types.FunctionType) and (value.__module__ or "").partition(".")[0] not in LIBRARIES


def _names(code: types.CodeType) -> Iterator[str]:
    """Every global a function names, those of functions inside it too."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _names(constant)
