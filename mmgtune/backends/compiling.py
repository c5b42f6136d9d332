"""Making the functions of ``physics`` callable from compiled code, and keeping what was compiled.

Importing this module imports numba and registers the physics once.  Kernels live as real files in the user's cache
folder, named by a hash of everything they were made from, so that numba's own cache beside them never goes stale.
"""

from __future__ import annotations

import gc
import hashlib
import importlib
import inspect
import pkgutil
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numba
from llvmlite import ir
from numba import carray, njit, types
from numba.core import cgutils
from numba.extending import intrinsic, overload, register_jitable

from .. import physics
from ..effects import effects
from ..files import write_text
from ..physics import elementary
from ..physics.integration import between
from . import vector_math
from .kernel_folder import Entry, alone, kernel_folder
from .tuples import inner
from .vector_math import OPTIONS, select, vector_arctan2, vector_cos, vector_exp, vector_log, vector_sin

__all__ = ["carray", "lane", "load_kernel", "logged_control", "njit", "stack", "whole_vectors"]


@intrinsic(prefer_literal=True)
def stack(context: Any, size: Any) -> Any:
    """Pointer to ``size`` float64 on the stack; the compiler knows that nothing else points there."""
    count = size.literal_value

    def generate(_context: Any, builder: Any, _signature: Any, _args: Any) -> Any:
        room = cgutils.alloca_once(builder, ir.ArrayType(ir.DoubleType(), count))
        return builder.bitcast(room, ir.DoubleType().as_pointer())

    return types.CPointer(types.float64)(size), generate


@intrinsic
def whole_vectors(_context: Any) -> Any:
    """Let a function use vectors as wide as the processor has: all lanes of a block in one, with AVX-512.

    LLVM halves them for most processors that have it, to spare the clock of a program that needs them now and then; a
    kernel that does little else is half as fast again with whole ones.
    """

    def generate(_context: Any, builder: Any, _signature: Any, _args: Any) -> None:
        # llvmlite knows no attributes with values and refuses them; to a set they are a text like any other.
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')

    return types.void(), generate


