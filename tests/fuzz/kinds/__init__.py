"""What can be made hostile: a module each.

A module of this package defines ``KIND``; nothing else has to know of it.  A case is a few small files by name, made
from a generator of numbers alone, so that it can be made again, kept in the corpus, and run from there.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

Files = Mapping[str, bytes]
"""Contents by file name: all that a case is."""


@dataclass(frozen=True)
class Kind:
    """One kind of hostile input.

    name  as the command line calls it
    make  a case from a generator of numbers, which is all it may depend on
    run   uses the files of a case, written to a folder of their own, as the program would, and says what came of it
          in a word or two.  An MmgtuneError is a good end; any other exception is a failure.  What it writes goes into
          the folder ``out`` beside the files.
    seconds  CPU time a case may take; waiting counts tenfold less, as others may have the processor
    """

    name: str
    make: Callable[[np.random.Generator], Files]
    run: Callable[[Path], str]
    seconds: float = 2.0


def kinds() -> dict[str, Kind]:
    """Every kind there is, by name."""
    found = [importlib.import_module(f"{__name__}.{one.name}").KIND for one in pkgutil.iter_modules(__path__)]
    return {kind.name: kind for kind in found}
