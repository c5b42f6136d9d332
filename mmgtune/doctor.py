"""What this installation can do, and what stands in its way."""

from __future__ import annotations

import os
import platform
import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

from .backends import BACKENDS, get_backend
from .errors import MmgtuneError, OptionError
from .model import Model
from .objective import cases_of, make_objective
from .profile import load_profile
from .resources import folder, profile_names, trial_set_names
from .threads import cores
from .trial import load_trials

PACKAGES = ("numpy", "scipy", "numba", "cma", "pandas", "pyarrow", "pyproj", "matplotlib", "jinja2")
OPTIONAL = {"jax": "back end jax, derivatives and networks", "optax": "training of networks"}
"""What the extra ``learn`` brings, and what it is for."""

AGREE = 1e-9
"""Largest difference of two back ends, over the size of the motion, that is rounding."""


@dataclass(frozen=True)
class Finding:
    """One thing looked at.

    ok   False where the program cannot do its work because of it
    fix  what to do about it, "" where there is nothing to do
    """

    name: str
    value: str
    ok: bool = True
    fix: str = ""


def examine() -> list[Finding]:
    """Look at everything; never raises for what it finds."""
    return [*_versions(), _cores(), *_backends(), _cache(), *_data()]


def _versions() -> list[Finding]:
    found = [
        Finding("mmgtune", version("mmgtune")),
        Finding("Python", f"{platform.python_version()} ({sys.executable})"),
        Finding("system", f"{platform.system()} {platform.machine()}"),
    ]
    for name in PACKAGES:
        try:
            found.append(Finding(name, version(name)))
        except PackageNotFoundError:
            found.append(Finding(name, "missing", ok=False, fix="install mmgtune again, with its dependencies"))
    for name, purpose in OPTIONAL.items():
        there = _installed(name)
        text = version(name) if there else f"not installed (optional: {purpose}; pip install 'mmgtune[learn]')"
        found.append(Finding(name, text))
    return found


def _installed(name: str) -> bool:
    try:
        return bool(version(name))
    except PackageNotFoundError:
        return False


def _cores() -> Finding:
    try:
        return Finding("cores", f"{cores()} of {os.cpu_count()}")
    except OptionError as error:
        return Finding("cores", error.problems[0].what, ok=False, fix=error.problems[0].fix)


def _backends() -> list[Finding]:
    """Every back end that is installed on one bundled trial: they must run, and agree."""
    try:
        model = Model(load_profile("suzaku"))
        trials = list(load_trials("suzaku").trials.values())[:1]
        cases = cases_of(trials, make_objective(model.L_pp), model.inputs, model.draught)
    except MmgtuneError as error:
        return [Finding("back ends", f"cannot be tried: {error.problems[0].what}", ok=False)]
    found, states = [], []
    there = [name for name in BACKENDS if name != "jax" or _installed("jax")]
    for name in there:
        began = time.perf_counter()
        try:
            result = get_backend(name).run(model, model.matrix(), cases, keep_states=True)
        except OptionError as error:  # of the environment
            what, fix = error.problems[0].what, error.problems[0].fix
            found.append(Finding(f"back end {name}", f"fails: {what}", ok=False, fix=fix))
            continue
        except Exception as error:  # whatever a compiler may raise is what is looked for here
            fix = "set MMGTUNE_CACHE to a folder you may write to, or use --backend numpy" if name == "compiled" else ""
            found.append(Finding(f"back end {name}", f"fails: {error!r}", ok=False, fix=fix))
            continue
        states.append(result.states)
        found.append(
            Finding(f"back end {name}", f"runs a trial in {time.perf_counter() - began:.2g} s, start included")
        )
    if len(states) == len(there):
        apart = max(float(np.max(np.abs(states[0] - one)) / np.max(np.abs(states[0]))) for one in states[1:])
        good = apart <= AGREE
        text = f"agree to {apart:.1g}" if good else f"differ by {apart:.1g}"
        fix = "" if good else "remove the folder of compiled kernels below, then please report it"
        found.append(Finding("back ends", text, ok=good, fix=fix))
    return found


def _cache() -> Finding:
    from .backends.kernel_folder import KernelFolderWarning, kernel_folder, wanted_folder

    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", KernelFolderWarning)
        path = kernel_folder()
    kernels = list(path.glob("mmgtune_kernel_*.py"))
    size = sum(file.stat().st_size for file in path.rglob("*") if file.is_file()) / 1e6
    text = f"{path}: {len(kernels)} kernels, {size:.1f} MB"
    lasting = path == wanted_folder()
    fix = "" if lasting else "every run compiles anew (10-40 s): set MMGTUNE_CACHE to a folder only you may write to"
    chosen = " (MMGTUNE_CACHE)" if os.environ.get("MMGTUNE_CACHE") and lasting else ""
    return Finding("compile cache", text + chosen + "".join(f"; {one.message}" for one in said), fix=fix)


def _data() -> list[Finding]:
    found = []
    loaders: dict[str, tuple[list[str], Callable[[str], object]]] = {
        "profile": (profile_names(), load_profile),
        "trials": (trial_set_names(), load_trials),
    }
    for kind, (names, load) in loaders.items():
        for name in names:
            try:
                load(name)
            except MmgtuneError as error:
                found.append(Finding(f"{kind} {name}", error.problems[0].what, ok=False, fix="install mmgtune again"))
    bundled = f"{len(profile_names())} profiles, {len(trial_set_names())} sets of trials ({folder('trials').parent})"
    found.append(Finding("bundled data", bundled, ok=bool(profile_names() and trial_set_names())))
    asked = os.environ.get("MMGTUNE_DATA")
    if asked:
        there = Path(asked).is_dir()
        fix = "" if there else "name the folder of measured data, or unset it: only tests look there"
        found.append(Finding("measured data", f"{asked}" if there else f"{asked} is no folder", ok=there, fix=fix))
    else:
        found.append(Finding("measured data", "MMGTUNE_DATA is not set (optional: only tests look there)"))
    return found