def lane(of: type, rows: Sequence[Any], width: int) -> Any:
    """A function of an array of the stack and a lane: the named tuple ``of`` with the lane's numbers of these rows.

    rows   of each field; several where the field is a table, or holds a named tuple
    width  lanes of a row

    To the same effect as indexing the array for each field, for which numba would take seconds to work out the types.
    """
    made = _type_of(of, rows)

    @intrinsic
    def load(_context: Any, array: Any, lane: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            data = context.make_array(signature.args[0])(context, builder, arguments[0]).data

            def value(kind: Any, of: Any) -> Any:
                if kind != types.float64:
                    own = kind.types if hasattr(kind, "types") else [kind.dtype] * len(of)
                    return context.make_tuple(builder, kind, [value(*one) for one in zip(own, of, strict=True)])
                at = builder.add(arguments[1], ir.Constant(ir.IntType(64), of * width))
                return builder.load(builder.gep(data, [at]))

            return value(made, rows)

        return made(array, types.int64), generate

    return load


def _type_of(of: type | None, rows: Any) -> Any:
    """Numba's type of a number, a table or a named tuple of rows."""
    if isinstance(rows, int):
        return types.float64
    if of is None:
        return types.UniTuple(types.float64, len(rows))
    kinds = [_type_of(kind, own) for kind, own in zip(inner(of).values(), rows, strict=True)]
    return types.NamedUniTuple(kinds[0], len(kinds), of) if len(set(kinds)) == 1 else types.NamedTuple(kinds, of)


@njit(**OPTIONS)
def logged_control(
    controls: Any, t: Any, n_samples: Any, case: int, i: int, f: float, shift: float, column: int
) -> float:
    """A logged input at the share f of the step that ends at sample i, or ``shift`` [s] later, linear between samples.

    Before the first sample and after the last the log is held.
    """
    j = min(i, n_samples[case] - 1)
    if shift != 0.0:
        time = between(t[case, i - 1], t[case, i], f) + shift
        while j > 1 and t[case, j - 1] > time:
            j -= 1
        while j < n_samples[case] - 1 and t[case, j] < time:
            j += 1
        f = min(max((time - t[case, j - 1]) / (t[case, j] - t[case, j - 1]), 0.0), 1.0)
    value: float = between(controls[case, j - 1, column], controls[case, j, column], f)
    return value


def _modules() -> list[ModuleType]:
    """Modules whose functions every kernel may call: the physics, and those of every effect."""
    names = {info.name for info in pkgutil.walk_packages(physics.__path__, physics.__name__ + ".")}
    names |= {effect.params.__module__ for effect in effects()}
    names |= {effect.function.__module__ for effect in effects() if effect.function is not None}
    return [importlib.import_module(name) for name in sorted(names)]


_registered: set[str] = set()
_own: set[str] = set()
"""Modules whose functions numba knows, and those of them that ``_source_hash`` covers."""


def _register(module: ModuleType) -> None:
    """Tell numba how to compile each function of a module: as written."""
    if module.__name__ in _registered:
        return
    _registered.add(module.__name__)
    for value in vars(module).values():
        if inspect.isfunction(value) and value.__module__ == module.__name__:
            register_jitable(**OPTIONS)(value)


def _register_all() -> None:
    """Elementary functions become vector arithmetic; all others are compiled as they stand."""

    def replace(function: Callable[..., Any], by: Callable[..., Any]) -> None:
        overload(function, jit_options=OPTIONS)(by)

    replace(elementary.exp, lambda x: lambda x: vector_exp(x))
    replace(elementary.log, lambda x: lambda x: vector_log(x))
    replace(elementary.sin, lambda x: lambda x: vector_sin(x))
    replace(elementary.cos, lambda x: lambda x: vector_cos(x))
    replace(elementary.arctan2, lambda y, x: lambda y, x: vector_arctan2(y, x))
    replace(elementary.where, lambda condition, a, b: lambda condition, a, b: select(condition, float(a), float(b)))
    _registered.add(elementary.__name__)
    for module in _modules():
        _register(module)
    _own.update(_registered)


_register_all()


@lru_cache(maxsize=1)
def _source_hash() -> str:
    """Hash of everything compiled code depends on besides the kernel's own text."""
    digest = hashlib.sha256(f"{numba.__version__} {sys.version} ".encode())
    for module in (*_modules(), vector_math, sys.modules[__name__]):
        digest.update(Path(str(module.__file__)).read_bytes())
    return digest.hexdigest()


@contextmanager
def _uncollected() -> Iterator[None]:
    """No looking for unused cycles: a compiler makes millions of objects and keeps them to its end."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def _compiled_once(function: Any, path: Path) -> Callable[..., None]:
    """The same function; of several processes that call it first, one compiles and the others read what it wrote.

    path  of its text; what is kept of it lies in a folder beside
    """
    ready = False
    kept = Entry(Path(function.stats.cache_path), path.stem)

    def kernel(*args: Any) -> None:
        nonlocal ready
        if not ready:
            with alone(path.with_suffix(".lock")):
                kept.clean()
                with _uncollected():
                    function.compile(tuple(map(function.typeof_pyval, args)))
                kept.seal()
            ready = True
        function(*args)

    return kernel


def _foreign(functions: Sequence[Callable[..., Any]]) -> list[ModuleType]:
    """Modules of functions that are no part of the program."""
    modules = dict.fromkeys(sys.modules[function.__module__] for function in functions)
    return [module for module in modules if module.__name__ not in _own]


def _path_of(text: str, functions: Sequence[Callable[..., Any]]) -> Path:
    """Where a generated text is kept, named by all that what is compiled of it depends on."""
    digest = hashlib.sha256((text + _source_hash()).encode())
    for module in _foreign(functions):
        digest.update(Path(str(module.__file__)).read_bytes())
    return kernel_folder() / f"mmgtune_kernel_{digest.hexdigest()[:16]}.py"


def is_kept(text: str, functions: Sequence[Callable[..., Any]] = ()) -> bool:
    """Whether the kernel of a generated text was compiled before."""
    path = _path_of(text, functions)
    return Entry(path.parent / "__pycache__", path.stem).sealed


def load_kernel(text: str, functions: Sequence[Callable[..., Any]] = ()) -> Callable[..., None]:
    """The compiled ``kernel`` function of a generated text; compiled at its first call unless cached on disk.

    functions  what it calls, some of them perhaps of other packages
    """
    path = _path_of(text, functions)
    name = path.stem
    for module in _foreign(functions):
        _register(module)
    if not path.exists() or path.read_bytes() != text.encode():
        write_text(path, text)
    module = ModuleType(name)
    module.__file__ = str(path)
    sys.modules[name] = module
    with _kept_beside():
        # Run from the text, not through the import system, which would believe a file of byte code in the folder.
        exec(compile(text, path, "exec"), vars(module))
    return _compiled_once(module.kernel, path)


@contextmanager
def _kept_beside() -> Iterator[None]:
    """What is decorated now is kept beside its file, wherever the user has the compiler keep other functions."""
    chosen = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = ""
    try:
        yield
    finally:
        numba.config.CACHE_DIR = chosen
